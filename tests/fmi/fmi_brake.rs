//! The brake and the height of the hub through the compiled library.
#![allow(unsafe_code)]

use crate::slave::*;
use std::ptr;

/// Torque of the brake over time \[N m]: locks the wheel, and lets it go.
fn torque(t: f64) -> f64 {
    4e4 * (t / 0.05).min(1.0).min(((0.5 - t) / 0.3).max(0.0))
}

/// Steps of a millisecond from one to another, with torques that ramp; whether the wheel is locked after each.
fn brake(slave: &Slave, steps: std::ops::Range<usize>) -> Vec<bool> {
    let step = |k: usize| {
        let [t, end] = [k, k + 1].map(|k| k as f64 * 1e-3);
        assert_eq!(slave.set_real("brake.torque", torque(t)), fmi2OK);
        assert_eq!(slave.set_rate("brake.torque", 1, (torque(end) - torque(t)) / 1e-3), fmi2OK);
        assert_eq!(slave.step(t, 1e-3), fmi2OK, "{:?}", slave.messages());
        let (locked, moment) = (slave.boolean("brake.locked"), slave.real("brake.torque_actual"));
        assert!(!locked || slave.real("wheel.omega") == 0.0);
        assert_eq!(slave.real("hub.moment"), moment);
        locked
    };
    steps.map(step).collect()
}

#[test]
fn a_locked_wheel_is_saved_and_let_go_by_another_instance_bit_for_bit() {
    let dll = load();
    let slave = Slave::ready(&dll);
    assert!(!slave.boolean("brake.locked"));
    let locked = brake(&slave, 0..250);
    assert!(locked[249] && !locked[0]);
    let mut state = ptr::null_mut();
    assert_eq!(slave.save(&mut state), fmi2OK);
    let bytes = slave.serialize(state);
    let first = (brake(&slave, 250..500), slave.outputs());
    assert!(!first.0[249], "the brake has let go");

    assert_eq!(slave.restore(state), fmi2OK);
    assert_eq!((brake(&slave, 250..500), slave.outputs()), first);
    let other = Slave::ready(&dll);
    let mut copy = ptr::null_mut();
    assert_eq!(other.deserialize(&bytes, &mut copy), fmi2OK);
    assert_eq!(other.restore(copy), fmi2OK);
    assert_eq!((brake(&other, 250..500), other.outputs()), first);
    assert_eq!((slave.free_state(&mut state), other.free_state(&mut copy)), (fmi2OK, fmi2OK));
}

#[test]
fn a_brake_strength_below_zero_is_refused() {
    let dll = load();
    let slave = Slave::ready(&dll);
    slave.refused(slave.set_real("brake.torque", -1.0), &["brake.torque", "-1", "0 to"]);
}

#[test]
fn a_prescribed_height_that_is_not_set_carries_the_load() {
    let dll = load();
    for load in [None, Some(7e4)] {
        let slave = Slave::coarse(&dll);
        assert_eq!(slave.set_integer("control.vertical", 2), fmi2OK);
        if let Some(load) = load {
            assert_eq!(slave.set_real("drive.load", load), fmi2OK);
        }
        slave.initialize();
        let (force, height) = (slave.real("contact.force_y"), slave.real("hub.height"));
        println!("{force} N at {height} m");
        assert!((force / load.unwrap_or(1e5) - 1.0).abs() < 1e-6 && height < 0.0);
        assert!((slave.real("drive.displacement") - height).abs() < 1e-15);
        for k in 0..20 {
            assert_eq!(slave.step(f64::from(k) * 1e-3, 1e-3), fmi2OK);
        }
        assert!((slave.real("contact.force_y") / force - 1.0).abs() < 1e-4);
    }
    // A height that is set is taken.
    let slave = Slave::coarse(&dll);
    assert_eq!(slave.set_integer("control.vertical", 2), fmi2OK);
    assert_eq!(slave.set_real("drive.displacement", -5e-5), fmi2OK);
    slave.initialize();
    assert!((slave.real("hub.height") + 5e-5).abs() < 1e-15);
}
