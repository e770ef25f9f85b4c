//! Notices that are given once in a run, by name, although nothing fails: inputs without effect, values of another
//! unit, moments that drive backwards.

use crate::slave::*;

/// All warnings of a run of `steps` steps, before each of which `set` gives values.
fn warnings(
    settings: &[(&str, f64)],
    controls: &[(&str, i32)],
    steps: usize,
    set: impl Fn(&Slave, usize),
) -> Vec<String> {
    let dll = load();
    let slave = Slave::coarse(&dll);
    settings.iter().for_each(|(name, value)| assert_eq!(slave.set_real(name, *value), fmi2OK));
    controls.iter().for_each(|(name, item)| assert_eq!(slave.set_integer(name, *item), fmi2OK));
    slave.initialize();
    for k in 0..steps {
        set(&slave, k);
        let status = slave.step(1e-3 * k as f64, 1e-3);
        if status == fmi2Discard {
            // Nothing is said too late: a rail at -253 degC may be too cold for a step.
            let texts = slave.messages();
            assert!(texts[0].status == fmi2Warning && texts[0].text.contains("kelvin"), "{texts:?}");
            return vec![texts[0].text.clone()];
        }
        assert_eq!(status, fmi2OK);
    }
    let messages = slave.messages();
    assert!(messages.iter().all(|m| m.status == fmi2Warning), "{messages:?}");
    messages.into_iter().map(|message| message.text).collect()
}

const ROTATION: (&str, i32) = ("control.rotation", 1);
const TRANSLATION: (&str, i32) = ("control.translation", 1);
const VERTICAL: (&str, i32) = ("control.vertical", 2);

#[test]
fn an_input_without_effect_is_told_once_with_what_would_let_it_act() {
    for (name, value, controls, words) in [
        ("drive.omega", 50.0, &[][..], ["control.rotation = moment", "set control.rotation = velocity"]),
        ("drive.velocity", 20.0, &[], ["control.translation = force", "set control.translation = velocity"]),
        ("drive.displacement", -5e-5, &[], ["control.vertical = force", "set control.vertical = displacement"]),
        ("drive.moment", -8e3, &[ROTATION], ["control.rotation = velocity", "set control.rotation = moment"]),
        ("brake.torque", 8e3, &[ROTATION], ["control.rotation = velocity", "to let the brake act"]),
        ("drive.force", 4e3, &[TRANSLATION], ["control.translation = velocity", "set control.translation = force"]),
        ("drive.load", 8e4, &[VERTICAL], ["control.vertical = displacement", "set control.vertical = force"]),
        ("drive.load_change", 4e3, &[VERTICAL], ["control.vertical = displacement", "set control.vertical = force"]),
    ] {
        // At the start the height is sought at which the wheel carries the load.
        let acts = name.starts_with("drive.load");
        let first = warnings(&[(name, value)], controls, 3, |_, _| ());
        assert_eq!(first.len(), usize::from(!acts), "{name}: {first:?}");
        let found = warnings(&[], controls, 3, |slave, _| assert_eq!(slave.set_real(name, value), fmi2OK));
        assert_eq!(found.len(), 1, "{name}: {found:?}");
        let told = |word: &&str| found[0].contains(*word);
        assert!(words.iter().all(told) && found[0].contains(&format!("{name} = ")), "{}", found[0]);
        assert!(found[0].contains("has no effect"), "{}", found[0]);
        // In the run as well, and every run anew.
        let later = warnings(&[], controls, 3, |slave, k| {
            assert_eq!(slave.set_real(name, if k == 0 { real_start(name) } else { value }), fmi2OK);
        });
        assert!(later.len() == 1 && later[0].starts_with("t = 0.001 s"), "{name}: {later:?}");
    }
}

#[test]
fn inputs_without_effect_at_their_start_value_or_equal_to_the_reaction_say_nothing() {
    let all = [ROTATION, TRANSLATION, VERTICAL];
    // Also those that follow from other parameters.
    let settings = [("initial.velocity", 20.0), ("drive.velocity", 20.0), ("drive.omega", 20.0 / 0.46)];
    assert_eq!(warnings(&settings, &[], 3, |_, _| ()), [""; 0]);
    let pairs = [
        ("drive.omega", "wheel.omega"),
        ("drive.velocity", "wheel.velocity"),
        ("drive.displacement", "hub.height"),
        ("drive.moment", "hub.moment"),
        ("drive.force", "hub.force_x"),
    ];
    let handed_back = |slave: &Slave, _: usize| {
        for (input, output) in pairs {
            let selected = if slave.integer("control.rotation") == 1 {
                ["drive.omega", "drive.velocity", "drive.displacement"]
            } else {
                ["drive.moment", "drive.force", "drive.load"]
            };
            if !selected.contains(&input) {
                assert_eq!(slave.set_real(input, slave.real(output)), fmi2OK);
            }
        }
        if slave.integer("control.rotation") == 1 {
            assert_eq!(slave.set_real("drive.load", -slave.real("hub.force_y")), fmi2OK);
        }
    };
    assert_eq!(warnings(&[("drive.moment", -6e3)], &[], 5, handed_back), [""; 0]);
    assert_eq!(warnings(&[("drive.omega", 59.0)], &all, 5, handed_back), [""; 0]);
}

