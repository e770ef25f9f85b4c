//! What layers that answer late spare the hub.
//!
//! Betti's theorem, on which the lever arms rest, holds between forces and the displacement that they cause themselves. The
//! displacement of a [`RetardedLayer`] belongs to the elastic part of the forces; what runs ahead of it does work on its slope,
//! which nobody dissipates. Derivation: `docs/theory/lever-arms.md`, section 4a.

use super::iterate::{Iterate, Retarded, copy};
use crate::contact::problem::RetardedLayer;

/// Change of the force in the last iteration that counts as none, over the nominal load \[1].
const TOLERANCE: f64 = 1e-7;

impl Iterate<'_> {
    /// Takes the forces of the late layers in the present iterate; returns whether they have changed.
    pub(super) fn update_retarded(&mut self) -> bool {
        let before: f64 = self.scratch.retarded.force.iter().sum();
        let mut late = std::mem::take(&mut self.scratch.retarded);
        late.force = [0.0; 2];
        if !self.problem.time.is_stationary() {
            for (body, layer) in self.problem.bodies.retarded.iter().enumerate() {
                late.force[body] = layer.map_or(0.0, |layer| self.force_of(body, &layer, &mut late));
            }
        }
        let change = late.force.iter().sum::<f64>() - before;
        self.scratch.retarded = late;
        change.abs() > TOLERANCE * self.problem.nominal_load
    }

    /// `Σ l·D u` with the forces `l` that run ahead and the displacement `u` of the layer, for the wheel less
    /// `Σ (l_n u_x − l_t u_y)/r` [N/m].
    fn force_of(&self, body: usize, layer: &RetardedLayer, late: &mut Retarded) -> f64 {
        let (grid, sign) = (self.grid, if body == 0 { 1.0 } else { -1.0 });
        let Retarded { elastic, displacement, .. } = late;
        copy(elastic, layer.known);
        elastic.axpy(sign * layer.share, &self.traction.port_forces, 1.0);
        let pull = &self.scratch.pull[body];
        pull.iter().enumerate().for_each(|(i, pull)| elastic[grid.port(i)] += layer.share * pull);
        copy(displacement, layer.known);
        displacement.gemv(1.0, layer.flexibility, elastic, 0.0);
        let turning = if body == 0 { 1.0 / self.problem.radius() } else { 0.0 };
        let of_node = |i: usize| {
            let port = grid.port(i);
            let pull = pull.get(i).copied().unwrap_or(0.0);
            let tangential = sign * self.tangential(i) + pull - elastic[port];
            let normal = sign * self.normal(i) - elastic[port + 1];
            let slope = |port: usize| (displacement[port + 2] - displacement[port - 2]) / grid.span(i);
            let turned = normal * displacement[port] - tangential * displacement[port + 1];
            tangential * slope(port) + normal * slope(port + 1) - turning * turned
        };
        (0..grid.len()).map(of_node).sum()
    }
}
