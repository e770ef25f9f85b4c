//! The protocol of FMI 2.0 on the compiled library: what masters may call when, and what they get.
#![allow(unsafe_code)]

mod slave;

use libfmi::fmi2Type;
use slave::*;
use std::ffi::CStr;
use std::fs;
use std::ptr;

/// Global symbols that an ELF shared library defines for others.
#[cfg(target_os = "linux")]
fn exported_symbols(library: &[u8]) -> Vec<String> {
    let number = |at: usize, bytes: usize| (0..bytes).rfold(0usize, |n, i| n << 8 | library[at + i] as usize);
    let (sections, size, count) = (number(0x28, 8), number(0x3a, 2), number(0x3c, 2));
    let header = |i: usize| sections + i * size;
    let dynamic = (0..count).map(header).find(|h| number(h + 4, 4) == 11).expect("a dynamic symbol table");
    let (start, length, names) = (number(dynamic + 0x18, 8), number(dynamic + 0x20, 8), number(dynamic + 0x28, 4));
    let names = number(header(names) + 0x18, 8);
    let defined = |symbol: &usize| number(symbol + 6, 2) != 0 && library[symbol + 4] >> 4 != 0;
    let name = |symbol: usize| {
        let text = CStr::from_bytes_until_nul(&library[names + number(symbol, 4)..]).unwrap();
        text.to_str().unwrap().to_owned()
    };
    let mut symbols: Vec<_> = (start..start + length).step_by(24).filter(defined).map(name).collect();
    symbols.sort();
    symbols
}

#[test]
#[cfg(target_os = "linux")]
fn exactly_the_34_functions_of_co_simulation_are_exported() {
    let expected = "fmi2CancelStep fmi2DeSerializeFMUstate fmi2DoStep fmi2EnterInitializationMode \
        fmi2ExitInitializationMode fmi2FreeFMUstate fmi2FreeInstance fmi2GetBoolean fmi2GetBooleanStatus \
        fmi2GetDirectionalDerivative fmi2GetFMUstate fmi2GetInteger fmi2GetIntegerStatus fmi2GetReal \
        fmi2GetRealOutputDerivatives fmi2GetRealStatus fmi2GetStatus fmi2GetString fmi2GetStringStatus \
        fmi2GetTypesPlatform fmi2GetVersion fmi2Instantiate fmi2Reset fmi2SerializeFMUstate \
        fmi2SerializedFMUstateSize fmi2SetBoolean fmi2SetDebugLogging fmi2SetFMUstate fmi2SetInteger fmi2SetReal \
        fmi2SetRealInputDerivatives fmi2SetString fmi2SetupExperiment fmi2Terminate";
    let expected: Vec<&str> = expected.split_whitespace().collect();
    assert_eq!(expected.len(), 34);
    assert_eq!(exported_symbols(&fs::read(library()).unwrap()), expected);
}

