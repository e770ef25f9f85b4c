//! The protocol of FMI 3.0 on the exported functions: what masters may call when, and what they get.
#![allow(unsafe_code)]

use crate::common::Random;
use crate::slave3::*;
use std::ptr;
use wheelrail::fmi::table::table;
use wheelrail::fmi::v3::c_abi::*;
use wheelrail::fmi::variable::{Causality, Kind};
use wheelrail_slave::Status;

#[test]
fn instantiation_with_wrong_arguments_gives_null_and_a_logged_reason() {
    let refused = |arguments: Arguments, word: &str| {
        let heard = Wheel::try_new(&arguments).err().expect("refused");
        let (status, category, text) = heard.last().expect("a message");
        assert!(text.contains(word) && *status == Status::Error, "{text}");
        assert_eq!(category, "logStatusError");
    };
    refused(Arguments { token: Some("{0}".to_owned()), ..Default::default() }, "instantiationToken = \"{0}\"");
    refused(Arguments { token: None, ..Default::default() }, "instantiationToken is NULL");
    refused(Arguments { name: Some(""), ..Default::default() }, "instanceName");
    refused(Arguments { name: None, ..Default::default() }, "instanceName");
    refused(Arguments { event_mode: 1, ..Default::default() }, "hasEventMode");
    refused(Arguments { event_mode: 2, ..Default::default() }, "eventModeUsed = 2 is no fmi3Boolean");
    refused(Arguments { visible: 255, ..Default::default() }, "visible = 255 ");
    refused(Arguments { logging: 3, ..Default::default() }, "loggingOn = 3 ");
    assert!(!fmi3GetVersion().is_null());
    let none = [
        unsafe_free(|| {
            fmi3InstantiateModelExchange(ptr::null(), ptr::null(), ptr::null(), 0, 0, ptr::null_mut(), None)
        }),
        unsafe_free(|| {
            fmi3InstantiateScheduledExecution(
                ptr::null(),
                ptr::null(),
                ptr::null(),
                0,
                0,
                ptr::null_mut(),
                None,
                None,
                None,
                None,
            )
        }),
    ];
    assert!(none.iter().all(|instance| instance.is_null()));
}

/// These two follow no pointer, so that calling them needs no promise.
fn unsafe_free<R>(call: impl FnOnce() -> R) -> R {
    call()
}

#[test]
fn resources_are_a_native_path_or_none() {
    let wheel = Wheel::try_new(&Arguments::default()).ok().unwrap();
    assert_eq!(wheel.set_string("preset", "railway_dry"), Status::Ok);
    let wheel = Wheel::try_new(&Arguments { resources: None, ..Default::default() }).ok().unwrap();
    wheel.refused(wheel.set_string("preset", "railway_dry"), &["railway_dry", "available presets: railway"]);
}

#[test]
fn start_values_are_read_before_initialization_and_outputs_are_not() {
    let wheel = Wheel::coarse();
    assert_eq!(wheel.float64("wheel.radius"), 0.46);
    assert_eq!(wheel.set("wheel.radius", 0.5), Status::Ok);
    assert_eq!(wheel.float64("wheel.radius"), 0.5);
    assert_eq!((wheel.string("preset"), wheel.item("control.rotation")), ("railway".to_owned(), 2));
    assert_eq!(wheel.get(&[0], 1), Ok(vec![0.0]), "time");
    wheel.refused(wheel.get(&[reference("contact.force_x")], 1).unwrap_err(), &["contact.force_x", "no start value"]);
    assert_eq!(wheel.enter(3.0, Some(4.0)), Status::Ok);
    assert!(wheel.float64("contact.force_y") > 0.0);
    assert_eq!(wheel.get(&[0, reference("drive.load"), 0], 3).unwrap()[2], 3.0);
    wheel.refused(unsafe { fmi3SetFloat64(wheel.instance, &0, 1, &1.0, 1) }, &["time", "independent"]);
}

