//! Power of the contact forces: it goes into friction, and comes from thermal expansion.
//!
//! Slopes are central differences: for these, not for upwind ones, the forces do no work on the derivative of their own
//! displacement, so that the power of hub, friction and expansion balances. Derivation: `docs/theory/lever-arms.md`.

use super::grid::ContactGrid;
use super::history::FrictionHistory;
use super::hot_layers::HotLayers;
use super::rim::RimFrame;
use crate::contact::traction::Traction;
use crate::multistep::TimeDerivative;

/// Contact forces and motions of a solution.
pub(in crate::contact) struct Power<'a> {
    pub grid: &'a ContactGrid,
    pub traction: &'a Traction,
    /// Frame that turns with the rim.
    pub frame: &'a RimFrame<'a>,
    /// Velocity with which the rim passes the contact [m/s].
    pub rim_velocity: f64,
    /// Slip velocity at the candidates with central differences [m/s].
    pub slip: &'a [f64],
    /// Hot layers of wheel and rail.
    pub layers: &'a HotLayers,
    /// Force by which the retarded layer of the rail relieves the hub [N/m].
    pub retarded: f64,
}

impl Power<'_> {
    /// Power [W/m] that friction turns from mechanical energy into heat, contact forces times relative velocity less
    /// what hot material gives back by expanding, and its energy in a step with the time formula `time` [J/m]: the
    /// impulse of every force times the mean velocity.
    pub fn friction(&self, time: &TimeDerivative, history: &mut FrictionHistory) -> [f64; 2] {
        history.advance(time, self.slope_power() - self.expansion(), |i| [self.forces(i)[0], self.slip[i]])
    }

    /// Power [W/m] of pressure on the slope of the deformed rail where the surfaces slide over each other.
    fn slope_power(&self) -> f64 {
        let rail = &self.traction.surface[1];
        let slope = |i: usize| self.grid.slope(rail, i, 1) + self.swelling_slope(1, i);
        let load: f64 = (0..self.grid.len()).map(|i| self.forces(i)[1] * slope(i)).sum();
        (self.rim_velocity - self.traction.rigid.travel) * (load + self.retarded)
    }

    /// Power [W/m] that the passing material adds by expanding and shrinking against the contact forces. What the
    /// change of the expansion in time adds is counted by the audit.
    fn expansion(&self) -> f64 {
        let velocity = [self.rim_velocity, self.traction.rigid.travel];
        let of_node = |i: usize| {
            let [_, normal] = self.forces(i);
            -normal * (velocity[0] * self.swelling_slope(0, i) + velocity[1] * self.swelling_slope(1, i))
        };
        let swelling: f64 = (0..self.grid.len()).map(of_node).sum();
        let turning = self.rim_velocity / self.frame.radius;
        let membrane = |body: usize| -> f64 {
            let u = &self.layers.membrane[body];
            let of_node = |i: usize| {
                let ([tangential, normal], port) = (self.forces(i), self.grid.port(i));
                let straight = tangential * self.grid.slope(u, i, 0) + normal * self.grid.slope(u, i, 1);
                let turned = tangential * u[port + 1] - normal * u[port];
                velocity[body] * straight + if body == 0 { turning * turned } else { 0.0 }
            };
            if u.is_empty() { 0.0 } else { (0..self.grid.len()).map(of_node).sum() }
        };
        swelling + membrane(0) - membrane(1)
    }

    fn forces(&self, i: usize) -> [f64; 2] {
        let port = self.grid.port(i);
        [self.traction.port_forces[port], self.traction.port_forces[port + 1]]
    }

    fn swelling_slope(&self, body: usize, i: usize) -> f64 {
        let at = |k: Option<usize>| k.map_or(0.0, |k| self.layers.swelling_at(body, k));
        (at(Some(i + 1)) - at(i.checked_sub(1))) / self.grid.span(i)
    }
}
