//! Irregular surfaces: heights that rail and wheel carry on top of their ideal shapes, fixed in the material.
//!
//! A [`Profile`] is a height over the position: the distance along the rail, or angle times radius along the tread,
//! where it repeats after the circumference. Positive heights add material: a bump of the rail, a larger radius of the
//! wheel. It is read from a text, which is either the name of a file of samples or a sum of features, see
//! [`Profile::parse`].
//!
//! | file | content |
//! |---|---|
//! | `text`, `arguments` | the text as calls of features; their arguments, taken by name and checked |
//! | `catalogue` | every feature by name, with ranges and defaults |
//! | `features` | one summand of a profile |
//! | `forms`, `defect` | height of a local feature over its middle; where it lies and how often |
//! | `undulation`, `roughness` | waves and random roughness on a stretch of the surface |
//! | `samples` | heights from a CSV file |

mod arguments;
mod body;
mod catalogue;
mod defect;
mod error;
mod features;
mod forms;
mod roughness;
mod samples;
mod text;
mod undulation;

pub use body::Body;
pub use error::ProfileError;
pub use samples::csv;

use crate::piecewise::Piecewise;
use defect::Defect;
use features::Feature;
use samples::HeightSamples;
use std::path::Path;

/// Height of a surface over its ideal shape: a sum of features.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Profile {
    features: Vec<Feature>,
}

impl Profile {
    /// Reads a profile.
    ///
    /// An empty text is a smooth surface. A text that ends in `.csv` is a file with the columns `position,height` \[m];
    /// its path is absolute or begins in the working directory, or else in `folder`. Any other text is a sum of features such as
    /// `sinusoid(amplitude = 5e-6, wavelength = 0.05) + hole(position = 2, length = 5e-3, depth = 1e-3)`, every number
    /// in SI units.
    ///
    /// # Errors
    /// Texts and files without meaning: the error names feature or line, value, allowed range and what to do.
    pub fn parse(text: &str, folder: Option<&Path>, body: Body) -> Result<Self, ProfileError> {
        let calls = text::calls(text)?;
        let site = catalogue::Site::new(body, folder);
        let features = calls.into_iter().map(|call| catalogue::build(call, &site)).collect::<Result<_, _>>()?;
        Ok(Self { features })
    }

    /// Profile through given samples, position and height \[m]: linear between them, constant beyond the first and the
    /// last. Positions ascend.
    pub fn from_samples(samples: Piecewise) -> Self {
        Self { features: vec![Feature::sampled(HeightSamples::new(samples))] }
    }

    /// Height at a position \[m]: positive where material is added.
    pub fn height(&self, position: f64) -> f64 {
        if self.is_smooth() {
            return 0.0;
        }
        self.features.iter().map(|feature| feature.height(position)).sum()
    }

    /// Height of local features alone, without waves and roughness \[m].
    pub fn local_height(&self, position: f64) -> f64 {
        self.local().map(|defect| defect.height(position)).sum()
    }

    /// Shortest wavelength of the features between two positions \[m]; infinite without any.
    pub fn shortest_wavelength_between(&self, low: f64, high: f64) -> f64 {
        let met = self.features.iter().filter(|feature| feature.meets(low, high));
        met.map(Feature::wavelength).fold(f64::INFINITY, f64::min)
    }

    /// Presence of a jump between two positions \[m].
    pub fn jumps_between(&self, low: f64, high: f64) -> bool {
        self.local().any(|defect| defect.jumps(low, high))
    }

    /// Position \[m] at which the first of its files ends, in the direction of travel; `None` if all go on.
    pub fn end(&self, forward: bool) -> Option<f64> {
        let ends = self.local().filter_map(|defect| defect.end(forward));
        if forward { ends.reduce(f64::min) } else { ends.reduce(f64::max) }
    }

    /// First and last position \[m] of every file on the rail.
    pub fn sample_ends(&self) -> impl Iterator<Item = [f64; 2]> {
        self.local().filter_map(Defect::sample_ends)
    }

    /// Ends \[m] of the first gap in samples, which are taken to be straight across it, and their usual distance.
    pub fn gap(&self) -> Option<([f64; 2], f64)> {
        self.local().find_map(Defect::gap)
    }

    /// Height and length \[m] of the first samples that look like a cross-section.
    pub fn cross_section(&self) -> Option<[f64; 2]> {
        self.local().find_map(Defect::cross_section)
    }

    /// Presence of any feature between two positions \[m].
    pub fn meets(&self, low: f64, high: f64) -> bool {
        self.features.iter().any(|feature| feature.meets(low, high))
    }

    fn local(&self) -> impl Iterator<Item = &Defect> {
        self.features.iter().filter_map(Feature::local)
    }

    /// Absence of any feature.
    pub fn is_smooth(&self) -> bool {
        self.features.is_empty()
    }
}

/// Length of the longest flat that a text names \[m]; zero if there is none.
pub fn longest_flat(text: &str) -> f64 {
    let calls = text::calls(text).unwrap_or_default();
    calls.iter().filter(|call| call.name == "flat").filter_map(|call| call.number("length")).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests;
