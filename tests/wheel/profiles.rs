//! Profiles of rail and wheel: holes, flats and joints, what is kept of them between communication points, and what is
//! said where they make no sense or are not resolved.

use crate::common::{self, KMH, model, prescribed, preset, store};
use std::sync::Arc;
use wheelrail::config::{Config, Damping};
use wheelrail::simulation::validity::Limit;
use wheelrail::simulation::{Drive, Inputs, Model, Outputs, Simulation, StepError, advice};

fn cold(mut config: Config) -> Config {
    config.thermal.enabled = false;
    config.tuning.tolerance = 0.0;
    config
}

fn without_friction(model: &Model, velocity: f64) -> Inputs {
    let mut inputs = prescribed(model, velocity, 0.0);
    inputs.drive.friction = 0.0;
    inputs
}

fn run(simulation: &mut Simulation, inputs: &Inputs, step: f64, steps: usize) -> Vec<Outputs> {
    let mut advance = || {
        simulation.advance(inputs, step).unwrap();
        simulation.outputs().clone()
    };
    (0..steps).map(|_| advance()).collect()
}

/// Paper D, figures 19 to 21: a locked wheel slides over a hole of 0.5 mm.
fn over_the_hole(elements: usize, step: f64) -> (f64, f64, u64) {
    let mut config = cold(preset("paper_d", elements));
    config.rail.profile = "hole(position = 2.26e-3, length = 0.5e-3, depth = 20e-6)".into();
    let model = model(config);
    let mut inputs = prescribed(&model, 50.0 * KMH, 2.0);
    inputs.drive.omega = 0.0;
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    let outputs = run(&mut simulation, &inputs, step, (1e-3 / step).round() as usize);
    let load = model.config().model.nominal_load;
    let forces = outputs.iter().map(|o| o.contact_force_y / load);
    let (low, high) = forces.fold((f64::MAX, f64::MIN), |(low, high), f| (low.min(f), high.max(f)));
    (low, high, outputs.iter().map(|o| o.contact_patches).max().unwrap())
}

#[test]
fn a_hole_unloads_the_contact_splits_it_in_two_and_is_left_with_a_small_peak() {
    let (coarse, fine) = (over_the_hole(40, 5e-6), over_the_hole(40, 2.5e-6));
    common::figure_within(5e-4, "hole.force", &[fine.0, fine.1]);
    println!("least and largest force over load, patches: {coarse:.5?}, half the step {fine:.5?}");
    assert!((fine.0 - 0.974).abs() < 3e-3 && (fine.1 - 1.0058).abs() < 3e-3 && fine.2 == 2, "{fine:?}");
    assert!((coarse.0 - fine.0).abs() < 2e-3 && (coarse.1 - fine.1).abs() < 2e-3, "{coarse:?} {fine:?}");
}

/// Least force over load as an elastic wheel rolls at 20 m/s over a sharp hole of the length `size` in half-widths.
fn least_over_a_hole(elements: usize, size: f64) -> f64 {
    let mut config = cold(preset("railway", elements));
    config.physics.yielding = false;
    let length = size * config.nominal_patch().half_length;
    config.rail.profile = format!("hole(position = 0.01, length = {length:?}, depth = 1e-3)");
    let model = model(config);
    let inputs = without_friction(&model, 20.0);
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    let outputs = run(&mut simulation, &inputs, 5e-6, 200);
    outputs.iter().map(|o| o.contact_force_y / inputs.drive.load).fold(1.0, f64::min)
}

/// The least force over holes of half a cell to eight cells against a grid four and two times as fine: as the guard
/// says.
#[test]
fn the_force_over_short_holes_errs_by_less_than_the_guard_says() {
    let said = |elements: usize, size: f64| -> f64 {
        let mut config = cold(preset("railway", elements));
        let length = size * config.nominal_patch().half_length;
        config.rail.profile = format!("hole(position = 2e-3, length = {length:?}, depth = 1e-3)");
        let model = model(config);
        let text =
            Simulation::new(model.clone(), &without_friction(&model, 20.0)).unwrap().describe_limit(Limit::Waves);
        1e-2 * text.split_once("by up to ").unwrap().1.split_once(" %").unwrap().0.parse::<f64>().unwrap()
    };
    for size in [0.05, 0.1, 0.2, 0.4] {
        let least = |elements: usize| least_over_a_hole(elements, size);
        let fine = least(40);
        for elements in [10, 20] {
            let (error, said) = ((least(elements) - fine).abs(), said(elements, size));
            common::figure("holes.said", &[error / said]);
            println!(
                "{size} half-widths, {elements} elements: least force {fine:.5}, error {error:.1e}, said {said:.1e}"
            );
            assert!(error < said && said < 0.011, "{error} {said}");
        }
    }
}

