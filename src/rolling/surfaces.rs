//! The surfaces of wheel and rail as the parameters describe them.

use super::error::ModelError;
use crate::config::Config;
use crate::contact::{Relief, Surfaces};
use crate::surface::{Body, Profile};
use std::path::Path;
use std::sync::Arc;

impl Relief for Profile {
    fn height(&self, s: f64) -> f64 {
        Profile::height(self, s)
    }

    fn wavelength(&self, low: f64, high: f64) -> f64 {
        self.shortest_wavelength_between(low, high)
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
