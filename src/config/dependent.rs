//! Ranges of parameters that depend on other parameters.

use super::choices::ContactShape;
use super::patch_rows::{PatchRows, RowsError};
use super::table::{Config, Initial, Material, Rail};
use super::value::{display_number, display_range};
use crate::analytic;
use crate::patch::EquivalentEllipse;

/// Half-width of the contact that can still be meshed [m].
const SMALLEST_HALF_WIDTH: f64 = 1e-6;
/// Largest half-width relative to the wheel radius and to the length of the rail.
const WHEEL_SHARE: f64 = 0.095;
const RAIL_SHARE: f64 = 0.12;
/// Curvatures of the gap across the direction of rolling over those along it: half axes from 1:20 to 13:1.
pub const CURVATURES: [f64; 2] = [0.01, 50.0];
/// Ratios of half axes of an ellipse that these curvatures allow.
const ASPECTS: [f64; 2] = [0.05, 13.0];
/// Smallest limit of the internal step [s].
const SHORTEST_LIMIT: f64 = 1e-6;
/// Largest way of the wheel during the retardation of stiffness-proportional damping [m].
const LARGEST_RETARDATION: f64 = 0.01;

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
            Self::Rows(_) => "contact.rows",
        }
    }
}

/// A check of one parameter against others: its name, value and unit, the range, and the others with their values.
pub struct Dependent {
    /// Name of the parameter, or what follows from parameters.
    pub(super) name: &'static str,
    pub(super) value: f64,
    pub(super) unit: &'static str,
    pub(super) low: f64,
    pub(super) high: f64,
    /// The others with their values, in words.
    pub(super) others: String,
}

