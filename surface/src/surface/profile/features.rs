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

    /// Shortest wavelength \[m].
    pub fn wavelength(&self) -> f64 {
        match self {
            Self::Undulation(undulation) => undulation.texture.wavelength(),
            Self::Defect(defect) => defect.form.wavelength(),
        }
    }

    /// The local feature; `None` for undulations, which may lie under all other features.
    pub fn local(&self) -> Option<&Defect> {
        match self {
            Self::Undulation(_) => None,
            Self::Defect(defect) => Some(defect),
        }
    }

    /// Overlap with the stretch between two positions \[m].
    pub fn meets(&self, low: f64, high: f64) -> bool {
        match self {
            Self::Undulation(undulation) => undulation.meets(low, high),
            Self::Defect(defect) => defect.meets(low, high),
        }
    }
}
