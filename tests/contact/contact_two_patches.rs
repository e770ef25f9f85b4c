//! Two contact patches at once, on half-planes.
//!
//! A double well `g = K (x⁴ − S x²)/4` has a closed solution. With `v = s²` the integral equation of the frictionless
//! line contact over `b < |x| < a`, `g' = 2/(πE*) ∫ p(s)/(x − s) ds`, becomes that of one interval in `v`, and
//! `p = C |x| √((a² − x²)(x² − b²))` satisfies it with `C = K E*/2` and `a² + b² = S`; the load is
//! `P = π C (a² − b²)²/8` (Muskhelishvili, *Singular Integral Equations*, §88, for contacts of several intervals).

use crate::common;
use crate::half_planes::{self, FRICTION, HalfPlanes, NOMINAL, modulus};
use std::f64::consts::PI;
use wheelrail::analytic::hertz_half_width;
use wheelrail::contact::ContactState;
use wheelrail::contact::line::NodeStatus;

/// The double well of an outer and an inner edge under the nominal load.
struct DoubleWell {
    /// `C` [Pa/m³].
    strength: f64,
    /// `S` [m²].
    sum: f64,
}

impl DoubleWell {
    /// Outer edges at ±1.2 and inner ones at ±0.5 Hertzian half-widths of the nominal load.
    fn new() -> Self {
        let unit = hertz_half_width(NOMINAL, half_planes::RADIUS, modulus());
        let (outer, inner) = ((1.2 * unit).powi(2), (0.5 * unit).powi(2));
        Self { strength: 8.0 * NOMINAL / (PI * (outer - inner).powi(2)), sum: outer + inner }
    }

    fn gap(&self, x: f64) -> f64 {
        0.5 * self.strength / modulus() * (x.powi(4) - self.sum * x * x)
    }

    /// Outer and inner edge under a line load.
    fn edges(&self, load: f64) -> (f64, f64) {
        let half = (2.0 * load / (PI * self.strength)).sqrt();
        ((0.5 * self.sum + half).sqrt(), (0.5 * self.sum - half).sqrt())
    }

    fn pressure(&self, x: f64, load: f64) -> f64 {
        let (a, b) = self.edges(load);
        self.strength * x.abs() * ((a * a - x * x) * (x * x - b * b)).max(0.0).sqrt()
    }

    fn bodies(&self, per_half_width: usize) -> HalfPlanes {
        HalfPlanes::new(per_half_width).with_gap(|x| self.gap(x))
    }
}

/// Rolls from one closed node in each well.
fn roll(bodies: &HalfPlanes, load: f64, creepage: f64) -> ContactState {
    let (mut start, x, well) = (bodies.start(), &bodies.grid.x, DoubleWell::new());
    let lowest = |nodes: std::ops::Range<usize>| nodes.min_by(|&i, &j| well.gap(x[i]).total_cmp(&well.gap(x[j])));
    let middle = x.len() / 2;
    let status = &mut start.grid.status;
    status.fill(NodeStatus::Open);
    for node in [lowest(0..middle), lowest(middle..x.len())].into_iter().flatten() {
        status[node] = NodeStatus::Stick;
    }
    bodies.roll(load, creepage, &start).unwrap()
}

fn normal(bodies: &HalfPlanes, solution: &ContactState) -> Vec<f64> {
    (0..bodies.grid.len()).map(|i| bodies.normal(solution, i)).collect()
}

/// Loads that move the four edges through more than a cell of a twentieth of the half-width.
fn loads() -> impl Iterator<Item = f64> {
    (0..21).map(|k| NOMINAL * (0.8 + 0.015 * k as f64))
}

