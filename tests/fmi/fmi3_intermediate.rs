//! Inputs that a master gives within a step: intermediate update of FMI 3.0.
#![allow(unsafe_code)]

use crate::common::Random;
use crate::slave3::*;
use std::cell::RefCell;
use std::ptr;
use std::rc::Rc;
use wheelrail::fmi::table::table;
use wheelrail::fmi::v3::c_abi::*;
use wheelrail_slave::Status;

const STEP: f64 = 5e-3;

/// A wheel whose master gives moment and load within steps, ready for the first one.
fn asked(early_return: u8) -> Wheel {
    let intermediate = ["drive.moment", "drive.load"].map(reference).to_vec();
    let wheel = Wheel::coarse_with(&Arguments { intermediate, answers: true, early_return, ..Default::default() });
    wheel.initialize();
    wheel
}

/// All real outputs.
fn outputs(wheel: &Wheel) -> Vec<f64> {
    let scalars =
        ["wheel.omega", "wheel.velocity", "contact.force_x", "contact.force_y", "energy.hub_work", "energy.friction"];
    let mut all: Vec<f64> = scalars.map(|name| wheel.float64(name)).to_vec();
    all.extend(["profile.pressure", "profile.shear"].iter().flat_map(|name| wheel.array(name)));
    all
}

/// Largest difference between two runs, over the largest value of each output.
fn difference(one: &[Vec<f64>], two: &[Vec<f64>]) -> f64 {
    let columns = 0..one[0].len();
    let largest = |k: usize| one.iter().map(|row| row[k].abs()).fold(f64::MIN_POSITIVE, f64::max);
    let apart = |k: usize| one.iter().zip(two).map(|(a, b)| (a[k] - b[k]).abs()).fold(0.0, f64::max);
    columns.map(|k| apart(k) / largest(k)).fold(0.0, f64::max)
}

/// Moment and load at a time since the start of a step: a ramp, and a load that rises and falls in turn.
fn straight(step: usize, within: f64) -> [f64; 2] {
    let up = if step.is_multiple_of(2) { within } else { STEP - within };
    [-1e5 * (STEP * step as f64 + within), 1e5 + 1e6 * up]
}

/// Values set within steps of 5 ms; outputs after each.
fn given(wheel: &Wheel, at: fn(usize, f64) -> [f64; 2], steps: usize) -> Vec<Vec<f64>> {
    let step = |k: usize| {
        let time = STEP * k as f64;
        let answer = move |wheel: &Wheel, now: f64| {
            let [moment, load] = at(k, now - time);
            assert_eq!(wheel.set("drive.moment", moment), Status::Ok, "{:?}", wheel.heard());
            assert_eq!(wheel.set("drive.load", load), Status::Ok);
        };
        let (status, told) = wheel.answering(time, STEP, Box::new(answer));
        assert_eq!((status, told.early), (Status::Ok, 0), "{:?}", wheel.heard());
        outputs(wheel)
    };
    (0..steps).map(step).collect()
}

#[test]
fn straight_inputs_within_a_step_are_those_of_their_derivatives_to_round_off() {
    let within = given(&asked(0), straight, 12);
    let wheel = Wheel::ready();
    let ramped: Vec<_> = (0..12)
        .map(|k| {
            let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
            assert_eq!(wheel.set("drive.moment_rate", -1e5), Status::Ok);
            assert_eq!(wheel.set("drive.load_rate", 1e6 * sign), Status::Ok);
            assert_eq!(wheel.step(STEP * f64::from(k), STEP), Status::Ok);
            outputs(&wheel)
        })
        .collect();
    let held = {
        let wheel = Wheel::ready();
        let step = |k: usize| {
            let [moment, load] = straight(k, 0.0);
            assert_eq!((wheel.set("drive.moment", moment), wheel.set("drive.load", load)), (Status::Ok, Status::Ok));
            assert_eq!(wheel.step(STEP * k as f64, STEP), Status::Ok);
            outputs(&wheel)
        };
        (0..12).map(step).collect::<Vec<_>>()
    };
    let (round_off, step) = (difference(&ramped, &within), difference(&ramped, &held));
    println!("inputs within steps against ramps: {round_off:.1e}; held inputs: {step:.1e}");
    assert!(round_off < 1e-9 && step > 1e-3);
}

