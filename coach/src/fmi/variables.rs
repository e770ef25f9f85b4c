//! All variables: parameters from 1000 on, inputs of axle k from 100 k on, outputs to it from 100 k + 50 on.

use super::variable::{Access, Variable};
use crate::AXLES;
use crate::coupling::{Driven, Running, Seen};
use crate::parameters::Parameters;
use wheelrail_slave::Reference;

/// Name, unit, field and meaning of what the outside says of an axle.
type SeenRow = (&'static str, &'static str, fn(&mut Seen) -> &mut f64, &'static str);
const SEEN: [SeenRow; 5] = [
    ("distance", "m", |seen| &mut seen.distance, "Way of the wheelset since the start: wheel.distance"),
    ("velocity", "m/s", |seen| &mut seen.velocity, "Its travel velocity: wheel.velocity"),
    ("omega", "rad/s", |seen| &mut seen.omega, "Its angular velocity: wheel.omega"),
    ("contact_force", "N", |seen| &mut seen.force, "Force of the rail on it: contact.force_x"),
    ("brake_torque", "N.m", |seen| &mut seen.torque, "Moment of its brake, forward positive: brake.torque_actual"),
];

/// Name, unit, field and meaning of what the coach does to an axle.
type DrivenRow = (&'static str, &'static str, fn(&Driven) -> f64, &'static str);
const DRIVEN: [DrivenRow; 3] = [
    ("force", "N", |driven| driven.force, "Mean force of the suspension over the next step: drive.force"),
    (
        "load_change",
        "N",
        |driven| driven.load_change,
        "Mean load beside the static one over the next step: drive.load_change",
    ),
    ("torque", "N.m", |driven| driven.torque, "Strength of the brake during the next step: brake.torque"),
];

/// Name, unit, value and meaning of what the coach tells.
type OutputRow = (&'static str, &'static str, fn(&Running) -> f64, &'static str);
const OUTPUTS: [OutputRow; 5] = [
    ("coach.speed", "m/s", |running| running.motion.body()[0], "Speed of the car body"),
    ("coach.distance", "m", |running| running.motion.body()[1], "Way of the car body since the start"),
    (
        "brake.control_pressure",
        "Pa",
        |running| running.brakes.control,
        "Pressure that the driver asks for, over ambient",
    ),
    (
        "brake.reference_speed",
        "m/s",
        |running| running.brakes.protection.reference,
        "Speed of the train as the slide protection sees it",
    ),
    ("brake.air", "m3", |running| running.brakes.air, "Air let into the cylinders so far, at ambient pressure"),
];

/// Pressures of the cylinders: functions, for a function pointer knows no axle.
const PRESSURES: [fn(&Running) -> f64; AXLES] = [
    |running| running.brakes.pressures[0],
    |running| running.brakes.pressures[1],
    |running| running.brakes.pressures[2],
    |running| running.brakes.pressures[3],
];

const WIDE: [f64; 2] = [-1e12, 1e12];

/// All variables, in the order of the model description. Made anew for each caller: nothing is left when the library is
/// unloaded.
pub fn variables() -> Vec<Variable> {
    let row = |reference, name: String, unit, range, start, text, access| Variable {
        reference,
        name,
        unit,
        range,
        start,
        text,
        access,
    };
    let demand = "Share of the full brake pressure";
    let mut all = vec![row(1, "demand".to_owned(), "1", [0.0, 1.0], 1.0, demand, Access::Demand)];
    for (axle, read) in PRESSURES.into_iter().enumerate() {
        let named = |name: &str| format!("axle{}.{name}", axle + 1);
        let first = 100 * (axle as Reference + 1);
        for (k, (name, unit, field, text)) in (0..).zip(SEEN) {
            all.push(row(first + k, named(name), unit, WIDE, 0.0, text, Access::Seen(axle, field)));
        }
        for (k, (name, unit, field, text)) in (50..).zip(DRIVEN) {
            all.push(row(first + k, named(name), unit, WIDE, 0.0, text, Access::Driven(axle, field)));
        }
        let (pressure, valve) =
            ("Pressure in the cylinder over ambient", "0: follows the control pressure, 1: holds, 2: vents");
        all.push(row(first + 60, named("pressure"), "Pa", WIDE, 0.0, pressure, Access::Output(read)));
        all.push(row(first + 61, named("valve"), "", [0.0, 2.0], 0.0, valve, Access::Valve(axle)));
    }
    for (k, (name, unit, read, text)) in (10..).zip(OUTPUTS) {
        all.push(row(k, name.to_owned(), unit, WIDE, 0.0, text, Access::Output(read)));
    }
    for (k, p) in Parameters::ROWS.iter().enumerate() {
        let reference = 1000 + k as Reference;
        all.push(row(reference, p.name.to_owned(), p.unit, p.range, p.start, p.text, Access::Parameter(k)));
    }
    all
}

/// Variable with the given value reference.
pub fn find(reference: Reference) -> Option<Variable> {
    variables().into_iter().find(|variable| variable.reference == reference)
}
