//! The protocol of FMI 2.0 on the compiled library: what masters may call when, and what they get.
#![allow(unsafe_code)]

use crate::slave::*;
use libfmi::fmi2Type;
use std::fs;
use std::ptr;
use wheelrail::fmi::v2::variables::variables;
use wheelrail::fmi::variable::{Causality, Kind, Start, Variable};

#[test]
fn instantiation_with_wrong_arguments_gives_null_and_a_logged_reason() {
    let dll = load();
    let refused = |arguments: Arguments, word: &str| {
        let messages = Slave::try_new(&dll, &arguments).err().expect("refused");
        let last = messages.last().expect("a message");
        assert!(last.text.contains(word) && last.status == fmi2Error, "{last:?}");
        assert_eq!(last.category, "logStatusError");
    };
    refused(Arguments { guid: Some("{0}"), ..Default::default() }, "{0}");
    refused(Arguments { guid: None, ..Default::default() }, "fmuGUID");
    refused(Arguments { name: Some(""), ..Default::default() }, "instanceName");
    refused(Arguments { name: None, ..Default::default() }, "instanceName");
    for kind in [fmi2Type::fmi2ModelExchange as i32, 7, -1, i32::MIN] {
        refused(Arguments { kind, ..Default::default() }, &format!("fmuType = {kind} "));
    }
    refused(Arguments { visible: 2, ..Default::default() }, "visible = 2 ");
    refused(Arguments { logging: -1, ..Default::default() }, "loggingOn = -1 ");
    assert!(Slave::try_new(&dll, &Arguments { callbacks: false, ..Default::default() }).is_err());
}

#[test]
fn c_integers_outside_an_enumeration_are_refused_by_every_status_function() {
    let dll = load();
    let slave = Slave::ready(&dll);
    assert_eq!(slave.step(0.0, 1e-3), fmi2OK);
    for kind in [-1, 4, 9, i32::MIN, i32::MAX] {
        for status in slave.ask(kind) {
            assert_eq!(status, fmi2Error, "{kind}");
        }
        let messages = slave.messages();
        assert_eq!(messages.len(), 5);
        for message in messages {
            assert!(message.text.contains(&format!("fmi2StatusKind = {kind} is outside its range")), "{message:?}");
            assert!(message.text.contains("2 (fmi2LastSuccessfulTime)"), "{message:?}");
        }
    }
    // Known kinds are answered by one function each and not available through the others.
    for (kind, answering) in [(0, Some(0)), (1, None), (2, Some(1)), (3, Some(3))] {
        for (i, status) in slave.ask(kind).into_iter().enumerate() {
            assert_eq!(status, if Some(i) == answering { fmi2OK } else { fmi2Discard }, "kind {kind}, function {i}");
        }
    }
}

#[test]
fn booleans_other_than_zero_and_one_are_refused_wherever_they_can_be_passed() {
    let dll = load();
    let slave = Slave::coarse(&dll);
    let c = slave.component;
    assert_eq!(slave.set_c_boolean("thermal.enabled", 0), fmi2OK);
    for value in [2, -1, 256, i32::MIN] {
        let text = format!("= {value} is no fmi2Boolean: pass 0 (fmi2False) or 1 (fmi2True)");
        slave.refused(slave.set_c_boolean("thermal.enabled", value), &["thermal.enabled", &text]);
        unsafe {
            slave.refused(dll.fmi2SetupExperiment(c, value, 1e-3, 0.0, 0, 0.0), &["toleranceDefined", &text]);
            slave.refused(dll.fmi2SetupExperiment(c, 0, 0.0, 0.0, value, 1.0), &["stopTimeDefined", &text]);
            slave.refused(dll.fmi2SetDebugLogging(c, value, 0, ptr::null()), &["loggingOn", &text]);
        }
    }
    slave.initialize();
    assert!(!slave.boolean("thermal.enabled"), "refused values change nothing");
    let status = unsafe { dll.fmi2DoStep(c, 0.0, 1e-3, 2) };
    slave.refused(status, &["noSetFMUStatePriorToCurrentPoint = 2"]);
    assert_eq!(slave.step(0.0, 1e-3), fmi2OK);
}

