//! Long braking by blocks, in steps that last from one second to minutes: 45 kW at 70 km/h for 34 min, the drag braking
//! of the European specification for freight wagons (21 ‰ over 40 km).

use crate::common::*;
use wheelrail::config::{Config, CrossSection};
use wheelrail::simulation::{Inputs, Outputs, Rotation, Simulation, Translation};

const SPEED: f64 = 70.0 * KMH;
const POWER: f64 = 45e3;
const DURATION: f64 = 2040.0;

/// Results of a run.
struct Braked {
    end: Outputs,
    /// Energies over the run: of friction, into the rail, into the hub \[J].
    passed: [f64; 3],
    /// Largest residual of the heat balance in a step \[1].
    residual: f64,
    /// Internal steps.
    steps: u64,
}

/// Brakes a cold wheel that rolls with prescribed velocity against the moment of its blocks, in communication steps of
/// `h`.
fn brake(change: impl FnOnce(&mut Config), h: f64) -> Braked {
    let mut config = preset("railway", 10);
    (config.initial.velocity, config.tuning.max_step) = (SPEED, 500.0);
    change(&mut config);
    let mut inputs = Inputs::rolling(&config);
    (inputs.translation, inputs.rotation) = (Translation::Velocity, Rotation::Moment);
    let radius = config.wheel.radius;
    let mut simulation = Simulation::new(model(config), &inputs).unwrap();
    inputs.drive.tread_heat = POWER;
    inputs.drive.moment = -POWER / (SPEED / radius);
    let (mut time, mut passed, mut residual, mut steps) = (0.0, [0.0; 3], 0.0_f64, 0);
    while time < DURATION - 1e-6 {
        let step = h.min(DURATION - time);
        simulation.advance(&inputs, step).unwrap();
        time += step;
        let o = simulation.outputs();
        for (energy, power) in passed.iter_mut().zip([o.friction_power, o.heat_to_rail, o.heat_to_hub]) {
            *energy += step * power;
        }
        residual = residual.max(o.heat_residual.abs());
        steps += o.internal_steps;
    }
    Braked { end: simulation.outputs().clone(), passed, residual, steps }
}

impl Braked {
    /// Mass that has taken at the bulk temperature what blocks and friction have put in and nothing has passed on
    /// \[kg].
    fn mass(&self) -> f64 {
        let [friction, rail, hub] = self.passed;
        (POWER * DURATION + friction - rail - hub) / (self.end.temperature_wheel_bulk - 293.0) / 470.0
    }
}

fn celsius(kelvin: f64) -> f64 {
    kelvin - 273.15
}

/// Literature: 300 to 400 °C. A slice as wide as the contact, the model of a rolling contact alone, becomes too hot.
#[test]
fn drag_braking_heats_the_wheel_to_what_is_observed_whatever_the_step() {
    let reference = brake(|_| (), 1.0);
    let bulk = celsius(reference.end.temperature_wheel_bulk);
    figure_within(0.002, "drag.bulk [°C]", &[bulk]);
    println!("bulk {bulk:.2} °C, {:.1} MJ into the rail, {:.4} kg", 1e-6 * reference.passed[1], reference.mass());
    assert!((250.0..450.0).contains(&bulk));
    // Rim, web and boss as drawn: 322 kg.
    assert!((reference.mass() / 322.0 - 1.0).abs() < 0.05);
    for (h, tolerance) in [(1.0, 0.0), (10.0, 0.0), (100.0, 0.0), (100.0, 0.002), (500.0, 0.002)] {
        let run = brake(|c| c.tuning.tolerance = tolerance, h);
        let off = (celsius(run.end.temperature_wheel_bulk) - bulk) / (bulk - 20.0);
        let rail = run.passed[1] / reference.passed[1] - 1.0;
        round_off("drag.heat", &[run.residual], 1e-12);
        if tolerance == 0.0 && h > 1.0 {
            figure(&format!("drag.step.{h}"), &[off]);
        }
        println!(
            "steps of {h} s, tolerance {tolerance}: bulk {:+.4} %, heat into the rail {:+.3} %, {} internal steps, residual {:.1e}",
            100.0 * off,
            100.0 * rail,
            run.steps,
            run.residual
        );
        assert!(off.abs() < 0.01 && rail.abs() < 0.01 && run.residual < 1e-6);
        let mass = run.mass();
        assert!((mass / reference.mass() - 1.0).abs() < 1e-6, "{mass}");
    }
    let slice = brake(|c| c.thermal.cross_section = CrossSection::Contact, 20.0);
    println!("as wide as the contact: bulk {:.1} °C", celsius(slice.end.temperature_wheel_bulk));
    // Measured: 65 °C hotter, while the rail takes most of the heat.
    assert!(celsius(slice.end.temperature_wheel_bulk) > bulk + 50.0);
}

