//! One summand of a profile.

use super::defect::Defect;
use super::wave::Cover;

/// One summand of a profile.
#[derive(Clone, Debug, PartialEq)]
pub enum Feature {
    /// Something that covers the surface.
    Cover(Cover),
    /// Something local, perhaps repeated.
    Defect(Defect),
}

impl Feature {
    /// Height at a position \[m].
    pub fn height(&self, position: f64) -> f64 {
        match self {
            Self::Cover(cover) => cover.height(position),
            Self::Defect(defect) => defect.height(position),
        }
    }

    /// Slope at a position.
    pub fn slope(&self, position: f64) -> f64 {
        match self {
            Self::Cover(cover) => cover.slope(position),
            Self::Defect(defect) => defect.slope(position),
        }
    }

    /// Shortest wavelength \[m].
    pub fn wavelength(&self) -> f64 {
        match self {
            Self::Cover(cover) => cover.pattern.wavelength(),
            Self::Defect(defect) => defect.form.wavelength(),
        }
    }

    /// Lowest and highest point \[m].
    pub fn range(&self) -> [f64; 2] {
        match self {
            Self::Cover(cover) => cover.pattern.range(),
            Self::Defect(defect) => defect.form.range(),
        }
    }

    /// Whether it covers the surface.
    pub fn is_cover(&self) -> bool {
        matches!(self, Self::Cover(_))
    }

    /// Whether it lies, in part at least, between two positions \[m].
    pub fn meets(&self, low: f64, high: f64) -> bool {
        match self {
            Self::Cover(cover) => cover.meets(low, high),
            Self::Defect(defect) => defect.meets(low, high),
        }
    }

    /// Whether it jumps somewhere between two positions \[m].
    pub fn jumps(&self, low: f64, high: f64) -> bool {
        match self {
            Self::Cover(_) => false,
            Self::Defect(defect) => defect.jumps(low, high),
        }
    }

    /// Last position \[m] of samples that go on nowhere, in the direction of travel.
    pub fn end(&self, forward: bool) -> Option<f64> {
        match self {
            Self::Cover(_) => None,
            Self::Defect(defect) => defect.end(forward),
        }
    }

    /// Whether both may lie on the same spot.
    pub fn may_overlap(&self, other: &Self) -> bool {
        match (self.only_stretch(), other.only_stretch()) {
            (Some([low, high]), _) => other.meets(low, high),
            (_, Some([low, high])) => self.meets(low, high),
            _ => true,
        }
    }

    /// Positions between which it lies, if there is one such stretch.
    fn only_stretch(&self) -> Option<[f64; 2]> {
        match self {
            Self::Defect(Defect { form, place }) if place.count == 1.0 => {
                Some(form.reach().map(|end| place.position + end))
            }
            _ => None,
        }
    }
}
