//! Communication steps that end where something happens: a wheel locks or is released, the contact is lost or made again.

use super::{Span, advance, advance_until};
use crate::axes::PerAxis;
use crate::config::Tuning;
use crate::rolling::control::{Drive, Inputs};
use crate::rolling::error::StepError;
use crate::rolling::model::{RollingModel, Workspace};
use crate::rolling::state::State;

/// What changes at an event: the brake holds, the wheel touches the rail.
fn condition(state: &State) -> [bool; 2] {
    [state.hub.brake.locked, state.touches()]
}

/// The inputs of a step that ends at the time `reached` of one of `h` seconds \[s]: motions that are prescribed have got as far
/// as they would have by then.
fn shortened(state: &State, inputs: &Inputs, h: f64, reached: f64) -> Inputs {
    let PerAxis { travel: velocity, height: displacement, rotation: omega, .. } = state.motion.values();
    let (end, rate) = (inputs.at(h), inputs.rate);
    let then = |start: f64, end: f64, rate: f64| start + reached / h * (end - start) - rate * reached;
    let drive = Drive {
        omega: then(omega, end.omega, rate.omega),
        velocity: then(velocity, end.velocity, rate.velocity),
        displacement: then(displacement, end.displacement, rate.displacement),
        ..inputs.drive
    };
    Inputs { drive, ..*inputs }
}

/// Computes the state `out` after a communication step of at most `h` seconds under `inputs`; returns the inputs over it and its
/// length \[s]. It ends after the internal step in which an event happens, and is then computed once more as a step of that
/// length, so that nothing depends on what was asked for. A step over which the height of the rail changes is not cut, nor one
/// that makes up for steps too short to be computed. On error `out` is meaningless.
pub fn advance_to_event(
    model: &RollingModel,
    tuning: &Tuning,
    state: &State,
    (inputs, h): (&Inputs, f64),
    workspace: &mut Workspace,
    out: &mut State,
) -> Result<(Inputs, f64), StepError> {
    let level = state.elevation == inputs.at(h).elevation && inputs.drive.elevation_rate == 0.0;
    let (cut, before) = (level && state.clock.pending == 0.0, condition(state));
    let stop = |now: &State| condition(now) != before;
    let span = Span { inputs, h, stop: if cut { Some(&stop) } else { None } };
    let reached = advance_until(model, tuning, state, &span, workspace, out)?;
    if reached == h {
        return Ok((*inputs, h));
    }
    let inputs = shortened(state, inputs, h, reached);
    advance(model, tuning, state, &inputs, reached, workspace, out)?;
    Ok((inputs, reached))
}
