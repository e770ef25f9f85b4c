//! Limits of the steel in the contact: a largest pressure, and less friction where its surface melts.

use crate::piecewise::{Piecewise, interpolate};
use std::f64::consts::PI;

/// Pressure above the limit per depth by which the surface gives way in a step [Pa/m]: so small that 100 µm take 1 MPa,
/// but enough to hold the wheel up where the whole contact yields. It belongs to the depth and not to the time: steel
/// that rolls through gives way by the whole depth in every step, however short that is.
pub const RESISTANCE: f64 = 1e10;

/// Pressure under which a rigid-plastic half-plane flows that bears no shear, over its yield strength in shear \[1]:
/// Prandtl's.
const PRANDTL: f64 = 2.0 + PI;
/// Shear traction over pressure from which on the surface of flowing steel slides over its inside: the strength in
/// shear over the pressure that steel bears under it \[1].
pub const SLIDES: f64 = 2.0 / (2.0 + PI);
/// Shear over strength that ends the search for it \[1].
const PRECISION: f64 = 1e-14;
/// Steps of this search at most: it converges quadratically from above.
const MOST_STEPS: usize = 20;

/// Pressure under which a rigid-plastic half-plane flows that bears the shear traction `shear`, both over its yield
/// strength in shear \[1].
///
/// Slip lines: under the punch the largest principal stress is turned from the normal by half of `φ = asin(shear)`,
/// beside it it lies along the surface, and along the fan between them, which turns by `π/2 − φ/2`, the mean stress
/// falls by twice the turn to 1 at the free surface. Derivation: `docs/theory/limits-of-steel.md`.
pub fn bearing(shear: f64) -> f64 {
    let shear = shear.abs().min(1.0);
    1.0 + PI - libm::asin(shear) + (1.0 - shear * shear).sqrt()
}

/// Pressure of [`bearing`] under a shear traction that is the share `ratio` of the pressure; from [`SLIDES`] on the
/// shear is the strength of the steel.
pub fn bearing_in_sliding(ratio: f64) -> f64 {
    let ratio = ratio.abs().min(SLIDES);
    let mut angle = libm::asin((ratio * PRANDTL).min(1.0));
    for _ in 0..MOST_STEPS {
        let (sin, cos) = libm::sincos(angle);
        let change = (sin - ratio * (1.0 + PI - angle + cos)) / (cos + ratio * (1.0 + sin));
        angle = (angle - change).clamp(0.0, 0.5 * PI);
        if change.abs() <= PRECISION {
            break;
        }
    }
    1.0 + PI - angle + libm::cos(angle)
}

/// Share of the largest pressure that is left under a shear traction that is the share `ratio` of it and counts with
/// the share `sheared` \[1].
pub fn borne_in_sliding(sheared: f64, ratio: f64) -> f64 {
    bearing_in_sliding(sheared * ratio.min(SLIDES)) / PRANDTL
}

/// Limits of the contact forces. In the plane, the pressure under which steel flows sideways is that of a rigid-plastic
/// half-plane under a punch; it falls with the temperature of what lies below,
/// and under shear ([`bearing`]).
#[derive(Clone, Copy, Debug)]
pub struct SteelLimits<'a> {
    /// Largest pressure of cold steel \[Pa]; infinite: it does not yield.
    pub pressure: f64,
    /// Smallest largest pressure \[Pa]: steel that bears less would spread beyond the contact zone.
    pub least: f64,
    /// Share in which the shear of friction counts \[1]: whole where steel stands under the contact, not at all where
    /// it rolls through.
    pub sheared: f64,
    /// Depth of a dent over the yield strength in shear from which on the steel under it has flowed as a whole [m/Pa]:
    /// half-width of the contact over shear modulus, so that the dent shears it by as much as it gives way elastically.
    pub flows: f64,
    /// Share of the largest pressure that remains, over x \[1]; empty: all of it.
    pub softened: &'a Piecewise,
    /// Share of the friction coefficient that remains where the surface melts, over x \[1]; empty: all of it.
    pub film: &'a Piecewise,
}

