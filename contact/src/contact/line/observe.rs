//! Traction read off a solution on the grid. It varies smoothly while the contact edges move between nodes.

use super::grid::ContactGrid;
use super::slip_zone::{NodalFriction, SlipZone};
use super::state::{GridState, NodeStatus, for_each_patch};
use super::streamline::edge_offset;
use super::strength::Strength;
use crate::contact::traction::Traction;
use crate::piecewise::{Interval, Piecewise};
use nalgebra::DVector;
use std::ops::Range;

/// Share of the peak above which nodes beside it take part in the fit of the pressure maximum [1].
const PEAK: f64 = 0.9;
/// Ratio of the two outermost nodal pressures below which the outer node is fading out [1].
const FADING: f64 = 0.2;
/// Distance of an edge, over the length of the patch, from which it does not tell on the other one \[1].
const FAR: f64 = 1e6;
/// Least distance of the end of a profile from the outermost node of a patch [spacings].
const MARGIN: f64 = 1e-3;

/// Fills patches, profiles and peaks in `traction` from forces and friction coefficient, for the `power` of
/// friction [W/m] and the largest pressure `limit` that the steel bears anywhere \[Pa], and the slip velocities of the
/// candidates with centred differences, along and across [m/s]. `coefficient`: the friction that a candidate can bear over its
/// normal force \[1]; `to_right`: the material arrives from `+x`.
pub fn read_off(
    grid: &ContactGrid,
    ([power, limit], coefficient): ([f64; 2], &dyn Fn(usize) -> f64),
    (state, to_right): (&GridState, bool),
    [centred_slip, centred_across]: [&[f64]; 2],
    traction: &mut Traction,
) {
    let forces = &state.forces;
    let tangential = |i: usize| forces[grid.component(i)];
    let lateral = |i: usize| state.lateral.get(i).copied().unwrap_or(0.0);
    let normal = |i: usize| forces[grid.component(i) + 1];
    traction.pressure_max = pressure_peak(grid, &state.yielded, normal, limit);
    traction.edges.clear();
    traction.conducting.clear();
    traction.patches.clear();
    let (mut length, mut stuck, mut zone) = (0.0, 0.0, None);
    let friction = NodalFriction { grid, state, coefficient, to_right };
    for_each_patch(&state.status, |run| {
        let apart = edges_apart(grid, normal, &run);
        traction.edges.push(edges(grid, normal, &run, apart));
        traction.conducting.push(apart);
        let patch = stretch(grid, apart, &run);
        traction.patches.push(patch);
        length += 2.0 * patch.half_length();
        zone = SlipZone::of(&friction, &run, patch);
        stuck += friction.stick_length(run, patch);
    });
    traction.stick_fraction = if length > 0.0 { (stuck / length).clamp(0.0, 1.0) } else { 0.0 };

    let (patches, status) = (&traction.patches, &state.status);
    over_patches(grid, status, patches, |i| normal(i) / grid.width(i), &mut traction.pressure);
    let zone = zone.filter(|_| patches.len() == 1);
    over_patches(grid, status, patches, |i| tangential(i) / grid.width(i), &mut traction.shear);
    // Central differences across the end of stick leave a little slip at nodes that stick.
    let slips = |slip: &[f64], profile: &mut Piecewise| match &zone {
        Some(zone) => zone.slip(grid, |i| slip[i], profile),
        None => over_patches(grid, status, patches, |i| if status[i].is_stuck() { 0.0 } else { slip[i] }, profile),
    };
    slips(centred_slip, &mut traction.slip);
    if state.directions() > 1 {
        over_patches(grid, status, patches, |i| lateral(i) / grid.width(i), &mut traction.lateral_shear);
        slips(centred_across, &mut traction.lateral_slip);
    }
    let across = |i: usize| if state.directions() > 1 { lateral(i) * centred_across[i] } else { 0.0 };
    heat(&friction, zone, patches, &mut traction.friction.dissipation);
    traction.friction.dissipation.scale_to(power, &traction.pressure);
    traction.scale_slip((0..grid.len()).map(|i| tangential(i) * centred_slip[i] + across(i)).sum());
}

