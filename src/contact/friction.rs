//! Laws of the friction coefficient. Within a step the friction cone is exact, whatever law gave its coefficient.

use serde::{Deserialize, Serialize};

/// Coefficient that falls with the slip velocity and with the temperature of the contact:
///
/// `μ(s, T) = μ₀ · (A + (1 − A) e^{−B s}) · max(m, 1 − K (T − T_ref))`
///
/// with the available coefficient `μ₀`, the nominal slip velocity `s = |V − rΩ|` and the mean contact temperature T (O.
/// Polach, *Wear* 258 (2005) 992–1000, for the falling part).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrictionLaw {
    /// `A`: share of the coefficient that remains at high slip velocity \[1]; 1: constant.
    pub falling_ratio: f64,
    /// `B`: decay with the slip velocity [s/m].
    pub falling_decay: f64,
    /// `K`: decay with the contact temperature [1/K]; 0: constant.
    pub softening: f64,
    /// `m`: share of the coefficient that remains in a hot contact \[1].
    pub softening_floor: f64,
}

/// Rise of the mean contact temperature per unit of friction coefficient \[K], at the end of the last step and of the one
/// before.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Heating {
    /// At the end of the last step.
    pub now: f64,
    /// One step earlier.
    pub before: f64,
}

impl Heating {
    /// Extrapolated linearly over the coming step, whose length is `ratio` times that of the last one.
    fn predicted(&self, ratio: f64) -> f64 {
        (self.now + ratio * (self.now - self.before)).clamp(0.0, 2.0 * self.now.max(0.0))
    }
}

impl FrictionLaw {
    /// Coefficient of the coming step from the `available` one \[1] and the nominal `slip` velocity [m/s]; `ratio` is the
    /// length of the step over that of the one before, 0 if that says nothing.
    ///
    /// The flash temperature follows the friction within microseconds, `T − T_ref = θ μ`. Solving `μ = cold (1 − K θ μ)`
    /// with θ extrapolated to the coming step keeps the law stable in long steps and second order in short ones.
    pub fn coefficient(&self, available: f64, slip: f64, heating: Heating, ratio: f64) -> f64 {
        let falling = self.falling_ratio + (1.0 - self.falling_ratio) * (-self.falling_decay * slip.abs()).exp();
        let cold = available * falling;
        let hot = cold / (1.0 + cold * self.softening * heating.predicted(ratio));
        hot.max(cold * self.softening_floor)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAW: FrictionLaw =
        FrictionLaw { falling_ratio: 0.4, falling_decay: 1.5, softening: 1e-3, softening_floor: 0.1 };

    #[test]
    fn friction_falls_from_the_available_coefficient_to_the_remaining_share() {
        let cold = |slip| LAW.coefficient(0.3, slip, Heating::default(), 0.0);
        assert_eq!(cold(0.0), 0.3);
        assert!((cold(-2.0) - 0.3 * (0.4 + 0.6 * (-3.0f64).exp())).abs() < 1e-16);
        assert!((cold(1e3) - 0.12).abs() < 1e-15);
    }

    #[test]
    fn the_softened_coefficient_and_its_temperature_belong_together() {
        // μ = μ₀ (1 − K θ μ) with θ in kelvin per unit of friction.
        let heating = Heating { now: 2000.0, before: 2000.0 };
        let mu = LAW.coefficient(0.3, 0.0, heating, 1.0);
        assert!((mu - 0.3 * (1.0 - LAW.softening * heating.now * mu)).abs() < 1e-15);
        let molten = Heating { now: 1e6, before: 1e6 };
        assert!((LAW.coefficient(0.3, 0.0, molten, 0.0) - 0.03).abs() < 1e-16);
    }

    #[test]
    fn heating_is_extrapolated_but_never_below_zero_or_beyond_twice_its_value() {
        assert_eq!(Heating { now: 300.0, before: 200.0 }.predicted(1.0), 400.0);
        assert_eq!(Heating { now: 300.0, before: -900.0 }.predicted(1.0), 600.0);
        assert_eq!(Heating { now: 300.0, before: 900.0 }.predicted(2.0), 0.0);
        assert_eq!(Heating { now: -5.0, before: -5.0 }.predicted(0.0), 0.0);
    }
}
