//! What steel bears in the contact: a largest pressure, and less friction where its surface melts.

use crate::piecewise::{Piecewise, interpolate};

/// Pressure above the limit per depth by which the surface gives way in a step [Pa/m]: so small that 100 µm take 1 MPa, but enough to
/// hold the wheel up where the whole contact yields. It belongs to the depth and not to the time: steel that rolls through gives
/// way by the whole depth in every step, however short that is.
pub const RESISTANCE: f64 = 1e10;

/// Limits of the contact forces. In the plane, the pressure under which steel flows sideways is that of a rigid-plastic
/// half-plane under a punch (see [`crate::material::INDENTATION`]); it falls with the temperature of what lies below.
#[derive(Clone, Copy, Debug)]
pub struct Limits<'a> {
    /// Largest pressure of cold steel \[Pa]; infinite: it does not yield.
    pub pressure: f64,
    /// Smallest largest pressure \[Pa]: steel that bears less would spread beyond the contact zone.
    pub least: f64,
    /// Largest friction traction of yielding steel over its pressure \[1].
    pub shear: f64,
    /// Share of the largest pressure that remains, over x \[1]; empty: all of it.
    pub softened: &'a Piecewise,
    /// Share of the friction coefficient that remains where the surface melts, over x \[1]; empty: all of it.
    pub film: &'a Piecewise,
}

impl<'a> Limits<'a> {
    /// No limit at all; `all` is an empty function.
    pub fn none(all: &'a Piecewise) -> Self {
        Self { pressure: f64::INFINITY, least: 0.0, shear: f64::INFINITY, softened: all, film: all }
    }

    /// Whether the pressure is limited at all.
    pub fn is_limited(&self) -> bool {
        self.pressure.is_finite()
    }

    /// Share of the friction coefficient at `x` \[m] that is left \[1].
    pub fn film_at(&self, x: f64) -> f64 {
        if self.film.is_empty() { 1.0 } else { interpolate(&self.film.x, &self.film.value, x) }
    }

    /// Largest pressure at `x` \[m] \[Pa].
    pub fn pressure_at(&self, x: f64) -> f64 {
        let softened = || interpolate(&self.softened.x, &self.softened.value, x);
        let pressure = if self.softened.is_empty() { self.pressure } else { self.pressure * softened() };
        pressure.max(self.least)
    }
}
