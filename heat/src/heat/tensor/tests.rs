//! Closed forms that need volume sources or prescribed boundary temperatures, and the parts of the solver.

use super::heat::Heat;
use super::mesh::body::HeatBody;
use super::mesh::depth_modes::DepthModes;
use super::mesh::section::Section;
use super::mesh::streamline::Streamline;
use super::solve::coefficients::StageCoefficients;
use super::solve::conductance::conducting;
use super::solve::line_conduction::{LineConduction, contact_nodes};
use super::solve::operators::{StageKey, StageOperators};
use super::solve::response::SurfaceInfluence;
use super::solve::transport::Transport;
use super::solve::tridiagonal::TridiagonalFactor;
use super::step::loads::SurfaceLoads;
use crate::fem::grading::graded;
use crate::heat::{
    Exchange, HeatLine, HeatMaterial, HeatModel, HeatParameters, HeatScratch, HeatState, Interval, Observation,
};
use crate::linalg::Update;
use crate::linalg::gmres::{Gmres, LinearSystem};
use crate::piecewise::Piecewise;
use std::f64::consts::PI;

const R: f64 = 0.5;
const HUB: f64 = 0.05;
const CONDUCTIVITY: f64 = 45.0;
const HEAT_CAPACITY: f64 = 460.0 * 8000.0;
const STATIONARY: StageCoefficients = StageCoefficients { storage: 0.0, flow: 1.0 };

/// Annulus with fixed hub whose rim is held at the temperature of the air by a very large film coefficient.
fn annulus(streamline: Streamline, layers: &[f64], convection: f64) -> HeatBody {
    let modes = DepthModes::new(&Section::even(layers.to_vec()), 1.0 / R, true, convection / CONDUCTIVITY).unwrap();
    HeatBody::new(streamline, modes, HEAT_CAPACITY, CONDUCTIVITY, convection).unwrap()
}

fn even(n: usize) -> Streamline {
    let step = 2.0 * PI * R / n as f64;
    Streamline::new((0..n).map(|j| (j as f64 + 0.5) * step - PI * R).collect(), 2.0 * PI * R)
}

#[test]
fn uniform_source_in_an_annulus_does_not_feel_the_rotation() {
    let zone: Vec<f64> = (0..=30).map(|i| f64::from(i) * 3.8e-5).collect();
    let streamline = Streamline::around_contact(&zone, PI * R, 1.5, 0.15 * R, true);
    let body = annulus(streamline, &graded(9e-6, 1.8, 0.15 * (R - HUB), R - HUB), 1e13);
    let mut middle = Vec::new();
    for omega in [0.0, 1e-3, 1.0, 27.8, 1e2, 1e3, 1e4] {
        let mut transport = Transport::default();
        transport.set(&body.streamline, -omega * R, 0.0, HEAT_CAPACITY, CONDUCTIVITY);
        let mut factor = TridiagonalFactor::default();
        factor.set(&body, &transport, STATIONARY, &(0..0)).unwrap();
        let mut tested = vec![0.0; body.streamline.len()];
        for (e, h) in body.streamline.lengths.iter().enumerate() {
            transport.add_load(&body.streamline, e, [*h, 0.5 * h], &mut tested);
        }
        let mut field: Vec<f64> =
            tested.iter().flat_map(|w| body.modes.content.iter().map(move |c| 1000.0 * w * c)).collect();
        factor.solve(&body, &mut field);
        let across = body.modes.at(R - 0.275);
        let nm = across.len();
        let values: Vec<f64> = field.chunks(nm).map(|row| row.iter().zip(&across).map(|(t, s)| t * s).sum()).collect();
        let (low, high) = values.iter().fold((f64::MAX, f64::MIN), |(l, h), &v| (l.min(v), h.max(v)));
        println!("omega {omega:e}: T = {low:.12} to {high:.12}, exact 0.611748698054");
        assert!((high - low) / high < 1e-9);
        middle.push(high);
    }
    assert!(middle.iter().all(|t| (t / middle[0] - 1.0).abs() < 1e-9), "{middle:?}");
    assert!((middle[0] / 0.6117486980545853 - 1.0).abs() < 2e-3);
}

