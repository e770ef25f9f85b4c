//! Setting up a run through the compiled library: in any order, judged as a whole, corrected where it was refused.

use crate::slave::*;
use wheelrail::fmi::v2::variables::variables;
use wheelrail::fmi::variable::{Causality, Kind};

#[test]
fn the_order_of_sets_does_not_matter() {
    let dll = load();
    // Alone, this creepage at the initial velocity of the preset makes the rim faster than surface waves.
    let settings = [("initial.creepage", -1.99), ("initial.velocity", 0.1), ("wheel.radius", 0.05)];
    let hub = ("wheel.hub_radius", 0.02);
    let run = |settings: &[(&str, f64)]| {
        let slave = Slave::coarse(&dll);
        for (name, value) in settings {
            assert_eq!(slave.set_real(name, *value), fmi2OK, "{:?}", slave.messages());
        }
        assert_eq!(slave.set_real("model.nominal_load", 2e3), fmi2OK);
        // For ever, a wheel that spins on the spot would be softer than any steel.
        assert_eq!(slave.set_boolean("physics.yielding", false), fmi2OK);
        slave.initialize();
        slave.outputs()
    };
    let first = run(&[settings[0], settings[1], settings[2], hub]);
    assert_eq!(run(&[settings[2], settings[0], hub, settings[1]]), first);
    assert_eq!(run(&[hub, settings[1], settings[2], settings[0]]), first);
}

#[test]
fn what_does_not_go_together_is_refused_with_the_variables_that_were_set_and_can_be_corrected() {
    let dll = load();
    let slave = Slave::coarse(&dll);
    assert_eq!(slave.set_real("initial.creepage", -1.99), fmi2OK);
    assert_eq!(slave.enter(), fmi2OK);
    let words = ["initial.creepage = -1.99", "at least -1.96", "initial.velocity = 27.7", "surface waves"];
    slave.refused(slave.get_reals(&[variable("contact.force_y").reference]).unwrap_err(), &words);
    slave.refused(slave.exit(), &words);
    slave.refused(slave.step(0.0, 1e-3), &["Initialization"]);
    assert_eq!(slave.set_real("initial.creepage", 1e-4), fmi2OK);
    assert!(slave.real("contact.force_y") > 0.0);
    assert_eq!(slave.set_real("wheel.radius", 0.05), fmi2OK);
    let words = ["wheel.hub_radius", "0.001 to 0.045", "preset \"railway\"", "wheel.radius = 0.05", "initial.creepage"];
    slave.refused(slave.exit(), &words);
    assert_eq!(slave.set_real("wheel.radius", 0.46), fmi2OK);
    assert_eq!(slave.exit(), fmi2OK);
    assert_eq!(slave.step(0.0, 1e-3), fmi2OK);
}

/// Numbers are short, and no word of a programming language comes through.
#[test]
fn a_value_that_is_no_value_is_refused_with_a_short_message_for_every_variable() {
    let dll = load();
    let slave = Slave::coarse(&dll);
    for variable in variables().iter().filter(|v| v.causality() != Causality::Output) {
        let name = &variable.name;
        match variable.kind {
            Kind::Real { .. } => {
                for (value, text) in [(1e300, "1e300"), (-1e300, "-1e300"), (f64::NAN, "NaN"), (5e-324, "5e-324")] {
                    let status = slave.set_real(name, value);
                    if status != fmi2OK {
                        slave.refused(status, &[&format!("{name} = {text} is outside its range")]);
                    }
                    assert!(status == fmi2Error || text == "5e-324", "{name} = {text}");
                }
            }
            Kind::Integer { .. } | Kind::Enumeration(_) => {
                let text = format!("{name} = {} is outside its range", i32::MIN);
                slave.refused(slave.set_integer(name, i32::MIN), &[&text]);
            }
            Kind::Boolean => slave.refused(slave.set_c_boolean(name, 7), &[&format!("{name} = 7 ")]),
            Kind::String if *name == "preset" => slave.refused(slave.set_string(name, "x y"), &[name, "x y"]),
            // Parameters that a profile needs are known at the end.
            Kind::String => {
                let slave = Slave::coarse(&dll);
                assert_eq!(slave.set_string(name, "x y"), fmi2OK);
                assert_eq!(slave.setup(0.0, None), fmi2OK);
                let entered = slave.enter();
                let status = if entered == fmi2OK { slave.exit() } else { entered };
                let why = if *name == "wheel.profile_save" { "must end in .csv" } else { "column" };
                slave.refused(status, &[name, why]);
            }
        }
    }
    let slave = Slave::coarse(&dll);
    let status = unsafe { dll.fmi2SetupExperiment(slave.component, 1, -1.0, 0.0, 0, 0.0) };
    assert_eq!(status, fmi2Error);
    assert_eq!(
        slave.messages()[0].text,
        "fmi2SetupExperiment: tolerance = -1.0 is outside its range: positive numbers"
    );
}

