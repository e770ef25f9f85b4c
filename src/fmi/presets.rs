//! Presets: parameter sets by name, and the inputs that follow from parameters until a master sets its own.

use super::variables::variables;
use crate::config::Config;
use crate::simulation::{Drive, Inputs, Rotation, Translation, Vertical};
use std::fs;
use std::path::Path;

/// Name of the preset that holds until another is chosen.
pub const DEFAULT: &str = "railway";

/// Contents of the default preset, for the start values of the model description and for masters that do not say
/// where the resources are.
const DEFAULT_JSON: &str = include_str!("../../resources/railway.json");

/// The default preset as compiled in.
pub fn default_config() -> Config {
    parse(DEFAULT, DEFAULT_JSON).expect("resources/railway.json is checked by a test")
}

/// Reads `<resources>/<name>.json`. Without resources only the compiled-in default is known. The error text lists the
/// presets that exist.
pub fn load(resources: Option<&Path>, name: &str) -> Result<Config, String> {
    let unknown = |why: &str| {
        let names = available(resources).join(", ");
        Err(format!("preset = \"{name}\" {why}; available presets: {names}"))
    };
    let plain = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    if name.is_empty() || !name.chars().all(plain) {
        return unknown("is not a preset name (letters, digits, _ and -)");
    }
    let text = match resources.map(|directory| fs::read_to_string(directory.join(format!("{name}.json")))) {
        Some(Ok(text)) => text,
        _ if name == DEFAULT => DEFAULT_JSON.to_owned(),
        Some(Err(error)) => return unknown(&format!("cannot be read ({error})")),
        None => return unknown("is unknown because the resources of the FMU cannot be read"),
    };
    parse(name, &text).or_else(|why| unknown(&why))
}

/// Names of the presets in the directory, sorted; the default is always among them.
pub fn available(resources: Option<&Path>) -> Vec<String> {
    let files = resources.and_then(|directory| fs::read_dir(directory).ok()).into_iter().flatten();
    let json = |path: &Path| path.extension().is_some_and(|e| e == "json");
    let mut names: Vec<String> = files
        .filter_map(|entry| Some(entry.ok()?.path()).filter(|path| json(path)))
        .filter_map(|path| Some(path.file_stem()?.to_str()?.to_owned()))
        .chain([DEFAULT.to_owned()])
        .collect();
    names.sort();
    names.dedup();
    names
}

fn parse(name: &str, text: &str) -> Result<Config, String> {
    let mut config: Config = serde_json::from_str(text).map_err(|error| format!("is malformed ({error})"))?;
    for variable in variables() {
        if let Some(value) = variable.parameter(name, &mut config) {
            variable.check(&value).map_err(|error| format!("is invalid ({error})"))?;
        }
    }
    config.validate().map_err(|error| format!("is invalid ({error})"))?;
    Ok(config)
}

/// Inputs that follow from the parameters: free rolling under the nominal load with the initial velocity and creepage.
pub fn default_inputs(config: &Config) -> Inputs {
    let drive = Drive {
        omega: rolling_omega(config.initial.velocity, config.initial.creepage, config.wheel.radius),
        velocity: config.initial.velocity,
        load: config.model.nominal_load,
        friction: config.friction.coefficient,
        ..Drive::default()
    };
    Inputs {
        rotation: Rotation::Moment,
        translation: Translation::Force,
        vertical: Vertical::Force,
        drive,
        rate: Drive::default(),
    }
}

/// Angular velocity [rad/s] at which a wheel of `radius` [m] travelling at `velocity` [m/s] has the given creepage
/// `ξ = 2 (V − rω)/(V + rω)`, so `rω = V (2 − ξ)/(2 + ξ)`. At the pole ξ = −2 (spinning on the spot, `V = 0`) the
/// velocity does not determine ω and 0 is returned.
fn rolling_omega(velocity: f64, creepage: f64, radius: f64) -> f64 {
    if creepage <= -2.0 { 0.0 } else { velocity * (2.0 - creepage) / (2.0 + creepage) / radius }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rolling_omega_gives_back_the_creepage() {
        let (v, r): (f64, f64) = (20.0, 0.46);
        for creepage in [-1.9, -1e-3, 0.0, 1e-3, 1.0, 2.0] {
            let circumferential = r * rolling_omega(v, creepage, r);
            let back = 2.0 * (v - circumferential) / (v + circumferential);
            assert!((back - creepage).abs() < 1e-12, "{back} against {creepage}");
        }
    }
}