#[test]
fn resources_are_found_under_every_spelling_of_their_location() {
    let dll = load();
    let directory = std::env::temp_dir().join(format!("wheelrail test {}", std::process::id()));
    fs::create_dir_all(&directory).unwrap();
    let source = concat!(env!("CARGO_MANIFEST_DIR"), "/resources/paper_d.json");
    fs::copy(source, directory.join("my_set.json")).unwrap();
    let plain = directory.to_str().unwrap().to_owned();
    let encoded = plain.replace(' ', "%20");
    let schemes = ["", "file:", "file://", "FILE:", "File://", "file://localhost", "FILE://LOCALHOST"];
    for location in
        schemes.into_iter().map(|scheme| format!("{scheme}{}", if scheme.is_empty() { &plain } else { &encoded }))
    {
        let slave = Slave::try_new(&dll, &Arguments { resources: Some(&location), ..Default::default() }).ok().unwrap();
        assert_eq!(slave.set_string("preset", "my_set"), fmi2OK, "{location} {:?}", slave.messages());
        slave.refused(slave.set_string("preset", "other"), &["preset", "other", "my_set, railway"]);
    }
    fs::write(directory.join("broken.json"), "{").unwrap();
    let slave = Slave::try_new(&dll, &Arguments { resources: Some(&plain), ..Default::default() }).ok().unwrap();
    slave.refused(slave.set_string("preset", "broken"), &["broken", "malformed", "my_set"]);
    slave.refused(slave.set_string("preset", "../broken"), &["../broken", "my_set"]);
    fs::remove_dir_all(&directory).unwrap();

    let slave = Slave::try_new(&dll, &Arguments { resources: None, ..Default::default() }).ok().unwrap();
    slave.refused(slave.set_string("preset", "paper_d"), &["paper_d", "available presets: railway"]);
    slave.coarsen();
    slave.initialize();
}

#[test]
fn calls_out_of_turn_are_refused_and_change_nothing() {
    let dll = load();
    let slave = Slave::coarse(&dll);
    let get = |name: &str| slave.get_reals(&[variable(name).reference]);
    let load = "drive.load";

    slave.refused(get(load).unwrap_err(), &["Get", "Instantiated"]);
    slave.refused(slave.step(0.0, 1e-3), &["DoStep", "Instantiated"]);
    slave.refused(slave.exit(), &["Instantiated"]);
    slave.refused(slave.terminate(), &["Instantiated"]);
    assert_eq!(slave.set_real("wheel.radius", 0.5), fmi2OK);
    assert_eq!(slave.set_real(load, 9e4), fmi2OK);
    slave.refused(slave.set_real("wheel.velocity", 1.0), &["wheel.velocity", "output"]);

    assert_eq!(slave.enter(), fmi2OK);
    slave.refused(slave.enter(), &["Initialization"]);
    slave.refused(slave.setup(0.0, None), &["Initialization"]);
    slave.refused(slave.step(0.0, 1e-3), &["Initialization"]);
    assert_eq!(get(load), Ok(vec![9e4]));
    assert_eq!(slave.set_real("wheel.radius", 0.46), fmi2OK);

    assert_eq!(slave.exit(), fmi2OK);
    slave.refused(slave.exit(), &["StepComplete"]);
    slave.refused(slave.set_real("wheel.radius", 0.5), &["wheel.radius", "parameter"]);
    assert_eq!(slave.real("wheel.radius"), 0.46);
    assert_eq!(slave.set_real(load, 8e4), fmi2OK);
    assert_eq!(slave.step(0.0, 1e-3), fmi2OK);
    slave.refused(unsafe { dll.fmi2CancelStep(slave.component) }, &["CancelStep"]);

    assert_eq!(slave.terminate(), fmi2OK);
    assert_eq!(get(load), Ok(vec![8e4]));
    slave.refused(slave.set_real(load, 9e4), &["Terminated"]);
    slave.refused(slave.step(1e-3, 1e-3), &["Terminated"]);
    assert_eq!(slave.reset(), fmi2OK);
    slave.refused(get(load).unwrap_err(), &["Instantiated"]);
    assert_eq!(unsafe { dll.fmi2Reset(ptr::null_mut()) }, fmi2Error);
}

