//! Local features: a form, where it lies and how often it is repeated.

use super::samples::Samples;

/// Height over the distance from the middle of a local feature.
#[derive(Clone, Debug, PartialEq)]
pub enum Form {
    /// A part of the surface lies higher, or lower, by the same everywhere: two jumps.
    Plateau {
        /// Length \[m].
        length: f64,
        /// Height \[m].
        height: f64,
    },
    /// Samples of a file.
    Samples(Samples),
}

impl Form {
    /// Height at a distance from the middle \[m].
    pub fn height(&self, at: f64) -> f64 {
        match self {
            Self::Plateau { length, height } => {
                if at.abs() <= 0.5 * length {
                    *height
                } else {
                    0.0
                }
            }
            Self::Samples(samples) => samples.height(at),
        }
    }

    /// Slope at a distance from the middle.
    pub fn slope(&self, at: f64) -> f64 {
        match self {
            Self::Plateau { .. } => 0.0,
            Self::Samples(samples) => samples.slope(at),
        }
    }

    /// Distances between which it lies \[m].
    pub fn reach(&self) -> [f64; 2] {
        match self {
            Self::Plateau { length, .. } => [-0.5 * length, 0.5 * length],
            Self::Samples(samples) => samples.reach(),
        }
    }

    /// Lowest and highest point \[m].
    pub fn range(&self) -> [f64; 2] {
        match self {
            Self::Plateau { height, .. } => [height.min(0.0), height.max(0.0)],
            Self::Samples(samples) => samples.range(),
        }
    }

    /// Shortest wavelength \[m].
    pub fn wavelength(&self) -> f64 {
        match self {
            Self::Plateau { length, .. } => 2.0 * length,
            Self::Samples(samples) => samples.wavelength(),
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
    /// Distance from the middle of that one of the repeated forms that may reach a position \[m].
    fn local(&self, position: f64) -> f64 {
        let Place { position: first, every, count, turn } = self.place;
        let begin = self.form.reach()[0].max(-0.5 * every);
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
        let Place { position: first, every, count, turn } = self.place;
        let [begin, end] = self.form.reach();
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
