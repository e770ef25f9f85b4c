//! Inputs of the track from a master: gradient, height and temperature of the rail; and outputs of the wheel.

use crate::common::{model, preset, range, shipped};
use std::f64::consts::PI;
use std::sync::Arc;
use wheelrail::config::{Config, Hub};
use wheelrail::simulation::validity::Limit;
use wheelrail::simulation::{Drive, Inputs, Model, Outputs, Simulation, Translation, Vertical};

const GRAVITY: f64 = 9.80665;

/// A railway wheel on a coarse mesh.
fn wheel(change: impl Fn(&mut Config)) -> Arc<Model> {
    let mut config = preset("railway", 6);
    (config.solver.modes_wheel, config.solver.modes_rail) = (20, 10);
    config.thermal.enabled = false;
    change(&mut config);
    model(config)
}

/// Mass moving in x [kg], and the same with the moment of inertia at the rim.
fn masses(model: &Model, outputs: &Outputs) -> [f64; 2] {
    let mass = outputs.wheel_mass + model.config().vehicle.mass;
    [mass, mass + outputs.wheel_inertia / model.config().wheel.radius.powi(2)]
}

#[test]
fn mass_and_inertia_are_those_of_annulus_and_hub() {
    let model = wheel(|_| {});
    let simulation = Simulation::new(model.clone(), &Inputs::rolling(model.config())).unwrap();
    let (c, o) = (model.config(), simulation.outputs());
    let (r, i) = (c.wheel.radius, c.wheel.hub_radius);
    let annulus = PI * c.material.density * c.model.contact_width * (r * r - i * i);
    println!("{} kg, {} kg m²", o.wheel_mass, o.wheel_inertia);
    assert!((o.wheel_mass / (annulus + 250.0) - 1.0).abs() < 1e-12);
    assert!((o.wheel_inertia / (0.5 * annulus * (r * r + i * i) + 15.0) - 1.0).abs() < 1e-12);
    assert_eq!(o.hub_height, -o.contact_approach);
}

#[test]
fn a_wheel_rolls_down_a_gradient_and_its_brake_holds_it_there() {
    let model = wheel(|config| config.initial.velocity = 0.0);
    let mut inputs = Inputs::rolling(model.config());
    (inputs.drive.slope, inputs.drive.torque) = (0.03, 5e3);
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    let start = simulation.outputs().clone();
    let [mass, with_inertia] = masses(&model, &start);
    let pull = mass * GRAVITY * 0.03 / 0.03f64.hypot(1.0);
    println!("holds {} N m against {} N", start.brake_moment, pull);
    assert!(start.brake_locked && (start.brake_moment / (0.46 * pull) - 1.0).abs() < 1e-2);
    assert_eq!(start.hub_force_x, 0.0);
    for _ in 0..500 {
        simulation.advance(&inputs, 1e-3).unwrap();
        assert!(simulation.outputs().brake_locked && simulation.outputs().wheel_velocity.abs() < 1e-6);
    }
    inputs.drive.torque = 0.0;
    for _ in 0..2000 {
        simulation.advance(&inputs, 1e-3).unwrap();
    }
    let (o, v) = (simulation.outputs(), -2.0 * pull / with_inertia);
    println!("{} m/s, closed form {v}; gravity {} J", o.wheel_velocity, o.gravity_work);
    println!("stored {} J, hub {} J, residual {}", o.stored_energy, o.hub_work, o.energy_residual);
    assert!((o.wheel_velocity / v - 1.0).abs() < 1e-3);
    assert!((o.gravity_work / (-pull * o.wheel_distance) - 1.0).abs() < 1e-9);
    assert!((o.gravity_work / o.stored_energy - 1.0).abs() < 1e-3 && o.hub_work.abs() < 1e-2);
}

