//! Saved states through the compiled library: whatever is restored, wherever, continues bit for bit.
#![allow(unsafe_code)]

use crate::common;
use crate::slave::*;
use std::process::Command;
use std::ptr;

/// Names the file with the state that [`continue_from_file`] reads.
const STATE_FILE: &str = "WHEELRAIL_STATE_FILE";

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

/// fmusim up to 0.0.39 passes the state to `fmi2FreeFMUstate`, not the address of the variable that holds it.
#[test]
fn a_state_passed_in_place_of_its_address_is_refused_and_stays() {
    let dll = load();
    let slave = Slave::ready(&dll);
    let mut state = ptr::null_mut();
    assert_eq!(slave.save(&mut state), fmi2OK);
    let free_itself = |state: libfmi::fmi2FMUstate| unsafe { dll.fmi2FreeFMUstate(slave.component, state.cast()) };
    slave.refused(free_itself(state), &["the address of a variable that holds a state"]);
    assert_eq!(slave.restore(state), fmi2OK, "the state is still there");
    let status = unsafe { dll.fmi2GetFMUstate(slave.component, state.cast()) };
    slave.refused(status, &["the address of a variable that holds a state"]);
    assert_eq!(slave.restore(state), fmi2OK);
    let stale = state;
    assert_eq!(slave.free_state(&mut state), fmi2OK);
    slave.refused(free_itself(stale), &["the address of a variable"]);
}

