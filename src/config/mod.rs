//! Parameters of a run: the [`table`] of all of them, their check and the presets.
//!
//! Everything is SI. Masses, inertias and forces are those of the *whole wheel*; the two-dimensional model works per
//! metre of width and [`Config::width`] maps one to the other. `Config::default()` is the preset
//! `railway`; other presets say in what they differ from it, see [`presets`].

mod bodies;
pub mod choices;
mod dependent;
mod nominal;
pub mod patch_rows;
pub mod presets;
pub mod retired;
pub mod row;
mod sideways;
pub mod table;
pub mod units;
pub mod value;

pub use choices::*;
pub use dependent::ConfigError;
pub use nominal::NominalPatch;
pub use patch_rows::{OnWheel, PatchRows, PatchTable, RowsError};
pub use table::{
    BrakeParameters, Config, ContactParameters, Damping, Files, Friction, Initial, Material, MeshParameters,
    ModelParameters, Physics, Rail, SolverParameters, Thermal, Tuning, Vehicle, Wheel, WheelsetParameters,
};

use crate::display::display_number;
use dependent::Dependent;
use value::{Kind, Value};

impl Damping {
    /// No damping of vibration modes at all.
    pub const NONE: Self = Self::all(0.0);

    /// One ratio for all modes of both bodies.
    pub const fn all(ratio: f64) -> Self {
        Self {
            wheel_torsion: ratio,
            wheel_radial: ratio,
            wheel_one_diameter: ratio,
            wheel_more_diameters: ratio,
            rail: ratio,
        }
    }

    /// True if no mode is damped.
    pub fn is_none(&self) -> bool {
        *self == Self::NONE
    }
}

impl Config {
    /// Width of the bodies of wheel and rail \[m]: forces of the wheel = width × forces of the plane model.
    pub fn width(&self) -> f64 {
        if self.contact.shape.is_line() { self.model.contact_width } else { self.model.structural_width }
    }

    /// Value and unit of a numeric parameter.
    fn number(&self, name: &str) -> (f64, &'static str) {
        match Self::rows().iter().find(|row| row.name == name).map(|row| ((row.read)(self), row.kind)) {
            Some((Value::Real(value), Kind::Real { measure, .. })) => (value, measure.unit),
            Some((Value::Integer(value), _)) => (f64::from(value), "1"),
            _ => (f64::NAN, "1"),
        }
    }

    /// A numeric parameter with its value, in words: `rail.length = 1 m`.
    pub fn given(&self, name: &str) -> String {
        let (value, unit) = self.number(name);
        let unit = if unit == "1" { String::new() } else { format!(" {unit}") };
        format!("{name} = {}{unit}", display_number(value))
    }

    /// A text with values of numeric parameters: `{rail.length}` becomes `rail.length = 1 m`, and `{rail.length now}`
    /// becomes `rail.length (now 1 m)`.
    pub fn told(&self, text: &str) -> String {
        let name = |name: &str| match name.strip_suffix(" now") {
            Some(name) => self.given(name).replacen(" = ", " (now ", 1) + ")",
            None => self.given(name),
        };
        let parts = text.split(['{', '}']).enumerate();
        parts.map(|(k, part)| if k % 2 == 0 { part.to_owned() } else { name(part) }).collect()
    }

    /// This configuration with all that may change during a run from another one.
    pub fn tuned_like(&self, other: &Config) -> Config {
        Config { tuning: other.tuning.clone(), files: other.files.clone(), ..self.clone() }
    }

    /// Refuses values for which the model has no meaning; the message names parameter, value and range, and the other
    /// parameter where the range depends on one.
    pub fn validate(&self) -> Result<(), ConfigError> {
        for row in Self::rows() {
            let value = match (row.read)(self) {
                Value::Real(value) => value,
                Value::Integer(value) => f64::from(value),
                _ => continue,
            };
            if row.kind.check(row.name, &(row.read)(self)).is_err() {
                return Err(ConfigError::Range { name: row.name, value, range: row.kind.range() });
            }
        }
        self.check_rows()?;
        sideways::check(self)?;
        dependent::ranges(self).into_iter().try_for_each(Dependent::check)
    }
}