#[test]
fn version_and_platform_are_those_of_the_standard() {
    let dll = load();
    let [version, platform] =
        unsafe { [dll.fmi2GetVersion(), dll.fmi2GetTypesPlatform()].map(|text| CStr::from_ptr(text)) };
    assert_eq!((version, platform), (c"2.0", c"default"));
}

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
    refused(Arguments { kind: fmi2Type::fmi2ModelExchange, ..Default::default() }, "fmi2CoSimulation");
    assert!(Slave::try_new(&dll, &Arguments { callbacks: false, ..Default::default() }).is_err());
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
    for location in [plain.clone(), format!("file:{encoded}"), format!("file://{encoded}"), format!("file://{plain}")] {
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
    assert_eq!(slave.set_boolean("physics.centrifugal", false), fmi2OK);
    assert_eq!(slave.set_string("preset", "paper_d"), fmi2OK);
    assert_eq!(slave.set_integer("solver.time_scheme", 2), fmi2OK);
    assert_eq!(slave.enter(), fmi2OK);
    assert_eq!(slave.string("preset"), "paper_d");
    assert_eq!(slave.real("wheel.hub_mass"), 77.0);
    assert_eq!(slave.real("wheel.radius"), 0.5);
    assert_eq!(slave.integer("mesh.elements_per_half_width"), 4);
    assert_eq!(slave.integer("solver.time_scheme"), 2);
    assert!(!slave.boolean("physics.centrifugal"));
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
        ("drive.moment", f64::NAN, ["NaN", "-1000000000 to 1000000000"]),
        ("drive.velocity", f64::INFINITY, ["inf", "-200 to 200"]),
        ("drive.load", -1.0, ["-1", "0 to 1000000000"]),
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
    slave.refused(slave.set_real("wheel.radius", 0.0), &["wheel.radius", "0.01 to 10"]);
    slave.refused(slave.set_integer("solver.modes_wheel", 0), &["solver.modes_wheel", "1 to 200"]);
    assert_eq!(slave.set_real("wheel.radius", 0.05), fmi2OK, "the hub may follow");
    assert_eq!(slave.enter(), fmi2OK);
    slave.refused(slave.exit(), &["wheel.hub_radius", "0.046", "0.001 to 0.045"]);
    assert_eq!(slave.set_real("wheel.radius", 0.46), fmi2OK);
    assert_eq!(slave.exit(), fmi2OK);
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
    assert!((slave.real("contact.utilisation") - 1.0).abs() < 1e-2 || slave.real("contact.force_x") > 0.0);
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
        slave.refused(slave.step(1.0, h), &["communicationStepSize", &format!("{h}"), "range"]);
    }
    for t in [0.0, 1.001, f64::NAN] {
        slave.refused(slave.step(t, 1e-3), &["currentCommunicationPoint", &format!("{t}"), "1 s"]);
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

#[test]
fn a_second_run_after_reset_is_the_first_bit_for_bit() {
    let dll = load();
    let slave = Slave::ready(&dll);
    let first = slave.brake(0);
    assert_eq!(slave.reset(), fmi2OK);
    slave.coarsen();
    slave.initialize();
    assert_eq!(slave.real("drive.moment"), 0.0);
    assert_eq!(slave.brake(0), first);
}

#[test]
fn a_run_from_a_saved_state_is_the_first_bit_for_bit() {
    let dll = load();
    let slave = Slave::ready(&dll);
    slave.brake(0);
    let (mut state, at_state) = (ptr::null_mut(), slave.outputs());
    assert_eq!(slave.save(&mut state), fmi2OK);
    let first = slave.brake(10);
    for _ in 0..2 {
        assert_eq!(slave.restore(state), fmi2OK);
        assert_eq!(slave.outputs(), at_state);
        assert_eq!(slave.brake(10), first);
    }
    let place = state;
    assert_eq!(slave.save(&mut state), fmi2OK, "a state can be overwritten");
    assert_eq!(state, place);
    assert_eq!(slave.restore(state), fmi2OK);
    assert_eq!(slave.outputs(), *first.last().unwrap());
    assert_eq!(slave.terminate(), fmi2OK);
    assert_eq!(slave.restore(state), fmi2OK, "a state includes where the run was");
    slave.brake(20);

    assert_eq!(slave.free_state(&mut state), fmi2OK);
    assert!(state.is_null());
    assert_eq!(slave.free_state(&mut state), fmi2OK, "nothing is freed");
    slave.refused(slave.restore(place), &["freed"]);
    slave.refused(slave.free_state(&mut place.clone()), &["freed"]);
}

#[test]
fn a_serialized_state_continues_in_another_instance() {
    let dll = load();
    let slave = Slave::ready(&dll);
    slave.brake(0);
    let mut state = ptr::null_mut();
    assert_eq!(slave.save(&mut state), fmi2OK);
    let bytes = slave.serialize(state);
    let expected = slave.brake(10);

    let other = Slave::new(&dll);
    other.refused(other.restore(state), &["not a state of this instance"]);
    let mut copy = ptr::null_mut();
    assert_eq!(other.deserialize(&bytes, &mut copy), fmi2OK);
    assert_eq!(other.restore(copy), fmi2OK, "{:?}", other.messages());
    assert_eq!(other.integer("mesh.elements_per_half_width"), 4);
    assert_eq!(other.brake(10), expected);
    assert_eq!(other.serialize(copy), bytes);
}

#[test]
fn damaged_states_are_refused() {
    let dll = load();
    let slave = Slave::ready(&dll);
    let mut state = ptr::null_mut();
    assert_eq!(slave.save(&mut state), fmi2OK);
    let bytes = slave.serialize(state);
    let refused = |bytes: &[u8]| {
        let mut place = ptr::null_mut();
        slave.refused(slave.deserialize(bytes, &mut place), &["state"]);
        assert!(place.is_null());
    };
    for at in (0..bytes.len()).step_by(1 + bytes.len() / 200) {
        let mut damaged = bytes.clone();
        damaged[at] ^= 0x10;
        refused(&damaged);
        refused(&bytes[..at]);
    }
    refused(&[bytes.as_slice(), &[0]].concat());
    refused(&[]);
    let mut small = [0i8; 8];
    let status = unsafe { dll.fmi2SerializeFMUstate(slave.component, state, small.as_mut_ptr().cast(), small.len()) };
    slave.refused(status, &["size = 8"]);
}

#[test]
fn interleaved_instances_do_not_know_of_each_other() {
    let dll = load();
    let alone = Slave::ready(&dll).brake(0);
    let [a, b] = [Slave::ready(&dll), Slave::coarse(&dll)];
    assert_eq!(b.set_real("initial.velocity", 5.0), fmi2OK);
    b.initialize();
    let mut together = Vec::new();
    for i in 0..10 {
        assert_eq!(a.set_real("drive.moment", -200.0 * (1 + i % 7) as f64), fmi2OK);
        assert_eq!(b.set_real("drive.moment", 500.0), fmi2OK);
        assert_eq!(b.step(1e-3 * i as f64, 1e-3), fmi2OK);
        assert_eq!(a.step(1e-3 * i as f64, 1e-3), fmi2OK);
        together.push(a.outputs());
    }
    assert_eq!(together, alone);
}

#[test]
fn instances_on_several_threads_agree() {
    let alone = Slave::ready(&load()).brake(0);
    std::thread::scope(|scope| {
        let runs: Vec<_> = (0..4).map(|_| scope.spawn(|| Slave::ready(&load()).brake(0))).collect();
        for run in runs {
            assert_eq!(run.join().unwrap(), alone);
        }
    });
}

#[test]
fn the_library_can_be_loaded_and_unloaded_many_times() {
    for _ in 0..20 {
        let dll = load();
        let slave = Slave::new(&dll);
        assert_eq!(slave.enter(), fmi2OK);
    }
}

#[test]
fn messages_are_arguments_and_come_only_when_wanted() {
    let dll = load();
    let slave = Slave::ready(&dll);
    assert_eq!(slave.messages(), [], "quiet unless asked");
    let text = "100%s%n%d";
    assert_eq!(slave.set_string("preset", text), fmi2Error);
    let messages = slave.messages();
    assert_eq!((messages.len(), messages[0].format.as_str()), (1, "%s"));
    assert_eq!((messages[0].instance.as_str(), messages[0].category.as_str()), ("wheel", "logStatusError"));
    assert_eq!(slave.reset(), fmi2OK);
    assert_eq!(slave.messages(), []);

    slave.refused(slave.set_logging(true, &["nonsense"]), &["nonsense", "logEvents"]);
    assert_eq!(slave.set_logging(true, &["logEvents"]), fmi2OK);
    slave.refused(slave.set_string("preset", text), &[text]);
    assert_eq!(slave.reset(), fmi2OK);
    let messages = slave.messages();
    assert_eq!((messages[0].status, messages[0].category.as_str()), (fmi2OK, "logEvents"));
    assert_eq!(slave.set_logging(false, &[]), fmi2OK);
    assert_eq!(slave.reset(), fmi2OK);
    assert_eq!(slave.messages(), []);

    let slave = Slave::try_new(&dll, &Arguments { logging: true, ..Default::default() }).ok().unwrap();
    slave.coarsen();
    assert_eq!(slave.set_real("wheel.radius", 0.47), fmi2OK);
    slave.initialize();
    let messages = slave.messages();
    assert!(messages.iter().any(|m| m.category == "logProgress"), "{messages:?}");
}

#[test]
fn strings_stay_readable_until_the_next_call() {
    let dll = load();
    let slave = Slave::coarse(&dll);
    assert_eq!(slave.set_string("preset", "paper_c"), fmi2OK);
    assert_eq!(slave.enter(), fmi2OK);
    let (reference, mut value) = (variable("preset").reference, ptr::null());
    assert_eq!(unsafe { dll.fmi2GetString(slave.component, &reference, 1, &mut value) }, fmi2OK);
    assert_eq!(slave.real("drive.load"), 10e3);
    assert_eq!(unsafe { CStr::from_ptr(value) }, c"paper_c");
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
