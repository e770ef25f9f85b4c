//! Shortcuts of the active set: without them every result is the same but for round-off, and takes longer.
//!
//! This file alone names them. [`initial_guess`] can be deleted by itself, [`alternating`] with its equations
//! [`pressure_shear`], and [`patch_inverse`], which both use, after them.

mod alternating;
mod initial_guess;
mod patch_inverse;
mod pressure_shear;

use super::axes::Axes;
use super::states::Comparison;
use super::unknowns::Unknowns;
use crate::contact::line::contact_line::ContactLine;
use crate::contact::line::state::NodeStatus;

/// Memory of the shortcuts.
#[derive(Default)]
pub(super) struct Shortcuts {
    inverses: patch_inverse::KeptInverses,
    alternating: pressure_shear::PressureShear,
    guess: initial_guess::InitialGuess,
}

impl Shortcuts {
    /// Guesses the closed nodes from which the search starts, with the forces that belong to them. `row` is memory for
    /// the coefficients of all ports, `before` for the states before an update.
    pub fn guess(
        &mut self,
        line: &mut ContactLine,
        axes: &Axes,
        comparison: Comparison,
        (unknowns, row, before): (&mut Unknowns, &mut [f64], &mut Vec<NodeStatus>),
    ) {
        self.guess.find(line, axes, comparison, (unknowns, row, before, &mut self.inverses));
    }

    /// Solves the linear problem of the present states and gives the line its forces and motions; `false`: it takes all
    /// equations together.
    pub fn solve(&mut self, line: &mut ContactLine, axes: &Axes, unknowns: &Unknowns, row: &mut [f64]) -> bool {
        alternating::solve(line, axes, unknowns, row, (&mut self.inverses, &mut self.alternating))
    }
}