#[test]
fn explicit_parameters_override_the_preset_in_any_order() {
    let dll = load();
    let slave = Slave::coarse(&dll);
    assert_eq!(slave.set_real("wheel.hub_mass", 77.0), fmi2OK);
    assert_eq!(slave.set_boolean("physics.yielding", false), fmi2OK);
    assert_eq!(slave.set_string("preset", "paper_d"), fmi2OK);
    assert_eq!(slave.set_integer("thermal.hub", 2), fmi2OK);
    assert_eq!(slave.enter(), fmi2OK);
    assert_eq!(slave.string("preset"), "paper_d");
    assert_eq!(slave.real("wheel.hub_mass"), 77.0);
    assert_eq!(slave.real("wheel.radius"), 0.5);
    assert_eq!(slave.integer("mesh.elements_per_half_width"), 4);
    assert_eq!(slave.integer("thermal.hub"), 2);
    assert!(!slave.boolean("physics.yielding"));
    // inputs follow until they are set
    assert_eq!((slave.real("drive.load"), slave.real("rail.friction")), (100e3, 0.4));
    assert!((slave.real("drive.omega") * 0.5 - slave.real("drive.velocity")).abs() < 1e-12);
    assert_eq!(slave.set_real("initial.velocity", 10.0), fmi2OK);
    assert_eq!(slave.set_real("drive.load", 90e3), fmi2OK);
    assert_eq!(slave.set_real("model.nominal_load", 95e3), fmi2OK);
    assert_eq!((slave.real("drive.velocity"), slave.real("drive.load")), (10.0, 90e3));
}

#[test]
fn bad_values_are_refused_by_name_value_and_range() {
    let dll = load();
    let slave = Slave::ready(&dll);
    let before = slave.outputs();
    for (name, value, words) in [
        ("drive.moment", f64::NAN, ["NaN", "-1e9 to 1e9 N.m"]),
        ("drive.velocity", f64::INFINITY, ["inf", "-200 to 200"]),
        ("drive.load", -1.0, ["-1", "0 to 1e9 N"]),
        ("rail.friction", -0.1, ["-0.1", "0 to 10"]),
    ] {
        let old = slave.real(name);
        slave.refused(slave.set_real(name, value), &[name, words[0], words[1]]);
        assert_eq!(slave.real(name), old);
    }
    slave.refused(slave.set_integer("control.rotation", 3), &["control.rotation", "3", "1 (velocity), 2 (moment)"]);
    let [omega, load] = ["drive.omega", "drive.load"].map(|name| variable(name).reference);
    slave.refused(slave.set_reals(&[omega, load], &[1.0, f64::NAN]), &["drive.load"]);
    assert_eq!(slave.real("drive.omega"), real_start("drive.omega"), "all or nothing");
    assert_eq!(slave.outputs(), before);
    assert_eq!(slave.step(0.0, 1e-3), fmi2OK, "the run goes on");

    let slave = Slave::coarse(&dll);
    slave.refused(slave.set_real("wheel.radius", 0.0), &["wheel.radius", "0.01 to 10 m"]);
    slave.refused(slave.set_integer("contact.lines", 0), &["contact.lines", "1 to 13"]);
    assert_eq!(slave.set_real("wheel.hub_radius", 0.4), fmi2OK, "the rim may follow");
    assert_eq!(slave.set_real("wheel.radius", 0.42), fmi2OK, "the hub may follow");
    assert_eq!(slave.enter(), fmi2OK);
    slave.refused(slave.exit(), &["wheel.hub_radius", "0.4", "0.0084 to 0.378 m with wheel.radius = 0.42 m"]);
    assert_eq!(slave.set_real("wheel.radius", 0.46), fmi2OK);
    assert_eq!(slave.set_real("wheel.hub_radius", 0.046), fmi2OK);
    assert_eq!(slave.exit(), fmi2OK);
}

#[test]
fn value_references_of_retired_parameters_are_refused_by_name_and_nothing_is_set() {
    let dll = load();
    let slave = Slave::coarse(&dll);
    let load = variable("drive.load").reference;
    for (number, refusal) in [
        (1094, "solver.theta was retired in 0.2.0 (last in 0.1.1)"),
        (1137, "damping.rayleigh_stiffness was retired in 0.21.0 (last in 0.20.0)"),
    ] {
        slave.refused(slave.set_reals(&[load, number], &[7e4, 0.5]), &[&number.to_string(), refusal]);
    }
    assert_eq!(slave.enter(), fmi2OK);
    assert_eq!(slave.real("drive.load"), 100e3);
}

