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
//! linear elements along `s`. Where heat spreads sideways into wider bodies, all of them have the width at the depth
//! `z` over that of the contact as a second weight (`mesh::section`).
//!
//! Rooms: `mesh` (meshes, modes, fields), `solve` (linear equations of a stage), `melt` (latent heat), `step` (loads,
//! time formula, flows, bounds, stationary state). `heat`, `weights` and `points` hold the model and read states.

mod heat;
mod measured;
mod melt;
mod mesh;
mod points;
mod solve;
pub(super) mod step;
#[cfg(test)]
mod tests;
mod weights;

pub use heat::Heat;
pub use measured::WheelStage;
pub use step::memory::HeatScratch;

use super::error::HeatError;
use super::exchange::Exchange;
use super::flows::HeatFlows;
use super::model::{HeatLine, HeatModel};
use super::observation::{Observation, TemperatureField};
use super::state::HeatState;
use step::stationary::{after_long_rolling, bounded, stationary};

impl Heat {
    /// Stationary temperatures at constant speeds and exchange.
    ///
    /// Fails where heat is supplied and nothing removes it (insulated hub, no air, standing wheel on a standing rail).
    pub fn stationary(
        &self,
        velocity: f64,
        omega: f64,
        exchange: &Exchange,
    ) -> Result<(HeatState, HeatFlows), HeatError> {
        let (state, flows) = stationary(self, [velocity, omega], exchange)?;
        Ok((bounded(&self.layout, state)?, flows))
    }
}

impl HeatModel for Heat {
    fn initial(&self, wheel: f64, rail: f64) -> HeatState {
        self.uniform(wheel, rail)
    }

    fn after_long_rolling(
        &self,
        velocity: f64,
        omega: f64,
        exchange: &Exchange,
        wheel: f64,
    ) -> Result<(HeatState, HeatFlows), HeatError> {
        after_long_rolling(self, [velocity, omega], exchange, wheel)
    }

    fn step(
        &self,
        lines: &mut [HeatLine],
        dt: f64,
        velocity: f64,
        omega: f64,
        scratch: &mut HeatScratch,
    ) -> Result<(), HeatError> {
        lines.iter().try_for_each(|line| self.check_state(line.state))?;
        step::formula::advance(self, lines, dt, [velocity, omega], scratch)
    }

    fn fits(&self, state: &HeatState) -> bool {
        self.check_state(state).is_ok()
    }

    fn zone_x(&self) -> &[f64] {
        self.layout.zone_positions()
    }

    fn observe(&self, state: &HeatState, seen: &mut Observation) -> Result<(), HeatError> {
        self.check_state(state)?;
        self.weights.observe(&self.layout, self.melting_within(state.range), state, seen);
        Ok(())
    }

    fn mean_over_depth(&self, state: &HeatState, depth: f64, out: &mut [Vec<f64>; 2]) -> Result<(), HeatError> {
        self.check_state(state)?;
        self.weights.mean_over_depth(&self.layout, &state.values, depth, out);
        Ok(())
    }

    fn depth_weights(&self, body: usize, depths: &[f64]) -> Vec<f64> {
        let modes = &self.layout.bodies()[body].modes;
        let bottom = modes.depths.last().copied().unwrap_or(0.0);
        let at_depths: Vec<_> = depths.iter().map(|&z| modes.at(z.min(bottom))).collect();
        (0..modes.len()).flat_map(|mode| at_depths.iter().map(move |values| values[mode])).collect()
    }

    fn column(&self, body: usize, state: &HeatState, s: f64, weights: &[f64], column: &mut [f64]) {
        column.fill(0.0);
        if self.fits(state) {
            self.fill_column(body, state, s, weights, column);
            // Sums of modes have the round-off of the hottest place.
            let [coldest, hottest] = state.data;
            if coldest < hottest {
                column.iter_mut().for_each(|t| *t = t.clamp(coldest, hottest));
            }
        }
    }

    fn fields(&self, state: &HeatState) -> Result<[TemperatureField; 2], HeatError> {
        self.check_state(state)?;
        Ok(self.temperature_fields(state))
    }
}
