//! One summand of a profile.

use super::defect::{Defect, Repetition};
use super::forms::Form;
use super::samples::HeightSamples;
use super::undulation::Undulation;

/// One summand of a profile.
#[derive(Clone, Debug, PartialEq)]
pub enum Feature {
    /// Waves or roughness on the whole surface or a stretch of it.
    Undulation(Undulation),
    /// A local feature, perhaps repeated.
    Defect(Defect),
}

impl Feature {
    /// Samples at the positions that they name.
    pub fn sampled(samples: HeightSamples) -> Self {
        let repetition = Repetition { position: 0.0, every: 1.0, count: 1.0, turn: None };
        Self::Defect(Defect { form: Form::Samples(samples), repetition })
    }

    /// Height at a position \[m].
    pub fn height(&self, position: f64) -> f64 {
        match self {
            Self::Undulation(undulation) => undulation.height(position),
            Self::Defect(defect) => defect.height(position),
        }
    }

    /// Slope at a position.
    pub fn slope(&self, position: f64) -> f64 {
        match self {
            Self::Undulation(undulation) => undulation.slope(position),
            Self::Defect(defect) => defect.slope(position),
        }
    }

    /// Shortest wavelength \[m].
    pub fn wavelength(&self) -> f64 {
        match self {
            Self::Undulation(undulation) => undulation.texture.wavelength(),
            Self::Defect(defect) => defect.form.wavelength(),
        }
    }

    /// Lowest and highest point \[m].
    pub fn range(&self) -> [f64; 2] {
        match self {
            Self::Undulation(undulation) => undulation.texture.range(),
            Self::Defect(defect) => defect.form.range(),
        }
    }

    /// Distinction of undulations, which may lie under all other features.
    pub fn is_undulation(&self) -> bool {
        matches!(self, Self::Undulation(_))
    }

    /// Overlap with the stretch between two positions \[m].
    pub fn meets(&self, low: f64, high: f64) -> bool {
        match self {
            Self::Undulation(undulation) => undulation.meets(low, high),
            Self::Defect(defect) => defect.meets(low, high),
        }
    }

    /// Presence of a jump between two positions \[m].
    pub fn jumps(&self, low: f64, high: f64) -> bool {
        match self {
            Self::Undulation(_) => false,
            Self::Defect(defect) => defect.jumps(low, high),
        }
    }

    /// Last position \[m] of samples in the direction of travel, behind which nothing is known of the rail.
    pub fn end(&self, forward: bool) -> Option<f64> {
        match self {
            Self::Undulation(_) => None,
            Self::Defect(defect) => defect.end(forward),
        }
    }

    /// First and last position \[m] of samples on the rail.
    pub fn sample_ends(&self) -> Option<[f64; 2]> {
        match self {
            Self::Undulation(_) => None,
            Self::Defect(defect) => defect.sample_ends(),
        }
    }

    /// Ends \[m] of a gap in samples, and their usual distance.
    pub fn gap(&self) -> Option<([f64; 2], f64)> {
        match self {
            Self::Undulation(_) => None,
            Self::Defect(defect) => defect.gap(),
        }
    }

    /// Possibility of an overlap with another feature; `false` is certain.
    pub fn may_overlap(&self, other: &Self) -> bool {
        match (self.only_stretch(), other.only_stretch()) {
            (Some([low, high]), _) => other.meets(low, high),
            (_, Some([low, high])) => self.meets(low, high),
            _ => true,
        }
    }

    /// First and last position of a feature that lies on a single stretch.
    fn only_stretch(&self) -> Option<[f64; 2]> {
        match self {
            Self::Defect(Defect { form, repetition }) if repetition.count == 1.0 => {
                Some(form.reach().map(|end| repetition.position + end))
            }
            _ => None,
        }
    }
}
