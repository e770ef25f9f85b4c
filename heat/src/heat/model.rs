//! Interface of a model of the temperatures.

use super::error::HeatError;
use super::exchange::Exchange;
use super::flows::HeatFlows;
use super::observation::{Observation, TemperatureField};
use super::state::HeatState;
use super::tensor::step::memory::HeatScratch;

/// Step of one of the contact lines side by side, per metre of its own width.
#[derive(Debug)]
pub struct HeatLine<'a> {
    /// State at the beginning.
    pub state: &'a HeatState,
    /// State at the end, to be replaced; its memory is reused.
    pub next: &'a mut HeatState,
    /// Exchange held over the step.
    pub exchange: &'a Exchange,
    /// Mean flows over the step, to be replaced.
    pub flows: HeatFlows,
}

impl<'a> HeatLine<'a> {
    /// Step from `state` to `next` under `exchange` that is still to be taken.
    pub fn new(state: &'a HeatState, next: &'a mut HeatState, exchange: &'a Exchange) -> Self {
        Self { state, next, exchange, flows: HeatFlows::default() }
    }
}

/// Model of the temperature of wheel and rail, per metre of the contact's width; immutable, its data are in the state.
///
/// Velocities are that of the wheel's centre [m/s] and the angular one [rad/s], forward rolling positive. Temperatures
/// count from the reference \[K]. A state of another model is refused with an error, or ignored where there is none to
/// return.
pub trait HeatModel: Send + Sync {
    /// State of a wheel at the uniform temperature `wheel` (but for a fixed hub) on a rail at the uniform temperature
    /// `rail`.
    fn initial(&self, wheel: f64, rail: f64) -> HeatState;

    /// State after long rolling at constant speeds and exchange, and its heat flows: the stationary temperatures of the
    /// heat, over a wheel that had the uniform temperature `wheel` on a rail at [`Exchange::arriving`], and the heat
    /// that these two exchange in passing. At standstill, where nothing carries heat away, only the uniform
    /// temperatures.
    fn after_long_rolling(
        &self,
        velocity: f64,
        omega: f64,
        exchange: &Exchange,
        wheel: f64,
    ) -> Result<(HeatState, HeatFlows), HeatError>;

    /// Takes lines side by side, which have speeds and step size in common, on by `dt` \[s] with the exchange of each
    /// held over the step. Heat does not flow from line to line: results are those of each line alone, to round-off.
    ///
    /// On error all states at the end and flows are meaningless.
    fn step(
        &self,
        lines: &mut [HeatLine],
        dt: f64,
        velocity: f64,
        omega: f64,
        scratch: &mut HeatScratch,
    ) -> Result<(), HeatError>;

    /// Test that a state has the dimensions of this model.
    fn fits(&self, state: &HeatState) -> bool;

    /// Surface positions at which a state is observed \[m], ascending, with the contact point in their middle.
    fn zone_x(&self) -> &[f64];

    /// Replaces `seen` by the observation of a state, but for [`Observation::core`]; its memory is reused.
    fn observe(&self, state: &HeatState, seen: &mut Observation) -> Result<(), HeatError>;

    /// Replaces `out` by the mean temperatures of wheel and rail between the surface and `depth` \[m] at the positions
    /// of [`Self::zone_x`]. Depths from a tenth to four half-widths at the nominal load are told apart.
    fn mean_over_depth(&self, state: &HeatState, depth: f64, out: &mut [Vec<f64>; 2]) -> Result<(), HeatError>;

    /// Data from which [`Self::column`] finds the temperatures of a body (0: wheel, 1: rail) at the given `depths`
    /// \[m], which end at its far side; computed once, their meaning is the model's.
    fn depth_weights(&self, body: usize, depths: &[f64]) -> Vec<f64>;

    /// Fills `column` with the temperatures of a body (0: wheel, 1: rail) at the distance `s` \[m] along its surface
    /// from the contact point, at the depths that `weights` were made for; zeros for a state of another model.
    fn column(&self, body: usize, state: &HeatState, s: f64, weights: &[f64], column: &mut [f64]);

    /// Temperature fields of wheel and rail.
    fn fields(&self, state: &HeatState) -> Result<[TemperatureField; 2], HeatError>;
}