impl<'a> SteelLimits<'a> {
    /// No limit at all; `all` is an empty function.
    pub fn none(all: &'a Piecewise) -> Self {
        Self { pressure: f64::INFINITY, least: 0.0, sheared: 0.0, flows: 0.0, softened: all, film: all }
    }

    /// True if the pressure is limited at all.
    pub fn is_limited(&self) -> bool {
        self.pressure.is_finite()
    }

    /// Yield strength in shear at `x` \[m] \[Pa].
    pub fn strength_at(&self, x: f64) -> f64 {
        self.pressure_at(x) / PRANDTL
    }

    /// How far the steel at `x` \[m] under a dent of some `depth` \[m] has flowed \[1].
    pub fn flowed(&self, x: f64, depth: f64) -> f64 {
        (depth / (self.flows * self.strength_at(x))).min(1.0)
    }

    /// Share of the largest pressure that is left under a shear traction that is the share `ratio` of it \[1]; `None`:
    /// all of it, to the last bit.
    pub fn borne(&self, ratio: f64) -> Option<f64> {
        (self.sheared != 0.0).then(|| borne_in_sliding(self.sheared, ratio))
    }

    /// Largest pressure at `x` \[m] where the share [`Self::borne`] is left of it \[Pa].
    pub fn sheared_at(&self, x: f64, borne: Option<f64>) -> f64 {
        let most = self.pressure_at(x);
        borne.map_or(most, |borne| (most * borne).max(self.least))
    }

    /// Largest pressure at `x` \[m] \[Pa].
    pub fn pressure_at(&self, x: f64) -> f64 {
        let softened = || interpolate(&self.softened.x, &self.softened.value, x);
        let pressure = if self.softened.is_empty() { self.pressure } else { self.pressure * softened() };
        pressure.max(self.least)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pressure_and_shear_of_sliding_steel_lie_on_the_slip_line_limit() {
        for ratio in [0.0, 1e-9, 0.05, 0.1, 0.2, 0.3, 0.38, SLIDES - 1e-9, SLIDES] {
            let pressure = bearing_in_sliding(ratio);
            // The limit itself has a vertical tangent where the shear is the strength.
            assert!((bearing(ratio * pressure) - pressure).abs() < 1e-6, "{ratio}: {pressure}");
            assert!((bearing_in_sliding(-ratio) - pressure).abs() < 1e-15);
        }
        assert!((bearing_in_sliding(0.0) - PRANDTL).abs() < 1e-15 && (bearing(1.0) - 1.0 - 0.5 * PI).abs() < 1e-15);
        assert_eq!(bearing_in_sliding(10.0), bearing_in_sliding(SLIDES));
        // Values computed from outside.
        for (ratio, pressure) in [(0.05, 4.87), (0.1, 4.56), (0.2, 3.88), (0.3, 3.18)] {
            assert!((bearing_in_sliding(ratio) - pressure).abs() < 5e-3);
        }
    }

    /// The upper bound theorem needs nothing of the stresses: blocks that slide over each other along the fan dissipate
    /// what punch and shear put in. The best of all fans lies on the limit.
    #[test]
    fn no_mechanism_of_fan_and_blocks_flows_below_the_limit() {
        for shear in [0.0, 0.3, 0.7, 0.954, 1.0] {
            let work = |base: f64| {
                // A right-angled triangle under a punch of length 1 slides with the speed 1 along its side at the angle
                // `base` from the surface, of the length `cos`; its other side, `sin`, is that of the fan, which leads
                // to a wedge at 45°.
                let (sin, cos) = base.sin_cos();
                let fan = 0.75 * PI - (0.5 * PI - base);
                let dissipated = cos + sin * (2.0 * fan + 1.0);
                (dissipated - shear * cos) / sin
            };
            let best = (1..100_000).map(|k| work(0.5 * PI * f64::from(k) / 1e5)).fold(f64::INFINITY, f64::min);
            println!("shear {shear}: {best} for {}", bearing(shear));
            assert!(best >= bearing(shear) - 1e-9 && best < bearing(shear) + 1e-4);
        }
    }
}
