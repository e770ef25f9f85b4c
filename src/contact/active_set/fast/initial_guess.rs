//! Where uneven surfaces will press in the step: a guess from which the active set starts.
//!
//! New material comes under the contact in every step, so that the edges of the patches move, and the search for all
//! states takes two or three iterations where on smooth surfaces it takes one. Pressures hardly depend on the shear. So closed
//! nodes and normal forces are first found by themselves, with the shear forces and velocities of before and the inverses that
//! the [turns](super::alternating) keep. The guess decides nothing; where it fails the search starts from the states of before.

use super::patch_inverse::compliance;
use crate::contact::active_set::iterate::{InitialGuess, Iterate};
use crate::contact::active_set::search::FORCE_TOLERANCE;
use crate::contact::line::state::Status;
use crate::linalg::InverseFactor;
use crate::linalg::vectorised::add_columns;

/// Guesses of the closed nodes at most.
const MAX_GUESSES: usize = 6;

/// Balance of the height of the hub.
struct HeightBalance {
    /// Coefficient of the height, and what is known.
    by_height: f64,
    known: f64,
}

impl Iterate<'_> {
    /// Sets closed nodes, gaps, normal forces and height of the hub to those that belong to the shear forces and velocities at
    /// hand, where the surfaces are uneven. `penalty`: see [`Self::run`].
    pub(in crate::contact::active_set) fn guess_closed(&mut self, penalty: f64) {
        if self.scratch.dents.is_empty() || self.problem.time.is_stationary() {
            return;
        }
        let mut memory = std::mem::take(&mut self.scratch.initial_guess);
        memory.status.clone_from(&self.state.status);
        memory.port_forces.clone_from(&self.traction.port_forces);
        let height = self.traction.rigid[1];
        if self.guess(penalty, &mut memory).is_none() {
            self.state.status.clone_from(&memory.status);
            self.traction.port_forces.clone_from(&memory.port_forces);
            self.traction.rigid[1] = height;
        }
        self.scratch.initial_guess = memory;
    }

    /// Guesses until the closed nodes stay; `None` if nothing is closed or they do not.
    fn guess(&mut self, penalty: f64, memory: &mut InitialGuess) -> Option<()> {
        self.write_rim_angle();
        let mut row = std::mem::take(&mut self.scratch.row);
        let balance = self.write_base(memory, &mut row);
        let mut settled = false;
        for _ in 0..MAX_GUESSES {
            settled = self.press(memory, &row, &balance).is_some() && !self.close(penalty, memory);
            if settled || self.scratch.closed.is_empty() {
                break;
            }
        }
        self.scratch.row = row;
        settled.then_some(())
    }

    /// Writes the gap without normal forces and height, and the balance of the height, whose force coefficients go to `row`;
    /// `None` if the height is prescribed.
    fn write_base(&self, memory: &mut InitialGuess, row: &mut [f64]) -> Option<HeightBalance> {
        let (free, [v, height, omega]) = (self.problem.rigid[1].target().is_none(), self.traction.rigid);
        let motions = [v, if free { 0.0 } else { height }, omega];
        let of_motions = |rigid: [f64; 3]| rigid.iter().zip(motions).map(|(by, value)| by * value).sum::<f64>();
        let InitialGuess { base, by_height, displaced, forces, .. } = memory;
        forces.clear();
        forces.extend((0..self.grid.len()).map(|i| self.tangential(i)));
        self.displace(0, forces, displaced);
        let turned: f64 =
            (0..self.grid.len()).map(|i| self.scratch.rim_angle.forces[self.grid.port(i)] * forces[i]).sum();
        base.clear();
        by_height.clear();
        for i in 0..self.grid.len() {
            let terms = self.gap_terms(i);
            let of_forces = displaced[self.grid.port(i) + 1] - self.grid.x[i] * turned;
            base.push(terms.constant + of_motions(terms.rigid) + of_forces);
            by_height.push(if free { terms.rigid[1] } else { 0.0 });
        }
        free.then(|| {
            let terms = self.axis_row(1, row);
            let of_shear: f64 = forces.iter().enumerate().map(|(i, force)| row[self.grid.port(i)] * force).sum();
            HeightBalance { by_height: terms.rigid[1], known: -terms.constant - of_motions(terms.rigid) - of_shear }
        })
    }

    /// Displacements of all ports by normal (`offset` 1) or tangential (0) forces at the candidates.
    fn displace(&self, offset: usize, forces: &[f64], displaced: &mut Vec<f64>) {
        let relative = self.problem.bodies.relative;
        displaced.clear();
        displaced.resize(relative.nrows(), 0.0);
        let columns = &relative.as_slice()[(self.grid.port(0) + offset) * relative.nrows()..];
        add_columns(1.0, columns, 2 * relative.nrows(), forces, displaced);
    }

    /// Solves for the normal forces of the closed nodes, and for the height of the hub if that is free; `row`: force coefficients
    /// of its balance.
    fn press(&mut self, memory: &mut InitialGuess, row: &[f64], balance: &Option<HeightBalance>) -> Option<()> {
        let mut closed = std::mem::take(&mut self.scratch.closed);
        closed.clear();
        closed.extend((0..self.grid.len()).filter(|&i| self.state.status[i].is_active()));
        self.scratch.closed = closed;
        let closed = &self.scratch.closed;
        let InitialGuess { base, by_height, normal: [known, raised, tilted], .. } = memory;
        [&mut *known, &mut *raised, &mut *tilted].into_iter().for_each(Vec::clear);
        known.extend(closed.iter().map(|&i| {
            let yields = if self.state.yielded[i] { self.creep(i) * self.scratch.limit[i] } else { 0.0 };
            yields - base[i]
        }));
        raised.extend(closed.iter().map(|&i| -by_height[i]));
        tilted.extend(closed.iter().map(|&i| self.grid.x[i]));
        self.solve_pressures(memory)?;
        let InitialGuess { normal: [known, raised, tilted], .. } = memory;
        let sum = |coefficients: &[f64], forces: &[f64]| -> f64 {
            let closed = self.scratch.closed.iter();
            closed.zip(forces).map(|(&i, force)| coefficients[self.grid.port(i) + 1] * force).sum()
        };
        // Height and turn of the rim by these forces: two equations.
        let turned = [&*known, raised, tilted].map(|forces| sum(&self.scratch.rim_angle.forces, forces));
        let (height, turn) = match balance {
            Some(balance) => {
                let of = [&*known, raised, tilted].map(|forces| sum(row, forces));
                let (side, by_height) = (balance.known - of[0], balance.by_height + of[1]);
                let turn =
                    (turned[0] * by_height + turned[1] * side) / ((1.0 - turned[2]) * by_height + turned[1] * of[2]);
                ((side - of[2] * turn) / by_height, turn)
            }
            None => (0.0, turned[0] / (1.0 - turned[2])),
        };
        if balance.is_some() {
            self.traction.rigid[1] = height;
        }
        for i in 0..self.grid.len() {
            let port = self.grid.port(i);
            self.traction.port_forces[port + 1] = 0.0;
            if !self.state.status[i].is_active() {
                self.traction.port_forces[port] = 0.0;
            }
        }
        for (n, &i) in self.scratch.closed.iter().enumerate() {
            self.traction.port_forces[self.grid.port(i) + 1] = known[n] + height * raised[n] + turn * tilted[n];
        }
        (height + turn).is_finite().then_some(())
    }

    /// Replaces gaps to be closed by the forces that close them.
    fn solve_pressures(&mut self, memory: &mut InitialGuess) -> Option<()> {
        let InitialGuess { normal, factor, product, .. } = memory;
        let patch = self.single_patch();
        let mut kept = std::mem::take(&mut self.scratch.kept);
        let known = patch.and_then(|patch| kept.factor(self.problem, self.grid, &patch));
        let factor = match known {
            Some(factor) => Some(factor),
            None => self.factorise(factor).map(|()| &*factor),
        };
        let solved = factor.map(|factor| normal.iter_mut().for_each(|forces| factor.solve(forces, product)));
        self.scratch.kept = kept;
        solved
    }

    /// Factorises the compliance of the closed nodes, of which some may yield.
    fn factorise(&self, factor: &mut InverseFactor) -> Option<()> {
        let closed = &self.scratch.closed;
        factor.truncate(0);
        for (n, &i) in closed.iter().enumerate() {
            let creep = if self.state.yielded[i] { self.creep(i) } else { 0.0 };
            let beside = closed[..n].iter().map(|&j| compliance(self.problem, self.grid, i, j));
            factor.append(beside, compliance(self.problem, self.grid, i, i) + creep)?;
        }
        Some(())
    }

    /// Opens closed nodes that pull and closes open ones that overlap; returns whether there were any.
    fn close(&mut self, penalty: f64, memory: &mut InitialGuess) -> bool {
        let tolerance = FORCE_TOLERANCE[0] * self.problem.nominal_load / self.grid.len() as f64;
        let InitialGuess { base, by_height, displaced, forces, .. } = memory;
        forces.clear();
        forces.extend((0..self.grid.len()).map(|i| self.normal(i)));
        self.displace(1, forces, displaced);
        let turned: f64 =
            (0..self.grid.len()).map(|i| self.scratch.rim_angle.forces[self.grid.port(i) + 1] * forces[i]).sum();
        self.scratch.status_before.clone_from(&self.state.status);
        let mut changed = false;
        for i in 0..self.grid.len() {
            let old = self.scratch.status_before[i];
            let gap = base[i] + by_height[i] * self.traction.rigid[1] + displaced[self.grid.port(i) + 1]
                - self.grid.x[i] * turned;
            self.state.gap[i] = if old.is_active() { 0.0 } else { gap };
            let indicator = if old.is_active() { self.normal(i) } else { -penalty * gap };
            if indicator.abs() <= tolerance || (indicator > 0.0) == old.is_active() {
                continue;
            }
            self.state.status[i] = if old.is_active() { Status::Open } else { self.closing_state(i, 1) };
            changed = true;
        }
        changed
    }
}