#[test]
fn calls_out_of_turn_are_refused_and_change_nothing() {
    let wheel = Wheel::coarse();
    wheel.refused(wheel.step(0.0, 1e-3), &["DoStep", "Instantiated"]);
    wheel.refused(wheel.exit(), &["Instantiated"]);
    wheel.refused(wheel.terminate(), &["Instantiated"]);
    wheel.refused(wheel.enter(0.0, Some(-1.0)), &["stopTime"]);
    wheel.initialize();
    wheel.refused(wheel.enter(0.0, None), &["StepComplete"]);
    let before = wheel.float64("wheel.velocity");
    wheel.refused(wheel.step(1.0, 1e-3), &["currentCommunicationPoint"]);
    wheel.refused(wheel.set("wheel.velocity", 1.0), &["wheel.velocity", "output"]);
    wheel.refused(wheel.set("wheel.radius", 0.4), &["wheel.radius", "fixed"]);
    assert_eq!(wheel.float64("wheel.velocity"), before);
    let (status, told) = wheel.told(0.0, 1e-3);
    assert_eq!((status, told), (Status::Ok, Told { event: 0, terminate: 0, early: 0, time: 1e-3 }));
    assert_eq!(wheel.get(&[0], 1), Ok(vec![1e-3]));
    assert_eq!(wheel.terminate(), Status::Ok);
    assert!(wheel.float64("wheel.velocity") > 0.0);
    wheel.refused(wheel.step(1e-3, 1e-3), &["Terminated"]);
    assert_eq!(wheel.reset(), Status::Ok);
    assert_eq!(wheel.float64("wheel.radius"), 0.46);
}

#[test]
fn a_discarded_step_leaves_the_wheel_where_it_was_and_the_run_goes_on() {
    let wheel = Wheel::ready();
    assert_eq!(wheel.step(0.0, 1e-3), Status::Ok);
    let (load, before) = (wheel.float64("drive.load"), wheel.float64("wheel.velocity"));
    assert_eq!(wheel.set("drive.load", 1e4 * load), Status::Ok);
    assert!(wheel.heard().is_empty());
    let (status, told) = wheel.told(1e-3, 1e-3);
    assert_eq!((status, told.time, told.terminate), (Status::Discard, 1e-3, 0));
    assert!(wheel.heard().is_empty(), "logging is off");
    assert_eq!(wheel.set_logging(true, &["logStatusDiscard"]), Status::Ok);
    let (status, told) = wheel.told(1e-3, 1e-3);
    assert_eq!((status, told.terminate), (Status::Discard, 1), "the same step failed twice");
    assert!(wheel.heard()[0].2.contains("model.nominal_load"));
    assert_eq!(wheel.float64("wheel.velocity"), before);
    assert_eq!(wheel.set("drive.load", load), Status::Ok);
    assert_eq!(wheel.told(1e-3, 1e-3).1, Told { event: 0, terminate: 0, early: 0, time: 2e-3 });
}

#[test]
fn warnings_come_only_where_logging_is_on_and_errors_always() {
    let warned = |logging: u8| {
        let wheel =
            Wheel::try_new(&Arguments { resources: Some("/nowhere/at/all".to_owned()), logging, ..Default::default() });
        let wheel = wheel.ok().unwrap();
        wheel.set_string("preset", "railway_dry");
        wheel.heard().into_iter().map(|(status, ..)| status).collect::<Vec<_>>()
    };
    assert_eq!(warned(0), [Status::Error]);
    assert_eq!(warned(1), [Status::Warning, Status::Error]);
}

