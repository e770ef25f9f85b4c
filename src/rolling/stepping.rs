//! Division of a communication step into internal steps.
//!
//! A communication step is first divided evenly by `solver.max_step`, then by halves where it must be, so that the last
//! internal step lands exactly on its end, and joined again where they can be. An internal step is halved if the contact finds no state, and, with a
//! `solver.tolerance`, if contact force or contact temperature miss their prediction by more than that. The prediction
//! is linear from the two steps before, or constant after a jump of the inputs; the difference is of second order in the
//! step and larger than the error of the second-order formula. Loss of contact, re-contact, lock-up and breaking loose
//! show in it at once, so no event needs a rule of its own. A contact that heats or cools by hundreds of kelvin in one
//! long step is always refined: friction that falls with the temperature is predicted from the steps before.

use super::control::{Drive, Inputs};
use super::state::State;
use super::{Model, StepError, Workspace};
use serde::{Deserialize, Serialize};

/// Longest communication step [s].
pub const LONGEST_STEP: f64 = 3600.0;
/// Shortest internal step [s]: below, waves do not cross an element and the contact may find no state. Communication
/// steps that are shorter, such as those that rounding leaves at the end of a run, wait for the next one.
pub const SHORTEST_STEP: f64 = 5e-7;
/// How often in succession a step that finds no contact state is halved before it is given up.
const MAX_HALVINGS: u32 = 12;
/// Internal step below which errors do not refine any further [s]: forces may jump, with the friction coefficient.
const FINEST: f64 = 1e-5;
/// Change of the highest contact temperature [K] that always refines steps longer than this [s].
const HEATING: (f64, f64) = (300.0, 1e-3);
/// Share of the tolerance, and of [`HEATING`], below which the step doubles; the difference grows fourfold.
const GROWTH: f64 = 0.125;
/// Temperature change that counts as much as the nominal load, unless the contact is hotter [K].
const WARM: f64 = 100.0;

/// What the control of the step size remembers.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct StepControl {
    /// Largest internal step that the errors so far allow [s].
    pub step: f64,
    /// Controlled quantities one internal step before: contact forces x, y [N/m], highest temperature rise [K].
    pub before: [f64; 3],
}

impl StepControl {
    /// Control of a stationary start.
    pub fn stationary(state: &State) -> Self {
        Self { step: f64::INFINITY, before: controlled(state) }
    }
}

/// Forces on the wheel [N/m] and highest rise of temperature in the contact [K].
fn controlled(state: &State) -> [f64; 3] {
    let force = state.contact.force();
    let temperature = state.thermal.as_ref().map_or(0.0, |t| t.temperatures.wheel_max.max(t.temperatures.rail_max));
    [force[0], force[1], temperature]
}

impl Model {
    /// The state after a communication step `h` [s] under `inputs`; `state` is only replaced on success.
    pub fn advance(
        &self,
        state: &State,
        inputs: &Inputs,
        h: f64,
        workspace: &mut Workspace,
    ) -> Result<State, StepError> {
        inputs.validate()?;
        if !(h > 0.0 && h <= LONGEST_STEP) {
            return Err(StepError::StepSize { step: h, longest: LONGEST_STEP });
        }
        let end = inputs.at(h);
        end.validate()?;
        let start = Drive {
            omega: state.omega.now,
            velocity: state.velocity.now,
            displacement: state.height.now,
            ..inputs.at(0.0)
        };
        let h = h + state.pending;
        if h < SHORTEST_STEP {
            return Ok(State { pending: h, ..state.clone() });
        }
        let mut next = State { pending: 0.0, internal_steps: 0, iterations: 0, ..state.clone() };
        let tolerance = self.config.tuning.tolerance;
        let pieces = (h / self.config.tuning.max_step - 1e-9).ceil().max(1.0) as u64;
        let mut failures = 0;
        // Position within the communication step in units of h / total.
        let (mut position, mut total) = (0u64, pieces);
        while tolerance > 0.0 && h / total as f64 > next.control.step * (1.0 + 1e-9) {
            total *= 2;
        }
        while position < total {
            let dt = h / total as f64;
            let fraction = (position + 1) as f64 / total as f64;
            let target = start.zip(&end, |a, b| if fraction == 1.0 { b } else { a + fraction * (b - a) });
            match self.step(&next, inputs, &target, dt, workspace) {
                Ok(mut advanced) => {
                    let error = self.error(&next, &advanced, dt);
                    let inaccurate = tolerance > 0.0 && error > tolerance && dt > 2.0 * FINEST;
                    let heating = (controlled(&advanced)[2] - controlled(&next)[2]).abs();
                    if inaccurate || (heating > HEATING.0 && dt > HEATING.1 * (1.0 + 1e-9)) {
                        (position, total) = (2 * position, 2 * total);
                        next.control.step = 0.5 * dt;
                        continue;
                    }
                    advanced.control.before = controlled(&next);
                    next = advanced;
                    position += 1;
                    failures = 0;
                    if (tolerance == 0.0 || error <= GROWTH * tolerance) && heating <= GROWTH * HEATING.0 {
                        next.control.step = next.control.step.max(2.0 * dt);
                        if position.is_multiple_of(2) && total.is_multiple_of(2) && total / 2 >= pieces {
                            (position, total) = (position / 2, total / 2);
                        }
                    }
                }
                Err(StepError::Contact { .. } | StepError::NotFinite { .. })
                    if failures < MAX_HALVINGS && dt >= 2.0 * SHORTEST_STEP =>
                {
                    failures += 1;
                    (position, total) = (2 * position, 2 * total);
                    next.last_step = 0.0;
                }
                Err(error) => return Err(error),
            }
        }
        next.time = state.time + h;
        Ok(next)
    }

    /// Largest deviation of the controlled quantities from their prediction [1].
    fn error(&self, state: &State, next: &State, dt: f64) -> f64 {
        let (before, now, found) = (state.control.before, controlled(state), controlled(next));
        let load = self.nominal_line_load();
        let scales = [load, load, WARM.max(found[2].abs())];
        // The first step after a jump of the inputs has no history.
        let ratio = if next.restarted || state.last_step == 0.0 { 0.0 } else { dt / state.last_step };
        (0..3).map(|k| (found[k] - now[k] - ratio * (now[k] - before[k])).abs() / scales[k]).fold(0.0, f64::max)
    }
}
