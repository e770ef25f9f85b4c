//! Runs of which valgrind counts the instructions of a step: `make bench NAME=instructions`.
//!
//! With the name of a case it is computed, without one the names are printed.

use std::path::Path;
use wheelrail::fmi::instance::Instance;
use wheelrail::fmi::log::Log;
use wheelrail::fmi::v2::variables::variables;
use wheelrail::fmi::variable::{Kind, Value, Variable};

const STEPS: u32 = 60;
const STEP: f64 = 1e-3;
/// Rounding of times \[s].
const ROUNDING: f64 = 1e-9;
/// About half of the adhesion limit \[N m].
const MOMENT: f64 = -7000.0;
/// Period of what varies \[s].
const PERIOD: f64 = 0.04;

/// Values of inputs at a time \[s].
type Course = fn(f64) -> Vec<(&'static str, f64)>;

/// Name, whether on an ellipse, with heat and sideways, and inputs.
const CASES: [(&str, [bool; 3], Course); 10] = [
    ("line, held", [false, true, false], held),
    ("line, varying", [false, true, false], varying),
    ("line without heat, held", [false, false, false], held),
    ("line without heat, varying", [false, false, false], varying),
    ("line, brake that locks", [false, true, false], locking),
    ("seven lines, varying", [true, true, false], varying),
    ("seven lines without heat, held", [true, false, false], held),
    ("seven lines without heat, varying", [true, false, false], varying),
    ("seven lines sideways without heat, held", [true, false, true], held),
    ("seven lines sideways without heat, swaying", [true, false, true], swaying),
];

/// From −1 to 1 and back within a period.
fn triangle(time: f64) -> f64 {
    1.0 - 4.0 * ((time / PERIOD).rem_euclid(1.0) - 0.5).abs()
}

fn held(_: f64) -> Vec<(&'static str, f64)> {
    vec![("drive.moment", MOMENT), ("brake.torque", 0.0)]
}

fn varying(time: f64) -> Vec<(&'static str, f64)> {
    vec![("drive.moment", MOMENT * (1.0 + 0.3 * triangle(time))), ("brake.torque", 0.0)]
}

fn swaying(time: f64) -> Vec<(&'static str, f64)> {
    vec![("drive.moment", MOMENT), ("drive.lateral_velocity", -0.05 * triangle(time)), ("brake.torque", 0.0)]
}

fn locking(time: f64) -> Vec<(&'static str, f64)> {
    vec![("drive.moment", 0.0), ("brake.torque", if time < 0.02 { 7e3 } else { 4e4 })]
}

fn variable(name: &str) -> &'static Variable {
    variables().iter().find(|variable| variable.name == name).expect(name)
}

/// Sets a variable of any type by text.
fn set(instance: &mut Instance, name: &str, text: &str) {
    let variable = variable(name);
    let value = match variable.kind {
        Kind::Boolean => Value::Boolean(text == "true"),
        Kind::String => Value::String(text.to_owned()),
        _ => Value::Real(text.parse().expect("a number")),
    };
    instance.set(&[variable.reference], vec![value]).expect(name);
}

fn run([ellipse, heat, sideways]: [bool; 3], course: Course) {
    let resources = Path::new(env!("CARGO_MANIFEST_DIR")).join("resources");
    let mut instance = Instance::new(Some(resources), Log::new(Box::new(|_, _, _| {}), false)).expect("an instance");
    instance.setup_experiment(None, 0.0, Some(f64::from(STEPS) * STEP)).expect("an experiment");
    set(&mut instance, "preset", if ellipse { "railway_ellipse" } else { "railway" });
    set(&mut instance, "initial.velocity", "27");
    set(&mut instance, "thermal.enabled", if heat { "true" } else { "false" });
    set(&mut instance, "contact.lateral", if sideways { "true" } else { "false" });
    instance.enter_initialization().expect("a start");
    course(0.0).into_iter().for_each(|(name, value)| set(&mut instance, name, &value.to_string()));
    instance.exit_initialization().expect("a start");
    for k in 0..STEPS {
        let time = f64::from(k) * STEP;
        prescribe(&mut instance, course, time);
        instance.do_step(time, STEP).expect("a step");
    }
}

/// Sets the inputs of a step as ramps.
fn prescribe(instance: &mut Instance, course: Course, time: f64) {
    for ((name, now), (_, then)) in course(time + ROUNDING).into_iter().zip(course(time + STEP - ROUNDING)) {
        let reference = variable(name).reference;
        instance.set(&[reference], vec![Value::Real(now)]).expect(name);
        if now != then {
            instance.set_input_derivatives(&[reference], &[1], &[(then - now) / STEP]).expect(name);
        }
    }
}

fn main() {
    let word = std::env::args().nth(1).unwrap_or_default();
    match CASES.iter().find(|(name, ..)| *name == word) {
        Some((_, kinds, course)) => run(*kinds, *course),
        None => CASES.iter().for_each(|(name, ..)| println!("{name}")),
    }
}
