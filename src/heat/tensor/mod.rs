//! The heat model on tensor meshes: streamlines × depth, solved mode by mode.
//!
//! Both bodies are described by the distance `s` along their surface (positive in travel direction, contact point at
//! zero) and the depth `z` below it. With the weight `g(z) = 1 − z/r_o` in the wheel (true polar elements) and `g = 1`
//! in the rail, the energy balance of the stream `v = −ω r_o` or `v = −V` reads
//!
//! ```text
//! ρc g (∂_t T + v ∂_s T) = k ∂_z(g ∂_z T) + k g⁻¹ ∂_s² T
//! ```
//!
//! and a tensor-product Galerkin method needs only `∫ g N N dz`, `∫ g N′N′ dz`, `∫ g⁻¹ N N dz` (quadratic) and the
//! linear elements along `s`. Where heat spreads sideways into wider bodies, all of them have the width at the depth `z` over
//! that of the contact as a second weight (`section`).

mod arrival;
mod bounds;
mod column;
mod coupling;
mod depth_modes;
mod elimination;
mod field;
mod flows;
mod inverse;
mod layout;
mod limiter;
mod loads;
mod melt;
mod modal;
mod nodal;
mod radiation;
mod recent;
mod response;
mod rows;
mod section;
mod stage;
mod state;
mod step;
mod streamline;
#[cfg(test)]
mod tests;
mod tridiagonal;

pub use field::TemperatureField;
pub use layout::Heat;
pub use state::HeatState;
pub use step::Scratch;

use super::error::HeatError;
use super::exchange::Exchange;
use super::model::{HeatFlows, HeatModel, Observation, Temperatures};
use crate::piecewise::peak;
use modal::{HeatBody, dot};

impl HeatModel for Heat {
    type State = HeatState;
    type Scratch = Scratch;

    fn initial(&self, wheel: f64, rail: f64) -> HeatState {
        let [wheel, rail] = [wheel, rail].map(|temperature| self.content(temperature));
        let uniform = |body: &HeatBody, content: f64| -> Vec<f64> {
            body.modes.free.iter().cycle().take(body.size()).map(|one| content * one).collect()
        };
        let data = [wheel.min(rail).min(0.0), wheel.max(rail).max(0.0)];
        let field = [uniform(&self.wheel, wheel), uniform(&self.rail, rail)].concat();
        HeatState { field, last: None, arriving: rail, data, range: data }
    }

    fn step(
        &self,
        state: &HeatState,
        next: &mut HeatState,
        dt: f64,
        velocity: f64,
        omega: f64,
        exchange: &Exchange,
        scratch: &mut Scratch,
    ) -> Result<HeatFlows, HeatError> {
        self.check_state(state)?;
        self.advance(state, next, dt, [velocity, omega], exchange, scratch)
    }

    fn stationary(&self, velocity: f64, omega: f64, exchange: &Exchange) -> Result<(HeatState, HeatFlows), HeatError> {
        let (state, flows) = self.settle([velocity, omega], exchange)?;
        Ok((self.bounded(state)?, flows))
    }

    fn zone_x(&self) -> &[f64] {
        self.zone_positions()
    }

    fn observe(&self, state: &HeatState, seen: &mut Observation) -> Result<(), HeatError> {
        self.check_state(state)?;
        let (wheel, rail) = self.split(state);
        let mut volume_means = [0.0; 2];
        for (i, (body, field)) in [(&self.wheel, wheel), (&self.rail, rail)].into_iter().enumerate() {
            let (nodes, nm) = (self.zone_nodes(body), body.modes.len());
            let (weights, moments) = (&self.layer_weights[i], &self.layer_moments[i]);
            let zone = &field[nodes.start * nm..nodes.end * nm];
            let out = [&mut seen.surface[i], &mut seen.layer[i], &mut seen.moments].map(|values| {
                values.resize(nodes.len(), 0.0);
                &mut values[..]
            });
            rows::products_of_three(zone, [&body.modes.surface, weights, moments], out);
            body.integrate(field, &mut seen.sums);
            volume_means[i] = body.heat_capacity * dot(&seen.sums, &body.modes.content) / self.heat_capacity(body);
            let mean = |weights: &[f64]| {
                if body.line.closed > 0.0 { dot(&seen.sums, weights) / body.line.closed } else { 0.0 }
            };
            let (along, moment_along) = (mean(weights), mean(moments));
            seen.layer[i].iter_mut().for_each(|content| *content -= along);
            let moments = seen.moments.iter().map(|moment| moment - moment_along);
            seen.layer_depth[i] = mean_depth(moments, &seen.layer[i]);
        }
        seen.lowest = state.range[0];
        let melted = self.observe_melting(state, seen);
        let [wheel, rail] = &seen.surface;
        seen.temperatures = Temperatures {
            wheel_max: peak(self.zone_x(), wheel),
            rail_max: peak(self.zone_x(), rail),
            wheel_centre: wheel[self.zone_cells],
            rail_centre: rail[self.zone_cells],
            wheel_mean: volume_means[0],
            rail_mean: volume_means[1],
            melted,
        };
        Ok(())
    }

    fn mean_over_depth(&self, state: &HeatState, depth: f64, out: &mut [Vec<f64>; 2]) -> Result<(), HeatError> {
        self.check_state(state)?;
        let (wheel, rail) = self.split(state);
        let (above, share) = self.core_place(depth);
        for (i, (body, field)) in [(&self.wheel, wheel), (&self.rail, rail)].into_iter().enumerate() {
            let (nodes, nm) = (self.zone_nodes(body), body.modes.len());
            let [low, high] = [above, above + 1].map(|k| &self.core_weights[i][k]);
            let rows = field[nodes.start * nm..nodes.end * nm].chunks_exact(nm);
            out[i].clear();
            out[i].extend(rows.map(|row| (1.0 - share) * dot(row, low) + share * dot(row, high)));
        }
        Ok(())
    }
}

/// Mean depth of heat \[m] with the first moments and the contents `layer` of the columns; zero where the layer is colder than the
/// rest of the tread, and in between where it is warmer in parts.
fn mean_depth(moments: impl Iterator<Item = f64>, layer: &[f64]) -> f64 {
    let (net, content) = layer.iter().fold((0.0, 0.0), |(net, sum), heat| (net + heat, sum + heat.abs()));
    let warm = f64::max(net / content, 0.0);
    if warm > 0.0 { warm * moments.map(f64::abs).sum::<f64>() / content } else { 0.0 }
}
