//! Derivatives of outputs by inputs and by time.

use crate::common::{self, model, prescribed, preset, vary};
use std::sync::Arc;
use wheelrail::contact::line::NodeStatus;
use wheelrail::simulation::{Checkpoint, Drive, Inputs, Model, Outputs, Simulation, Vertical};

type Field = fn(&mut Drive) -> &mut f64;
type Output = fn(&Outputs) -> f64;

/// Inputs with typical sizes.
const INPUTS: [(&str, Field, f64); 8] = [
    ("omega", |d| &mut d.omega, 50.0),
    ("moment", |d| &mut d.moment, 4e4),
    ("velocity", |d| &mut d.velocity, 20.0),
    ("force", |d| &mut d.force, 1e5),
    ("load", |d| &mut d.load, 1e5),
    ("displacement", |d| &mut d.displacement, 1e-4),
    ("friction", |d| &mut d.friction, 0.3),
    ("tread_heat", |d| &mut d.tread_heat, 1e4),
];

/// Outputs with typical sizes.
const OUTPUTS: [(&str, Output, f64); 11] = [
    ("contact.force_x", |o| o.contact_force_x, 3e4),
    ("contact.force_y", |o| o.contact_force_y, 1e5),
    ("contact.moment", |o| o.contact_moment, 1e4),
    ("contact.approach", |o| o.contact_approach, 1e-4),
    ("wheel.velocity", |o| o.wheel_velocity, 20.0),
    ("wheel.omega", |o| o.wheel_omega, 50.0),
    ("hub.moment", |o| o.hub_moment, 1e4),
    ("hub.force_x", |o| o.hub_force_x, 3e4),
    ("heat.friction_power", |o| o.friction_power, 1e3),
    ("temperature.wheel_max", |o| o.temperature_wheel_max, 100.0),
    ("heat.to_rail", |o| o.heat_to_rail, 1e3),
];

/// Thirty steps of 1 ms; returns the simulation, and memory and inputs before the last step.
fn driven(model: &Arc<Model>, mut inputs: Inputs) -> (Simulation, Checkpoint, Inputs) {
    inputs.drive.tread_heat = 1e3;
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    let mut before = simulation.checkpoint().clone();
    for k in 0..30 {
        inputs.drive.moment = -7000.0 * (f64::from(k) / 20.0).min(1.0);
        inputs.drive.omega *= 1.0 - 1e-5;
        inputs.drive.displacement *= 1.0 + 1e-4;
        before = simulation.checkpoint().clone();
        simulation.advance(&inputs, 1e-3).unwrap();
    }
    (simulation, before, inputs)
}

/// Compares with central differences of `again(inputs)`; errors are relative to the derivative or, where that is
/// small, to the typical sizes. Speeds are moved by their size times `speeds`.
fn agree(
    simulation: &mut Simulation,
    inputs: &Inputs,
    relative: f64,
    speeds: f64,
    again: &mut dyn FnMut(&Inputs) -> Outputs,
) {
    let mut largest = 0.0f64;
    for (input, field, size) in INPUTS {
        let mut direction = Drive::default();
        *field(&mut direction) = 1.0;
        let difference = simulation.difference(&direction).unwrap();
        // Small enough to stay between changes of state, which prescribed speeds cross first.
        let step = if matches!(input, "omega" | "velocity") { speeds } else { 1e-4 } * size;
        let [low, high] = [-step, step].map(|by| {
            let mut inputs = *inputs;
            *field(&mut inputs.drive) += by;
            again(&inputs)
        });
        for (output, get, unit) in OUTPUTS {
            let (found, expected) = (difference.quotient(get), (get(&high) - get(&low)) / (2.0 * step));
            let scale = expected.abs().max(unit / size);
            let error = (found - expected).abs() / scale;
            largest = largest.max(error);
            assert!(error < relative, "d {output} / d {input}: {found:e}, differences {expected:e}, error {error:.1e}");
        }
    }
    common::figure("derivatives.step", &[largest]);
    println!("largest error {largest:.1e}");
}

fn derivatives_of_a_step(inputs: impl Fn(&Model) -> Inputs) {
    let model = model(preset("railway", 20));
    let (mut simulation, before, inputs) = driven(&model, inputs(&model));
    let mut again = Simulation::new(model.clone(), &Inputs::rolling(model.config())).unwrap();
    agree(&mut simulation, &inputs, 1e-5, 1e-6, &mut |inputs| {
        again.recall(before.clone()).unwrap();
        again.advance(inputs, 1e-3).unwrap();
        again.outputs().clone()
    });
}