#[test]
fn air_cools_a_wheel_in_drag_braking() {
    let still = brake(|_| (), 20.0).end.temperature_wheel_bulk;
    let aired = brake(|c| c.thermal.convection = 20.0, 20.0).end.temperature_wheel_bulk;
    println!("bulk {:.1} °C, with 20 W/(m2 K) {:.1} °C", celsius(still), celsius(aired));
    assert!(aired < still - 30.0 && aired > still - 150.0);
}

/// Friction heat, too: a wheel that slides at 2 % creepage, which no step resolves in its turns.
#[test]
fn a_long_slide_does_not_depend_on_the_step() {
    let run = |h: f64| {
        let mut config = preset("railway", 10);
        (config.tuning.max_step, config.tuning.tolerance) = (500.0, 0.0);
        config.material.expansion = 0.0;
        let model = model(config);
        let cold = prescribed(&model, SPEED, 0.0);
        let mut simulation = Simulation::new(model.clone(), &cold).unwrap();
        let inputs = prescribed(&model, SPEED, 0.02);
        // Prescribed motions move linearly within a step: the slide begins in a short one.
        simulation.advance(&inputs, 1e-2).unwrap();
        (0..(1000.0 / h) as u32).for_each(|_| simulation.advance(&inputs, h).unwrap());
        let o = simulation.outputs();
        assert!(o.heat_residual.abs() < 1e-6);
        [
            o.temperature_wheel_bulk - 293.0,
            o.temperature_wheel_max - 293.0,
            o.temperature_rail_max - 293.0,
            o.heat_to_rail,
        ]
    };
    let reference = run(1.0);
    println!("1 s: {reference:?}");
    for h in [10.0, 100.0] {
        let found = run(h);
        println!("{h} s: {found:?}");
        for (a, b) in found.iter().zip(reference) {
            assert!((a / b - 1.0).abs() < 0.01, "{a} against {b}");
        }
    }
}

/// Steel so hot yields, and its pressure moves the lever arms of the moment in every step.
#[test]
fn long_steps_on_hot_yielding_steel_keep_their_energy() {
    let (power, step) = (65e3, 10.0);
    let mut config = preset("railway", 10);
    (config.initial.velocity, config.tuning.max_step, config.thermal.wheel_excess) = (SPEED, 500.0, 655.0);
    let radius = config.wheel.radius;
    let mut inputs = Inputs::rolling(&config);
    (inputs.translation, inputs.rotation) = (Translation::Velocity, Rotation::Moment);
    (inputs.drive.tread_heat, inputs.drive.moment) = (power, -power / (SPEED / radius));
    let mut simulation = Simulation::new(model(config), &inputs).unwrap();
    let missing = |o: &Outputs| {
        o.hub_work + o.thermal_work - o.stored_energy - o.friction_energy - o.damping_energy - o.plastic_energy
    };
    let (mut before, mut worst) = (missing(simulation.outputs()), 0.0_f64);
    for _ in 0..40 {
        simulation.advance(&inputs, step).unwrap();
        let now = missing(simulation.outputs());
        worst = worst.max((now - before).abs());
        before = now;
    }
    let o = simulation.outputs();
    println!("{worst} J of {} J in a step, {before} J in all; yielded {}", power * step, o.yielded);
    assert!(o.yielded > 0.9 && worst < 1e-4 * power * step);
}