#[test]
fn a_start_uphill_needs_the_pull_of_the_gradient_before_the_brake_lets_go() {
    let model = wheel(|config| config.initial.velocity = 0.0);
    let mut inputs = Inputs::rolling(model.config());
    (inputs.drive.slope, inputs.drive.torque) = (0.02, 4e3);
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    // The driver opens the throttle against the brake, which fades from half a second on.
    let (mut lowest, mut released) = (f64::MAX, None);
    for k in 0..3000 {
        let t = f64::from(k + 1) * 1e-3;
        inputs.drive.moment = 2e3 * (t / 0.5).min(1.0);
        inputs.drive.torque = 4e3 * (1.0 - (t - 0.5).clamp(0.0, 1.0));
        simulation.advance(&inputs, 1e-3).unwrap();
        let o = simulation.outputs();
        lowest = lowest.min(o.wheel_distance);
        if released.is_none() && !o.brake_locked {
            released = Some(t);
        }
    }
    let (o, [mass, _]) = (simulation.outputs(), masses(&model, simulation.outputs()));
    // It is free where the torque is what the drive has over the pull.
    let free = 1.5 - (2e3 - 0.46 * mass * GRAVITY * 0.02 / 0.02f64.hypot(1.0)) / 4e3;
    println!("free at {released:?} s, closed form {free}; lowest {lowest:e} m, {} m/s", o.wheel_velocity);
    assert!((released.unwrap() - free).abs() < 5e-3 && o.wheel_velocity > 0.1);
    assert!(lowest > -1e-4, "it rolls back by {lowest} m");
}

#[test]
fn a_prescribed_velocity_on_a_gradient_takes_the_force_of_gravity() {
    let model = wheel(|_| {});
    let force = [0.0, 0.01].map(|slope| {
        let mut inputs = Inputs { translation: Translation::Velocity, ..Inputs::rolling(model.config()) };
        inputs.drive.slope = slope;
        let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
        let start = simulation.outputs().hub_force_x;
        (0..20).for_each(|_| simulation.advance(&inputs, 1e-3).unwrap());
        [start, simulation.outputs().hub_force_x]
    });
    let [mass, _] = masses(&model, Simulation::new(model.clone(), &Inputs::rolling(model.config())).unwrap().outputs());
    let pull = mass * GRAVITY * 0.01 / 0.01f64.hypot(1.0);
    println!("{force:?}, gravity {pull}");
    for (flat, rising) in force[0].into_iter().zip(force[1]) {
        assert!((rising - flat - pull).abs() < 1e-6 * pull);
    }
}

#[test]
fn a_rail_that_rises_lifts_the_wheel_and_does_the_work_of_the_load() {
    let model = wheel(|_| {});
    let mut inputs = Inputs::rolling(model.config());
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    let before = simulation.outputs().clone();
    for k in 0..2000 {
        let share = (f64::from(k + 1) / 1000.0).min(1.0);
        inputs.drive.elevation = 5e-4 * (1.0 - (PI * share).cos());
        simulation.advance(&inputs, 1e-3).unwrap();
    }
    let o = simulation.outputs();
    println!("{} m, {} J, residual {}", o.hub_height - before.hub_height, o.lift_work, o.energy_residual);
    assert!((o.hub_height - before.hub_height - 1e-3).abs() < 1e-8);
    assert!((o.lift_work / (1e-3 * 1e5) - 1.0).abs() < 1e-3 && (o.hub_work / (-1e-3 * 1e5) - 1.0).abs() < 1e-3);
    assert!((o.contact_approach - before.contact_approach).abs() < 1e-8 && o.energy_residual.abs() < 1e-2);
}

#[test]
fn a_rail_that_rises_under_a_held_hub_presses_as_a_hub_that_sinks() {
    let model = wheel(|_| {});
    let mut inputs = Inputs { vertical: Vertical::Displacement, ..Inputs::rolling(model.config()) };
    inputs.drive.displacement = -8e-5;
    let run = |change: &dyn Fn(&mut Drive, f64)| {
        let mut inputs = inputs;
        let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
        for k in 0..50 {
            change(&mut inputs.drive, 1e-5 * (f64::from(k + 1) / 20.0).min(1.0));
            simulation.advance(&inputs, 1e-3).unwrap();
        }
        simulation.outputs().clone()
    };
    let [rises, sinks] = [run(&|drive, by| drive.elevation = by), run(&|drive, by| drive.displacement = -8e-5 - by)];
    println!("{} and {} N", rises.contact_force_y, sinks.contact_force_y);
    assert!(rises.contact_force_y > 4e4);
    // The annulus is not lifted, so that its inertia makes a difference while the motion lasts.
    assert!((rises.contact_force_y / sinks.contact_force_y - 1.0).abs() < 1e-4);
    assert!((rises.contact_approach - sinks.contact_approach).abs() < 1e-12);
}

