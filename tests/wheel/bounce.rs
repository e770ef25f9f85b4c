//! Vertical vibration of the hub on the elastic contact.

use crate::common::*;
use std::f64::consts::{PI, TAU};
use std::sync::Arc;
use wheelrail::simulation::{Inputs, Model, Simulation};

/// Frictionless wheel at rest under the nominal load.
fn at_rest(model: &Model) -> Inputs {
    let mut inputs = prescribed(model, 0.0, 0.0);
    inputs.drive.friction = 0.0;
    inputs
}

/// Slope of load over approach [N/m] about the nominal load, from two static states.
fn stiffness(model: &Arc<Model>) -> f64 {
    let approach = |share: f64| {
        let mut inputs = at_rest(model);
        inputs.drive.load *= share;
        Simulation::new(model.clone(), &inputs).unwrap().outputs().contact_approach
    };
    0.02 * model.config().model.nominal_load / (approach(1.01) - approach(0.99))
}

/// Angular frequency [rad/s] of the vibration after a small change of the load, over `periods` periods of about
/// `expected`.
fn frequency(model: &Arc<Model>, expected: f64, periods: usize) -> f64 {
    let mut inputs = at_rest(model);
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    let dt = TAU / expected / 400.0;
    inputs.drive.load *= 1.001;
    let (mut before, mut crossings) = (f64::NAN, Vec::new());
    for k in 1..=(periods + 1) * 400 {
        simulation.advance(&inputs, dt).unwrap();
        let from_mean = simulation.outputs().contact_force_y - inputs.drive.load;
        if before < 0.0 && from_mean >= 0.0 {
            crossings.push((k as f64 - from_mean / (from_mean - before)) * dt);
        }
        before = from_mean;
    }
    TAU * (crossings.len() - 1) as f64 / (crossings[crossings.len() - 1] - crossings[0])
}

/// With a hub far heavier than the wheel the deformation of the bodies carries no inertia worth mentioning.
#[test]
fn a_heavy_hub_bounces_with_the_root_of_stiffness_over_mass() {
    let mut config = preset("railway", 10);
    config.thermal.enabled = false;
    config.wheel.hub_mass = 3000.0;
    config.vehicle.damping = 0.0;
    let model = model(config);
    let config = model.config();
    let area = PI * (config.wheel.radius.powi(2) - config.wheel.hub_radius.powi(2));
    let mass = config.wheel.hub_mass + config.material.density * area * config.model.contact_width;
    let expected = (stiffness(&model) / mass).sqrt();
    let found = frequency(&model, expected, 5);
    figure_within(1e-3, "bounce.heavy [rad/s]", &[expected, found]);
    println!("bounce at {found:.2} rad/s, √(K/m) = {expected:.2} rad/s");
    assert!((found / expected - 1.0).abs() < 0.01, "{found} against {expected} rad/s");
}

/// The wheel of Paper D without axle: stiffness and frequency of an independent eigenvalue analysis, in which the
/// deformation of the wheel takes part: 28.13 ± 0.1 GN/m per metre and 2196 ± 4 rad/s.
#[test]
fn a_bare_wheel_bounces_as_its_eigenvalue_analysis_says() {
    let mut config = preset("paper_d", 20);
    config.physics.centrifugal = false;
    config.thermal.enabled = false;
    let model = model(config);
    let stiffness = stiffness(&model) / model.config().model.contact_width;
    let found = frequency(&model, 2196.0, 5);
    figure_within(1e-3, "bounce.bare", &[1e-9 * stiffness, found]);
    println!("stiffness {stiffness:.4e} N/m per metre, frequency {found:.1} rad/s");
    assert!((stiffness / 28.13e9 - 1.0).abs() < 0.01, "{stiffness:e}");
    assert!((found / 2196.0 - 1.0).abs() < 0.005, "{found} rad/s");
}
