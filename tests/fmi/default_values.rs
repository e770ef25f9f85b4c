//! Default values of steel, friction, heat, damping and damage, and those of the presets, beside the sources that they
//! are from. Every value that differs is told by its name; a parameter of these groups without a source is refused.
//!
//! Values that are published as a formula are computed from it; standards are quoted from memory. A value called *chosen* has no
//! source but the page that says so.

use crate::common::shipped;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};
use wheelrail::config::value::Value;
use wheelrail::config::{Config, Tuning};
use wheelrail::contact::FrictionLaw;
use wheelrail::surface::WearLaw;

/// Part of a value by which a rounded default may differ from the formula of its source.
const ROUNDED: f64 = 0.005;
const EXACT: f64 = 1e-12;

/// Name of a parameter, its value, the part by which the default may differ, source.
type Sourced = (&'static str, f64, f64, &'static str);

/// 0 °C \[K].
const ICE: f64 = 273.15;

/// Conductivity of steel at `t` \[°C], EN 1993-1-2:2005, 3.4.1.3 [W/(m K)].
fn conductivity(t: f64) -> f64 {
    54.0 - 3.33e-2 * t
}

/// Specific heat of steel at `t` \[°C], EN 1993-1-2:2005, 3.4.1.2 [J/(kg K)].
fn specific_heat(t: f64) -> f64 {
    425.0 + t * (0.773 + t * (-1.69e-3 + t * 2.22e-6))
}

/// Ac1 and Ms of a steel with parts of C, Mn, Cr, Si \[%] by Andrews' formulas (*J. Iron Steel Inst.* 203 (1965)) \[K].
fn andrews([c, mn, cr, si]: [f64; 4]) -> [f64; 2] {
    let ac1 = 723.0 - 10.7 * mn + 29.1 * si + 16.9 * cr;
    let ms = 539.0 - 423.0 * c - 30.4 * mn - 12.1 * cr;
    [ac1 + ICE, ms + ICE]
}

fn steel() -> Vec<Sourced> {
    let limits = "chosen: docs/theory/limits-of-steel.md, section 8";
    vec![
        ("material.youngs_modulus", 210e9, EXACT, "EN 1993-1-1:2005, 3.2.6"),
        ("material.poissons_ratio", 0.3, EXACT, "EN 1993-1-1:2005, 3.2.6"),
        ("material.expansion", 12e-6, EXACT, "EN 1993-1-1:2005, 3.2.6, up to 100 degC"),
        ("material.density", 7850.0, EXACT, "EN 1993-1-2:2005, 3.2.2"),
        ("material.conductivity", conductivity(120.0), ROUNDED, "EN 1993-1-2:2005, 3.4.1.3, at 120 degC"),
        ("material.specific_heat", specific_heat(67.0), ROUNDED, "EN 1993-1-2:2005, 3.4.1.2, at 67 degC"),
        ("material.yield_strength", 550e6, EXACT, limits),
        ("material.solidus", 1450.0 + ICE, ROUNDED, limits),
        ("material.liquidus", 1530.0 + ICE, ROUNDED, limits),
        ("material.latent_heat", 270e3, EXACT, limits),
        ("material.film_friction", 0.02, EXACT, limits),
    ]
}

fn damping() -> Vec<Sourced> {
    let source = "D. J. Thompson for axial modes, or chosen: docs/theory/damping.md, section 2";
    vec![
        ("damping.wheel_torsion", 1e-2, EXACT, source),
        ("damping.wheel_radial", 1e-3, EXACT, source),
        ("damping.wheel_one_diameter", 1e-2, EXACT, source),
        ("damping.wheel_more_diameters", 1e-4, EXACT, source),
        ("damping.rail", 1e-2, EXACT, source),
    ]
}

fn friction() -> Vec<Sourced> {
    vec![
        ("friction.coefficient", 0.3, EXACT, "wet rail of Polach's table, Wear 258 (2005)"),
        ("friction.falling_ratio", 1.0, EXACT, "no fall with the slip"),
        ("friction.softening", 1e-3, EXACT, "chosen: Galton's locked wheels, docs/published.md"),
        ("friction.softening_floor", 0.1, EXACT, "chosen with it"),
    ]
}