#[test]
fn derivatives_under_moment_and_force_are_those_of_the_repeated_step() {
    derivatives_of_a_step(|model| Inputs::rolling(model.config()));
}

#[test]
fn derivatives_under_prescribed_motion_are_those_of_the_repeated_step() {
    derivatives_of_a_step(|model| {
        let start = Simulation::new(model_of(model), &Inputs::rolling(model.config())).unwrap();
        let mut inputs = prescribed(model, 20.0, 5e-4);
        inputs.vertical = Vertical::Displacement;
        inputs.drive.displacement = -start.outputs().contact_approach;
        inputs
    });
}

/// Shared model.
fn model_of(model: &Model) -> Arc<Model> {
    common::model(model.config().clone())
}

#[test]
fn derivatives_at_the_start_are_those_of_the_stationary_state() {
    let model = model(preset("railway", 20));
    let mut inputs = prescribed(&model, 20.0, 5e-4);
    inputs.drive.tread_heat = 1e3;
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    agree(&mut simulation, &inputs, 3e-4, 1e-6, &mut |inputs| {
        Simulation::new(model.clone(), inputs).unwrap().outputs().clone()
    });
}

#[test]
fn at_the_end_of_a_range_the_derivative_is_one_sided() {
    let mut config = preset("railway", 10);
    config.thermal.cross_section = wheelrail::config::CrossSection::Contact;
    let model = model(config);
    let inputs = prescribed(&model, 20.0, 1e-3);
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    for _ in 0..5 {
        simulation.advance(&inputs, 1e-2).unwrap();
    }
    let direction = Drive { tread_heat: 1.0, ..Drive::default() };
    let difference = simulation.difference(&direction).unwrap();
    assert_eq!(difference.low.wheel_velocity, simulation.outputs().wheel_velocity);
    // One watt for 10 ms in the wheel.
    let config = model.config();
    let area = std::f64::consts::PI * (0.46f64.powi(2) - 0.046f64.powi(2));
    let capacity = area * config.model.contact_width * config.material.density * config.material.specific_heat;
    let warming = difference.quotient(|o| o.temperature_wheel_bulk);
    assert!((warming * capacity / 1e-2 - 1.0).abs() < 0.1, "{warming:e} K/W");
}

#[test]
fn a_derivative_leaves_no_trace() {
    let model = model(preset("railway", 10));
    let (mut simulation, ..) = driven(&model, Inputs::rolling(model.config()));
    let before = simulation.checkpoint().clone();
    let direction = Drive { moment: 1.0, load: 0.5, ..Drive::default() };
    let difference = simulation.difference(&direction).unwrap();
    assert!(difference.quotient(|o| o.contact_force_y) > 0.0);
    assert_eq!(simulation.checkpoint(), &before);
}

#[test]
fn time_derivatives_converge_with_second_order() {
    let mut config = preset("railway", 10);
    config.tuning.max_step = 1e-3;
    let model = model(config);
    // A force that grows steadily: the distance is a cubic of time, its derivative the velocity.
    let error = |h: f64| {
        let mut inputs = Inputs::rolling(model.config());
        inputs.rate.force = -2e4;
        let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
        for _ in 0..(0.64 / h).round() as usize {
            simulation.advance(&inputs, h).unwrap();
            inputs.drive.force += h * inputs.rate.force;
        }
        let travelled = simulation.rate(|o| o.wheel_distance);
        (travelled - simulation.outputs().wheel_velocity).abs()
    };
    let errors = [0.08, 0.04, 0.02].map(error);
    println!("errors {:.2e}, {:.2e}, {:.2e} m/s with 80, 40, 20 ms", errors[0], errors[1], errors[2]);
    assert!(errors[0] < 1e-2);
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((order - 2.0).abs() < 0.2, "order {order:.2}");
    }
}

#[test]
fn at_the_start_time_derivatives_are_those_of_the_stationary_motion() {
    let mut config = preset("railway", 10);
    config.initial.velocity = 15.0;
    let model = model(config);
    let mut inputs = Inputs::rolling(model.config());
    inputs.drive.force = 1e4;
    let simulation = Simulation::new(model.clone(), &inputs).unwrap();
    let o = simulation.outputs();
    assert!(o.wheel_acceleration > 0.1);
    for (found, expected) in [
        (simulation.rate(|o| o.wheel_distance), o.wheel_velocity),
        (simulation.rate(|o| o.wheel_angle), o.wheel_omega),
        (simulation.rate(|o| o.wheel_velocity), o.wheel_acceleration),
        (simulation.rate(|o| o.wheel_omega), o.wheel_angular_acceleration),
        (simulation.rate(|o| o.contact_force_y), 0.0),
    ] {
        assert!((found - expected).abs() < 1e-9 * (1.0 + expected.abs()), "{found} {expected}");
    }
}

