//! Where slip begins and ends: within cells, as edges of patches lie within cells.
//!
//! The friction that stuck nodes leave unused grows from the place where slip begins like the pressure from an edge, so
//! that the ratio of the two outermost ones tells that place by the formula of the edges. Whole nodes place it to a cell,
//! and with it all the heat of light braking. Derivation: `docs/theory/contact.md`, sections 4 and 9.

use super::grid::ContactGrid;
use super::state::{GridState, NodeStatus};
use super::streamline::edge_offset;
use crate::piecewise::{Interval, Piecewise, interpolate};
use std::ops::Range;

/// Ratio of the unused friction of the two outermost stuck nodes from which on they tell no place \[1].
const LARGEST: f64 = 0.8;
/// Slipping nodes next to the beginning whose slip differences across it do not tell.
const BESIDE: usize = 2;
/// Places at which the profile of a zone is written.
const PLACES: usize = 13;

/// Friction of the closed nodes of a line, and what they could still bear.
pub struct NodalFriction<'a> {
    pub grid: &'a ContactGrid,
    pub state: &'a GridState,
    /// Friction that a candidate can bear over its normal force \[1].
    pub coefficient: &'a dyn Fn(usize) -> f64,
    /// True if the material arrives from `+x`.
    pub to_right: bool,
}

/// Slip from a place within a patch to its trailing edge.
#[derive(Clone, Debug, PartialEq)]
pub struct SlipZone {
    /// Slipping nodes but for those next to the beginning, if there are others.
    nodes: Range<usize>,
    /// Place where it begins \[m].
    begin: f64,
    /// Leading and trailing edge of the patch \[m].
    edges: [f64; 2],
}

impl NodalFriction<'_> {
    fn status(&self, i: usize) -> NodeStatus {
        self.state.status[i]
    }

    /// Force of friction at candidate `i`, along and across [N/m].
    pub fn force(&self, i: usize) -> [f64; 2] {
        [self.state.forces[self.grid.component(i)], self.state.lateral.get(i).copied().unwrap_or(0.0)]
    }

    /// Largest force of friction at candidate `i` [N/m].
    fn most(&self, i: usize) -> f64 {
        (self.coefficient)(i) * self.state.forces[self.grid.component(i) + 1]
    }

    /// Force of friction that candidate `i` could bear in addition [N/m].
    fn unused(&self, i: usize) -> f64 {
        let [along, across] = self.force(i);
        (self.most(i) - libm::hypot(along, across)).max(0.0)
    }

    /// Place \[m] where the stick of the stuck nodes `outer` and `inner` ends, beyond the former, which lies to the right of
    /// the other or not. The friction that is unused vanishes at the `far` end of the stick, too. `None`: the nodes do not tell.
    fn end(&self, [outer, inner]: [usize; 2], far: f64) -> Option<f64> {
        let (grid, right) = (self.grid, outer > inner);
        let rises = |i: usize| self.unused(i) * grid.share(i) / (grid.x[i] - far).abs().sqrt();
        let distance = edge_offset(rises(outer), rises(inner)) * grid.cells_beside(outer, right)[0];
        let place = grid.x[outer] + if right { distance } else { -distance };
        (rises(outer) <= LARGEST * rises(inner)).then_some(place)
    }

    /// Length \[m] over which the `run` of closed nodes of a `patch` sticks.
    pub fn stick_length(&self, run: Range<usize>, patch: Interval) -> f64 {
        let mut stuck = run.clone().filter(|&i| self.status(i).is_stuck());
        let (Some(first), Some(last)) = (stuck.next(), stuck.next_back()) else {
            return self.little_stick(run, patch);
        };
        let second = stuck.next().unwrap_or(last);
        let before = stuck.next_back().unwrap_or(if second == last { first } else { second });
        let half = |i: usize, right: bool| 0.5 * self.grid.cells_beside(i, right)[0];
        let outside = |i: usize| i == run.start || i + 1 == run.end;
        let far = |i: usize, edge: f64| if outside(i) { edge } else { self.grid.x[i] };
        let low = match outside(first) && self.leads(first, &run) {
            true => patch.low,
            false => {
                self.end([first, second], far(last, patch.high)).unwrap_or(self.grid.x[first] - half(first, false))
            }
        };
        let high = match outside(last) && self.leads(last, &run) {
            true => patch.high,
            false => self.end([last, before], far(first, patch.low)).unwrap_or(self.grid.x[last] + half(last, true)),
        };
        (high.min(patch.high) - low.max(patch.low)).max(0.0)
    }

    /// True if a node is the first that the material reaches.
    fn leads(&self, i: usize, run: &Range<usize>) -> bool {
        i == if self.to_right { run.end - 1 } else { run.start }
    }

    /// Length \[m] over which a patch sticks that has one stuck node at most: its share of the patch is the root of that of
    /// the friction that is unused (Carter 1926, Mindlin 1949).
    fn little_stick(&self, run: Range<usize>, patch: Interval) -> f64 {
        let stuck = run.clone().filter(|&i| self.status(i).is_stuck());
        let unused: f64 = stuck.map(|i| self.unused(i)).sum();
        let all: f64 = run.map(|i| self.most(i)).sum();
        if unused > 0.0 { 2.0 * patch.half_length() * (unused / all).sqrt().min(1.0) } else { 0.0 }
    }
}