/// Largest errors of the edges relative to the outer one, and of the pressure relative to its peak.
fn errors(per_half_width: usize) -> (f64, f64) {
    let well = DoubleWell::new();
    let bodies = well.bodies(per_half_width);
    let (x, h) = (&bodies.grid.x, bodies.grid.spacing);
    let (mut edge_error, mut pressure_error) = (0.0f64, 0.0f64);
    for load in loads() {
        let solution = roll(&bodies, load, 0.0);
        let force = normal(&bodies, &solution);
        let patches = &solution.traction.edges;
        assert_eq!(patches.len(), 2, "load {load}");
        let (a, b) = well.edges(load);
        let peak = (0..1000).map(|k| well.pressure(b + (a - b) * k as f64 / 1000.0, load)).fold(0.0, f64::max);
        let of_half = |right: bool| -> f64 { (0..x.len()).filter(|&i| (x[i] > 0.0) == right).map(|i| force[i]).sum() };
        for (patch, right) in patches.iter().zip([false, true]) {
            let carried = of_half(right);
            assert!((carried / (0.5 * load) - 1.0).abs() < 1e-9, "load {load}: {carried}");
            let (exact_low, exact_high) = if right { (b, a) } else { (-a, -b) };
            edge_error = edge_error.max((patch.low - exact_low).abs().max((patch.high - exact_high).abs()) / a);
        }
        // Closer to an edge a node carries part of a cell.
        for i in (0..x.len()).filter(|&i| x[i].abs() > 1.1 * b && x[i].abs() < 0.95 * a) {
            pressure_error = pressure_error.max((force[i] / h - well.pressure(x[i], load)).abs() / peak);
        }
    }
    common::figure(&format!("two.patches.{per_half_width}"), &[edge_error, pressure_error]);
    println!(
        "a/{per_half_width}: error of an edge {edge_error:.2e} a, of the pressure {pressure_error:.2e} of its peak"
    );
    (edge_error, pressure_error)
}

#[test]
fn two_patches_carry_half_the_load_each_and_converge_to_the_closed_solution() {
    let (coarse, fine) = (errors(20), errors(40));
    assert!(coarse.0 < 8e-3 && coarse.1 < 0.012, "{coarse:?}");
    let orders = ((coarse.0 / fine.0).log2(), (coarse.1 / fine.1).log2());
    assert!(orders.0 > 1.5 && orders.1 > 1.5, "observed orders {orders:?}");
}

#[test]
fn forces_press_gaps_are_open_and_friction_stays_in_its_cone_on_two_patches() {
    let well = DoubleWell::new();
    let bodies = well.bodies(20);
    let deepest = bodies.grid.x.iter().fold(0.0, |low: f64, &x| low.min(well.gap(x))).abs();
    for creepage in [0.0, 2e-4, -4e-4, 1e-2] {
        let solution = roll(&bodies, NOMINAL, creepage);
        let grid = &solution.grid;
        for i in 0..bodies.grid.len() {
            let (n, t) = (bodies.normal(&solution, i), bodies.tangential(&solution, i));
            assert!(n >= 0.0 && grid.gap[i] >= -1e-9 * deepest, "node {i}: force {n}, gap {}", grid.gap[i]);
            assert!(n * grid.gap[i] == 0.0, "node {i}: force {n} over a gap of {}", grid.gap[i]);
            assert!(t.abs() <= FRICTION * n * (1.0 + 1e-9), "node {i}: friction {t} under {n}");
            assert!(t * grid.slip[0][i] <= 1e-9 * NOMINAL, "node {i}: friction drives the slip");
        }
    }
}

#[test]
fn creep_force_of_two_patches_reverses_with_the_creepage_and_converges() {
    let well = DoubleWell::new();
    let utilisation = |bodies: &HalfPlanes, load: f64, creepage: f64| {
        roll(bodies, load, creepage).traction.resultant.travel / (FRICTION * load)
    };
    let [coarse, middle, fine] = [20, 40, 80].map(|n| well.bodies(n));
    let mut worst = [0.0f64; 2];
    for load in loads().step_by(4) {
        for share in [0.4, 0.8] {
            let creepage = share * coarse.full_slip(load);
            let there = utilisation(&coarse, load, creepage);
            let back = utilisation(&coarse, load, -creepage);
            assert!((there + back).abs() < 5e-3, "load {load}, creepage {creepage}: {there} and {back}");
            let exact = utilisation(&fine, load, creepage);
            worst[0] = worst[0].max((there - exact).abs());
            worst[1] = worst[1].max((utilisation(&middle, load, creepage) - exact).abs());
        }
    }
    common::figure("two.patches.force", &worst);
    println!("largest error of F/μP: a/20 {:.5}, a/40 {:.5}", worst[0], worst[1]);
    assert!(worst[0] < 0.016, "{worst:?}");
    assert!(worst[1] < 0.6 * worst[0], "{worst:?}");
}