#[test]
fn unknown_references_wrong_types_and_null_arrays_are_refused() {
    let dll = load();
    let slave = Slave::ready(&dll);
    slave.refused(slave.get_reals(&[987_654]).unwrap_err(), &["987654"]);
    slave.refused(slave.set_reals(&[987_654], &[1.0]), &["987654"]);
    slave.refused(slave.get_reals(&[variable("solver.iterations").reference]).unwrap_err(), &["solver.iterations"]);
    slave.refused(slave.set_integer("drive.load", 1), &["drive.load", "Real", "Integer"]);
    let reference = variable("drive.load").reference;
    let (c, null) = (slave.component, ptr::null_mut());
    unsafe {
        slave.refused(dll.fmi2GetReal(c, &reference, 1, null), &["value", "NULL"]);
        slave.refused(dll.fmi2GetReal(c, ptr::null(), 1, &mut 0.0), &["vr", "NULL"]);
        assert_eq!(dll.fmi2GetReal(c, ptr::null(), 0, null), fmi2OK);
        assert_eq!(dll.fmi2SetReal(c, ptr::null(), 0, null), fmi2OK);
        assert_eq!(dll.fmi2GetString(c, ptr::null(), 0, ptr::null_mut()), fmi2OK);
        assert_eq!(dll.fmi2GetReal(null.cast(), &reference, 1, &mut 0.0), fmi2Error);
    }
}

/// Arrays of so many elements do not fit into any memory: their sizes in bytes wrap around, some to nothing.
const IMPOSSIBLE: [usize; 6] = [usize::MAX, (1 << 63) + 1, 1 << 63, 1 << 62, 1 << 61, 1 << 32];

#[test]
fn numbers_of_elements_that_no_array_has_are_refused_by_every_function() {
    let dll = load();
    let slave = Slave::ready(&dll);
    assert_eq!(slave.step(0.0, 1e-3), fmi2OK);
    let (c, reference, mut state, mut other) =
        (slave.component, variable("drive.load").reference, ptr::null_mut(), ptr::null_mut());
    assert_eq!(slave.save(&mut state), fmi2OK);
    let before = slave.real("contact.force_x");
    let (mut real, mut whole, mut text, mut byte) = (0.0, 0, ptr::null(), 0);
    for n in IMPOSSIBLE {
        let words = [format!("= {n} is outside its range"), "number of elements".to_owned()];
        let refused =
            |call: &mut dyn FnMut() -> fmi2Status| slave.refused(call(), &words.each_ref().map(String::as_str));
        // SAFETY: every array has one element; no number below is that of its elements, which is what is tried.
        unsafe {
            refused(&mut || dll.fmi2GetReal(c, &reference, n, &mut real));
            refused(&mut || dll.fmi2GetInteger(c, &reference, n, &mut whole));
            refused(&mut || dll.fmi2GetBoolean(c, &reference, n, &mut whole));
            refused(&mut || dll.fmi2GetString(c, &reference, n, &mut text));
            refused(&mut || dll.fmi2SetReal(c, &reference, n, &1e5));
            refused(&mut || dll.fmi2SetInteger(c, &reference, n, &1));
            refused(&mut || dll.fmi2SetBoolean(c, &reference, n, &1));
            refused(&mut || dll.fmi2SetString(c, &reference, n, &c"a".as_ptr()));
            refused(&mut || dll.fmi2SetRealInputDerivatives(c, &reference, n, &1, &0.0));
            refused(&mut || dll.fmi2GetRealOutputDerivatives(c, &reference, n, &1, &mut real));
            refused(&mut || dll.fmi2GetDirectionalDerivative(c, &reference, n, &reference, 1, &1.0, &mut real));
            refused(&mut || dll.fmi2GetDirectionalDerivative(c, &reference, 1, &reference, n, &1.0, &mut real));
            refused(&mut || dll.fmi2SetDebugLogging(c, 0, n, &c"logAll".as_ptr()));
            refused(&mut || dll.fmi2SerializeFMUstate(c, state, &mut byte, n));
            refused(&mut || dll.fmi2DeSerializeFMUstate(c, &byte, n, &mut other));
        }
    }
    assert!(other.is_null() && slave.real("contact.force_x") == before && slave.step(1e-3, 1e-3) == fmi2OK);
}

