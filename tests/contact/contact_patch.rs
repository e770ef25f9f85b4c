//! Observables of the contact patch on sampled closed forms: Hertz, Carter, and a hot, skewed patch. The grid is
//! shifted through one cell, so that the edges take every position between the nodes.

use crate::common;
use nalgebra::DVector;
use std::f64::consts::PI;
use wheelrail::contact::Traction;
use wheelrail::contact::line::observe::read_off;
use wheelrail::contact::line::{ContactGrid, GridState, NodeStatus};

/// Cells per half-width.
const CELLS: f64 = 20.0;
/// Positions of the grid within a cell.
const SHIFTS: usize = 41;
const FRICTION: f64 = 0.3;

/// A grid of unit half-width whose nodes are shifted by `shift` cells.
fn grid(shift: f64) -> ContactGrid {
    let h = 1.0 / CELLS;
    ContactGrid::uniform((-30..=30).map(|i| (i as f64 + shift) * h).collect(), h, 3)
}

/// The traction of these nodal forces; closed where they press, stuck where they stay below the friction limit.
fn traction(grid: &ContactGrid, normal: impl Fn(f64) -> f64, tangential: impl Fn(f64) -> f64) -> Traction {
    let (n, forces) = (grid.len(), DVector::zeros(grid.components()));
    let (status, zeros) = (vec![NodeStatus::Open; n], vec![0.0; n]);
    let mut state = GridState { status, slip: [zeros.clone(), Vec::new()], gap: zeros, forces, ..Default::default() };
    let mut traction = Traction::default();
    for (i, &x) in grid.x.iter().enumerate() {
        let (n, t) = (normal(x), tangential(x));
        if n <= 0.0 {
            continue;
        }
        let slips = t.abs() >= FRICTION * n * (1.0 - 1e-9);
        state.status[i] = if slips { NodeStatus::SlipForward } else { NodeStatus::Stick };
        state.forces[grid.component(i)] = t;
        state.forces[grid.component(i) + 1] = n;
    }
    let limits: (_, &dyn Fn(usize) -> f64) = ([0.0, f64::INFINITY], &|_| FRICTION);
    read_off(grid, limits, (&state, true), [&vec![0.0; n], &[]], &mut traction);
    traction
}

/// Tractions at every shift of the grid.
fn observed(normal: impl Fn(f64, f64) -> f64, tangential: impl Fn(f64, f64) -> f64) -> Vec<Traction> {
    (0..SHIFTS)
        .map(|k| {
            let grid = grid(k as f64 / SHIFTS as f64);
            let h = grid.spacing;
            traction(&grid, |x| normal(x, h), |x| tangential(x, h))
        })
        .collect()
}

/// Mean error and peak to peak.
fn statistics(values: impl Iterator<Item = f64> + Clone) -> (f64, f64) {
    let (count, sum) = values.clone().fold((0.0, 0.0), |(n, s), v| (n + 1.0, s + v));
    let high = values.clone().fold(f64::MIN, f64::max);
    (sum / count, high - values.fold(f64::MAX, f64::min))
}

/// Force of the pressure `√(1 − x²)` from −1 to `x`.
fn hertz_up_to(x: f64) -> f64 {
    let x = x.clamp(-1.0, 1.0);
    0.5 * (x * (1.0 - x * x).sqrt() + x.asin() + 0.5 * PI)
}

/// Exact force of the Hertzian pressure on the cell of a node.
fn hertz_cell(x: f64, h: f64) -> f64 {
    hertz_up_to(x + 0.5 * h) - hertz_up_to(x - 0.5 * h)
}

/// Nodal forces by an edge as the discrete half-plane answers: `Γ(n + ½)/n! (n + z)`, `n` cells from the outermost
/// node, tends to `√(n + 2z − ¼)`; it solves the kernel `1/(n + ½)`, and the effective edge lies `2z − ¼` cells
/// outside.
fn discrete_edge(outermost: f64, cell: f64) -> f64 {
    let (n, z) = (cell.round() as i32, 0.5 * (outermost + 0.25));
    let gamma = (0..n).fold(PI.sqrt(), |product, k| product * (k as f64 + 0.5) / (k as f64 + 1.0));
    gamma * (n as f64 + z)
}

/// Nodal forces of a Hertzian patch with such edges: the product of both is `√((1 − x)(1 + x))` away from them.
fn discrete_hertz(x: f64, h: f64) -> f64 {
    // Cells from the edge to a node; its outermost node lies up to ¾ cell inside and ¼ cell outside.
    let edge = |distance: f64| {
        let outermost = (distance + 0.25).rem_euclid(1.0) - 0.25;
        let cell = distance - outermost;
        if cell.round() < 0.0 { 0.0 } else { discrete_edge(outermost, cell) }
    };
    h * h * edge((1.0 + x) / h) * edge((1.0 - x) / h)
}

