//! Flexibility of the contact besides that of the bodies: an elastic layer between the surfaces, see
//! `docs/theory/elastic-layer.md`.
//!
//! What a node moves by it follows from the force at that node alone. Here is all that it does: displacements and energy of the
//! present forces, and the changes of a slip with them as the linear problem has them.

use super::contact_line::ContactLine;
use super::rows::UpwindSlip;

impl ContactLine<'_> {
    /// Displacement of the wheel less that of the rail by the layer at a tangential port \[m].
    pub fn moved_by_layer(&self, port: usize) -> f64 {
        if self.problem.layer.gives_way() { self.state.forces[port] * self.layer_by_force(port) } else { 0.0 }
    }

    /// That displacement per unit nodal force [m/(N/m)].
    fn layer_by_force(&self, port: usize) -> f64 {
        let candidate = (port / 2).checked_sub(self.grid.guard).filter(|i| *i < self.grid.len());
        candidate.map_or(0.0, |i| self.problem.layer.shear / self.grid.width(i))
    }

    /// Elastic energy of the layer under shear along [J/m]; that across is in [`Self::energy_of_shear`].
    pub fn energy_of_layer(&self) -> f64 {
        let energy = |i: usize| 0.5 * self.tangential(i) * self.moved_by_layer(self.grid.component(i));
        (0..self.grid.len()).map(energy).sum()
    }

    /// Adds the displacement by the layer under lateral forces to that of all nodes \[m].
    pub fn displace_layer_across(&mut self) {
        if !self.problem.layer.gives_way() {
            return;
        }
        let first = self.grid.component(0) / 2;
        for i in 0..self.state.lateral.len() {
            let moved = self.state.lateral[i] * self.layer_by_force(self.grid.component(i));
            self.iterate.displaced[first + i] += moved;
        }
    }

    /// Adds changes of the slip at candidate `i` with unit shear at the `closed` ones by the layer [m/s/(N/m)].
    pub fn add_slips_by_layer(&self, (i, upwind): (usize, &UpwindSlip), closed: &[usize], slips: &mut [f64]) {
        if !self.problem.layer.gives_way() {
            return;
        }
        let carried = self.traction.rigid.travel + self.rim_velocity();
        let rate = (self.grid.component(i), self.problem.time.a0);
        let stencil = upwind.stencil.map(|(at, weight)| (at, -0.5 * carried * weight));
        for (at, factor) in [rate].into_iter().chain(stencil) {
            if let Ok(place) = closed.binary_search_by_key(&at, |&j| self.grid.component(j)) {
                slips[place] += factor * self.layer_by_force(at);
            }
        }
    }
}
