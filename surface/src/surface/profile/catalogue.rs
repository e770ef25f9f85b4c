//! The features that a text can name, with their parameters, ranges and defaults.

use super::arguments::FeatureArguments;
use super::body::Body;
use super::defect::{Defect, Repetition};
use super::error::ProfileError;
use super::features::Feature;
use super::forms::Form;
use super::roughness::{self, EN_ISO_3095, LARGEST_TABLE, LONGEST_LIMIT, Spectrum};
use super::samples::{HeightSamples, ROUNDED_PERIOD, ROUNDED_SUM};
use super::text::FeatureCall;
use super::undulation::{Sinusoid, Texture, Undulation, Window};

use crate::display::display_number;
use crate::display::nearest;
use std::cell::Cell;
use std::path::Path;

/// Positions [m].
const POSITION: [f64; 2] = [-1e7, 1e7];
/// Wavelengths and lengths of features [m].
const LENGTH: [f64; 2] = [1e-4, 1000.0];
/// Amplitudes and depths [m].
const DEPTH: [f64; 2] = [0.0, 0.02];
/// Phases [rad].
const PHASE: [f64; 2] = [-10.0, 10.0];
/// Levels of roughness [dB re 1 µm].
const LEVEL: [f64; 2] = [-100.0, 60.0];
/// Largest distance of the circumference from a whole number of waves or distances \[1], which are then made to fit.
const MISFIT: f64 = 1e-3;
/// Half-length of the bands that a wavelength may name, as share of 1/10 of a decade.
const OFF_BAND: f64 = 0.1;

/// Builder of a feature from its arguments.
type Maker = fn(&mut FeatureArguments, &Site) -> Result<Feature, ProfileError>;

/// Body of a surface, folder of its files, and memory that is left for its roughness.
pub struct Site<'a> {
    body: Body,
    folder: Option<&'a Path>,
    /// Samples that tables of roughness may still take.
    samples: Cell<usize>,
}

impl<'a> Site<'a> {
    /// A surface without features yet.
    pub fn new(body: Body, folder: Option<&'a Path>) -> Self {
        Self { body, folder, samples: Cell::new(LARGEST_TABLE) }
    }
}

/// All features.
const CATALOGUE: [(&str, Maker); 9] = [
    ("sinusoid", sinusoid),
    ("polygon", polygon),
    ("roughness", rough),
    ("hole", hole),
    ("step", step),
    ("joint", joint),
    ("squat", squat),
    ("flat", flat),
    ("file", file),
];

/// Names of all features.
pub fn names() -> impl Iterator<Item = &'static str> {
    CATALOGUE.iter().map(|(name, _)| *name)
}

/// Makes the feature that a call names.
pub fn build(call: FeatureCall, site: &Site) -> Result<Feature, ProfileError> {
    let Some((name, make)) = CATALOGUE.iter().find(|(name, _)| *name == call.name) else {
        let nearest = nearest(&call.name, names());
        let problem = format!("feature {} is unknown; nearest: {nearest}", call.name);
        return Err(ProfileError::at(call.column, problem));
    };
    let mut given = FeatureArguments::new(name, call, "name")?;
    let feature = make(&mut given, site)?;
    given.finish()?;
    Ok(feature)
}

/// The radius of the wheel, of a feature that the rail cannot have.
fn wheel_only(given: &FeatureArguments, site: &Site) -> Result<f64, ProfileError> {
    match site.body {
        Body::Wheel { radius } => Ok(radius),
        Body::Rail => Err(given.owner("wheel", "rail", "sinusoid, hole or file")),
    }
}

/// Refuses the wheel, of a feature that only the rail can have.
fn rail_only(given: &FeatureArguments, site: &Site) -> Result<(), ProfileError> {
    match site.body {
        Body::Rail => Ok(()),
        Body::Wheel { .. } => Err(given.owner("rail", "wheel", "flat, hole or file")),
    }
}

/// A length that fits a whole number of times around the wheel; any length on the rail.
fn fitting(given: &FeatureArguments, site: &Site, name: &'static str, length: f64) -> Result<f64, ProfileError> {
    let Some(turn) = site.body.circumference() else { return Ok(length) };
    let times = (turn / length).round().max(1.0);
    if (turn / length - times).abs() > MISFIT {
        let range = format!(
            "a whole part of the circumference {} m, such as {} m, which fits {times} times",
            display_number(turn),
            turn / times
        );
        return Err(given.outside(name, format!("{length} m"), range));
    }
    Ok(turn / times)
}

/// A texture on the stretch that is given; on the wheel everywhere.
fn undulation(texture: Texture, given: &mut FeatureArguments, site: &Site) -> Result<Feature, ProfileError> {
    let mut window = Window { from: f64::NEG_INFINITY, to: f64::INFINITY, blend: 0.0 };
    if site.body.circumference().is_none() {
        window.from = given.optional("from", "m", POSITION)?.unwrap_or(window.from);
        window.to = given.optional("to", "m", [window.from.max(POSITION[0]), POSITION[1]])?.unwrap_or(window.to);
        let half = if window.from.is_finite() && window.to.is_finite() { 0.5 * (window.to - window.from) } else { 1e4 };
        window.blend = given.optional("blend", "m", [0.0, half])?.unwrap_or(0.0);
    }
    Ok(Feature::Undulation(Undulation { texture, window }))
}

