//! New states of the nodes from forces, gaps and slips.
//!
//! - A node is closed if `λ_n − c g > 0`.
//! - A stuck node slips when `|λ_t| > μ λ_n`, and so does a [brake](crate::contact::brake) beyond its strength; a
//!   slipping node whose friction force no longer opposes the slip sticks, so that a reversal of slip always passes
//!   through stick; a node that closes takes the state of its nearest closed neighbour and sticks where it has none,
//!   unless the surfaces run against each other. Without these rules the iteration cycles.

use crate::contact::line::contact_line::ContactLine;
use crate::contact::line::state::{GridState, NodeStatus};

/// Tolerance of nodal forces in mean nodal loads, at first and at most.
const FORCE_TOLERANCE: [f64; 2] = [1e-9, 1e-4];
/// Tolerance of slip velocities in rolling speeds, at first and at most.
const SLIP_TOLERANCE: [f64; 2] = [1e-12, 1e-8];
/// Slip velocity of stuck nodes that is round-off: in rolling speeds \[1], in displacements over the step \[1], and in
/// any case [m/s]. Measured with steps of 1 to 10 µs at 2 mm/s: 1e-12 of the displacements over the step.
const SLIP_ROUND_OFF: [f64; 3] = [1e-9, 1e-11, 1e-13];
/// Stuck nodes that carry more than this multiple of the friction they can bear say nothing about pressures and gaps
/// yet.
const OVERLOAD: f64 = 3.0;

/// Rules by which one update of the states goes.
pub(super) struct Rules {
    /// Stiffness that compares gaps with forces [N/m per m].
    penalty: f64,
    /// Tolerance of nodal forces [N/m].
    pub force: f64,
    /// Tolerance of slip velocities [m/s].
    slip: f64,
    /// True if nodes that close found patches of their own.
    founding: bool,
}

impl Rules {
    /// Rules whose tolerances have grown by `growth` from their smallest; `load`: nominal line load [N/m].
    pub fn new(line: &ContactLine, penalty: f64, load: f64, growth: f64, founding: bool) -> Self {
        let share = load / line.grid.len() as f64;
        let force = (FORCE_TOLERANCE[0] * growth).min(FORCE_TOLERANCE[1]) * share;
        let slip = (SLIP_TOLERANCE[0] * growth).min(SLIP_TOLERANCE[1]) * line.speed();
        Self { penalty, force, slip, founding }
    }
}

/// Stiffness of the node in the middle [N/m per m].
pub(super) fn penalty(line: &ContactLine) -> f64 {
    let shared = line.problem.bodies.shared.relative;
    let (node, mut by_bodies) = (line.grid.nodes().len() / 2, 0.0);
    let values = &line.grid.values[node];
    for (k, at) in values.iter().enumerate() {
        let of_points = values.iter().enumerate().map(|(l, by)| shared[(2 * k + 1, 2 * l + 1)] * by);
        by_bodies += at * of_points.sum::<f64>();
    }
    1.0 / (2.0 * line.alone().by_force(1, node, node) + line.problem.share * by_bodies)
}

/// Takes new states of all nodes, or of the `last` one alone that is wrong; returns whether any changed. `before` is
/// memory for the states before.
pub(super) fn update(line: &mut ContactLine, rules: &Rules, last: bool, before: &mut Vec<NodeStatus>) -> bool {
    before.clone_from(&line.state.status);
    let overloaded = !last && is_overloaded(line);
    let mut changed = false;
    for i in (0..line.grid.len()).rev() {
        let new = new_state(line, i, rules, overloaded, last, before);
        let yields = new.is_active() && yields(line, i, rules.force);
        changed |= new != before[i] || yields != line.state.yielded[i];
        line.state.status[i] = new;
        line.state.yielded[i] = yields;
        if last && changed {
            break;
        }
    }
    changed
}

/// New state of a node. Where stuck nodes are `overloaded`, closed nodes stay closed and open ones open. Where nodes change
/// `one_by_one`, a stuck one slips before it opens: shear beyond friction may be what pulls at it, and it would close again.
fn new_state(
    line: &ContactLine,
    i: usize,
    rules: &Rules,
    overloaded: bool,
    one_by_one: bool,
    before: &[NodeStatus],
) -> NodeStatus {
    let old = before[i];
    let indicator = line.normal(i) - rules.penalty * line.state.gap[i];
    let closed = if overloaded || indicator.abs() <= rules.force { old.is_active() } else { indicator > 0.0 };
    match (closed, old) {
        (false, NodeStatus::Stick) if one_by_one => stuck_state(line, i, rules.force),
        (false, _) => NodeStatus::Open,
        (true, NodeStatus::Open) if rules.founding => founding_state(line),
        (true, NodeStatus::Open) => closing_state(line, i, before),
        (true, NodeStatus::Stick) => stuck_state(line, i, rules.force),
        (true, slipping @ (NodeStatus::SlipForward | NodeStatus::SlipBackward)) => {
            slipping_state(line, i, slipping, rules.slip)
        }
    }
}

