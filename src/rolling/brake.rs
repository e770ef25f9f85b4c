//! The brake of the wheel: what it does in a step.
//!
//! Its strength is that of the input `brake.torque`; whether it slips or holds is found with the contact
//! ([`crate::contact::active_set`]). There it is an impulse of the step, as all forces in the time formula are: the
//! brake that stops the wheel within a step gives what that takes, and one that holds it balances what the step brings.
//! Theory: `docs/theory/time-formula.md`.

use super::state::{Brake, Motion};
use crate::axes::PerAxis;
use crate::contact::AxisDrive;

/// Speed of the rim below which a wheel starts at rest [m/s].
const AT_REST: f64 = 1e-9;

impl Brake {
    /// The brake in a step that ended with `motion` under the moment `driving` \[N]. `given` is what the inputs give at
    /// its end, `taken` what entered the time formula, whose weight of the new value is `a0` [1/s], over `dt` \[s].
    pub fn applied(given: AxisDrive, taken: AxisDrive, motion: &Motion, driving: f64, [a0, dt]: [f64; 2]) -> Self {
        let (AxisDrive::Braked { load, .. }, omega) = (taken, motion.omega.now) else { return Self::default() };
        let (impulse, locked) = ((driving - load) / a0, omega == 0.0);
        let limit = given.loads().map_or(0.0, |[_, limit]| limit);
        let moment = if locked { impulse / dt } else { -limit * omega.signum() };
        Self { moment, impulse, locked, power: 0.0 }
    }

    /// The brake in a stationary state with the speed `omega` [rad/s] under the moment `driving` \[N].
    pub fn stationary(given: AxisDrive, omega: f64, driving: f64) -> Self {
        let AxisDrive::Braked { load, limit } = given else { return Self::default() };
        let moment = (driving - load).clamp(-limit, limit);
        Self { moment, impulse: 0.0, locked: omega == 0.0, power: -moment * omega }
    }
}

/// Drive of the rotation at a stationary start, where the brake slips or holds for good: `rim` is the peripheral
/// velocity [m/s] at which the wheel starts. A wheel that stands is held against drive and pull as far as the brake
/// does.
pub fn at_start(drives: &PerAxis<AxisDrive>, velocity: f64, rim: f64, radius: f64) -> AxisDrive {
    let AxisDrive::Braked { load, limit } = drives.rotation else { return drives.rotation };
    let pull = drives.travel.loads().map_or(0.0, |[force, _]| load + radius * force);
    let at_rest = velocity.abs() + rim.abs() <= AT_REST;
    if rim.abs() > AT_REST {
        AxisDrive::Free { load: load - limit * rim.signum() }
    } else if at_rest && pull.abs() > limit {
        AxisDrive::Free { load: load - limit * pull.signum() }
    } else {
        AxisDrive::Prescribed { target: 0.0 }
    }
}
