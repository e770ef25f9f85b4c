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
use crate::lru::Lru;
use std::convert::Infallible;
use std::ops::Range;

/// Matrices of one patch of neighbouring nodes and of one step size.
#[derive(Clone, Copy)]
pub struct PatchMatrices<'a> {
    /// Factor of the normal forces at the closed nodes per gap [N/m per m]; it may have more rows.
    pub factor: &'a InverseFactor,
    /// Columns of the gap at the closed nodes per tangential force there [m/(N/m)], which are `apart` entries apart.
    pub coupling: &'a [f64],
    pub apart: usize,
}

/// Step size and line to which matrices belong.
struct StepKey {
    /// Weight of the new value in the time formula [1/s].
    a0: f64,
    /// First normal column of the compliance: those of other models and grids are told apart by it.
    column: Vec<f64>,
    /// Share of the width and flexibility of the line.
    kernel: (f64, LineKernel),
}

/// Matrices of one step size.
struct OfStep {
    /// Gap at all candidates per tangential force at all candidates [m/(N/m)], by columns.
    coupling: Vec<f64>,
    /// Factors by the first closed node.
    factors: Lru<usize, InverseFactor>,
}

/// Matrices of the last step sizes and patches.
#[derive(Default)]
pub struct KeptFactors(Lru<StepKey, OfStep, 4>);

/// Normal displacement at candidate `i` per normal force at candidate `j` [m/(N/m)].
fn compliance(problem: &LineProblem, grid: &ContactGrid, i: usize, j: usize) -> f64 {
    problem.compliance(grid.port(i) + 1, grid.port(j) + 1)
}

impl StepKey {
    fn new(problem: &LineProblem, grid: &ContactGrid) -> Self {
        let kernel = (problem.share, problem.kernel);
        Self { a0: problem.time.a0, column: first_column(problem, grid).to_vec(), kernel }
    }

    /// True if the matrices are those of a problem with this first column.
    fn fits(&self, problem: &LineProblem, column: &[f64]) -> bool {
        let same = (self.a0, self.kernel) == (problem.time.a0, (problem.share, problem.kernel));
        same && self.column == column
    }
}

impl OfStep {
    fn new(problem: &LineProblem, grid: &ContactGrid) -> Self {
        let nodes = 0..grid.len();
        let of_shear = |j: usize| nodes.clone().map(move |i| problem.compliance(grid.port(i) + 1, grid.port(j)));
        Self { coupling: nodes.clone().flat_map(of_shear).collect(), factors: Lru::default() }
    }

    /// Makes the factor of a patch the present one; `None` if there is none.
    fn factor(&mut self, problem: &LineProblem, grid: &ContactGrid, patch: &Range<usize>) -> Option<()> {
        let Ok(()) = self.factors.select(patch.start, |factor| {
            factor.truncate(0);
            Ok::<_, Infallible>(())
        });
        let factor = self.factors.present_mut();
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
        let column = first_column(problem, grid);
        if !self.0.find(|key| key.fits(problem, column)) {
            self.0.keep(StepKey::new(problem, grid), OfStep::new(problem, grid));
        }
        let kept = self.0.present_mut();
        kept.factor(problem, grid, patch)?;
        let (coupling, apart) = (&kept.coupling[patch.start * (grid.len() + 1)..], grid.len());
        Some(PatchMatrices { factor: kept.factors.present(), coupling, apart })
    }
}