#[test]
fn a_warm_wheel_on_a_warm_rail_is_a_cold_one_at_a_warm_reference() {
    let warm = |reference: f64, excess: f64| {
        wheel(|config| {
            config.thermal.enabled = true;
            config.material.expansion = 0.0;
            config.tuning.softening = 0.0;
            config.thermal.hub = Hub::Insulated;
            (config.thermal.reference, config.thermal.wheel_excess) = (reference, excess);
        })
    };
    let [whole, parts] = [(343.0, 0.0), (293.0, 50.0)].map(|(reference, excess)| {
        let model = warm(reference, excess);
        let mut inputs = Inputs::rolling(model.config());
        inputs.drive.temperature = 343.0;
        let mut simulation = Simulation::new(model, &inputs).unwrap();
        for _ in 0..300 {
            inputs.drive.torque = 1e4;
            simulation.advance(&inputs, 1e-3).unwrap();
        }
        simulation.outputs().clone()
    });
    let of = |o: &Outputs| {
        let mean = [o.temperature_wheel_mean, o.temperature_rail_mean, o.temperature_wheel_max, o.temperature_rail_max];
        (mean, [o.heat_to_rail, o.heat_conduction, o.rail_heat, o.friction_power])
    };
    println!("{:?}\n{:?}", of(&whole), of(&parts));
    let ((a, p), (b, q)) = (of(&whole), of(&parts));
    assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-2) && a[3] > 350.0);
    assert!(p.iter().zip(q).all(|(p, q)| (p - q).abs() < 3e-3 * whole.friction_power));
    assert_eq!([whole.rail_heat, whole.t_gamma], [whole.heat_per_metre, whole.rail_energy]);
}

#[test]
fn warm_rail_arrives_with_the_way_and_heats_a_cold_wheel() {
    let model = model(preset("railway", 20));
    let mut inputs = Inputs::rolling(model.config());
    let mut simulation = Simulation::new(model, &inputs).unwrap();
    let cold = simulation.outputs().clone();
    inputs.drive.temperature = 343.0;
    for _ in 0..200 {
        simulation.advance(&inputs, 1e-3).unwrap();
    }
    let o = simulation.outputs();
    println!("{} K, {} K, {} W", o.temperature_rail_mean, o.temperature_rail_max, o.heat_conduction);
    assert!(o.heat_conduction < -1e3 && o.temperature_wheel_mean > cold.temperature_wheel_mean + 10.0);
    assert!(o.temperature_rail_max > 338.0 && o.temperature_rail_max < 344.0);
    println!("residual {:e} per metre {:e}", o.heat_residual, o.heat_per_metre);
    // The heat that the wheel has taken from the rail is in the wheel.
    assert!(o.heat_residual.abs() < 1e-9 && o.heat_per_metre == 0.0);
    // No new rail comes under a wheel that stands.
    let standing = wheel(|config| (config.thermal.enabled, config.initial.velocity) = (true, 0.0));
    let mut inputs = Inputs::rolling(standing.config());
    let mut simulation = Simulation::new(standing, &inputs).unwrap();
    inputs.drive.temperature = 343.0;
    (0..100).for_each(|_| simulation.advance(&inputs, 1e-3).unwrap());
    assert!((simulation.outputs().temperature_rail_mean - 293.0).abs() < 1e-3);
}

/// The parameters of a wheelset, as `docs/coupling.md` gives them.
fn wheelset(config: &mut Config) {
    config.model.contact_width *= 2.0;
    config.model.nominal_load *= 2.0;
    config.wheel.hub_mass *= 2.0;
    config.wheel.hub_inertia *= 2.0;
    config.vehicle.mass *= 2.0;
    config.vehicle.damping *= 2.0;
    config.rail.restraint_stiffness *= 2.0;
    config.rail.restraint_damping *= 2.0;
    let thermal = &mut config.thermal;
    for width in [&mut thermal.rim_width, &mut thermal.web_width, &mut thermal.head_width] {
        *width *= 2.0;
    }
    thermal.block_width *= 2.0;
}

