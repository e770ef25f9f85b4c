//! Sinusoids.

use std::f64::consts::TAU;

/// `h = A sin(2πx/λ + φ)`.
///
/// The sine is the portable one of the crate `libm`, so that the same profile has the same bits on every machine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wave {
    /// Amplitude \[m].
    pub amplitude: f64,
    /// Wavelength \[m].
    pub wavelength: f64,
    /// Phase at position zero \[rad].
    pub phase: f64,
}

impl Wave {
    fn angle(&self, position: f64) -> f64 {
        TAU * (position / self.wavelength).fract() + self.phase
    }

    /// Height at a position \[m].
    pub fn height(&self, position: f64) -> f64 {
        self.amplitude * libm::sin(self.angle(position))
    }

    /// Slope at a position.
    pub fn slope(&self, position: f64) -> f64 {
        TAU * self.amplitude / self.wavelength * libm::cos(self.angle(position))
    }
}