#[test]
fn a_temperature_in_degrees_celsius_is_told_at_the_start_and_in_the_run_with_the_one_in_kelvin() {
    let found = warnings(&[("rail.temperature", 20.0)], &[], 1, |_, _| ());
    let cold = |found: &[String], name: &str| {
        let about: Vec<_> = found.iter().filter(|text| text.contains("are in kelvin")).collect();
        assert!(
            about.len() == 1 && about[0].contains(&format!("{name} = 20 K")) && about[0].ends_with("set 293.15"),
            "{found:?}"
        );
    };
    cold(&found, "rail.temperature");
    cold(&warnings(&[("thermal.reference", 20.0)], &[], 1, |_, _| ()), "thermal.reference");
    let later = warnings(&[], &[], 4, |slave, k| {
        assert_eq!(slave.set_real("rail.temperature", if k < 2 { 293.0 } else { 20.0 }), fmi2OK);
    });
    cold(&later, "rail.temperature");
    assert!(later.iter().any(|text| text.starts_with("t = 0.002 s")), "{later:?}");
    assert_eq!(warnings(&[("rail.temperature", 263.0)], &[], 2, |_, _| ()), [""; 0]);
}

#[test]
fn a_value_of_another_unit_is_told_by_its_size_and_a_ramp_through_small_values_is_not() {
    for (name, value, meant) in [
        ("brake.torque", 8.0, "8000"),
        ("drive.moment", -6.0, "-6000"),
        ("vehicle.mass", 9.9, "9900"),
        ("friction.memory_length", 0.025, ""),
    ] {
        let found = warnings(&[(name, value)], &[], 2, |_, _| ());
        let told = found.iter().filter(|text| text.contains(name) && text.ends_with(&format!("set {meant}"))).count();
        assert_eq!(told, usize::from(!meant.is_empty()), "{name}: {found:?}");
    }
    let ramp = warnings(&[], &[], 10, |slave, k| assert_eq!(slave.set_real("brake.torque", 4.0 * k as f64), fmi2OK));
    assert_eq!(ramp, [""; 0]);
}

/// A slide protection lowers a torque that had its size before; a brake that never had it is asked for its unit.
#[test]
fn a_torque_that_a_slide_protection_lowers_is_not_asked_for_its_unit() {
    let after = |first: f64| {
        warnings(&[], &[], 6, |slave, k| {
            assert_eq!(slave.set_real("brake.torque", if k < 2 { first } else { 41.0 }), fmi2OK);
        })
    };
    assert_eq!(after(8e3), [""; 0]);
    let found = after(20.0);
    assert!(found.len() == 1 && found[0].contains("brake.torque = ") && found[0].contains("kN.m"), "{found:?}");
    // What is larger than before is asked for.
    let found = warnings(&[], &[], 6, |slave, k| {
        assert_eq!(slave.set_real("rail.friction", if k < 2 { 0.3 } else { 2.5 }), fmi2OK);
    });
    assert!(found.iter().any(|text| text.contains("rail.friction = 2.5 is a ratio")), "{found:?}");
}

/// A master that holds a locked wheel by its speed leaves the torque as it was; one that changes it then is told.
#[test]
fn an_input_that_acted_until_another_control_took_over_is_told_once_it_changes() {
    let held = |later: f64| {
        warnings(&[("initial.velocity", 20.0)], &[], 6, |slave, k| {
            if k == 2 {
                assert_eq!(slave.set_real("drive.omega", slave.real("wheel.omega")), fmi2OK);
                assert_eq!(slave.set_integer("control.rotation", 1), fmi2OK);
            }
            assert_eq!(slave.set_real("brake.torque", if k < 4 { 3700.0 } else { later }), fmi2OK);
        })
    };
    assert_eq!(held(3700.0), [""; 0]);
    let found = held(3800.0);
    assert!(found.len() == 1 && found[0].contains("brake.torque = 3800 N.m has no effect"), "{found:?}");
}

