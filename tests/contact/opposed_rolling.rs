//! A wheel that turns against its travel, up to rω = −V: it slides more than a locked one, and nothing about it is
//! special where the sum of both velocities, in which creepage is given, vanishes.

use crate::common::{model, preset};
use std::sync::Arc;
use wheelrail::simulation::{Inputs, Model, Outputs, Rotation, Simulation, Translation, Vertical};

/// The railway wheel without heat.
fn cold() -> Arc<Model> {
    let mut config = preset("railway", 10);
    config.thermal.enabled = false;
    model(config)
}

/// Outputs at the start and after ten steps of a wheel that travels with `velocity` [m/s] and turns with the peripheral
/// velocity `factor · velocity`.
fn slide(model: &Arc<Model>, velocity: f64, factor: f64) -> [Outputs; 2] {
    let mut inputs = Inputs::rolling(model.config());
    (inputs.rotation, inputs.translation) = (Rotation::Velocity, Translation::Velocity);
    (inputs.drive.velocity, inputs.drive.omega) = (velocity, factor * velocity / model.config().wheel.radius);
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    let start = simulation.outputs().clone();
    for _ in 0..10 {
        simulation.advance(&inputs, 1e-3).unwrap();
    }
    [start, simulation.outputs().clone()]
}

#[test]
fn a_wheel_that_turns_against_its_travel_starts_and_slides_like_any_sliding_wheel() {
    let model = cold();
    let friction = model.config().friction.coefficient;
    for velocity in [20.0, -20.0] {
        for factor in [-1.0, -1.0 - 1e-9, -1.0 + 1e-9, -0.99, -1.01, -0.3, -2.0] {
            for outputs in slide(&model, velocity, factor) {
                let traction = outputs.contact_force_x / (friction * outputs.contact_force_y);
                println!("V {velocity}, rω/V {factor:.9}: F/(μP) {traction:.9}, iterations {}", outputs.iterations);
                assert!((traction + velocity.signum()).abs() < 1e-9, "{velocity} {factor}: {traction}");
                assert_eq!(outputs.contact_stick_fraction, 0.0);
                assert_eq!(outputs.contact_creepage, 2.0);
                assert!((outputs.contact_slide - (1.0 - factor)).abs() < 1e-12 * (1.0 - factor));
                let power = friction * outputs.contact_force_y * outputs.contact_slip_velocity.abs();
                assert!((outputs.friction_power / power - 1.0).abs() < 5e-3, "{} of {power}", outputs.friction_power);
            }
        }
    }
}

#[test]
fn a_wheel_passes_from_locked_to_opposed_rolling_without_a_jump() {
    let model = cold();
    let mut inputs = Inputs::rolling(model.config());
    (inputs.rotation, inputs.translation) = (Rotation::Velocity, Translation::Velocity);
    (inputs.drive.velocity, inputs.drive.omega) = (20.0, 0.0);
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    let mut before = simulation.outputs().clone();
    // rω from 0 to −1.2 V: the sum of both velocities changes its sign on the way.
    for k in 1..=60 {
        inputs.drive.omega = -0.02 * f64::from(k) * 20.0 / model.config().wheel.radius;
        simulation.advance(&inputs, 1e-3).unwrap();
        let now = simulation.outputs().clone();
        let jump = |of: fn(&Outputs) -> f64| of(&now) - of(&before);
        assert_eq!(now.contact_creepage, 2.0);
        assert!((jump(|o| o.contact_slide) - 0.02).abs() < 1e-9, "step {k}");
        let force = jump(|o| o.contact_force_x).abs() / now.contact_force_y;
        assert!(force < 0.02, "step {k}: jump of {force} of the load");
        before = now;
    }
}

#[test]
fn a_wheel_that_is_let_down_while_it_turns_against_its_travel_slides_at_once() {
    let model = cold();
    let friction = model.config().friction.coefficient;
    for factor in [-1.0, -0.99, -1.01] {
        let mut inputs = Inputs::rolling(model.config());
        (inputs.rotation, inputs.translation) = (Rotation::Velocity, Translation::Velocity);
        (inputs.drive.velocity, inputs.drive.omega) = (20.0, factor * 20.0 / model.config().wheel.radius);
        (inputs.vertical, inputs.drive.displacement) = (Vertical::Displacement, 5e-5);
        let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
        assert_eq!(simulation.outputs().contact_force_y, 0.0);
        for k in 1..=40 {
            inputs.drive.displacement = 5e-5 - 5e-6 * f64::from(k);
            simulation.advance(&inputs, 1e-3).unwrap();
            let outputs = simulation.outputs();
            let limit = friction * outputs.contact_force_y;
            assert!((outputs.contact_force_x + limit).abs() < 1e-9 * limit.max(1.0), "factor {factor}, step {k}");
        }
        assert!(simulation.outputs().contact_force_y > 1e4, "{}", simulation.outputs().contact_force_y);
    }
}
