//! Every state a train can bring about is an ordinary state: random starts, lift-off, standstill, reversal, bad input.

use crate::common::*;
use rayon::prelude::*;
use std::sync::Arc;
use wheelrail::material::Isotropic;
use wheelrail::simulation::{
    Inputs, LONGEST_STEP, Model, Rotation, Simulation, StepError, Translation, Vertical, advice,
};

#[test]
fn a_thousand_random_starts_converge_without_shortening_a_step() {
    let mut config = preset("paper_d", 20);
    config.tuning.tolerance = 0.0;
    let model = model(config);
    let found = (1..=4).into_par_iter().map(|seed| random_starts(&model, seed, 250));
    let (worst, total) = found.reduce(|| (0, 0), |a, b| (a.0.max(b.0), a.1 + b.1));
    figure("starts.steps", &[worst as f64]);
    println!("iterations: mean {:.2}, worst {worst}", total as f64 / 1000.0);
    assert!(worst <= 30, "{worst}");
}

/// Starts of a simulation from random states, each with a step to another one; largest and whole number of iterations.
fn random_starts(model: &Arc<Model>, seed: u64, cases: usize) -> (u64, u64) {
    let mut random = Random(seed);
    let mut simulation = Simulation::new(model.clone(), &prescribed(model, 10.0, 0.0)).unwrap();
    let (mut worst, mut total) = (0, 0);
    for case in 0..cases {
        // A stationary state of any speed, creepage, load and friction ...
        let velocity = random.sign() * random.logarithmic(1e-3, 80.0);
        let creepage = random.sign() * random.logarithmic(1e-6, 1.9);
        let mut inputs = prescribed(model, velocity, creepage);
        inputs.drive.load *= random.between(0.02, 1.9);
        inputs.drive.friction = random.between(0.02, 0.8);
        simulation.restart(&inputs).unwrap_or_else(|e| panic!("{seed}, case {case}: {e}\n{inputs:?}"));
        // ... then one step of any length to another load and friction and, with up to 30 m/s² and 300 rad/s², speeds.
        let step = random.logarithmic(1e-6, 0.1);
        inputs.drive.load = model.config().model.nominal_load * random.between(0.02, 1.9);
        inputs.drive.friction = random.between(0.02, 0.8);
        inputs.drive.velocity += step * random.between(-30.0, 30.0);
        inputs.drive.omega += step * random.between(-300.0, 300.0);
        simulation
            .advance(&inputs, step)
            .unwrap_or_else(|e| panic!("{seed}, case {case}: {e}\n{inputs:?}, {step:e} s"));
        let outputs = simulation.outputs();
        assert_eq!(outputs.internal_steps, 1, "case {case}: {inputs:?}, {step:e} s");
        worst = worst.max(outputs.iterations);
        total += outputs.iterations;
    }
    (worst, total)
}

#[test]
fn wheel_starts_from_rest_under_a_driving_force() {
    let mut config = preset("railway", 10);
    config.initial.velocity = 0.0;
    let model = model(config);
    let mut inputs = Inputs::rolling(model.config());
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    assert_eq!(simulation.outputs().contact_creepage, 0.0);
    inputs.drive.force = 5000.0;
    for _ in 0..500 {
        simulation.advance(&inputs, 1e-3).unwrap();
    }
    let outputs = simulation.outputs();
    let config = model.config();
    let wheel_mass = config.material.density
        * std::f64::consts::PI
        * (config.wheel.radius.powi(2) - config.wheel.hub_radius.powi(2))
        * config.model.contact_width;
    let inertia =
        config.wheel.hub_inertia + 0.5 * wheel_mass * (config.wheel.radius.powi(2) + config.wheel.hub_radius.powi(2));
    let mass = wheel_mass + config.wheel.hub_mass + config.vehicle.mass + inertia / config.wheel.radius.powi(2);
    println!("{} m/s against rigid rolling {}", outputs.wheel_velocity, 5000.0 / mass * 0.5);
    assert!((outputs.wheel_velocity / (5000.0 / mass * 0.5) - 1.0).abs() < 0.01);
    assert!(outputs.contact_creepage.abs() < 1e-3);
}

#[test]
fn wheel_lifts_off_falls_back_and_carries_the_load_again() {
    let mut config = preset("railway", 10);
    // Long steps damp the bounce, whose first impact exceeds the candidate zone.
    config.tuning.tolerance = 0.0;
    let model = model(config);
    let mut inputs = Inputs::rolling(model.config());
    inputs.vertical = Vertical::Displacement;
    inputs.drive.displacement = 1e-4;
    let mut simulation = Simulation::new(model.clone(), &Inputs::rolling(model.config())).unwrap();
    for _ in 0..20 {
        simulation.advance(&inputs, 1e-3).unwrap();
    }
    assert_eq!(simulation.outputs().contact_force_y, 0.0);
    assert_eq!(simulation.outputs().contact_half_width, 0.0);
    inputs.vertical = Vertical::Force;
    let mut largest = 0.0f64;
    for _ in 0..400 {
        simulation.advance(&inputs, 1e-3).unwrap();
        largest = largest.max(simulation.outputs().contact_force_y);
    }
    let outputs = simulation.outputs();
    println!("landing force {largest:.0} N, then {:.0} N", outputs.contact_force_y);
    assert!(largest > 1.1 * inputs.drive.load);
    assert!((outputs.contact_force_y / inputs.drive.load - 1.0).abs() < 1e-3, "{}", outputs.contact_force_y);
}