/// A step of the second-order formula before and after heat sets in, and the parameters of the step, not of now.
#[test]
fn derivatives_by_heat_that_is_off_and_after_a_tunable_change_are_those_of_the_step() {
    let model = model(preset("railway", 5));
    let mut inputs = Inputs::rolling(model.config());
    inputs.drive.friction = 0.08;
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    inputs.drive.moment = -6000.0;
    for _ in 0..50 {
        simulation.advance(&inputs, 1e-3).unwrap();
    }
    let hottest = |o: &Outputs| o.temperature_wheel_max;
    let heat = Drive { tread_heat: 1.0, ..Drive::default() };
    let by_heat = simulation.difference(&heat).unwrap().quotient(hottest);
    assert!(by_heat.abs() < 1e-6, "a block elsewhere on the tread does not heat the contact at once: {by_heat} K/W");

    let load = Drive { load: 1.0, ..Drive::default() };
    let before = simulation.difference(&load).unwrap().quotient(|o| o.contact_force_x);
    let mut config = model.config().clone();
    (config.tuning.falling_ratio, config.tuning.falling_decay, config.tuning.max_step) = (0.5, 0.5, 1e-4);
    simulation.retune(&config.tuning);
    assert_eq!(simulation.difference(&load).unwrap().quotient(|o| o.contact_force_x), before);
}

/// Patches of several lines with moment and load varying: their lines follow the load, and the derivatives by it are those of
/// the repeated step.
#[test]
fn derivatives_of_patches_by_load_and_moment_are_those_of_the_repeated_step() {
    let patch: [(&str, Output, f64); 2] = [
        ("contact.pressure_max", |o| o.contact_pressure_max, 1e9),
        ("contact.half_width", |o| o.contact_half_width, 6e-3),
    ];
    for name in ["railway_ellipse", "railway_s1002_0mm", "railway_s1002_3mm"] {
        let model = model(preset(name, 10));
        let mut inputs = Inputs::rolling(model.config());
        let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
        let mut again = Simulation::new(model.clone(), &inputs).unwrap();
        let (mut largest, mut kinks) = (0.0_f64, 0);
        for k in 0..73 {
            inputs.drive.moment = -3e3 * (0.1 * f64::from(k)).sin();
            inputs.drive.load = 1e5 * (1.0 + 0.1 * (0.3 * f64::from(k)).sin());
            let before = simulation.checkpoint().clone();
            simulation.advance(&inputs, 1e-3).unwrap();
            // At first there is no force, and both directions of slip are as near.
            let inputs_varied = INPUTS.into_iter().filter(|(input, ..)| k > 0 && matches!(*input, "load" | "moment"));
            for (input, field, size) in inputs_varied {
                let mut direction = Drive::default();
                *field(&mut direction) = 1.0;
                let difference = simulation.difference(&direction).unwrap();
                let [low, middle, high] = [-1e-5, 0.0, 1e-5].map(|by| {
                    let mut inputs = inputs;
                    *field(&mut inputs.drive) += by * size;
                    again.recall(before.clone()).unwrap();
                    again.advance(&inputs, 1e-3).unwrap();
                    again.outputs().clone()
                });
                for (output, get, unit) in OUTPUTS.into_iter().take(3).chain(patch) {
                    let (found, expected) = (difference.quotient(get), (get(&high) - get(&low)) / (2e-5 * size));
                    let sides = [get(&middle) - get(&low), get(&high) - get(&middle)].map(|side| side / (1e-5 * size));
                    let error = |expected: f64| (found - expected).abs() / expected.abs().max(unit / size);
                    // Near a kink of the repeated step the derivative is that of one side.
                    let kinked = error(expected) >= 5e-6;
                    let error = if kinked { error(sides[0]).min(error(sides[1])) } else { error(expected) };
                    kinks += usize::from(kinked);
                    largest = largest.max(error);
                    assert!(
                        error < if kinked { 2e-4 } else { 5e-6 },
                        "{name}, {k}: d {output} / d {input}: {found:e}, {expected:e}, {error:.1e}"
                    );
                }
            }
        }
        println!("{name}: largest error {largest:.1e}, {kinks} at kinks");
        assert!(kinks <= 12);
    }
}