#[test]
fn bent_inputs_within_a_step_are_those_of_many_short_steps() {
    // A moment that grows and falls within a step, and a load that swings with 50 Hz.
    fn bent(step: usize, within: f64) -> [f64; 2] {
        let time = STEP * step as f64 + within;
        [-1e4 * (100.0 * std::f64::consts::PI * time).sin().powi(2), 1e5 + 5e3 * (314.0 * time).sin()]
    }
    let within = given(&asked(0), bent, 4);
    let wheel = Wheel::ready();
    let parts = 32;
    let h = STEP / f64::from(parts);
    let mut short = Vec::new();
    for k in 0..4 * parts {
        let [now, next] = [k, k + 1].map(|k| bent(0, h * f64::from(k)));
        for (n, name) in ["drive.moment", "drive.load"].iter().enumerate() {
            assert_eq!(wheel.set(name, now[n]), Status::Ok);
            assert_eq!(wheel.set(&format!("{name}_rate"), (next[n] - now[n]) / h), Status::Ok);
        }
        assert_eq!(wheel.step(h * f64::from(k), h), Status::Ok);
        if (k + 1) % parts == 0 {
            short.push(outputs(&wheel));
        }
    }
    let chord = {
        let wheel = Wheel::ready();
        let step = |k: usize| {
            let [now, next] = [k, k + 1].map(|k| bent(k, 0.0));
            for (n, name) in ["drive.moment", "drive.load"].iter().enumerate() {
                assert_eq!(wheel.set(name, now[n]), Status::Ok);
                assert_eq!(wheel.set(&format!("{name}_rate"), (next[n] - now[n]) / STEP), Status::Ok);
            }
            assert_eq!(wheel.step(STEP * k as f64, STEP), Status::Ok);
            outputs(&wheel)
        };
        (0..4).map(step).collect::<Vec<_>>()
    };
    let (found, line) = (difference(&short, &within), difference(&short, &chord));
    println!("inputs within steps against short steps: {found:.1e}; one ramp a step: {line:.1e}");
    // A bend matters from 0.002 of the usual load on, which is 4 % of the swing.
    assert!(found < 0.05 && line > 10.0 * found);
}

#[test]
fn the_master_is_asked_within_the_step_and_what_it_leaves_keeps_its_value() {
    let wheel = asked(0);
    assert_eq!(wheel.set("drive.moment", -700.0), Status::Ok);
    assert_eq!(wheel.set("drive.force_rate", 100.0), Status::Ok);
    let times = Rc::new(RefCell::new(Vec::new()));
    let seen = times.clone();
    let (status, _) = wheel.answering(0.0, STEP, Box::new(move |_, time| seen.borrow_mut().push(time)));
    assert_eq!((status, times.take()), (Status::Ok, [0.25, 0.5, 0.75, 1.0].map(|share| share * STEP).to_vec()));
    assert_eq!(wheel.float64("drive.moment"), -700.0);
    assert_eq!(
        wheel.float64("drive.force"),
        100.0 * STEP,
        "a ramp of an input that nobody sets within the step goes on"
    );
    let twin = Wheel::ready();
    assert_eq!(twin.set("drive.moment", -700.0), Status::Ok);
    assert_eq!(twin.set("drive.force_rate", 100.0), Status::Ok);
    assert_eq!(twin.step(0.0, STEP), Status::Ok);
    assert_eq!(outputs(&twin), outputs(&wheel), "bit for bit");
    let set = |wheel: &Wheel, time: f64| {
        let _ = if time > STEP { wheel.set("drive.moment", -900.0) } else { Status::Ok };
    };
    assert_eq!(wheel.answering(STEP, STEP, Box::new(set)).0, Status::Ok);
    assert_eq!(wheel.float64("drive.moment"), -900.0, "the last value stays");
}

#[test]
fn variables_that_cannot_be_given_within_steps_are_told_and_refused_there() {
    let intermediate = ["drive.moment", "drive.velocity", "contact.force_x"].map(reference).to_vec();
    let wheel = Wheel::coarse_with(&Arguments { intermediate, answers: true, logging: 1, ..Default::default() });
    let (status, _, text) = wheel.heard().into_iter().next().expect("a warning");
    assert!(status == Status::Warning && text.contains("2 variables without intermediateUpdate"), "{text}");
    wheel.initialize();
    let answer = |wheel: &Wheel, _: f64| {
        assert_eq!(wheel.set("drive.moment", -100.0), Status::Ok);
        wheel.refused(wheel.set("drive.velocity", 20.0), &["202 ", "requiredIntermediateVariables"]);
    };
    assert_eq!(wheel.answering(0.0, STEP, Box::new(answer)).0, Status::Ok);
    assert_eq!(wheel.float64("drive.moment"), -100.0);
}

