//! Surface nodes at which contact is looked for.

use super::kernel::logarithms;
use crate::contact::kernel::Logarithm;
use crate::linalg::{Lagrange, POINTS};
use nalgebra::{DMatrix, DVector};
use std::sync::Arc;

/// Relative deviation within which a cell counts as one of the uniform ones: round-off of the positions.
const ROUND_OFF: f64 = 1e-9;

/// Pairs of surface nodes: candidates for contact with guard nodes on both sides. The nodes are uniformly spaced in the
/// middle of the grid; beyond, their distance may grow slowly.
///
/// Guard nodes never come into contact; the slip of the outermost candidates needs their displacements. A grid can be
/// [`scaled`](Self::scaled) with the patch of a line, so that this has as many nodes under any load.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactGrid {
    /// Positions of the candidates \[m], ascending.
    pub x: Vec<f64>,
    /// Their spacing in the middle of the grid \[m].
    pub spacing: f64,
    /// Number of guard nodes on each side.
    pub guard: usize,
    /// Positions of all nodes, guards included [m].
    nodes: Vec<f64>,
    /// Lengths of the cells between neighbouring nodes [m].
    cells: Vec<f64>,
    /// Points of the polynomials by which the bodies see the nodes.
    pub points: Lagrange,
    /// Values of these polynomials at all nodes.
    pub values: Arc<[[f64; POINTS]]>,
    /// Logarithms of the distances of all nodes of the grid of size 1, see [`logarithms`] \[1].
    pub logarithms: Arc<DMatrix<f64>>,
    /// Size over that of this grid \[1], and its natural logarithm.
    pub size: f64,
    log_size: f64,
}

impl ContactGrid {
    /// A grid of all `nodes` \[m], x ascending, the outermost `guard` of which on each side are guards; `spacing` is
    /// that in the middle \[m]. The polynomials of the bodies reach to the outermost candidates.
    pub fn new(nodes: Vec<f64>, spacing: f64, guard: usize) -> Self {
        let length = |pair: &[f64]| match pair[1] - pair[0] {
            cell if (cell - spacing).abs() < ROUND_OFF * spacing => spacing,
            cell => cell,
        };
        let cells = nodes.windows(2).map(length).collect();
        let x = nodes.get(guard..nodes.len().saturating_sub(guard)).unwrap_or_default().to_vec();
        let points = Lagrange::new(x.last().copied().unwrap_or(spacing));
        let logarithms = Arc::new(logarithms(&nodes, spacing));
        Self { x, spacing, guard, nodes, cells, values: Arc::new([]), logarithms, points, size: 1.0, log_size: 0.0 }
            .seen_by_points()
    }

    /// This grid, of size 1, on nodes that are `size` times as far apart, under the same bodies.
    pub fn scaled(&self, size: f64) -> Self {
        let times = |lengths: &[f64]| lengths.iter().map(|length| size * length).collect();
        let Self { x, spacing, guard, nodes, cells, points, logarithms, .. } = self;
        let (spacing, logarithms, values) = (size * spacing, Arc::clone(logarithms), Arc::new([]) as Arc<[_]>);
        let [x, nodes, cells] = [x, nodes, cells].map(|lengths| times(lengths));
        Self {
            x,
            spacing,
            guard: *guard,
            nodes,
            cells,
            points: points.clone(),
            values,
            logarithms,
            size,
            log_size: libm::log(size),
        }
        .seen_by_points()
    }