#[test]
fn values_of_the_wrong_type_or_number_are_refused_by_name() {
    let wheel = Wheel::ready();
    wheel.refused(wheel.set_int32("drive.load", 1), &["drive.load", "Float64, not Int32"]);
    wheel.refused(wheel.set_int32("control.rotation", 1), &["control.rotation", "Int64, not Int32"]);
    wheel.refused(wheel.set_item("control.rotation", 1 << 40), &["1099511627776", "no item"]);
    wheel.refused(wheel.set_item("control.rotation", 9), &["control.rotation", "9"]);
    wheel.refused(wheel.set_boolean("thermal.enabled", 2), &["2 is no fmi3Boolean"]);
    wheel.refused(wheel.get(&[987_654], 1).unwrap_err(), &["987654", "unknown"]);
    wheel.refused(wheel.get(&[reference("profile.pressure")], 3).unwrap_err(), &["nValues = 3", "61 values"]);
    let many = [reference("drive.load"), reference("drive.moment")];
    let status = unsafe { fmi3SetFloat64(wheel.instance, many.as_ptr(), 2, [1e5; 3].as_ptr(), 3) };
    wheel.refused(status, &["nValues = 3", "2 values"]);
    let status = unsafe { fmi3SetFloat64(wheel.instance, ptr::null(), 2, [1e5; 2].as_ptr(), 2) };
    wheel.refused(status, &["valueReferences is NULL"]);
    let pressure = [reference("profile.pressure")];
    let status = unsafe { fmi3SetFloat64(wheel.instance, pressure.as_ptr(), 1, [1e5; 61].as_ptr(), 61) };
    wheel.refused(status, &["profile.pressure[1]", "output"]);
    assert_eq!(wheel.get(&[], 0), Ok(vec![]));
}

#[test]
fn what_this_fmu_does_not_have_is_refused_politely() {
    let wheel = Wheel::ready();
    let w = wheel.instance;
    let no = ptr::null_mut();
    // SAFETY: a living instance; refused calls follow no other pointer.
    let refusals = unsafe {
        [
            (fmi3EnterEventMode(w), "Event Mode"),
            (fmi3EnterStepMode(w), "Event Mode"),
            (fmi3UpdateDiscreteStates(w, no, no, no, no, no, ptr::null_mut()), "Event Mode"),
            (fmi3EnterConfigurationMode(w), "structural parameters"),
            (fmi3ExitConfigurationMode(w), "structural parameters"),
            (fmi3GetClock(w, ptr::null(), 1, no), "clocks"),
            (fmi3ActivateModelPartition(w, 0, 0.0), "clocks"),
            (fmi3GetFloat32(w, ptr::null(), 1, ptr::null_mut(), 1), "type"),
            (fmi3SetBinary(w, ptr::null(), 1, ptr::null(), ptr::null(), 1), "type"),
            (fmi3GetNumberOfVariableDependencies(w, 0, ptr::null_mut()), "providesPerElementDependencies"),
            (fmi3EnterContinuousTimeMode(w), "Model Exchange"),
            (fmi3SetTime(w, 0.0), "Model Exchange"),
        ]
    };
    let heard = wheel.heard();
    assert_eq!(heard.len(), refusals.len());
    for ((status, word), (_, category, text)) in refusals.into_iter().zip(heard) {
        assert!(status == Status::Error && category == "logStatusError" && text.contains(word), "{text}");
    }
    assert_eq!(wheel.step(0.0, 1e-3), Status::Ok, "refusals change nothing");
    assert_eq!(unsafe { fmi3EnterEventMode(ptr::null_mut()) }, Status::Error);
}

/// Arrays of so many elements do not fit into any memory: their sizes in bytes wrap around, some to nothing.
const IMPOSSIBLE: [usize; 6] = [usize::MAX, (1 << 63) + 1, 1 << 63, 1 << 62, 1 << 61, 1 << 32];

