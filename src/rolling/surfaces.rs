//! The surfaces of wheel and rail as the parameters describe them.

use super::error::ModelError;
use super::model::Model;
use super::state::State;
use crate::config::Config;
use crate::contact::{Relief, Surfaces};
use crate::surface::{Body, Profile};
use std::path::Path;
use std::sync::Arc;

pub use crate::surface::csv;

impl Relief for Profile {
    fn height(&self, s: f64) -> f64 {
        Profile::height(self, s)
    }

    fn wavelength(&self, low: f64, high: f64) -> f64 {
        self.shortest_wavelength_between(low, high)
    }

    fn jumps(&self, low: f64, high: f64) -> bool {
        self.jumps_between(low, high)
    }

    fn end(&self, forward: bool) -> Option<f64> {
        Profile::end(self, forward)
    }
}

/// The surfaces that the parameters describe; files of profiles are looked for in `folder`.
pub fn surfaces(config: &Config, folder: Option<&Path>) -> Result<Surfaces, ModelError> {
    let radius = config.wheel.radius;
    let relief = |parameter: &'static str, text: &str, body: Body| -> Result<Option<Arc<dyn Relief>>, ModelError> {
        let profile = Profile::parse(text, folder, body).map_err(|source| ModelError::Profile { parameter, source })?;
        if profile.is_smooth() { Ok(None) } else { Ok(Some(Arc::new(profile))) }
    };
    Ok(Surfaces {
        radius,
        wheel: relief("wheel.profile", &config.wheel.profile, Body::Wheel { radius })?,
        rail: relief("rail.profile", &config.rail.profile, Body::Rail)?,
    })
}

/// Elements of the contact between the samples of a profile: as many as the contact resolves.
const SAMPLING: f64 = 2.0;

/// The present profile of the wheel: positions around the tread and heights over the circle \[m], that is `wheel.profile` less what
/// yield and wear have taken. Samples on level stretches are left out.
pub fn wheel_profile(model: &Model, state: &State) -> Vec<[f64; 2]> {
    let circumference = std::f64::consts::TAU * model.wheel.radius;
    let element = model.contact.nominal_half_width() / model.config.mesh.elements_per_half_width as f64;
    let count = (circumference / (SAMPLING * element)).floor().max(3.0) as usize;
    let sample = |k: usize| {
        let s = circumference * k as f64 / count as f64;
        [s, model.contact.surfaces.heights([s, 0.0])[0] - state.flattening[0].depth(s)]
    };
    let samples: Vec<_> = (0..count).map(sample).collect();
    let level = |k: usize| k > 0 && k + 1 < count && (k - 1..k + 2).all(|i| samples[i][1] == samples[k][1]);
    (0..count).filter(|&k| !level(k)).map(|k| samples[k]).collect()
}
