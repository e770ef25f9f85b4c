//! Conduction of heat in a spot: both directions in turn, arc – depth – arc (Strang's splitting, second order), each by
//! an L-stable implicit formula of second order. Stable for any step; insulated below and at the sides, where nothing
//! is hot.

use super::mesh::{ConductionLine, SpotMesh};
use crate::linalg::vectorised::vectorised;
use std::ops::Range;

/// Coefficient of the two-stage formula [1]: `1 − 1/√2` (Alexander, *SIAM J. Numer. Anal.* 14 (1977)).
const GAMMA: f64 = 1.0 - std::f64::consts::FRAC_1_SQRT_2;
/// Share of the first stage in the beginning of the second one \[1].
const SHARE: f64 = (1.0 - GAMMA) / GAMMA;
/// Lanes are filled up to a multiple of this number with empty ones, so that loops run on full registers.
const PADDING: usize = 4;
/// Share of a temperature that conduction along the tread may carry past the columns that a step leaves out \[1].
const CARRIED: f64 = 1e-13;

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
/// temperature by the coefficient `convection` [W/(m² K)]. The `columns` conduct as if they were alone.
pub(super) fn conduct(
    mesh: &SpotMesh,
    values: &mut [f64],
    columns: Range<usize>,
    dt: f64,
    convection: f64,
    scratch: &mut ConductionScratch,
) {
    let (across, along) = (mesh.depth.len(), columns.len());
    let values = &mut values[columns.start * across..columns.end * across];
    let [deep, wide] = [across, along].map(|lanes| lanes.next_multiple_of(PADDING));
    let theta = GAMMA * dt * mesh.diffusivity();
    let lanes = &mut scratch.theta;
    lanes.clear();
    lanes.extend(mesh.stretch.iter().map(|stretch| 0.5 * theta * stretch));
    lanes.resize(deep, 0.0);
    scratch.along.set(&mesh.along, columns, 0.0, lanes);
    lanes.clear();
    lanes.resize(wide, theta);
    scratch.across.set(&mesh.across, 0..across, GAMMA * dt * mesh.cooling(convection), lanes);
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

/// Columns that must conduct in a step of `dt` \[s] where those of `known` are not asked for: all others, and as many
/// of these as reach them. The second range is empty if it is all of them.
pub(super) fn beside(mesh: &SpotMesh, known: &Range<usize>, dt: f64) -> [Range<usize>; 2] {
    let (line, count) = (&mesh.along, mesh.arc.len());
    let largest = |values: &[f64]| values.iter().fold(0.0, |most: f64, value| most.max(*value));
    let theta = 0.5 * GAMMA * dt * mesh.diffusivity() * largest(&mesh.stretch);
    let link = theta * largest(&line.lower).max(largest(&line.upper));
    // From node to node of `1 − θ L` an influence falls to less than this.
    let passed = link / (1.0 + link);
    let reach = (libm::log(CARRIED) / libm::log(passed)).ceil().min(count as f64) as usize;
    let (low, high) = (known.start + reach, known.end.saturating_sub(reach));
    if low < high { [0..low, high..count] } else { [0..count, count..count] }
}

/// Writes the first `count` rows of one matrix to the columns of the other one; `widths` are the lengths of their rows.
fn transpose([from, to]: [&mut Vec<f64>; 2], widths: [usize; 2], count: usize) {
    let from = from.chunks_exact(widths[0]).take(count);
    for (at, row) in from.enumerate() {
        to[at..].iter_mut().step_by(widths[1]).zip(row).for_each(|(to, value)| *to = *value);
    }
}

impl Factors {
    /// Factors of the `nodes` of a line with a sink at the first one, with the coefficients `theta` of the lanes.
    fn set(&mut self, line: &ConductionLine, nodes: Range<usize>, sink: f64, theta: &[f64]) {
        let Self { lanes, lower, upper, inverse } = self;
        *lanes = theta.len();
        for values in [&mut *lower, upper, inverse] {
            values.resize(nodes.len() * theta.len(), 0.0);
        }
        let links = [&line.lower, &line.upper].map(|links| &links[nodes.clone()]);
        factorise(links, sink, theta, [lower, upper, inverse]);
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
        let (k, one, last) = (theta.len(), simd.splat_f64s(1.0), line[0].len() - 1);
        let mut first = simd.splat_f64s(1.0 + sink);
        for (node, (&below, &above)) in line[0].iter().zip(line[1]).enumerate() {
            // The ends are insulated.
            let below = simd.splat_f64s(if node > 0 { below } else { 0.0 });
            let above = simd.splat_f64s(if node < last { above } else { 0.0 });
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

#[cfg(test)]
mod tests {
    use super::super::mesh::SpotLayout;
    use super::*;

    #[test]
    fn columns_beside_known_ones_conduct_as_in_the_whole_place() {
        let layout = SpotLayout {
            radius: 0.46,
            hub_radius: 0.15,
            half_width: 6e-3,
            zone: 12e-3,
            conductivity: 45.0,
            heat_capacity: 3.6e6,
            convection: 20.0,
            reference: 293.0,
            resolution: 1.0,
        };
        let mesh = SpotMesh::new(&layout);
        let layers = mesh.depth.len();
        let hot = |arc: f64, depth: f64| 1200.0 * (-(arc / 9e-3).powi(2) - depth / 1e-3).exp();
        let field: Vec<f64> = mesh.arc.iter().flat_map(|&x| mesh.depth.iter().map(move |&z| hot(x, z))).collect();
        let known = mesh.arc.partition_point(|x| *x < -12e-3)..mesh.arc.partition_point(|x| *x <= 12e-3);
        for (dt, fewer) in [(1e-5, true), (1e-3, true), (10.0, false)] {
            let (mut whole, mut parts, mut scratch) = (field.clone(), field.clone(), ConductionScratch::default());
            conduct(&mesh, &mut whole, 0..mesh.arc.len(), dt, 300.0, &mut scratch);
            let beside = beside(&mesh, &known, dt);
            let count: usize = beside.iter().map(Range::len).sum();
            for columns in beside.into_iter().filter(|columns| !columns.is_empty()) {
                conduct(&mesh, &mut parts, columns, dt, 300.0, &mut scratch);
            }
            let outside = (0..whole.len()).filter(|node| !known.contains(&(node / layers)));
            let apart = outside.map(|node| (whole[node] - parts[node]).abs()).fold(0.0, f64::max);
            println!("{dt} s: {count} of {} columns, {apart:.1e} K apart", mesh.arc.len());
            assert!(apart < 1e-9 && (count < mesh.arc.len()) == fewer);
        }
    }
}
