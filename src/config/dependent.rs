//! Ranges of parameters that depend on other parameters.

use super::choices::ContactShape;
use super::patch_rows::{PatchTable, RowsError};
use super::table::{Config, Material};
use crate::analytic;
use crate::display::{display_number, display_range};
use crate::patch::EquivalentEllipse;

/// Half-width of the contact that can still be meshed [m].
const SMALLEST_HALF_WIDTH: f64 = 1e-6;
/// Largest half-width relative to the wheel radius and to the length of the rail.
const WHEEL_SHARE: f64 = 0.095;
const RAIL_SHARE: f64 = 0.12;
/// Curvatures of the gap across the direction of rolling over those along it: half axes from 1:20 to 13:1.
pub const CURVATURES: [f64; 2] = [0.01, 50.0];
/// Ratios of half axes of an ellipse that these curvatures allow.
const ASPECTS: [f64; 2] = [0.05, 25.0];
/// Smallest limit of the internal step [s].
const SHORTEST_LIMIT: f64 = 1e-6;

/// A parameter without meaning.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ConfigError {
    /// A number outside its range.
    #[error("{name} = {} is outside its range: {range}", display_number(*value))]
    Range {
        /// Name of the parameter, or what follows from parameters.
        name: &'static str,
        /// Its value.
        value: f64,
        /// Allowed range in words, and the other parameters that it depends on.
        range: String,
    },
    /// Parameters that do not go with a contact of two directions.
    #[error("contact.lateral = true does not go with {other}: set {remedy}, or contact.lateral = false")]
    Lateral {
        /// The other parameter with its value.
        other: &'static str,
        /// Parameter that has to be set, and the value.
        remedy: &'static str,
    },
    /// A wheelset whose wheel has no lateral direction.
    #[error(
        "wheelset.side does not go with contact.lateral = false: set contact.lateral = true with contact.shape = ellipse or rows, or \
         wheelset.side = none"
    )]
    NotSideways,
    /// Rows that are no patch.
    #[error(transparent)]
    Rows(#[from] RowsError),
}

impl ConfigError {
    /// Name of the parameter, or what follows from parameters.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Range { name, .. } => name,
            Self::Lateral { .. } => "contact.lateral",
            Self::NotSideways => "wheelset.side",
            Self::Rows(_) => "contact.rows",
        }
    }
}

/// A check of one parameter, or of what follows from parameters, against others.
pub struct Dependent {
    name: &'static str,
    value: f64,
    unit: &'static str,
    range: [f64; 2],
    /// The others with their values, in words.
    others: String,
}

impl Dependent {
    /// The parameter `name` against others.
    pub fn of(config: &Config, name: &'static str, range: [f64; 2], others: String) -> Self {
        let (value, unit) = config.number(name);
        Self { name, value, unit, range, others }
    }

    /// Refuses a value outside the range.
    pub fn check(self) -> Result<(), ConfigError> {
        let Self { name, value, unit, range: [low, high], others } = self;
        if value >= low && value <= high {
            return Ok(());
        }
        let range = display_range([low, high], unit);
        Err(ConfigError::Range { name, value, range: format!("{range} with {others}") })
    }
}

/// Speed of surface waves [m/s].
fn rayleigh_speed(config: &Config) -> f64 {
    let Material { youngs_modulus, poissons_ratio, density, .. } = config.material;
    let shear_wave_speed = (0.5 * youngs_modulus / ((1.0 + poissons_ratio) * density)).sqrt();
    analytic::rayleigh_speed(shear_wave_speed, poissons_ratio)
}

/// Loads for which the contact zone can be meshed and fits wheel and rail.
fn contact_zone(config: &Config) -> Dependent {
    let (material, radius) = (&config.material, config.wheel.radius);
    let stiffness = analytic::contact_modulus(material.youngs_modulus, material.poissons_ratio);
    let half_widths = [SMALLEST_HALF_WIDTH, longest_half_width(config)];
    let range = match config.contact.shape {
        ContactShape::Line => {
            half_widths.map(|a| analytic::hertz_load(a, radius, stiffness) * config.model.contact_width)
        }
        ContactShape::Ellipse => half_widths.map(|a| (a / config.hertz().under(1.0).a).powi(3)),
        ContactShape::Rows => return longest_row(config),
    };
    let others = "{model.contact_width}, {wheel.radius}, {rail.length} and {material.youngs_modulus} (the contact zone fits \
                  wheel and rail)";
    Dependent::of(config, "model.nominal_load", range, config.told(others))
}

/// Largest half-width of a contact for which wheel and rail have room \[m].
fn longest_half_width(config: &Config) -> f64 {
    (WHEEL_SHARE * config.wheel.radius).min(RAIL_SHARE * config.rail.length)
}

