//! Compliance of a body less that of a half-plane, on surface nodes: it varies over the size of the body. Theory:
//! `docs/theory/kernel-correction.md`.

use super::reduction::{ReducedBasis, scale_columns};
use crate::analytic::{HalfPlane, digamma};
use nalgebra::DMatrix;

/// Nodes within which the compliance of finite elements is not yet that of the elastic body.
const NEAR: usize = 8;

impl ReducedBasis {
    /// Static displacements of the surface nodes by forces on them, x and y of every node [m/(N/m)].
    pub(super) fn compliance(&self) -> DMatrix<f64> {
        let weighted = scale_columns(&self.shapes, &self.squared_frequencies.map(f64::recip));
        let mut compliance = self.residual.clone();
        compliance.gemm(1.0, &weighted, &self.shapes.transpose(), 1.0);
        compliance
    }
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
