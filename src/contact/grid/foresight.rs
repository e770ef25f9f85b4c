//! Where uneven surfaces will press in the step: a guess from which the active set starts.
//!
//! New material comes under the contact in every step, so that the edges of the patches move, and the search for all
//! states takes two or three iterations where on smooth surfaces it takes one. Pressures hardly depend on the shear. So closed
//! nodes and normal forces are first found by themselves, with the shear forces and velocities of before: half of the unknowns,
//! an eighth of the work. The guess decides nothing; where it fails the search starts from the states of before.

use super::active_set::FORCE_TOLERANCE;
use super::iterate::Iterate;
use super::linear::largest;
use super::state::Status;
use crate::linalg::DenseSystem;
use crate::linalg::vectorised::dot;
use std::ops::Range;

/// Guesses of the closed nodes at most.
const MAX_GUESSES: usize = 6;

impl Iterate<'_> {
    /// Sets closed nodes, gaps, normal forces and height of the hub to those that belong to the shear forces and velocities at
    /// hand, where the surfaces are uneven. `penalty`: see [`Self::run`].
    pub(super) fn foresee(&mut self, penalty: f64) {
        if self.scratch.dents.is_empty() || self.problem.time.is_stationary() {
            return;
        }
        let before = (self.state.status.clone(), self.traction.port_forces.clone(), self.traction.rigid);
        let mut system = std::mem::take(&mut self.scratch.system);
        let found = self.guess(penalty, &mut system);
        self.scratch.system = system;
        if found.is_none() {
            (self.state.status, self.traction.port_forces, self.traction.rigid) = before;
        }
    }

    /// Guesses until the closed nodes stay; `None` if nothing is closed or they do not.
    fn guess(&mut self, penalty: f64, system: &mut DenseSystem) -> Option<()> {
        let mut row = std::mem::take(&mut self.scratch.row);
        self.write_turn();
        let mut settled = false;
        for _ in 0..MAX_GUESSES {
            settled = self.press(system, &mut row).is_some_and(|window| !self.close(penalty, window, &mut row));
            if settled || self.scratch.closed.is_empty() {
                break;
            }
        }
        self.scratch.row = row;
        settled.then_some(())
    }

    /// Solves for the normal forces of the closed nodes, and for the height of the hub if that is free. Returns the ports
    /// from the first to the last closed node.
    fn press(&mut self, system: &mut DenseSystem, row: &mut [f64]) -> Option<Range<usize>> {
        let mut closed = std::mem::take(&mut self.scratch.closed);
        closed.clear();
        closed.extend((0..self.grid.len()).filter(|&i| self.state.status[i].is_active()));
        let window = self.grid.port(*closed.first()?)..self.grid.port(*closed.last()?) + 2;
        let free = self.problem.rigid[1].target().is_none();
        for i in 0..self.grid.len() {
            let port = self.grid.port(i);
            self.traction.port_forces[port + 1] = 0.0;
            if !self.state.status[i].is_active() {
                self.traction.port_forces[port] = 0.0;
            }
        }
        system.reset(closed.len() + usize::from(free));
        for r in 0..closed.len() + usize::from(free) {
            let affine = match closed.get(r) {
                Some(&i) => self.gap_row(i, window.clone(), row),
                None => self.axis_row(1, row),
            };
            let (target, rhs) = system.row(r);
            target.iter_mut().zip(&closed).for_each(|(value, &i)| *value = row[self.grid.port(i) + 1]);
            *rhs = -affine.constant - dot(&row[window.clone()], &self.traction.port_forces.as_slice()[window.clone()]);
            for k in (0..3).filter(|k| !free || *k != 1) {
                *rhs -= affine.rigid[k] * self.traction.rigid[k];
            }
            if free {
                target[closed.len()] = affine.rigid[1];
            }
            let scale = 1.0 / largest(target);
            target.iter_mut().for_each(|value| *value *= scale);
            *rhs *= scale;
        }
        self.scratch.closed = closed;
        let solution = system.solve()?;
        for (&i, force) in self.scratch.closed.iter().zip(solution) {
            self.traction.port_forces[self.grid.port(i) + 1] = *force;
        }
        if free {
            self.traction.rigid[1] = *solution.last()?;
        }
        Some(window)
    }

    /// Opens closed nodes that pull and closes open ones that overlap; returns whether there were any.
    fn close(&mut self, penalty: f64, window: Range<usize>, row: &mut [f64]) -> bool {
        let tolerance = FORCE_TOLERANCE[0] * self.problem.nominal_load / self.grid.len() as f64;
        self.scratch.status_before.clone_from(&self.state.status);
        let mut changed = false;
        for i in 0..self.grid.len() {
            let old = self.scratch.status_before[i];
            self.state.gap[i] = if old.is_active() { 0.0 } else { self.gap_at(i, window.clone(), row) };
            let indicator = if old.is_active() { self.normal(i) } else { -penalty * self.state.gap[i] };
            if indicator.abs() <= tolerance || (indicator > 0.0) == old.is_active() {
                continue;
            }
            self.state.status[i] = if old.is_active() { Status::Open } else { self.closing_state(i, 1) };
            changed = true;
        }
        changed
    }

    /// Gap at an open candidate [m].
    fn gap_at(&self, i: usize, window: Range<usize>, row: &mut [f64]) -> f64 {
        let affine = self.gap_row(i, window.clone(), row);
        let of_forces = dot(&row[window.clone()], &self.traction.port_forces.as_slice()[window]);
        let of_motions = affine.rigid.iter().zip(self.traction.rigid).map(|(c, v)| c * v);
        affine.constant + of_forces + of_motions.sum::<f64>()
    }
}
