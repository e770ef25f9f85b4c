//! How long material stays under the contact: steel that stands there flows, steel that rolls through does not.

use crate::piecewise::Interval;

/// Time in which material has to pass the contact so that it keeps no dent [s].
const PASSING: f64 = 0.01;

/// Speed [m/s] below which material stands in a `patch`, seen in steps of `step` \[s].
pub fn slowest(patch: Interval, step: f64) -> f64 {
    (patch.high - patch.low) / PASSING.max(step)
}

/// How far material with a `speed` [m/s] stands \[1]: wholly below the slowest speed of those that roll through, not at
/// all from twice that on.
pub fn share(speed: f64, slowest: f64) -> f64 {
    if slowest > 0.0 { (2.0 - speed.abs() / slowest).clamp(0.0, 1.0) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn material_stands_that_needs_ten_milliseconds_or_a_step_for_the_patch() {
        let patch = Interval { low: -4e-3, high: 6e-3 };
        assert!((slowest(patch, 1e-3) - 1.0).abs() < 1e-12 && (slowest(patch, 0.02) - 0.5).abs() < 1e-12);
        assert_eq!([0.0, -1.0, 1.5, -2.0, 30.0].map(|speed| share(speed, 1.0)), [1.0, 1.0, 0.5, 0.0, 0.0]);
        assert_eq!(share(0.0, 0.0), 0.0, "no patch");
    }
}
