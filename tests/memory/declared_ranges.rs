//! Declared ranges are accepted ranges: a model starts and steps with every parameter at each end of its range, alone
//! or, where the refusal names another parameter, together with that.

use crate::common;
use crate::heap;
use rayon::prelude::*;
use std::path::Path;
use wheelrail::config::value::{Kind, Value};
use wheelrail::config::{Config, presets};
use wheelrail::simulation::{BasisStore, Inputs, Model, Simulation};

const PRESETS: [&str; 12] = [
    "railway",
    "paper_a",
    "paper_b",
    "paper_c",
    "paper_d",
    "railway_damage",
    "railway_dry",
    "railway_wet",
    "railway_ellipse",
    "railway_s1002_0mm",
    "railway_s1002_3mm",
    "railway_low_adhesion",
];

/// A preset on the coarsest mesh with fewer modes.
fn coarse(name: &str) -> Config {
    let mut config = common::preset(name, 4);
    (config.solver.modes_wheel, config.solver.modes_rail) = (12, 20);
    // In short steps the rail under a wheel of 5000 K cools below absolute zero.
    config.tuning.tolerance = 0.0;
    config
}

/// The configuration with each parameter at each end of its range, with name and value.
fn ends(config: &Config) -> Vec<(&'static str, f64, Config)> {
    let mut found = Vec::new();
    for row in Config::rows() {
        let ends = match row.kind {
            Kind::Real { min, max, .. } => [min, max].map(Value::Real),
            Kind::Integer { min, max } => [min, max].map(Value::Integer),
            _ => continue,
        };
        for value in ends {
            let mut changed = config.clone();
            (row.write)(&mut changed, &value);
            assert_eq!((row.read)(&changed), value);
            let number = match value {
                Value::Real(number) => number,
                Value::Integer(number) => f64::from(number),
                _ => unreachable!("numeric rows only"),
            };
            found.push((row.name, number, changed));
        }
    }
    found
}

/// Start and two steps of free rolling.
fn rolls(config: &Config) -> Result<(), String> {
    let model = Model::prepare(config.clone(), &common::store(), &mut |_, _| {}).map_err(|error| error.to_string())?;
    let inputs = Inputs::rolling(config);
    let mut simulation = Simulation::new(model, &inputs).map_err(|error| error.to_string())?;
    (0..2).try_for_each(|_| simulation.advance(&inputs, 1e-3)).map_err(|error| error.to_string())
}

/// Refusals of values whose message does not name the changed parameter together with another one.
fn unexplained(name: &str, value: f64, config: &Config) -> Option<String> {
    let error = config.validate().err()?;
    let text = error.to_string();
    let others = Config::rows().iter().filter(|row| row.name != name && text.contains(row.name)).count();
    (!text.contains(name) || others == 0).then(|| format!("{name} = {value}: {text}"))
}

