//! Derivatives through the C interface: by inputs, and by time.

use crate::slave::{Slave, load, variable};
use libfmi::fmi2Status::{fmi2Error, fmi2OK};
use libfmi::{fmi2FMUstate, fmi2Status};
use std::ptr;
use wheelrail::fmi::v2::variables::variables;
use wheelrail::fmi::variable::{Causality, Kind};

fn references(names: &[&str]) -> Vec<u32> {
    names.iter().map(|name| variable(name).reference).collect()
}

/// Derivatives of the unknowns along the direction.
fn directional(slave: &Slave, unknown: &[&str], direction: &[(&str, f64)]) -> Result<Vec<f64>, fmi2Status> {
    let known: Vec<_> = direction.iter().map(|(name, _)| variable(name).reference).collect();
    let seed: Vec<_> = direction.iter().map(|(_, seed)| *seed).collect();
    let (unknown, mut result) = (references(unknown), vec![f64::NAN; unknown.len()]);
    let status = unsafe {
        slave.dll.fmi2GetDirectionalDerivative(
            slave.component,
            unknown.as_ptr(),
            unknown.len(),
            known.as_ptr(),
            known.len(),
            seed.as_ptr(),
            result.as_mut_ptr(),
        )
    };
    if status == fmi2OK { Ok(result) } else { Err(status) }
}

fn output_derivatives(slave: &Slave, names: &[&str], order: i32) -> Result<Vec<f64>, fmi2Status> {
    let (references, orders) = (references(names), vec![order; names.len()]);
    let mut values = vec![f64::NAN; names.len()];
    let status = unsafe {
        slave.dll.fmi2GetRealOutputDerivatives(
            slave.component,
            references.as_ptr(),
            names.len(),
            orders.as_ptr(),
            values.as_mut_ptr(),
        )
    };
    if status == fmi2OK { Ok(values) } else { Err(status) }
}

const OUTPUTS: [&str; 4] = ["contact.force_x", "contact.force_y", "wheel.velocity", "wheel.omega"];

/// Outputs after the step from the saved state with these inputs.
fn stepped(slave: &Slave, state: fmi2FMUstate, inputs: &[(&str, f64)]) -> Vec<f64> {
    assert_eq!(slave.restore(state), fmi2OK);
    for (name, value) in inputs {
        assert_eq!(slave.set_real(name, *value), fmi2OK);
    }
    assert_eq!(slave.step(0.02, 1e-3), fmi2OK);
    slave.get_reals(&references(&OUTPUTS)).unwrap()
}

#[test]
fn directional_derivatives_are_those_of_the_last_step() {
    let dll = load();
    let slave = Slave::ready(&dll);
    for k in 0..20 {
        assert_eq!(slave.set_real("drive.moment", -200.0 * f64::from(k)), fmi2OK);
        assert_eq!(slave.step(1e-3 * f64::from(k), 1e-3), fmi2OK);
    }
    let mut state = ptr::null_mut();
    assert_eq!(slave.save(&mut state), fmi2OK);
    // One direction of two inputs.
    let at = |by: f64| stepped(&slave, state, &[("drive.moment", -4200.0 + by), ("drive.load", 1e5 + 2.0 * by)]);
    let (low, high) = (at(-2.0), at(2.0));
    at(0.0);
    let found = directional(&slave, &OUTPUTS, &[("drive.moment", 1.0), ("drive.load", 2.0)]).unwrap();
    for (i, name) in OUTPUTS.iter().enumerate() {
        let expected = (high[i] - low[i]) / 4.0;
        let error = (found[i] - expected).abs() / expected.abs();
        assert!(error < 1e-5, "{name}: {:e}, differences {expected:e}", found[i]);
    }
    // Restored elsewhere, the state still knows where it came from.
    let bytes = {
        let mut now = ptr::null_mut();
        assert_eq!(slave.save(&mut now), fmi2OK);
        let bytes = slave.serialize(now);
        assert_eq!(slave.free_state(&mut now), fmi2OK);
        bytes
    };
    let other = Slave::new(&dll);
    let mut theirs = ptr::null_mut();
    assert_eq!(other.deserialize(&bytes, &mut theirs), fmi2OK);
    assert_eq!(other.restore(theirs), fmi2OK);
    let again = directional(&other, &OUTPUTS, &[("drive.moment", 1.0), ("drive.load", 2.0)]).unwrap();
    assert_eq!(found, again);
    assert_eq!(other.free_state(&mut theirs), fmi2OK);
    assert_eq!(slave.free_state(&mut state), fmi2OK);
}

#[test]
fn in_initialization_mode_derivatives_are_those_of_the_stationary_state() {
    let dll = load();
    let slave = Slave::coarse(&dll);
    slave.refused(directional(&slave, &["contact.force_y"], &[("drive.load", 1.0)]).unwrap_err(), &["Instantiated"]);
    assert_eq!(slave.enter(), fmi2OK);
    let found = directional(&slave, &["contact.force_y", "contact.half_width"], &[("drive.load", 1.0)]).unwrap();
    assert!((found[0] - 1.0).abs() < 1e-4, "{found:?}");
    // Hertz: the half-width grows with the root of the load.
    let expected = 0.5 * slave.real("contact.half_width") / slave.real("drive.load");
    assert!((found[1] / expected - 1.0).abs() < 0.1, "{found:?}, {expected:e}");
}