#[test]
fn limits_of_the_model_are_told_once_with_both_numbers_although_no_log_was_asked_for() {
    let dll = load();
    let warnings = |settings: &[(&str, f64)]| {
        let slave = Slave::coarse(&dll);
        for (name, value) in settings {
            assert_eq!(slave.set_real(name, *value), fmi2OK);
        }
        slave.initialize();
        slave.brake(0);
        let messages = slave.messages();
        assert!(messages.iter().all(|m| m.status == fmi2Warning && m.category == "logStatusWarning"), "{messages:?}");
        messages.into_iter().map(|message| message.text).collect::<Vec<_>>()
    };
    assert_eq!(warnings(&[]), [""; 0]);
    let one = |settings: &[(&str, f64)], words: &[&str]| {
        let found = warnings(settings);
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(words.iter().all(|word| found[0].contains(word)), "{found:?}");
    };
    one(&[("thermal.max_speed", 20.0)], &["t = 0.0 s", "speed 27.8 m/s", "thermal.max_speed = 20.0 m/s", "raise"]);
    let load = [("drive.load", 40e3), ("thermal.smallest_load_ratio", 0.5)];
    one(&load, &["load 40000 N", "thermal.smallest_load_ratio x model.nominal_load = 50000 N", "lower"]);
    one(&[("drive.load", 205e3)], &["load 205", "2 x model.nominal_load = 200000 N", "drive.load"]);
    let little = [("drive.load", 10e3), ("thermal.smallest_load_ratio", 0.09)];
    // Contact nodes follow the load.
    assert_eq!(warnings(&little), [""; 0]);
}

#[test]
fn a_limit_passed_during_the_run_is_told_then_and_again_in_the_next_run() {
    let dll = load();
    let slave = Slave::coarse(&dll);
    for _ in 0..2 {
        slave.initialize();
        assert_eq!(slave.messages(), []);
        for k in 0..5 {
            assert_eq!(slave.set_real("drive.load", 100e3 - 20e3 * k as f64), fmi2OK);
            assert_eq!(slave.step(0.01 * k as f64, 0.01), fmi2OK);
        }
        let messages = slave.messages();
        let told = messages.iter().filter(|m| m.text.contains("thermal.smallest_load_ratio")).count();
        assert_eq!(told, 1, "{messages:?}");
        assert_eq!(slave.reset(), fmi2OK);
        slave.coarsen();
    }
}

#[test]
fn the_initial_creepage_counts_only_if_it_is_set() {
    let dll = load();
    let force = |creepage: Option<f64>| {
        let slave = Slave::coarse(&dll);
        if let Some(creepage) = creepage {
            assert_eq!(slave.set_real("initial.creepage", creepage), fmi2OK);
            // Zero is the declared start value.
            assert_eq!(slave.set_integer("initial.given", 2), fmi2OK);
        }
        slave.initialize();
        assert_eq!(slave.real("initial.creepage"), creepage.unwrap_or(0.0));
        let force = slave.real("contact.force_x");
        assert_eq!(slave.reset(), fmi2OK);
        slave.coarsen();
        slave.initialize();
        assert!(slave.real("contact.force_x").abs() < 0.1, "a reset leaves it unset");
        force
    };
    assert!(force(None).abs() < 0.1);
    assert!((-1200.0..-800.0).contains(&force(Some(0.0))));
}

#[test]
fn a_start_beyond_adhesion_is_refused_with_a_way_out() {
    let dll = load();
    let slave = Slave::coarse(&dll);
    assert_eq!(slave.set_real("drive.moment", -2e4), fmi2OK);
    assert_eq!(slave.enter(), fmi2OK);
    slave.refused(slave.exit(), &["drive.moment = -20000 N m", "adhesion carries", "initial.creepage"]);
    assert_eq!(slave.set_real("initial.creepage", 0.01), fmi2OK);
    assert_eq!(slave.exit(), fmi2OK);
    assert!((slave.real("contact.utilisation") - 1.0).abs() < 1e-9);
}