impl Dependent {
    /// Refuses a value outside the range.
    pub fn check(self) -> Result<(), ConfigError> {
        let Self { name, value, unit, low, high, others } = self;
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
    let (Material { youngs_modulus, poissons_ratio, .. }, radius) = (&config.material, config.wheel.radius);
    let stiffness = analytic::contact_modulus(*youngs_modulus, *poissons_ratio);
    let half_widths = [SMALLEST_HALF_WIDTH, longest_half_width(config)];
    let [low, high] = match config.contact.shape {
        ContactShape::Line => {
            half_widths.map(|a| analytic::hertz_load(a, radius, stiffness) * config.model.contact_width)
        }
        ContactShape::Ellipse => half_widths.map(|a| (a / config.hertz().under(1.0).a).powi(3)),
        ContactShape::Rows => return longest_row(config),
    };
    Dependent {
        name: "model.nominal_load",
        value: config.model.nominal_load,
        unit: "N",
        low,
        high,
        others: format!(
            "model.contact_width = {} m, wheel.radius = {} m, rail.length = {} m and material.youngs_modulus = {} Pa \
             (the contact zone fits wheel and rail)",
            display_number(config.model.contact_width),
            display_number(radius),
            display_number(config.rail.length),
            display_number(*youngs_modulus)
        ),
    }
}

/// Largest half-width of a contact for which wheel and rail have room \[m].
fn longest_half_width(config: &Config) -> f64 {
    (WHEEL_SHARE * config.wheel.radius).min(RAIL_SHARE * config.rail.length)
}

/// Rows of a patch for which wheel and rail have room; rows that have not been read are not judged.
fn longest_row(config: &Config) -> Dependent {
    let (radius, length) = (display_number(config.wheel.radius), display_number(config.rail.length));
    let rows = config.patch_rows().ok().flatten();
    let [low, high] = match rows {
        Some(_) => [SMALLEST_HALF_WIDTH, longest_half_width(config)],
        None => [0.0, f64::INFINITY],
    };
    Dependent {
        name: "largest half_length of contact.rows under model.nominal_load",
        value: rows.map_or(0.0, |rows| rows.half_length()),
        unit: "m",
        low,
        high,
        others: format!(
            "model.nominal_load = {} N, contact.rows_load = {} N, wheel.radius = {radius} m and rail.length = {length} m (the \
             contact zone fits wheel and rail)",
            display_number(config.model.nominal_load),
            display_number(config.contact.rows_load)
        ),
    }
}

/// Rows of patches that are neither a line across nor one along the direction of rolling, and no more of them than
/// lines.
fn rows(config: &Config) -> Vec<Dependent> {
    let Ok(Some(PatchRows { shapes, .. })) = config.patch_rows() else { return Vec::new() };
    let lines = config.contact.lines;
    let count = Dependent {
        name: "number of patches in contact.rows",
        value: shapes.len() as f64,
        unit: "",
        low: 1.0,
        high: lines as f64,
        others: format!(
            "contact.lines = {lines} (gaps between rows part patches, and each needs a line of its own: raise contact.lines, or \
             say with the column width that rows touch)"
        ),
    };
    shapes.iter().map(aspect).chain([count]).collect()
}

/// The ratio of the half axes of a patch of rows.
fn aspect(shape: &EquivalentEllipse) -> Dependent {
    Dependent {
        name: "half axes' ratio a/b of contact.rows",
        value: shape.a / shape.b,
        unit: "1",
        low: ASPECTS[0],
        high: ASPECTS[1],
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
    let Initial { velocity, creepage, .. } = config.initial;
    let wave = rayleigh_speed(config);
    let share = wave / velocity.abs();
    let material = format!(
        "material.youngs_modulus = {} Pa and material.density = {} kg/m3, whose surface waves have {} m/s",
        display_number(config.material.youngs_modulus),
        display_number(config.material.density),
        display_number(wave)
    );
    [
        Dependent {
            name: "initial.velocity",
            value: velocity,
            unit: "m/s",
            low: -wave,
            high: wave,
            others: material.clone(),
        },
        Dependent {
            name: "initial.creepage",
            value: creepage.unwrap_or(0.0),
            unit: "1",
            low: if share.is_finite() { 2.0 * (1.0 - share) / (1.0 + share) } else { -2.0 },
            high: f64::INFINITY,
            others: format!("initial.velocity = {} m/s, {material}", display_number(velocity)),
        },
    ]
}

/// Dampers and mass of the track need a spring beside them; under the nominal load it gives by less than the radius of
/// the wheel.
fn track(config: &Config) -> Vec<Dependent> {
    let Rail { support_stiffness, support_damping, support_mass, restraint_stiffness, restraint_damping, .. } =
        config.rail;
    let (radius, load) = (config.wheel.radius, config.model.nominal_load);
    let vertical = ("rail.support_stiffness", support_stiffness);
    let longitudinal = ("rail.restraint_stiffness", restraint_stiffness);
    let springs = |springs: &[(&str, f64)]| {
        let each: Vec<_> = springs.iter().map(|(name, k)| format!("{name} = {} N/m", display_number(*k))).collect();
        each.join(" and ")
    };
    let beside = |name, value, unit, used: &[(&str, f64)]| {
        let high = if used.iter().any(|(_, k)| *k > 0.0) { f64::INFINITY } else { 0.0 };
        Dependent { name, value, unit, low: 0.0, high, others: format!("{} (0: rigid)", springs(used)) }
    };
    let given = |(name, value): (&'static str, f64)| {
        let others = format!(
            "model.nominal_load = {} N and wheel.radius = {} m (or 0: rigid)",
            display_number(load),
            display_number(radius)
        );
        let low = if value > 0.0 { load / radius } else { 0.0 };
        Dependent { name, value, unit: "N/m", low, high: f64::INFINITY, others }
    };
    vec![
        given(vertical),
        given(longitudinal),
        beside("rail.support_damping", support_damping, "N.s/m", &[vertical]),
        beside("rail.restraint_damping", restraint_damping, "N.s/m", &[longitudinal]),
        beside("rail.support_mass", support_mass, "kg", &[vertical, longitudinal]),
    ]
}

/// Stiffness-proportional damping that the stream carries less than a centimetre during the retardation: its part in
/// the stream is lagged, and a stationary state would not be found beyond.
fn retardation(config: &Config) -> Dependent {
    let velocity = config.initial.velocity;
    Dependent {
        name: "damping.rayleigh_stiffness",
        value: config.damping.rayleigh_stiffness,
        unit: "s",
        low: 0.0,
        high: LARGEST_RETARDATION / velocity.abs(),
        others: format!("initial.velocity = {} m/s", display_number(velocity)),
    }
}

/// The wheel starts above absolute zero, and where steel melts no hotter than the liquidus.
fn start_temperature(config: &Config) -> Dependent {
    let (reference, material) = (config.thermal.reference, &config.material);
    let melts = material.latent_heat > 0.0 && reference < material.solidus;
    let liquidus = display_number(material.liquidus);
    let hottest = if melts { format!(" and of at most material.liquidus = {liquidus} K") } else { String::new() };
    Dependent {
        name: "thermal.wheel_excess",
        value: config.thermal.wheel_excess,
        unit: "K",
        low: 1.0 - reference,
        high: if melts { material.liquidus - reference } else { f64::INFINITY },
        others: format!(
            "thermal.reference = {} K (the wheel starts above absolute zero{hottest})",
            display_number(reference)
        ),
    }
}

/// Internal steps are not too short to be computed, or chosen by the profiles.
fn internal_step(config: &Config) -> Dependent {
    let value = config.tuning.max_step;
    let (low, high) = if value > 0.0 { (SHORTEST_LIMIT, f64::INFINITY) } else { (0.0, 0.0) };
    let others = "0 as the choice by wheel.profile and rail.profile".to_owned();
    Dependent { name: "solver.max_step", value, unit: "s", low, high, others }
}

/// Melting takes place within a range of temperatures.
fn melting_range(config: &Config) -> Dependent {
    let solidus = config.material.solidus;
    Dependent {
        name: "material.liquidus",
        value: config.material.liquidus,
        unit: "K",
        low: solidus + 10.0,
        high: f64::INFINITY,
        others: format!("material.solidus = {} K", display_number(solidus)),
    }
}

/// Catastrophic wear begins beyond severe wear.
fn wear_regimes(config: &Config) -> Dependent {
    let from = config.damage.wear_severe_from;
    Dependent {
        name: "damage.wear_catastrophic_from",
        value: config.damage.wear_catastrophic_from,
        unit: "Pa",
        low: from,
        high: f64::INFINITY,
        others: format!("damage.wear_severe_from = {} Pa", display_number(from)),
    }
}

/// Worn surfaces are no smooth patch.
fn wear_contact(config: &Config) -> Dependent {
    let number = |on: bool| if on { 2.0 } else { 1.0 };
    let (value, high) = (number(config.damage.wear.is_on()), number(!config.solver.contact.requires_patch()));
    let others = "solver.contact = patch, on smooth surfaces only (1: off, 2: t_gamma)".to_owned();
    Dependent { name: "damage.wear", value, unit: "", low: 1.0, high, others }
}

/// Curvatures across the direction of rolling with which wheel and rail touch in an ellipse that is no line.
fn ellipse(config: &Config) -> Dependent {
    let radius = config.wheel.radius;
    let [low, high] = match config.contact.shape {
        ContactShape::Line | ContactShape::Rows => [f64::NEG_INFINITY, f64::INFINITY],
        ContactShape::Ellipse => CURVATURES.map(|c| c / radius),
    };
    Dependent {
        name: "1/contact.wheel_lateral_radius + 1/contact.rail_lateral_radius",
        value: config.lateral_curvature(),
        unit: "1/m",
        low,
        high,
        others: format!(
            "contact.shape = ellipse and wheel.radius = {} m (wheel and rail touch in a patch between a line across and a line along \
             the direction of rolling; raise or lower contact.rail_lateral_radius)",
            display_number(radius)
        ),
    }
}

/// Every range that depends on other parameters, with the present value in it.
pub fn ranges(config: &Config) -> Vec<Dependent> {
    let (radius, infinity) = (config.wheel.radius, f64::INFINITY);
    let with_radius = || format!("wheel.radius = {} m", display_number(radius));
    let [velocity, creepage] = subsonic(config);
    let mut all = vec![
        Dependent {
            name: "wheel.hub_radius",
            value: config.wheel.hub_radius,
            unit: "m",
            low: 0.02 * radius,
            high: 0.9 * radius,
            others: with_radius(),
        },
        Dependent {
            name: "rail.length",
            value: config.rail.length,
            unit: "m",
            low: 0.2 * radius,
            high: infinity,
            others: with_radius(),
        },
        Dependent {
            name: "rail.height",
            value: config.rail.height,
            unit: "m",
            low: 0.02 * radius,
            high: infinity,
            others: with_radius(),
        },
        ellipse(config),
        start_temperature(config),
        melting_range(config),
        wear_regimes(config),
        wear_contact(config),
        internal_step(config),
        velocity,
        creepage,
        contact_zone(config),
        retardation(config),
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
        refused(
            |c| (c.initial.velocity, c.damping.rayleigh_stiffness) = (150.0, 1e-4),
            &["damping.rayleigh_stiffness = 0.0001", "6.66667e-5 s with initial.velocity = 150 m/s"],
        );
    }
}