#[test]
fn a_thousand_holes_leave_temperatures_and_forces_sound() {
    let mut config = preset("railway", 6);
    config.tuning.tolerance = 0.0;
    config.rail.profile = "hole(position = 0.02, length = 2e-3, depth = 2e-5, every = 0.015, count = 1000)".into();
    let model = model(config);
    let inputs = prescribed(&model, 20.0, 2e-3);
    let mut simulation = Simulation::new(model, &inputs).unwrap();
    let mut split = 0;
    for _ in 0..7600 {
        simulation.advance(&inputs, 1e-4).unwrap();
        let o = simulation.outputs();
        split += usize::from(o.contact_patches == 2);
        let hot = [o.temperature_wheel_max, o.temperature_rail_max, o.temperature_wheel_mean, o.temperature_rail_mean];
        assert!(hot.iter().all(|t| (292.9..500.0).contains(t)), "{hot:?} at {} m", o.wheel_distance);
        assert!(o.contact_force_y > 0.5e5 && o.contact_force_y < 1.5e5 && o.contact_half_width > 4e-3, "{o:?}");
        assert!((0.0..=1.0).contains(&o.contact_stick_fraction) && o.contact_pressure_max < 3e9);
    }
    let outputs = simulation.outputs();
    println!(
        "{} m, {split} of 7600 steps with two patches, residuals {:.1e} and {:.1e}",
        outputs.wheel_distance, outputs.energy_residual, outputs.heat_residual
    );
    assert!(split > 300 && outputs.wheel_distance > 15.1 && outputs.heat_residual.abs() < 1e-8);
}

/// A wheel with a fresh flat of 40 mm on a heavy hub.
fn flat() -> Arc<Model> {
    let mut config = cold(preset("railway", 6));
    config.physics.yielding = false;
    // Beside such a hub the momentum of the deformation is small, and nothing else carries any.
    (config.wheel.hub_mass, config.vehicle.damping) = (3000.0, 0.0);
    config.wheel.profile = "flat(length = 0.04, position = 0.08)".into();
    model(config)
}

#[test]
fn nothing_of_a_flat_is_lost_between_communication_points() {
    let model = flat();
    let inputs = without_friction(&model, 80.0 * KMH);
    let mut fine = Simulation::new(model.clone(), &inputs).unwrap();
    let outputs = run(&mut fine, &inputs, 2e-5, 500);
    let least = outputs.iter().map(|o| o.contact_force_y).fold(f64::MAX, f64::min);
    let largest = outputs.iter().map(|o| o.contact_force_y).fold(f64::MIN, f64::max);
    let impulse: f64 = outputs.iter().map(|o| o.contact_impulse).sum();
    let mut coarse = Simulation::new(model, &inputs).unwrap();
    let mut tuning = coarse.tuning().clone();
    tuning.max_step = 2e-5;
    coarse.retune(&tuning);
    let seen = run(&mut coarse, &inputs, 1e-2, 1).remove(0);
    let lost = outputs[499].contact_lost_time;
    println!(
        "force {:.1} to {:.1} kN, {:.2} ms without contact, impulse {:.2} N s",
        1e-3 * least,
        1e-3 * largest,
        1e3 * lost,
        impulse
    );
    assert!(lost > 1e-4 && least == 0.0 && largest > 1.5e5);
    assert_eq!((seen.contact_force_min, seen.contact_force_max), (least, largest));
    assert!((seen.contact_impulse / impulse - 1.0).abs() < 1e-12 && (seen.contact_lost_time - lost).abs() < 1e-12);
    let supported = seen.contact_impulse - 1e-2 * inputs.drive.load;
    let momentum = seen.wheel_mass * seen.hub_vertical_velocity;
    println!("impulse beyond the load {supported:.2} N s, momentum {momentum:.2} N s");
    // The rest is in the deformation of the wheel, 72 kg of which move by centimetres a second.
    assert!((supported - momentum).abs() < 2.5e-3 * impulse, "{supported} {momentum}");
}

