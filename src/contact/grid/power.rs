//! Where the power of the contact forces goes: into friction, and out of thermal expansion.
//!
//! Slopes are central differences: for these, not for upwind ones, the forces do no work on the derivative of their own
//! displacement, so that the power of hub, friction and expansion balances. Derivation: `docs/theory/lever-arms.md`.

use super::candidates::ContactGrid;
use super::frame::RimFrame;
use crate::contact::traction::Traction;
use nalgebra::DVector;

/// Contact forces and motions of a solution.
pub(super) struct Power<'a> {
    pub grid: &'a ContactGrid,
    pub traction: &'a Traction,
    /// Turn of the rim.
    pub frame: &'a RimFrame<'a>,
    /// Velocity with which the rim passes the contact [m/s].
    pub rim_velocity: f64,
    /// Slip velocity at the candidates with central differences [m/s].
    pub slip: &'a [f64],
    /// Swelling of the hot layers of wheel and rail at the candidates [m]; empty without any.
    pub swelling: &'a [Vec<f64>; 2],
    /// Displacement of wheel and rail by the membrane forces of their hot layers [m]; empty without any.
    pub membrane: &'a [DVector<f64>; 2],
}

impl Power<'_> {
    /// Power [W/m] that friction dissipates: contact forces times relative velocity, tangential and normal. Where the
    /// surfaces slide over each other, pressure acts on the slope of the deformed rail.
    pub fn friction(&self) -> f64 {
        let rigid_slip = self.traction.rigid[0] - self.rim_velocity;
        let rail = &self.traction.surface[1];
        let of_node = |i: usize| {
            let [tangential, normal] = self.forces(i);
            let slope = self.slope(rail, self.grid.port(i) + 1) + self.swelling_slope(1, i);
            tangential * self.slip[i] + normal * rigid_slip * slope
        };
        -(0..self.grid.len()).map(of_node).sum::<f64>()
    }

    /// Power [W/m] that the passing material adds by expanding and shrinking against the contact forces. What the change of
    /// the expansion in time adds, force times expansion, is not counted: joules in a whole run.
    pub fn expansion(&self) -> f64 {
        let velocity = [self.rim_velocity, self.traction.rigid[0]];
        let of_node = |i: usize| {
            let [_, normal] = self.forces(i);
            -normal * (velocity[0] * self.swelling_slope(0, i) + velocity[1] * self.swelling_slope(1, i))
        };
        let swelling: f64 = (0..self.grid.len()).map(of_node).sum();
        let turning = self.rim_velocity / self.frame.radius;
        let membrane = |body: usize| -> f64 {
            let u = &self.membrane[body];
            let of_node = |i: usize| {
                let ([tangential, normal], port) = (self.forces(i), self.grid.port(i));
                let straight = tangential * self.slope(u, port) + normal * self.slope(u, port + 1);
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

    fn slope(&self, u: &DVector<f64>, port: usize) -> f64 {
        (u[port + 2] - u[port - 2]) / (2.0 * self.grid.spacing)
    }

    fn swelling_slope(&self, body: usize, i: usize) -> f64 {
        let layer = &self.swelling[body];
        let at = |k: Option<usize>| k.and_then(|k| layer.get(k)).copied().unwrap_or(0.0);
        (at(Some(i + 1)) - at(i.checked_sub(1))) / (2.0 * self.grid.spacing)
    }
}