#[test]
fn handles_that_are_foreign_freed_or_made_up_are_refused_and_never_followed() {
    let dll = load();
    let (slave, other) = (Slave::ready(&dll), Slave::ready(&dll));
    let (mut state, mut theirs) = (ptr::null_mut(), ptr::null_mut());
    assert_eq!((slave.save(&mut state), other.save(&mut theirs)), (fmi2OK, fmi2OK));
    assert_ne!(state, theirs);
    let mut freed = ptr::null_mut();
    assert_eq!(slave.save(&mut freed), fmi2OK);
    assert_eq!(slave.free_state(&mut freed.clone()), fmi2OK);
    let words = ["not a state of this instance", "freed"];
    for handle in [theirs, freed, ptr::without_provenance_mut(0x10), ptr::without_provenance_mut(usize::MAX - 7)] {
        slave.refused(slave.restore(handle), &words);
        let mut place = handle;
        slave.refused(slave.free_state(&mut place), &words);
        slave.refused(slave.save(&mut place), &words);
        assert_eq!(place, handle, "a refused call writes nothing");
        let status = unsafe { dll.fmi2SerializedFMUstateSize(slave.component, handle, &mut 0) };
        slave.refused(status, &words);
    }
    assert_eq!((slave.restore(state), other.restore(theirs)), (fmi2OK, fmi2OK));
    assert_eq!(slave.free_state(&mut state), fmi2OK);
    // Many states at once, freed in another order: each handle is one of its own.
    let mut handles: Vec<_> = (0..50).map(|_| ptr::null_mut()).collect();
    for handle in &mut handles {
        assert_eq!(slave.save(handle), fmi2OK);
    }
    let distinct: std::collections::BTreeSet<usize> = handles.iter().map(|handle| handle.addr()).collect();
    assert_eq!(distinct.len(), 50);
    for handle in handles.iter_mut().rev() {
        assert_eq!(slave.free_state(handle), fmi2OK);
    }
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

/// Four lines that stand for the seven of an ellipse, with heat.
#[test]
fn the_state_of_an_elliptical_patch_is_restored_and_continues_in_another_instance() {
    let dll = load();
    let slave = Slave::coarse(&dll);
    assert_eq!(slave.set_integer("contact.shape", 2), fmi2OK);
    for (name, value) in [("wheel.hub_radius", 0.067), ("wheel.hub_mass", 277.0), ("wheel.hub_inertia", 4.7)] {
        assert_eq!(slave.set_real(name, value), fmi2OK);
    }
    slave.initialize();
    slave.brake(0);
    let (mut state, at_state, width) = (ptr::null_mut(), slave.outputs(), slave.real("contact.width"));
    assert!((9e-3..12e-3).contains(&width), "{width} m is no ellipse");
    assert_eq!(slave.save(&mut state), fmi2OK);
    let (bytes, expected) = (slave.serialize(state), slave.brake(10));
    assert_eq!(slave.restore(state), fmi2OK);
    assert_eq!((slave.outputs(), slave.brake(10)), (at_state.clone(), expected.clone()));

    let other = Slave::new(&dll);
    let mut copy = ptr::null_mut();
    assert_eq!(other.deserialize(&bytes, &mut copy), fmi2OK);
    assert_eq!(other.restore(copy), fmi2OK, "{:?}", other.messages());
    assert_eq!((other.outputs(), other.brake(10)), (at_state, expected));
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
    // Every byte of the header, then a sample of the rest; bits of all places.
    for at in (0..100).chain((100..bytes.len()).step_by(1 + bytes.len() / 500)) {
        let mut damaged = bytes.clone();
        damaged[at] ^= 1 << (at % 8);
        refused(&damaged);
        refused(&bytes[..at]);
    }
    refused(&[bytes.as_slice(), &[0]].concat());
    refused(&vec![0xff; bytes.len()]);
    let version = env!("CARGO_PKG_VERSION").as_bytes();
    let at = bytes.windows(version.len()).position(|text| text == version).unwrap();
    let mut other_version = bytes.clone();
    other_version[at..at + version.len()].fill(b'9');
    refused(&other_version);
    let mut small = [0i8; 8];
    let status = unsafe { dll.fmi2SerializeFMUstate(slave.component, state, small.as_mut_ptr().cast(), small.len()) };
    slave.refused(status, &["size = 8"]);

    let run = slave.brake(0);
    assert_eq!(run, Slave::ready(&dll).brake(0), "the refusals left no trace");
    assert_eq!(slave.restore(state), fmi2OK);
    assert_eq!(slave.brake(0), run);
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

/// Mixed steps after [`Slave::brake`]: changes of step size, a ramp, a control switch and lift-off, so that every part
/// of a state matters. Outputs after each.
fn varied(slave: &Slave, mut time: f64) -> Vec<Vec<u64>> {
    let step = |i: usize| {
        let h = [1e-3, 2.5e-4, 4e-3, 1e-3][i % 4];
        match i {
            3 => assert_eq!(slave.set_rate("rail.friction", 1, -5.0), fmi2OK),
            6 => assert_eq!(slave.set_integer("control.rotation", 1), fmi2OK),
            9 => assert_eq!(slave.set_real("drive.tread_heat", 2e4), fmi2OK),
            12 => {
                assert_eq!(slave.set_integer("control.vertical", 2), fmi2OK);
                assert_eq!(slave.set_real("drive.displacement", 1e-5), fmi2OK);
            }
            14 => {
                assert_eq!(slave.set_integer("control.vertical", 1), fmi2OK);
                assert_eq!(slave.set_real("drive.load", 3e4), fmi2OK);
            }
            _ => {}
        }
        assert_eq!(slave.step(time, h), fmi2OK, "step {i}: {:?}", slave.messages());
        time += h;
        slave.outputs()
    };
    (0..20).map(step).collect()
}

#[test]
fn every_kind_of_step_can_be_repeated_from_a_state_in_the_midst() {
    let dll = load();
    let slave = Slave::ready(&dll);
    slave.brake(0);
    let mut states = Vec::new();
    for _ in 0..2 {
        let mut state = ptr::null_mut();
        assert_eq!(slave.save(&mut state), fmi2OK);
        let first = varied(&slave, slave.last_successful_time());
        states.push((state, first));
    }
    for (state, first) in states.iter().rev().chain(&states) {
        assert_eq!(slave.restore(*state), fmi2OK);
        assert_eq!(varied(&slave, slave.last_successful_time()), *first);
    }
}

#[test]
fn a_serialized_state_continues_in_another_process() {
    let dll = load();
    let slave = Slave::ready(&dll);
    slave.brake(0);
    let mut state = ptr::null_mut();
    assert_eq!(slave.save(&mut state), fmi2OK);
    let file = std::env::temp_dir().join(format!("wheelrail state {}", std::process::id()));
    std::fs::write(&file, slave.serialize(state)).unwrap();
    let output = Command::new(std::env::current_exe().unwrap())
        .args(["fmi_state::continue_from_file", "--exact", "--ignored", "--nocapture"])
        .env(STATE_FILE, &file)
        .output()
        .unwrap();
    std::fs::remove_file(&file).unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.success(), "{text}");
    let theirs: Vec<&str> = text.lines().filter(|line| line.starts_with("outputs ")).collect();
    let ours: Vec<String> = varied(&slave, 0.01).iter().map(|bits| format!("outputs {bits:x?}")).collect();
    assert_eq!(ours.len(), 20);
    assert_eq!(theirs, ours);
}

/// The other process of the test above.
#[test]
#[ignore = "needs a state file from another test"]
fn continue_from_file() {
    let bytes = std::fs::read(std::env::var(STATE_FILE).unwrap()).unwrap();
    let dll = load();
    let slave = Slave::new(&dll);
    let mut state = ptr::null_mut();
    assert_eq!(slave.deserialize(&bytes, &mut state), fmi2OK, "{:?}", slave.messages());
    assert_eq!(slave.restore(state), fmi2OK, "{:?}", slave.messages());
    println!();
    for bits in varied(&slave, slave.last_successful_time()) {
        println!("outputs {bits:x?}");
    }
}

#[test]
fn a_serialized_state_of_the_default_wheel_is_small() {
    common::model(common::preset("railway", 20));
    let dll = load();
    let arguments = Arguments { resources: Some(STORED_BASES), ..Default::default() };
    let slave = Slave::try_new(&dll, &arguments).ok().unwrap();
    slave.initialize();
    slave.brake(0);
    let mut state = ptr::null_mut();
    assert_eq!(slave.save(&mut state), fmi2OK);
    let size = slave.serialize(state).len();
    println!("{} kB", size / 1024);
    assert!((1000..2_000_000).contains(&size), "{size}");
}

#[test]
fn a_restored_instance_is_not_terminated_but_remembers_a_hopeless_step() {
    let dll = load();
    let slave = Slave::ready(&dll);
    let mut state = ptr::null_mut();
    assert_eq!(slave.save(&mut state), fmi2OK);
    for hopeless in [false, true, true] {
        assert_eq!(slave.set_real("drive.load", 1e4 * real_start("drive.load")), fmi2OK);
        assert_eq!(slave.step(0.0, 1e-3), fmi2Discard);
        assert_eq!(slave.terminated(), hopeless);
        assert_eq!(slave.restore(state), fmi2OK);
        assert_eq!((slave.last_step(), slave.terminated()), (fmi2OK, false));
    }
}

#[test]
fn a_state_is_restored_even_where_its_parameters_alone_have_no_stationary_state() {
    let dll = load();
    let slave = Slave::coarse(&dll);
    // Free rolling at this creepage would spin the wheel so fast that it outgrows the contact zone; prescribed speeds
    // do not.
    for (name, value) in [("initial.velocity", 200.0), ("initial.creepage", -1.5)] {
        assert_eq!(slave.set_real(name, value), fmi2OK);
    }
    let prescribe = |slave: &Slave| {
        for name in ["control.rotation", "control.translation"] {
            assert_eq!(slave.set_integer(name, 1), fmi2OK);
        }
        assert_eq!(slave.set_real("drive.velocity", 46.0), fmi2OK);
        assert_eq!(slave.set_real("drive.omega", 100.0), fmi2OK);
    };
    prescribe(&slave);
    slave.initialize();
    assert_eq!(slave.step(0.0, 1e-3), fmi2OK);
    let mut state = ptr::null_mut();
    assert_eq!(slave.save(&mut state), fmi2OK);
    let (bytes, outputs) = (slave.serialize(state), slave.outputs());
    let other = Slave::coarse(&dll);
    let mut theirs = ptr::null_mut();
    assert_eq!(other.deserialize(&bytes, &mut theirs), fmi2OK);
    assert_eq!(other.restore(theirs), fmi2OK, "{:?}", other.messages());
    assert_eq!(other.outputs(), outputs);
    assert_eq!(other.free_state(&mut theirs), fmi2OK);
    assert_eq!(slave.free_state(&mut state), fmi2OK);
}
