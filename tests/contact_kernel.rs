//! The correction of the surface compliance at grid scale, alone.

mod common;

use common::Random;
use nalgebra::{DMatrix, DVector};
use std::f64::consts::PI;
use wheelrail::analytic::contact_modulus;
use wheelrail::contact::line::kernel::{KernelCorrection, REACH};

const NODES: usize = 41;

fn modulus() -> f64 {
    contact_modulus(210e9, 0.3)
}

/// Compliance of two half-planes whose nodal forces are spread over hat functions, as linear elements do, instead of
/// the kernel `1/(n + ½)`: second differences of the antiderivative `x²/2 (ln|x| − 3/2)` of the logarithm. The normal
/// component is stiffer at grid scale by a tenth.
fn spread_over_hats() -> DMatrix<f64> {
    let twice_integrated = |x: f64| if x == 0.0 { 0.0 } else { 0.5 * x * x * (x.abs().ln() - 1.5) };
    let kernel = |k: usize| {
        let x = k as f64;
        let second = twice_integrated(x + 1.0) - 2.0 * twice_integrated(x) + twice_integrated(x - 1.0);
        (10.0 - 2.0 / PI * second) / modulus()
    };
    DMatrix::from_fn(2 * NODES, 2 * NODES, |i, j| {
        let distance = (i / 2).abs_diff(j / 2);
        let own = if i % 2 == 1 && distance == 0 { 0.9 } else { 1.0 };
        if i % 2 == j % 2 { own * kernel(distance) } else { 0.01 / modulus() * (i as f64 - j as f64) }
    })
}

/// The compliance with the correction, half of it from each body.
fn corrected(relative: &DMatrix<f64>) -> (KernelCorrection, DMatrix<f64>) {
    let correction = KernelCorrection::new(relative, modulus());
    let mut surface = relative.clone();
    correction.add_to(&mut surface, 0.5);
    correction.add_to(&mut surface, 0.5);
    (correction, surface)
}

#[test]
fn neighbours_differ_as_on_half_planes_within_reach_and_as_before_beyond() {
    let relative = spread_over_hats();
    let (_, surface) = corrected(&relative);
    let (mut before, mut after) = (0.0f64, 0.0f64);
    for component in 0..2 {
        for node in 0..NODES {
            let entry = |of: &DMatrix<f64>, k: usize| of[(2 * (node + k) + component, 2 * node + component)];
            for k in 0..NODES - 1 - node {
                let half_plane = 2.0 / (PI * modulus()) / (k as f64 + 0.5);
                let difference = |of: &DMatrix<f64>| entry(of, k) - entry(of, k + 1);
                if k < REACH {
                    before = before.max((difference(&relative) / half_plane - 1.0).abs());
                    after = after.max((difference(&surface) / half_plane - 1.0).abs());
                } else {
                    assert_eq!(difference(&surface), difference(&relative), "beyond reach, distance {k}");
                }
            }
        }
    }
    println!("largest relative difference from the half-plane: {before:.1e}, corrected {after:.1e}");
    assert!(before > 0.05, "the sample must need a correction: {before}");
    assert!(after < 1e-12, "{after}");
}

#[test]
fn correction_is_symmetric_and_leaves_normal_and_tangential_uncoupled() {
    let relative = spread_over_hats();
    let addition = corrected(&relative).1 - &relative;
    let scale = addition.amax();
    for i in 0..2 * NODES {
        for j in 0..2 * NODES {
            assert!((addition[(i, j)] - addition[(j, i)]).abs() <= 1e-14 * scale.max(relative[(i, j)].abs()));
            assert!(i % 2 == j % 2 || addition[(i, j)] == 0.0, "components {i} and {j}");
        }
    }
    assert!(scale > 0.0);
}

#[test]
fn energy_of_the_correction_is_half_the_forces_times_their_displacement() {
    let relative = spread_over_hats();
    let (correction, _) = corrected(&relative);
    let mut addition = DMatrix::zeros(2 * NODES, 2 * NODES);
    correction.add_to(&mut addition, 1.0);
    let mut random = Random(7);
    for _ in 0..20 {
        let forces = DVector::from_fn(2 * NODES, |_, _| random.between(-1e5, 1e5));
        let expected = 0.5 * forces.dot(&(&addition * &forces));
        let found = correction.energy(&forces);
        assert!((found - expected).abs() <= 1e-12 * addition.amax() * forces.norm_squared(), "{found}, {expected}");
    }
}
