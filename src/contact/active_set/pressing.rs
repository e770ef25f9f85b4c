//! Closed nodes, normal forces and height of the hub under known shear forces and velocities.

use super::axes::Axes;
use super::linear::LinearSolver;
use super::states::{Rules, guess_state, yields};
use super::unknowns::Unknowns;
use crate::contact::error::ContactError;
use crate::contact::line::contact_line::ContactLine;
use crate::contact::line::exchange;
use crate::contact::line::state::NodeStatus;

/// How far states of nodes are looked for.
#[derive(Clone, Copy)]
pub(super) struct Thoroughness {
    /// Iterations at most, and those after which only one node changes its state in each.
    pub most: usize,
    pub together: usize,
    /// True if nodes begin and cease to yield.
    pub yields: bool,
}

/// Memory of the normal problem.
#[derive(Default)]
pub(super) struct PressureSearch {
    unknowns: Unknowns,
    /// Shear forces at the candidates of every line [N/m].
    shear: Vec<Vec<f64>>,
    /// States before an update.
    before: Vec<NodeStatus>,
}

impl PressureSearch {
    /// Sets closed nodes, gaps, normal forces and height of the hub to those that belong to the shear forces and
    /// velocities at hand; true if states settled.
    pub fn press(
        &mut self,
        lines: &mut [ContactLine],
        axes: &Axes,
        rules: &Rules,
        thoroughness: Thoroughness,
        solver: &mut LinearSolver,
    ) -> Result<bool, ContactError> {
        lines.iter_mut().for_each(ContactLine::update_rim);
        self.shear.resize_with(lines.len(), Vec::new);
        for (line, shear) in lines.iter().zip(&mut self.shear) {
            shear.clear();
            shear.extend((0..line.grid.len()).map(|i| line.tangential(i)));
        }
        let settled = self.settle(lines, axes, rules, thoroughness, solver);
        // Open nodes have kept their shear so far, so that they press on the same surfaces when they close.
        for line in lines {
            for i in (0..line.grid.len()).filter(|&i| !line.state.status[i].is_active()) {
                line.state.forces[line.grid.component(i)] = 0.0;
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
        thoroughness: Thoroughness,
        solver: &mut LinearSolver,
    ) -> Result<bool, ContactError> {
        for iteration in 0..thoroughness.most {
            self.unknowns.list_pressures(lines, axes);
            solver.solve(lines, (axes, &self.unknowns), Some(&self.shear))?;
            exchange::forces(lines);
            for line in &mut *lines {
                line.follow_forces(axes.sought_accelerations(line.traction.rigid));
                line.take_gaps();
            }
            if !self.close(lines, rules, thoroughness, iteration) {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Opens closed nodes that pull and closes open ones that overlap; returns whether there were any, or yielding has
    /// changed.
    fn close(
        &mut self,
        lines: &mut [ContactLine],
        rules: &Rules,
        thoroughness: Thoroughness,
        iteration: usize,
    ) -> bool {
        let last = iteration >= thoroughness.together;
        let mut changed = false;
        for line in lines {
            self.before.clone_from(&line.state.status);
            for i in 0..line.grid.len() {
                changed |= guess_state(line, i, rules, &self.before);
                if thoroughness.yields {
                    let yields = line.state.status[i].is_active() && yields(line, i, rules.force);
                    changed |= std::mem::replace(&mut line.state.yielded[i], yields) != yields;
                }
                if last && changed {
                    return true;
                }
            }
        }
        changed
    }
}