struct AnnulusSystem<'a>(&'a HeatBody, &'a Transport, &'a mut TridiagonalFactor);

impl LinearSystem for AnnulusSystem<'_> {
    fn apply(&mut self, x: &[f64], out: &mut [f64]) {
        STATIONARY.multiply(self.0, self.1, x, out, Update::Replace);
        STATIONARY.add_curvature(self.0, x, out, &mut Vec::new());
    }

    fn precondition(&mut self, x: &mut [f64]) {
        self.2.solve(self.0, x);
    }
}

/// Amplitude at r = 0.45 of the field under a rim temperature cos φ on `n` even elements, flow towards +φ.
fn rotating_cosine(n: usize, layers: usize, omega: f64) -> ([f64; 2], usize) {
    let depths: Vec<f64> = (0..=layers).map(|i| (R - HUB) * i as f64 / layers as f64).collect();
    let body = annulus(even(n), &depths, 1e8);
    let (mut transport, mut factor) = (Transport::default(), TridiagonalFactor::default());
    transport.set(&body.streamline, omega * R, 0.0, HEAT_CAPACITY, CONDUCTIVITY);
    factor.set(&body, &transport, STATIONARY, &(0..0)).unwrap();
    let rim = |j: usize| (body.streamline.nodes[j % n] / R).cos();
    let load: Vec<f64> = (0..n)
        .map(|i| {
            transport.mass_lower[i] * rim(i + n - 1) + transport.mass[i] * rim(i) + transport.mass_upper[i] * rim(i + 1)
        })
        .map(|w| body.convection * w)
        .collect();
    let mut field = vec![0.0; body.size()];
    body.add_surface_load(0, &load, &mut field);
    let iterations =
        Gmres::default().solve(&mut AnnulusSystem(&body, &transport, &mut factor), &mut field, 1e-15, 1e-10).unwrap();
    let across = body.modes.at(R - 0.45);
    let mut c = [0.0; 2];
    for (row, s) in field.chunks(across.len()).zip(&body.streamline.nodes) {
        let t: f64 = row.iter().zip(&across).map(|(t, s)| t * s).sum();
        c[0] += 2.0 / n as f64 * t * (s / R).cos();
        c[1] -= 2.0 / n as f64 * t * (s / R).sin();
    }
    (c, iterations)
}

#[test]
fn rotating_cosine_converges_to_the_bessel_solution_with_order_two() {
    let cases =
        [(1e-4, [0.8937955185079237, -0.04216981902516639]), (1e-3, [0.7261656008055898, -0.23471966025848268])];
    for (omega, exact) in cases {
        let error = |n: usize| {
            let (c, iterations) = rotating_cosine(n, 36, omega);
            let error = (c[0] - exact[0]).hypot(c[1] - exact[1]);
            println!("omega {omega:e}, {n} elements: c = {c:?}, error {error:.2e}, {iterations} iterations");
            error
        };
        let [coarse, fine] = [64, 128].map(error);
        let order = (coarse / fine).log2();
        println!("figure: heat.order.{} = {order:.3} ± 0.02", 1e4 * omega);
        assert!((order - 2.0).abs() < 0.15, "observed order {order:.3}");
        assert!(fine < 1e-4);
    }
}

/// `e^{z²} erfc(z) = 2/√π ∫₀^∞ e^{−t²−2zt} dt` by Simpson's rule.
fn erfcx(z: f64) -> f64 {
    let (n, end) = (4000, 7.0);
    let h = end / f64::from(n);
    let f = |t: f64| (-t * t - 2.0 * z * t).exp();
    let weight = |i: i32| if i == 0 || i == n { 1.0 } else { f64::from(2 + 2 * (i % 2)) };
    2.0 / PI.sqrt() * h / 3.0 * (0..=n).map(|i| weight(i) * f(f64::from(i) * h)).sum::<f64>()
}