#[test]
fn half_width_of_discrete_hertz_patches_is_right_below_grid_scale() {
    let seen = observed(discrete_hertz, |_, _| 0.0);
    let (mean, spread) = statistics(seen.iter().map(|p| p.half_width() - 1.0));
    common::figure("patch.sampled.half.width", &[spread]);
    println!("half-width: mean {mean:+.2e}, peak to peak {spread:.2e}");
    // 1.8e-3: an edge beyond a node that opens is taken, continuously, from the two nodes further inside.
    assert!(mean.abs() <= 5e-4 && spread <= 2e-3, "mean {mean}, peak to peak {spread}");
    let (mean, spread) = statistics(seen.iter().map(|p| p.pressure_max - 1.0));
    common::figure("patch.sampled.pressure", &[spread]);
    println!("peak pressure: mean {mean:+.2e}, peak to peak {spread:.2e}");
    assert!(mean.abs() <= 1e-3 && spread <= 1e-3, "mean {mean}, peak to peak {spread}");
}

/// Cell forces are not those of a discrete solution at the edges: where the edge enters a cell it is seen a quarter of
/// a cell too far outside.
#[test]
fn half_width_of_integrated_hertz_pressure_is_right_to_a_quarter_of_a_cell() {
    let seen = observed(hertz_cell, |_, _| 0.0);
    let worst = seen.iter().map(|p| (p.half_width() - 1.0).abs()).fold(0.0, f64::max);
    let (mean, spread) = statistics(seen.iter().map(|p| p.pressure_max - 1.0));
    println!("half-width: worst {worst:.2e}; peak pressure: mean {mean:+.2e}, peak to peak {spread:.2e}");
    assert!(worst <= 0.25 / CELLS, "{worst}");
    assert!(mean.abs() <= 1e-3 && spread <= 1e-3, "mean {mean}, peak to peak {spread}");
}

#[test]
fn stick_fraction_of_carter_shear_is_right_to_half_a_cell() {
    for share in [0.2, 0.45, 0.7, 0.9] {
        // Stick zone of half-width `share` at the leading edge.
        let centre = 1.0 - share;
        let shear = |x: f64, h: f64| {
            let inner = share * share * hertz_cell((x - centre) / share, h / share);
            FRICTION * (hertz_cell(x, h) - inner)
        };
        let seen = observed(hertz_cell, shear);
        let (mean, spread) = statistics(seen.iter().map(|p| p.stick_fraction - share));
        println!("stick fraction {share}: mean {mean:+.2e}, peak to peak {spread:.2e}");
        // A cell is 0.025 of the length of the patch.
        assert!(mean.abs() <= 0.25 / CELLS && spread <= 0.25 / CELLS, "{share}: mean {mean}, peak to peak {spread}");
    }
}

/// Integral of a function over a cell: four Gauss–Legendre points on each half.
fn cell(x: f64, h: f64, f: impl Fn(f64) -> f64) -> f64 {
    const POINTS: [(f64, f64); 4] = [
        (-0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
        (-0.339_981_043_584_856_3, 0.652_145_154_862_546_1),
        (0.339_981_043_584_856_3, 0.652_145_154_862_546_1),
        (0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
    ];
    let half = |middle: f64| POINTS.iter().map(|(s, w)| 0.25 * h * w * f(middle + 0.25 * h * s)).sum::<f64>();
    half(x - 0.25 * h) + half(x + 0.25 * h)
}

/// A locked wheel heats the trailing half of its patch, which swells: the pressure leans backwards, or concentrates on
/// a hot ridge of a fifth of the half-width.
#[test]
fn peak_pressure_of_a_hot_skewed_patch_is_that_of_the_profile() {
    let hertz = |x: f64| (1.0 - x * x).max(0.0).sqrt();
    type Pressure = (&'static str, Box<dyn Fn(f64) -> f64>);
    let profiles: [Pressure; 3] = [
        ("leaning", Box::new(move |x| hertz(x) * (1.0 - 0.8 * x))),
        ("exponential", Box::new(move |x| hertz(x) * (-1.5 * x).exp())),
        ("ridge", Box::new(move |x| hertz(x) * (0.5 + 2.0 * (-((x + 0.45) / 0.25).powi(2)).exp()))),
    ];
    for (name, pressure) in profiles {
        let peak = (0..20_001).map(|k| pressure(k as f64 / 1e4 - 1.0)).fold(0.0, f64::max);
        let seen = observed(|x, h| cell(x, h, &pressure), |_, _| 0.0);
        let worst = seen.iter().map(|p| (p.pressure_max / peak - 1.0).abs()).fold(0.0, f64::max);
        common::figure("patch.skewed", &[worst]);
        println!("{name}: largest relative error of the peak {worst:.2e}");
        assert!(worst <= 0.01, "{name}: {worst}");
    }
}
