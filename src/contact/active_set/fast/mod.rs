//! Fast ways to solve the linear problem: without them every result takes longer and is the same but for round-off.
//!
//! This file alone names them. [`alternating`] with its equations [`pressure_shear`] and the factors [`patch_factor`]
//! can be deleted by itself, and so can [`line_by_line`].

mod alternating;
mod line_by_line;
mod patch_factor;
mod pressure_shear;

use super::linear::{self, LinearProblem};
use crate::contact::error::ContactError;
use crate::contact::line::contact_line::ContactLine;
use crate::linalg::DenseSystem;

/// Ways to solve a linear problem, and their memory.
#[derive(Default)]
pub(super) struct LinearSolver {
    alternating: alternating::Alternating,
    line_by_line: line_by_line::LineByLine,
    together: DenseSystem,
}

impl LinearSolver {
    /// Solves a linear problem and gives the lines their forces and motions; returns whether that took all equations
    /// together. `rows` is memory for the coefficients of all ports of every line.
    pub fn solve(
        &mut self,
        lines: &mut [ContactLine],
        problem: LinearProblem,
        rows: &mut [Vec<f64>],
    ) -> Result<bool, ContactError> {
        let solved = match lines.len() {
            1 => self.alternating.solve(lines, problem, rows),
            _ => self.line_by_line.solve(lines, problem, rows),
        };
        match solved {
            true => Ok(false),
            false => linear::solve(lines, problem, rows, &mut self.together).map(|()| true),
        }
    }
}
