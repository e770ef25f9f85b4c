//! States of a wheel that touches in an ellipse: whatever is repeated, restored or read back goes on bit for bit, a
//! step that fails changes nothing, derivatives are those of repeated runs, and no momentum is lost.

use crate::common::*;
use std::sync::Arc;
use wheelrail::config::Config;
use wheelrail::simulation::{Checkpoint, Drive, Inputs, Model, Outputs, Rotation, Simulation, Vertical};

/// The preset with a number of lines and of elements per half axis.
fn ellipse(lines: usize, elements: usize, heat: bool) -> Config {
    let mut config = preset("railway_ellipse", elements);
    config.contact.lines = lines;
    config.thermal.enabled = heat;
    config
}

fn bytes(simulation: &Simulation) -> Vec<u8> {
    postcard::to_stdvec(simulation.checkpoint()).unwrap()
}

/// Inputs of every step of a run.
type Course = fn(&mut Inputs, usize);

/// A run whose states are saved in its midst.
struct Run {
    name: &'static str,
    config: Config,
    course: Course,
    step: f64,
    /// Steps before a state is saved, and after it.
    steps: [usize; 2],
}

fn braked(inputs: &mut Inputs, k: usize) {
    let t = k as f64;
    inputs.drive.moment = -6000.0 * (t / 10.0).min(1.0);
    inputs.drive.load = 1e5 * (1.0 + 0.1 * (0.4 * t).sin());
    inputs.drive.temperature = 293.0 + t;
}

fn locked(inputs: &mut Inputs, k: usize) {
    let at_first = Inputs::rolling(&shipped("railway_ellipse")).drive.omega;
    inputs.rotation = Rotation::Velocity;
    inputs.drive.omega = at_first * (1.0 - k as f64 / 12.0).max(0.0);
}

/// Load that ceases, and comes back twice as large: the wheel flies for some milliseconds and lands in the eighth.
fn landing(inputs: &mut Inputs, k: usize) {
    inputs.drive.load = if k <= 5 { 0.0 } else { 2e5 };
}

fn runs() -> [Run; 5] {
    let mut flat = ellipse(7, 6, true);
    flat.wheel.profile = "flat(position = 0.05, length = 0.02)".to_owned();
    let mut soft = ellipse(7, 6, true);
    soft.material.yield_strength = 300e6;
    let run = |name, config, course, step, steps| Run { name, config, course, step, steps };
    [
        run("rolling", ellipse(7, 10, true), braked, 1e-3, [20, 20]),
        run("locked, hot", ellipse(7, 6, true), locked, 1e-3, [20, 10]),
        run("on a flat", flat, braked, 2e-4, [12, 10]),
        run("yielding", soft, braked, 1e-3, [8, 8]),
        run("landing", ellipse(7, 6, true), landing, 1e-3, [8, 2]),
    ]
}

#[test]
fn a_run_repeated_from_a_saved_or_serialised_state_is_the_first_bit_for_bit() {
    for Run { name, config, course, step, steps: [before, after] } in runs() {
        let model = model(config);
        let mut inputs = Inputs::rolling(model.config());
        let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
        for k in 1..=before {
            course(&mut inputs, k);
            simulation.advance(&inputs, step).unwrap_or_else(|error| panic!("{name}, step {k}: {error}"));
        }
        let (saved, text) = (simulation.checkpoint().clone(), bytes(&simulation));
        let o = simulation.outputs().clone();
        println!("{name}: {} kB, {:.0} K, yielded {:.2}", text.len() / 1024, o.temperature_wheel_max, o.yielded);
        assert_eq!(simulation.state().lines.len(), 4, "{name}");
        let go_on = |simulation: &mut Simulation| {
            let mut inputs = *simulation.latest_inputs();
            let mut all = Vec::new();
            for k in before + 1..=before + after {
                course(&mut inputs, k);
                simulation.advance(&inputs, step).unwrap();
                all.push(bytes(simulation));
            }
            (all, simulation.outputs().clone())
        };
        let first = go_on(&mut simulation);
        simulation.recall(saved).unwrap();
        assert_eq!(simulation.outputs(), &o, "{name}");
        assert!(go_on(&mut simulation) == first, "{name}: recalled");
        let read: Checkpoint = postcard::from_bytes(&text).unwrap();
        let mut resumed = Simulation::resume(model, simulation.tuning().clone(), read).unwrap();
        assert!(bytes(&resumed) == text && go_on(&mut resumed) == first, "{name}: read back");
    }
}

/// A state belongs to a number of lines; one with others, or without, is refused.
#[test]
fn a_state_of_another_number_of_lines_is_refused() {
    let [five, seven] = [5, 7].map(|lines| model(ellipse(lines, 10, false)));
    let line = model(preset("railway", 10));
    let simulation = Simulation::new(five.clone(), &Inputs::rolling(five.config())).unwrap();
    for other in [seven, line] {
        let checkpoint = simulation.checkpoint().clone();
        assert!(Simulation::resume(other, simulation.tuning().clone(), checkpoint).is_err());
    }
}

