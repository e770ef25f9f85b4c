//! Undulations: sinusoids and roughness on the whole surface, or on a stretch with smooth ends.

use super::roughness::Roughness;
use std::f64::consts::TAU;

/// `h = A sin(2πx/λ + φ)`.
///
/// The sine is the portable one of the crate `libm`, so that the same profile has the same bits on every machine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sinusoid {
    /// Amplitude \[m].
    pub amplitude: f64,
    /// Wavelength \[m].
    pub wavelength: f64,
    /// Phase at position zero \[rad].
    pub phase: f64,
}

impl Sinusoid {
    fn height(&self, position: f64) -> f64 {
        self.amplitude * libm::sin(TAU * (position / self.wavelength).fract() + self.phase)
    }
}

/// Stretch of an undulation, which rises within `blend` after `from` and falls within `blend` before `to`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    /// First position \[m].
    pub from: f64,
    /// Last position \[m].
    pub to: f64,
    /// Length over which it rises and falls \[m].
    pub blend: f64,
}

impl Window {
    /// Weight of the undulation at a position: `3t² − 2t³` within the blends \[1].
    fn weight(&self, position: f64) -> f64 {
        match (position - self.from).min(self.to - position) {
            way if way < 0.0 => 0.0,
            way if way >= self.blend => 1.0,
            way => {
                let t = way / self.blend;
                t * t * (3.0 - 2.0 * t)
            }
        }
    }
}

/// Height of an undulation over the position.
#[derive(Clone, Debug, PartialEq)]
pub enum Texture {
    /// A sinusoid.
    Sinusoid(Sinusoid),
    /// Random roughness.
    Roughness(Roughness),
}

/// A texture on a stretch of the surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Undulation {
    /// Height over the position.
    pub texture: Texture,
    /// Stretch of the surface.
    pub window: Window,
}

impl Undulation {
    /// Height at a position \[m].
    pub fn height(&self, position: f64) -> f64 {
        self.window.weight(position) * self.texture.height(position)
    }

    /// Overlap with the stretch between two positions \[m].
    pub fn meets(&self, low: f64, high: f64) -> bool {
        high >= self.window.from && low <= self.window.to
    }
}

impl Texture {
    fn height(&self, position: f64) -> f64 {
        match self {
            Self::Sinusoid(wave) => wave.height(position),
            Self::Roughness(roughness) => roughness.height(position),
        }
    }

    /// Shortest wavelength \[m].
    pub fn wavelength(&self) -> f64 {
        match self {
            Self::Sinusoid(wave) => wave.wavelength,
            Self::Roughness(roughness) => roughness.wavelength(),
        }
    }
}
