//! Dependence of the friction coefficient on the slip.

/// Factor of the friction coefficient that depends on the slip velocity s [m/s]: 1 without slip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SlipDependence {
    /// The factor 1 at any slip.
    Constant,
    /// `A + (1 − A) e^{−B |s|}` (O. Polach, *Wear* 258 (2005) 992–1000).
    Exponential {
        /// `A`: factor at high slip velocity \[1]; above 1 friction rises.
        remaining: f64,
        /// `B`: decay with the slip velocity [s/m].
        decay: f64,
    },
}

impl SlipDependence {
    /// Factor at a slip velocity [m/s].
    pub fn factor(self, slip: f64) -> f64 {
        match self {
            Self::Constant => 1.0,
            Self::Exponential { remaining, decay } => remaining + (1.0 - remaining) * libm::exp(-decay * slip.abs()),
        }
    }

    /// Fall of the factor with the slip velocity, `−df/d|s|` [s/m].
    pub fn fall(self, slip: f64) -> f64 {
        match self {
            Self::Constant => 0.0,
            Self::Exponential { remaining, decay } => (1.0 - remaining) * decay * libm::exp(-decay * slip.abs()),
        }
    }

    /// Two factors between which it lies at any slip.
    pub fn ends(self) -> [f64; 2] {
        match self {
            Self::Constant => [1.0, 1.0],
            Self::Exponential { remaining, .. } => [1.0, remaining],
        }
    }

    /// Presence of any dependence on the slip.
    pub fn varies(self) -> bool {
        match self {
            Self::Constant => false,
            Self::Exponential { remaining, decay } => remaining != 1.0 && decay > 0.0,
        }
    }

    /// Presence of a fall with the slip, which may excite vibrations.
    pub fn falls(self) -> bool {
        match self {
            Self::Constant => false,
            Self::Exponential { remaining, decay } => remaining < 1.0 && decay > 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Factor, fall and ends of every law belong together; a new one is tried by a line of the list.
    #[test]
    fn fall_is_the_derivative_of_the_factor_which_lies_between_the_ends() {
        for law in [
            SlipDependence::Constant,
            SlipDependence::Exponential { remaining: 0.4, decay: 1.5 },
            SlipDependence::Exponential { remaining: 1.6, decay: 0.7 },
            SlipDependence::Exponential { remaining: 0.0, decay: 100.0 },
        ] {
            let [a, b] = law.ends();
            let (mut any, mut falls) = (false, false);
            for slip in [0.0, 1e-3, 0.02, 0.3, 1.0, 5.0, 40.0] {
                let factor = law.factor(slip);
                assert!(factor >= a.min(b) - 1e-15 && factor <= a.max(b) + 1e-15 && factor == law.factor(-slip));
                let step = 1e-6;
                let difference = (law.factor(slip) - law.factor(slip + step)) / step;
                let middle = law.fall(slip + 0.5 * step);
                assert!(
                    (difference - middle).abs() < 1e-6 * (1.0 + middle.abs()),
                    "{law:?} {slip}: {difference} {middle}"
                );
                (any, falls) = (any || factor != 1.0, falls || middle > 0.0);
            }
            assert_eq!((law.varies(), law.falls(), law.factor(0.0)), (any, falls, 1.0), "{law:?}");
        }
    }
}
