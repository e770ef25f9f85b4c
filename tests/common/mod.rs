//! Models for the physics tests; reduced bases are kept under `target/basis`, so that each is computed once.
#![allow(dead_code)]

pub mod random;

#[allow(unused_imports)]
pub use random::Random;
use std::path::Path;
use std::sync::Arc;
use wheelrail::config::{Config, presets};
use wheelrail::simulation::{BasisStore, Inputs, Model, Outputs, Rotation, Simulation, Translation};

pub const KMH: f64 = 1.0 / 3.6;

/// A preset as it is shipped.
pub fn shipped(name: &str) -> Config {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("resources").join(format!("{name}.json"));
    presets::parse(&std::fs::read_to_string(path).unwrap()).unwrap()
}

/// Lateral velocity that lets a contact compute both directions, and is too small to be felt [m/s].
pub const HARDLY: f64 = 1e-9;

/// A shipped preset with another density of all meshes, the contact nodes included.
pub fn preset(name: &str, elements_per_half_width: usize) -> Config {
    let mut config = shipped(name);
    config.mesh.elements_per_half_width = elements_per_half_width;
    config.mesh.grid_elements_per_half_width = elements_per_half_width;
    config
}

/// The prepared model of a configuration.
pub fn model(config: Config) -> Arc<Model> {
    Model::shared(config, &store(), &mut |_, _| {}).unwrap()
}

/// Where the tests keep reduced bases, with the shipped resources.
pub fn store() -> BasisStore {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    BasisStore::within(&root.join("target")).with_packed(Some(&root.join("resources")))
}

/// Inputs that prescribe velocity and creepage under the nominal load.
pub fn prescribed(model: &Model, velocity: f64, creepage: f64) -> Inputs {
    let mut config = model.config().clone();
    config.initial.velocity = velocity;
    config.initial.creepage = Some(creepage);
    let mut inputs = Inputs::rolling(&config);
    inputs.rotation = Rotation::Velocity;
    inputs.translation = Translation::Velocity;
    inputs
}

/// Peripheral velocity over radius for a velocity and a creepage [rad/s].
pub fn omega(model: &Model, velocity: f64, creepage: f64) -> f64 {
    velocity * (1.0 - 0.5 * creepage) / (1.0 + 0.5 * creepage) / model.config().wheel.radius
}

/// Tangential force over its limit in stationary rolling.
pub fn stationary_utilisation(model: &Arc<Model>, inputs: &Inputs) -> f64 {
    let simulation = Simulation::new(model.clone(), inputs).unwrap();
    signed_utilisation(&simulation, inputs.drive.friction)
}

/// `F_x/(μ F_y)`, traction positive.
pub fn signed_utilisation(simulation: &Simulation, friction: f64) -> f64 {
    let outputs = simulation.outputs();
    outputs.contact_force_x / (friction * outputs.contact_force_y)
}

/// Prints figures of the pages, of which the smaller ones are the better (`tools/figures.py`). Printed again, the largest count.
pub fn figure(name: &str, values: &[f64]) {
    println!("figure: {name} = {}", listed(values));
}

/// Prints figures of errors that are round-off, or that it decides by way of stick-slip: all below `least` are equally good.
pub fn round_off(name: &str, values: &[f64], least: f64) {
    println!("figure: {name} = {} < {least:e}", listed(values));
}

/// Prints figures of the pages that are neither better nor worse while they change by less than the share `tolerance`.
pub fn figure_within(tolerance: f64, name: &str, values: &[f64]) {
    println!("figure: {name} = {} ± {tolerance}", listed(values));
}

fn listed(values: &[f64]) -> String {
    values.iter().map(|value| format!("{value:.5e}")).collect::<Vec<_>>().join(", ")
}

/// Smallest and largest value.
pub fn range(values: &[f64]) -> (f64, f64) {
    values.iter().fold((f64::MAX, f64::MIN), |(low, high), &v| (low.min(v), high.max(v)))
}

/// A preset without heat, on twenty elements and nodes.
pub fn without_heat(name: &str, change: impl Fn(&mut Config)) -> Arc<Model> {
    let mut config = preset(name, 20);
    config.thermal.enabled = false;
    change(&mut config);
    model(config)
}

/// Outputs at the start and after every step of inputs that change.
pub fn run(
    model: &Arc<Model>,
    mut inputs: Inputs,
    (step, count): (f64, usize),
    change: impl Fn(&mut Inputs, f64),
) -> Vec<Outputs> {
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    let mut seen = vec![simulation.outputs().clone()];
    for k in 1..=count {
        change(&mut inputs, k as f64 * step);
        simulation.advance(&inputs, step).unwrap_or_else(|error| panic!("step {k} of {step} s: {error}"));
        seen.push(simulation.outputs().clone());
    }
    seen
}

/// Moment, load, friction and rail temperature that change a little in every step, at the time `t` [s].
pub fn vary(inputs: &mut Inputs, t: f64) {
    inputs.drive.moment = -4000.0 - 2000.0 * (300.0 * t).sin();
    inputs.drive.load = 1e5 * (1.0 + 0.1 * (400.0 * t).sin());
    inputs.drive.friction = 0.3 + 0.03 * (200.0 * t).sin();
    inputs.drive.temperature = 293.0 + 1e3 * t;
}