/// Warnings of a wheel at 20 m/s with a profile of its own or of the rail, after steps of `h` \[s].
fn over(parameter: &str, profile: &str, h: f64, steps: usize) -> Vec<String> {
    let dll = load();
    let slave = Slave::coarse(&dll);
    slave.set_boolean("thermal.enabled", false);
    assert_eq!(slave.set_string(parameter, profile), fmi2OK);
    assert_eq!(slave.set_real("initial.velocity", 20.0), fmi2OK);
    slave.initialize();
    (0..steps).for_each(|k| assert_eq!(slave.step(h * k as f64, h), fmi2OK));
    slave.messages().into_iter().map(|message| message.text).collect()
}

/// A wheel out of round lifts its load and lowers it again: 20 J, of which up to a fiftieth is missing for a while. Steps
/// of whole waves miss all of their energy, and all of their height.
#[test]
fn energy_that_comes_and_goes_with_a_damped_wheel_out_of_round_says_nothing_and_what_steps_pass_over_does() {
    assert_eq!(over("wheel.profile", "polygon(order = 5, amplitude = 1e-4)", 1e-3, 200), [""; 0]);
    let found = over("rail.profile", "sinusoid(amplitude = 1e-5, wavelength = 0.1)", 5e-3, 20);
    for words in ["forces are inexact by", "solver.energy_residual"] {
        assert_eq!(found.iter().filter(|text| text.contains(words)).count(), 1, "{found:?}");
    }
}

#[test]
fn a_moment_that_turns_a_locked_wheel_backwards_is_told_and_a_brake_does_not() {
    // Twice what adhesion carries stops a wheel without a vehicle's mass to speak of in some milliseconds.
    let run = |name: &'static str, value: f64| {
        let settings = [("rail.friction", 0.05), ("initial.velocity", 3.0)];
        warnings(&settings, &[], 60, move |slave, _| assert_eq!(slave.set_real(name, value), fmi2OK))
    };
    let told = |found: &[String]| found.iter().filter(|text| text.contains("brake.torque instead")).count();
    let moment = run("drive.moment", -2e4);
    assert!(told(&moment) == 1 && moment.iter().any(|text| text.contains("drive.moment = -20000 N.m")), "{moment:?}");
    assert_eq!(told(&run("brake.torque", 2e4)), 0);
}

#[test]
fn a_fixed_parameter_that_is_set_in_a_run_points_to_the_input_that_changes_it() {
    let dll = load();
    let slave = Slave::ready(&dll);
    for (parameter, input) in [
        ("friction.coefficient", "rail.friction"),
        ("thermal.reference", "rail.temperature"),
        ("model.nominal_load", "drive.load"),
        ("initial.velocity", "drive.velocity"),
    ] {
        slave.refused(slave.set_real(parameter, real_start(parameter)), &[parameter, "fixed parameter", input]);
    }
}

/// Of a load whose patch is as much narrower or wider as to warm the bodies 1.26 or .79 times as much.
#[test]
fn a_load_that_warms_the_bodies_otherwise_than_the_patch_is_told() {
    for (load, shape, told) in
        [(5e4, 2, Some("1.26 times")), (2e5, 2, Some("0.79 times")), (9e4, 2, None), (5e4, 1, None)]
    {
        let found = warnings(&[("drive.load", load)], &[("contact.shape", shape)], 1, |_, _| ());
        let about = found.iter().filter(|text| text.contains("model.nominal_load = 100000 N")).collect::<Vec<_>>();
        assert_eq!(about.len(), usize::from(told.is_some()), "{load} {shape}: {found:?}");
        assert!(told.is_none_or(|words| about[0].contains(words) && about[0].contains("mean load")), "{found:?}");
    }
}

#[test]
fn rows_of_a_patch_of_another_shape_are_told() {
    for (shape, told) in [(1, 1), (2, 1), (3, 0)] {
        let dll = load();
        let slave = Slave::coarse(&dll);
        let rows = "position,half_length,load_share; -2e-3,5e-3,1; 2e-3,5e-3,1";
        assert_eq!(
            (slave.set_string("contact.rows", rows), slave.set_integer("contact.shape", shape)),
            (fmi2OK, fmi2OK)
        );
        slave.initialize();
        let found: Vec<_> = slave.messages().into_iter().map(|message| message.text).collect();
        let about = found.iter().filter(|text| text.contains("contact.rows has no effect")).count();
        assert_eq!(about, told, "{shape}: {found:?}");
    }
}

const LINE: i32 = 1;
const ELLIPSE: i32 = 2;
const ROWS: i32 = 3;
/// An ellipse on eleven rows under 100 kN.
const TABLE: &str = "position,half_length,load_share; -5e-3,2.98e-3,0.174; -4e-3,4.91e-3,0.471; -3e-3,5.97e-3,0.698; \
                     -2e-3,6.63e-3,0.860; -1e-3,7.03e-3,0.967; 0,7.16e-3,1; 1e-3,7.03e-3,0.967; 2e-3,6.63e-3,0.860; \
                     3e-3,5.97e-3,0.698; 4e-3,4.91e-3,0.471; 5e-3,2.98e-3,0.174";

