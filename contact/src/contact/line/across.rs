//! Lateral direction of a line: displacements, slips and forces across, which plane bodies do not feel.
//!
//! A lateral force displaces its own line as a logarithm and all lines of the patch as polynomials
//! ([`crate::contact::flexibility`]); the lateral motion of the hub and the spin add to the slip.

use super::alone::Alone;
use super::contact_line::ContactLine;
use super::state::Slide;

impl ContactLine<'_> {
    /// Lateral force on the wheel at candidate `i` [N/m].
    pub fn lateral(&self, i: usize) -> f64 {
        self.state.lateral.get(i).copied().unwrap_or(0.0)
    }

    /// Friction on the wheel at candidate `i`, along and across [N/m].
    pub fn shear(&self, i: usize) -> [f64; 2] {
        [self.tangential(i), self.lateral(i)]
    }

    /// Slipping of candidate `i`, if it slips.
    pub fn slide(&self, i: usize) -> Slide {
        let along = || Slide { direction: [self.state.status[i].friction_direction(), 0.0], turn: 0.0 };
        if self.state.directions() > 1 { self.iterate.slides[i] } else { along() }
    }

    /// Slip of a node in the middle per force on it [m/s/(N/m)].
    pub fn own_slip(&self) -> f64 {
        let (middle, mut slips) = (self.grid.len() / 2, Vec::new());
        self.slips_by_own(0, (middle, &self.upwind_slip(middle)), &[middle], &mut slips);
        slips.iter().sum::<f64>().abs()
    }

    /// Shear less what would take the slip away from candidate `i` by itself [N/m]: against it the law of friction is judged
    /// where it may have any direction; `None`: it has one.
    pub fn shear_without_slip(&self, i: usize) -> Option<[f64; 2]> {
        let [along, across] = &self.state.slip;
        let (across, shear, own) = (across.get(i)?, self.shear(i), self.iterate.own_slip);
        // A wheel that stands for ever has no slip.
        Some(if own > 0.0 { [shear[0] - along[i] / own, shear[1] - across / own] } else { shear })
    }

    /// Takes displacements and slips across under the present forces and motions.
    pub(super) fn evaluate_across(&mut self) {
        let (speed, to_right) = (self.traction.rigid.travel + self.rim_velocity(), self.upstream_right());
        let [_, across, spin] = self.drift.velocities(self.traction.rigid);
        self.displace_across();
        let (grid, problem) = (self.grid, self.problem);
        for i in 0..grid.len() {
            let (mut slip, mut centred) = (0.0, 0.0);
            if self.state.status[i].is_active() {
                let known = self.state.moved[1][i].offset(&problem.time);
                let still = self.traction.rigid.lateral + across + spin * grid.x[i] + known;
                let (node, displaced) = (grid.component(i) / 2, &self.iterate.displaced);
                let rigid = still + problem.time.a0 * self.moved(1, i) - 0.5 * speed * self.stretch_by_lines(1, i);
                let upwind = self.stencil(i, self.iterate.upwind.row(i), to_right);
                let strain: f64 = upwind.iter().map(|(port, weight)| weight * displaced[port / 2]).sum();
                slip = rigid - 0.5 * speed * strain;
                centred = rigid - 0.5 * speed * (displaced[node + 1] - displaced[node - 1]) / grid.span(i);
            }
            self.state.slip[1][i] = slip;
            self.iterate.centred_slip[1][i] = centred;
        }
    }

    /// Takes the displacements at all nodes by the line's own lateral forces.
    pub fn displace_across(&mut self) {
        if self.state.directions() == 1 {
            return;
        }
        let Self { grid, iterate, state, kernel, .. } = self;
        let (first, displaced) = (grid.component(0) / 2, &mut iterate.displaced);
        Alone { kernel: *kernel, grid }.displace(2, first, &state.lateral, displaced);
        displaced.iter_mut().for_each(|moved| *moved *= 2.0);
        self.displace_layer_across();
    }

    /// Mean slip velocities along and across of the closed nodes [m/s], weighted with their normal forces. They are those of
    /// the friction law, with upwind differences, which vanish where nodes stick.
    pub fn mean_slips(&self) -> [f64; 2] {
        let (mut sums, mut load) = ([0.0; 2], 0.0);
        for (i, status) in self.state.status.iter().enumerate() {
            let weight = self.normal(i).max(0.0);
            load += weight;
            // The rest of the slip at stuck nodes is round-off.
            if !status.is_stuck() {
                let slips = sums.iter_mut().zip(&self.state.slip);
                slips.for_each(|(sum, slip)| *sum += weight * slip.get(i).copied().unwrap_or(0.0));
            }
        }
        if load > 0.0 { sums.map(|sum| sum / load) } else { sums }
    }

    /// Moment of friction about the vertical through the centre of load, `z F_x − Σ x F_z` \[N].
    pub(super) fn spin_moment(&self) -> f64 {
        let turned: f64 = self.state.lateral.iter().zip(&self.grid.x).map(|(force, x)| force * x).sum();
        let along: f64 = (0..self.grid.len()).map(|i| self.tangential(i)).sum();
        self.problem.position * along - turned
    }
}