fn heat() -> Vec<Sourced> {
    let section = "chosen: docs/theory/width-of-conduction.md, section 4";
    vec![
        ("thermal.reference", 20.0 + ICE, ROUNDED, "20 degC"),
        (
            "thermal.conductance",
            1e8,
            EXACT,
            "chosen: ten times that from which contact is perfect, docs/thesis.md, B 15",
        ),
        ("thermal.heat_ratio", 1.0, EXACT, "all work of friction is heat"),
        ("thermal.max_speed", 60.0, EXACT, "chosen: layers for 216 km/h"),
        ("thermal.smallest_load_ratio", 0.5, EXACT, "chosen: layers for half of the load"),
        ("thermal.tread_angle", FRAC_PI_2, EXACT, "blocks at the height of the axle"),
        ("thermal.tread_width", FRAC_PI_4, EXACT, "chosen: an eighth of the tread"),
        ("thermal.rim_width", 0.135, EXACT, "common wheels, docs/theory/width-of-conduction.md, section 4"),
        ("thermal.rim_depth", 0.06, EXACT, section),
        ("thermal.web_width", 0.025, EXACT, section),
        ("thermal.boss_radius", 0.13, EXACT, section),
        ("thermal.head_width", 0.072, EXACT, "head of the rail 60E1, EN 13674-1"),
        ("thermal.block_width", 0.08, EXACT, section),
    ]
}

fn damage() -> Vec<Sourced> {
    let history = "chosen: docs/theory/material-history.md, section 3";
    let [ac1, ms] = andrews([0.50, 0.75, 0.25, 0.35]);
    vec![
        ("thermal.austenitisation", ac1, ROUNDED, "Andrews' formula, docs/theory/material-history.md"),
        ("damage.martensite_start", ms, ROUNDED, "Andrews' formula, docs/theory/material-history.md"),
        ("damage.critical_cooling", 50.0, EXACT, history),
        ("damage.threshold", 300.0, EXACT, history),
        ("damage.resolution", 1.0, EXACT, "the usual size"),
        ("damage.wear_factor", 1.0, EXACT, "the source itself"),
    ]
}

/// Numeric parameters that are not zero, by name.
fn numbers(config: &Config) -> impl Iterator<Item = (&'static str, f64)> {
    Config::rows().iter().filter_map(|row| match (row.read)(config) {
        Value::Real(value) if value != 0.0 => Some((row.name, value)),
        _ => None,
    })
}

/// Parameters that are not what their sources say, in words.
fn wrong(config: &Config, sources: &[Sourced]) -> Vec<String> {
    let told = |&(name, expected, part, source): &Sourced| {
        let value = numbers(config).find(|(row, _)| *row == name).map_or(0.0, |(_, value)| value);
        let right = (value / expected - 1.0).abs() <= part;
        (!right).then(|| format!("{name} = {value}, but {expected}: {source}"))
    };
    sources.iter().filter_map(told).collect()
}

#[test]
fn defaults_of_steel_friction_heat_damping_and_damage_are_those_of_their_sources() {
    let sources = [steel(), damping(), friction(), heat(), damage()].concat();
    let wrong = wrong(&Config::default(), &sources);
    println!("{} values", sources.len());
    assert!(wrong.is_empty(), "{wrong:#?}");
    let groups = ["material.", "damping.", "friction.", "thermal.", "damage."];
    let config = Config::default();
    let known = |name: &str| sources.iter().any(|source| source.0 == name);
    let unknown: Vec<_> = numbers(&config)
        .map(|(name, _)| name)
        .filter(|name| groups.iter().any(|group| name.starts_with(group)) && !known(name))
        .collect();
    assert!(unknown.is_empty(), "say where these are from: {unknown:?}");
}

/// Numbers of Braghin, Lewis, Dwyer-Joyce, Bruni, *Wear* 261 (2006) 1253–1264. The regimes join: what is severe begins where mild
/// wear has grown to it, within the digits of the source.
#[test]
fn wear_has_the_numbers_of_its_source_and_mild_wear_has_grown_to_severe_wear_where_that_begins() {
    let law = WearLaw::r8t().scaled(Config::default().damage.wear_factor);
    assert_eq!([law.mild, law.severe, law.catastrophic], [5.3e-9, 55e-3, 61.9e-9]);
    assert_eq!([law.severe_from, law.catastrophic_from], [10.4e6, 77.2e6]);
    let grown = law.mild * law.severe_from / law.severe;
    println!("{grown:.4} of it");
    assert!((grown - 1.0).abs() < 5e-3);
}

/// Values that no parameter sets.
#[test]
fn values_that_are_no_parameters_are_those_of_their_pages() {
    let Config { thermal, physics, solver, .. } = Config::default();
    assert_eq!((thermal.wheel_share, physics.centrifugal), (0.5, true));
    assert_eq!((solver.modes_wheel, solver.modes_rail), (80, 40));
    // The boss of docs/theory/width-of-conduction.md, section 4.
    assert!((thermal.rim_width * thermal.boss - 0.17).abs() < 1e-12);
}