/// True if the steel at a node yields: it bears more than its limit.
fn yields(line: &ContactLine, i: usize, tolerance: f64) -> bool {
    let Some(excess) = line.given.strength.excess(i, line.normal(i)) else { return false };
    if excess.abs() <= tolerance { line.state.yielded[i] } else { excess > 0.0 }
}

/// State of a node that has stuck: it slips where friction cannot hold it.
fn stuck_state(line: &ContactLine, i: usize, tolerance: f64) -> NodeStatus {
    let (shear, n, friction) = (line.shear(i), line.normal(i), line.friction(i));
    if size(shear) <= friction * n + tolerance * friction.min(1.0) && friction > 0.0 {
        NodeStatus::Stick
    } else if shear[0] >= 0.0 {
        NodeStatus::SlipForward
    } else {
        NodeStatus::SlipBackward
    }
}

/// State of a node that has slipped: it sticks where friction no longer opposes the slip.
fn slipping_state(line: &ContactLine, i: usize, slipping: NodeStatus, tolerance: f64) -> NodeStatus {
    let opposes = match line.shear_without_slip(i) {
        Some(drawn) => size(drawn) >= line.friction(i) * line.normal(i),
        None => slipping.friction_direction() * line.state.slip[0][i] <= tolerance,
    };
    if opposes || line.friction(i) == 0.0 { slipping } else { NodeStatus::Stick }
}

/// State of a node that has just closed: that of the nearest node that was closed `before`, or its own where it founds
/// a patch.
fn closing_state(line: &ContactLine, i: usize, before: &[NodeStatus]) -> NodeStatus {
    nearest_closed(before, i).map_or_else(|| founding_state(line), |nearest| before[nearest])
}

/// Nearest node to another one that was closed `before`.
pub(super) fn nearest_closed(before: &[NodeStatus], i: usize) -> Option<usize> {
    let left = before[..i].iter().rev().position(|s| s.is_active());
    let right = before[i + 1..].iter().position(|s| s.is_active());
    match (left, right) {
        (Some(l), Some(r)) if r < l => Some(i + 1 + r),
        (Some(l), _) => Some(i - 1 - l),
        (None, right) => right.map(|r| i + 1 + r),
    }
}

/// Length of a shear along and across [N/m].
pub(super) fn size(shear: [f64; 2]) -> f64 {
    if shear[1] == 0.0 { shear[0].abs() } else { libm::hypot(shear[0], shear[1]) }
}

/// Takes the state of a node from its normal force or, if it was open `before`, from its gap; returns whether it changed.
pub(super) fn guess_state(line: &mut ContactLine, i: usize, rules: &Rules, before: &[NodeStatus]) -> bool {
    let closed = before[i].is_active();
    let indicator = if closed { line.normal(i) } else { -rules.penalty * line.state.gap[i] };
    if indicator.abs() <= rules.force || (indicator > 0.0) == closed {
        return false;
    }
    line.state.status[i] = if closed { NodeStatus::Open } else { closing_state(line, i, before) };
    true
}

/// State of a node without a past or a neighbour: it sticks, unless the surfaces run against each other, and that by
/// more than a cell in the step. There sticking needs strains of order one; where both velocities are about opposite
/// (`rΩ = −V`) its equation even loses its force coefficients, and their sign is no direction of friction.
pub(super) fn founding_state(line: &ContactLine) -> NodeStatus {
    let (v, rim) = (line.traction.rigid.travel, line.rim_velocity());
    if v * rim >= 0.0 || (v - rim).abs() <= line.problem.time.a0 * line.grid.spacing {
        NodeStatus::Stick
    } else if v < rim {
        NodeStatus::SlipForward
    } else {
        NodeStatus::SlipBackward
    }
}

/// Gives all stuck nodes the state of founding ones.
pub(super) fn found_anew(line: &mut ContactLine) {
    let founding = founding_state(line);
    line.state.status.iter_mut().filter(|s| s.is_stuck()).for_each(|s| *s = founding);
}

