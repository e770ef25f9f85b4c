//! The friction law and its parameters.

use super::heating::Heating;
use super::slip::SlipDependence;

/// Coefficient that depends on the slip velocity of the tread and on the temperature of the contact:
///
/// `μ(s, T) = μ₀ · f(s) · max(m, 1 − K (T − T_ref))`
///
/// with the available coefficient `μ₀`, the mean slip velocity s of the surfaces in the patch and their mean
/// temperature T, both weighted with the pressure, and the factor f of [`SlipDependence`]. With a memory the
/// share of `μ₀` follows this local law over a sliding distance `d`: `dμ/dt = (μ(s, T) − μ) |s|/d` at a constant `μ₀` (after E. A. H.
/// Vollebregt, H. M. Schuttelaars, *J. Sound Vib.* 331 (2012) 2141–2155).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrictionLaw {
    /// `f`: factor that depends on the slip.
    pub slip: SlipDependence,
    /// `K`: decay with the contact temperature [1/K]; 0: constant.
    pub softening: f64,
    /// `m`: share of the coefficient that remains in a hot contact \[1].
    pub softening_floor: f64,
    /// `d`: sliding distance over which the coefficient follows the law \[m]; 0: at once.
    pub memory_length: f64,
}

impl FrictionLaw {
    /// The available coefficient at any slip and temperature.
    pub const CONSTANT: Self =
        Self { slip: SlipDependence::Constant, softening: 0.0, softening_floor: 1.0, memory_length: 0.0 };

    /// Sliding distance over which friction that falls with the slip follows its law unless another one is given \[m]:
    /// of the size of a contact of asperities. The tread has no mass of its own and answers a lower friction with a
    /// slip that lowers it further.
    pub const MEMORY: f64 = 25e-6;

    /// The law of a wheel at rest, which does not slip.
    pub fn at_rest(self) -> Self {
        Self { slip: SlipDependence::Constant, ..self }
    }

    /// Fall of the coefficient with the slip velocity in a cold contact, `−∂μ/∂|s|` [s/m], where `available` is that on
    /// the rail.
    pub fn fall(&self, available: f64, slip: f64) -> f64 {
        available * self.slip.fall(slip)
    }

    /// Least share of its temperature that counts as following friction within a step \[1]: all where friction has lost
    /// up to a third, else `1/2κ` with `κ = μ₀Kθ`.
    ///
    /// If nothing followed, friction would take κ times from the temperature what the temperature takes from friction,
    /// one step later, and jump. With this share an error of the extrapolated temperature falls to `1/√3` in every step.
    pub fn followed(&self, available: f64, heating: Heating) -> f64 {
        let softened = available * self.softening * heating.now.max(0.0);
        if softened > 0.5 { 0.5 / softened } else { 1.0 }
    }
}