    /// True if this grid is `other` in another size.
    pub fn is_scaled(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.logarithms, &other.logarithms)
    }

    /// A logarithm of the distance of these nodes as that of [`Self::logarithms`].
    pub fn unscaled(&self, along: Logarithm) -> Logarithm {
        Logarithm { reach: along.reach - self.log_size, ..along }
    }

    /// This grid under bodies whose polynomials reach to the distance `reach` \[m] from the middle.
    pub fn under(self, reach: f64) -> Self {
        Self { points: Lagrange::new(reach), ..self }.seen_by_points()
    }

    fn seen_by_points(mut self) -> Self {
        self.values = self.nodes.iter().map(|x| self.points.values(*x)).collect();
        self
    }

    /// A grid of uniformly spaced candidates `x` \[m], ascending, with guards at the same spacing \[m].
    pub fn uniform(x: Vec<f64>, spacing: f64, guard: usize) -> Self {
        let (first, last) = (x.first().copied().unwrap_or(0.0), x.last().copied().unwrap_or(0.0));
        let below = (1..=guard).rev().map(|k| first - k as f64 * spacing);
        let nodes = below.chain(x.iter().copied()).chain((1..=guard).map(|k| last + k as f64 * spacing)).collect();
        let points = Lagrange::new(last);
        Self { x, points, ..Self::new(nodes, spacing, guard) }.seen_by_points()
    }

    /// Number of candidates.
    pub fn len(&self) -> usize {
        self.x.len()
    }

    /// True if there is no candidate.
    pub fn is_empty(&self) -> bool {
        self.x.is_empty()
    }

    /// Number of the components x and y of all nodes: `2·(candidates + 2·guard)`.
    pub fn components(&self) -> usize {
        2 * (self.len() + 2 * self.guard)
    }

    /// Place of the component x of candidate `i` among those of all nodes; y follows it.
    pub fn component(&self, i: usize) -> usize {
        2 * (i + self.guard)
    }

    /// Writes the displacements of all nodes that belong to those of the bodies' `ports`, x and y of every point \[m].
    pub fn expand(&self, ports: &DVector<f64>, displacement: &mut DVector<f64>) {
        if displacement.len() != self.components() {
            *displacement = DVector::zeros(self.components());
        }
        displacement.fill(0.0);
        self.add_expanded(ports, displacement);
    }

    /// Adds the displacements of all nodes that belong to those of the bodies' `ports`.
    pub fn add_expanded(&self, ports: &DVector<f64>, displacement: &mut DVector<f64>) {
        let mut points = [[0.0; 2]; POINTS];
        points.as_flattened_mut().copy_from_slice(ports.as_slice());
        for (node, values) in displacement.as_mut_slice().as_chunks_mut::<2>().0.iter_mut().zip(&*self.values) {
            let mut sum = *node;
            for (value, [x, y]) in values.iter().zip(&points) {
                sum[0] += value * x;
                sum[1] += value * y;
            }
            *node = sum;
        }
    }

    /// Moments with all polynomials of the bodies, x and y of every point, of forces at all nodes [N/m].
    pub fn moments(&self, forces: &[f64]) -> DVector<f64> {
        let mut moments = DVector::zeros(2 * POINTS);
        for (values, [x, y]) in self.values.iter().zip(forces.as_chunks::<2>().0).filter(|(_, f)| **f != [0.0; 2]) {
            for (value, moment) in values.iter().zip(moments.as_mut_slice().as_chunks_mut::<2>().0) {
                moment[0] += value * x;
                moment[1] += value * y;
            }
        }
        moments
    }

    /// Positions of all nodes, guards included \[m], ascending.
    pub fn nodes(&self) -> &[f64] {
        &self.nodes
    }

    /// Positions of the candidates and of the node next to them on both sides \[m], ascending.
    pub fn around(&self) -> &[f64] {
        &self.nodes[self.guard - 1..=self.guard + self.len()]
    }

    /// Distance \[m] between both neighbours of candidate `i`: the base of central differences, twice [`Self::width`].
    pub fn span(&self, i: usize) -> f64 {
        let node = i + self.guard;
        self.cells[node - 1] + self.cells[node]
    }

    /// Slope at candidate `i` of a displacement of all nodes, by central differences \[1]: of its component x (0) or y
    /// (1).
    pub fn slope(&self, u: &DVector<f64>, i: usize, component: usize) -> f64 {
        let at = self.component(i) + component;
        (u[at + 2] - u[at - 2]) / self.span(i)
    }

    /// Width of the surface that belongs to candidate `i` \[m]: a nodal force over it is a traction.
    pub fn width(&self, i: usize) -> f64 {
        0.5 * self.span(i)
    }

    /// Uniform spacing over the width of candidate `i` \[1]: a nodal force times it compares with those in the middle.
    pub fn share(&self, i: usize) -> f64 {
        self.spacing / self.width(i)
    }

    /// Lengths \[m] of the two cells next to candidate `i` towards `+x` (`to_right`) or `−x`, the nearer one first.
    pub fn cells_beside(&self, i: usize, to_right: bool) -> [f64; 2] {
        let node = i + self.guard;
        if to_right { [self.cells[node], self.cells[node + 1]] } else { [self.cells[node - 1], self.cells[node - 2]] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn widths_of_a_graded_grid_add_up_to_its_length() {
        let nodes = vec![-9.0, -5.0, -3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0, 5.0, 9.0];
        let grid = ContactGrid::new(nodes, 1.0, 2);
        assert_eq!(grid.x, [-3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0]);
        assert_eq!((grid.width(0), grid.width(3), grid.share(6)), (1.5, 1.0, 1.0 / 1.5));
        assert_eq!((grid.cells_beside(6, true), grid.cells_beside(6, false)), ([2.0, 4.0], [1.0, 1.0]));
        assert_eq!((0..grid.len()).map(|i| grid.width(i)).sum::<f64>(), 8.0);
    }

    #[test]
    fn uniform_grids_have_one_spacing_whatever_the_round_off_of_their_positions() {
        let h = 3.7e-5;
        let grid = ContactGrid::uniform((-30..=30).map(|i| f64::from(i) * h).collect(), h, 3);
        assert_eq!((grid.components(), grid.nodes().len()), (134, 67));
        assert!((0..grid.len()).all(|i| grid.width(i) == h && grid.cells_beside(i, i % 2 == 0) == [h, h]));
    }
}
