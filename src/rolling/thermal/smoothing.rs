//! Smoothing of the swelling of a hot layer by its depth.
//!
//! A heat source line at the depth `d` below the surface of a half-plane lifts it by a Poisson kernel, `e^{−|k|d}` at
//! the wavenumber `k` (2(1 + ν) α ∫ T e^{−|k|z} dz; from the thermoelastic potential, J. R. Barber, *Elasticity*, ch.
//! 14). A flash that is much thinner than an element lifts the surface above it; a locked wheel is heated to the depth
//! of several elements, and hot spots narrower than that do not lift it by their own height.

use crate::lru::Lru;
use crate::piecewise::smooth_step;
use std::convert::Infallible;
use std::f64::consts::PI;

/// Depth from which on it matters, and that from which on it does so wholly, in distances of the surface nodes of the contact
/// [1].
const NOTICED: [f64; 2] = [0.24, 0.25];
/// Ratio of the depths for which kernels are made \[1]; between them the result is linear in the logarithm of the depth, within
/// 3e-4 of a wave.
const STEP: f64 = 1.1;

/// Poisson kernels for the positions of one model; only memory, its content follows from the depth asked for.
#[derive(Default)]
pub struct Smoothing {
    /// Weights of the values at all nodes for each node, row by row, by the depth in steps and the number of nodes: each
    /// line of a wheel has its own depth.
    weights: Lru<(i32, usize), Vec<f64>>,
    /// Primitives of the kernel of one node and of its first moment at another one, row by row.
    primitives: Vec<[f64; 2]>,
    /// Values smoothed for the depths on both sides.
    smoothed: [Vec<f64>; 2],
}

impl Smoothing {
    /// Smooths a `share` of `values` at the positions `x` \[m] for heat at the mean `depth` \[m]; `spacing` \[m] is the distance
    /// of the contact nodes. Beyond the ends there is nothing.
    pub fn apply(&mut self, x: &[f64], values: &mut [f64], depth: f64, (spacing, share): (f64, f64)) {
        let noticed = share * smooth_step((depth / spacing - NOTICED[0]) / (NOTICED[1] - NOTICED[0]));
        if noticed == 0.0 || values.len() != x.len() {
            return;
        }
        let place = libm::log(depth) / libm::log(STEP);
        let (shallower, share) = (place.floor() as i32, place - place.floor());
        let Self { weights, primitives, smoothed } = self;
        for (place, smoothed) in (shallower..).zip(&mut *smoothed) {
            let Ok(()) = weights.select((place, x.len()), |weights| {
                set_primitives(primitives, x, STEP.powi(place));
                set_weights(weights, primitives, x);
                Ok::<(), Infallible>(())
            });
            smoothed.clear();
            smoothed.extend(weights.present().chunks_exact(x.len()).map(|row| product(row, values)));
        }
        let [shallower, deeper] = smoothed;
        for (value, (shallower, deeper)) in values.iter_mut().zip(shallower.iter().zip(deeper)) {
            *value += noticed * (*shallower + share * (*deeper - *shallower) - *value);
        }
    }
}

/// Weights of the values at the nodes `x`: exact integrals of the kernel of the `primitives` over the pieces of a piecewise
/// linear function.
fn set_weights(weights: &mut Vec<f64>, primitives: &[[f64; 2]], x: &[f64]) {
    let n = x.len();
    weights.clear();
    weights.resize(n * n, 0.0);
    let rows = weights.chunks_exact_mut(n).zip(primitives.chunks_exact(n));
    for ((row, primitives), &at) in rows.zip(x) {
        for i in 1..n {
            let ([a0, a1], [b0, b1]) = (primitives[i - 1], primitives[i]);
            // ∫ K ds and ∫ K (s − at) ds over the piece.
            let (whole, first) = (b0 - a0, b1 - a1);
            let length = x[i] - x[i - 1];
            let share = (first + (at - x[i - 1]) * whole) / length;
            row[i] += share;
            row[i - 1] += whole - share;
        }
    }
}