/// Writes the profile of friction's power, but for a factor: that of the slip `zone` of a single patch, or from node to node.
/// The upwind slip knows where friction acts, the centred one how much it dissipates. What is left of the slip at stuck
/// nodes is round-off: it would place the heat of a contact that sticks everywhere at random.
fn heat(friction: &NodalFriction, zone: Option<SlipZone>, patches: &[Interval], dissipation: &mut Piecewise) {
    let NodalFriction { grid, state, .. } = *friction;
    let density = |i: usize| match state.status[i] {
        NodeStatus::SlipForward | NodeStatus::SlipBackward => {
            let [along, across] = friction.force(i);
            let across = state.slip[1].get(i).map_or(0.0, |slip| across * slip);
            (-(along * state.slip[0][i] + across) / grid.width(i)).max(0.0)
        }
        NodeStatus::Stick | NodeStatus::Open => 0.0,
    };
    let of_nodes = (state.directions() > 1).then_some(density);
    if !zone.is_some_and(|zone| zone.power(grid, of_nodes, dissipation)) {
        over_patches(grid, &state.status, patches, density, dissipation);
    }
}

/// Fills the yielding part of `traction` from the depths `overlap` by which candidates have given way [m].
pub(in crate::contact) fn overlap(grid: &ContactGrid, state: &GridState, overlap: &[f64], traction: &mut Traction) {
    traction.yielding.overlap.clear();
    let closed = state.status.iter().filter(|s| s.is_active()).count();
    let yielding = state.yielded.iter().filter(|yields| **yields).count();
    traction.yielding.share = if closed > 0 { yielding as f64 / closed as f64 } else { 0.0 };
    let first = state.yielded.iter().position(|yields| *yields);
    let (Some(first), Some(last)) = (first, state.yielded.iter().rposition(|yields| *yields)) else { return };
    let stretch = first.saturating_sub(1)..(last + 2).min(grid.len());
    for (x, depth) in grid.x[stretch.clone()].iter().zip(&overlap[stretch]) {
        traction.yielding.overlap.push(*x, depth.max(0.0));
    }
}

/// Share of the width of the closed candidates on which a molten film takes friction away \[1].
pub(in crate::contact) fn under_film(grid: &ContactGrid, state: &GridState, strength: &Strength) -> f64 {
    let closed = (0..grid.len()).filter(|&i| state.status[i].is_active());
    let [molten, all] = closed.fold([0.0; 2], |[molten, all], i| {
        let width = grid.width(i);
        [molten + if strength.is_molten(i) { width } else { 0.0 }, all + width]
    });
    if all > 0.0 { molten / all } else { 0.0 }
}

/// Work [J/m] that yielding candidates would give back if none of their depth `overlap` \[m] stayed. Their force rises
/// with the depth from the `limit` on [N/m] and falls with it again, so that the work is that of the mean of both.
pub(in crate::contact) fn springing_work(
    grid: &ContactGrid,
    overlap: &[f64],
    limit: &[f64],
    forces: &DVector<f64>,
) -> f64 {
    let mean = |i: usize, limit: f64| 0.5 * (limit + forces[grid.component(i) + 1]);
    let of_node = |(i, (depth, limit)): (usize, (&f64, &f64))| if *depth > 0.0 { depth * mean(i, *limit) } else { 0.0 };
    overlap.iter().zip(limit).enumerate().map(of_node).sum()
}

/// Edges of a run of closed nodes below grid scale, from the ratio of its outermost nodal pressures, as if the other edge were
/// far away.
fn edges_apart(grid: &ContactGrid, normal: impl Fn(usize) -> f64, run: &Range<usize>) -> Interval {
    let (low, high) = (grid.x[run.start], grid.x[run.end - 1]);
    let far = FAR * (high - low + grid.spacing);
    edges(grid, normal, run, Interval { low: low - far, high: high + far })
}

/// Edges of a run of closed nodes, given where each has its other one, `far`. Where a patch has few nodes, its other edge bends
/// the pressure down, too: over the root of the distance to that edge it rises as at the edge of a long patch, for a
/// Hertzian one exactly.
fn edges(grid: &ContactGrid, normal: impl Fn(usize) -> f64, run: &Range<usize>, far: Interval) -> Interval {
    let (first, last) = (run.start, run.end - 1);
    let pressure = |i: Option<usize>, opposite: f64| {
        let rises = |i: usize| normal(i) * grid.share(i) / (grid.x[i] - opposite).abs().sqrt();
        i.filter(|i| run.contains(i)).map_or(0.0, rises)
    };
    let offset = |nodes: [Option<usize>; 3], outwards: bool, opposite: f64| {
        let edge = if outwards { last } else { first };
        let [outer, inner, next] = nodes.map(|i| pressure(i, opposite));
        grid.cells_beside(edge, outwards)[0] * continuous_offset(outer, inner, next)
    };
    Interval {
        low: grid.x[first] - offset([0, 1, 2].map(|k| first.checked_add(k)), false, far.high),
        high: grid.x[last] + offset([0, 1, 2].map(|k| last.checked_sub(k)), true, far.low),
    }
}