/// Both bodies for a contact of the half-width `a` \[m] at the speed `v` [m/s] with the conductance `k_c` [W/(m² K)].
fn both(a: f64, v: f64, k_c: f64) -> Heat {
    let zone = 1.5 * a;
    let density = 8000.0;
    let material = HeatMaterial {
        density,
        specific_heat: HEAT_CAPACITY / density,
        conductivity: CONDUCTIVITY,
        latent_heat: 270e3,
        solidus: 1723.0,
        liquidus: 1803.0,
    };
    Heat::new(&HeatParameters {
        radius: R,
        hub_radius: HUB,
        rail_length: 1.0,
        rail_height: 0.1,
        material,
        widths: None,
        reference: 293.0,
        hub_held: true,
        convection: 0.0,
        conductance: k_c,
        heat_ratio: 0.1,
        wheel_share: 0.5,
        max_speed: v,
        smallest_load_ratio: 1.0,
        contact_width: 1.0,
        elements_per_half_width: 20,
        half_width: a,
        zone,
        reach: zone,
    })
    .unwrap()
}

/// A wheel slows down from 50 km/h at 2 m/s² while its friction heat swings by a fifth.
#[test]
fn inverses_shared_by_neighbouring_speeds_change_no_temperature_and_lose_no_heat() {
    let (a, v) = (0.761e-3, 50.0 / 3.6);
    let heat = both(a, v, 1e7);
    let run = |shared: bool, scratch: &mut dyn FnMut(usize) -> HeatScratch| {
        let (mut state, mut next, mut seen) = (heat.initial(0.0, 0.0), HeatState::default(), Observation::default());
        let mut maxima = Vec::new();
        for k in 0..400 {
            let time = 1e-3 * k as f64;
            let speed = v - 2.0 * time;
            let power = 1e6 * (1.0 + 0.2 * (200.0 * time).sin());
            let exchange = Exchange {
                patches: vec![Interval { low: -a, high: a }],
                friction_power: Piecewise::sampled(-a, a, 41, |x| power * (1.0 - x / a)),
                ..Exchange::default()
            };
            if !shared && let Some(last) = &mut state.last {
                // Speeds that no rounding brings near the present ones; no jump either.
                last.speeds = last.speeds.map(|speed| 1.1 * speed);
            }
            let mut scratch = scratch(k);
            let mut line = [HeatLine::new(&state, &mut next, &exchange)];
            heat.step(&mut line, 1e-3, speed, 1.001 * speed / R, &mut scratch).unwrap();
            let flows = line[0].flows;
            std::mem::swap(&mut state, &mut next);
            assert!(flows.relative_imbalance() < 1e-12, "{k}: {:e}", flows.relative_imbalance());
            heat.observe(&state, &mut seen).unwrap();
            maxima.push([seen.temperatures.wheel_max, seen.temperatures.rail_max]);
        }
        (maxima, state)
    };
    let (shared, state) = run(true, &mut |_| HeatScratch::default());
    let (own, other) = run(false, &mut |_| HeatScratch::default());
    let differences = shared.iter().flatten().zip(own.iter().flatten()).map(|(a, b)| (a / b - 1.0).abs());
    let largest = differences.fold(0.0, f64::max);
    println!("largest relative difference of a temperature rise {largest:.1e}");
    assert!(largest < 1e-4 && state.values != other.values, "{largest:e}");
    // Neither does it matter what was computed before in the same memory.
    let mut kept = Some(HeatScratch::default());
    let mut advance = |state: &HeatState, speed: f64| {
        let (mut next, mut scratch) = (HeatState::default(), kept.take().unwrap());
        let idle = Exchange::default();
        heat.step(&mut [HeatLine::new(state, &mut next, &idle)], 1e-3, speed, speed / R, &mut scratch).unwrap();
        kept = Some(scratch);
        next
    };
    let speeds = [13.0, 13.001, 12.9, 13.0];
    let [first, .., again] = speeds.map(|speed| advance(&state, speed));
    assert_eq!(first.values, again.values);
}