/// Primitives of the kernel for the depth `d` and of its first moment between all nodes. They depend on distances only: odd
/// and even, and the same on both sides of the middle where the nodes are.
fn set_primitives(primitives: &mut Vec<[f64; 2]>, x: &[f64], d: f64) {
    let n = x.len();
    primitives.resize(n * n, [0.0; 2]);
    let mirrored = x.iter().zip(x.iter().rev()).all(|(a, b)| *a == -b);
    for at in 0..n {
        let ends = if mirrored { at..n - at } else { at..n };
        for i in ends {
            let s = x[i] - x[at];
            let [odd, even] = [libm::atan(s / d) / PI, 0.5 * d / PI * libm::log(s.powi(2) + d * d)];
            primitives[at * n + i] = [odd, even];
            primitives[i * n + at] = [-odd, even];
            if mirrored {
                let [at, i] = [n - 1 - i, n - 1 - at];
                primitives[at * n + i] = [odd, even];
                primitives[i * n + at] = [-odd, even];
            }
        }
    }
}

/// Scalar product, as sums that do not wait for each other.
fn product(a: &[f64], b: &[f64]) -> f64 {
    const SUMS: usize = 8;
    let (a, b) = (a.chunks_exact(SUMS), b.chunks_exact(SUMS));
    let rest = a.remainder().iter().zip(b.remainder()).map(|(a, b)| a * b).sum::<f64>();
    let mut sums = [0.0; SUMS];
    for (a, b) in a.zip(b) {
        sums.iter_mut().zip(a.iter().zip(b)).for_each(|(sum, (a, b))| *sum += a * b);
    }
    rest + sums.iter().sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `cos kx` under the depth d becomes `e^{−kd} cos kx`, far from the ends.
    #[test]
    fn waves_fade_with_the_depth_of_the_heat() {
        let x: Vec<f64> = (0..=2000).map(|i| 1e-3 * f64::from(i - 1000)).collect();
        for (k, d) in [(40.0, 5e-3), (40.0, 2e-2), (100.0, 1e-2)] {
            let mut values: Vec<f64> = x.iter().map(|x| (k * x).cos()).collect();
            Smoothing::default().apply(&x, &mut values, d, (1e-3, 1.0));
            let expected = (-k * d).exp();
            println!("k d = {}: {} for {expected}", k * d, values[1000]);
            assert!((values[1000] / expected - 1.0).abs() < 0.02);
        }
    }

    #[test]
    fn a_thin_flash_is_left_alone_bit_for_bit() {
        let (x, flash) = (vec![0.0, 1.0, 2.0, 4.0], vec![0.0, 3.0, 1.0, 0.0]);
        let mut values = flash.clone();
        Smoothing::default().apply(&x, &mut values, 0.2, (1.0, 1.0));
        assert_eq!(values, flash);
    }

    /// The weights of nodes that mirror each other are those of nodes that do not, but for the mirror.
    #[test]
    fn nodes_on_both_sides_of_the_middle_have_mirrored_weights() {
        let x = [-3.0, -2.5, -1.0, -0.2, 0.2, 1.0, 2.5, 3.0];
        let weights = |x: &[f64]| {
            let (mut primitives, mut weights) = (Vec::new(), Vec::new());
            set_primitives(&mut primitives, x, 0.7);
            set_weights(&mut weights, &primitives, x);
            weights
        };
        let (mirrored, shifted) = (weights(&x), weights(&x.map(|x| x + 1.0)));
        let pairs = mirrored.iter().zip(&shifted);
        let apart = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        println!("{apart:.1e} apart");
        assert!(apart < 1e-14);
        assert!(mirrored.iter().zip(mirrored.iter().rev()).all(|(a, b)| (a - b).abs() < 1e-14));
    }

    #[test]
    fn depths_in_turn_are_smoothed_as_each_alone_bit_for_bit() {
        let x: Vec<f64> = (-20..=20).map(f64::from).collect();
        let hot: Vec<f64> = x.iter().map(|x| 1.0 / (1.0 + x * x)).collect();
        let smoothed = |smoothing: &mut Smoothing, depth: f64| {
            let mut values = hot.clone();
            smoothing.apply(&x, &mut values, depth, (1.0, 1.0));
            values
        };
        let mut shared = Smoothing::default();
        for depth in (0..60).map(|k| 0.3 + 0.1 * f64::from(k % 20)) {
            assert_eq!(smoothed(&mut shared, depth), smoothed(&mut Smoothing::default(), depth));
        }
    }
}
