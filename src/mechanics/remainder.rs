//! Compliance of a body less that of a half-plane, on surface nodes: it varies over the size of the body. Theory:
//! `docs/theory/kernel-correction.md`.

use super::reduction::{ReducedBasis, scale_columns};
use crate::analytic::{HalfPlane, digamma};
use crate::linalg::dense::symmetrise;
use nalgebra::DMatrix;

/// Nodes within which the compliance of finite elements is not yet that of the elastic body.
pub(super) const NEAR: usize = 8;

impl ReducedBasis {
    /// Static displacements of the surface nodes by forces on them, x and y of every node [m/(N/m)].
    pub(super) fn compliance(&self) -> DMatrix<f64> {
        let weighted = scale_columns(&self.shapes, &self.squared_frequencies.map(f64::recip));
        let mut compliance = self.residual.clone();
        compliance.gemm(1.0, &weighted, &self.shapes.transpose(), 1.0);
        compliance
    }
}

/// Displacements that finite elements lack between all nodes `x` \[m], whose static `compliance` has the components x and y
/// of every node: what the [`remainder`] leaves out [m/(N/m)].
pub(super) fn missing(compliance: &DMatrix<f64>, x: &[f64], half_plane: HalfPlane, side: f64) -> DMatrix<f64> {
    let mut missing = from_components(x.len(), |(c, d)| {
        let rest = remainder(compliance, (c, d), x, half_plane, side);
        DMatrix::from_fn(x.len(), x.len(), |i, j| {
            let corrected = rest[(i, j)] + nodal(half_plane, (c, d), x, (i, j), side);
            corrected - compliance[(2 * i + c, 2 * j + d)]
        })
    });
    symmetrise(&mut missing);
    missing
}

/// Matrix between the components x and y of `n` nodes, from those between components of all nodes.
pub(super) fn from_components(n: usize, of: impl Fn((usize, usize)) -> DMatrix<f64>) -> DMatrix<f64> {
    let mut whole = DMatrix::zeros(2 * n, 2 * n);
    for (c, d) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
        let part = of((c, d));
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            whole[(2 * i + c, 2 * j + d)] = part[(i, j)];
        }
    }
    whole
}

/// Rest of a `compliance` between all nodes `x` \[m]: displacement in direction `c` by forces in direction `d`, less
/// that of a half-plane which lies above its surface (`side` 1) or below it (−1), without the error of finite elements
/// between near nodes [m/(N/m)].
pub(super) fn remainder(
    compliance: &DMatrix<f64>,
    (c, d): (usize, usize),
    x: &[f64],
    half_plane: HalfPlane,
    side: f64,
) -> DMatrix<f64> {
    let mut rest = DMatrix::from_fn(x.len(), x.len(), |i, j| {
        compliance[(2 * i + c, 2 * j + d)] - nodal(half_plane, (c, d), x, (i, j), side)
    });
    level(&mut rest);
    rest
}

/// Displacement `component` of a half-plane at node i by a unit force in direction `force` at node j of `nodes` \[m], but
/// for a constant [m/(N/m)]: where nodes lie n apart along each axis `−κ (ψ(n + ½) + ln h)` with the digamma function ψ
/// and the mean distance h of the nodes between both, whose differences on a uniform grid are those of the discrete
/// kernel `1/(n + ½)`.
pub(super) fn nodal(
    half_plane: HalfPlane,
    (component, force): (usize, usize),
    nodes: &[f64],
    (i, j): (usize, usize),
    side: f64,
) -> f64 {
    let n = i.abs_diff(j);
    if component != force {
        return if n == 0 { 0.0 } else { half_plane.displacement(component, force, nodes[i] - nodes[j], side) };
    }
    let spacing = match n {
        0 => {
            let (before, after) = (i.saturating_sub(1), (i + 1).min(nodes.len() - 1));
            (nodes[after] - nodes[before]) / (after - before).max(1) as f64
        }
        n => (nodes[i] - nodes[j]).abs() / n as f64,
    };
    -half_plane.kernel * (digamma(n as f64 + 0.5) + libm::log(spacing))
}