/// Warnings at the start, largest pressure \[Pa] and half-length \[m] of a patch of the `shape` with settings.
fn start(shape: i32, settings: &[(&str, f64)]) -> (Vec<String>, [f64; 2]) {
    let dll = load();
    let slave = Slave::coarse(&dll);
    assert_eq!(slave.set_integer("contact.shape", shape), fmi2OK);
    if shape == ROWS {
        assert_eq!(slave.set_string("contact.rows", TABLE), fmi2OK);
    }
    for (name, value) in settings {
        assert_eq!(slave.set_real(name, *value), fmi2OK, "{name}");
    }
    slave.initialize();
    let texts = slave.messages().into_iter().map(|message| message.text).collect();
    (texts, ["contact.pressure_max", "contact.half_width"].map(|name| slave.real(name)))
}

/// Every advice about the load and the patch is obeyed: its warning is gone, no other one comes, and pressure and length
/// are those of Hertz under the load, the root of the load over 100 kN times those under it, the third one of patches.
#[test]
fn advice_about_the_load_of_a_patch_is_right_when_it_is_obeyed() {
    let little = |load: f64| move |settings: &mut Vec<(&str, f64)>| settings.push(("model.nominal_load", load));
    let ratio =
        |ratio: f64| move |settings: &mut Vec<(&str, f64)>| settings.push(("thermal.smallest_load_ratio", ratio));
    type Obey<'a> = &'a dyn Fn(&mut Vec<(&'static str, f64)>);
    let cases: [(i32, f64, &[&str], &[Obey]); 9] = [
        (ELLIPSE, 5e4, &["take up heat", "set model.nominal_load to the mean load"], &[&little(5e4)]),
        (ROWS, 5e4, &["take up heat", "set model.nominal_load to the mean load"], &[&little(5e4)]),
        (ROWS, 1.9e5, &["take up heat", "set model.nominal_load to the mean load"], &[&little(1.9e5)]),
        (ELLIPSE, 2e5 + 1e4, &["raise model.nominal_load and set drive.load"], &[&little(2.1e5)]),
        (ROWS, 2e5 + 1e4, &["raise model.nominal_load and set drive.load"], &[&little(2.1e5)]),
        (ELLIPSE, 5e3, &["take up heat", "set model.nominal_load to the mean load"], &[&little(5e3)]),
        (ROWS, 5e3, &["take up heat", "set model.nominal_load to the mean load"], &[&little(5e3)]),
        (ROWS, 2e3, &["smallest_load_ratio cannot be below 0.05", "lower model.nominal_load"], &[&little(2e3)]),
        (LINE, 4e4, &["lower thermal.smallest_load_ratio to 0.39 or less"], &[&ratio(0.39), &little(4e4)]),
    ];
    let common = [("material.yield_strength", 2e9), ("thermal.smallest_load_ratio", 0.5)];
    for (shape, load, words, ways) in cases {
        let (_, reference) = start(shape, &common);
        let root = if shape == LINE { (load / 1e5).sqrt() } else { (load / 1e5).cbrt() };
        let mut settings = common.to_vec();
        settings.push(("drive.load", load));
        let (found, before) = start(shape, &settings);
        assert!(found.iter().any(|text| words.iter().all(|word| text.contains(word))), "{shape} {load}: {found:?}");
        for obey in ways {
            let mut settings = settings.clone();
            obey(&mut settings);
            if shape == ROWS {
                settings.push(("contact.rows_load", 1e5));
            }
            let (left, after) = start(shape, &settings);
            let errors = |found: [f64; 2]| [0, 1].map(|k| found[k] / reference[k] / root - 1.0);
            println!("shape {shape}, {load} N: pressure and length {:?}, obeyed {:?}", errors(before), errors(after));
            assert!(left.is_empty(), "{shape} {load}: {left:?}");
            assert!(errors(after).iter().all(|error| error.abs() < 0.01));
        }
    }
}

#[test]
fn rows_whose_load_is_not_said_are_told_and_a_said_one_is_taken() {
    let words = "contact.rows counts as the patch under contact.rows_load = 100000 N";
    let told = |settings: &[(&str, f64)]| start(ROWS, settings).0.iter().filter(|text| text.contains(words)).count();
    assert_eq!(told(&[]), 0);
    assert_eq!(told(&[("model.nominal_load", 5e4)]), 1);
    assert_eq!(told(&[("model.nominal_load", 5e4), ("contact.rows_load", 5e4)]), 0);
    let idle = start(ELLIPSE, &[("contact.rows_load", 5e4)]).0;
    assert!(idle.iter().any(|text| text.contains("contact.rows_load has no effect")), "{idle:?}");
}