#[test]
fn a_tolerance_given_deliberately_is_used_unless_the_parameter_is_set_and_the_log_says_which() {
    let dll = load();
    let default = real_start("solver.tolerance");
    let run = |given: Option<f64>, set: Option<f64>| {
        let slave = Slave::coarse(&dll);
        assert_eq!(slave.set_logging(true, &["logEvents"]), fmi2OK);
        if let Some(value) = set {
            assert_eq!(slave.set_real("solver.tolerance", value), fmi2OK);
        }
        let (defined, tolerance) = (i32::from(given.is_some()), given.unwrap_or(0.0));
        // SAFETY: a component of this library.
        assert_eq!(unsafe { dll.fmi2SetupExperiment(slave.component, defined, tolerance, 0.0, 0, 0.0) }, fmi2OK);
        assert_eq!((slave.enter(), slave.exit()), (fmi2OK, fmi2OK));
        let texts: Vec<_> = slave.messages().into_iter().map(|m| (m.status == fmi2Warning, m.text)).collect();
        let warned = texts.iter().any(|(warning, text)| *warning && text.contains("tolerance"));
        let told = texts.into_iter().map(|(_, text)| text).find(|text| text.contains("initialized")).unwrap();
        slave.set_real("drive.moment", -8000.0);
        assert_eq!(slave.step(0.0, 1e-3), fmi2OK);
        let found = slave.real("solver.tolerance");
        assert!(told.contains(&format!("solver.tolerance = {found:?} ")), "{told}");
        (found, warned, told, slave.outputs())
    };
    let plain = run(None, None);
    assert_eq!((plain.0, plain.1), (default, false));
    assert!(plain.2.ends_with("of preset \"railway\""), "{}", plain.2);
    // Start values that fmpy hands back from the model description change nothing.
    assert_eq!(run(Some(default), None), plain);
    // Tolerances of the master's own solver are not ours.
    for usual in [1e-3, 1e-4, 1e-6, 2.0] {
        let (found, warned, _, outputs) = run(Some(usual), None);
        assert_eq!((found, warned, &outputs), (default, true, &plain.3), "{usual}");
    }
    let coarse = run(Some(0.05), None);
    assert_eq!((coarse.0, coarse.1), (0.05, false));
    assert!(coarse.2.ends_with("as the experiment asks") && coarse.3 != plain.3);
    let set = run(Some(1e-6), Some(0.05));
    assert_eq!((set.0, set.1, &set.3), (0.05, false, &coarse.3));
    assert!(set.2.ends_with("as set"));
}

#[test]
fn the_tolerance_of_an_experiment_survives_in_states_and_ends_with_a_reset() {
    let dll = load();
    let [first, second] = [0, 1].map(|_| Slave::coarse(&dll));
    // SAFETY: a component of this library.
    assert_eq!(unsafe { dll.fmi2SetupExperiment(first.component, 1, 0.05, 0.0, 0, 0.0) }, fmi2OK);
    assert_eq!((first.enter(), first.exit()), (fmi2OK, fmi2OK));
    second.initialize();
    let mut state = std::ptr::null_mut();
    assert_eq!(first.save(&mut state), fmi2OK);
    let bytes = first.serialize(state);
    let mut copy = std::ptr::null_mut();
    assert_eq!(second.deserialize(&bytes, &mut copy), fmi2OK);
    assert_eq!(second.restore(copy), fmi2OK);
    assert_eq!(second.real("solver.tolerance"), 0.05);
    for slave in [&first, &second] {
        assert_eq!(slave.set_real("drive.moment", -8000.0), fmi2OK);
        assert_eq!(slave.step(0.0, 1e-3), fmi2OK);
    }
    assert_eq!(first.outputs(), second.outputs());
    assert_eq!((first.free_state(&mut state), second.free_state(&mut copy)), (fmi2OK, fmi2OK));
    assert_eq!(first.reset(), fmi2OK);
    first.coarsen();
    first.initialize();
    assert_eq!(first.real("solver.tolerance"), real_start("solver.tolerance"));
}