#[test]
fn kept_factors_of_a_full_contact_and_its_two_ends_are_the_factors_of_the_contact() {
    let (a, v) = (0.761e-3, 50.0 / 3.6);
    for (k_c, share, tolerance) in [(1e7, 0.5, 1e-13), (1e8, 1e-6, 1e-12), (1e12, 0.999, 1e-9)] {
        let heat = both(a, v, k_c);
        // Ends within an element: of which the given share is in contact.
        let end = |towards: f64| {
            let x = heat.zone_x();
            let (outer, inner) = if towards < 0.0 { (x[3], x[4]) } else { (x[x.len() - 6], x[x.len() - 7]) };
            inner + share * (outer - inner)
        };
        let exchange = Exchange { patches: vec![Interval { low: end(-1.0), high: end(1.0) }], ..Exchange::default() };
        let (mut stage, mut line, mut loads) =
            (StageOperators::default(), LineConduction::default(), SurfaceLoads::default());
        loads.set(&heat.layout, &exchange, 0.0).unwrap();
        let coefficients = StageCoefficients { storage: 1.0, flow: 0.3e-3 };
        let (speeds, inverted) = ([v, 0.98 * v / R], [1.003 * v, 0.978 * v / R]);
        // Among the nodes that another, wider line touches.
        let contact = [0, heat.zone_x().len()];
        let key = StageKey { speeds, inverted, coefficients, rate: 1.0 / 0.3e-3, curved: false, contact };
        stage.set(&heat.layout, key).unwrap();
        line.set(&stage, &heat.layout, &loads.conductance).unwrap();
        let jump: Vec<f64> =
            (0..conducting(&loads.conductance).len() + 1).map(|i| 100.0 + (7.0 * i as f64).sin()).collect();
        let [kept, direct] =
            [(k_c, true), (2.0 * k_c, false)].map(|even| line.left_of(&stage, &heat.layout, even, &jump));
        let largest = |values: &[f64]| values.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
        let apart: Vec<f64> = kept.iter().zip(&direct).map(|(a, b)| a - b).collect();
        println!("k_c {k_c:e}: {:.1e} of {:.1e} K", largest(&apart), largest(&direct));
        assert!(largest(&apart) < tolerance * largest(&direct));
    }
}

#[test]
fn entry_into_a_conducting_contact_follows_its_closed_form() {
    let (a, v, k_c) = (0.761e-3, 50.0 / 3.6, 1e7);
    let heat = both(a, v, k_c);
    let exchange = Exchange { patches: vec![Interval { low: -a, high: a }], ..Exchange::default() };
    let (mut stage, mut line, mut loads) =
        (StageOperators::default(), LineConduction::default(), SurfaceLoads::default());
    loads.set(&heat.layout, &exchange, 0.0).unwrap();
    let (speeds, contact) = ([v, v / R], contact_nodes(&loads.conductance));
    let key = StageKey { speeds, inverted: speeds, coefficients: STATIONARY, rate: 0.0, curved: false, contact };
    stage.set(&heat.layout, key).unwrap();
    line.set(&stage, &heat.layout, &loads.conductance).unwrap();
    let (nodes, temperatures) = line.rail_under_uniform_wheel(&stage, 1.0);
    let surface: Vec<[f64; 2]> = heat.zone_x()[nodes].iter().zip(temperatures).map(|(&x, t)| [x, t]).collect();
    let effusivity = (CONDUCTIVITY * HEAT_CAPACITY).sqrt();
    let exact = |x: f64| 1.0 - erfcx(k_c / effusivity * ((a - x) / v).sqrt());
    let (mut worst, mut heat_flow) = (0.0_f64, 0.0);
    for pair in surface.windows(2) {
        let ([x, t], [next, u]) = (pair[0], pair[1]);
        // The first two nodes oscillate (by 0.05 and 0.006): a square root starts there.
        if x > -a && x < 0.97 * a {
            worst = worst.max((t - exact(x)).abs());
        }
        heat_flow += k_c * (next - x) * (1.0 - 0.5 * (t + u));
    }
    let b = k_c / effusivity;
    let z = b * (2.0 * a / v).sqrt();
    let expected = v * k_c / (b * b) * (erfcx(z) - 1.0 + 2.0 * z / PI.sqrt());
    println!("largest error {worst:.2e} of 1, heat {heat_flow:.6e} ({:+.3} %)", 100.0 * (heat_flow / expected - 1.0));
    assert!(worst < 1e-2);
    assert!((heat_flow / expected - 1.0).abs() < 1e-3);
}