/// Beyond the speed of surface waves a moving load has no stable field: energy would grow from nothing.
#[test]
fn a_motion_beyond_the_range_of_the_model_is_refused_and_the_run_goes_on() {
    let model = model(preset("railway", 5));
    let mut inputs = Inputs::rolling(model.config());
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    inputs.drive.force = 1e8;
    let error = (0..1000).find_map(|_| simulation.advance(&inputs, 1e-4).err()).unwrap();
    assert!(matches!(error, StepError::Motion(_)) && error.to_string().contains("drive.velocity"), "{error}");
    // A free motion may go 5 % beyond the range of the input.
    let velocity = simulation.outputs().wheel_velocity;
    assert!(error.to_string().contains("-210 to 210 m/s"), "{error}");
    assert!(velocity > 200.0 && velocity <= 210.0, "{velocity} m/s");
    simulation.advance(&Inputs::rolling(model.config()), 1e-4).unwrap();

    let wave = Isotropic::from(&model.config().material).rayleigh_speed();
    assert!((wave / 2977.0 - 1.0).abs() < 0.01, "steel, Poisson's ratio 0.3: {wave} m/s");
    inputs = Inputs { rotation: Rotation::Velocity, ..Inputs::rolling(model.config()) };
    inputs.drive.omega = 1.01 * wave / model.config().wheel.radius;
    let error = simulation.restart(&inputs).unwrap_err();
    assert!(matches!(error, StepError::Motion(_)) && error.to_string().contains("drive.omega"), "{error}");
}

/// Rounding leaves such steps at the end of a run.
#[test]
fn steps_too_short_to_be_computed_wait_for_the_next_one() {
    let mut config = preset("railway", 5);
    config.tuning.tolerance = 0.0;
    let model = model(config);
    let mut inputs = Inputs::rolling(model.config());
    let run = |steps: &[f64], inputs: &Inputs| {
        let mut simulation = Simulation::new(model.clone(), inputs).unwrap();
        steps.iter().for_each(|&h| simulation.advance(inputs, h).unwrap());
        simulation
    };
    inputs.drive.moment = -3000.0;
    let one = run(&[1e-3], &inputs);
    let held = run(&[1e-3, 1e-15, 3e-8], &inputs);
    assert_eq!(held.outputs(), one.outputs());
    assert!((held.time() - 1e-3 - 3e-8).abs() < 1e-14);
    let made_up = run(&[1e-3, 1e-15, 3e-8, 1e-3 - 3e-8], &inputs);
    let two = run(&[1e-3, 1e-3], &inputs);
    assert!((made_up.outputs().contact_force_x - two.outputs().contact_force_x).abs() < 1e-3);
    assert!((made_up.time() - two.time()).abs() < 1e-14);
    let dust = run(&[1e-7; 100], &inputs);
    assert!((dust.outputs().wheel_distance / dust.time() / inputs.drive.velocity - 1.0).abs() < 1e-3);
}

#[test]
fn the_longest_communication_step_is_carried_out() {
    let mut config = preset("railway", 5);
    (config.tuning.max_step, config.tuning.tolerance) = (1.0, 0.0);
    let model = model(config);
    let inputs = Inputs::rolling(model.config());
    let mut simulation = Simulation::new(model, &inputs).unwrap();
    simulation.advance(&inputs, LONGEST_STEP).unwrap();
    let outputs = simulation.outputs();
    assert_eq!(outputs.internal_steps, LONGEST_STEP as u64);
    assert!((outputs.wheel_distance / (LONGEST_STEP * inputs.drive.velocity) - 1.0).abs() < 1e-3);
    assert!(matches!(simulation.advance(&inputs, 1.001 * LONGEST_STEP), Err(StepError::StepSize { .. })));
}

#[test]
fn wheel_with_all_motions_prescribed_lifts_off() {
    let model = model(preset("railway", 10));
    let mut inputs = prescribed(&model, 10.0, 0.0);
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    inputs.vertical = Vertical::Displacement;
    inputs.drive.displacement = 1e-4;
    for _ in 0..20 {
        simulation.advance(&inputs, 1e-3).unwrap();
    }
    let outputs = simulation.outputs();
    assert_eq!((outputs.contact_force_y, outputs.friction_power), (0.0, 0.0));
    assert!((outputs.wheel_velocity - 10.0).abs() < 1e-12 && (outputs.contact_approach + 1e-4).abs() < 1e-15);
}