/// Largest force [N] and time without contact [s] as a wheel with a flat [m] rolls over it.
fn impact(length: f64, shape: &str, speed: f64, elements: usize, step: f64) -> (f64, f64) {
    let mut config = cold(preset("railway", elements));
    config.physics.yielding = false;
    config.wheel.profile = format!("flat(length = {length}, shape = {shape}, position = 0.08)");
    let model = model(config);
    let inputs = without_friction(&model, speed * KMH);
    let mut simulation = Simulation::new(model, &inputs).unwrap();
    let steps = (0.14 / (speed * KMH) + 5e-3) / step;
    let outputs = run(&mut simulation, &inputs, step, steps as usize);
    let largest = outputs.iter().map(|o| o.contact_force_max).fold(0.0, f64::max);
    (largest, outputs.last().unwrap().contact_lost_time)
}

#[test]
fn a_flat_hits_hardest_at_a_moderate_speed_and_throws_the_wheel_off_the_rail() {
    for (shape, speeds) in [("fresh", [20.0, 40.0, 100.0]), ("rounded", [20.0, 40.0, 140.0])] {
        let found = speeds.map(|speed| impact(0.04, shape, speed, 6, 2e-5));
        println!("{shape}, {speeds:?} km/h: {found:.4?}");
        assert!(found[1].0 > 1.2 * found[0].0.max(found[2].0) && found[1].1 > 1e-3, "{found:?}");
        let (finer, lost) = impact(0.04, shape, speeds[1], 10, 1e-5);
        assert!((found[1].0 / finer - 1.0).abs() < 0.02 && (found[1].1 / lost - 1.0).abs() < 0.02, "{finer} {lost}");
    }
}

/// The zone of the contact widens to the edges of the flat, on cells that grow outwards: 6, 10 and 20 elements and half
/// the step.
#[test]
fn a_flat_of_60_mm_runs_at_every_speed_and_converges_in_step_and_mesh() {
    for speed in [20.0, 30.0, 40.0, 60.0, 80.0, 100.0, 140.0] {
        let found = [(6, 2e-5), (6, 1e-5), (10, 1e-5), (20, 1e-5)].map(|(n, dt)| impact(0.06, "fresh", speed, n, dt));
        found[..3].iter().for_each(|f| common::figure("flat.converges", &[f.0 / found[3].0 - 1.0]));
        println!("60 mm at {speed} km/h: {found:.4?}");
        assert!(found[..3].iter().all(|f| (f.0 / found[3].0 - 1.0).abs() < 0.02), "{found:?}");
        assert!(found[3].0 > 3e5 && found[3].1 > 2e-3);
    }
}

#[test]
fn states_on_profiles_return_bit_for_bit_and_have_derivatives() {
    let mut config = cold(preset("railway", 6));
    config.rail.profile =
        "sinusoid(amplitude = 5e-6, wavelength = 0.04) + hole(position = 0.05, length = 4e-3, depth = \
                           1e-4)"
            .into();
    let model = model(config);
    let mut inputs = prescribed(&model, 20.0, 1e-3);
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    run(&mut simulation, &inputs, 1e-4, 23);
    let saved = simulation.checkpoint().clone();
    let first = run(&mut simulation, &inputs, 1e-4, 20);
    assert!(first.iter().any(|o| o.contact_patches == 2));
    simulation.recall(saved.clone()).unwrap();
    assert_eq!(run(&mut simulation, &inputs, 1e-4, 20), first);
    let tuning = model.config().tuning.clone();
    let mut other = Simulation::resume(model, tuning, saved.clone()).unwrap();
    assert_eq!(run(&mut other, &inputs, 1e-4, 20), first);
    // The derivative by the load of the step before, against two steps under other loads.
    simulation.recall(saved.clone()).unwrap();
    run(&mut simulation, &inputs, 1e-4, 1);
    let direction = Drive { load: 1.0, ..Drive::default() };
    let told = simulation.difference(&direction).unwrap().quotient(|o| o.contact_force_y);
    let load = inputs.drive.load;
    let mut force = |change: f64| {
        simulation.recall(saved.clone()).unwrap();
        inputs.drive.load = load + change;
        run(&mut simulation, &inputs, 1e-4, 1)[0].contact_force_y
    };
    let found = (force(10.0) - force(-10.0)) / 20.0;
    println!("dF/dP = {told:.8}, differences {found:.8}");
    assert!((told / found - 1.0).abs() < 1e-5, "{told} {found}");
}