/// Rows of a patch for which wheel and rail have room; rows that have not been read are not judged.
fn longest_row(config: &Config) -> Dependent {
    let table = config.patch_table().ok().flatten();
    let longest =
        |table: &PatchTable| table.patches.iter().fold(0.0, |longest: f64, rows| longest.max(rows.half_length()));
    Dependent {
        name: "largest half_length of contact.rows under model.nominal_load",
        range: if table.is_some() { [SMALLEST_HALF_WIDTH, longest_half_width(config)] } else { ANY },
        value: table.as_ref().map_or(0.0, longest),
        unit: "m",
        others: config.told(
            "{model.nominal_load}, {contact.rows_load}, {wheel.radius} and {rail.length} (the contact zone fits wheel and rail)",
        ),
    }
}

/// Rows of patches that are neither a line across nor one along the direction of rolling, and no more of them than
/// lines.
fn rows(config: &Config) -> Vec<Dependent> {
    let Ok(Some(PatchTable { patches, .. })) = config.patch_table() else { return Vec::new() };
    let shapes: Vec<_> = patches.iter().flat_map(|rows| &rows.shapes).collect();
    let most = patches.iter().map(|rows| rows.shapes.len()).max().unwrap_or(0);
    let lines = config.contact.lines;
    let count = Dependent {
        name: "number of patches in contact.rows",
        value: most as f64,
        unit: "1",
        range: [1.0, lines as f64],
        others: format!(
            "contact.lines = {lines} (gaps between rows part patches, and each needs a line of its own: raise contact.lines, or \
             say with the column width that rows touch)"
        ),
    };
    // Where a patch moves, its lines are its rows.
    let rows = patches.first().filter(|_| patches.len() > 1).map_or(1, |rows| rows.rows.len());
    let moving = Dependent {
        name: "number of rows of every shift in contact.rows",
        value: rows as f64,
        unit: "1",
        range: [1.0, lines as f64],
        others: format!("contact.lines = {lines} (raise contact.lines to it, or make a table of fewer rows)"),
    };
    shapes.into_iter().map(aspect).chain([count, moving]).collect()
}

/// The ratio of the half axes of a patch of rows.
fn aspect(shape: &EquivalentEllipse) -> Dependent {
    Dependent {
        name: "half axes' ratio a/b of contact.rows",
        value: shape.a / shape.b,
        unit: "1",
        range: ASPECTS,
        others: format!(
            "the ellipse a = {} m along and b = {} m across the direction of rolling that has the second moments of area \
             of a patch of rows",
            display_number(shape.a),
            display_number(shape.b)
        ),
    }
}

/// Initial motions slower than the surface waves: |V| < c and |V| (1 − ξ/2)/(1 + ξ/2) < c. Equality is left to the
/// model.
fn subsonic(config: &Config) -> [Dependent; 2] {
    let wave = rayleigh_speed(config);
    let share = wave / config.initial.velocity.abs();
    let least = if share.is_finite() { 2.0 * (1.0 - share) / (1.0 + share) } else { -2.0 };
    let material = config.told("{material.youngs_modulus} and {material.density}, whose surface waves have ");
    let material = format!("{material}{} m/s", display_number(wave));
    let with_velocity = config.told("{initial.velocity}, ") + &material;
    [
        Dependent::of(config, "initial.velocity", [-wave, wave], material),
        Dependent::of(config, "initial.creepage", at_least(least), with_velocity),
    ]
}

/// Dampers and masses need a spring beside them, `springs`.
fn beside(config: &Config, name: &'static str, springs: &[&str], most: f64) -> Dependent {
    let high = if springs.iter().any(|spring| config.number(spring).0 > 0.0) { most } else { 0.0 };
    let given: Vec<_> = springs.iter().map(|spring| config.given(spring)).collect();
    Dependent::of(config, name, [0.0, high], format!("{} (0: rigid)", given.join(" and ")))
}

/// Dampers and mass of the track need a spring beside them; under the nominal load it gives by less than the radius of
/// the wheel.
fn track(config: &Config) -> Vec<Dependent> {
    const SPRINGS: [&str; 2] = ["rail.support_stiffness", "rail.restraint_stiffness"];
    let given = |name| {
        let least = config.model.nominal_load / config.wheel.radius;
        let others = config.told("{model.nominal_load} and {wheel.radius} (or 0: rigid)");
        Dependent::of(config, name, at_least(if config.number(name).0 > 0.0 { least } else { 0.0 }), others)
    };
    vec![
        given(SPRINGS[0]),
        given(SPRINGS[1]),
        beside(config, "rail.support_damping", &SPRINGS[..1], f64::INFINITY),
        beside(config, "rail.restraint_damping", &SPRINGS[1..], f64::INFINITY),
        beside(config, "rail.support_mass", &SPRINGS, f64::INFINITY),
    ]
}

/// The wheel starts above absolute zero, and where steel melts no hotter than the liquidus.
fn start_temperature(config: &Config) -> Dependent {
    let (reference, material) = (config.thermal.reference, &config.material);
    let (highest, hottest) = match material.latent_heat > 0.0 && reference < material.solidus {
        true => (material.liquidus - reference, " and of at most {material.liquidus}"),
        false => (f64::INFINITY, ""),
    };
    let others = ["{thermal.reference} (the wheel starts above absolute zero", hottest, ")"].concat();
    Dependent::of(config, "thermal.wheel_excess", [1.0 - reference, highest], config.told(&others))
}

