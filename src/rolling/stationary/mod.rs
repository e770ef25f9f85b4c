//! Stationary rolling: the state in which nothing changes in the moving frame (`d_t = 0`).
//!
//! What is given and what is sought follows from the control ([`goal`]). Contact forces, convective terms, creepage and
//! accelerations depend on each other; they are brought together by passes of the linear contact problem at fixed
//! temperatures (`settle`). Around them, temperatures and contact follow each other until neither forces nor creepage
//! change any longer ([`start`]). Derivation: `docs/theory/friction-and-coupling.md`.

mod goal;
mod settle;

use super::control::Inputs;
use super::decisions::Decisions;
use super::error::StepError;
use super::line::Line;
use super::model::{RollingModel, Workspace};
use super::state::State;
use super::thermal::HeatSupply;
use crate::axes::Axis;
use crate::config::{StartTemperature, Tuning};
use goal::Goal;
use settle::{Firm, heated, lines, scale, settle};
use std::hash::Hasher;

/// Passes of temperatures and contact.
const MAX_PASSES: usize = 30;
/// Passes after which the feedback of the temperatures is averaged, unless the changes shrink by this factor from pass
/// to pass: friction that softens and swelling that lifts parts of a very hot contact off make it go back and forth. Steel that
/// finds no yielding state then stays firmer than it is.
const PLAIN_PASSES: usize = 5;
const CONTRACTION: f64 = 0.5;
/// Passes in which no yielding state was found after which none is sought any more.
const MOST_FAILURES: usize = 2;
/// Largest pressure over what the steel bears, up to which a start may be that of firmer steel \[1]: the first steps yield. Beyond,
/// they would lose most of the load.
const MOST_OVERLOAD: f64 = 5.0;
/// Relative change of contact force and creepage at which temperatures and friction are settled: further passes repeat
/// rounding.
const THERMAL_TOLERANCE: f64 = 1e-9;
/// Scatter that is accepted where averages are all there is.
const THERMAL_SCATTER: f64 = 1e-3;

/// Stationary state for inputs. Where a force or moment is prescribed it is quasi-steady rolling at `initial.velocity`:
/// the creepage is constant and belongs to force and moment, and the accelerations are what they do not balance. With
/// `initial.creepage`, creepage and velocity are given, and rotation and translation accelerate each by its own.
///
/// # Errors
///
/// [`StepError::BeyondAdhesion`] if force and moment ask for more than friction carries, and what the contact, the heat
/// and the ranges of the model refuse.
pub fn start(
    model: &RollingModel,
    tuning: &Tuning,
    inputs: &Inputs,
    workspace: &mut Workspace,
) -> Result<State, StepError> {
    inputs.validate()?;
    model.wheel.sideways.check(inputs)?;
    model.wheel.wheelset.check(inputs)?;
    model.wheel.wheelset.within(&inputs.drive)?;
    let goal = Goal::new(model, inputs)?;
    let mut state = settled(model, tuning, &goal, workspace)?;
    let mut decisions = Decisions::default();
    decisions.add_contact(model, &state);
    state.clock.decisions = decisions.finish();
    Ok(state)
}

/// Stationary state of a goal, with contact and temperatures that belong to each other.
fn settled(model: &RollingModel, tuning: &Tuning, goal: &Goal, workspace: &mut Workspace) -> Result<State, StepError> {
    let mut firm = 0.0;
    let mut state = settle(model, tuning, goal, lines(model, goal), &mut firm, workspace)?;
    let Some(thermal) = &model.thermal else { return Ok(state) };
    let (mut change, mut averaged, mut failed) = (f64::INFINITY, 0, 0);
    for pass in 0..MAX_PASSES {
        let temperatures = state.lines.iter().map(|line| {
            let contact = thermal.contact(&model.contact, &line.contact, goal.drive.temperature);
            let mut temperatures = match model.config.initial.temperature {
                StartTemperature::Uniform => thermal.uniform(&contact)?,
                StartTemperature::Stationary => {
                    let (brake_power, narrowing) = (state.hub.brake.power, model.narrowing(&state));
                    let supply = HeatSupply { drive: &goal.drive, brake_power, narrowing };
                    thermal.stationary(&state.motion, &contact, supply)?
                }
            };
            if let (Some(before), true) = (&line.thermal, averaged > 0) {
                thermal.average(&mut temperatures, before, 1.0 / f64::from(averaged + 1));
            }
            Ok(Some(temperatures))
        });
        let temperatures = temperatures.collect::<Result<Vec<_>, StepError>>()?;
        let mut settle_from = |lines: &[Line], temperatures, firm: &mut Firm| {
            settle(model, tuning, goal, heated(model, lines, temperatures), firm, workspace)
        };
        // Steel that was too hot to yield in a state on the way may yield in this one, or from another contact on.
        let again = pass < PLAIN_PASSES && failed < MOST_FAILURES;
        if again {
            firm = 0.0;
        }
        let mut settled = settle_from(&state.lines, temperatures, &mut firm)?;
        if again && firm > 0.0 {
            failed += 1;
            let mut other = 0.0;
            let temperatures = settled.lines.iter().map(|line| line.thermal.clone()).collect();
            if pass > 0
                && let Ok(state) = settle_from(&lines(model, goal), temperatures, &mut other)
                && other == 0.0
            {
                (settled, firm) = (state, other);
            }
        }
        let before = std::mem::replace(&mut change, difference(model, &state, &settled));
        state = settled;
        if averaged > 0 || pass + 1 >= PLAIN_PASSES && change > CONTRACTION * before {
            averaged += 1;
        }
        // The first temperatures are those of the cold contact.
        if pass > 0 && change <= THERMAL_TOLERANCE {
            break;
        }
    }
    if change <= THERMAL_SCATTER { borne(model, state, firm) } else { Err(StepError::Unsettled) }
}

/// A state of steel that is no softer than `firm`, unless it bears far less than that.
fn borne(model: &RollingModel, state: State, firm: Firm) -> Result<State, StepError> {
    let [overload, bears] = model.contact.overload(&state);
    match firm > 0.0 && overload > MOST_OVERLOAD {
        true => Err(StepError::Softened { bears, pressure: overload * bears }),
        false => Ok(state),
    }
}

/// Change from one state to the next: of the contact force relative to the load and, since a prescribed force fixes it
/// whatever the temperatures, of the creepage relative to the one that strains the patch by its own width over the
/// radius.
fn difference(model: &RollingModel, before: &State, now: &State) -> f64 {
    let ([from, to], half_width) = ([before, now].map(State::resultant), now.half_width());
    let forces = [Axis::Travel, Axis::Height, Axis::Lateral].map(|axis| (to[axis] - from[axis]).abs());
    let force = forces.into_iter().fold(0.0, f64::max) / scale(model, to);
    let [v, v_before] = [now, before].map(|state| state.motion.velocity.now);
    let [v_c, v_c_before] = [now, before].map(|state| model.wheel.radius * state.motion.omega.now);
    let speed = v.abs() + v_c.abs();
    let slip = ((v - v_c) - (v_before - v_c_before)).abs() * model.wheel.radius;
    let creepage = if speed > 0.0 && half_width > 0.0 { slip / (speed * half_width) } else { 0.0 };
    force.max(creepage)
}