/// A cylinder over a sharp hole of the width 2b that it does not fill. On a grid the hole ends somewhere between
/// two nodes. With `v = s²` the hole is an end of the interval at which
/// the pressure is singular: `p = E*/(2R) |x| √((a² − x²)/(x² − b²))` and `a² = b² + 4PR/(πE*)`.
#[test]
fn a_cylinder_over_a_sharp_hole_has_the_edges_and_the_pressure_of_the_closed_solution() {
    let unit = hertz_half_width(NOMINAL, half_planes::RADIUS, modulus());
    let errors = [20, 40].map(|per_half_width| {
        let spacing = unit / f64::from(per_half_width);
        // The hole ends in the middle between two nodes.
        let hole = ((0.25 * unit / spacing).round() + 0.5) * spacing;
        let circle = |x: f64| x * x / (half_planes::RADIUS + (half_planes::RADIUS.powi(2) - x * x).sqrt());
        let gap = |x: f64| circle(x) + if x.abs() < hole { 1e-3 } else { 0.0 };
        let bodies = HalfPlanes::new(per_half_width as usize).with_gap(gap);
        let (x, h) = (&bodies.grid.x, bodies.grid.spacing);
        let (mut edge_error, mut pressure_error, mut ends) = (0.0f64, 0.0f64, [20, -20]);
        for load in loads() {
            let solution = bodies.roll(load, 0.0, &bodies.start()).unwrap();
            let edges = &solution.traction.edges;
            assert_eq!(edges.len(), 2, "load {load}");
            let a = (hole * hole + hertz_half_width(load, half_planes::RADIUS, modulus()).powi(2)).sqrt();
            edge_error = edge_error.max((edges[1].high - a).abs().max((edges[0].low + a).abs()) / a);
            let place = |share: i32| hole + 0.5 * spacing * f64::from(share) / 20.0;
            let scale = modulus() / (2.0 * half_planes::RADIUS);
            let (force, peak) = (normal(&bodies, &solution), scale * a);
            let error = |b: f64| {
                let a = (b * b + hertz_half_width(load, half_planes::RADIUS, modulus()).powi(2)).sqrt();
                let inside = (0..x.len()).filter(|&i| x[i].abs() > hole + 0.1 * unit && x[i].abs() < 0.95 * a);
                let exact = |x: f64| scale * x.abs() * ((a * a - x * x) / (x * x - b * b)).sqrt();
                inside.map(|i| (force[i] / h - exact(x[i])).abs() / peak).fold(0.0, f64::max)
            };
            let (end, least) = (-20..=20).map(|k| (k, error(place(k)))).min_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
            (pressure_error, ends) = (pressure_error.max(least), [ends[0].min(end), ends[1].max(end)]);
            assert!((0..x.len()).all(|i| x[i].abs() > hole || force[i] == 0.0));
        }
        common::figure(&format!("hole.closed.{per_half_width}"), &[edge_error, pressure_error]);
        println!("a/{per_half_width}: error of the outer edge {edge_error:.2e} a, of the pressure {pressure_error:.2e} of its peak, the hole ends {ends:?} fortieths of a spacing from the middle");
        [edge_error, pressure_error]
    });
    let [coarse, fine] = errors;
    assert!(fine[0] < 5e-3 && fine[1] < 5e-3 && fine[0] < coarse[0] && fine[1] < coarse[1], "{errors:?}");
}
