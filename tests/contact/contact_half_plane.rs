//! Contact algorithm alone, on elastic half-planes whose compliance is known in closed form. Hertz and Carter are exact
//! for the continuum.

use crate::common::{self, Random};
use crate::half_planes::{HalfPlanes, NOMINAL, RADIUS, modulus};
use wheelrail::analytic::hertz_half_width;
use wheelrail::axes::Axis;
use wheelrail::contact::ContactError;
use wheelrail::contact::line::NodeStatus;

#[test]
fn carter_force_is_smooth_while_the_edges_move_between_nodes() {
    let bodies = HalfPlanes::new(20);
    for share in [0.3, 0.6, 0.8, 0.9, 0.95, -0.3, -0.6, -0.8, -0.9, -0.95] {
        let errors: Vec<f64> =
            (0..41).map(|k| bodies.carter_error(NOMINAL * (0.85 + 0.0075 * k as f64), share)).collect();
        let mean = errors.iter().sum::<f64>() / errors.len() as f64;
        let spread = errors.iter().cloned().fold(f64::MIN, f64::max) - errors.iter().cloned().fold(f64::MAX, f64::min);
        println!("share {share}: mean {mean:.5}, peak to peak {spread:.5}");
        assert!(mean.abs() <= 1e-3, "share {share}: mean {mean}");
        assert!(spread <= 2e-3, "share {share}: peak to peak {spread}");
    }
}

#[test]
fn half_width_is_smooth_and_hertzian() {
    let bodies = HalfPlanes::new(20);
    let errors: Vec<f64> = (0..61)
        .map(|k| {
            let load = NOMINAL * (0.85 + 0.005 * k as f64);
            let solution = bodies.roll(load, 0.0, &bodies.start()).unwrap();
            let a = hertz_half_width(load, RADIUS, modulus());
            solution.traction.half_width() / a - 1.0
        })
        .collect();
    let mean = errors.iter().sum::<f64>() / errors.len() as f64;
    let spread = errors.iter().cloned().fold(f64::MIN, f64::max) - errors.iter().cloned().fold(f64::MAX, f64::min);
    println!("half-width: mean {mean:.5}, peak to peak {spread:.5}");
    // The edge passes continuously over a node that opens; what the next two nodes say of it differs by 0.08 cells.
    assert!(mean.abs() <= 1e-3 && spread <= 4e-3, "mean {mean}, peak to peak {spread}");
}

/// The torsion of the wheel turns the rim against the hub: for a round rim no change of geometry.
#[test]
fn a_rigid_turn_of_the_rim_by_five_millimetres_changes_nothing_in_the_contact() {
    for (load, creepage) in [(NOMINAL, 3e-4), (0.1 * NOMINAL, -1e-4), (1.9 * NOMINAL, 2.0), (NOMINAL, 0.0)] {
        let found = [0.0, 5e-3, -5e-3].map(|moved| {
            let bodies = HalfPlanes::new(20).turned(moved / RADIUS);
            bodies.roll(load, creepage, &bodies.start()).unwrap().traction
        });
        for turned in &found[1..] {
            let patch = |t: &wheelrail::contact::Traction| t.extent().map(|p| [p.low, p.high]).unwrap();
            let moved = (0..2).map(|k| (patch(turned)[k] - patch(&found[0])[k]).abs()).fold(0.0, f64::max);
            let force =
                Axis::ALL.map(|k| (turned.resultant[k] - found[0].resultant[k]).abs()).into_iter().fold(0.0, f64::max);
            let half_width = found[0].half_width();
            common::round_off("rim.turned", &[moved / half_width, force / load], 1e-9);
            println!("load {load}, creepage {creepage}: edges {:.1e}, force {:.1e}", moved / half_width, force / load);
            assert!(moved < 1e-6 * half_width && force < 1e-6 * load, "{moved:e} m, {force:e} N/m");
        }
    }
}

#[test]
fn carter_error_falls_with_order_one_and_a_half_or_better() {
    let spread = |n: usize| {
        let bodies = HalfPlanes::new(n);
        (0..15).map(|k| bodies.carter_error(NOMINAL * (0.9 + 0.013 * k as f64), 0.8).abs()).fold(0.0, f64::max)
    };
    let (coarse, fine) = (spread(10), spread(20));
    println!("largest error: a/10 {coarse:.5}, a/20 {fine:.5}");
    assert!((coarse / fine).log2() > 1.5, "observed order {:.2}", (coarse / fine).log2());
}

#[test]
fn a_patch_wider_than_the_candidate_zone_is_an_error() {
    let bodies = HalfPlanes::new(10);
    assert!(bodies.roll(2.0 * NOMINAL, 0.0, &bodies.start()).is_ok());
    let error = bodies.roll(4.0 * NOMINAL, 0.0, &bodies.start()).unwrap_err();
    assert!(matches!(error, ContactError::ZoneExceeded { .. }), "{error}");
}

#[test]
fn every_random_start_converges_to_the_same_contact_state() {
    let bodies = HalfPlanes::new(20);
    let mut random = Random(2);
    let (mut worst, mut total) = (0, 0);
    for case in 0..1000 {
        let load = NOMINAL * random.between(0.02, 1.92);
        let xi = random.sign() * random.logarithmic(1e-6, 1.5);
        let expected = bodies.roll(load, xi, &bodies.start()).unwrap_or_else(|e| panic!("case {case}: {e}"));
        let mut start = bodies.start();
        for i in 0..bodies.grid.len() {
            start.grid.status[i] =
                [NodeStatus::Open, NodeStatus::Stick, NodeStatus::SlipForward, NodeStatus::SlipBackward]
                    [random.between(0.0, 4.0) as usize];
            let at = bodies.grid.component(i) + 1;
            start.grid.forces[at] = random.between(0.0, load / 20.0);
        }
        let found = bodies.roll(load, xi, &start).unwrap_or_else(|e| panic!("case {case}, xi = {xi}: {e}"));
        let difference = (&found.grid.forces - &expected.grid.forces).amax() / load;
        let solution = found.traction;
        assert!(difference < 1e-3, "case {case}, xi = {xi}, load {load}: {difference}");
        worst = worst.max(solution.iterations);
        total += solution.iterations;
    }
    common::figure("starts.contact", &[worst as f64]);
    println!("iterations: mean {:.2}, worst {worst}", total as f64 / 1000.0);
    assert!(worst <= 30, "{worst}");
}
