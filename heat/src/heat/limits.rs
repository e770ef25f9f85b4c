//! Steps and speeds for which temperatures are computed.

use super::error::HeatError;

/// Shortest step \[s].
pub const SMALLEST_STEP: f64 = 1e-9;
/// Longest step \[s].
pub const LARGEST_STEP: f64 = 1e6;

/// Refuses a step of `dt` \[s] outside [`SMALLEST_STEP`] to [`LARGEST_STEP`].
pub(super) fn check_step(dt: f64) -> Result<(), HeatError> {
    if (SMALLEST_STEP..=LARGEST_STEP).contains(&dt) {
        return Ok(());
    }
    Err(HeatError::StepSize { dt, shortest: SMALLEST_STEP, longest: LARGEST_STEP })
}

/// Refuses a velocity [m/s] and an angular velocity [rad/s] that are no numbers.
pub(super) fn check_speeds(speeds: [f64; 2]) -> Result<(), HeatError> {
    for (name, value) in ["velocity", "angular velocity"].into_iter().zip(speeds) {
        if !value.is_finite() {
            return Err(HeatError::Input { name, value });
        }
    }
    Ok(())
}