#[test]
fn in_initialization_mode_outputs_are_those_of_the_inputs_just_set() {
    let dll = load();
    let slave = Slave::coarse(&dll);
    assert_eq!(slave.enter(), fmi2OK);
    for load in [100e3, 80e3, 120e3] {
        assert_eq!(slave.set_real("drive.load", load), fmi2OK);
        assert!((slave.real("contact.force_y") / load - 1.0).abs() < 0.01);
    }
    assert_eq!(slave.set_integer("control.rotation", 1), fmi2OK);
    assert_eq!(slave.set_integer("control.translation", 1), fmi2OK);
    assert_eq!(slave.set_real("drive.velocity", 20.0), fmi2OK);
    assert_eq!(slave.set_real("drive.omega", 20.0 / 0.46 * 1.05), fmi2OK);
    assert!((slave.real("wheel.velocity") - 20.0).abs() < 1e-12);
    assert!((slave.real("contact.utilisation") - 1.0).abs() < 1e-2 && slave.real("contact.force_x") > 0.0);
    assert_eq!((slave.real("wheel.distance"), slave.real("wheel.angle")), (0.0, 0.0));
    assert_eq!(slave.integer("solver.internal_steps"), 0);
}

#[test]
fn steps_need_a_positive_length_and_the_current_time() {
    let dll = load();
    let slave = Slave::coarse(&dll);
    assert_eq!(slave.setup(1.0, Some(2.0)), fmi2OK);
    assert_eq!(slave.enter(), fmi2OK);
    assert_eq!(slave.exit(), fmi2OK);
    let before = slave.outputs();
    for h in [0.0, -1e-3, f64::NAN, f64::INFINITY, 1e300] {
        slave.refused(slave.step(1.0, h), &["communicationStepSize", &format!("= {h:?} s"), "range"]);
    }
    for t in [0.0, 1.001, f64::NAN] {
        slave.refused(slave.step(t, 1e-3), &["currentCommunicationPoint", &format!("= {t:?} s"), "1.0 s"]);
    }
    assert_eq!(slave.outputs(), before);
    let mut sum = 1.0;
    for i in 0..10 {
        let t = if i % 2 == 0 { sum } else { 1.0 + i as f64 * 0.1 };
        assert_eq!(slave.step(t, 0.1), fmi2OK, "step {i}: {:?}", slave.messages());
        sum += 0.1;
    }
    assert_ne!(sum, 2.0, "rounding makes the last step end past the stop time");
    slave.refused(slave.step(sum, 0.1), &["stopTime"]);
    // A clock far from zero rounds coarsely.
    let late = Slave::coarse(&dll);
    let (mut time, stop) = (1e9, 1e9 + 0.1);
    assert_eq!(late.setup(time, Some(stop)), fmi2OK);
    assert_eq!(late.enter(), fmi2OK);
    assert_eq!(late.exit(), fmi2OK);
    for k in 0..100 {
        assert_eq!(late.step(time, 1e-3), fmi2OK, "step {k}: {:?}", late.messages());
        time += 1e-3;
    }
    assert!(time > stop);
}