#[test]
fn numbers_of_elements_that_no_array_has_are_refused_by_every_function() {
    let wheel = Wheel::ready();
    assert_eq!(wheel.step(0.0, 1e-3), Status::Ok);
    let (w, reference, mut state, mut other) =
        (wheel.instance, reference("drive.load"), ptr::null_mut(), ptr::null_mut());
    assert_eq!(wheel.save(&mut state), Status::Ok);
    let before = wheel.float64("contact.force_x");
    let (mut real, mut whole, mut long, mut flag, mut text) = (0.0, 0, 0, 0, ptr::null());
    for n in IMPOSSIBLE {
        let words = format!("= {n} is outside its range");
        let refused = |call: &mut dyn FnMut() -> Status| wheel.refused(call(), &["number of elements", &words]);
        // SAFETY: every array has one element; no number below is that of its elements, which is what is tried.
        unsafe {
            refused(&mut || fmi3GetFloat64(w, &reference, n, &mut real, n));
            refused(&mut || fmi3GetInt32(w, &reference, n, &mut whole, n));
            refused(&mut || fmi3GetInt64(w, &reference, n, &mut long, n));
            refused(&mut || fmi3GetBoolean(w, &reference, n, &mut flag, n));
            refused(&mut || fmi3GetString(w, &reference, n, &mut text, n));
            for (references, values) in [(n, n), (n, 1), (1, n)] {
                refused(&mut || fmi3SetFloat64(w, &reference, references, &1e5, values));
                refused(&mut || fmi3SetInt32(w, &reference, references, &1, values));
                refused(&mut || fmi3SetInt64(w, &reference, references, &1, values));
                refused(&mut || fmi3SetBoolean(w, &reference, references, &1, values));
                refused(&mut || fmi3SetString(w, &reference, references, &c"a".as_ptr(), values));
            }
            for [a, b, c] in [[n, 1, 1], [1, n, 1], [1, 1, n]] {
                refused(&mut || fmi3GetDirectionalDerivative(w, &reference, a, &reference, b, &1.0, c, &mut real, 1));
                refused(&mut || fmi3GetAdjointDerivative(w, &reference, a, &reference, b, &1.0, c, &mut real, 1));
            }
            refused(&mut || fmi3GetOutputDerivatives(w, &reference, n, &1, &mut real, n));
            refused(&mut || fmi3SetDebugLogging(w, 0, n, &c"logAll".as_ptr()));
            refused(&mut || fmi3SerializeFMUState(w, state, &mut flag, n));
            refused(&mut || fmi3DeserializeFMUState(w, &flag, n, &mut other));
            // The numbers of values that are written must be those of the variables.
            wheel.refused(fmi3GetFloat64(w, &reference, 1, &mut real, n), &["nValues = ", &n.to_string()]);
        }
    }
    assert!(other.is_null() && wheel.float64("contact.force_x") == before && wheel.step(1e-3, 1e-3) == Status::Ok);
}

#[test]
fn seeds_that_are_no_finite_numbers_are_refused() {
    let wheel = Wheel::ready();
    assert_eq!(wheel.step(0.0, 1e-3), Status::Ok);
    let [force, load] = ["contact.force_x", "drive.load"].map(reference);
    for seed in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let value = format!("= {seed:?} is outside its range: finite numbers");
        wheel.refused(wheel.adjoint(&[force, force], &[load], &[1.0, seed]).unwrap_err(), &["seed[2]", &value]);
        wheel.refused(wheel.adjoint(&[], &[], &[seed]).unwrap_err(), &["seed[1]", &value]);
        wheel.refused(wheel.directional(&[force], &[load], &[seed], 1).unwrap_err(), &["seed of drive.load", &value]);
    }
    // Each weight is a number, their product with a derivative is none.
    let slope = wheel.adjoint(&[reference("contact.approach")], &[load], &[1.0]).unwrap()[0];
    assert!(slope != 0.0 && slope.is_finite());
    let elevation = reference("rail.elevation");
    wheel.refused(
        wheel.adjoint(&[reference("contact.force_y")], &[elevation], &[1e308]).unwrap_err(),
        &["seed is too large"],
    );
}

