//! Edge-consistent upwind differences along the contact surface.
//!
//! The slip at a node takes the convective derivative from the two cells upstream. Where the first of them straddles
//! the leading edge of the patch, the displacement has a square-root kink inside the cell; its position follows from
//! the ratio `r` of the two outermost nodal pressures (Wiener–Hopf solution of the discrete kernel `1/(n + ½)`), and
//! the weights are chosen so that the slip is consistent with that position. A fixed weight makes the force jump by
//! about 0.01 μP whenever the edge passes a node. Derivation: `docs/theory/contact.md`, sections 4 and 6.

use super::state::{NodeStatus, for_each_patch};
use crate::piecewise::smooth_step;

/// Largest ratio of edge to inner nodal pressure in the discrete edge solution, at which the next node closes, and the distance
/// from it from which on ratios approach it without a kink: iterates and rough surfaces have larger ones.
const LARGEST_RATIO: f64 = 2.0 / 3.0;
const APPROACH: f64 = 0.05;

/// Ratio of edge to inner nodal pressure, limited to the range of the discrete edge solution.
fn edge_ratio(edge: f64, inner: f64) -> f64 {
    if inner <= 0.0 || edge >= LARGEST_RATIO * inner {
        return LARGEST_RATIO;
    }
    let (ratio, from) = ((edge / inner).max(0.0), LARGEST_RATIO - APPROACH);
    let t = ((ratio - from) / APPROACH).max(0.0);
    ratio + APPROACH * t * t * (1.0 - t)
}

/// Distance of the contact edge beyond its outermost node, in cells: `2z − ¼` with `z = r/(2 − r)`.
pub fn edge_offset(edge: f64, inner: f64) -> f64 {
    let r = edge_ratio(edge, inner);
    2.0 * r / (2.0 - r) - 0.25
}

/// Weights of the two cells upstream of a node: `∂u ≈ w0·m0 + w1·m1`, `w0 + w1 = 1`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UpwindWeights {
    /// Of the nearer cell \[1].
    pub w0: f64,
    /// Of the one behind it \[1].
    pub w1: f64,
}

const SMOOTH: UpwindWeights = UpwindWeights { w0: 1.5, w1: -0.5 };
const FIRST_CELL: UpwindWeights = UpwindWeights { w0: 1.0, w1: 0.0 };
/// Power of the place of the edge with which the weights of the inner neighbour change.
const SUDDENNESS: i32 = 4;

/// Weights of the inner neighbour of the outermost node, where its force over that of the neighbour is `r`: those of the
/// first cell, since the second one is outside, which become those of all others as the next node is about to close.
fn inner_weights(r: f64) -> UpwindWeights {
    let w1 = (2.0 * r / (2.0 - r)).powi(SUDDENNESS) * SMOOTH.w1;
    UpwindWeights { w0: 1.0 - w1, w1 }
}

/// Writes the weights of every node to `rows`; `to_right` tells that upstream is towards `+x` (forward motion).
///
/// `pressure` gives nodal normal forces. Only the closed set and the edge ratios matter, never stick or slip.
pub fn upwind_rows(
    status: &[NodeStatus],
    pressure: impl Fn(usize) -> f64,
    to_right: bool,
    rows: &mut Vec<UpwindWeights>,
) {
    rows.clear();
    rows.resize(status.len(), SMOOTH);
    for_each_patch(status, |run| {
        let (first, last) = (run.start, run.end - 1);
        let (edge, inner) = if to_right { (last, last.wrapping_sub(1)) } else { (first, first + 1) };
        if first == last {
            rows[edge] = FIRST_CELL;
            return;
        }
        let r = edge_ratio(pressure(edge), pressure(inner));
        let beta = (2.0 - 3.0 * r) / (1.0 + 0.5 * r);
        rows[edge] = UpwindWeights { w0: 1.0 + beta, w1: -beta };
        rows[inner] = inner_weights(r);
    });
}