#[test]
fn surface_response_equals_solutions_for_unit_loads() {
    let zone: Vec<f64> = (0..=20).map(|i| f64::from(i) * 1e-3).collect();
    let streamline = Streamline::around_contact(&zone, PI * R, 1.5, 0.15 * R, true);
    for (omega, nodes) in
        [0.0, 0.01, 30.0, -30.0].into_iter().flat_map(|omega| [1, 5, 9, 38].map(|nodes| (omega, nodes)))
    {
        let modes = DepthModes::new(&Section::even(graded(1e-4, 1.8, 0.1, R - HUB)), 1.0 / R, true, 0.0).unwrap();
        let body = HeatBody::new(streamline.clone(), modes, HEAT_CAPACITY, CONDUCTIVITY, 0.0).unwrap();
        let (mut transport, mut factor) = (Transport::default(), TridiagonalFactor::default());
        transport.set(&body.streamline, -omega * R, 0.0, HEAT_CAPACITY, CONDUCTIVITY);
        let range = body.streamline.zone + 1..body.streamline.zone + 1 + nodes;
        factor.set(&body, &transport, STATIONARY, &range).unwrap();
        let mut response = SurfaceInfluence::default();
        response.set(&factor, &body, range.clone());
        let entries = (0..nodes).flat_map(|i| response.row(i));
        let scale = entries.fold(0.0_f64, |largest, r| largest.max(r.abs()));
        for (k, node) in range.clone().enumerate() {
            let mut field = vec![0.0; body.size()];
            body.add_surface_load(node, &[1.0], &mut field);
            let load = field.clone();
            factor.solve(&body, &mut field);
            let mut trace = Vec::new();
            body.trace(range.clone(), &field, &mut trace);
            let error = trace.iter().enumerate().map(|(i, t)| (t - response.row(i)[k]).abs());
            assert!(error.fold(0.0, f64::max) < 1e-12 * scale);
            let mut product = vec![0.0; body.size()];
            STATIONARY.multiply(&body, &transport, &field, &mut product, Update::Replace);
            let residual = product.iter().zip(&load).fold(0.0_f64, |m, (p, l)| m.max((p - l).abs()));
            assert!(residual < 1e-8 * load.iter().fold(0.0, |m: f64, l| m.max(l.abs())), "residual {residual:.1e}");
        }
    }
}

#[test]
fn modes_of_an_insulated_plate_are_cosines() {
    let height = 0.1;
    let modes = DepthModes::new(&Section::even(graded(9e-6, 1.3, 0.05 * height, height)), 0.0, false, 0.0).unwrap();
    assert_eq!(modes.values[0], 0.0);
    for n in 1..4 {
        let exact = (f64::from(n) * PI / height).powi(2);
        let error = modes.values[n as usize] / exact - 1.0;
        println!("mode {n}: {error:+.2e}");
        assert!(error.abs() < 1e-4);
    }
    // A uniform temperature is the first mode alone.
    let height_again: f64 = modes.content.iter().map(|c| c * c).sum();
    assert!((height_again / height - 1.0).abs() < 1e-14);
    assert!(modes.content[1..].iter().all(|c| c.abs() < 1e-15));
}
