//! Brakes of the rigid motions: dry friction beside the force that drives an axis, one more pair of stick and slip.
//!
//! With the speed `v` of the axis at the end of the step and the force `b` of the brake, `|b| ≤ L` and `b = −L sign v`
//! where the axis moves. A holding brake has the row `v = 0` instead of the balance of the axis, which then gives `b`;
//! a slipping one has the balance with the known force. A brake that holds slips where more than `L` is needed to hold
//! it; one whose force no longer opposes the motion holds, so that a reversal passes through rest.

use crate::axes::PerAxis;
use crate::contact::problem::RigidMotion;

/// State of the brake of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum BrakeState {
    /// It holds the axis at rest.
    Holding,
    /// It slips with a force towards `+`.
    Forward,
    /// It slips with a force towards `−`.
    Backward,
}

impl BrakeState {
    /// Direction of its force: ±1 where it slips, 0 where it holds.
    pub fn direction(self) -> f64 {
        match self {
            BrakeState::Holding => 0.0,
            BrakeState::Forward => 1.0,
            BrakeState::Backward => -1.0,
        }
    }
}

/// States of the brakes at which the search begins: those of the motions that are expected.
pub(super) fn founding(rigid: &PerAxis<RigidMotion>) -> PerAxis<BrakeState> {
    rigid.map(|motion| match motion.guess {
        speed if speed > 0.0 => BrakeState::Backward,
        speed if speed < 0.0 => BrakeState::Forward,
        _ => BrakeState::Holding,
    })
}

/// State of a brake of strength `limit` beside an external `load` after a solution with the `reaction` that the motion
/// takes [N/m, N] and the `speed` of the axis. A brake keeps its hold within a `tolerance`.
pub(super) fn next(
    before: BrakeState,
    [load, limit]: [f64; 2],
    reaction: impl FnOnce() -> f64,
    speed: f64,
    tolerance: f64,
) -> BrakeState {
    match before {
        BrakeState::Holding => match reaction() - load {
            held if held.abs() <= limit + tolerance => BrakeState::Holding,
            held if held > 0.0 => BrakeState::Forward,
            _ => BrakeState::Backward,
        },
        BrakeState::Forward | BrakeState::Backward if before.direction() * speed > 0.0 => BrakeState::Holding,
        BrakeState::Forward | BrakeState::Backward => before,
    }
}
