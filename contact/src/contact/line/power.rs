//! Power of the contact forces: it goes into friction, and comes from thermal expansion.
//!
//! Slopes are central differences: for these, not for upwind ones, the forces do no work on the derivative of their own
//! displacement, so that the power of hub, friction and expansion balances. Derivation: `docs/theory/lever-arms.md`.

use super::contact_line::ContactLine;

impl ContactLine<'_> {
    /// Takes the power [W/m] that friction turns from mechanical energy into heat, contact forces times relative
    /// velocity less what hot material gives back by expanding; returns it and its energy in the step [J/m]: the
    /// impulse of every force times the mean velocity.
    pub fn take_friction_power(&mut self) -> [f64; 2] {
        let rest = self.slope_power() - self.expansion();
        let Self { grid, problem, iterate, history, state, .. } = self;
        let of_node = |place: usize| match place.checked_sub(grid.len()) {
            Some(i) => [state.lateral[i], iterate.centred_slip[1][i]],
            None => [state.forces[grid.component(place)], iterate.centred_slip[0][place]],
        };
        history.friction.advance(&problem.time, rest, of_node)
    }

    /// Power [W/m] of pressure on the slope of the deformed rail where the surfaces slide over each other.
    fn slope_power(&self) -> f64 {
        let rail = &self.state.surface[1];
        let slope = |i: usize| self.grid.slope(rail, i, 1) + self.swelling_slope(1, i);
        let load: f64 = self.loaded().map(|i| self.normal(i) * slope(i)).sum();
        (self.rim_velocity() - self.traction.rigid.travel) * load
    }

    /// Power [W/m] that the passing material adds by expanding and shrinking against the contact forces. What the
    /// change of the expansion in time adds is counted by the audit.
    fn expansion(&self) -> f64 {
        let velocity = [self.rim_velocity(), self.traction.rigid.travel];
        let of_node = |i: usize| {
            -self.normal(i) * (velocity[0] * self.swelling_slope(0, i) + velocity[1] * self.swelling_slope(1, i))
        };
        let swelling: f64 = self.loaded().map(of_node).sum();
        let turning = velocity[0] / self.frame.radius;
        let membrane = |body: usize| -> f64 {
            let u = &self.given.layers.membrane[body];
            let of_node = |i: usize| {
                let (tangential, normal, port) = (self.tangential(i), self.normal(i), self.grid.component(i));
                let straight = tangential * self.grid.slope(u, i, 0) + normal * self.grid.slope(u, i, 1);
                let turned = tangential * u[port + 1] - normal * u[port];
                velocity[body] * straight + if body == 0 { turning * turned } else { 0.0 }
            };
            if u.is_empty() { 0.0 } else { self.loaded().map(of_node).sum() }
        };
        swelling + membrane(0) - membrane(1)
    }

    fn swelling_slope(&self, body: usize, i: usize) -> f64 {
        let at = |k: Option<usize>| k.map_or(0.0, |k| self.given.layers.swelling_at(body, k));
        (at(Some(i + 1)) - at(i.checked_sub(1))) / self.grid.span(i)
    }
}