/// Jenkins (1974): a rail that dips towards a joint and rises behind it turns the wheel's path by an angle; a mass m on
/// the contact spring K answers with `ΔP = angle · V · √(K m)`.
#[test]
fn a_dipped_joint_makes_the_force_p1_of_jenkins_on_a_rigid_base() {
    let mut config = cold(preset("railway", 10));
    (config.wheel.hub_mass, config.vehicle.damping, config.damping) = (3000.0, 0.0, Damping::NONE);
    let smooth = model(config.clone());
    let approach = |share: f64| {
        let mut inputs = without_friction(&smooth, 15.0);
        inputs.drive.load *= share;
        Simulation::new(smooth.clone(), &inputs).unwrap().outputs().contact_approach
    };
    let stiffness = 0.02 * config.model.nominal_load / (approach(1.01) - approach(0.99));
    let (angle, velocity) = (3e-4, 15.0);
    config.rail.profile = format!("joint(position = 2.05, length = 4, angle = {angle:?})");
    let model = model(config);
    let inputs = without_friction(&model, velocity);
    let mut simulation = Simulation::new(model, &inputs).unwrap();
    let outputs = run(&mut simulation, &inputs, 1e-4, 1450);
    let added = outputs.iter().map(|o| o.contact_force_y).fold(0.0, f64::max) - inputs.drive.load;
    let expected = angle * velocity * (stiffness * outputs[0].wheel_mass).sqrt();
    common::figure_within(5e-3, "joint.jenkins [N]", &[expected, added]);
    println!("P1 adds {added:.1} N, closed form {expected:.1} N");
    assert!((added / expected - 1.0).abs() < 0.05, "{added} {expected}");
}

#[test]
fn profiles_without_meaning_are_refused_by_name_and_unresolved_ones_are_announced() {
    let refused = |change: &dyn Fn(&mut Config), words: &[&str]| {
        let mut config = cold(preset("railway", 6));
        change(&mut config);
        let error = Model::shared(config.clone(), &store(), &mut |_, _| {}).map(|_| ()).unwrap_err();
        let text = advice::failed_preparation(&error, &config);
        println!("{text}");
        assert!(words.iter().all(|word| text.contains(word)), "{text}");
    };
    refused(&|c| c.rail.profile = "hole(length = 1e-3)".into(), &["rail.profile: ", "hole", "depth"]);
    refused(&|c| c.wheel.profile = "nowhere.csv".into(), &["wheel.profile: ", "nowhere.csv"]);
    refused(&|c| c.rail.profile = "flat(length = 0.02)".into(), &["rail.profile: ", "flat", "wheel"]);
    let announced = |profile: &str, step: f64, limits: &[Limit], words: &[&str]| {
        let mut config = cold(preset("railway", 6));
        config.rail.profile = profile.into();
        let model = model(config);
        let inputs = without_friction(&model, 20.0);
        let mut simulation = Simulation::new(model, &inputs).unwrap();
        run(&mut simulation, &inputs, step, 3);
        let found: Vec<Limit> = simulation.exceeded_limits().collect();
        let text = simulation.describe_limit(limits[0]);
        println!("{found:?}: {text}");
        assert_eq!(found, limits);
        assert!(words.iter().all(|word| text.contains(word)), "{text}");
    };
    announced("sinusoid(amplitude = 1e-6, wavelength = 0.002)", 1e-5, &[Limit::Waves], &["2.00 mm", "4.0", "mesh"]);
    let mut steep = cold(preset("railway", 20));
    steep.rail.profile = "sinusoid(amplitude = 0.01, wavelength = 0.01)".into();
    let model_of_steep = model(steep.clone());
    let inputs = without_friction(&model_of_steep, 20.0);
    let failed = Simulation::new(model_of_steep, &inputs).map(|_| ()).unwrap_err();
    let text = advice::failed_start(&failed, &steep, &inputs);
    assert!(text.contains("make rail.profile less deep"), "{text}");
    // Three steps of 40 mm each go over a hole that no end of a step comes near, and over a single edge.
    announced("hole(position = 0.1, length = 5e-3, depth = 1e-4)", 2e-3, &[Limit::Sampling], &["40.00 mm", "2.50 mm"]);
    // A wheel that is lifted within a step misses the work of the lift, half of the energy, which is announced beside.
    let both = [Limit::Sampling, Limit::Energy];
    announced("step(position = 0.1, height = 1e-5)", 2e-3, &both, &["40.00 mm", "3.01 mm"]);
    announced("sinusoid(amplitude = 1e-6, wavelength = 0.02)", 1e-3, &both, &["20.00 mm", "5.00 mm", "0"]);
    // Steps that do not resolve it do so when they are chosen by the profile.
    let mut config = cold(preset("railway", 6));
    config.rail.profile = "sinusoid(amplitude = 1e-6, wavelength = 0.02)".into();
    config.tuning.max_step = 0.0;
    let model = model(config);
    let inputs = without_friction(&model, 20.0);
    let mut simulation = Simulation::new(model, &inputs).unwrap();
    let outputs = run(&mut simulation, &inputs, 1e-3, 1).remove(0);
    assert_eq!((simulation.exceeded_limits().count(), outputs.internal_steps), (0, 40));
}

