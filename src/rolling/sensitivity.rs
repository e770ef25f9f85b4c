//! Derivatives of the outputs by the inputs that led to them.
//!
//! The state at a communication point is a function of the inputs of the step that led to it (at the start: of the
//! inputs of the stationary state). That function is differentiated as it is computed, through all its internal steps,
//! contact, heat and histories, by central differences *within its branch*: both perturbed steps must end with the
//! contact states of the present one, with the edges of its patches in the same elements of the temperature fields, and
//! have taken as many contact iterations and internal steps, otherwise the perturbation is reduced. Between changes of
//! state the function is analytic, and the difference quotient has about seven correct digits; at a kink and at the end
//! of a range it falls back to the derivative of one side.

use super::control::{Drive, Inputs};
use super::direction::Direction;
use super::error::StepError;
use super::model::{RollingModel, Workspace};
use super::output_rows::Outputs;
use super::outputs::observe_all;
use super::state::State;
use super::{stationary, substeps};
use crate::config::Tuning;
use serde::{Deserialize, Serialize};

/// Origin of a state.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Origin {
    /// The stationary state of these inputs.
    Stationary(Inputs),
    /// A communication step.
    Step {
        /// State at its beginning.
        state: Box<State>,
        /// Inputs over it.
        inputs: Inputs,
        /// Its length \[s].
        length: f64,
    },
}

/// Outputs at both ends of a difference quotient.
pub struct Difference {
    /// Outputs a little before the present ones.
    pub low: Box<Outputs>,
    /// Outputs a little behind them.
    pub high: Box<Outputs>,
    /// Distance of the ends in units of the direction.
    pub width: f64,
}

impl Difference {
    /// Derivative of one output along the direction.
    pub fn quotient(&self, output: impl Fn(&Outputs) -> f64) -> f64 {
        (output(&self.high) - output(&self.low)) / self.width
    }
}

/// Sizes over which the outputs bend: they bend much with slip, less with forces.
fn scales(model: &RollingModel, inputs: &Inputs, state: &State) -> Drive {
    let config = &model.config;
    let load = config.model.nominal_load;
    let (speed, radius) = (0.1 * state.motion.velocity.now.abs().max(1.0), config.wheel.radius);
    let half_width = model.contact.nominal_half_width();
    let approach = (state.elevation - state.motion.height.now).abs().max(1e-5);
    Drive {
        omega: speed / radius,
        moment: load * radius,
        velocity: speed,
        force: load,
        load,
        load_change: load,
        lateral_velocity: speed,
        lateral_force: load,
        spin: 0.1 / half_width,
        contact_angle: 0.1 * radius / half_width,
        lateral: half_width,
        yaw: 0.1,
        roll: 0.1,
        lateral_rate: speed,
        yaw_rate: speed / radius,
        roll_rate: speed / radius,
        displacement: approach,
        friction: 1.0,
        torque: load * radius,
        temperature: 100.0,
        slope: 1.0,
        elevation: approach,
        elevation_rate: 1.0,
        ..inputs.drive.sizes()
    }
}

/// Perturbation relative to the scales, and the factor by which it is reduced where the branch is left. The contact is settled
/// to 1e-9, and jumps by some 1e-8 where it decides otherwise on its way: those must lie beyond the perturbation.
const PERTURBATION: f64 = 2e-5;
const REDUCTION: f64 = 0.1;
const TRIES: usize = 4;

/// Outputs a little before and behind `state` along a direction of its inputs; `tuning` are the tunable parameters with
/// which it was computed.
pub fn difference(
    model: &RollingModel,
    tuning: &Tuning,
    state: &State,
    origin: &Origin,
    direction: &Direction,
    workspace: &mut Workspace,
) -> Result<Difference, StepError> {
    let (Origin::Stationary(inputs) | Origin::Step { inputs, .. }) = origin;
    let acting = |drive: &Drive| model.wheel.wheelset.acting(&model.wheel.sideways.acting(drive));
    let direction = &Direction { drive: acting(&direction.drive), rate: acting(&direction.rate) };
    let scales = scales(model, inputs, state);
    let largest = |of: &Drive| of.zip(&scales, |d, s| (d / s).abs()).values().into_iter().fold(0.0, f64::max);
    // A rate acts over the length of the step: not at all on a stationary state.
    let length = if let Origin::Step { length, .. } = origin { *length } else { 0.0 };
    let size = largest(&direction.drive).max(length * largest(&direction.rate));
    let present = Box::new(observe_all(model, state));
    if size == 0.0 {
        return Ok(Difference { low: present.clone(), high: present, width: 1.0 });
    }
    let mut width = PERTURBATION / size;
    let mut one_sided = None;
    for _ in 0..TRIES {
        let mut beyond_range = false;
        let mut ends = [-1.0, 1.0].map(|sign| {
            let end = repeat(model, tuning, origin, &direction.away(inputs, sign * width), workspace);
            beyond_range |= matches!(end, Err(StepError::Input(_) | StepError::Shifted { .. }));
            end.ok()
                .filter(|end| end.clock.decisions == state.clock.decisions)
                .map(|end| Box::new(observe_all(model, &end)))
        });
        match (ends[0].take(), ends[1].take()) {
            (Some(low), Some(high)) => return Ok(Difference { low, high, width: 2.0 * width }),
            (Some(low), None) => one_sided = Some(Difference { low, high: present.clone(), width }),
            (None, Some(high)) => one_sided = Some(Difference { low: present.clone(), high, width }),
            (None, None) => {}
        }
        if beyond_range && let Some(at_the_bound) = one_sided {
            return Ok(at_the_bound);
        }
        width *= REDUCTION;
    }
    one_sided.ok_or(StepError::NoDerivative { time: state.clock.time })
}

/// Computes a state anew from its origin under other inputs.
fn repeat(
    model: &RollingModel,
    tuning: &Tuning,
    origin: &Origin,
    inputs: &Inputs,
    workspace: &mut Workspace,
) -> Result<State, StepError> {
    match origin {
        Origin::Stationary(_) => stationary::start(model, tuning, inputs, workspace),
        Origin::Step { state, length, .. } => {
            let mut end = State::default();
            substeps::advance(model, tuning, state, inputs, *length, workspace, &mut end)?;
            Ok(end)
        }
    }
}
