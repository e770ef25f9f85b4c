//! Linear problem of given states, and its solution by all equations of all lines together.

use super::axes::{Axes, Equation};
use super::unknowns::Unknowns;
use crate::axes::Axis;
use crate::contact::error::ContactError;
use crate::contact::line::contact_line::ContactLine;
use crate::contact::line::rows::{AffineRow, NodeEquation};
use crate::linalg::DenseSystem;
use crate::linalg::vectorised::dot;

/// Parts of the solution that are known beside the unknowns; empty: none.
#[derive(Default)]
pub(super) struct Known {
    /// Gap that they leave at the candidates of every line \[m].
    pub gaps: Vec<Vec<f64>>,
    /// Forces at all ports of every line [N/m].
    pub forces: Vec<Vec<f64>>,
}

/// Linear problem of given states.
#[derive(Clone, Copy)]
pub(super) struct LinearProblem<'a> {
    pub axes: &'a Axes<'a>,
    pub unknowns: &'a Unknowns,
    pub known: &'a Known,
}

impl LinearProblem<'_> {
    /// An equation of node `i` of line `k`, of which `row` is what the forces do not change, with what is known beside
    /// the unknowns.
    pub fn equation(&self, k: usize, i: usize, kind: NodeEquation, row: AffineRow) -> Equation {
        let mut equation = self.axes.equation(row);
        if let (NodeEquation::Gap, Some(gaps)) = (kind, self.known.gaps.get(k)) {
            equation.constant += gaps[i];
        }
        equation
    }

    /// An equation of node `i` of line `k`. Writes the coefficients of all port forces of every line to `forces`.
    pub fn node(
        &self,
        lines: &[ContactLine],
        k: usize,
        i: usize,
        kind: NodeEquation,
        forces: &mut [Vec<f64>],
    ) -> Equation {
        let (line, mut affine) = (&lines[k], AffineRow::default());
        for (j, (other, forces)) in self.unknowns.lines.iter().zip(forces).enumerate() {
            let window = other.window(line.grid);
            kind.by_shared(line, i, lines[j].problem.share, window.clone(), forces);
            match (j == k, kind) {
                (true, _) => affine = kind.add_own(line, i, window, forces),
                (false, NodeEquation::Slip) => line.add_slip_by(i, &lines[j], window, forces),
                (false, NodeEquation::Gap) => {}
            }
        }
        self.equation(k, i, kind, affine)
    }

    /// Balance of an axis, with what is known beside the unknowns. Writes the coefficients of all port forces of every
    /// line to `forces`.
    pub fn balance(&self, axis: Axis, lines: &[ContactLine], forces: &mut [Vec<f64>]) -> Equation {
        let mut balance = self.axes.row(axis, lines, forces);
        balance.constant += forces.iter().zip(&self.known.forces).map(|(row, forces)| dot(row, forces)).sum::<f64>();
        balance
    }

    /// Constant of an equation with all motions as they are.
    pub fn left_over(equation: &Equation, line: &ContactLine) -> f64 {
        equation.constant + equation.motions.dot(line.traction.rigid)
    }

    /// Writes an equation of a line, with the coefficients `forces` of all ports of every line, to the row of a system,
    /// in which equations may have any scale.
    pub fn write(&self, line: &ContactLine, equation: &Equation, forces: &[Vec<f64>], row: (&mut [f64], &mut f64)) {
        let mut rest = &mut *row.0;
        for (unknowns, forces) in self.unknowns.lines.iter().zip(forces) {
            let (own, others) = rest.split_at_mut(unknowns.len());
            unknowns.write(own, forces, line.grid);
            rest = others;
        }
        for (value, &axis) in rest.iter_mut().zip(&self.unknowns.axes) {
            *value = equation.motions[axis];
        }
        *row.1 = -Self::left_over(equation, line);
    }
}

/// Solves the linear problem and gives the lines their forces and motions; `rows` is memory for the coefficients of all
/// ports of every line.
pub(super) fn solve(
    lines: &mut [ContactLine],
    problem: LinearProblem,
    rows: &mut [Vec<f64>],
    system: &mut DenseSystem,
) -> Result<(), ContactError> {
    let unknowns = problem.unknowns;
    system.reset(unknowns.len());
    let mut r = 0;
    for (k, own) in unknowns.lines.iter().enumerate() {
        for (i, kind) in own.equations() {
            let equation = problem.node(lines, k, i, kind, rows);
            problem.write(&lines[k], &equation, rows, system.row(r));
            r += 1;
        }
    }
    for &axis in &unknowns.axes {
        let balance = problem.balance(axis, lines, rows);
        problem.write(&lines[0], &balance, rows, system.row(r));
        r += 1;
    }
    // Nothing is unknown when a wheel with prescribed motions is off the rail.
    let solution = system.solve().ok_or(ContactError::Singular { closed: unknowns.closed() })?;
    unknowns.accept(solution, lines, problem.axes);
    Ok(())
}