#[test]
fn a_step_that_fails_is_rolled_back_and_the_run_goes_on() {
    let dll = load();
    let slave = Slave::ready(&dll);
    assert_eq!(slave.step(0.0, 1e-3), fmi2OK);
    assert_eq!((slave.last_step(), slave.last_successful_time()), (fmi2OK, 1e-3));
    let before = slave.outputs();
    let load = real_start("drive.load");

    assert_eq!(slave.set_real("drive.load", 1e4 * load), fmi2OK);
    assert_eq!(slave.step(1e-3, 1e-3), fmi2Discard);
    slave.explained(&["load", "model.nominal_load"]);
    assert_eq!((slave.last_step(), slave.last_successful_time()), (fmi2Discard, 1e-3));
    assert!(!slave.terminated(), "a shorter step may help");
    assert_eq!(slave.outputs(), before);
    assert_eq!(slave.step(1e-3, 1e-3), fmi2Discard);
    assert!(slave.terminated(), "the same step failed twice");

    assert_eq!(slave.set_real("drive.load", load), fmi2OK);
    assert_eq!(slave.step(1e-3, 1e-3), fmi2OK);
    assert!(!slave.terminated());

    let twin = Slave::ready(&dll);
    assert_eq!(twin.set_real("drive.load", load), fmi2OK);
    assert_eq!(twin.step(0.0, 1e-3), fmi2OK);
    assert_eq!(twin.step(1e-3, 1e-3), fmi2OK);
    assert_eq!(slave.outputs(), twin.outputs(), "the failure left no trace");
}

#[test]
fn input_derivatives_make_a_ramp_for_one_step() {
    let dll = load();
    let slave = Slave::coarse(&dll);
    assert_eq!(slave.set_integer("control.translation", 1), fmi2OK);
    slave.initialize();
    let v = real_start("drive.velocity");
    slave.refused(slave.set_rate("drive.velocity", 2, 1.0), &["drive.velocity", "order 2"]);
    slave.refused(slave.set_rate("drive.velocity", 1, f64::NAN), &["drive.velocity", "NaN"]);
    slave.refused(slave.set_rate("wheel.velocity", 1, 1.0), &["wheel.velocity", "input"]);
    assert_eq!(slave.set_rate("drive.velocity", 1, -2.0), fmi2OK);
    assert_eq!(slave.step(0.0, 0.01), fmi2OK);
    assert_eq!(slave.real("drive.velocity"), v - 0.02);
    assert!((slave.real("wheel.velocity") - (v - 0.02)).abs() < 1e-3);
    assert_eq!(slave.step(0.01, 0.01), fmi2OK);
    assert!((slave.real("wheel.velocity") - (v - 0.02)).abs() < 1e-9, "held after the ramp");
    assert_eq!(slave.set_rate("drive.velocity", 1, 1e6), fmi2OK);
    slave.refused(slave.step(0.02, 0.01), &["end of the step", "drive.velocity", "-200 to 200"]);
    assert_eq!(slave.set_real("drive.velocity", v), fmi2OK);
    assert_eq!(slave.step(0.02, 0.01), fmi2OK, "setting the value forgets the derivative");
}

/// Bits of all real outputs by name.
fn named_outputs(slave: &Slave) -> Vec<(&'static str, u64)> {
    let real = |v: &&Variable| v.causality() == Causality::Output && matches!(v.kind, Kind::Real { .. });
    variables().iter().filter(real).map(|v| v.name).zip(slave.outputs()).collect()
}

#[test]
fn outputs_depend_on_inputs_only_as_declared() {
    let dll = load();
    let slave = Slave::coarse(&dll);
    assert_eq!(slave.set_integer("control.rotation", 1), fmi2OK);
    assert_eq!(slave.set_integer("control.translation", 1), fmi2OK);
    assert_eq!(slave.enter(), fmi2OK);
    let inputs = ["drive.omega", "drive.velocity", "drive.load", "rail.friction", "drive.moment", "drive.force"];
    let declared_zero = |name: &str| variable(name).start == Start::Zero;
    let mut moved = std::collections::BTreeSet::new();
    let before = named_outputs(&slave);
    for name in inputs {
        let old = slave.real(name);
        assert_eq!(slave.set_real(name, 0.9 * old + 1e-2), fmi2OK);
        for ((output, was), (_, is)) in before.iter().zip(named_outputs(&slave)) {
            assert!(*was == is || !declared_zero(output), "{output} follows {name} in Initialization Mode");
            moved.extend((*was != is).then_some(*output));
        }
        assert_eq!(slave.set_real(name, old), fmi2OK);
        assert_eq!(named_outputs(&slave), before);
    }
    for output in ["contact.force_y", "contact.half_width", "contact.pressure_max", "wheel.velocity", "hub.force_y"] {
        assert!(moved.contains(output), "{output} follows nothing");
    }
    assert_eq!(slave.exit(), fmi2OK);
    assert_eq!(slave.step(0.0, 1e-3), fmi2OK);
    let before = named_outputs(&slave);
    for name in inputs {
        assert_eq!(slave.set_real(name, 0.9 * slave.real(name) + 1e-2), fmi2OK);
        assert_eq!(named_outputs(&slave), before, "between steps {name} acts on nothing yet");
    }
}