#[test]
fn adjoint_derivatives_are_the_transpose_of_directional_ones() {
    let wheel = Wheel::ready();
    assert_eq!(wheel.set("drive.moment", -500.0), Status::Ok);
    assert_eq!(wheel.step(0.0, 1e-3), Status::Ok);
    let knowns = ["drive.moment", "drive.force", "drive.load", "rail.friction"].map(reference);
    let unknowns = ["contact.force_x", "wheel.omega", "profile.pressure", "contact.force_y"].map(reference);
    let size = 64;
    let rows: Vec<Vec<f64>> =
        knowns.iter().map(|known| wheel.directional(&unknowns, &[*known], &[1.0], size).unwrap()).collect();
    let mut random = Random(1);
    let (mut worst, mut largest) = (0.0_f64, 0.0_f64);
    for _ in 0..20 {
        let seed: Vec<f64> = (0..size).map(|_| random.between(-1.0, 1.0)).collect();
        let adjoint = wheel.adjoint(&unknowns, &knowns, &seed).unwrap();
        for (row, found) in rows.iter().zip(adjoint) {
            let terms: Vec<f64> = row.iter().zip(&seed).map(|(a, b)| a * b).collect();
            let scale: f64 = terms.iter().map(|term| term.abs()).sum();
            worst = worst.max((terms.iter().sum::<f64>() - found).abs() / scale.max(f64::MIN_POSITIVE));
            largest = largest.max(scale);
        }
    }
    println!("adjoint against directional derivatives: {worst:.1e} of {largest:.1e}");
    assert!(worst < 1e-12 && largest > 0.0);
    wheel.refused(wheel.adjoint(&unknowns, &knowns, &[1.0]).unwrap_err(), &["nSeed = 1", "64 values"]);
    wheel.refused(wheel.directional(&unknowns, &knowns, &[1.0], size).unwrap_err(), &["nSeed = 1", "4 values"]);
    let rates = wheel.output_rates(&unknowns, &[1; 4], size).unwrap();
    assert!(rates.iter().all(|rate| rate.is_finite()) && rates[1] != 0.0);
    wheel.refused(wheel.output_rates(&unknowns[..1], &[2], 1).unwrap_err(), &["contact.force_x", "order 2"]);
}

#[test]
fn a_damaged_state_is_refused_and_a_whole_one_continues_bit_for_bit() {
    let wheel = Wheel::ready();
    let run = |wheel: &Wheel, first: usize| {
        let step = |i: usize| {
            assert_eq!(wheel.set("drive.moment", -200.0 * (1 + i % 7) as f64), Status::Ok);
            assert_eq!(wheel.step(1e-3 * i as f64, 1e-3), Status::Ok);
            [wheel.float64("wheel.omega"), wheel.float64("contact.force_x"), wheel.array("profile.shear")[30]]
        };
        (first..first + 5).map(step).collect::<Vec<_>>()
    };
    run(&wheel, 0);
    let (mut state, mut other) = (ptr::null_mut(), ptr::null_mut());
    assert_eq!(wheel.save(&mut state), Status::Ok);
    let bytes = wheel.serialize(state);
    let expected = run(&wheel, 5);
    assert_eq!(wheel.restore(state), Status::Ok);
    assert_eq!(run(&wheel, 5), expected);
    let twin = Wheel::coarse();
    let mut random = Random(3);
    for _ in 0..200 {
        let mut damaged = bytes.clone();
        let at = random.below(bytes.len());
        damaged[at] ^= 1 << random.below(8);
        assert_eq!(twin.deserialize(&damaged, &mut other), Status::Error, "byte {at}");
        assert_eq!(twin.deserialize(&bytes[..at], &mut other), Status::Error, "{at} bytes");
    }
    assert!(other.is_null());
    assert_eq!(twin.deserialize(&bytes, &mut other), Status::Ok);
    assert_eq!(twin.restore(other), Status::Ok);
    assert_eq!(run(&twin, 5), expected);
    assert_eq!(twin.restore(state), Status::Error, "a state of another instance");
    assert_eq!((wheel.forget(&mut state), twin.forget(&mut other)), (Status::Ok, Status::Ok));
    assert!(state.is_null() && other.is_null());
}

