//! Pressures that close a given patch: the inverse of the normal part of the compliance, kept from step to step.

use super::candidates::ContactGrid;
use super::turns::PatchMatrices;
use crate::contact::problem::ContactProblem;
use crate::linalg::dense::inverse_of_definite;
use nalgebra::DMatrix;
use std::ops::Range;

/// Patches whose inverses are kept: a smooth wheel needs one or two, a rough rail moves the edges by a few nodes.
const KEPT: usize = 8;

/// What belongs to the place of a patch on the grid and to the step size alone.
struct PatchInverse {
    patch: Range<usize>,
    /// Weight of the new value in the time formula [1/s], and number of ports.
    operator: (f64, usize),
    /// First column of the compliance: inverses of another model are told apart by it.
    column: Vec<f64>,
    matrices: PatchMatrices,
}

impl PatchInverse {
    /// Of the closed nodes `patch`; `None` if their compliance is not positive definite.
    fn new(problem: &ContactProblem, grid: &ContactGrid, patch: Range<usize>) -> Option<Self> {
        let (relative, n) = (problem.bodies.relative, patch.len());
        let normal = |i: usize| grid.port(patch.start + i) + 1;
        let compliance = DMatrix::from_fn(n, n, |i, j| relative[(normal(i), normal(j))]);
        let coupling = DMatrix::from_fn(n, n, |i, j| relative[(normal(i), normal(j) - 1)]);
        let (operator, column) = (Self::operator(problem), compliance.column(0).iter().copied().collect());
        let matrices = PatchMatrices { inverse: inverse_of_definite(&compliance)?, coupling };
        Some(Self { patch, operator, column, matrices })
    }

    fn operator(problem: &ContactProblem) -> (f64, usize) {
        (problem.time.a0, problem.bodies.relative.nrows())
    }

    /// Whether this is the inverse for a problem and a patch.
    fn fits(&self, problem: &ContactProblem, grid: &ContactGrid, patch: &Range<usize>) -> bool {
        let relative = problem.bodies.relative;
        let first = grid.port(patch.start) + 1;
        self.patch == *patch
            && self.operator == Self::operator(problem)
            && self.column.iter().enumerate().all(|(i, c)| *c == relative[(first + 2 * i, first)])
    }
}

/// Inverses of the last patches.
#[derive(Default)]
pub(super) struct KeptInverses {
    recent: Vec<PatchInverse>,
}

impl KeptInverses {
    /// The matrices of a patch; `None` if its compliance has no inverse.
    pub fn of(&mut self, problem: &ContactProblem, grid: &ContactGrid, patch: &Range<usize>) -> Option<&PatchMatrices> {
        match self.recent.iter().position(|kept| kept.fits(problem, grid, patch)) {
            Some(at) => self.recent[at..].rotate_left(1),
            None => {
                let new = PatchInverse::new(problem, grid, patch.clone())?;
                if self.recent.len() >= KEPT {
                    self.recent.remove(0);
                }
                self.recent.push(new);
            }
        }
        self.recent.last().map(|kept| &kept.matrices)
    }
}
