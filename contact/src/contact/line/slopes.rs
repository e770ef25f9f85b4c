//! Slopes of gap and surfaces as the balances of forces and moments see them.
//!
//! Slopes are differences over both neighbours of a node. Beside a sharp edge one neighbour is open, and how deep the
//! ground lies below it does not matter to the contact: only the part that bulges into the hole counts. Derivation:
//! `docs/theory/profiles.md`, section 6.

use super::grid::ContactGrid;

/// Gap and depths of the surfaces on a grid.
#[derive(Clone, Copy)]
pub(in crate::contact) struct Slopes<'a> {
    pub grid: &'a ContactGrid,
    /// Gap at the candidates [m].
    pub gap: &'a [f64],
    /// Depth by which yielding candidates give way, zero elsewhere [m].
    pub overlap: &'a [f64],
    /// Slope of the depth of the rail at the candidates \[1]; empty: both surfaces are smooth.
    pub rail_slope: &'a [f64],
    /// Depths of wheel and rail below circle and plane at the candidates and one node beyond on each side [m].
    pub depth: &'a [[f64; 2]],
}

impl Slopes<'_> {
    /// Slope of the depth of the rail at candidate `i`, across which pressure pushes the hub back \[1].
    pub fn rail(&self, i: usize) -> f64 {
        self.rail_slope.get(i).map_or(0.0, |dent| dent - self.falls(i)[1])
    }

    /// Part of the lever arm of pressure that the slopes add at candidate `i`, over the radius \[1]: that of the gap,
    /// which takes away the power that the outermost nodes would spend on closing the next cells, that of the rail, on
    /// which pressure acts through the wheel centre, and that of a wheel that falls away, which the pressure does not
    /// push back.
    pub fn arm(&self, i: usize) -> f64 {
        let at = |k: Option<usize>| k.filter(|k| *k < self.gap.len()).map_or(0.0, |k| self.gap[k] - self.overlap[k]);
        let gap = (at(Some(i + 1)) - at(i.checked_sub(1))) / self.grid.span(i);
        self.rail_slope.get(i).map_or(-gap, |dent| dent - gap + self.falls(i)[0])
    }

    /// Slopes at candidate `i` of the parts of the gap that wheel and rail open by falling away faster beside it than
    /// up to there \[1].
    fn falls(&self, i: usize) -> [f64; 2] {
        let after = self.fall(i, Some(i + 1), i);
        let before = self.fall(i, i.checked_sub(1), i + 2);
        let span = self.grid.span(i);
        [(after[0] - before[0]) / span, (after[1] - before[1]) / span]
    }

    /// Parts of the gap at the neighbour `beside` of candidate `i` [m]; `behind`: place of the other neighbour in the
    /// depths.
    ///
    /// The depth by which candidate `i` gives way springs back where the edge has passed, and only half of its slope
    /// there is that of a closed node: the other half is left in the gap beside it.
    fn fall(&self, i: usize, beside: Option<usize>, behind: usize) -> [f64; 2] {
        let Some((gap, beside)) = beside.and_then(|k| self.gap.get(k).map(|gap| (*gap, k + 1))) else {
            return [0.0; 2];
        };
        let gap = gap - self.overlap[i];
        // A number that is none is refused where the iteration ends.
        if gap.is_nan() || gap <= 0.0 {
            return [0.0; 2];
        }
        let beyond = |body: usize| self.depth[beside][body] - 2.0 * self.depth[i + 1][body] + self.depth[behind][body];
        let rail = beyond(1).clamp(0.0, gap);
        [beyond(0).clamp(0.0, gap - rail), rail]
    }
}