#[test]
fn reversal_of_the_travel_direction_mirrors_the_contact() {
    let model = model(preset("paper_d", 10));
    let forward = Simulation::new(model.clone(), &prescribed(&model, 10.0, 2e-4)).unwrap();
    let backward = Simulation::new(model.clone(), &prescribed(&model, -10.0, 2e-4)).unwrap();
    let (f, b) = (forward.outputs().clone(), backward.outputs().clone());
    assert!((f.contact_force_x + b.contact_force_x).abs() < 1e-6 * f.contact_force_y);
    let mut inputs = prescribed(&model, 10.0, 2e-4);
    let mut simulation = forward;
    for k in 1..=300 {
        // Through standstill within 0.2 s, then settling to the mirrored state.
        inputs.drive.velocity = 10.0 - 20.0 * (k as f64 / 200.0).min(1.0);
        inputs.drive.omega = omega(&model, inputs.drive.velocity, 2e-4);
        simulation.advance(&inputs, 1e-3).unwrap();
    }
    let settled = simulation.outputs().contact_force_x;
    println!("{settled} {}", b.contact_force_x);
    assert!((settled - b.contact_force_x).abs() < 5e-3 * f.contact_force_y);
}

#[test]
fn locked_wheel_slides_with_the_full_friction_force() {
    let model = model(preset("railway", 10));
    let mut inputs = Inputs::rolling(model.config());
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    inputs.rotation = Rotation::Velocity;
    for k in 1..=50 {
        inputs.drive.omega = simulation.outputs().wheel_omega.max(0.0) * (1.0 - k as f64 / 50.0);
        simulation.advance(&inputs, 1e-3).unwrap();
    }
    inputs.drive.omega = 0.0;
    for _ in 0..100 {
        simulation.advance(&inputs, 1e-3).unwrap();
    }
    let outputs = simulation.outputs();
    assert_eq!(outputs.contact_creepage, 2.0);
    assert!((outputs.contact_utilisation - 1.0).abs() < 1e-9, "{}", outputs.contact_utilisation);
    assert!(outputs.contact_force_x < 0.0 && outputs.contact_stick_fraction == 0.0);
}

#[test]
fn switching_control_to_the_reaction_continues_the_motion() {
    let mut config = preset("railway", 10);
    config.initial.creepage = Some(5e-4);
    let model = model(config);
    let mut inputs = Inputs::rolling(model.config());
    (inputs.rotation, inputs.translation) = (Rotation::Velocity, Translation::Velocity);
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    for _ in 0..50 {
        simulation.advance(&inputs, 1e-3).unwrap();
    }
    let before = simulation.outputs().clone();
    (inputs.rotation, inputs.translation, inputs.vertical) =
        (Rotation::Moment, Translation::Force, Vertical::Displacement);
    inputs.drive.moment = before.hub_moment;
    inputs.drive.force = before.hub_force_x;
    inputs.drive.displacement = -before.contact_approach;
    for _ in 0..50 {
        simulation.advance(&inputs, 1e-3).unwrap();
        let now = simulation.outputs();
        assert!((now.contact_force_x - before.contact_force_x).abs() < 1e-4 * before.contact_force_y);
        assert!((now.contact_force_y / before.contact_force_y - 1.0).abs() < 1e-4);
        assert!((now.wheel_velocity / before.wheel_velocity - 1.0).abs() < 1e-6);
    }
}

#[test]
fn a_load_beyond_the_candidate_zone_is_refused_and_the_run_goes_on() {
    let model = model(preset("railway", 10));
    let mut inputs = Inputs::rolling(model.config());
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    inputs.drive.load = 2.0 * model.config().model.nominal_load;
    let mut twice = Simulation::new(model.clone(), &inputs).unwrap();
    assert!((twice.outputs().contact_force_y / inputs.drive.load - 1.0).abs() < 1e-9);
    inputs.drive.load *= 15.0;
    let error = twice.restart(&inputs).unwrap_err();
    assert!(matches!(error, StepError::ZoneExceeded { .. }), "{error}");
    let advice = advice::failed_start(&error, model.config(), &inputs);
    assert!(advice.contains("model.nominal_load") && advice.contains("drive.load"), "{advice}");
    let before = simulation.state().clone();
    let mut bad = Inputs::rolling(model.config());
    bad.drive.load = f64::NAN;
    let error = simulation.advance(&bad, 1e-3).unwrap_err();
    assert!(error.to_string().contains("drive.load"), "{error}");
    assert!(matches!(simulation.advance(&Inputs::rolling(model.config()), -1.0), Err(StepError::StepSize { .. })));
    assert_eq!(simulation.state(), &before);
    simulation.advance(&Inputs::rolling(model.config()), 1e-3).unwrap();
}

#[test]
fn a_step_of_too_many_internal_steps_is_refused_and_the_run_goes_on() {
    let mut config = preset("railway", 8);
    config.tuning.max_step = 1e-6;
    let model = model(config);
    let inputs = Inputs::rolling(model.config());
    let mut simulation = Simulation::new(model, &inputs).unwrap();
    let error = simulation.advance(&inputs, 0.05).unwrap_err();
    assert!(matches!(error, StepError::TooManySteps { pieces: 50_000, .. }), "{error}");
    assert!(error.to_string().contains("solver.max_step"), "{error}");
    simulation.advance(&inputs, 1e-5).unwrap();
    assert_eq!(simulation.outputs().internal_steps, 10);
}