impl UpwindWeights {
    /// Coefficients of `∂u/∂x` on the node and its first and second upstream neighbour [1/m]; `cells` are the lengths
    /// of the cells between them \[m].
    pub fn stencil(&self, to_right: bool, cells: [f64; 2]) -> [f64; 3] {
        let sign = if to_right { 1.0 } else { -1.0 };
        let (near, far) = (sign * self.w0 / cells[0], sign * self.w1 / cells[1]);
        [-near, near - far, far]
    }
}

/// Upwind differences of a line.
#[derive(Default)]
pub struct UpwindRows {
    rows: Vec<UpwindWeights>,
    /// Those of the iterate before.
    before: Vec<UpwindWeights>,
    /// Those of the beginning of the search.
    first: Vec<UpwindWeights>,
}

/// Largest difference of a weight.
fn largest_change(a: &[UpwindWeights], b: &[UpwindWeights]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a.w1 - b.w1).abs()).fold(0.0, f64::max)
}

impl UpwindRows {
    /// That of one candidate.
    pub fn row(&self, i: usize) -> UpwindWeights {
        self.rows[i]
    }

    /// Begins a search with those of the states and pressures, see [`upwind_rows`].
    pub fn begin(&mut self, status: &[NodeStatus], pressure: impl Fn(usize) -> f64, to_right: bool) {
        upwind_rows(status, pressure, to_right, &mut self.rows);
        self.first.clone_from(&self.rows);
    }

    /// Takes those of the present states and pressures: as at the beginning where no weight is farther from that than the
    /// `tolerance`, those of the iterate where one is twice as far, and between them without a jump or a kink. Returns the
    /// largest change of a weight.
    pub fn update(
        &mut self,
        status: &[NodeStatus],
        pressure: impl Fn(usize) -> f64,
        to_right: bool,
        tolerance: f64,
    ) -> f64 {
        std::mem::swap(&mut self.rows, &mut self.before);
        upwind_rows(status, pressure, to_right, &mut self.rows);
        let share = smooth_step(largest_change(&self.rows, &self.first) / tolerance - 1.0);
        for (row, first) in self.rows.iter_mut().zip(&self.first).filter(|_| share < 1.0) {
            let w1 = first.w1 + share * (row.w1 - first.w1);
            *row = UpwindWeights { w0: 1.0 - w1, w1 };
        }
        largest_change(&self.rows, &self.before)
    }

    /// Returns to those of before the last update.
    pub fn restore(&mut self) {
        std::mem::swap(&mut self.rows, &mut self.before);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stencil_differentiates_linear_fields_exactly_in_both_directions() {
        for row in [SMOOTH, FIRST_CELL, UpwindWeights { w0: 2.3, w1: -1.3 }] {
            for (to_right, step) in [(true, 1.0), (false, -1.0)] {
                let s = row.stencil(to_right, [0.5, 0.8]);
                let x = [0.0, 0.5, 1.3];
                let derivative: f64 = s.iter().zip(x).map(|(c, x)| c * (3.0 + 2.0 * step * x)).sum();
                assert!((derivative - 2.0).abs() < 1e-14);
            }
        }
    }

    /// A node that has just closed carries nothing, and the weights of all others are those of before.
    #[test]
    fn weights_do_not_jump_when_a_node_closes() {
        let status = |closed: usize| -> Vec<_> {
            (0..9).map(|i| if i < closed { NodeStatus::Stick } else { NodeStatus::Open }).collect()
        };
        // The outermost forces as a node beyond them is about to close, and just after.
        let force = |i: usize| [3.0, 3.0, 3.0, 3.0, 3.0, 2.0, 1e-13][i];
        let [mut before, mut after] = [Vec::new(), Vec::new()];
        upwind_rows(&status(6), force, true, &mut before);
        upwind_rows(&status(7), force, true, &mut after);
        assert!(largest_change(&before[..6], &after[..6]) < 1e-12, "{before:?} {after:?}");
    }

    #[test]
    fn edge_lies_between_a_quarter_cell_inside_and_three_quarters_outside() {
        assert!((edge_offset(0.0, 1.0) + 0.25).abs() < 1e-15);
        assert!((edge_offset(2.0 / 3.0, 1.0) - 0.75).abs() < 1e-15);
    }
}