/// A wheel whose tread is hotter than 400 °C grows with its bulk in steps of a second, and nothing of the growth is
/// kept back until a short step comes and presses the wheel onto the rail.
#[test]
fn a_hot_wheel_grows_with_its_bulk_in_long_steps_and_bears_its_load() {
    let (power, step) = (65e3, 1.0);
    let mut config = preset("railway", 10);
    (config.initial.velocity, config.tuning.max_step) = (SPEED, 500.0);
    let (radius, expansion) = (config.wheel.radius, config.material.expansion);
    let mut inputs = Inputs::rolling(&config);
    (inputs.translation, inputs.rotation) = (Translation::Velocity, Rotation::Moment);
    (inputs.drive.tread_heat, inputs.drive.moment) = (power, -power / (SPEED / radius));
    let mut simulation = Simulation::new(model(config), &inputs).unwrap();
    let start = simulation.outputs().clone();
    let mut most = 0.0_f64;
    for _ in 0..(2000.0 / step) as usize {
        simulation.advance(&inputs, step).unwrap();
        most = most.max(simulation.outputs().contact_force_max);
    }
    let o = simulation.outputs();
    let warmer = o.temperature_wheel_bulk - start.temperature_wheel_bulk;
    let growth = (o.thermal_growth - start.thermal_growth) / (expansion * radius * warmer);
    let missing =
        o.hub_work + o.thermal_work - o.stored_energy - o.friction_energy - o.damping_energy - o.plastic_energy;
    println!(
        "steps of {step} s: {warmer:.1} K warmer, growth over that of the bulk {growth:.4}, load at most {most:.0} N, \
             {missing:.1} J missing, residual {:.1e}",
        o.energy_residual
    );
    assert!(warmer > 400.0 && (growth - 1.0).abs() < 0.01 && most < 1.02e5, "{growth} {most}");
    // Measured: .45 % of what friction has dissipated; 1.8 % while the grown circle had the lever arms of the cold one.
    assert!(missing.abs() < 0.01 * o.friction_energy, "{missing}");
}

/// On a wheel that has grown by half a percent, pressure that yielding steel has moved off the middle passes through the
/// centre, too, and spends nothing on turning it. Measured: .19 and .005 % of what friction dissipates are missing; with the
/// arms of the cold circle 12 % on the line.
#[test]
fn pressure_off_the_middle_of_a_hot_yielding_patch_does_not_turn_the_wheel() {
    let (power, step) = (65e3, 5.0);
    for name in ["railway", "railway_ellipse"] {
        let mut config = preset(name, 10);
        (config.initial.velocity, config.tuning.max_step, config.thermal.wheel_excess) = (SPEED, 500.0, 620.0);
        let radius = config.wheel.radius;
        let mut inputs = Inputs::rolling(&config);
        (inputs.translation, inputs.rotation) = (Translation::Velocity, Rotation::Moment);
        (inputs.drive.tread_heat, inputs.drive.moment) = (power, -power / (SPEED / radius));
        let mut simulation = Simulation::new(model(config), &inputs).unwrap();
        let terms = |o: &Outputs| {
            let missing =
                o.hub_work + o.thermal_work - o.stored_energy - o.friction_energy - o.damping_energy - o.plastic_energy;
            [missing, o.friction_energy]
        };
        (0..20).for_each(|_| simulation.advance(&inputs, step).unwrap());
        let before = terms(simulation.outputs());
        (0..40).for_each(|_| simulation.advance(&inputs, step).unwrap());
        let after = terms(simulation.outputs());
        let [missing, friction] = [0, 1].map(|k| after[k] - before[k]);
        println!("{name}: {missing:.2} J of {friction:.1} J missing; yielded {}", simulation.outputs().yielded);
        assert!(simulation.outputs().yielded > 0.5 && missing.abs() < 0.005 * friction);
    }
}

/// Steel of 960 K gives way from edge to edge of the patch, so that a change of many nodes at once goes in circles: the
/// search ends node by node.
#[test]
fn a_patch_that_yields_from_edge_to_edge_is_found_in_long_steps() {
    let power = 65e3;
    let run = |step: f64| {
        let mut config = preset("railway", 10);
        (config.initial.velocity, config.tuning.max_step) = (SPEED, 500.0);
        let radius = config.wheel.radius;
        let mut inputs = Inputs::rolling(&config);
        (inputs.translation, inputs.rotation) = (Translation::Velocity, Rotation::Moment);
        (inputs.drive.tread_heat, inputs.drive.moment) = (power, -power / (SPEED / radius));
        let mut simulation = Simulation::new(model(config), &inputs).unwrap();
        for _ in 0..(2100.0 / step) as usize {
            simulation.advance(&inputs, step).unwrap();
        }
        let o = simulation.outputs();
        println!(
            "steps of {step} s: {} K, yielded {}, {} Pa",
            o.temperature_wheel_bulk, o.yielded, o.contact_pressure_max
        );
        [o.temperature_wheel_bulk - 293.0, o.yielded, o.contact_pressure_max]
    };
    let reference = run(1.0);
    assert!(reference[1] > 0.9);
    for step in [10.0, 20.0] {
        for (found, reference) in run(step).iter().zip(reference) {
            assert!((found / reference - 1.0).abs() < 0.01, "{step}: {found} for {reference}");
        }
    }
}
