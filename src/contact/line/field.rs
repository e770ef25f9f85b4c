//! Displacement of a line by the tangential forces of all lines of its patch.

use super::contact_line::ContactLine;
use crate::contact::flexibility::{ByMoments, ByPowers, at, slip_of_field};
use crate::contact::problem::LineProblem;
use crate::multistep::History;

impl ContactLine<'_> {
    /// Moments of tangential forces [N/m] at candidates with the powers of their places.
    pub fn moments(&self, forces: impl Iterator<Item = (usize, f64)>) -> ByPowers {
        let mut moments = ByPowers::default();
        let Some(patch) = self.problem.patch else { return moments };
        for (i, force) in forces.filter(|(_, force)| *force != 0.0) {
            let powers = patch.powers(self.grid.x[i]);
            moments.iter_mut().zip(powers).for_each(|(moment, power)| *moment += force * power);
        }
        moments
    }

    /// Displacement of the wheel less that of the rail at a candidate \[m].
    pub fn moved_by_lines(&self, i: usize) -> f64 {
        let moved = |powers| at(&self.iterate.field.displacement, &powers);
        self.problem.patch.map_or(0.0, |patch| moved(patch.powers(self.grid.x[i])))
    }

    /// Displacement of the wheel less that of the rail by an elastic layer between them at a tangential port \[m].
    pub fn moved_by_layer(&self, port: usize) -> f64 {
        if self.problem.layer == 0.0 { 0.0 } else { self.state.forces[port] * self.layer_by_force(port) }
    }

    /// That displacement per unit nodal force [m/(N/m)].
    pub fn layer_by_force(&self, port: usize) -> f64 {
        let candidate = (port / 2).checked_sub(self.grid.guard).filter(|i| *i < self.grid.len());
        candidate.map_or(0.0, |i| self.problem.layer / self.grid.width(i))
    }

    /// Elastic energy of the layer [J/m].
    pub fn energy_of_layer(&self) -> f64 {
        let energy = |i: usize| 0.5 * self.tangential(i) * self.moved_by_layer(self.grid.component(i));
        (0..self.grid.len()).map(energy).sum()
    }

    /// Strain of the wheel at a candidate \[1]; that of the rail is the opposite.
    pub fn stretch_by_lines(&self, i: usize) -> f64 {
        let Some(patch) = self.problem.patch else { return 0.0 };
        0.5 * at(&self.iterate.field.strain, &patch.powers(self.grid.x[i])) / patch.half_length
    }

    /// Moves the history of what becomes smaller where the line becomes wider on, along (0) or across (1), see
    /// [`GridState::widened`](super::state::GridState).
    pub(super) fn remember_width(&mut self, direction: usize) {
        let LineProblem { time, patch: Some(patch), size: Some(_), .. } = *self.problem else { return };
        let mut widened = std::mem::take(match direction {
            0 => &mut self.state.widened,
            _ => &mut self.state.across.widened,
        });
        let begins = widened.is_empty();
        widened.resize(self.grid.len(), History::default());
        for (i, history) in widened.iter_mut().enumerate() {
            let port = self.grid.component(i);
            let own = match direction {
                0 => 2.0 * self.iterate.own.along[port],
                _ => 2.0 * self.iterate.displaced[port / 2],
            };
            let growth = at(&self.iterate.growth[direction], &patch.powers(self.grid.x[i]));
            let value = own - 2.0 * growth;
            if begins { *history = History::constant(value) } else { history.reach(&time, value) }
        }
        *match direction {
            0 => &mut self.state.widened,
            _ => &mut self.state.across.widened,
        } = widened;
    }

    /// Slip [m/s] as a polynomial of the place by unit moments of the line number `by` of the patch; `None`: there is
    /// no patch.
    pub fn slip_by_moments(&self, by: usize) -> Option<ByMoments> {
        let patch = self.problem.patch?;
        let between = if by == patch.line { patch.own(0)? } else { *patch.flexibility.between(patch.line, by) };
        let speeds = [self.problem.time.a0, self.traction.rigid.travel + self.rim_velocity()];
        Some(between.slips(slip_of_field(speeds, patch.half_length)))
    }
}
