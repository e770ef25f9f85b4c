//! Damping in stationary rolling: what it costs, and what it changes.

use crate::common::*;
use std::sync::Arc;
use wheelrail::config::Damping;
use wheelrail::simulation::{Model, Simulation};

/// Power at the hub less that of friction, and power of damping [W] in stationary rolling.
fn powers(model: &Arc<Model>, velocity: f64, creepage: f64, friction: f64) -> [f64; 2] {
    let mut inputs = prescribed(model, velocity, creepage);
    inputs.drive.friction = friction;
    let simulation = Simulation::new(model.clone(), &inputs).unwrap();
    let outputs = simulation.outputs();
    let hub = outputs.hub_force_x * outputs.wheel_velocity + outputs.hub_moment * outputs.wheel_omega;
    let width = model.config().model.contact_width;
    [hub - outputs.friction_power, simulation.state().audit.damping_power * width]
}

fn cold(change: impl Fn(&mut Damping)) -> Arc<Model> {
    let mut config = preset("railway", 10);
    config.thermal.enabled = false;
    change(&mut config.damping);
    model(config)
}

/// The rest of the power is that of the undamped model at the same creepage.
#[test]
fn stationary_rolling_costs_what_friction_and_damping_dissipate() {
    let undamped = cold(|d| *d = Damping::NONE);
    let cases = [
        ("default", cold(|_| {})),
        ("wheel", cold(|d| (d.wheel_more_diameters, d.rail) = (1e-2, 0.0))),
        ("rail", cold(|d| (d.wheel_one_diameter, d.wheel_more_diameters) = (0.0, 0.0))),
    ];
    for (velocity, creepage, friction) in [(10.0, 0.0, 0.0), (30.0, 0.0, 0.0), (30.0, 1e-3, 0.3)] {
        let [floor, none] = powers(&undamped, velocity, creepage, friction);
        assert!(none.abs() < 1e-9);
        for (name, model) in &cases {
            let [lost, damping] = powers(model, velocity, creepage, friction);
            let ratio = (lost - floor) / damping;
            println!(
                "{name}, {velocity} m/s, creepage {creepage}: {damping:.4} W of damping, hub gives {ratio:.4} of it"
            );
            // The stream carries the kept modes only.
            assert!(damping > 0.0 && (ratio - 1.0).abs() < 0.05);
        }
    }
}

#[test]
fn default_damping_changes_the_creep_curve_by_less_than_a_ten_thousandth() {
    let damped = model(preset("railway", 20));
    let mut config = preset("railway", 20);
    config.damping = Damping::NONE;
    let undamped = model(config);
    let mut worst = 0.0_f64;
    for velocity in [5.0, 27.8] {
        for creepage in [-3e-3, -1e-3, -3e-4, 0.0, 3e-4, 1e-3, 3e-3] {
            let inputs = prescribed(&damped, velocity, creepage);
            let [a, b] = [&damped, &undamped].map(|model| stationary_utilisation(model, &inputs));
            worst = worst.max((a - b).abs());
        }
    }
    figure("damping.creep.curve", &[worst]);
    println!("largest change {worst:.1e} of the limit");
    assert!(worst < 1e-4);
}
