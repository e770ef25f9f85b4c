//! Conduction of heat in a spot: both directions in turn, arc – depth – arc (Strang's splitting, second order), each by
//! an L-stable implicit formula of second order. Stable for any step; insulated below and at the sides, where nothing
//! is hot.

use super::mesh::{ConductionLine, SpotMesh};
use crate::linalg::vectorised::vectorised;

/// Coefficient of the two-stage formula [1]: `1 − 1/√2` (Alexander, *SIAM J. Numer. Anal.* 14 (1977)).
const GAMMA: f64 = 1.0 - std::f64::consts::FRAC_1_SQRT_2;
/// Share of the first stage in the beginning of the second one \[1].
const SHARE: f64 = (1.0 - GAMMA) / GAMMA;
/// Lanes are filled up to a multiple of this number with empty ones, so that loops run on full registers.
const PADDING: usize = 4;

/// Memory that steps reuse.
#[derive(Default)]
pub struct ConductionScratch {
    along: Factors,
    across: Factors,
    /// Coefficients of the lanes.
    theta: Vec<f64>,
    /// Temperatures column by column, and layer by layer.
    columns: Vec<f64>,
    layers: Vec<f64>,
    stage: Vec<f64>,
}

/// Factors of `1 − θ L` for the nodes of one direction, each for all lanes: how the node before and the one after act,
/// both over the pivot, and the inverse pivot.
#[derive(Default)]
struct Factors {
    lanes: usize,
    lower: Vec<f64>,
    upper: Vec<f64>,
    inverse: Vec<f64>,
}

/// Advances excess temperatures `values` by `dt` \[s], with heat transfer from the surface to a medium without excess
/// temperature by the coefficient `convection` [W/(m² K)].
pub(super) fn conduct(mesh: &SpotMesh, values: &mut [f64], dt: f64, convection: f64, scratch: &mut ConductionScratch) {
    let (across, along) = (mesh.depth.len(), mesh.arc.len());
    let [deep, wide] = [across, along].map(|lanes| lanes.next_multiple_of(PADDING));
    let theta = GAMMA * dt * mesh.diffusivity();
    let lanes = &mut scratch.theta;
    lanes.clear();
    lanes.extend(mesh.stretch.iter().map(|stretch| 0.5 * theta * stretch));
    lanes.resize(deep, 0.0);
    scratch.along.set(&mesh.along, 0.0, lanes);
    lanes.clear();
    lanes.resize(wide, theta);
    scratch.across.set(&mesh.across, GAMMA * dt * mesh.cooling(convection), lanes);
    let ConductionScratch { columns, layers, stage, .. } = scratch;
    columns.resize(along * deep, 0.0);
    layers.resize(across * wide, 0.0);
    for (column, values) in columns.chunks_exact_mut(deep).zip(values.chunks_exact(across)) {
        column[..across].copy_from_slice(values);
    }
    scratch.along.advance(columns, stage);
    transpose([columns, layers], [deep, wide], along);
    scratch.across.advance(layers, stage);
    transpose([layers, columns], [wide, deep], across);
    scratch.along.advance(columns, stage);
    for (column, values) in columns.chunks_exact(deep).zip(values.chunks_exact_mut(across)) {
        values.copy_from_slice(&column[..across]);
    }
}

/// Writes the first `count` rows of one matrix to the columns of the other one; `widths` are the lengths of their rows.
fn transpose([from, to]: [&mut Vec<f64>; 2], widths: [usize; 2], count: usize) {
    let from = from.chunks_exact(widths[0]).take(count);
    for (at, row) in from.enumerate() {
        to[at..].iter_mut().step_by(widths[1]).zip(row).for_each(|(to, value)| *to = *value);
    }
}

impl Factors {
    /// Factors of a line with a sink at its first node, with the coefficients `theta` of the lanes.
    fn set(&mut self, line: &ConductionLine, sink: f64, theta: &[f64]) {
        let Self { lanes, lower, upper, inverse } = self;
        *lanes = theta.len();
        for values in [&mut *lower, upper, inverse] {
            values.resize(line.lower.len() * theta.len(), 0.0);
        }
        factorise([&line.lower, &line.upper], sink, theta, [lower, upper, inverse]);
    }

    /// Two stages: the second starts from the result of the first.
    fn advance(&self, values: &mut [f64], stage: &mut Vec<f64>) {
        let factors = [&self.lower[..], &self.upper, &self.inverse];
        let lanes = self.lanes;
        stage.clear();
        stage.extend_from_slice(values);
        solve(factors, stage, lanes);
        values.iter_mut().zip(&*stage).for_each(|(value, stage)| *value += SHARE * (stage - *value));
        solve(factors, values, lanes);
    }
}

vectorised! {
    /// Fills the factors of all nodes for the lanes with the coefficients `theta`.
    fn factorise<'a, S>(
        simd,
        line: [&'a [f64]; 2],
        sink: f64,
        theta: &'a [f64],
        factors: [&'a mut [f64]; 3],
    ) {
        let theta = S::as_simd_f64s(theta).0;
        let [lower, upper, inverse] = factors.map(|factors| S::as_mut_simd_f64s(factors).0);
        let (k, one) = (theta.len(), simd.splat_f64s(1.0));
        let mut first = simd.splat_f64s(1.0 + sink);
        for (node, (&below, &above)) in line[0].iter().zip(line[1]).enumerate() {
            let [below, above] = [below, above].map(|coefficient| simd.splat_f64s(coefficient));
            for (q, &theta) in theta.iter().enumerate() {
                let at = node * k + q;
                let before = if node > 0 { upper[at - k] } else { simd.splat_f64s(0.0) };
                let [below, above] = [below, above].map(|coefficient| simd.mul_f64s(theta, coefficient));
                let sum = simd.add_f64s(simd.add_f64s(first, below), above);
                let pivot = simd.div_f64s(one, simd.sub_f64s(sum, simd.mul_f64s(below, before)));
                (lower[at], upper[at]) = (simd.mul_f64s(below, pivot), simd.mul_f64s(above, pivot));
                inverse[at] = pivot;
            }
            first = one;
        }
    }
}

vectorised! {
    /// Replaces `values` by the solution of `(1 − θ L) x = values`.
    fn solve<'a, S>(simd, factors: [&'a [f64]; 3], values: &'a mut [f64], lanes: usize) {
        let [lower, upper, inverse] = factors.map(|factors| S::as_simd_f64s(factors).0);
        let (x, k) = (S::as_mut_simd_f64s(values).0, lanes / S::F64_LANES);
        let none = simd.splat_f64s(0.0);
        for (node, (lower, inverse)) in lower.chunks_exact(k).zip(inverse.chunks_exact(k)).enumerate() {
            let (done, rest) = x.split_at_mut(node * k);
            let before = done.len().checked_sub(k).map_or(&[][..], |first| &done[first..]);
            for (q, ((x, &lower), &inverse)) in rest.iter_mut().zip(lower).zip(inverse).enumerate() {
                let before = before.get(q).copied().unwrap_or(none);
                *x = simd.mul_add_e_f64s(lower, before, simd.mul_f64s(*x, inverse));
            }
        }
        for (node, upper) in upper.chunks_exact(k).enumerate().rev().skip(1) {
            let (now, after) = x.split_at_mut((node + 1) * k);
            for ((x, &after), &upper) in now[node * k..].iter_mut().zip(&*after).zip(upper) {
                *x = simd.mul_add_e_f64s(upper, after, *x);
            }
        }
    }
}
