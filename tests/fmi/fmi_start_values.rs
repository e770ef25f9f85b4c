//! Start values that are written back, and what is said where they are not what a run takes.

use crate::slave;
use crate::slave::*;
use wheelrail::fmi::presets;
use wheelrail::fmi::settings::start_value;
use wheelrail::fmi::v2::variables::variables;
use wheelrail::fmi::variable::{Causality, Value, Variable};

/// Parameters, or inputs, with their declared start values.
fn declared(causality: Causality) -> impl Iterator<Item = (&'static Variable, Value)> {
    let mine = move |row: &&Variable| row.causality() == causality && row.name != "preset";
    variables().iter().filter(mine).map(|row| (row, start_value(row).unwrap()))
}

/// Writes values, as tools do that know no variable which is not set.
fn write(slave: &Slave, values: impl Iterator<Item = (&'static Variable, Value)>) -> usize {
    let write = |(row, value): (&Variable, Value)| {
        let status = match value {
            Value::Real(number) => slave.set_real(row.name, number),
            Value::Integer(number) => slave.set_integer(row.name, number),
            Value::Boolean(on) => slave.set_boolean(row.name, on),
            Value::String(text) => slave.set_string(row.name, &text),
            Value::Reals(_) => panic!("{} is no parameter", row.name),
        };
        assert_eq!(status, fmi2OK, "{}", row.name);
    };
    values.map(write).count()
}

/// A run of a railway wheel after `before`, on a mesh that is quick: all outputs at the start and after each of some
/// steps, and all that is said.
fn run(before: impl Fn(&Slave)) -> (Vec<Vec<u64>>, Vec<String>) {
    let dll = load();
    let arguments = Arguments { resources: Some(RESOURCES), ..Default::default() };
    let slave = Slave::try_new(&dll, &arguments).unwrap();
    before(&slave);
    slave.coarsen();
    slave.initialize();
    let mut outputs = vec![slave.outputs()];
    for k in 0..5 {
        assert_eq!(slave.step(1e-3 * f64::from(k), 1e-3), fmi2OK, "{:?}", slave.messages());
        outputs.push(slave.outputs());
    }
    (outputs, slave.messages().into_iter().map(|message| message.text).collect())
}

fn both(slave: &Slave) {
    assert!(write(slave, declared(Causality::Parameter)) > 90);
    assert!(write(slave, declared(Causality::Input)) >= 16);
}

#[test]
fn writing_back_all_declared_start_values_changes_no_bit_of_a_run_and_says_nothing() {
    for moment in [0.0, -6000.0] {
        let brake = |slave: &Slave| assert_eq!(slave.set_real("drive.moment", moment), fmi2OK);
        let plain = run(brake);
        assert!(plain.1.is_empty(), "{:?}", plain.1);
        let parameters = run(|slave| {
            write(slave, declared(Causality::Parameter));
            brake(slave);
        });
        let inputs = run(|slave| {
            write(slave, declared(Causality::Input));
            brake(slave);
        });
        let all = run(|slave| {
            both(slave);
            brake(slave);
        });
        assert!(plain == parameters && plain == inputs && plain == all, "{:?}", all.1);
    }
}

/// The others of each kind are written: a nominal load, friction, temperature and speed other than the declared ones
/// stay.
#[test]
fn inputs_that_are_written_back_follow_the_parameters_that_are_not_and_are_counted() {
    let parameters = |slave: &Slave| {
        for (name, value) in [
            ("model.nominal_load", 60e3),
            ("friction.coefficient", 0.2),
            ("thermal.reference", 283.0),
            ("initial.velocity", 20.0),
        ] {
            assert_eq!(slave.set_real(name, value), fmi2OK);
        }
    };
    let plain = run(parameters);
    let back = run(|slave| {
        both(slave);
        parameters(slave);
    });
    assert_eq!(plain.0, back.0);
    assert!(plain.1.is_empty() && back.1.len() == 1, "{:?}", back.1);
    for words in [
        "3 inputs",
        "drive.load = 100000 N, now 60000 N",
        "rail.friction = 0.3, now 0.2",
        "293 K, now 283 K",
        "initial.given",
    ] {
        assert!(back.1[0].contains(words), "{}", back.1[0]);
    }
}

#[test]
fn what_is_written_counts_where_it_is_asked_to() {
    let load = |given: Option<i32>| {
        let dll = slave::load();
        let slave = Slave::coarse(&dll);
        given.into_iter().for_each(|item| assert_eq!(slave.set_integer("initial.given", item), fmi2OK));
        let values = [("model.nominal_load", 90e3), ("drive.load", 100e3), ("initial.creepage", 0.0)];
        values.iter().for_each(|(name, value)| assert_eq!(slave.set_real(name, *value), fmi2OK));
        slave.initialize();
        let texts: Vec<_> = slave.messages().into_iter().map(|message| message.text).collect();
        (slave.real("contact.force_y").round(), slave.real("contact.force_x").abs() > 500.0, texts)
    };
    let (changed, written) = (load(None), load(Some(2)));
    assert_eq!((changed.0, changed.1), (90e3, false));
    let said = |text: &str| changed.2.iter().filter(|found| found.contains(text)).count();
    assert_eq!((said("drive.load = 100000 N, now 90000 N"), said("initial.creepage = 0")), (1, 1), "{:?}", changed.2);
    assert_eq!(written, (100e3, true, vec![]));
    // The choice confirmed, zero is what it says: not given.
    assert_eq!(load(Some(1)).2.len(), 1);
}

#[test]
fn in_a_run_every_input_counts_that_is_written() {
    let dll = load();
    let slave = Slave::coarse(&dll);
    assert_eq!(slave.set_real("model.nominal_load", 90e3), fmi2OK);
    slave.initialize();
    assert_eq!(slave.real("contact.force_y").round(), 90e3);
    assert_eq!(slave.set_real("drive.load", real_start("drive.load")), fmi2OK);
    (0..50).for_each(|k| assert_eq!(slave.step(0.01 * f64::from(k), 0.01), fmi2OK));
    assert!((slave.real("contact.force_y") - 100e3).abs() < 50.0, "{}", slave.real("contact.force_y"));
}

/// Otherwise a tool that writes all inputs at the start would give a moment of 0 to a wheel that is let go later.
#[test]
fn a_control_that_is_switched_takes_over_the_reaction_although_the_start_value_was_written() {
    let moment = |write_back: bool| {
        let dll = load();
        let slave = Slave::coarse(&dll);
        if write_back {
            both(&slave);
            slave.coarsen();
        }
        assert_eq!(slave.set_integer("control.rotation", 1), fmi2OK);
        assert_eq!(slave.set_real("drive.omega", 60.0), fmi2OK);
        slave.initialize();
        assert_eq!(slave.step(0.0, 1e-3), fmi2OK);
        assert_eq!(slave.set_integer("control.rotation", 2), fmi2OK);
        slave.real("drive.moment").to_bits()
    };
    assert_eq!(moment(true), moment(false));
    assert!(f64::from_bits(moment(false)).abs() > 100.0);
}

#[test]
fn under_another_preset_written_values_win_and_one_warning_counts_them() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("resources");
    let preset = |slave: &Slave, name: &str| assert_eq!(slave.set_string("preset", name), fmi2OK);
    let default = run(|_| ());
    for name in ["railway_dry", "railway_wet"] {
        let config = presets::load(Some(&folder), name).unwrap();
        let differ =
            declared(Causality::Parameter).filter(|(row, start)| row.parameter("", &config).as_ref() != Some(start));
        let differ: Vec<_> = differ.map(|(row, _)| row.name).collect();
        assert!(differ.len() > 1);
        let plain = run(|slave| preset(slave, name));
        let back = run(|slave| {
            preset(slave, name);
            both(slave);
        });
        assert!(plain.1.is_empty() && plain.0 != default.0 && back.0 == default.0);
        assert_eq!(back.1.len(), 1, "{:?}", back.1);
        // The friction that was written for the run is that of the parameter, and is not counted twice.
        let words = format!("{} values", differ.len());
        assert!(
            back.1[0].contains(&words) && back.1[0].contains(differ[0]) && back.1[0].contains(name),
            "{}",
            back.1[0]
        );
        // Inputs alone override what follows from the preset.
        let inputs = run(|slave| {
            preset(slave, name);
            write(slave, declared(Causality::Input));
        });
        let friction = config.friction.coefficient;
        assert_eq!(inputs.0 == plain.0, friction == real_start("rail.friction"));
        if friction != real_start("rail.friction") {
            assert!(
                inputs.1.len() == 1 && inputs.1[0].contains("1 value") && inputs.1[0].contains("rail.friction"),
                "{:?}",
                inputs.1
            );
        }
        // A value set on purpose is not worth a word.
        let deliberate = run(|slave| {
            preset(slave, name);
            assert_eq!(slave.set_real("friction.coefficient", 0.123), fmi2OK);
        });
        assert!(deliberate.1.is_empty(), "{:?}", deliberate.1);
    }
}

#[test]
fn a_tolerance_that_is_written_back_leaves_that_of_the_experiment() {
    let tolerance = |write_back: Option<f64>| {
        let dll = load();
        let slave = Slave::coarse(&dll);
        write_back.into_iter().for_each(|value| assert_eq!(slave.set_real("solver.tolerance", value), fmi2OK));
        // SAFETY: a component of this library.
        #[allow(unsafe_code)]
        let set = unsafe { dll.fmi2SetupExperiment(slave.component, 1, 0.05, 0.0, 0, 0.0) };
        assert_eq!((set, slave.enter(), slave.exit()), (fmi2OK, fmi2OK, fmi2OK));
        slave.real("solver.tolerance")
    };
    assert_eq!(tolerance(None), 0.05);
    assert_eq!(tolerance(Some(real_start("solver.tolerance"))), 0.05);
    assert_eq!(tolerance(Some(0.01)), 0.01);
}
