//! Factor of the inverse of the normal part of the compliance of a patch, kept from step to step: it gives the
//! pressures that close the patch. Measured: factors that patches share take a rough rail's step without heat to 0.83
//! (rolling freely) and 0.85 (braking) of its time with one factorisation per patch.
//!
//! Patches that begin at the same node share one factor: the longer one only has more rows. So it costs little where
//! uneven surfaces move the edges. A kept factor has the same bits whatever came before ([`InverseFactor`]), so that a
//! step is a function of the state alone.

use crate::contact::kernel::LineKernel;
use crate::contact::line::ContactGrid;
use crate::contact::problem::LineProblem;
use crate::linalg::InverseFactor;
use std::ops::Range;

/// Number of step sizes that are kept, and of factors of each.
const KEPT: [usize; 2] = [4, 16];

/// Matrices of one patch of neighbouring nodes and of one step size.
#[derive(Clone, Copy)]
pub struct PatchMatrices<'a> {
    /// Factor of the normal forces at the closed nodes per gap [N/m per m]; it may have more rows.
    pub factor: &'a InverseFactor,
    /// Columns of the gap at the closed nodes per tangential force there [m/(N/m)], which are `apart` entries apart.
    pub coupling: &'a [f64],
    pub apart: usize,
}

/// Factors of one step size.
struct OfStep {
    /// Weight of the new value in the time formula [1/s].
    a0: f64,
    /// First normal column of the compliance: those of other models and grids are told apart by it.
    column: Vec<f64>,
    /// Share of the width and flexibility of the line.
    kernel: (f64, LineKernel),
    /// Gap at all candidates per tangential force at all candidates [m/(N/m)], by columns.
    coupling: Vec<f64>,
    /// First closed nodes and their factors, the last one used at the end.
    factors: Vec<(usize, InverseFactor)>,
}

/// Factors of the last patches.
#[derive(Default)]
pub struct KeptFactors {
    recent: Vec<OfStep>,
}

/// Normal displacement at candidate `i` per normal force at candidate `j` [m/(N/m)].
fn compliance(problem: &LineProblem, grid: &ContactGrid, i: usize, j: usize) -> f64 {
    problem.compliance(grid.port(i) + 1, grid.port(j) + 1)
}

impl OfStep {
    /// True if the matrices are those of a problem with this first column.
    fn fits(&self, problem: &LineProblem, column: &[f64]) -> bool {
        let same = (self.a0, self.kernel) == (problem.time.a0, (problem.share, problem.kernel));
        same && self.column == column
    }

    fn new(problem: &LineProblem, grid: &ContactGrid) -> Self {
        let nodes = 0..grid.len();
        let of_shear = |j: usize| nodes.clone().map(move |i| problem.compliance(grid.port(i) + 1, grid.port(j)));
        Self {
            a0: problem.time.a0,
            column: first_column(problem, grid).to_vec(),
            kernel: (problem.share, problem.kernel),
            coupling: nodes.clone().flat_map(of_shear).collect(),
            factors: Vec::new(),
        }
    }

    /// Puts the factor of a patch at the end; `None` if there is none.
    fn factor(&mut self, problem: &LineProblem, grid: &ContactGrid, patch: &Range<usize>) -> Option<()> {
        match self.factors.iter().position(|(first, _)| *first == patch.start) {
            Some(at) => self.factors[at..].rotate_left(1),
            None if self.factors.len() < KEPT[1] => self.factors.push((patch.start, InverseFactor::default())),
            None => {
                self.factors.rotate_left(1);
                let (first, factor) = self.factors.last_mut()?;
                *first = patch.start;
                factor.truncate(0);
            }
        }
        let (_, factor) = self.factors.last_mut()?;
        for i in patch.start + factor.size()..patch.end {
            let beside = (patch.start..i).map(|j| compliance(problem, grid, i, j));
            factor.append(beside, compliance(problem, grid, i, i))?;
        }
        Some(())
    }
}

/// The column of the first candidate's normal force in the compliance.
fn first_column<'a>(problem: &LineProblem<'a>, grid: &ContactGrid) -> &'a [f64] {
    let relative = problem.bodies.shared.relative;
    &relative.as_slice()[(grid.port(0) + 1) * relative.nrows()..][..relative.nrows()]
}

impl KeptFactors {
    /// The matrices of a patch; `None` if its compliance has no inverse.
    pub fn of(&mut self, problem: &LineProblem, grid: &ContactGrid, patch: &Range<usize>) -> Option<PatchMatrices<'_>> {
        let kept = self.of_step(problem, grid)?;
        kept.factor(problem, grid, patch)?;
        let (coupling, apart) = (&kept.coupling[patch.start * (grid.len() + 1)..], grid.len());
        Some(PatchMatrices { factor: &kept.factors.last()?.1, coupling, apart })
    }

    fn of_step(&mut self, problem: &LineProblem, grid: &ContactGrid) -> Option<&mut OfStep> {
        let column = first_column(problem, grid);
        match self.recent.iter().position(|kept| kept.fits(problem, column)) {
            Some(at) => self.recent[at..].rotate_left(1),
            None => {
                if self.recent.len() >= KEPT[0] {
                    self.recent.remove(0);
                }
                self.recent.push(OfStep::new(problem, grid));
            }
        }
        self.recent.last_mut()
    }
}