#[test]
fn everything_else_is_refused_within_a_step_and_changes_nothing() {
    let (wheel, twin) = (asked(0), Wheel::ready());
    let answer = |wheel: &Wheel, _: f64| {
        let w = wheel.instance;
        let mut state = ptr::null_mut();
        wheel.refused(wheel.set("drive.force", 1.0), &["requiredIntermediateVariables"]);
        wheel.refused(wheel.set("drive.load", -1.0), &["drive.load"]);
        wheel.refused(wheel.set("drive.load", f64::NAN), &["drive.load"]);
        wheel.refused(wheel.set_item("control.rotation", 1), &["requiredIntermediateVariables"]);
        wheel.refused(wheel.get(&[reference("wheel.omega")], 1).unwrap_err(), &["Intermediate"]);
        wheel.refused(wheel.save(&mut state), &["Intermediate"]);
        wheel.refused(wheel.step(0.0, 1e-3), &["DoStep", "Intermediate"]);
        wheel.refused(wheel.reset(), &["Reset", "Intermediate"]);
        wheel.refused(wheel.terminate(), &["Terminate", "Intermediate"]);
        wheel.refused(wheel.exit(), &["Intermediate"]);
        // SAFETY: a living instance and one value.
        let status = unsafe { fmi3SetFloat64(w, &reference("drive.load"), 1, [1e5, 1e5].as_ptr(), 2) };
        wheel.refused(status, &["nValues = 2"]);
    };
    assert_eq!(wheel.answering(0.0, STEP, Box::new(answer)).0, Status::Ok);
    assert_eq!(twin.step(0.0, STEP), Status::Ok);
    assert_eq!(outputs(&twin), outputs(&wheel));
    assert_eq!(wheel.set("drive.moment_rate", 5.0), Status::Ok);
    let twice =
        |wheel: &Wheel, _: f64| wheel.refused(wheel.set("drive.moment", 1.0), &["drive.moment", "drive.moment_rate"]);
    assert_eq!(wheel.answering(STEP, STEP, Box::new(twice)).0, Status::Ok);
}

#[test]
fn a_step_that_cannot_be_computed_half_way_is_taken_back_as_a_whole() {
    let (wheel, twin) = (asked(0), Wheel::ready());
    let much = |wheel: &Wheel, time: f64| {
        let load = if time > 0.7 * STEP { 1e9 } else { 1e5 };
        assert_eq!(wheel.set("drive.load", load), Status::Ok);
    };
    let before = outputs(&wheel);
    let (status, told) = wheel.answering(0.0, STEP, Box::new(much));
    assert_eq!((status, told.time, told.terminate), (Status::Discard, 0.0, 0));
    assert_eq!((outputs(&wheel), wheel.float64("drive.load")), (before, 1e5));
    let (status, told) = wheel.answering(0.0, STEP, Box::new(much));
    assert_eq!((status, told.terminate), (Status::Discard, 1), "the same step failed twice");
    let (status, told) = wheel.answering(0.0, STEP, Box::new(|_, _| {}));
    assert_eq!((status, told.time), (Status::Ok, STEP));
    assert_eq!(twin.step(0.0, STEP), Status::Ok);
    assert_eq!(outputs(&twin), outputs(&wheel));
}

#[test]
fn a_master_that_frees_the_instance_within_a_step_gets_an_error() {
    let wheel = asked(0);
    let answer = |wheel: &Wheel, _: f64| unsafe { fmi3FreeInstance(wheel.instance) };
    assert_eq!(wheel.answering(0.0, STEP, Box::new(answer)).0, Status::Error);
    assert_eq!(wheel.reset(), Status::Error, "there is no instance any more");
}

#[test]
fn random_calls_within_steps_end_with_a_status_and_finite_outputs() {
    let wheel = Rc::new(asked(1));
    let random = Rc::new(RefCell::new(Random(11)));
    let (mut time, mut counts) = (0.0, [0usize; 5]);
    for _ in 0..300 {
        let random = random.clone();
        let answer = move |wheel: &Wheel, _: f64| {
            let mut random = random.borrow_mut();
            for _ in 0..random.below(6) {
                let row = random.of(&table().iter().collect::<Vec<_>>());
                let number = random.of(&[0.0, -1e3, 1e5, 1e300, f64::NAN, f64::INFINITY]);
                let mut state = ptr::null_mut();
                match random.below(9) {
                    0 => wheel.set(row.name, number),
                    1 => wheel.set_item(row.name, number as i64),
                    2 => wheel.get(&[row.reference], row.dimension.unwrap_or(1)).err().unwrap_or(Status::Ok),
                    3 => wheel.save(&mut state),
                    4 => wheel.step(0.0, 1e-3),
                    5 => wheel.set_logging(random.below(2) == 0, &[]),
                    6 => wheel.set("drive.load", random.between(5e4, 1.5e5)),
                    _ => wheel.set("drive.moment", random.between(-1e4, 1e4)),
                };
                wheel.heard();
            }
        };
        let (status, told) = wheel.answering(time, 1e-3, Box::new(answer));
        counts[status as usize] += 1;
        assert!(matches!(status, Status::Ok | Status::Discard), "{status:?}: {:?}", wheel.heard());
        time = told.time;
        assert!(outputs(&wheel).iter().all(|value| value.is_finite()));
        wheel.heard();
    }
    println!("300 steps: {} done, {} discarded", counts[0], counts[2]);
    assert!(counts[0] > 200);
}