#[test]
fn a_wheelset_is_two_wheels() {
    let [one, two] = [false, true].map(|both| {
        let model = wheel(|config| {
            config.thermal.enabled = true;
            if both {
                wheelset(config);
            }
        });
        let mut inputs = Inputs::rolling(model.config());
        let mut simulation = Simulation::new(model, &inputs).unwrap();
        for _ in 0..300 {
            inputs.drive.torque = if both { 1.6e4 } else { 8e3 };
            simulation.advance(&inputs, 1e-3).unwrap();
        }
        simulation.outputs().clone()
    });
    println!(
        "{} kg, {} kg m²; {} m/s, {} m/s",
        two.wheel_mass, two.wheel_inertia, one.wheel_velocity, two.wheel_velocity
    );
    for (one, two) in [
        (one.contact_force_x, two.contact_force_x),
        (one.contact_force_y, two.contact_force_y),
        (one.brake_power, two.brake_power),
        (one.friction_power, two.friction_power),
        (one.wheel_mass, two.wheel_mass),
        (one.rail_energy, two.rail_energy),
    ] {
        assert!((two / one - 2.0).abs() < 5e-5, "{one} and {two}");
    }
    for (one, two) in [(one.wheel_velocity, two.wheel_velocity), (one.contact_pressure_max, two.contact_pressure_max)] {
        assert!((two / one - 1.0).abs() < 1e-6, "{one} and {two}");
    }
    // Heat spreads sideways over lengths that do not double.
    println!(
        "{} W, {} W; {} K, {} K",
        one.heat_to_rail, two.heat_to_rail, one.temperature_wheel_max, two.temperature_wheel_max
    );
    assert!((two.heat_to_rail / one.heat_to_rail - 2.0).abs() < 1e-2);
    assert!((two.temperature_wheel_max - one.temperature_wheel_max).abs() < 0.1);
    assert!((two.temperature_wheel_bulk - one.temperature_wheel_bulk).abs() < 1e-2);
}

/// Largest deviation of the contact force from the load \[N] on a sinusoidal track of the amplitude 0.1 mm and the wave 1 m at
/// 20 m/s, in the second half of half a second in steps of `h` seconds; with its rates where `given`.
fn force_on_a_wave(h: f64, given: bool) -> (f64, bool) {
    let model = wheel(|config| config.initial.velocity = 20.0);
    let mut inputs = Inputs::rolling(model.config());
    let mut simulation = Simulation::new(model, &inputs).unwrap();
    let (mut worst, mut told, frequency): (f64, _, _) = (0.0, false, 2.0 * PI * 20.0);
    for k in 1..=(0.5 / h).round() as u32 {
        let phase = frequency * h * f64::from(k);
        inputs.drive.elevation = 1e-4 * (1.0 - phase.cos());
        inputs.drive.elevation_rate = if given { 1e-4 * frequency * phase.sin() } else { 0.0 };
        simulation.advance(&inputs, h).unwrap();
        told |= simulation.exceeded_limits().any(|limit| limit == Limit::Track);
        if phase > 0.25 * frequency {
            let [low, high] = [simulation.outputs().contact_force_min, simulation.outputs().contact_force_max];
            worst = worst.max((low - 1e5).abs()).max((high - 1e5).abs());
        }
    }
    (worst, told)
}

#[test]
fn a_track_loads_the_wheel_alike_in_steps_of_one_and_five_milliseconds_or_tells_that_it_does_not() {
    let (exact, _) = force_on_a_wave(2.5e-4, true);
    for (h, given) in [(1e-3, false), (2e-3, false), (1e-3, true), (5e-3, true)] {
        let (force, told) = force_on_a_wave(h, given);
        println!("steps of {h} s, rates given: {given}: {force} N, in short steps {exact} N");
        assert!((force / exact - 1.0).abs() < 0.05 && !told);
    }
    let (force, told) = force_on_a_wave(5e-3, false);
    println!("steps of 0.005 s without rates: {force} N");
    // Corners would make it 8.4 kN.
    assert!(told && force < 4.2e3);
}

