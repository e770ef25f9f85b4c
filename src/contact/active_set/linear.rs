//! Linear problem of given states: all equations are written and solved together.

use super::axes::Axes;
use super::unknowns::Unknowns;
use crate::contact::error::ContactError;
use crate::contact::line::contact_line::ContactLine;
use crate::linalg::DenseSystem;

/// Solves the linear problem of the present states and gives the line its forces and motions; `row` is memory for the
/// coefficients of all ports.
pub(super) fn solve(
    line: &mut ContactLine,
    axes: &Axes,
    unknowns: &Unknowns,
    row: &mut [f64],
    system: &mut DenseSystem,
) -> Result<(), ContactError> {
    assemble(line, axes, unknowns, row, system);
    // Nothing is unknown when a wheel with prescribed motions is off the rail.
    let solution = system.solve().ok_or(ContactError::Singular { closed: unknowns.closed.len() })?;
    unknowns.accept(solution, line, axes);
    Ok(())
}

/// Writes the equations: no gap at closed nodes, no slip at stuck ones, balances of the axes.
fn assemble(line: &ContactLine, axes: &Axes, unknowns: &Unknowns, row: &mut [f64], system: &mut DenseSystem) {
    let Unknowns { closed, stuck, .. } = unknowns;
    system.reset(unknowns.len());
    let window = unknowns.window(line.grid);
    for (r, &i) in closed.iter().enumerate() {
        let gap = axes.equation(line.gap_row(i, window.clone(), row));
        unknowns.write(system.row(r), (&gap, row), line.grid, axes);
    }
    for (r, &i) in stuck.iter().enumerate() {
        let slip = axes.equation(line.slip_row(i, window.clone(), row));
        unknowns.write(system.row(closed.len() + r), (&slip, row), line.grid, axes);
    }
    for (r, &axis) in unknowns.axes.iter().enumerate() {
        let balance = axes.row(axis, line, row);
        unknowns.write(system.row(closed.len() + stuck.len() + r), (&balance, row), line.grid, axes);
    }
}
