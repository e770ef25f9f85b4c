//! What any model of the temperatures does for the rest of the program.

use super::error::HeatError;
use super::exchange::Exchange;
use serde::{Deserialize, Serialize};

/// Shortest step \[s].
pub const SMALLEST_STEP: f64 = 1e-9;
/// Longest step \[s].
pub const LARGEST_STEP: f64 = 1e6;

/// A model of the temperature of wheel and rail, per metre of the contact's width; immutable, its data are in the state.
pub trait HeatModel {
    /// Both temperature fields and what the next step needs to know of the last one.
    type State;
    /// Memory that steps reuse; holds nothing that outlives a step.
    type Scratch: Default;

    /// A wheel at the uniform temperature `wheel` (but for a fixed hub) on a rail at the uniform temperature `rail`, both over
    /// the reference \[K].
    fn initial(&self, wheel: f64, rail: f64) -> Self::State;

    /// Replaces `next` by the state `dt` \[s] after `state`, with the velocity of the wheel's centre `velocity` [m/s], the
    /// angular velocity `omega` [rad/s] (forward rolling positive) and the exchange held over the step.
    ///
    /// Returns the mean flows over the step. The memory of `next` is reused; on error its content is meaningless.
    #[allow(clippy::too_many_arguments)]
    fn step(
        &self,
        state: &Self::State,
        next: &mut Self::State,
        dt: f64,
        velocity: f64,
        omega: f64,
        exchange: &Exchange,
        scratch: &mut Self::Scratch,
    ) -> Result<HeatFlows, HeatError>;

    /// Stationary temperatures at constant speeds and exchange.
    ///
    /// Fails where heat is supplied and nothing removes it (insulated hub, no air, standing wheel on a standing rail).
    fn stationary(&self, velocity: f64, omega: f64, exchange: &Exchange)
    -> Result<(Self::State, HeatFlows), HeatError>;

    /// Surface positions at which a state is observed \[m], ascending.
    fn zone_x(&self) -> &[f64];

    /// Replaces `seen` by what a state shows; its memory is reused.
    fn observe(&self, state: &Self::State, seen: &mut Observation) -> Result<(), HeatError>;

    /// Replaces `out` by the mean temperatures of wheel and rail between the surface and `depth` \[m] at the positions of
    /// [`Self::zone_x`], over the reference \[K]. Depths from a tenth to four half-widths at the nominal load are told
    /// apart.
    fn mean_over_depth(&self, state: &Self::State, depth: f64, out: &mut [Vec<f64>; 2]) -> Result<(), HeatError>;
}

/// What the rest of the program sees of a state; pairs are wheel and rail.
#[derive(Clone, Debug, Default)]
pub struct Observation {
    /// Maxima, values at the contact point and means.
    pub temperatures: Temperatures,
    /// Surface temperatures at the positions of [`HeatModel::zone_x`], over the reference \[K].
    pub surface: [Vec<f64>; 2],
    /// Temperature integrated over the layer whose expansion acts on the contact, at the same positions [K m]: of the
    /// wheel less its mean along the tread, of the rail less the temperature in the depth.
    pub layer: [Vec<f64>; 2],
    /// Mean depth of the heat in that layer \[m].
    pub layer_depth: [f64; 2],
    /// Mean temperatures over a depth, see [`HeatModel::mean_over_depth`]; filled on demand only.
    pub core: [Vec<f64>; 2],
    /// No node of the bodies is colder, over the reference \[K]; exact where it comes near absolute zero.
    pub lowest: f64,
    /// Work space: a field summed along the streamlines, or the nodes below one surface node.
    pub(super) sums: Vec<f64>,
    /// Work space: first moments of the layers.
    pub(super) moments: Vec<f64>,
}

/// Mean heat flows over a step, or in the stationary state [W/m].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct HeatFlows {
    /// Friction heat into both bodies, `γ_f ∫|τs| dx`.
    pub friction: f64,
    /// Prescribed heat on the tread.
    pub tread: f64,
    /// Wheel to rail through the contact conductance.
    pub conduction: f64,
    /// Net heat into the wheel through the contact: friction share and conduction.
    pub to_wheel: f64,
    /// The same for the rail.
    pub to_rail: f64,
    /// Wheel to hub.
    pub to_hub: f64,
    /// Carried out of the modelled rail by the stream, less what enters with it.
    pub outflow: f64,
    /// From the wheel to the air.
    pub wheel_to_air: f64,
    /// From the rail to the air.
    pub rail_to_air: f64,
    /// Growth of the wheel's heat content.
    pub stored_wheel: f64,
    /// Growth of the rail's heat content.
    pub stored_rail: f64,
    /// Iterations of the correction to the exact operator (none in rolling).
    pub iterations: usize,
}

impl HeatFlows {
    /// What the wheel receives less what it passes on and stores [W/m]; zero but for round-off.
    pub fn wheel_imbalance(&self) -> f64 {
        self.to_wheel + self.tread - self.to_hub - self.wheel_to_air - self.stored_wheel
    }

    /// The same for the rail.
    pub fn rail_imbalance(&self) -> f64 {
        self.to_rail - self.outflow - self.rail_to_air - self.stored_rail
    }

    /// Largest imbalance relative to the largest flow.
    pub fn relative_imbalance(&self) -> f64 {
        let largest = self.all().into_iter().fold(0.0_f64, |m, f| m.max(f.abs()));
        let worst = self.wheel_imbalance().abs().max(self.rail_imbalance().abs());
        if largest > 0.0 { worst / largest } else { 0.0 }
    }

    /// Adds a share of other flows: the sum over all steps with their shares of the time is the mean.
    pub fn add(&mut self, share: f64, other: &Self) {
        let Self { friction, tread, conduction, to_wheel, to_rail, to_hub, outflow, .. } = self;
        let Self { wheel_to_air, rail_to_air, stored_wheel, stored_rail, iterations, .. } = other;
        for (mean, flow) in [
            (friction, other.friction),
            (tread, other.tread),
            (conduction, other.conduction),
            (to_wheel, other.to_wheel),
            (to_rail, other.to_rail),
            (to_hub, other.to_hub),
            (outflow, other.outflow),
            (&mut self.wheel_to_air, *wheel_to_air),
            (&mut self.rail_to_air, *rail_to_air),
            (&mut self.stored_wheel, *stored_wheel),
            (&mut self.stored_rail, *stored_rail),
        ] {
            *mean += share * flow;
        }
        self.iterations += iterations;
    }

    fn all(&self) -> [f64; 9] {
        [
            self.friction,
            self.tread,
            self.conduction,
            self.to_hub,
            self.outflow,
            self.wheel_to_air,
            self.rail_to_air,
            self.stored_wheel,
            self.stored_rail,
        ]
    }

    pub(super) fn is_finite(&self) -> bool {
        self.all().iter().all(|f| f.is_finite())
    }
}

/// Temperatures that a run reports, over the reference \[K].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Temperatures {
    /// Maximum of the wheel's surface in the contact zone.
    pub wheel_max: f64,
    /// Maximum of the rail's surface in the contact zone.
    pub rail_max: f64,
    /// Surface of the wheel at the contact point.
    pub wheel_centre: f64,
    /// Surface of the rail at the contact point.
    pub rail_centre: f64,
    /// Mean of the wheel over its volume.
    pub wheel_mean: f64,
    /// Mean of the modelled rail over its volume.
    pub rail_mean: f64,
    /// Largest molten thickness of wheel and rail in the contact zone now, the molten fraction integrated over the
    /// depth \[m].
    pub melted: [f64; 2],
}
