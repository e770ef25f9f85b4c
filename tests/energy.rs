//! Energy balance and independence of the communication step in a braking stop.

mod common;
use common::*;
use std::sync::Arc;
use wheelrail::simulation::{Inputs, Model, Outputs, Rotation, Simulation};

/// Braking from 10 m/s: moment ramp, hold, at walking speed the brake holds the wheel. Outputs at the end.
fn braking_stop(model: &Arc<Model>, step: f64) -> Outputs {
    let config = model.config();
    let peak = 0.6 * config.friction.coefficient * config.model.nominal_load * config.wheel.radius;
    let mut inputs = Inputs::rolling(config);
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    let mut k = 0u64;
    while simulation.outputs().wheel_velocity > 0.05 {
        inputs.drive.moment = -peak * (k as f64 * step / 0.2).min(1.0);
        simulation.advance(&inputs, step).unwrap();
        k += 1;
        assert!((k as f64) * step < 30.0, "no stop: {:?}", simulation.outputs().wheel_velocity);
    }
    inputs.rotation = Rotation::Velocity;
    inputs.drive.omega = 0.0;
    for _ in 0..(0.2 / step) as usize {
        simulation.advance(&inputs, step).unwrap();
    }
    simulation.outputs().clone()
}

#[test]
fn braking_stop_balances_energy_and_does_not_depend_on_the_communication_step() {
    let mut config = preset("railway", 20);
    config.initial.velocity = 10.0;
    let model = model(config);
    let coarse = braking_stop(&model, 2e-3);
    let fine = braking_stop(&model, 1e-3);
    println!("distance {:.5} m and {:.5} m", coarse.wheel_distance, fine.wheel_distance);
    println!("energy residual {:+.2e} and {:+.2e}", coarse.energy_residual, fine.energy_residual);
    assert!((coarse.wheel_distance / fine.wheel_distance - 1.0).abs() < 5e-4);
    assert!(fine.energy_residual.abs() < 4e-3, "{}", fine.energy_residual);
}

#[test]
fn steady_creep_dissipates_what_the_drive_supplies() {
    let model = model(preset("railway", 20));
    for creepage in [-2e-3, -5e-4, 5e-4, 2e-3, 1e-2] {
        let inputs = prescribed(&model, 20.0, creepage);
        let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
        for _ in 0..10 {
            simulation.advance(&inputs, 1e-2).unwrap();
        }
        let outputs = simulation.outputs();
        let supplied = outputs.hub_force_x * outputs.wheel_velocity + outputs.hub_moment * outputs.wheel_omega;
        println!("xi = {creepage}: supplied {supplied:.3} W, dissipated {:.3} W", outputs.friction_power);
        assert!((supplied / outputs.friction_power - 1.0).abs() < 5e-3);
        assert!(outputs.energy_residual.abs() < 5e-3);
    }
}

/// The driven mass moves a thousand times the energy that the contact dissipates.
#[test]
fn energy_residual_of_gentle_traction_falls_with_the_step() {
    let mut config = preset("railway", 20);
    config.tuning.tolerance = 0.0;
    config.initial.velocity = 20.0;
    let model = model(config);
    let residual = |step: f64| {
        let mut inputs = Inputs::rolling(model.config());
        let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
        for k in 0..(3.0 / step) as usize {
            inputs.drive.moment = 1000.0 * (k as f64 * step).sin();
            simulation.advance(&inputs, step).unwrap();
        }
        simulation.outputs().energy_residual
    };
    let residuals = [2e-2, 1e-2, 5e-3, 2.5e-3].map(|step| residual(step).abs());
    println!("residuals with steps of 20 to 2.5 ms: {residuals:?}");
    // First order, on top of some 0.1 % of the dissipation that no step removes: the normals are those of the undeformed
    // bodies.
    assert!(residuals[0] < 0.04 && residuals[3] < 0.008, "{residuals:?}");
    assert!(residuals.windows(2).all(|r| r[1] < 0.75 * r[0]), "{residuals:?}");
}