/// Random calls; `WHEELRAIL_FMI3_CALLS` asks for more than the usual 20,000.
#[test]
fn random_legal_and_illegal_calls_end_with_a_status_and_finite_outputs() {
    let calls = std::env::var("WHEELRAIL_FMI3_CALLS").ok().and_then(|n| n.parse().ok()).unwrap_or(20_000);
    let (mut random, mut wheel, mut state) = (Random(7), Wheel::ready(), ptr::null_mut());
    let (mut time, mut counts) = (0.0, [0usize; 5]);
    let values = [0.0, -0.0, 1.0, -1e3, 1e5, 1e300, f64::NAN, f64::INFINITY];
    let outputs: Vec<_> = table()
        .iter()
        .filter(|row| row.causality() == Causality::Output && matches!(row.kind, Kind::Real { .. }))
        .collect();
    for call in 0..calls {
        let row = random.of(&table().iter().collect::<Vec<_>>());
        let number = random.of(&values);
        let status = match random.below(24) {
            0 => wheel.enter(0.0, None),
            1 => wheel.exit(),
            2 if random.below(40) == 0 => wheel.terminate(),
            3 if random.below(20) == 0 => wheel.reset(),
            4 => wheel.save(&mut state),
            5 if !state.is_null() => wheel.restore(state),
            6 if random.below(4) == 0 => wheel.forget(&mut state),
            7 | 8 => {
                let (status, told) = wheel.told(time, 1e-4);
                time = if status == Status::Ok { told.time } else { time };
                status
            }
            9 => wheel.step(number, number),
            10 => wheel.set(row.name, number),
            11 => wheel.set_int32(row.name, number as i32),
            12 => wheel.set_item(row.name, number as i64),
            13 => wheel.set_boolean(row.name, number as u8),
            14 => wheel.get(&[row.reference], row.dimension.unwrap_or(1)).err().unwrap_or(Status::Ok),
            15 => wheel.get(&[row.reference + 1], random.below(3)).err().unwrap_or(Status::Ok),
            16 => wheel.output_rates(&[row.reference], &[1], row.dimension.unwrap_or(1)).err().unwrap_or(Status::Ok),
            17 if random.below(50) == 0 => {
                let known = reference("drive.moment");
                wheel.adjoint(&[row.reference], &[known], &[number]).err().unwrap_or(Status::Ok)
            }
            18 => wheel.set_logging(random.below(2) == 0, &[]),
            19 => unsafe { fmi3EnterEventMode(wheel.instance) },
            20 => unsafe { fmi3GetFloat64(wheel.instance, ptr::null(), 3, ptr::null_mut(), 3) },
            21 if random.below(100) == 0 => {
                (wheel, state, time) = (Wheel::ready(), ptr::null_mut(), 0.0);
                Status::Ok
            }
            _ => wheel.set("drive.moment", random.between(-1e4, 1e4)),
        };
        counts[status as usize] += 1;
        assert_ne!(status, Status::Fatal, "call {call}");
        time = wheel.get(&[0], 1).map_or(time, |now| now[0]);
        if call % 500 == 0 {
            for output in &outputs {
                let found = wheel.get(&[output.reference], output.dimension.unwrap_or(1));
                assert!(found.is_ok_and(|all| all.iter().all(|v| v.is_finite())) || !wheel.heard().is_empty());
            }
        }
        wheel.heard();
    }
    println!("{calls} calls: {} ok, {} discarded, {} refused", counts[0], counts[2], counts[3]);
    assert!(counts[0] > calls / 10 && counts[3] > calls / 10 && counts[1] == 0);
}

