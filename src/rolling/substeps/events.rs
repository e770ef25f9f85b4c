//! Communication steps that end where something happens: a wheel locks or is released, the contact is lost or made again.

use super::super::model::RollingModel;
use super::super::wheelset::Pose;
use crate::axes::PerAxis;
use crate::rolling::control::{Drive, Inputs};
use crate::rolling::state::State;

/// Condition that changes at an event: the brake holds, the wheel touches the rail.
pub fn condition(state: &State) -> [bool; 2] {
    [state.hub.brake.locked, state.touches()]
}

/// The inputs of a step that ends at the time `reached` of one of `h` seconds \[s]: motions that are prescribed have got as far
/// as they would have by then.
pub fn shortened(model: &RollingModel, state: &State, inputs: &Inputs, h: f64, reached: f64) -> Inputs {
    let PerAxis { travel: velocity, height: displacement, rotation: omega, lateral } = state.motion.values();
    let (end, rate) = (inputs.at(h), inputs.rate);
    let then = |start: f64, end: f64, rate: f64| start + reached / h * (end - start) - rate * reached;
    let (from, to, by) = (state.motion.pose, Pose::of(&end), Pose::of(&rate));
    let then_pose = Pose {
        lateral: then(from.lateral, to.lateral, by.lateral),
        yaw: then(from.yaw, to.yaw, by.yaw),
        roll: then(from.roll, to.roll, by.roll),
        lateral_rate: then(from.lateral_rate, to.lateral_rate, by.lateral_rate),
        yaw_rate: then(from.yaw_rate, to.yaw_rate, by.yaw_rate),
        roll_rate: then(from.roll_rate, to.roll_rate, by.roll_rate),
    };
    let drive = Drive {
        omega: then(omega, end.omega, rate.omega),
        velocity: then(velocity, end.velocity, rate.velocity),
        displacement: then(displacement, end.displacement, rate.displacement),
        lateral_velocity: then(lateral, end.lateral_velocity, rate.lateral_velocity),
        ..then_pose.into(inputs.drive)
    };
    Inputs { drive: model.wheel.wheelset.acting(&drive), ..*inputs }
}