impl SlipZone {
    /// The slip zone of a `run` of closed nodes that make a `patch`. `None` where slip is elsewhere, turns round, or hardly
    /// leaves a node that sticks.
    pub fn of(friction: &NodalFriction, run: &Range<usize>, patch: Interval) -> Option<Self> {
        let node = |k: usize| if friction.to_right { run.start + k } else { run.end - 1 - k };
        let edges = if friction.to_right { [patch.high, patch.low] } else { [patch.low, patch.high] };
        let sticks = |k: usize| friction.status(node(k)).is_stuck();
        let slipping = (0..run.len()).take_while(|&k| !sticks(k)).count();
        let turned = |[a, b]: [f64; 2], [c, d]: [f64; 2]| a * c + b * d <= 0.0;
        let alike = (1..slipping).all(|k| !turned(friction.force(node(k)), friction.force(node(0))));
        if run.len() < slipping + 2 || !alike || !(slipping..run.len()).all(sticks) {
            return None;
        }
        let begin = friction.end([node(slipping), node(slipping + 1)], edges[0])?.clamp(patch.low, patch.high);
        let inner = slipping.saturating_sub(BESIDE).max(1);
        let nodes = if friction.to_right { node(0)..node(inner) } else { node(inner) + 1..node(0) + 1 };
        Some(Self { nodes, begin, edges })
    }

    /// Writes the profile of friction's power, but for a factor: friction rises from the trailing edge and slip from the
    /// place where it begins as roots, as in Carter's contact, times what the `power` at the nodes has more, where that is
    /// given [W/m²]: under spin slip grows otherwise. Returns false where there is no slip.
    pub fn power(&self, grid: &ContactGrid, power: Option<impl Fn(usize) -> f64>, profile: &mut Piecewise) -> bool {
        let Self { ref nodes, begin, edges: [leading, trailing] } = *self;
        // Beside the trailing edge the ratio is that of two small numbers.
        let inside = if leading > trailing { nodes.start + 1..nodes.end } else { nodes.start..nodes.end - 1 };
        let density = |x: f64| (leading - x).abs() * ((begin - x) * (x - trailing)).max(0.0).sqrt();
        self.write(grid, density, power.map(|power| (inside, power)), profile);
        begin != trailing
    }

    /// Writes the profile of slip [m/s], but for a factor: it rises as in Carter's contact, times what the `slip` at the
    /// nodes has more.
    pub fn slip(&self, grid: &ContactGrid, slip: impl Fn(usize) -> f64, profile: &mut Piecewise) {
        let Self { ref nodes, begin, edges: [leading, _] } = *self;
        let shape = |x: f64| ((leading - x) * (begin - x)).max(0.0).sqrt();
        self.write(grid, shape, Some((nodes.clone(), slip)), profile);
    }

    /// Writes a `shape` over the places of the zone, times what the values of the nodes have more, where those are given.
    fn write(
        &self,
        grid: &ContactGrid,
        shape: impl Fn(f64) -> f64,
        values: Option<(Range<usize>, impl Fn(usize) -> f64)>,
        profile: &mut Piecewise,
    ) {
        let Self { begin, edges: [_, trailing], .. } = *self;
        profile.take_samples(begin.min(trailing), begin.max(trailing), PLACES, &shape);
        if let Some((nodes, value)) = values.filter(|(nodes, _)| !nodes.is_empty()) {
            let over = |i: usize| Some(value(i) / shape(grid.x[i])).filter(|ratio| ratio.is_finite()).unwrap_or(0.0);
            let ratio = |x: f64| {
                let next = nodes.start + grid.x[nodes.clone()].partition_point(|node| *node <= x);
                let [low, high] = [next.saturating_sub(1).max(nodes.start), next.min(nodes.end - 1)];
                if low == high { over(low) } else { interpolate(&grid.x[low..=high], &[over(low), over(high)], x) }
            };
            profile.x.iter().zip(&mut profile.value).for_each(|(x, value)| *value *= ratio(*x));
        }
    }
}