#[test]
fn a_step_that_fails_leaves_no_trace() {
    for Run { name, config, course, step, steps: [before, _], .. } in runs() {
        let model = model(config);
        let mut inputs = Inputs::rolling(model.config());
        let [mut simulation, mut other] = [(); 2].map(|()| Simulation::new(model.clone(), &inputs).unwrap());
        let limit = before.min(15);
        for k in 1..=limit {
            course(&mut inputs, k);
            if k + 3 >= limit {
                let (state, outputs) = (bytes(&simulation), simulation.outputs().clone());
                let mut hopeless = inputs;
                hopeless.drive.load = 1e4 * model.config().model.nominal_load;
                assert!(simulation.advance(&hopeless, step).is_err(), "{name}");
                assert!(bytes(&simulation) == state && simulation.outputs() == &outputs, "{name}, step {k}");
            }
            [&mut simulation, &mut other].into_iter().for_each(|simulation| simulation.advance(&inputs, step).unwrap());
            assert!(bytes(&simulation) == bytes(&other), "{name}, step {k}");
        }
    }
}

type Field = fn(&mut Drive) -> &mut f64;
type Output = fn(&Outputs) -> f64;

/// Inputs with typical sizes.
const INPUTS: [(&str, Field, f64); 9] = [
    ("omega", |d| &mut d.omega, 50.0),
    ("moment", |d| &mut d.moment, 4e4),
    ("velocity", |d| &mut d.velocity, 20.0),
    ("force", |d| &mut d.force, 1e5),
    ("load", |d| &mut d.load, 1e5),
    ("displacement", |d| &mut d.displacement, 1e-4),
    ("friction", |d| &mut d.friction, 0.3),
    ("tread_heat", |d| &mut d.tread_heat, 1e4),
    ("temperature", |d| &mut d.temperature, 100.0),
];

/// Outputs with typical sizes.
const OUTPUTS: [(&str, Output, f64); 13] = [
    ("contact.force_x", |o| o.contact_force_x, 3e4),
    ("contact.force_y", |o| o.contact_force_y, 1e5),
    ("contact.moment", |o| o.contact_moment, 1e4),
    ("contact.approach", |o| o.contact_approach, 1e-4),
    ("contact.pressure_max", |o| o.contact_pressure_max, 1e9),
    ("contact.half_width", |o| o.contact_half_width, 6e-3),
    ("wheel.velocity", |o| o.wheel_velocity, 20.0),
    ("wheel.omega", |o| o.wheel_omega, 50.0),
    ("hub.moment", |o| o.hub_moment, 1e4),
    ("hub.force_x", |o| o.hub_force_x, 3e4),
    ("heat.friction_power", |o| o.friction_power, 1e3),
    ("temperature.wheel_max", |o| o.temperature_wheel_max, 100.0),
    ("heat.to_rail", |o| o.heat_to_rail, 1e3),
];

/// Compares derivatives with central differences of `again(inputs)`; returns the largest error, relative to the
/// derivative or, where that is small, to the typical sizes, with the names of what is differentiated by what.
fn derivatives(
    simulation: &mut Simulation,
    inputs: &Inputs,
    shares: [f64; 2],
    again: &mut dyn FnMut(&Inputs) -> Outputs,
) -> (f64, String) {
    let mut largest = (0.0, String::new());
    for (input, field, size) in INPUTS {
        let mut direction = Drive::default();
        *field(&mut direction) = 1.0;
        let difference = simulation.difference(&direction).unwrap();
        // Small enough to stay between changes of state, which prescribed speeds cross first.
        let step = shares[usize::from(matches!(input, "omega" | "velocity"))] * size;
        let [low, high] = [-step, step].map(|by| {
            let mut inputs = *inputs;
            *field(&mut inputs.drive) += by;
            again(&inputs)
        });
        for (output, get, unit) in OUTPUTS {
            let (found, expected) = (difference.quotient(get), (get(&high) - get(&low)) / (2.0 * step));
            let error = (found - expected).abs() / expected.abs().max(unit / size);
            if error > largest.0 {
                largest = (error, format!("d {output} / d {input}: {found:e} {expected:e}"));
            }
        }
    }
    largest
}

fn of_a_step(config: Config, inputs: impl Fn(&Arc<Model>) -> Inputs, steps: usize, moment: f64) -> (f64, String) {
    let model = model(config);
    let mut inputs = inputs(&model);
    inputs.drive.tread_heat = 1e3;
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    let mut before = simulation.checkpoint().clone();
    for k in 0..steps {
        inputs.drive.moment = moment * (k as f64 / (0.6 * steps as f64)).min(1.0);
        inputs.drive.omega *= 1.0 - 1e-5;
        inputs.drive.displacement *= 1.0 + 1e-4;
        before = simulation.checkpoint().clone();
        simulation.advance(&inputs, 1e-3).unwrap();
    }
    let mut again = Simulation::new(model.clone(), &Inputs::rolling(model.config())).unwrap();
    derivatives(&mut simulation, &inputs, [1e-4, 1e-6], &mut |inputs| {
        again.recall(before.clone()).unwrap();
        again.advance(inputs, 1e-3).unwrap();
        again.outputs().clone()
    })
}

