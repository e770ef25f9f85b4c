//! Shortcuts of the active set: without them every result takes longer and is the same but for round-off and, on uneven
//! surfaces, for the tolerance of the edges: without the guess, forces on a rough rail change by 1.4e-5.
//!
//! This file alone names them. [`guess_of_lines`] and [`initial_guess`] can be deleted by themselves, [`alternating`]
//! with its equations [`pressure_shear`], and [`line_by_line`] and [`patch_inverse`], which they use, after them.

mod alternating;
mod guess_of_lines;
mod initial_guess;
mod line_by_line;
mod patch_inverse;
mod pressure_shear;

use self::line_by_line::Known;
use super::axes::Axes;
use super::states::Comparison;
use super::unknowns::{LineUnknowns, Unknowns};
use crate::contact::line::contact_line::ContactLine;
use crate::contact::line::state::NodeStatus;

/// Memory of the shortcuts.
#[derive(Default)]
pub(super) struct Shortcuts {
    inverses: patch_inverse::KeptInverses,
    alternating: pressure_shear::PressureShear,
    guess: initial_guess::InitialGuess,
    guess_of_lines: guess_of_lines::GuessOfLines,
    line_by_line: line_by_line::LineByLine,
}

impl Shortcuts {
    /// Guesses the closed nodes from which the search starts, with the forces that belong to them.
    /// `rows` is memory for the coefficients of all ports, `before` for the states before an update.
    pub fn guess(
        &mut self,
        lines: &mut [ContactLine],
        axes: &Axes,
        comparison: Comparison,
        (unknowns, rows, before): (&mut Unknowns, &mut [Vec<f64>], &mut Vec<NodeStatus>),
    ) {
        let [line] = lines else {
            return self.guess_of_lines.find(lines, axes, comparison, (rows, &mut self.line_by_line));
        };
        unknowns.lines.resize_with(1, LineUnknowns::default);
        self.guess.find(line, axes, comparison, (&mut unknowns.lines[0], rows, before, &mut self.inverses));
    }

    /// Solves the linear problem of the present states and gives the lines their forces and motions; `false`: it takes
    /// all equations together.
    pub fn solve(
        &mut self,
        lines: &mut [ContactLine],
        axes: &Axes,
        unknowns: &Unknowns,
        rows: &mut [Vec<f64>],
    ) -> bool {
        match lines.len() {
            1 => alternating::solve(lines, axes, unknowns, rows, (&mut self.inverses, &mut self.alternating)),
            _ => line_by_line::solve(lines, axes, (unknowns, &Known::default()), rows, &mut self.line_by_line),
        }
    }
}
