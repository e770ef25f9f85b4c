//! Damping in stationary rolling: what it costs, and what it changes.

mod common;

use common::*;
use std::sync::Arc;
use wheelrail::config::Config;
use wheelrail::simulation::{Model, Simulation};

/// Power at the hub and power of damping [W] of frictionless stationary rolling.
fn powers(model: &Arc<Model>, velocity: f64) -> [f64; 2] {
    let mut inputs = prescribed(model, velocity, 0.0);
    inputs.drive.friction = 0.0;
    let simulation = Simulation::new(model.clone(), &inputs).unwrap();
    let outputs = simulation.outputs();
    let hub = outputs.hub_force_x * outputs.wheel_velocity + outputs.hub_moment * outputs.wheel_omega;
    [hub, simulation.state().audit.dissipated_power * model.config().model.contact_width]
}

#[test]
fn frictionless_rolling_costs_what_damping_dissipates() {
    let with = |change: &dyn Fn(&mut Config)| {
        let mut config = preset("railway", 10);
        config.thermal.enabled = false;
        change(&mut config);
        model(config)
    };
    let undamped = with(&|c| c.damping.modal = false);
    let cases: [(&str, Arc<Model>); 3] = [
        ("default", with(&|_| {})),
        (
            "ratio 0.1",
            with(&|c| {
                let d = &mut c.damping;
                (d.wheel_torsion, d.wheel_radial, d.wheel_one_diameter) = (0.1, 0.1, 0.1);
                (d.wheel_more_diameters, d.rail) = (0.1, 0.1);
            }),
        ),
        (
            "Rayleigh 10/s, 10 us",
            with(&|c| {
                c.damping.modal = false;
                (c.damping.rayleigh_mass, c.damping.rayleigh_stiffness) = (10.0, 1e-5);
            }),
        ),
    ];
    for velocity in [10.0, 30.0] {
        let [floor, _] = powers(&undamped, velocity);
        for (name, model) in &cases {
            let [hub, damping] = powers(model, velocity);
            let share = (hub - floor) / damping;
            println!(
                "{name}, {velocity} m/s: {hub:.4} W at the hub ({floor:.1e} W undamped), {damping:.4} W damping, \
                      ratio {share:.4}"
            );
        }
    }
}

#[test]
fn default_damping_changes_the_creep_curve_by_less_than_a_ten_thousandth() {
    let damped = model(preset("railway", 20));
    let mut config = preset("railway", 20);
    config.damping.modal = false;
    let undamped = model(config);
    let mut worst = 0.0_f64;
    for velocity in [5.0, 27.8] {
        for creepage in [-3e-3, -1e-3, -3e-4, 0.0, 3e-4, 1e-3, 3e-3] {
            let inputs = prescribed(&damped, velocity, creepage);
            let [a, b] = [&damped, &undamped].map(|model| stationary_utilisation(model, &inputs));
            worst = worst.max((a - b).abs());
        }
    }
    println!("largest change {worst:.1e} of the limit");
    assert!(worst < 1e-4);
}
