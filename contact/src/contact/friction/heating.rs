//! Heating of the contact by friction, extrapolated over a step.

use serde::{Deserialize, Serialize};

/// Rise of the mean contact temperature per unit of friction coefficient \[K], at the end of the last step and of the
/// one before.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Heating {
    /// At the end of the last step.
    pub now: f64,
    /// One step earlier.
    pub before: f64,
}

impl Heating {
    /// Extrapolated linearly over the coming step, whose length is `ratio` times that of the last one.
    pub(super) fn predicted(&self, ratio: f64) -> f64 {
        (self.now + ratio * (self.now - self.before)).clamp(0.0, 2.0 * self.now.max(0.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heating_is_extrapolated_but_never_below_zero_or_beyond_twice_its_value() {
        assert_eq!(Heating { now: 300.0, before: 200.0 }.predicted(1.0), 400.0);
        assert_eq!(Heating { now: 300.0, before: -900.0 }.predicted(1.0), 600.0);
        assert_eq!(Heating { now: 300.0, before: 900.0 }.predicted(2.0), 0.0);
        assert_eq!(Heating { now: -5.0, before: -5.0 }.predicted(0.0), 0.0);
    }
}