/// A form at the position that is given, repeated if asked for.
fn defect(mut form: Form, given: &mut FeatureArguments, site: &Site) -> Result<Feature, ProfileError> {
    let [begin, end] = form.reach();
    let length = end - begin;
    let turn = site.body.circumference();
    let rounded = if turn.is_some() { ROUNDED_PERIOD } else { ROUNDED_SUM };
    let shortest = if matches!(form, Form::Samples(_)) { length * (1.0 - rounded) } else { length };
    if let Some(turn) = turn.filter(|turn| shortest > *turn) {
        let range = format!("at most the circumference {} m", display_number(turn));
        return Err(given.outside("length", format!("{length} m"), range));
    }
    let position = given.optional("position", "m", POSITION)?.unwrap_or(0.0);
    if length.is_infinite() && (given.has("every") || given.has("count")) {
        return Err(given.missing("length", "where each of them ends, since they are repeated"));
    }
    let every = given.optional("every", "m", [shortest, turn.unwrap_or(1e7).max(length)])?;
    let count = given.whole("count", [1.0, 1e9])?;
    let (every, count) = match (every, count, turn) {
        (None, Some(_), _) => return Err(given.missing("every", "the distance after which it repeats [m]")),
        (None, None, turn) => (turn.unwrap_or(1.0), 1.0),
        (Some(every), count, None) => (every, count.unwrap_or(f64::INFINITY)),
        (Some(every), None, Some(turn)) => {
            let every = fitting(given, site, "every", every)?;
            (every, (turn / every).round())
        }
        (Some(every), Some(count), Some(turn)) if count * every > turn => {
            let range =
                format!("at most {} with every = {every} m on {} m", (turn / every).floor(), display_number(turn));
            return Err(given.outside("count", count, range));
        }
        (Some(every), Some(count), Some(_)) => (every, count),
    };
    if let (Form::Samples(samples), true) = (&mut form, turn.is_some() || count > 1.0) {
        samples.close(every).map_err(|problem| given.outside("every", format!("{every} m"), problem))?;
    }
    Ok(Feature::Defect(Defect { form, repetition: Repetition { position, every, count, turn } }))
}

fn sinusoid(given: &mut FeatureArguments, site: &Site) -> Result<Feature, ProfileError> {
    let amplitude = given.number("amplitude", "m", DEPTH)?;
    let wavelength = given.number("wavelength", "m", LENGTH)?;
    let wavelength = fitting(given, site, "wavelength", wavelength)?;
    let phase = given.optional("phase", "rad", PHASE)?.unwrap_or(0.0);
    undulation(Texture::Sinusoid(Sinusoid { amplitude, wavelength, phase }), given, site)
}

fn polygon(given: &mut FeatureArguments, site: &Site) -> Result<Feature, ProfileError> {
    let radius = wheel_only(given, site)?;
    let range = [1.0, 30.0];
    let order = given.whole("order", range)?.ok_or_else(|| given.missing("order", "whole, 1 to 30"))?;
    let amplitude = given.number("amplitude", "m", DEPTH)?;
    let phase = given.optional("phase", "rad", PHASE)?.unwrap_or(0.0);
    let wavelength = std::f64::consts::TAU * radius / order;
    undulation(Texture::Sinusoid(Sinusoid { amplitude, wavelength, phase }), given, site)
}

/// Number of the one-third octave of a wavelength, if it is given.
fn band(given: &mut FeatureArguments, name: &'static str, range: [f64; 2]) -> Result<Option<i32>, ProfileError> {
    let Some(wavelength) = given.optional(name, "m", range)? else { return Ok(None) };
    let number = 10.0 * libm::log10(wavelength);
    if (number - number.round()).abs() > OFF_BAND {
        let near = [number.floor(), number.ceil()].map(|n| display_number(roughness::band_wavelength(n)));
        let range = format!("a one-third octave such as {} or {} m", near[0], near[1]);
        return Err(given.outside(name, format!("{} m", display_number(wavelength)), range));
    }
    Ok(Some(number.round() as i32))
}

