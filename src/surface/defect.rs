//! Local features: a form, where it lies and how often it is repeated.

use super::samples::Samples;
use std::f64::consts::PI;

/// Height over the distance from the middle of a local feature.
#[derive(Clone, Debug, PartialEq)]
pub enum Form {
    /// A part of the surface lies higher, or lower, by the same everywhere: a jump at each end.
    Plateau {
        /// Distances between which it lies \[m].
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
        /// Half of the angle that it takes \[rad].
        half: f64,
        /// Radius of the wheel \[m].
        radius: f64,
    },
    /// Samples of a file.
    Samples(Samples),
}

impl Form {
    /// Height at a distance from the middle \[m].
    pub fn height(&self, at: f64) -> f64 {
        let within = |length: &f64| 2.0 * at.abs() < *length;
        match self {
            Self::Plateau { reach, height } if at >= reach[0] && at <= reach[1] => *height,
            Self::Trough { length, depth } if within(length) => -depth * libm::cos(PI * at / length).powi(2),
            Self::Joint { length, dip, gap, depth } if within(length) => {
                let end = 1.0 - 2.0 * at.abs() / length;
                -dip * end * end - if within(gap) { *depth } else { 0.0 }
            }
            Self::Chord { half, radius } => {
                let angle = at.abs() / radius;
                if angle >= *half {
                    return 0.0;
                }
                // r (cos α/cos θ − 1) without cancellation.
                -2.0 * radius * libm::sin(0.5 * (half + angle)) * libm::sin(0.5 * (half - angle)) / libm::cos(angle)
            }
            Self::Samples(samples) => samples.height(at),
            _ => 0.0,
        }
    }

    /// Slope at a distance from the middle.
    pub fn slope(&self, at: f64) -> f64 {
        let within = |length: &f64| 2.0 * at.abs() < *length;
        match self {
            Self::Trough { length, depth } if within(length) => PI * depth / length * libm::sin(2.0 * PI * at / length),
            Self::Joint { length, dip, .. } if within(length) => {
                4.0 * dip / length * (1.0 - 2.0 * at.abs() / length) * at.signum()
            }
            Self::Chord { half, radius } if at.abs() < half * radius => {
                let angle = at / radius;
                libm::cos(*half) * libm::sin(angle) / libm::cos(angle).powi(2)
            }
            Self::Samples(samples) => samples.slope(at),
            _ => 0.0,
        }
    }

    /// Distances between which it lies \[m].
    pub fn reach(&self) -> [f64; 2] {
        match self {
            Self::Plateau { reach, .. } => *reach,
            Self::Trough { length, .. } | Self::Joint { length, .. } => [-0.5 * length, 0.5 * length],
            Self::Chord { half, radius } => [-half * radius, half * radius],
            Self::Samples(samples) => samples.reach(),
        }
    }

    /// Distances at which it jumps \[m].
    fn jumps(&self) -> Option<[f64; 2]> {
        match self {
            Self::Plateau { reach, .. } => Some(*reach),
            Self::Joint { gap, .. } if *gap > 0.0 => Some([-0.5 * gap, 0.5 * gap]),
            _ => None,
        }
    }

    /// Lowest and highest point \[m].
    pub fn range(&self) -> [f64; 2] {
        match self {
            Self::Plateau { height, .. } => [height.min(0.0), height.max(0.0)],
            Self::Samples(samples) => samples.range(),
            other => [other.height(0.0), 0.0],
        }
    }

    /// Shortest wavelength \[m]: between two jumps lies half a wave; a single jump has none.
    pub fn wavelength(&self) -> f64 {
        let [begin, end] = self.reach();
        match self {
            Self::Plateau { .. } => 2.0 * (end - begin),
            Self::Joint { gap, .. } if *gap > 0.0 => 2.0 * gap,
            Self::Samples(samples) => samples.wavelength(),
            _ => end - begin,
        }
    }
}

/// Where a form lies: once, repeated, or once a turn of the wheel.
#[derive(Clone, Debug, PartialEq)]
pub struct Place {
    /// Position of the middle of the first one \[m].
    pub position: f64,
    /// Distance to the next one \[m].
    pub every: f64,
    /// How many there are; infinite if they never end.
    pub count: f64,
    /// Circumference after which all repeat \[m], of a wheel.
    pub turn: Option<f64>,
}

/// A form in its place.
#[derive(Clone, Debug, PartialEq)]
pub struct Defect {
    /// What it looks like.
    pub form: Form,
    /// Where it lies.
    pub place: Place,
}

impl Defect {
    /// Last position \[m] of samples that go on nowhere, in the direction of travel. Those that are put in a place and begin and end
    /// at no height are a defect, behind which the smooth rail goes on.
    pub fn end(&self, forward: bool) -> Option<f64> {
        let (Form::Samples(samples), Place { position, every, count, turn: None }) = (&self.form, &self.place) else {
            return None;
        };
        let [begin, end] = samples.reach();
        let whole = *position != 0.0 && [begin, end].iter().all(|&at| samples.height(at) == 0.0);
        let last = if forward { position + every * (count - 1.0) + end } else { position + begin };
        (!whole && last.is_finite()).then_some(last)
    }

    /// Distance from the middle of that one of the repeated forms that may reach a position \[m].
    fn local(&self, position: f64) -> f64 {
        let Place { position: first, every, count, turn } = self.place;
        let [begin, _] = self.form.reach();
        let along = position - first;
        let along = turn.map_or(along, |turn| along - turn * ((along - begin) / turn).floor());
        along - every * ((along - begin) / every).floor().clamp(0.0, count - 1.0)
    }

    /// Height at a position \[m].
    pub fn height(&self, position: f64) -> f64 {
        self.form.height(self.local(position))
    }

    /// Slope at a position.
    pub fn slope(&self, position: f64) -> f64 {
        self.form.slope(self.local(position))
    }

    /// Whether one of the forms lies, in part at least, between two positions \[m].
    pub fn meets(&self, low: f64, high: f64) -> bool {
        self.has_between(self.form.reach(), [low, high])
    }

    /// Whether one of the forms jumps between two positions \[m].
    pub fn jumps(&self, low: f64, high: f64) -> bool {
        self.form
            .jumps()
            .into_iter()
            .flatten()
            .filter(|at| at.is_finite())
            .any(|at| self.has_between([at, at], [low, high]))
    }

    /// Whether the part from `begin` to `end` of one of the forms, distances from its middle \[m], lies between two positions \[m].
    fn has_between(&self, [begin, end]: [f64; 2], [low, high]: [f64; 2]) -> bool {
        let Place { position: first, every, count, turn } = self.place;
        let once = |low: f64, high: f64| {
            let from = ((low - first - end) / every).ceil().max(0.0);
            let to = ((high - first - begin) / every).floor().min(count - 1.0);
            from <= to
        };
        match turn {
            None => once(low, high),
            Some(turn) => {
                let shift = turn * ((low - first - begin) / turn).floor();
                [0.0, turn].iter().any(|back| once(low - shift - back, high - shift - back))
            }
        }
    }
}
