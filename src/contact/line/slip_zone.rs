//! Slip zone of a patch, which begins within a cell, as edges of patches lie within cells.
//!
//! The friction that stuck nodes leave unused grows from the place where slip begins like the pressure from an edge, so
//! that the ratio of the two outermost ones tells that place by the formula of the edges. Whole nodes place it to a cell,
//! and with it all the heat of light braking. Derivation: `docs/theory/profiles.md`.

use super::grid::ContactGrid;
use super::state::NodeStatus;
use super::streamline::edge_offset;
use crate::piecewise::{Interval, Piecewise, interpolate};
use std::ops::Range;

/// Stuck nodes from which on the place where slip begins is told by them.
const STUCK: usize = 3;
/// Ratio of the unused friction of the two outermost stuck nodes from which on they tell no place \[1].
const LARGEST: f64 = 0.8;
/// Slipping nodes next to the beginning whose slip differences across it do not tell.
const BESIDE: usize = 2;
/// Places at which the profile of a zone is written.
const PLACES: usize = 13;

/// Slip from a place within a patch to its trailing edge.
#[derive(Clone, Debug, PartialEq)]
pub struct SlipZone {
    /// Slipping nodes whose neighbours slip, too, but for those next to the beginning.
    nodes: Range<usize>,
    /// Place where it begins \[m].
    begin: f64,
    /// Leading and trailing edge of the patch \[m].
    edges: [f64; 2],
}

impl SlipZone {
    /// The slip zone of a `run` of closed nodes that make a `patch`, where `unused` is the friction that a node could still
    /// bear over its width \[Pa], `shear` the force along and across [N/m], and the material arrives from `+x` or not
    /// (`to_right`). `None` where slip is elsewhere, turns round, or hardly leaves a node that sticks.
    pub fn of(
        grid: &ContactGrid,
        status: &[NodeStatus],
        (run, patch): (Range<usize>, Interval),
        (unused, shear): (impl Fn(usize) -> f64, impl Fn(usize) -> [f64; 2]),
        to_right: bool,
    ) -> Option<Self> {
        let node = |k: usize| if to_right { run.start + k } else { run.end - 1 - k };
        let edges = if to_right { [patch.high, patch.low] } else { [patch.low, patch.high] };
        let slipping = (0..run.len()).take_while(|&k| !status[node(k)].is_stuck()).count();
        let turned = |[a, b]: [f64; 2], [c, d]: [f64; 2]| a * c + b * d <= 0.0;
        let alike = (1..slipping).all(|k| !turned(shear(node(k)), shear(node(0))));
        let sticks = (slipping..run.len()).all(|k| status[node(k)].is_stuck());
        if !alike || !sticks || run.len() < slipping + STUCK {
            return None;
        }
        let gap = |k: usize| unused(node(k)).max(0.0) / (grid.x[node(k)] - edges[0]).abs().sqrt();
        let [outer, inner] = [gap(slipping), gap(slipping + 1)];
        if outer > LARGEST * inner {
            return None;
        }
        let outermost = node(slipping);
        let downstream = edge_offset(outer, inner) * grid.cells_beside(outermost, !to_right)[0];
        let begin = grid.x[outermost] + if to_right { -downstream } else { downstream };
        let inner = slipping.saturating_sub(BESIDE).max(1);
        let nodes = if to_right { node(1)..node(inner) } else { node(inner) + 1..node(1) + 1 };
        Some(Self { nodes, begin: begin.clamp(patch.low, patch.high), edges })
    }

    /// Length of the patch over which it sticks \[m].
    pub fn stuck(&self) -> f64 {
        (self.edges[0] - self.begin).abs()
    }

    /// Writes the profile of friction's power, but for a factor: friction rises from the trailing edge and slip from the
    /// place where it begins as roots, as in Carter's contact, times what the `power` at the nodes has more, where that is
    /// given [W/m²]: under spin slip grows otherwise. Returns false where there is no slip.
    pub fn power(&self, grid: &ContactGrid, power: Option<impl Fn(usize) -> f64>, profile: &mut Piecewise) -> bool {
        let Self { ref nodes, begin, edges: [leading, trailing] } = *self;
        let density = |x: f64| (leading - x).abs() * ((begin - x) * (x - trailing)).max(0.0).sqrt();
        *profile = Piecewise::sampled(begin.min(trailing), begin.max(trailing), PLACES, density);
        if let Some(power) = power.filter(|_| !nodes.is_empty()) {
            let ratios: Vec<f64> = nodes.clone().map(|i| power(i) / density(grid.x[i])).collect();
            let ratio = |x: f64| interpolate(&grid.x[nodes.clone()], &ratios, x);
            profile.x.iter().zip(&mut profile.value).for_each(|(x, value)| *value *= ratio(*x));
        }
        begin != trailing
    }
}