/// Takes from `rest`, the compliance less that of a half-plane, the error of finite elements between near nodes: there it
/// becomes a straight line between the values of the middle column at both ends of [`NEAR`].
fn level(rest: &mut DMatrix<f64>) {
    let n = rest.nrows();
    let middle = n / 2;
    let near = NEAR.min(middle).min(n - 1 - middle);
    let at = |k: isize| rest[(middle.saturating_add_signed(k), middle)];
    let (low, high) = (at(-(near as isize)), at(near as isize));
    let error = |k: isize| at(k) - 0.5 * (low + high) - 0.5 * (high - low) * k as f64 / near.max(1) as f64;
    let errors: Vec<f64> = (1 - near as isize..near as isize).map(error).collect();
    for i in 0..n {
        for j in i.saturating_sub(near - 1)..(i + near).min(n) {
            rest[(i, j)] -= errors[i + near - 1 - j];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NODES: usize = 41;
    const SPACING: f64 = 2e-4;

    /// Compliance of a half-plane whose nodal forces are spread over hat functions, as linear elements do, instead of the
    /// kernel `1/(n + ½)`: second differences of the antiderivative `x²/2 (ln|x| − 3/2)` of the logarithm. The normal
    /// component is stiffer at grid scale by a tenth.
    fn spread_over_hats(half_plane: HalfPlane) -> DMatrix<f64> {
        let twice_integrated = |x: f64| if x == 0.0 { 0.0 } else { 0.5 * x * x * (x.abs().ln() - 1.5) };
        let along = |n: usize| {
            let x = n as f64;
            let second = twice_integrated(x + 1.0) - 2.0 * twice_integrated(x) + twice_integrated(x - 1.0);
            half_plane.kernel * (10.0 - second)
        };
        DMatrix::from_fn(2 * NODES, 2 * NODES, |i, j| {
            let distance = SPACING * (i as f64 / 2.0).floor() - SPACING * (j as f64 / 2.0).floor();
            let own = if i % 2 == 1 && i == j { 0.9 } else { 1.0 };
            match (i % 2 == j % 2, i / 2 == j / 2) {
                (true, _) => own * along((i / 2).abs_diff(j / 2)),
                (false, true) => 0.0,
                (false, false) => half_plane.displacement(i % 2, j % 2, distance, 1.0),
            }
        })
    }

    #[test]
    fn neighbours_differ_as_on_a_half_plane_where_elements_are_too_coarse_and_as_before_beyond() {
        let half_plane = HalfPlane { kernel: 3e-12, coupling: 1e-12 };
        let x: Vec<f64> = (0..NODES).map(|i| SPACING * i as f64).collect();
        let before = spread_over_hats(half_plane);
        let missing = missing(&before, &x, half_plane, 1.0);
        let after = &before + &missing;
        let mut worst = [0.0_f64; 2];
        for component in 0..2 {
            for node in 0..NODES {
                let entry = |of: &DMatrix<f64>, k: usize| of[(2 * (node + k) + component, 2 * node + component)];
                for k in 0..NODES - 1 - node {
                    let kernel = half_plane.kernel / (k as f64 + 0.5);
                    let difference = |of: &DMatrix<f64>| entry(of, k) - entry(of, k + 1);
                    if k < NEAR {
                        let error = |of| (difference(of) / kernel - 1.0).abs();
                        worst = [worst[0].max(error(&before)), worst[1].max(error(&after))];
                    } else {
                        assert_eq!(difference(&after), difference(&before), "{k} nodes apart");
                    }
                }
            }
        }
        println!("largest relative difference from the half-plane: {:.1e}, corrected {:.1e}", worst[0], worst[1]);
        assert!(worst[0] > 0.05, "the sample must need a correction: {worst:?}");
        assert!(worst[1] < 1e-11, "{worst:?}");
        assert_eq!(missing, missing.transpose());
        let coupled = (0..2 * NODES).flat_map(|i| (0..2 * NODES).map(move |j| (i, j))).filter(|(i, j)| i % 2 != j % 2);
        assert!(coupled.map(|at| missing[at].abs()).fold(0.0, f64::max) < 1e-12 * half_plane.kernel);
    }
}