/// A wheel that a brake locks at low adhesion, with what its master allows.
fn braked(early_return: u8) -> Wheel {
    let wheel = Wheel::coarse_with(&Arguments { early_return, ..Default::default() });
    assert_eq!(wheel.set("initial.velocity", 5.0), Status::Ok);
    assert_eq!(wheel.set("friction.coefficient", 0.1), Status::Ok);
    wheel.initialize();
    wheel
}

/// Steps of 5 ms up to 0.2 s under a torque that is taken away after 0.1 s; what each has told, and the end of the run.
fn locked_and_released(wheel: &Wheel) -> (Vec<(Told, u8)>, [f64; 3]) {
    let (mut time, mut told, mut k) = (0.0, Vec::new(), 0);
    while k < 40 {
        let end = 5e-3 * f64::from(k + 1);
        assert_eq!(wheel.set("brake.torque", if k < 20 { 3e4 } else { 0.0 }), Status::Ok);
        let (status, now) = wheel.told(time, end - time);
        assert_eq!(status, Status::Ok, "{:?}", wheel.heard());
        time = now.time;
        told.push((now, wheel.boolean("brake.locked")));
        k += i32::from(now.early == 0);
    }
    (told, ["wheel.velocity", "wheel.omega", "wheel.distance"].map(|name| wheel.float64(name)))
}

#[test]
fn a_step_returns_early_where_the_wheel_locks_and_is_released_and_the_run_has_the_same_end() {
    let (whole, expected) = locked_and_released(&braked(0));
    assert!(whole.iter().all(|(told, _)| told.early == 0) && whole.len() == 40);
    let locked_at = whole.iter().position(|(_, locked)| *locked == 1).unwrap() as f64 * 5e-3;
    let (cut, end) = locked_and_released(&braked(1));
    let early: Vec<_> = cut.iter().filter(|(told, _)| told.early == 1).collect();
    let lock = early.iter().find(|(_, locked)| *locked == 1).expect("an early return at the lock").0.time;
    println!(
        "locks at {:.3} ms, within the step from {:.0} ms; {} early returns",
        1e3 * lock,
        1e3 * locked_at,
        early.len()
    );
    assert!(lock > locked_at && lock < locked_at + 5e-3);
    assert!(early.len() >= 2 && early.len() <= 6, "{early:?}");
    for (a, b) in end.iter().zip(expected) {
        println!("{a:.9} and {b:.9} at the end");
        // What the step control leaves of a stick that ends.
        assert!((a - b).abs() < 1e-3 * b.abs().max(1.0));
    }
}

#[test]
fn an_early_return_is_within_one_internal_step_of_the_lock() {
    let fine = braked(0);
    let short = 2e-5;
    assert_eq!(fine.set("brake.torque", 3e4), Status::Ok);
    let mut steps = 0;
    while fine.boolean("brake.locked") == 0 {
        assert_eq!(fine.step(short * f64::from(steps), short), Status::Ok);
        steps += 1;
        assert!(steps < 1000, "the wheel does not lock");
    }
    let wheel = braked(1);
    assert_eq!(wheel.set("brake.torque", 3e4), Status::Ok);
    let (mut start, mut told) = (0.0, wheel.told(0.0, 5e-3).1);
    while told.early == 0 {
        start = told.time;
        told = wheel.told(start, 5e-3).1;
    }
    let (expected, inner) =
        (short * f64::from(steps), (told.time - start) / f64::from(wheel.int32("solver.internal_steps")));
    println!(
        "locks at {:.3} ms, in steps of {short} s at {:.3} ms; internal steps of {:.3} ms",
        1e3 * told.time,
        1e3 * expected,
        1e3 * inner
    );
    assert_eq!(wheel.boolean("brake.locked"), 1);
    assert!((told.time - expected).abs() < inner + short);
}
