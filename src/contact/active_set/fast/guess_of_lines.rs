//! Guess of the closed nodes of several lines on uneven surfaces: as [`super::initial_guess`] for a single one, but
//! with the gaps of all lines and the balance of the height in one system of equations.

use crate::contact::active_set::axes::{Axes, Equation};
use crate::contact::active_set::states::{Comparison, guess_state};
use crate::contact::active_set::unknowns::Unknowns;
use crate::contact::line::contact_line::ContactLine;
use crate::contact::line::state::NodeStatus;
use crate::linalg::DenseSystem;
use nalgebra::DVector;

/// Guesses of the closed nodes at most.
const MAX_GUESSES: usize = 6;

/// Memory of the guess.
#[derive(Default)]
pub struct GuessOfLines {
    unknowns: Unknowns,
    system: DenseSystem,
    /// Tangential forces at the candidates of every line before the guess [N/m].
    shear: Vec<Vec<f64>>,
    before: Vec<NodeStatus>,
}

impl GuessOfLines {
    /// Sets closed nodes, gaps, normal forces and height of the hub to those that belong to the shear forces and
    /// velocities at hand, where the surfaces are uneven. `rows` is memory for the coefficients of all ports.
    pub fn find(&mut self, lines: &mut [ContactLine], axes: &Axes, comparison: Comparison, rows: &mut [Vec<f64>]) {
        let skipped = |line: &ContactLine| line.given.rail_slope.is_empty() || line.problem.time.is_stationary();
        if lines.iter().all(skipped) {
            return;
        }
        type Start = (Vec<NodeStatus>, DVector<f64>, f64);
        let of_line =
            |line: &ContactLine| (line.state.status.clone(), line.traction.port_forces.clone(), line.traction.rigid[1]);
        let starts: Vec<Start> = lines.iter().map(of_line).collect();
        if self.settle(lines, axes, comparison, rows) {
            return;
        }
        for (line, (status, forces, height)) in lines.iter_mut().zip(starts) {
            line.state.status = status;
            line.traction.port_forces = forces;
            line.traction.rigid[1] = height;
        }
    }

    /// Guesses until the closed nodes stay; `false` if nothing is closed or they do not.
    fn settle(
        &mut self,
        lines: &mut [ContactLine],
        axes: &Axes,
        comparison: Comparison,
        rows: &mut [Vec<f64>],
    ) -> bool {
        lines.iter_mut().for_each(ContactLine::update_rim);
        let of_line = |line: &ContactLine| (0..line.grid.len()).map(|i| line.tangential(i)).collect();
        self.shear = lines.iter().map(of_line).collect();
        for _ in 0..MAX_GUESSES {
            self.unknowns.list_pressures(lines, axes);
            let pressed = self.press(lines, axes, rows).is_some();
            if pressed && !self.close(lines, axes, comparison, rows) {
                return true;
            }
            if self.unknowns.closed() == 0 {
                break;
            }
        }
        false
    }

    /// Solves for the normal forces of the closed nodes, and for the height of the hub if that is sought.
    fn press(&mut self, lines: &mut [ContactLine], axes: &Axes, rows: &mut [Vec<f64>]) -> Option<()> {
        let Self { unknowns, system, shear, .. } = self;
        system.reset(unknowns.len());
        let grid = lines.first()?.grid;
        let mut r = 0;
        for k in 0..lines.len() {
            for &i in &unknowns.lines[k].closed {
                let gap = gap(lines, axes, (k, i), rows);
                unknowns.write(system.row(r), (&sheared(gap, lines, axes, shear, rows), rows), grid, axes);
                r += 1;
            }
        }
        for &axis in &unknowns.axes {
            let balance = axes.row(axis, lines, rows);
            unknowns.write(system.row(r), (&sheared(balance, lines, axes, shear, rows), rows), grid, axes);
            r += 1;
        }
        let solution = system.solve()?;
        unknowns.accept(solution, lines, axes);
        for (line, shear) in lines.iter_mut().zip(shear) {
            for (i, force) in shear.iter().enumerate().filter(|(i, _)| line.state.status[*i].is_active()) {
                line.traction.port_forces[grid.port(i)] = *force;
            }
        }
        lines.iter().all(|line| line.traction.rigid[1].is_finite()).then_some(())
    }

    /// Opens closed nodes that pull and closes open ones that overlap; returns whether there were any.
    fn close(&mut self, lines: &mut [ContactLine], axes: &Axes, comparison: Comparison, rows: &mut [Vec<f64>]) -> bool {
        let mut changed = false;
        for k in 0..lines.len() {
            self.before.clone_from(&lines[k].state.status);
            for i in 0..lines[k].grid.len() {
                let equation = gap(lines, axes, (k, i), rows);
                let equation = sheared(equation, lines, axes, &self.shear, rows);
                let of_normal = |(line, row): (&ContactLine, &Vec<f64>)| -> f64 {
                    (0..line.grid.len()).map(|n| row[line.grid.port(n) + 1] * line.normal(n)).sum()
                };
                let height = if axes.seeks(1) { equation.motions[1] * lines[k].traction.rigid[1] } else { 0.0 };
                let by_forces: f64 = lines.iter().zip(&*rows).map(of_normal).sum();
                let gap = axes.constant(&equation) + height + by_forces;
                changed |= guess_state(&mut lines[k], i, gap, comparison, &self.before);
            }
        }
        changed
    }
}

/// Gap at node `i` of line `k`; writes the coefficients of all port forces of every line to `rows`.
fn gap(lines: &[ContactLine], axes: &Axes, (k, i): (usize, usize), rows: &mut [Vec<f64>]) -> Equation {
    let (line, mut own) = (&lines[k], None);
    for (j, row) in rows.iter_mut().enumerate() {
        let window = 0..row.len();
        match j == k {
            true => own = Some(line.gap_row(i, window, row)),
            false => line.gap_by_shared(i, lines[j].problem.share, window, row),
        }
    }
    axes.equation(own.unwrap_or_default())
}

/// An equation with the shear forces and the velocities at hand as known.
fn sheared(
    mut equation: Equation,
    lines: &[ContactLine],
    axes: &Axes,
    shear: &[Vec<f64>],
    rows: &[Vec<f64>],
) -> Equation {
    for ((line, shear), row) in lines.iter().zip(shear).zip(rows) {
        equation.constant += shear.iter().enumerate().map(|(i, force)| row[line.grid.port(i)] * force).sum::<f64>();
    }
    for axis in [0, 2].into_iter().filter(|&axis| axes.seeks(axis)) {
        equation.constant += equation.motions[axis] * lines[0].traction.rigid[axis];
    }
    equation
}