#[test]
fn derivatives_by_other_things_than_real_inputs_are_refused_by_name() {
    let dll = load();
    let slave = Slave::ready(&dll);
    for (unknown, known, seed, words) in [
        ("contact.force_x", "wheel.radius", 1.0, ["wheel.radius", "not an input"]),
        ("contact.force_x", "contact.force_y", 1.0, ["contact.force_y", "not an input"]),
        ("drive.load", "drive.load", 1.0, ["drive.load", "not an output"]),
        ("contact.force_x", "drive.load", f64::NAN, ["drive.load", "NaN"]),
    ] {
        slave.refused(directional(&slave, &[unknown], &[(known, seed)]).unwrap_err(), &words);
    }
    assert_eq!(directional(&slave, &["contact.force_x"], &[]).unwrap(), [0.0]);
    assert_eq!(directional(&slave, &[], &[("drive.load", 1.0)]).unwrap(), [] as [f64; 0]);
}

#[test]
fn output_derivatives_of_first_order_are_rates() {
    let dll = load();
    let slave = Slave::ready(&dll);
    assert_eq!(slave.set_real("drive.force", -2e4), fmi2OK);
    for k in 0..20 {
        assert_eq!(slave.step(1e-3 * f64::from(k), 1e-3), fmi2OK);
    }
    let names = ["wheel.distance", "wheel.velocity", "wheel.angle"];
    let found = output_derivatives(&slave, &names, 1).unwrap();
    for (rate, name) in found.iter().zip(["wheel.velocity", "wheel.acceleration", "wheel.omega"]) {
        let expected = slave.real(name);
        assert!((rate - expected).abs() < 1e-4 * expected.abs(), "{name}: {rate}, {expected}");
    }
    slave.refused(output_derivatives(&slave, &["wheel.distance"], 2).unwrap_err(), &["wheel.distance", "2", "order 1"]);
    slave.refused(output_derivatives(&slave, &["drive.load"], 1).unwrap_err(), &["drive.load", "not an output"]);
    assert_eq!(output_derivatives(&slave, &["wheel.distance"], 0).unwrap_err(), fmi2Error);
    assert_eq!(output_derivatives(&slave, &[], 1).unwrap(), [] as [f64; 0]);
}

#[test]
fn a_ramp_to_the_end_of_a_range_is_not_refused_for_rounding() {
    let dll = load();
    let slave = Slave::ready(&dll);
    let (friction, h) = (0.007, 0.003);
    assert!(friction + h * (-friction / h) < 0.0, "the case rounds below zero");
    assert_eq!(slave.set_real("rail.friction", friction), fmi2OK);
    assert_eq!(slave.set_rate("rail.friction", 1, -friction / h), fmi2OK);
    assert_eq!(slave.step(0.0, h), fmi2OK, "{:?}", slave.messages());
    assert_eq!(slave.real("rail.friction"), 0.0);
}

/// Declared knowns of each output by name, `None` for all, in a section of the model structure.
fn declared(section: &str) -> Vec<(&'static str, Option<Vec<&'static str>>)> {
    let description = wheelrail::fmi::v2::description::model_description(Default::default()).unwrap();
    let inside = description.split(&format!("<{section}>")).nth(1).unwrap();
    let inside = inside.split(&format!("</{section}>")).next().unwrap();
    let attribute = |line: &str, name: &str| {
        let rest = line.split(&format!(" {name}=\"")).nth(1)?;
        Some(rest.split('"').next().unwrap().to_owned())
    };
    let name = |index: &str| variables()[index.parse::<usize>().unwrap() - 1].name;
    let unknowns = inside.lines().filter(|line| line.contains("<Unknown"));
    unknowns
        .map(|line| {
            let known = attribute(line, "dependencies");
            let known = known.map(|list| list.split_whitespace().map(name).collect());
            (name(&attribute(line, "index").unwrap()), known)
        })
        .collect()
}

/// Tools colour the matrix of derivatives by the declared dependencies and take all other entries for zero.
#[test]
fn a_tool_that_skips_pairs_not_declared_gets_every_derivative() {
    let dll = load();
    let slave = Slave::coarse(&dll);
    for name in ["control.rotation", "control.translation"] {
        assert_eq!(slave.set_integer(name, 1), fmi2OK);
    }
    let is_real = |name: &str| matches!(variable(name).kind, Kind::Real { .. });
    let inputs = variables().iter().filter(|v| v.causality() == Causality::Input && is_real(v.name));
    let inputs: Vec<&str> = inputs.map(|v| v.name).collect();
    let compare = |slave: &Slave, section: &str| {
        let declared: Vec<_> = declared(section).into_iter().filter(|(name, _)| is_real(name)).collect();
        let names: Vec<&str> = declared.iter().map(|(name, _)| *name).collect();
        let mut found = 0;
        for input in &inputs {
            let column = directional(slave, &names, &[(input, 1.0)]).unwrap();
            for ((name, known), value) in declared.iter().zip(column) {
                let skipped = known.as_ref().is_some_and(|known| !known.contains(input));
                assert!(!skipped || value == 0.0, "{section}: d {name} / d {input} = {value} is not declared");
                found += usize::from(value != 0.0);
            }
        }
        assert!(found > 100, "{section}: {found} derivatives are not zero");
    };
    assert_eq!(slave.setup(0.0, None), fmi2OK);
    assert_eq!(slave.enter(), fmi2OK);
    compare(&slave, "InitialUnknowns");
    assert_eq!(slave.exit(), fmi2OK);
    assert_eq!(slave.step(0.0, 1e-3), fmi2OK);
    compare(&slave, "Outputs");
}
