//! Communication steps that end where something happens: a wheel locks or is released, the contact is lost or made again.

use crate::axes::PerAxis;
use crate::rolling::control::{Drive, Inputs};
use crate::rolling::state::State;

/// Condition that changes at an event: the brake holds, the wheel touches the rail.
pub fn condition(state: &State) -> [bool; 2] {
    [state.hub.brake.locked, state.touches()]
}

/// The inputs of a step that ends at the time `reached` of one of `h` seconds \[s]: motions that are prescribed have got as far
/// as they would have by then.
pub fn shortened(state: &State, inputs: &Inputs, h: f64, reached: f64) -> Inputs {
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