/// Internal steps are not too short to be computed, or chosen by the profiles.
fn internal_step(config: &Config) -> Dependent {
    let range = if config.tuning.max_step > 0.0 { at_least(SHORTEST_LIMIT) } else { [0.0; 2] };
    Dependent::of(config, "solver.max_step", range, "0 as the choice by wheel.profile and rail.profile".to_owned())
}

/// Curvatures across the direction of rolling with which wheel and rail touch in an ellipse that is no line.
fn ellipse(config: &Config) -> Dependent {
    Dependent {
        name: "1/contact.wheel_lateral_radius + 1/contact.rail_lateral_radius",
        value: config.lateral_curvature(),
        unit: "1/m",
        range: match config.contact.shape {
            ContactShape::Line | ContactShape::Rows => ANY,
            ContactShape::Ellipse => CURVATURES.map(|c| c / config.wheel.radius),
        },
        others: config.told(
            "contact.shape = ellipse and {wheel.radius} (wheel and rail touch in a patch between a line across and a line along \
             the direction of rolling; raise or lower contact.rail_lateral_radius)",
        ),
    }
}

/// No limits.
const ANY: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

fn at_least(low: f64) -> [f64; 2] {
    [low, f64::INFINITY]
}

/// Every range that depends on other parameters, with the present value in it.
pub fn ranges(config: &Config) -> Vec<Dependent> {
    let radius = config.wheel.radius;
    let simple = |name, range, other| Dependent::of(config, name, range, config.given(other));
    let [velocity, creepage] = subsonic(config);
    let mut all = vec![
        simple("wheel.hub_radius", [0.02 * radius, 0.9 * radius], "wheel.radius"),
        simple("rail.length", at_least(0.2 * radius), "wheel.radius"),
        simple("rail.height", at_least(0.02 * radius), "wheel.radius"),
        ellipse(config),
        start_temperature(config),
        // Melting takes place within a range of temperatures.
        simple("material.liquidus", at_least(config.material.solidus + 10.0), "material.solidus"),
        internal_step(config),
        velocity,
        creepage,
        contact_zone(config),
    ];
    all.extend(track(config));
    all.extend(rows(config));
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(change: impl Fn(&mut Config), words: &[&str]) {
        let mut config = Config::default();
        change(&mut config);
        let message = config.validate().unwrap_err().to_string();
        assert!(words.iter().all(|word| message.contains(word)), "{message}");
    }

    #[test]
    fn the_default_is_valid() {
        assert_eq!(Config::default().validate(), Ok(()));
    }

    #[test]
    fn ranges_that_depend_on_another_parameter_name_both_values_and_the_range() {
        refused(
            |c| (c.wheel.radius, c.wheel.hub_radius) = (1.0, 0.01),
            &["wheel.hub_radius = 0.01 ", "0.02 to 0.9 m with wheel.radius = 1 m"],
        );
        refused(
            |c| c.wheel.radius = 0.05,
            &["wheel.hub_radius = 0.046 ", "0.001 to 0.045 m with wheel.radius = 0.05 m"],
        );
        refused(
            |c| (c.wheel.radius, c.rail.length) = (2.0, 0.2),
            &["rail.length = 0.2 ", "at least 0.4 m with wheel.radius = 2 m"],
        );
        refused(
            |c| (c.wheel.radius, c.rail.height) = (2.0, 0.03),
            &["rail.height = 0.03 ", "at least 0.04 m with wheel.radius = 2 m"],
        );
        refused(
            |c| (c.thermal.reference, c.thermal.wheel_excess) = (100.0, -150.0),
            &["thermal.wheel_excess = -150 ", "-99 to 1703 K with thermal.reference = 100 K"],
        );
        refused(
            |c| (c.initial.velocity, c.initial.creepage, c.material.youngs_modulus) = (200.0, Some(-1.0), 5e9),
            &[
                "initial.creepage = -1 ",
                "at least -0.78",
                "with initial.velocity = 200 m/s",
                "459.164 m/s",
                "youngs_modulus",
            ],
        );
        refused(
            |c| c.material.youngs_modulus = 1e5,
            &["initial.velocity = 27.7778 ", "-2.05344 to 2.05344 m/s with material.youngs_modulus = 100000 Pa"],
        );
        refused(
            |c| (c.model.contact_width, c.model.nominal_load) = (2e-3, 2e6),
            &[
                "model.nominal_load = 2e6 ",
                " N with model.contact_width = 0.002 m",
                "wheel.radius",
                "rail.length = 1 m",
            ],
        );
        refused(|c| c.tuning.max_step = 5e-7, &["solver.max_step = 5e-7 ", "at least 1e-6 s with 0 as the choice"]);
        refused(|c| c.initial.creepage = Some(f64::NAN), &["initial.creepage = NaN", "-1.99 to 2"]);
    }
}