#[test]
fn the_default_rolls_with_every_parameter_at_each_end_of_its_range_or_names_the_other_parameter() {
    common::model(coarse("railway"));
    let wrong = ends(&coarse("railway")).into_par_iter().filter_map(|(name, value, config)| match config.validate() {
        Ok(()) => rolls(&config).err().map(|why| format!("{name} = {value}: {why}")),
        Err(_) => unexplained(name, value, &config),
    });
    let wrong: Vec<String> = wrong.collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The railway wheel at another size: lengths and, at equal pressure, loads and masses follow the radius.
fn scaled(radius: f64) -> Config {
    let mut config = coarse("railway");
    let scale = radius / config.wheel.radius;
    config.wheel.radius = radius;
    config.wheel.hub_radius *= scale;
    (config.rail.length, config.rail.height) = (scale * config.rail.length, scale * config.rail.height);
    config.model.contact_width *= scale;
    config.model.nominal_load *= scale.powi(2);
    config.wheel.hub_mass = (config.wheel.hub_mass * scale.powi(3)).min(1e6);
    config.wheel.hub_inertia = (config.wheel.hub_inertia * scale.powi(5)).min(1e6);
    config.vehicle.mass *= scale.powi(3);
    config
}

/// A range that depends on another parameter is used to its ends: the radius from a laboratory disc to a big wheel.
#[test]
fn wheels_of_every_size_roll() {
    let rows = Config::rows();
    let kind = rows.iter().find(|row| row.name == "wheel.radius").unwrap().kind;
    let Kind::Real { min, max, .. } = kind else { unreachable!("a length") };
    for radius in [min, 0.0235, 0.1, 2.0, max] {
        assert_eq!(rolls(&scaled(radius)), Ok(()), "wheel.radius = {radius}");
    }
    // Discs of 47 mm on each other, as tribology laboratories have them, with a thin shaft.
    let mut disc = scaled(0.0235);
    (disc.wheel.hub_radius, disc.model.contact_width, disc.initial.velocity) = (0.005, 0.01, 1.0);
    disc.model.nominal_load = 7e3;
    assert_eq!(rolls(&disc), Ok(()));
}

/// Soft and hard materials under loads that press the same patch.
#[test]
fn materials_at_both_ends_of_the_stiffness_roll() {
    for (modulus, velocity) in [(1e5, 0.1), (1e13, 27.0)] {
        let mut config = coarse("railway");
        config.model.nominal_load *= modulus / config.material.youngs_modulus;
        let strength = config.material.yield_strength * modulus / config.material.youngs_modulus;
        config.material.yield_strength = strength.max(1e5);
        (config.material.youngs_modulus, config.initial.velocity) = (modulus, velocity);
        assert_eq!(rolls(&config), Ok(()), "material.youngs_modulus = {modulus}");
    }
}

/// Other presets may meet a range that depends on another parameter; the refusal then names both.
#[test]
fn every_preset_accepts_the_ends_of_ranges_or_names_the_other_parameter() {
    let mut wrong = Vec::new();
    for preset in &PRESETS[1..] {
        for (name, value, config) in ends(&coarse(preset)) {
            wrong.extend(unexplained(name, value, &config).map(|text| format!("{preset}: {text}")));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn shipped_presets_say_only_what_differs_from_the_default() {
    let resources = Path::new(env!("CARGO_MANIFEST_DIR")).join("resources");
    for name in PRESETS {
        let text = std::fs::read_to_string(resources.join(format!("{name}.json"))).unwrap();
        let config = presets::parse(&text).unwrap();
        let json: serde_json::Value = serde_json::from_str(&text).unwrap();
        let named = |row: &str| row.split_once('.').is_some_and(|(group, field)| json[group].get(field).is_some());
        for row in Config::rows() {
            let differs = (row.read)(&config) != (row.read)(&Config::default());
            assert_eq!(named(row.name), differs, "{name}: {}", row.name);
        }
    }
    assert_eq!(common::shipped("railway"), Config::default());
}

/// Two bodies that ranges allow, but no memory: metres of rail in cells that a small wheel prescribes; a heat model for
/// a twentieth of the load on the finest mesh.
#[test]
fn models_too_large_for_memory_are_refused_by_name_before_memory_is_taken() {
    let mut rail = Config::default();
    (rail.wheel.radius, rail.wheel.hub_radius) = (0.1, 0.01);
    (rail.rail.length, rail.rail.height) = (2.0, 2.0);
    (rail.model.nominal_load, rail.model.contact_width) = (100.0, 1.0);
    rail.mesh.elements_per_half_width = 80;
    let mut heat = Config::default();
    heat.mesh.elements_per_half_width = 80;
    heat.thermal.smallest_load_ratio = 0.05;
    for (config, name) in [(rail, "rail.height"), (heat, "thermal.smallest_load_ratio")] {
        assert!(config.thermal.enabled && config.validate().is_ok());
        let before = heap::requested_bytes();
        let computed = &mut |activity: &str, share: f64| assert!(share == 0.0, "{activity}");
        let error = Model::prepare(config, &BasisStore::none(), computed).err().unwrap().to_string();
        let taken = heap::requested_bytes() - before;
        println!("{name}: {taken} bytes before the refusal");
        assert!(taken < 1_000_000, "{taken} bytes");
        assert!(error.contains(name) && error.contains("mesh.elements_per_half_width"), "{error}");
    }
}

#[test]
fn full_bodies_accept_the_ends_of_geometry() {
    let valid = |end: &(&str, f64, Config)| end.2.validate().is_ok();
    for (name, value, mut config) in ends(&coarse("railway")).into_iter().filter(valid) {
        if ["wheel.radius", "wheel.hub_radius", "rail.height", "material.poissons_ratio"].contains(&name) {
            config.solver.reduced = false;
            assert_eq!(rolls(&config), Ok(()), "{name} = {value}");
        }
    }
}