/// Wheel and height of the hub prescribed.
fn held(model: &Arc<Model>) -> Inputs {
    let start = Simulation::new(model.clone(), &Inputs::rolling(model.config())).unwrap();
    let mut inputs = prescribed(model, 20.0, 5e-4);
    inputs.vertical = Vertical::Displacement;
    inputs.drive.displacement = -start.outputs().contact_approach;
    inputs
}

/// Measured: 3e-8 under moment and force; 1e-5 to 1.3e-4 where speeds are prescribed with slips of 5e-4 to 5.7e-4, whose
/// derivatives are taken over 2 % of the slip.
#[test]
fn derivatives_are_those_of_the_repeated_step() {
    let rolling = |model: &Arc<Model>| Inputs::rolling(model.config());
    for (name, (error, of), tolerance) in [
        ("moment and force", of_a_step(ellipse(7, 10, true), rolling, 30, -6000.0), 1e-6),
        ("prescribed", of_a_step(ellipse(7, 10, true), held, 30, 0.0), 2e-4),
        ("coarse, moment and force", of_a_step(ellipse(5, 6, true), rolling, 12, -5000.0), 1e-5),
    ] {
        if name == "moment and force" {
            round_off("ellipse.derivatives", &[error], 2e-7);
        }
        println!("{name}: {error:.1e}, {of}");
        assert!(error < tolerance, "{name}: {of}");
    }
}

/// A load within 0.2 % of that for which lines are laid out leaves them their widths: derivatives are those of lines of
/// constant width and constant nodes. Force and approach answer within 1 % as they do beyond, where lines are laid out anew. Pressure, which rises
/// with the square root of the load of a line and the third root of that of an ellipse, does not (1.50 of the
/// difference), nor does the creep force in a single step (0.79).
#[test]
fn derivatives_by_the_load_are_those_across_layouts() {
    let mut config = ellipse(7, 10, false);
    config.tuning.tolerance = 0.0;
    let model = model(config);
    let mut inputs = prescribed(&model, 20.0, -1e-3);
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    let before = simulation.checkpoint().clone();
    simulation.advance(&inputs, 1e-3).unwrap();
    let difference = simulation.difference(&Drive { load: 1.0, ..Drive::default() }).unwrap();
    let at_first = simulation.outputs().clone();
    let step = 1e3;
    let [low, high] = [-step, step].map(|by| {
        simulation.recall(before.clone()).unwrap();
        inputs.drive.load = 1e5 + by;
        simulation.advance(&inputs, 1e-3).unwrap();
        simulation.outputs().clone()
    });
    let ratio = |get: Output| difference.quotient(get) / (get(&high) - get(&low)) * (2.0 * step);
    let found = [
        ratio(|o| o.contact_force_y),
        ratio(|o| o.contact_approach),
        ratio(|o| o.contact_force_x),
        ratio(|o| o.contact_pressure_max),
    ];
    println!("derivatives over differences of 1 %: {found:.4?}");
    assert!(high.contact_width > at_first.contact_width && at_first.contact_width > low.contact_width);
    assert!((found[0] - 1.0).abs() < 1e-2 && (found[1] - 1.0).abs() < 1e-2, "{found:?}");
}

#[test]
fn derivatives_at_the_start_are_those_of_the_stationary_state() {
    let model = model(ellipse(7, 10, true));
    let mut inputs = prescribed(&model, 20.0, 5e-4);
    inputs.drive.tread_heat = 1e3;
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    let (error, of) = derivatives(&mut simulation, &inputs, [1e-4, 1e-6], &mut |inputs| {
        Simulation::new(model.clone(), inputs).unwrap().outputs().clone()
    });
    println!("{error:.1e}, {of}");
    assert!(error < 3e-4, "{of}");
}

/// Momentum that the rail takes from the turning wheel goes to the moving vehicle, with the rolling radius as lever
/// arm. Measured: 1.3e-5 of the impulse.
#[test]
fn lines_that_slip_in_turns_in_both_directions_lose_no_momentum() {
    let mut config = ellipse(5, 10, false);
    config.initial.velocity = 7.0;
    let model = model(config);
    let mut inputs = Inputs::rolling(model.config());
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    let (start, mut impulse) = (simulation.outputs().clone(), 0.0);
    for k in 0..160 {
        inputs.drive.moment = match (k / 10) % 2 {
            _ if k >= 60 => 0.0,
            0 => 6000.0,
            _ => -3000.0,
        };
        simulation.advance(&inputs, 1e-3).unwrap();
        impulse += 1e-3 * inputs.drive.moment;
    }
    let (end, config) = (simulation.outputs(), model.config());
    let moved = (end.wheel_mass + config.vehicle.mass) * (end.wheel_velocity - start.wheel_velocity);
    let turned = end.wheel_inertia * (end.wheel_omega - start.wheel_omega);
    let lost = (moved * config.wheel.radius + turned - impulse) / impulse;
    println!("{lost:.2e} of {impulse:.1} N m s");
    assert!(lost.abs() < 5e-5, "{lost}");
}
