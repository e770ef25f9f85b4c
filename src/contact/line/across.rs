//! Lateral direction of a line: displacements, slips and forces across, which plane bodies do not feel.
//!
//! A lateral force displaces its own line as a logarithm and all lines of the patch as polynomials
//! ([`crate::contact::flexibility`]); the lateral motion of the hub and the spin add to the slip.

use super::alone::Alone;
use super::contact_line::{ContactLine, LineAcross, LineIterate};
use crate::contact::flexibility::at;
use crate::contact::line::state::AcrossNodes;

impl ContactLine<'_> {
    /// True if tractions and slips have a lateral part.
    pub fn is_sideways(&self) -> bool {
        !self.state.across.force.is_empty()
    }

    /// Lateral force on the wheel at candidate `i` [N/m].
    pub fn lateral(&self, i: usize) -> f64 {
        self.state.across.force.get(i).copied().unwrap_or(0.0)
    }

    /// Friction on the wheel at candidate `i`, along and across [N/m].
    pub fn shear(&self, i: usize) -> [f64; 2] {
        [self.tangential(i), self.lateral(i)]
    }

    /// Spin velocity [rad/s].
    pub fn spin_velocity(&self) -> f64 {
        self.spin.velocity(self.traction.rigid)
    }

    /// Displacement of the wheel less that of the rail at the node `at` by a unit of lateral force at candidate `by`
    /// [m/(N/m)].
    pub fn lateral_flexibility(&self, at: usize, by: usize) -> f64 {
        let node = self.grid.component(by) / 2;
        2.0 * self.alone().by_force(2, at, node)
            + if at == node { self.problem.layer / self.grid.width(by) } else { 0.0 }
    }

    /// Takes displacements and slips across under the present forces and motions.
    pub(super) fn evaluate_across(&mut self) {
        let (speed, to_right, spin) =
            (self.traction.rigid.travel + self.rim_velocity(), self.upstream_right(), self.spin_velocity());
        self.displace_across();
        let (grid, problem) = (self.grid, self.problem);
        for i in 0..grid.len() {
            let (mut slip, mut centred) = (0.0, 0.0);
            if self.state.status[i].is_active() {
                let known = self.state.across.gap[i].offset(&problem.time);
                let still = self.traction.rigid.lateral + spin * grid.x[i] + known;
                let (node, displaced) = (grid.component(i) / 2, &self.iterate.across.displaced);
                let rigid = still + problem.time.a0 * self.moved_across(i) - 0.5 * speed * self.stretch_across(i);
                let upwind = self.stencil(i, self.iterate.upwind.row(i), to_right);
                let strain: f64 = upwind.iter().map(|(port, weight)| weight * displaced[port / 2]).sum();
                slip = rigid - 0.5 * speed * strain;
                centred = rigid - 0.5 * speed * (displaced[node + 1] - displaced[node - 1]) / grid.span(i);
            }
            self.state.across.slip[i] = slip;
            self.iterate.across.centred_slip[i] = centred;
        }
    }

    /// Takes the displacements at all nodes by the line's own lateral forces.
    fn displace_across(&mut self) {
        let Self { grid, problem, iterate, state, kernel, .. } = self;
        let LineIterate { across, displaced: body, .. } = &mut **iterate;
        across.centred_slip.resize(grid.len(), 0.0);
        across.displaced.clear();
        across.displaced.resize(grid.components() / 2, 0.0);
        let first = grid.component(0) / 2;
        Alone { kernel: *kernel, grid }.displace(2, first, &state.across.force, body);
        across.displaced.iter_mut().zip(&*body).for_each(|(both, body)| *both = 2.0 * body);
        for (i, force) in state.across.force.iter().enumerate().filter(|_| problem.layer > 0.0) {
            across.displaced[first + i] += force * problem.layer / grid.width(i);
        }
    }

    /// Lateral displacement of the wheel less that of the rail at candidate `i` \[m].
    fn moved_across(&self, i: usize) -> f64 {
        let by_lines = |powers| at(&self.iterate.across.field.displacement, &powers);
        let by_lines = self.problem.patch.map_or(0.0, |patch| by_lines(patch.powers(self.grid.x[i])));
        self.iterate.across.displaced[self.grid.component(i) / 2] + by_lines
    }

    /// Slope along the line of the lateral displacement by all lines of the patch at candidate `i` \[1].
    fn stretch_across(&self, i: usize) -> f64 {
        let Some(patch) = self.problem.patch else { return 0.0 };
        at(&self.iterate.across.field.strain, &patch.powers(self.grid.x[i])) / patch.half_length
    }

    /// Moves the history of the lateral displacements on; returns the elastic energy of the lateral forces [J/m].
    pub(super) fn remember_across(&mut self) -> f64 {
        let time = self.problem.time;
        for i in 0..self.state.across.gap.len() {
            let moved = self.moved_across(i);
            self.state.across.gap[i].reach(&time, moved);
        }
        self.remember_width(1);
        let (first, LineAcross { displaced, moments, field, .. }) = (self.grid.component(0) / 2, &self.iterate.across);
        let own = self.state.across.force.iter().zip(&displaced[first.min(displaced.len())..]);
        let by_lines = moments.iter().zip(&field.displacement).map(|(moment, by)| moment * by);
        0.5 * (own.map(|(force, moved)| force * moved).sum::<f64>() + by_lines.sum::<f64>())
    }

    /// Length of the mean slip velocity along and across over the closed nodes, by their normal forces [m/s]: it vanishes
    /// where they stick.
    pub fn slip_speed(&self) -> f64 {
        let (mut sum, mut load) = ([0.0; 2], 0.0);
        for (i, status) in self.state.status.iter().enumerate() {
            let weight = self.normal(i).max(0.0);
            load += weight;
            if !status.is_stuck() {
                sum[0] += weight * self.state.slip[i];
                sum[1] += weight * self.state.across.slip.get(i).copied().unwrap_or(0.0);
            }
        }
        if load > 0.0 { libm::hypot(sum[0] / load, sum[1] / load) } else { 0.0 }
    }

    /// Moment of friction about the vertical through the centre of load, `z F_x − Σ x F_z` \[N].
    pub(super) fn spin_moment(&self) -> f64 {
        let AcrossNodes { force, .. } = &self.state.across;
        let turned: f64 = force.iter().zip(&self.grid.x).map(|(force, x)| force * x).sum();
        let along: f64 = (0..self.grid.len()).map(|i| self.tangential(i)).sum();
        self.problem.position * along - turned
    }
}