/// States of all nodes on all lines.
fn node_states(simulation: &Simulation) -> Vec<NodeStatus> {
    let lines = simulation.state().lines.iter();
    lines.flat_map(|line| line.contact.grid.status.clone()).collect()
}

/// Several lines with everything varying: rounding of the forces that lines give to each other does not show. Measured:
/// 8.9e-5 at most, and within 1e-5 but for a few pairs.
#[test]
fn derivatives_with_everything_varying_are_those_of_the_repeated_step() {
    let model = model(preset("railway_ellipse", 10));
    let mut inputs = Inputs::rolling(model.config());
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    let mut again = Simulation::new(model.clone(), &inputs).unwrap();
    let (mut largest, mut compared, mut beyond) = (0.0_f64, 0, 0);
    for k in 1..=25 {
        vary(&mut inputs, 1e-3 * f64::from(k));
        let before = simulation.checkpoint().clone();
        simulation.advance(&inputs, 1e-3).unwrap();
        let states = node_states(&simulation);
        let varied = |input: &str| matches!(input, "load" | "moment" | "force" | "friction");
        for (input, field, size) in INPUTS.into_iter().filter(|(input, ..)| k > 2 && varied(input)) {
            let mut direction = Drive::default();
            *field(&mut direction) = 1.0;
            let difference = simulation.difference(&direction).unwrap();
            let mut same = true;
            let [low, high] = [-1e-5, 1e-5].map(|by| {
                let mut inputs = inputs;
                *field(&mut inputs.drive) += by * size;
                again.recall(before.clone()).unwrap();
                again.advance(&inputs, 1e-3).unwrap();
                same &= node_states(&again) == states;
                again.outputs().clone()
            });
            // Between other states of nodes the solution has a kink, and heat where an edge passes a node of the temperatures:
            // there the derivative is that of one side.
            let now = simulation.outputs();
            for (output, get, unit) in OUTPUTS.into_iter().filter(|_| same) {
                let (found, expected) = (difference.quotient(get), (get(&high) - get(&low)) / (2e-5 * size));
                let sides = [get(now) - get(&low), get(&high) - get(now)].map(|side| side / (1e-5 * size));
                let missed = |expected: f64| (found - expected).abs() / expected.abs().max(unit / size);
                let error = sides.into_iter().map(missed).fold(missed(expected), f64::min);
                (largest, compared, beyond) = (largest.max(error), compared + 1, beyond + usize::from(error >= 1e-5));
                assert!(error < 2e-3, "{k}: d {output} / d {input}: {found:e}, {expected:e}, {error:.1e}");
            }
        }
    }
    println!("largest error {largest:.1e} of {compared}, {beyond} beyond 1e-5");
    assert!(compared > 900 && beyond <= 12);
}

/// Everything varying on patches: where an edge passes a node of the temperatures, the heat into the rail has a kink, to
/// which no perturbation of a derivative reaches. Measured: 7e-7, and 4e-5 where one side decides otherwise, so that the
/// derivative is that of the other side; across the kink 8e-4.
#[test]
fn derivatives_of_the_heat_into_the_rail_do_not_reach_across_elements() {
    let mut config = preset("railway_s1002_0mm", 10);
    config.tuning.tolerance = 0.0;
    let model = model(config);
    let mut inputs = Inputs::rolling(model.config());
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    let mut again = Simulation::new(model.clone(), &inputs).unwrap();
    let load = Drive { load: 1.0, ..Drive::default() };
    let mut largest = 0.0_f64;
    for k in 1..=25 {
        vary(&mut inputs, 1e-3 * f64::from(k));
        let before = simulation.checkpoint().clone();
        simulation.advance(&inputs, 1e-3).unwrap();
        let found = simulation.difference(&load).unwrap().quotient(|o| o.heat_to_rail);
        let [low, high] = [-1.0, 1.0].map(|by| {
            let mut inputs = inputs;
            inputs.drive.load += by;
            again.recall(before.clone()).unwrap();
            again.advance(&inputs, 1e-3).unwrap();
            again.outputs().heat_to_rail
        });
        let expected = 0.5 * (high - low);
        let error = (found - expected).abs() / expected.abs().max(1e-2);
        largest = largest.max(error);
        assert!(error < 1e-4, "{k}: {found:e}, differences {expected:e}, {error:.1e}");
    }
    println!("largest error {largest:.1e}");
}