fn rough(given: &mut FeatureArguments, site: &Site) -> Result<Feature, ProfileError> {
    let seed = given.whole("seed", [0.0, 2f64.powi(53)])?.unwrap_or(1.0) as u64;
    let offset = given.optional("offset", "dB", LEVEL)?.unwrap_or(0.0);
    let limit = given.word("spectrum", &["EN_ISO_3095"])?;
    let free = given.list("levels", "dB", LEVEL)?;
    let (longest, levels) = match (limit, free) {
        (Some(_), Some(_)) => return Err(given.outside("levels", "a list", "not beside spectrum; leave one out")),
        (None, None) => return Err(given.missing("spectrum", "EN_ISO_3095, or levels: a list in dB re 1e-6 m")),
        (Some(_), None) => {
            let longest = band(given, "longest", [7.8e-4, 2.1])?.unwrap_or(-4);
            let most = 1.02 * roughness::band_wavelength(f64::from(longest));
            let shortest = band(given, "shortest", [7.8e-4, most])?.unwrap_or((-20).min(longest));
            let at = |number: i32| usize::try_from(LONGEST_LIMIT - number).unwrap_or(0);
            (longest, EN_ISO_3095.get(at(longest)..=at(shortest)).unwrap_or_default().to_vec())
        }
        (None, Some(levels)) => {
            let range = [1e-3, 100.0];
            let longest = band(given, "longest", range)?;
            (longest.ok_or_else(|| given.missing("longest", "a one-third octave, 0.001 to 100 m"))?, levels)
        }
    };
    let period = match site.body.circumference() {
        Some(turn) => turn,
        None => given.optional("length", "m", [0.1, 1e5])?.unwrap_or(50.0),
    };
    let levels = levels.iter().map(|level| level + offset).collect();
    let spectrum = Spectrum { longest, levels, seed, period };
    check_table(&spectrum, given, site)?;
    undulation(Texture::Roughness(spectrum.realise()), given, site)
}

/// Refuses bands without a wave, and tables that are too long, alone or together.
fn check_table(spectrum: &Spectrum, given: &FeatureArguments, site: &Site) -> Result<(), ProfileError> {
    let mid = |i: usize| roughness::band_wavelength(f64::from(spectrum.longest) - i as f64);
    let period = display_number(spectrum.period);
    if let Some(i) = (0..spectrum.levels.len()).find(|&i| spectrum.waves(i).is_empty()) {
        let range = format!(
            "shorter, or a longer length: no whole number of waves on {period} m is in the band of {} m",
            display_number(mid(i))
        );
        return Err(given.outside("longest", format!("{} m", display_number(mid(0))), range));
    }
    let (samples, last) = (spectrum.samples(), spectrum.levels.len() - 1);
    let Some(left) = site.samples.get().checked_sub(samples) else {
        let range = format!(
            "longer, or a shorter length: {period} m would take {samples} samples, at most {LARGEST_TABLE} for all roughness of \
             a surface"
        );
        return Err(given.outside("shortest", format!("{} m", display_number(mid(last))), range));
    };
    site.samples.set(left);
    Ok(())
}

fn hole(given: &mut FeatureArguments, site: &Site) -> Result<Feature, ProfileError> {
    let (length, depth) = (given.number("length", "m", LENGTH)?, given.number("depth", "m", DEPTH)?);
    defect(Form::Plateau { reach: [-0.5 * length, 0.5 * length], height: -depth }, given, site)
}

fn step(given: &mut FeatureArguments, site: &Site) -> Result<Feature, ProfileError> {
    let height = given.number("height", "m", [-DEPTH[1], DEPTH[1]])?;
    let length = given.optional("length", "m", LENGTH)?;
    if length.is_none() && site.body.circumference().is_some() {
        return Err(given.missing("length", "on a wheel, where it ends again"));
    }
    let length = length.unwrap_or(f64::INFINITY);
    defect(Form::Plateau { reach: [0.0, length], height }, given, site)
}

fn joint(given: &mut FeatureArguments, site: &Site) -> Result<Feature, ProfileError> {
    rail_only(given, site)?;
    let angle = given.optional("angle", "rad", [0.0, 0.1])?.unwrap_or(0.0);
    let length = given.optional("length", "m", [0.01, 10.0])?.unwrap_or(1.0);
    let gap = given.optional("gap", "m", [0.0, length])?.unwrap_or(0.0);
    let depth = given.optional("depth", "m", DEPTH)?.unwrap_or(0.01);
    if gap == 0.0 && angle == 0.0 {
        return Err(given.missing("angle", "0 to 0.1 rad between the rail ends, or gap, or both"));
    }
    defect(Form::Joint { length, dip: 0.125 * angle * length, gap, depth }, given, site)
}

fn squat(given: &mut FeatureArguments, site: &Site) -> Result<Feature, ProfileError> {
    let (length, depth) = (given.number("length", "m", LENGTH)?, given.number("depth", "m", DEPTH)?);
    defect(Form::Trough { length, depth }, given, site)
}

fn flat(given: &mut FeatureArguments, site: &Site) -> Result<Feature, ProfileError> {
    let radius = wheel_only(given, site)?;
    let length = given.number("length", "m", [1e-3, 0.5 * radius])?;
    let form = match given.word("shape", &["fresh", "rounded"])? {
        Some(1) => Form::Trough { length, depth: length * length / (16.0 * radius) },
        _ => Form::Chord { half: libm::asin(0.5 * length / radius), radius },
    };
    defect(form, given, site)
}

fn file(given: &mut FeatureArguments, site: &Site) -> Result<Feature, ProfileError> {
    let name = given.text("name")?.ok_or_else(|| given.missing("name", "the path of a .csv file"))?;
    let factor = given.optional("factor", "1", [-1e6, 1e6])?.unwrap_or(1.0);
    defect(Form::Samples(HeightSamples::read(&name, site.folder, factor)?), given, site)
}
