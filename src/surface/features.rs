//! The features of which a profile is made, by name.

use super::arguments::Arguments;
use super::defect::{Defect, Form, Place};
use super::samples::Samples;
use super::text::Call;
use super::wave::Wave;
use super::{Body, ProfileError};
use crate::config::{display_number, nearest};
use std::path::Path;

/// One summand of a profile.
#[derive(Clone, Debug, PartialEq)]
pub enum Feature {
    /// A sinusoid, everywhere.
    Wave(Wave),
    /// Something local, perhaps repeated.
    Defect(Defect),
}

/// Distances along a surface [m].
const POSITION: [f64; 2] = [-1e7, 1e7];
/// Lengths of local features and wavelengths [m].
const LENGTH: [f64; 2] = [1e-4, 100.0];
/// Amplitudes and depths [m].
const DEPTH: [f64; 2] = [0.0, 0.01];

/// Names of all features.
const NAMES: [&str; 3] = ["sinusoid", "hole", "file"];

/// Makes a feature of its call.
pub fn build(call: Call, folder: Option<&Path>, body: Body) -> Result<Feature, ProfileError> {
    let Some(&name) = NAMES.iter().find(|name| **name == call.name) else {
        let nearest = nearest(&call.name, NAMES);
        return Err(ProfileError::Feature { column: call.column, name: call.name, nearest });
    };
    let mut given = Arguments::new(name, call, if name == "file" { "name" } else { "" })?;
    let feature = match name {
        "sinusoid" => Feature::Wave(sinusoid(&mut given, body)?),
        "hole" => {
            let (length, depth) = (given.number("length", "m", LENGTH)?, given.number("depth", "m", DEPTH)?);
            defect(Form::Plateau { length, height: -depth }, &mut given, body)?
        }
        _ => file(&mut given, folder, body)?,
    };
    given.finish()?;
    Ok(feature)
}

fn sinusoid(given: &mut Arguments, body: Body) -> Result<Wave, ProfileError> {
    let amplitude = given.number("amplitude", "m", DEPTH)?;
    let mut wavelength = given.number("wavelength", "m", LENGTH)?;
    let phase = given.optional("phase", "rad", [-10.0, 10.0])?.unwrap_or(0.0);
    if let Some(turn) = body.circumference() {
        let waves = (turn / wavelength).round().max(1.0);
        if (turn / wavelength - waves).abs() > 1e-3 {
            let whole = format!(
                "a whole number of waves around the wheel, {} m with {waves} waves on {} m",
                turn / waves,
                display_number(turn)
            );
            return Err(given.outside("wavelength", format!("{wavelength} m"), whole));
        }
        wavelength = turn / waves;
    }
    Ok(Wave { amplitude, wavelength, phase })
}

fn file(given: &mut Arguments, folder: Option<&Path>, body: Body) -> Result<Feature, ProfileError> {
    let name = given.text("name")?.ok_or_else(|| given.missing("name", "the path of a .csv file"))?;
    let factor = given.optional("factor", "1", [-1e6, 1e6])?.unwrap_or(1.0);
    let samples = Samples::read(&name, folder, factor)?;
    defect(Form::Samples(samples), given, body)
}

/// Puts a form where it belongs.
fn defect(mut form: Form, given: &mut Arguments, body: Body) -> Result<Feature, ProfileError> {
    let [begin, end] = form.reach();
    let length = end - begin;
    let turn = body.circumference();
    let position = given.optional("position", "m", POSITION)?.unwrap_or(0.0);
    let every = given.optional("every", "m", [length, 1e7])?;
    let count = given.whole("count", [1.0, 1e9])?;
    if let Some(turn) = turn.filter(|turn| length > *turn) {
        return Err(given.outside("length", format!("{length} m"), format!("at most the circumference, {turn} m")));
    }
    let (every, count) = match (every, turn) {
        (None, _) => (turn.unwrap_or(1.0), 1.0),
        (Some(every), None) => (every, count.unwrap_or(f64::INFINITY)),
        (Some(every), Some(turn)) => (every, count.unwrap_or((turn / every).round())),
    };
    if let (Form::Samples(samples), true) = (&mut form, turn.is_some() || count > 1.0) {
        samples.close(every);
    }
    Ok(Feature::Defect(Defect { form, place: Place { position, every, count, turn } }))
}

impl Feature {
    /// Height at a position \[m].
    pub fn height(&self, position: f64) -> f64 {
        match self {
            Self::Wave(wave) => wave.height(position),
            Self::Defect(defect) => defect.height(position),
        }
    }

    /// Slope at a position.
    pub fn slope(&self, position: f64) -> f64 {
        match self {
            Self::Wave(wave) => wave.slope(position),
            Self::Defect(defect) => defect.slope(position),
        }
    }

    /// Shortest wavelength \[m].
    pub fn wavelength(&self) -> f64 {
        match self {
            Self::Wave(wave) => wave.wavelength,
            Self::Defect(defect) => defect.form.wavelength(),
        }
    }

    /// Lowest and highest point \[m].
    pub fn range(&self) -> [f64; 2] {
        match self {
            Self::Wave(wave) => [-wave.amplitude, wave.amplitude],
            Self::Defect(defect) => defect.form.range(),
        }
    }

    /// Whether it covers the whole surface.
    pub fn is_everywhere(&self) -> bool {
        matches!(self, Self::Wave(_))
    }

    /// Whether it lies, in part at least, between two positions \[m].
    pub fn meets(&self, low: f64, high: f64) -> bool {
        match self {
            Self::Wave(_) => true,
            Self::Defect(defect) => defect.meets(low, high),
        }
    }

    /// Whether both may lie on the same spot.
    pub fn may_overlap(&self, other: &Self) -> bool {
        let once = |feature: &Self| match feature {
            Self::Defect(Defect { form, place }) if place.count == 1.0 => {
                Some(form.reach().map(|end| place.position + end))
            }
            _ => None,
        };
        match (once(self), once(other)) {
            (Some([low, high]), _) => other.meets(low, high),
            (_, Some([low, high])) => self.meets(low, high),
            _ => true,
        }
    }
}