/// Gives nodes at which stick ends the states that they have if friction or slip goes on changing as in the step before;
/// on rough surfaces every step is another one, and a stationary state follows none.
pub(super) fn foresee(line: &mut ContactLine) {
    let mut reserves = std::mem::take(&mut line.state.reserve);
    if !line.given.rail_slope.is_empty() || line.problem.time.is_stationary() {
        return;
    }
    reserves.resize(line.grid.len(), 0.0);
    let ratio = line.problem.time.ratio().unwrap_or(1.0);
    for (i, reserve) in reserves.iter_mut().enumerate() {
        let now = self::reserve(line, i);
        let before = std::mem::replace(reserve, now);
        if now * before > 0.0 && now * (now + ratio * (now - before)) < 0.0 {
            line.state.status[i] = match line.state.status[i] {
                NodeStatus::Stick if line.shear(i)[0] >= 0.0 => NodeStatus::SlipForward,
                NodeStatus::Stick => NodeStatus::SlipBackward,
                _ => NodeStatus::Stick,
            };
        }
    }
    line.state.reserve = reserves;
}

/// Friction that a stuck node leaves unused [N/m], or the slip of one that slips, negative [m/s]: nodes at which it is about to
/// pass zero stop to stick or to slip.
fn reserve(line: &ContactLine, i: usize) -> f64 {
    match line.state.status[i] {
        NodeStatus::Open => 0.0,
        NodeStatus::Stick => (line.friction(i) * line.normal(i) - size(line.shear(i))).max(0.0),
        NodeStatus::SlipForward | NodeStatus::SlipBackward => {
            -size([0, 1].map(|d| line.state.slip[d].get(i).copied().unwrap_or(0.0)))
        }
    }
}

/// Gives all nodes the states that they have once the patch has become longer by a factor about its middle; a change of less
/// than half a node at either end is none.
pub(super) fn stretch(line: &mut ContactLine, factor: f64) {
    let (x, GridState { status, yielded, .. }) = (&line.grid.x, &mut *line.state);
    let closed = |s: &NodeStatus| s.is_active();
    let (Some(first), Some(last)) = (status.iter().position(closed), status.iter().rposition(closed)) else { return };
    if factor == 1.0 || (last - first) as f64 * (1.0 / factor - 1.0).abs() < 1.0 {
        return;
    }
    let middle = 0.5 * (x[first] + x[last]);
    let nearest = |place: f64| {
        let above = x.partition_point(|x| *x < place).clamp(1, x.len() - 1);
        if place - x[above - 1] < x[above] - place { above - 1 } else { above }
    };
    let from: Vec<_> = x.iter().map(|x| nearest(middle + (x - middle) / factor)).collect();
    *status = from.iter().map(|&i| status[i]).collect();
    *yielded = from.iter().map(|&i| yielded[i]).collect();
}

/// Closes the nearest node of lines without any; returns whether it did.
pub(super) fn support(lines: &mut [ContactLine]) -> bool {
    if lines.iter().any(|line| line.state.status.iter().any(|s| s.is_active())) {
        return false;
    }
    let nodes = (0..lines.len()).flat_map(|k| (0..lines[k].grid.len()).map(move |i| (k, i)));
    let gap = |(k, i): (usize, usize)| lines[k].state.gap[i];
    let Some((k, i)) = nodes.min_by(|a, b| gap(*a).total_cmp(&gap(*b))) else { return false };
    lines[k].state.status[i] = founding_state(&lines[k]);
    true
}

/// True if the stuck nodes carry far more than friction allows, as happens when sliding starts from stick: normal
/// forces and gaps then mean nothing yet. A line that is pulled as a whole leaves the other surface, whatever its shear.
fn is_overloaded(line: &ContactLine) -> bool {
    let nodes = 0..line.grid.len();
    let sum = |least: f64| nodes.clone().map(|i| line.normal(i).max(least)).sum::<f64>();
    let limit = sum(0.0) * line.traction.friction.coefficient;
    let stuck = nodes.clone().filter(|&i| line.state.status[i].is_stuck()).map(|i| size(line.shear(i)));
    stuck.sum::<f64>() > OVERLOAD * limit && line.traction.friction.coefficient > 0.0 && sum(f64::NEG_INFINITY) > 0.0
}

/// True if the stuck nodes do not slip, round-off apart: their rows are linearised in V and Ω. In short steps of slow
/// wheels the rate of the displacements, new less known ones over the step, has the larger round-off.
pub(super) fn sticks(line: &ContactLine) -> bool {
    let rate = || line.problem.time.a0 * line.state.surface.iter().map(|u| u.amax()).fold(0.0, f64::max);
    let round_off = SLIP_ROUND_OFF[0] * line.speed() + SLIP_ROUND_OFF[2];
    let stuck = |slip: &Vec<f64>| {
        let stuck = line.state.status.iter().zip(slip).filter(|(status, _)| status.is_stuck());
        stuck.map(|(_, slip)| slip.abs()).fold(0.0, f64::max)
    };
    let slip = line.state.slip.iter().map(stuck).fold(0.0, f64::max);
    slip <= round_off || slip <= round_off + SLIP_ROUND_OFF[1] * rate()
}