/// Distance of the contact edge beyond the outermost of three nodes [cells]. As the pressure of that node vanishes, the
/// edge tends to where it is without it, whatever the shape of the pressure; for a Hertzian one it does so by itself.
fn continuous_offset(edge: f64, inner: f64, next: f64) -> f64 {
    let own = edge_offset(edge, inner);
    let ratio = if inner > 0.0 { (edge / inner).max(0.0) } else { 1.0 };
    if ratio >= FADING || next <= 0.0 {
        return own;
    }
    let jump = edge_offset(inner, next) - 1.0 - edge_offset(0.0, inner);
    own + (1.0 - ratio / FADING) * jump
}

/// The patch of a run of closed nodes with these edges. An edge up to a quarter of a cell inside the outermost node is
/// moved just beyond it, so that the force of that node acts, heats and conducts within the patch.
fn stretch(grid: &ContactGrid, edges: Interval, run: &Range<usize>) -> Interval {
    let margin = MARGIN * grid.spacing;
    Interval { low: edges.low.min(grid.x[run.start] - margin), high: edges.high.max(grid.x[run.end - 1] + margin) }
}

/// Writes a nodal quantity as a profile over all patches that falls to zero at their ends.
fn over_patches(
    grid: &ContactGrid,
    status: &[NodeStatus],
    patches: &[Interval],
    value: impl Fn(usize) -> f64,
    profile: &mut Piecewise,
) {
    profile.clear();
    let mut patches = patches.iter();
    for_each_patch(status, |run| {
        let Some(patch) = patches.next() else { return };
        profile.push(patch.low, 0.0);
        run.for_each(|i| profile.push(grid.x[i], value(i)));
        profile.push(patch.high, 0.0);
    });
}

/// Largest pressure [Pa] from the parabola through the squared nodal pressures around the largest one, at most the
/// `limit`: for the elliptic pressure of a Hertzian patch it is exact. Where the largest pressure is a node's, it is
/// that: where steel `yields` pressures follow its strength from node to node, and a parabola through a skewed peak
/// passes below it.
fn pressure_peak(grid: &ContactGrid, yields: &[bool], normal: impl Fn(usize) -> f64, limit: f64) -> f64 {
    let pressure = |i: usize| normal(i) / grid.width(i);
    let Some(top) = (0..grid.len()).max_by(|&a, &b| pressure(a).total_cmp(&pressure(b))) else { return 0.0 };
    let peak = pressure(top).max(0.0);
    let beside = |i: usize| (pressure(i) > PEAK * peak || i.abs_diff(top) <= 1) && pressure(i) > 0.0;
    let first = (0..top).rev().take_while(|&i| beside(i)).last().unwrap_or(top);
    let last = (top + 1..grid.len()).take_while(|&i| beside(i)).last().unwrap_or(top);
    if (first..=last).any(|i| yields.get(i) == Some(&true)) {
        return peak;
    }
    let samples = (first..=last).map(|i| ((grid.x[i] - grid.x[top]) / grid.spacing, pressure(i).powi(2)));
    parabola_peak(samples).map_or(peak, |squared| squared.sqrt().min(limit).max(peak))
}

/// Maximum of the least-squares parabola through `(x, y)` if it lies between them.
fn parabola_peak(samples: impl Iterator<Item = (f64, f64)>) -> Option<f64> {
    let mut normal = nalgebra::Matrix3::<f64>::zeros();
    let mut rhs = nalgebra::Vector3::<f64>::zeros();
    let (mut count, mut ends) = (0, [f64::INFINITY, f64::NEG_INFINITY]);
    for (x, y) in samples {
        let row = nalgebra::Vector3::new(1.0, x, x * x);
        normal += row * row.transpose();
        rhs += row * y;
        ends = [ends[0].min(x), ends[1].max(x)];
        count += 1;
    }
    if count < 3 {
        return None;
    }
    let c = normal.lu().solve(&rhs)?;
    let at = -0.5 * c[1] / c[2];
    (c[2] < 0.0 && at >= ends[0] && at <= ends[1]).then(|| c[0] + 0.5 * c[1] * at).filter(|p| *p > 0.0)
}