/// Contact forces \[N] and the number of internal steps of a wheel on waves of 2.5 mm that pass with 2.7 Hz, from 0.2 s on,
/// every 10 ms, in steps of `h` seconds; with their rates where `given`.
fn on_long_waves(h: f64, given: bool) -> (Vec<f64>, u64) {
    let model = wheel(|config| config.initial.velocity = 20.0);
    let mut inputs = Inputs::rolling(model.config());
    let mut simulation = Simulation::new(model, &inputs).unwrap();
    let (frequency, each, mut forces, mut steps) = (17.0, (1e-2 / h).round() as usize, Vec::new(), 0);
    for k in 1..=100 * each {
        let phase = frequency * h * k as f64;
        inputs.drive.elevation = 2.5e-3 * (1.0 - phase.cos());
        inputs.drive.elevation_rate = if given { 2.5e-3 * frequency * phase.sin() } else { 0.0 };
        simulation.advance(&inputs, h).unwrap();
        steps += simulation.outputs().internal_steps;
        if k % each == 0 && k > 20 * each {
            forces.push(simulation.outputs().contact_force_y - 1e5);
        }
    }
    (forces, steps)
}

#[test]
fn a_smooth_track_in_steps_of_ten_milliseconds_takes_half_as_many_internal_steps_again_without_rates() {
    let (exact, _) = on_long_waves(5e-4, true);
    let amplitude = exact.iter().fold(0.0f64, |most, force| most.max(force.abs()));
    let [(given, steps_given), (found, steps_found)] = [true, false].map(|given| on_long_waves(1e-2, given));
    let error = |forces: &[f64]| {
        let squares: f64 = forces.iter().zip(&exact).map(|(a, b)| (a - b).powi(2)).sum();
        (squares / exact.len() as f64).sqrt() / amplitude
    };
    let errors = [error(&given), error(&found)];
    println!(
        "rms errors over the amplitude of {amplitude} N: {errors:.3?}, internal steps {steps_given}, {steps_found}"
    );
    assert!(steps_found as f64 <= 1.6 * steps_given as f64);
    assert!(errors.iter().all(|error| *error < 0.03));
}

/// Contact forces every 10 ms \[N] of a wheel of a preset on the same track, which passes under it at 20 m/s whatever its own
/// speed is, in steps of `h` seconds with rates; its moment and the friction change a little in every step where they `vary`.
fn forces_on_a_wave(name: &str, velocity: f64, vary: bool, h: f64) -> Vec<f64> {
    let mut config = shipped(name);
    config.initial.velocity = velocity;
    config.mesh.elements_per_half_width = 8;
    let model = model(config);
    let mut inputs = Inputs::rolling(model.config());
    let mut simulation = Simulation::new(model, &inputs).unwrap();
    let (frequency, each) = (2.0 * PI * 20.0, (1e-2 / h).round() as usize);
    let mut forces = Vec::new();
    for k in 1..=30 * each {
        let t = h * k as f64;
        inputs.drive.elevation = 1e-4 * (1.0 - (frequency * t).cos());
        inputs.drive.elevation_rate = 1e-4 * frequency * (frequency * t).sin();
        if vary {
            inputs.drive.moment = -2000.0 * (30.0 * t).sin();
            inputs.drive.friction = 0.2 + 0.02 * (40.0 * t).sin();
        }
        simulation.advance(&inputs, h).unwrap();
        if k % each == 0 {
            forces.push(simulation.outputs().contact_force_y);
        }
    }
    forces
}

#[test]
fn a_track_loads_wheels_of_every_kind_alike_in_short_and_long_steps() {
    let cases = [
        ("railway", -20.0, false),
        ("railway", 0.0, false),
        ("railway_wet", 20.0, true),
        ("railway_ellipse", 20.0, true),
        ("railway_s1002_3mm", -10.0, true),
        ("railway_damage", 40.0, true),
    ];
    for (name, velocity, vary) in cases {
        let [exact, long] = [2.5e-4, 5e-3].map(|h| forces_on_a_wave(name, velocity, vary, h).split_off(10));
        let (low, high) = range(&exact);
        let error = exact.iter().zip(&long).map(|(exact, long)| (exact - long).abs()).fold(0.0, f64::max);
        println!(
            "{name} at {velocity} m/s, varying: {vary}: {low:.0} to {high:.0} N, steps of 5 ms are off by {error:.0} N"
        );
        assert!(high - low > 800.0 && error < 0.1 * (high - low), "{name} at {velocity} m/s");
    }
}
