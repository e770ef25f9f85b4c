//! Forms of local features: height over the distance from their middle.

use super::samples::HeightSamples;
use std::f64::consts::PI;

/// Height over the distance from the middle of a local feature.
#[derive(Clone, Debug, PartialEq)]
pub enum Form {
    /// A constant height between two jumps.
    Plateau {
        /// First and last distance \[m].
        reach: [f64; 2],
        /// Height \[m].
        height: f64,
    },
    /// A smooth trough `−d cos²(πs/L)`.
    Trough {
        /// Length L \[m].
        length: f64,
        /// Depth d \[m].
        depth: f64,
    },
    /// Two rail ends that dip as `−d (1 − 2|s|/L)²`, with a gap between them.
    Joint {
        /// Length L over which the ends dip \[m].
        length: f64,
        /// Depth d of the dip \[m]; the ends meet at the angle 8 d/L.
        dip: f64,
        /// Length of the gap \[m].
        gap: f64,
        /// Depth of the gap \[m].
        depth: f64,
    },
    /// A chord of a wheel: the flat that a slide leaves.
    Chord {
        /// Half of the angle that the chord subtends \[rad].
        half: f64,
        /// Radius of the wheel \[m].
        radius: f64,
    },
    /// Samples of a file.
    Samples(HeightSamples),
}

impl Form {
    /// Height at a distance from the middle \[m].
    pub fn height(&self, at: f64) -> f64 {
        let within = |length: f64| 2.0 * at.abs() < length;
        match self {
            Self::Plateau { reach, height } => match at >= reach[0] && at <= reach[1] {
                true => *height,
                false => 0.0,
            },
            Self::Trough { length, depth } => match within(*length) {
                true => -depth * libm::cos(PI * at / length).powi(2),
                false => 0.0,
            },
            Self::Joint { length, dip, gap, depth } if within(*length) => {
                let end = 1.0 - 2.0 * at.abs() / length;
                -dip * end * end - if within(*gap) { *depth } else { 0.0 }
            }
            Self::Joint { .. } => 0.0,
            Self::Chord { half, radius } => {
                let angle = at.abs() / radius;
                if angle >= *half {
                    return 0.0;
                }
                // r (cos α/cos θ − 1) without cancellation.
                -2.0 * radius * libm::sin(0.5 * (half + angle)) * libm::sin(0.5 * (half - angle)) / libm::cos(angle)
            }
            Self::Samples(samples) => samples.height(at),
        }
    }

    /// First and last distance of the form \[m].
    pub fn reach(&self) -> [f64; 2] {
        match self {
            Self::Plateau { reach, .. } => *reach,
            Self::Trough { length, .. } | Self::Joint { length, .. } => [-0.5 * length, 0.5 * length],
            Self::Chord { half, radius } => [-half * radius, half * radius],
            Self::Samples(samples) => samples.reach(),
        }
    }

    /// Distances of its jumps \[m].
    pub fn jumps(&self) -> Option<[f64; 2]> {
        match self {
            Self::Plateau { reach, .. } => Some(*reach),
            Self::Joint { gap, .. } => (*gap > 0.0).then_some([-0.5 * gap, 0.5 * gap]),
            Self::Trough { .. } | Self::Chord { .. } | Self::Samples(_) => None,
        }
    }

    /// Shortest wavelength \[m]: between two jumps lies half a wave; a single jump has none.
    pub fn wavelength(&self) -> f64 {
        let [begin, end] = self.reach();
        match self {
            Self::Plateau { .. } => 2.0 * (end - begin),
            Self::Joint { gap, .. } if *gap > 0.0 => 2.0 * gap,
            Self::Samples(samples) => samples.wavelength(),
            Self::Trough { .. } | Self::Joint { .. } | Self::Chord { .. } => end - begin,
        }
    }
}
