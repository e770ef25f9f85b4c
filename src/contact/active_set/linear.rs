//! Linear problem of given states: all equations of all lines are written and solved together.

use super::axes::Axes;
use super::unknowns::Unknowns;
use crate::contact::error::ContactError;
use crate::contact::line::ContactGrid;
use crate::contact::line::contact_line::ContactLine;
use crate::contact::line::rows::AffineRow;
use crate::linalg::DenseSystem;
use std::ops::Range;

/// Equation of a node. The first function writes the coefficients of the line's own forces at the given ports, and
/// returns the rest; the second one writes those of the forces of another line.
type NodeEquation = (
    fn(&ContactLine, usize, Range<usize>, &mut [f64]) -> AffineRow,
    fn(&ContactLine, usize, &ContactLine, Range<usize>, &mut [f64]),
);

/// Solves the linear problem of the present states and gives the lines their forces and motions; `rows` is memory for
/// the coefficients of all ports of every line.
pub(super) fn solve(
    lines: &mut [ContactLine],
    grid: &ContactGrid,
    axes: &Axes,
    unknowns: &Unknowns,
    (rows, system): (&mut [Vec<f64>], &mut DenseSystem),
) -> Result<(), ContactError> {
    system.reset(unknowns.len());
    let mut r = 0;
    for (k, unknown) in unknowns.lines.iter().enumerate() {
        let gap: NodeEquation = (
            |line, i, window, row| line.gap_row(i, window, row),
            |line, i, other, window, row| line.gap_by_shared(i, other.problem.share, window, row),
        );
        let slip: NodeEquation = (
            |line, i, window, row| line.slip_row(i, window, row),
            |line, i, other, window, row| {
                line.slip_by_shared(i, other.problem.share, window.clone(), row);
                line.add_slip_by(i, other, window, row);
            },
        );
        for (nodes, equation) in [(&unknown.closed, gap), (&unknown.stuck, slip)] {
            for &i in nodes {
                let row = write_forces(lines, unknowns, (k, i), equation, rows);
                unknowns.write(system.row(r), (&axes.equation(row), rows), grid, axes);
                r += 1;
            }
        }
    }
    for &axis in &unknowns.axes {
        let balance = axes.row(axis, lines, rows);
        unknowns.write(system.row(r), (&balance, rows), grid, axes);
        r += 1;
    }
    // Nothing is unknown when a wheel with prescribed motions is off the rail.
    let solution = system.solve().ok_or(ContactError::Singular { closed: unknowns.closed() })?;
    unknowns.accept(solution, lines, axes);
    Ok(())
}

/// Writes the coefficients of all ports of every line in the equation of node `i` of line `k` to `rows`; returns the
/// rest of it.
fn write_forces(
    lines: &[ContactLine],
    unknowns: &Unknowns,
    (k, i): (usize, usize),
    (own, by_other): NodeEquation,
    rows: &mut [Vec<f64>],
) -> AffineRow {
    let (line, mut affine) = (&lines[k], AffineRow::default());
    for (j, (other, row)) in unknowns.lines.iter().zip(rows).enumerate() {
        let window = other.window(line.grid);
        match j == k {
            true => affine = own(line, i, window, row),
            false => by_other(line, i, &lines[j], window, row),
        }
    }
    affine
}