#[test]
fn results_hardly_depend_on_the_communication_step() {
    let dll = load();
    // Braking at about half the adhesion limit, the moment rising within 50 ms: speed, distance, force after 0.2 s.
    let brake = |h: f64| {
        let slave = Slave::ready(&dll);
        for i in 0..(0.2 / h).round() as usize {
            let t = i as f64 * h;
            let rate = if t < 0.05 - 1e-9 { -7000.0 / 0.05 } else { 0.0 };
            assert_eq!(slave.set_real("drive.moment", -7000.0 * (t / 0.05).min(1.0)), fmi2OK);
            assert_eq!(slave.set_rate("drive.moment", 1, rate), fmi2OK);
            assert_eq!(slave.step(t, h), fmi2OK);
        }
        ["wheel.velocity", "wheel.distance", "contact.force_x", "contact.half_width"].map(|name| slave.real(name))
    };
    let (coarse, fine) = (brake(1e-3), brake(5e-4));
    println!("{coarse:?} {fine:?}");
    for ((a, b), tolerance) in coarse.iter().zip(fine).zip([1e-5, 1e-5, 5e-3, 5e-3]) {
        assert!((a / b - 1.0).abs() < tolerance, "{coarse:?} {fine:?}");
    }
}

#[test]
fn tunable_parameters_change_between_steps_and_survive_save_and_restore() {
    let dll = load();
    let slave = Slave::ready(&dll);
    slave.brake(0);
    let mut state = ptr::null_mut();
    assert_eq!(slave.save(&mut state), fmi2OK);
    let plain = slave.brake(10);
    assert_eq!(slave.restore(state), fmi2OK);
    assert_eq!(slave.set_real("friction.falling_ratio", 0.5), fmi2OK);
    assert_eq!(slave.set_real("friction.falling_decay", 100.0), fmi2OK);
    assert_eq!(slave.real("friction.falling_ratio"), 0.5);
    let mut tuned_state = ptr::null_mut();
    assert_eq!(slave.save(&mut tuned_state), fmi2OK);
    let tuned = slave.brake(10);
    assert_ne!(plain, tuned);
    // Back to each of the two, in both orders.
    assert_eq!(slave.restore(state), fmi2OK);
    assert_eq!(slave.brake(10), plain);
    assert_eq!(slave.restore(tuned_state), fmi2OK);
    assert_eq!(slave.brake(10), tuned);
    slave.refused(slave.set_real("friction.falling_ratio", 1.5), &["friction.falling_ratio", "1.5", "0 to 1"]);
    slave.refused(slave.set_real("wheel.radius", 0.5), &["wheel.radius", "fixed"]);
    assert_eq!(slave.free_state(&mut state), fmi2OK);
    assert_eq!(slave.free_state(&mut tuned_state), fmi2OK);
}

#[test]
fn instances_that_are_freed_or_made_up_are_refused_and_never_followed() {
    let dll = load();
    let slave = Slave::ready(&dll);
    let freed = {
        let other = Slave::coarse(&dll);
        other.component
    };
    // Within the memory of one that lives, but not its address, and addresses at which nothing can be read.
    let inside = slave.component.wrapping_byte_add(8);
    for component in [freed, inside, ptr::without_provenance_mut(0x10), ptr::without_provenance_mut(usize::MAX - 7)] {
        let (reference, mut value) = (variable("wheel.velocity").reference, f64::NAN);
        // SAFETY: what is under test: a component that is none is not followed.
        unsafe {
            assert_eq!(dll.fmi2DoStep(component, 0.0, 1e-3, 1), fmi2Error);
            assert_eq!(dll.fmi2GetReal(component, &reference, 1, &mut value), fmi2Error);
            assert_eq!(dll.fmi2Reset(component), fmi2Error);
            dll.fmi2FreeInstance(component);
        }
        assert!(value.is_nan());
    }
    assert_eq!(slave.step(0.0, 1e-3), fmi2OK);
}