/// A wheel that sinks between the edges of a hole of the rail, or the rail between those of a hole of the wheel; with
/// the advice it does so without complaint.
#[test]
fn surfaces_that_touch_where_no_contact_is_looked_for_are_refused_with_advice_that_helps() {
    for name in ["rail.profile", "wheel.profile"] {
        let mut config = cold(preset("railway", 6));
        config.physics.yielding = false;
        let text = "hole(length = 0.06, position = 0.1, depth = 2e-3, every = 1, count = 1)";
        *(if name == "rail.profile" { &mut config.rail.profile } else { &mut config.wheel.profile }) = text.into();
        let over = |config: &Config| {
            let model = model(config.clone());
            let inputs = without_friction(&model, 1.0);
            let mut simulation = Simulation::new(model, &inputs).unwrap();
            (0..200).find_map(|_| simulation.advance(&inputs, 1e-3).err())
        };
        let text = advice::failed_step(&over(&config).unwrap(), &config);
        println!("{text}");
        let (_, advised) = text.split_once("up to which contact is looked for, to ").unwrap();
        config.mesh.reach = advised.split_once(' ').unwrap().0.parse().unwrap();
        assert!(["candidate zone".into(), format!("{name} is too")].iter().all(|word| text.contains(word)));
        assert_eq!(over(&config), None);
    }
}

/// Flats that wear or yielding makes during a run do not widen the zone: the message says what does.
#[test]
fn a_flat_that_the_run_has_made_and_that_outgrows_the_zone_is_refused_with_the_reach_to_set() {
    let mut config = cold(preset("railway", 6));
    let error = StepError::ZoneExceeded { zone: 0.03, load: config.model.nominal_load };
    config.mesh.reach = 0.01;
    let text = advice::failed_step(&error, &config);
    println!("{text}");
    assert!(["wear or yielding", "mesh.reach (now 0.01 m)", "0.045 m"].iter().all(|word| text.contains(word)));
    config.physics.yielding = false;
    assert!(!advice::failed_step(&error, &config).contains("mesh.reach"));
}

/// In both directions and at once for a run that starts behind it; not before, not where it is repeated, and not of a
/// dent.
#[test]
fn a_contact_that_passes_the_last_sample_of_a_file_is_told_by_name() {
    let folder = std::env::temp_dir().join(format!("wheelrail-end-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("rail.csv"), "position,height\n-0.1,0\n0.03,2e-6\n0.1,1e-6\n").unwrap();
    std::fs::write(folder.join("dent.csv"), "position,height\n-0.02,0\n0,-2e-6\n0.02,0\n").unwrap();
    let told = |profile: &str, velocity: f64| -> Vec<Option<String>> {
        let mut config = cold(preset("railway", 6));
        config.rail.profile = profile.replace('@', folder.to_str().unwrap());
        (config.tuning.max_step, config.initial.velocity) = (1e-3, velocity);
        let model = model(config);
        let inputs = without_friction(&model, velocity);
        let mut simulation = Simulation::new(model, &inputs).unwrap();
        let mut see = |advance: bool| {
            if advance {
                simulation.advance(&inputs, 2e-3).unwrap();
            }
            let past = simulation.exceeded_limits().any(|limit| limit == Limit::End);
            past.then(|| simulation.describe_limit(Limit::End))
        };
        [false, true, true, true].map(&mut see).into()
    };
    // Steps of 40 mm: two to before the end, the third beyond.
    for velocity in [20.0, -20.0] {
        let found = told("@/rail.csv", velocity);
        assert_eq!(found.iter().map(Option::is_some).collect::<Vec<_>>(), [false, false, false, true], "{found:?}");
        let text = found[3].as_ref().unwrap();
        let end = if velocity > 0.0 { " 0.100 m" } else { "-0.100 m" };
        assert!(text.contains("rail.profile") && text.contains(end) && text.contains("every"), "{text}");
    }
    assert!(told("file(\"@/rail.csv\", position = -1)", 20.0).iter().all(Option::is_some));
    for profile in ["file(\"@/rail.csv\", every = 0.3)", "file(\"@/dent.csv\", position = 0.05)", ""] {
        assert!(told(profile, 20.0).iter().all(Option::is_none), "{profile}");
    }
    std::fs::remove_dir_all(&folder).unwrap();
}
