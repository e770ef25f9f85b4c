//! Guess of the closed nodes on uneven surfaces, from which the active set starts.
//!
//! New material comes under the contact in every step, so that the edges of the patches move, and the search for all
//! states takes two or three iterations where on smooth surfaces it takes one. Pressures hardly depend on the shear. So
//! closed nodes and normal forces are first found by themselves, with the shear forces and velocities of before. The
//! guess decides nothing; where it fails the search starts from the states of before. Without it every result takes
//! longer and is the same but for the tolerance of the edges: forces on a rough rail change by 1.4e-5.

use super::axes::Axes;
use super::linear::LinearSolver;
use super::present::{self, Present};
use super::states::{Rules, guess_state};
use super::unknowns::Unknowns;
use crate::contact::error::ContactError;
use crate::contact::line::contact_line::ContactLine;
use crate::contact::line::exchange;
use crate::contact::line::state::NodeStatus;

/// Iterations at most.
const MOST: usize = 6;

/// Memory of the guess.
#[derive(Default)]
pub(super) struct Guess {
    starts: Vec<Present>,
    unknowns: Unknowns,
    /// Tangential forces at the candidates of every line [N/m].
    shear: Vec<Vec<f64>>,
    /// States before an update.
    before: Vec<NodeStatus>,
}

impl Guess {
    /// Sets closed nodes, gaps, normal forces and height of the hub to those that belong to the shear forces and
    /// velocities at hand, where the surfaces are uneven, then the displacements to these forces: lever arms of the step
    /// before would leave a moment that takes an iteration more.
    pub fn find(&mut self, lines: &mut [ContactLine], axes: &Axes, rules: &Rules, solver: &mut LinearSolver) {
        let skipped = |line: &ContactLine| line.given.rail_slope.is_empty() || line.problem.time.is_stationary();
        if lines.iter().all(skipped) {
            return;
        }
        present::take(lines, &mut self.starts);
        if !matches!(self.press(lines, axes, rules, solver), Ok(true)) {
            present::give_back(&self.starts, lines);
            return;
        }
        lines.iter_mut().for_each(slide);
        exchange::forces(lines);
        for line in lines {
            line.follow_forces(axes.sought_accelerations(line.traction.rigid));
        }
    }

    /// Sets closed nodes, gaps, normal forces and height of the hub to those that belong to the shear forces and velocities at
    /// hand; true if states settled.
    fn press(
        &mut self,
        lines: &mut [ContactLine],
        axes: &Axes,
        rules: &Rules,
        solver: &mut LinearSolver,
    ) -> Result<bool, ContactError> {
        lines.iter_mut().for_each(ContactLine::update_rim);
        self.shear.resize_with(lines.len(), Vec::new);
        for (line, shear) in lines.iter().zip(&mut self.shear) {
            shear.clear();
            shear.extend((0..line.grid.len()).map(|i| line.tangential(i)));
        }
        let settled = self.settle(lines, axes, rules, solver);
        // Open nodes have kept their shear so far, so that they press on the same surfaces when they close.
        for line in lines {
            for i in (0..line.grid.len()).filter(|&i| !line.state.status[i].is_active()) {
                line.state.forces[line.grid.component(i)] = 0.0;
                line.state.lateral.get_mut(i).into_iter().for_each(|lateral| *lateral = 0.0);
            }
        }
        settled
    }

    /// Iterates until closed nodes and pressures under the shear forces at hand settle; true if they do.
    fn settle(
        &mut self,
        lines: &mut [ContactLine],
        axes: &Axes,
        rules: &Rules,
        solver: &mut LinearSolver,
    ) -> Result<bool, ContactError> {
        for _ in 0..MOST {
            self.unknowns.list_pressures(lines, axes);
            solver.solve(lines, (axes, &self.unknowns), Some(&self.shear))?;
            exchange::forces(lines);
            for line in &mut *lines {
                line.follow_forces(axes.sought_accelerations(line.traction.rigid));
                line.take_gaps();
            }
            if !self.close(lines, rules) {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Opens closed nodes that pull and closes open ones that overlap; returns whether there were any.
    fn close(&mut self, lines: &mut [ContactLine], rules: &Rules) -> bool {
        let mut changed = false;
        for line in lines {
            self.before.clone_from(&line.state.status);
            for i in 0..line.grid.len() {
                changed |= guess_state(line, i, rules, &self.before);
            }
        }
        changed
    }
}

/// Gives nodes that slip the shear forces of friction under the pressures at hand.
fn slide(line: &mut ContactLine) {
    for i in 0..line.grid.len() {
        let status = line.state.status[i];
        if status.is_active() && !status.is_stuck() {
            let shear = line.slide(i).direction.map(|part| part * line.friction(i) * line.normal(i));
            line.state.forces[line.grid.component(i)] = shear[0];
            line.state.lateral.get_mut(i).into_iter().for_each(|lateral| *lateral = shear[1]);
        }
    }
}
