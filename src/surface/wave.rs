//! What covers a whole surface: sinusoids and roughness, or a stretch of them that begins and ends gently.

use super::roughness::Roughness;
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

    fn height(&self, position: f64) -> f64 {
        self.amplitude * libm::sin(self.angle(position))
    }

    fn slope(&self, position: f64) -> f64 {
        TAU * self.amplitude / self.wavelength * libm::cos(self.angle(position))
    }
}

/// The stretch on which a pattern lies: it rises within `blend` after `from` and falls within `blend` before `to`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    /// Where it begins \[m].
    pub from: f64,
    /// Where it ends \[m].
    pub to: f64,
    /// Length over which it rises and falls \[m].
    pub blend: f64,
}

impl Window {
    /// Share of the pattern at a position, and its slope \[1/m]: `3t² − 2t³` within the blends.
    fn share(&self, position: f64) -> [f64; 2] {
        let (after, before) = (position - self.from, self.to - position);
        if after < 0.0 || before < 0.0 {
            return [0.0, 0.0];
        }
        let (way, sign) = if after < before { (after, 1.0) } else { (before, -1.0) };
        if way >= self.blend {
            return [1.0, 0.0];
        }
        let t = way / self.blend;
        [t * t * (3.0 - 2.0 * t), sign * 6.0 * t * (1.0 - t) / self.blend]
    }
}

/// What covers a surface.
#[derive(Clone, Debug, PartialEq)]
pub enum Pattern {
    /// A sinusoid.
    Wave(Wave),
    /// Random roughness.
    Roughness(Roughness),
}

/// A pattern and the stretch on which it lies.
#[derive(Clone, Debug, PartialEq)]
pub struct Cover {
    /// What it looks like.
    pub pattern: Pattern,
    /// Where it lies.
    pub window: Window,
}

impl Cover {
    /// Height at a position \[m].
    pub fn height(&self, position: f64) -> f64 {
        self.window.share(position)[0] * self.pattern.height(position)
    }

    /// Slope at a position.
    pub fn slope(&self, position: f64) -> f64 {
        match self.window.share(position) {
            [share, 0.0] => share * self.pattern.slope(position),
            [share, slope] => share * self.pattern.slope(position) + slope * self.pattern.height(position),
        }
    }

    /// Whether it lies, in part at least, between two positions \[m].
    pub fn meets(&self, low: f64, high: f64) -> bool {
        high >= self.window.from && low <= self.window.to
    }
}

impl Pattern {
    fn height(&self, position: f64) -> f64 {
        match self {
            Self::Wave(wave) => wave.height(position),
            Self::Roughness(roughness) => roughness.height(position),
        }
    }

    fn slope(&self, position: f64) -> f64 {
        match self {
            Self::Wave(wave) => wave.slope(position),
            Self::Roughness(roughness) => roughness.slope(position),
        }
    }

    /// Shortest wavelength \[m].
    pub fn wavelength(&self) -> f64 {
        match self {
            Self::Wave(wave) => wave.wavelength,
            Self::Roughness(roughness) => roughness.wavelength(),
        }
    }

    /// Lowest and highest point \[m].
    pub fn range(&self) -> [f64; 2] {
        match self {
            Self::Wave(wave) => [-wave.amplitude, wave.amplitude],
            Self::Roughness(roughness) => roughness.range(),
        }
    }
}