/// Friction that falls with the slip follows its law over the 25 µm of the presets where none are given
/// (`docs/theory/friction-and-coupling.md`).
#[test]
fn falling_friction_without_a_memory_of_its_own_has_that_of_the_presets() {
    let falling = Tuning { falling_ratio: 0.4, falling_decay: 0.6, ..Tuning::default() };
    assert!((FrictionLaw::from(&falling).memory_length / 25e-6 - 1.0).abs() < EXACT);
    assert_eq!(FrictionLaw::from(&Tuning::default()).memory_length, 0.0);
    let own = Tuning { memory_length: 4e-5, ..falling };
    assert_eq!(FrictionLaw::from(&own).memory_length, 4e-5);
}

/// Masses, springs and widths that stand for the rest of a vehicle and its track.
#[test]
fn defaults_of_vehicle_track_and_wheel_are_those_of_their_pages() {
    let track = "2 sqrt(k' EA) with 4e7 N/m2 and 1.6e9 N, rounded: docs/theory/track-support.md, section 4";
    let wrong = wrong(
        &Config::default(),
        &[
            ("model.contact_width", 0.014, EXACT, "chosen: docs/theory/equivalent-width.md, section 5"),
            ("model.structural_width", 0.073, EXACT, "docs/theory/structural-width.md"),
            ("contact.rail_lateral_radius", 0.3, EXACT, "head of the rail 60E1, EN 13674-1"),
            ("vehicle.damping", 20e3, EXACT, "chosen: primary dampers have 10 to 30 kN s/m, docs/theory/damping.md"),
            ("rail.restraint_stiffness", 4e8, EXACT, track),
            ("rail.restraint_damping", 1e6, EXACT, "loss factor of .23 while a stopped wheel rocks, same page"),
        ],
    );
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// Each wrong value of a preset is told as `preset/parameter`.
#[test]
fn presets_have_the_friction_of_polachs_table_and_the_steel_of_the_thesis() {
    let polach = "O. Polach, Wear 258 (2005) 992-1000";
    let low = "EN 15595: brake tests on soapy rail have .05 to .08";
    let memory = "chosen: docs/theory/friction-and-coupling.md";
    let falling = |[coefficient, ratio, decay]: [f64; 3], source: &'static str| -> Vec<Sourced> {
        vec![
            ("friction.coefficient", coefficient, EXACT, source),
            ("friction.falling_ratio", ratio, EXACT, source),
            ("friction.falling_decay", decay, EXACT, source),
            ("friction.memory_length", 25e-6, EXACT, memory),
        ]
    };
    let thesis = "A. Draganis, thesis, papers A to D";
    let paper = |friction: f64| -> Vec<Sourced> {
        let values = [
            ("material.youngs_modulus", 200e9),
            ("material.density", 8000.0),
            ("material.expansion", 4.8e-6),
            ("material.conductivity", 45.0),
            ("material.specific_heat", 460.0),
            ("friction.softening_floor", 0.2),
            ("thermal.conductance", 1e7),
            ("thermal.heat_ratio", 0.1),
        ];
        let mut paper: Vec<_> = values.map(|(name, value)| (name, value, EXACT, thesis)).into();
        if friction > 0.0 {
            paper.push(("friction.coefficient", friction, EXACT, thesis));
        }
        paper
    };
    let hub = "docs/theory/structural-width.md, section 4";
    let bodies: [Sourced; 3] = [
        ("wheel.hub_radius", 0.067, EXACT, hub),
        ("wheel.hub_mass", 277.0, EXACT, hub),
        ("wheel.hub_inertia", 4.7, EXACT, hub),
    ];
    let presets = [
        ("railway_dry", falling([0.55, 0.40, 0.60], polach)),
        ("railway_wet", falling([0.30, 0.40, 0.20], polach)),
        ("railway_low_adhesion", falling([0.08, 0.05 / 0.08, 0.20], low)),
        ("paper_a", paper(0.0)),
        ("paper_b", paper(0.0)),
        ("paper_c", paper(0.4)),
        ("paper_d", paper(0.4)),
        ("railway_ellipse", bodies.into()),
        ("railway_s1002_0mm", bodies.into()),
        ("railway_s1002_3mm", bodies.into()),
    ];
    let told = |(name, sources): &(&str, Vec<Sourced>)| -> Vec<String> {
        wrong(&shipped(name), sources).into_iter().map(|wrong| format!("{name}/{wrong}")).collect()
    };
    let wrong: Vec<String> = presets.iter().flat_map(told).collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
}
