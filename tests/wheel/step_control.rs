//! Error-controlled internal steps.

use crate::common::{self, model, preset, shipped};
use wheelrail::simulation::validity::Limit;
use wheelrail::simulation::{Inputs, Outputs, Simulation, Vertical};

/// Outputs after each communication step `h` under `drive(inputs, time)`, with the number of internal steps.
fn run(tolerance: f64, max_step: f64, h: f64, end: f64, drive: impl Fn(&mut Inputs, f64)) -> (Vec<Outputs>, u64) {
    let mut config = preset("railway", 10);
    (config.tuning.tolerance, config.tuning.max_step) = (tolerance, max_step);
    let model = model(config);
    let mut inputs = Inputs::rolling(model.config());
    let mut simulation = Simulation::new(model, &inputs).unwrap();
    let mut steps = 0;
    let seen = (1..=(end / h).round() as usize)
        .map(|k| {
            drive(&mut inputs, k as f64 * h);
            simulation.advance(&inputs, h).unwrap();
            assert!((simulation.time() - k as f64 * h).abs() < 1e-12);
            steps += simulation.outputs().internal_steps;
            simulation.outputs().clone()
        })
        .collect();
    (seen, steps)
}

/// Largest difference of an output between two runs.
fn difference(a: &[Outputs], b: &[Outputs], of: impl Fn(&Outputs) -> f64) -> f64 {
    a.iter().zip(b).map(|(a, b)| (of(a) - of(b)).abs()).fold(0.0, f64::max)
}

#[test]
fn force_error_after_a_moment_step_falls_with_the_tolerance() {
    // The brake grips at once; the master steps far too coarsely for what follows.
    let brake = |inputs: &mut Inputs, t: f64| inputs.drive.moment = if t > 0.015 { -7000.0 } else { 0.0 };
    let (exact, _) = run(0.0, 2e-5, 5e-3, 0.1, brake);
    let error = |tolerance: f64| {
        let (seen, steps) = run(tolerance, 0.1, 5e-3, 0.1, brake);
        let force = difference(&seen, &exact, |o| o.contact_force_x) / 1e5;
        let speed = difference(&seen, &exact, |o| o.wheel_velocity);
        println!("tolerance {tolerance}: {steps} steps, force error {force:.1e} P, speed error {speed:.1e} m/s");
        (force, speed, steps)
    };
    let results = [0.0, 0.03, 0.01, 0.003].map(error);
    common::figure("moment.tolerance", &results.map(|(force, ..)| force));
    assert_eq!(results[0].2, 20, "without control one internal step each");
    assert!(results.windows(2).all(|r| r[1].0 < 0.8 * r[0].0 && r[1].2 > r[0].2));
    assert!(results[3].0 < 0.01 && results[3].1 < 0.1 * results[0].1);
    assert!(results[3].2 < 1000, "a fifth of the reference: {}", results[3].2);
}

#[test]
fn quiet_driving_takes_one_internal_step_each() {
    let brake = |inputs: &mut Inputs, t: f64| inputs.drive.moment = -7000.0 * (t / 0.2).min(1.0);
    let (_, steps) = run(0.03, 0.1, 1e-3, 0.3, brake);
    assert_eq!(steps, 300);
}

#[test]
fn breaking_loose_is_refined() {
    // A brake at 60 % of the dry limit; then the rail is wet.
    let wet = |inputs: &mut Inputs, t: f64| {
        inputs.drive.moment = -8000.0 * (t / 0.1).min(1.0);
        inputs.drive.friction = if t > 0.121 { 0.1 } else { 0.3 };
    };
    let (exact, _) = run(0.0, 2e-5, 2e-3, 0.126, wet);
    let (plain, _) = run(0.0, 0.1, 2e-3, 0.126, wet);
    let (controlled, _) = run(0.003, 0.1, 2e-3, 0.126, wet);
    let loose = controlled.iter().position(|o| o.contact_stick_fraction == 0.0).unwrap();
    assert_eq!(controlled[loose - 1].internal_steps, 1);
    assert!(controlled[loose].internal_steps >= 8, "{}", controlled[loose].internal_steps);
    let error = |seen: &[Outputs]| difference(&seen[loose..], &exact[loose..], |o| o.contact_slip_velocity);
    println!("slip velocity error {:.1e} m/s, without control {:.1e} m/s", error(&controlled), error(&plain));
    assert!(error(&controlled) < 0.2 * error(&plain));
}

#[test]
fn take_off_and_landing_are_refined() {
    // The hub swings up by 0.4 mm and back within 50 ms, off the rail and onto it again.
    let lift = |inputs: &mut Inputs, t: f64| {
        inputs.vertical = Vertical::Displacement;
        let turn = (t / 0.05).min(1.0) * std::f64::consts::TAU;
        inputs.drive.displacement = -1.7e-4 + 2e-4 * (1.0 - turn.cos());
    };
    let (seen, _) = run(0.005, 0.1, 1e-3, 0.06, lift);
    let open = |o: &Outputs| o.contact_force_y == 0.0;
    let take_off = seen.iter().position(open).unwrap();
    let landing = seen.iter().rposition(open).unwrap() + 1;
    assert!(seen[take_off].internal_steps >= 4 && seen[landing].internal_steps >= 4);
    let flight = take_off + (landing - take_off) / 2;
    assert_eq!(seen[flight].internal_steps, 1);
}

#[test]
fn impact_force_of_a_dropped_wheel_needs_control() {
    // Raised until it just hangs free, then released under 40 % of the nominal load.
    let drop = |inputs: &mut Inputs, t: f64| {
        inputs.drive.load = 4e4;
        inputs.drive.displacement = -1.78e-4 + 9e-5 * (1.0 - (std::f64::consts::PI * (t / 0.02).min(1.0)).cos());
        inputs.vertical = if t < 0.03 { Vertical::Displacement } else { Vertical::Force };
    };
    let peak = |(seen, steps): (Vec<Outputs>, u64)| {
        (seen[seen.len() * 3 / 5..].iter().map(|o| o.contact_force_y).fold(0.0, f64::max), steps)
    };
    let (exact, _) = peak(run(0.0, 1e-5, 5e-4, 0.05, drop));
    let (plain, _) = peak(run(0.0, 0.1, 5e-4, 0.05, drop));
    let (controlled, steps) = peak(run(0.005, 0.1, 5e-4, 0.05, drop));
    common::figure("landing", &[controlled / exact - 1.0]);
    common::figure_within(0.1, "landing.without.control", &[plain / exact - 1.0]);
    println!("largest force {exact:.0} N, {controlled:.0} N in {steps} steps, without control {plain:.0} N");
    assert!((controlled / exact - 1.0).abs() < 0.03);
    assert!((plain / exact - 1.0).abs() > 3.0 * (controlled / exact - 1.0).abs());
}

/// Time within which events agree between communication steps at the default tolerance [s].
const RESOLUTION: f64 = 2e-5;

/// The default tolerance.
fn defaults() -> f64 {
    preset("railway", 10).tuning.tolerance
}

#[test]
fn force_after_a_moment_step_is_right_with_default_settings_and_quiet_driving_costs_nothing() {
    let step = |inputs: &mut Inputs, _: f64| inputs.drive.moment = -8000.0;
    let (exact, _) = run(0.0, 2e-5, 1e-3, 0.012, step);
    let (seen, steps) = run(defaults(), 0.1, 1e-3, 0.012, step);
    println!("{steps} internal steps in {}", seen.len());
    for ms in [2, 4, 10] {
        let (force, reference) = (seen[ms - 1].contact_force_x, exact[ms - 1].contact_force_x);
        common::figure(&format!("moment.step.{ms}"), &[force / reference - 1.0]);
        println!("{ms} ms: {force:.0} N, converged {reference:.0} N");
        assert!((force / reference - 1.0).abs() < 0.02, "{ms} ms");
    }
    // The ramp begins when the start has settled.
    let brake = |inputs: &mut Inputs, t: f64| inputs.drive.moment = -7000.0 * ((t - 0.05) / 0.2).clamp(0.0, 1.0);
    let (seen, _) = run(defaults(), 0.1, 1e-3, 0.3, brake);
    assert!(seen[50..].iter().all(|o| o.internal_steps == 1));
}

#[test]
fn take_off_and_landing_are_located_independently_of_the_communication_step() {
    // Raised until it hangs free, then released under 40 % of the nominal load: the same motion for all steps.
    let drop = |h: f64| {
        move |inputs: &mut Inputs, t: f64| {
            inputs.drive.load = 4e4;
            inputs.drive.displacement = -1.78e-4 + 1.8e-4 * (t / 0.02).min(1.0);
            let released = t - h > 0.03 - 1e-9;
            inputs.vertical = if released { Vertical::Force } else { Vertical::Displacement };
        }
    };
    // Every millisecond, whatever the step.
    let each = |seen: Vec<Outputs>, h: f64| -> Vec<f64> {
        let skip = (1e-3 / h).round() as usize;
        seen.iter().skip(skip - 1).step_by(skip).map(|o| o.contact_force_y).collect()
    };
    let forces = |tolerance: f64, max_step: f64, h: f64| each(run(tolerance, max_step, h, 0.04, drop(h)).0, h);
    let exact = forces(0.0, 5e-6, 1e-3);
    let take_off = exact.iter().position(|&f| f == 0.0).unwrap();
    let landing = exact.iter().rposition(|&f| f == 0.0).unwrap() + 1;
    let coarse = forces(defaults(), 0.1, 1e-3);
    let fine = forces(defaults(), 0.1, 1e-4);
    // The force next to the event, over its rate, tells when it was.
    for (name, k, rate, limit) in [
        ("take-off", take_off - 1, exact[take_off - 1] - exact[take_off - 2], 5.0 * RESOLUTION),
        ("landing", landing, exact[landing + 1] - exact[landing], RESOLUTION),
    ] {
        let late = |seen: &[f64]| 1e-3 * ((exact[k] - seen[k]) / rate).abs();
        let apart = 1e-3 * ((coarse[k] - fine[k]) / rate).abs();
        println!("{name}: {:.1e} s, {:.1e} s from the exact time, {apart:.1e} s apart", late(&coarse), late(&fine));
        assert!(apart < RESOLUTION && late(&coarse) < limit && late(&fine) < limit);
    }
}

#[test]
fn breaking_loose_and_catching_again_are_located_independently_of_the_communication_step() {
    // A moment beyond adhesion on a damp rail; then it is taken away.
    let drive = |h: f64| {
        move |inputs: &mut Inputs, t: f64| {
            let begin = ((t - h) / 1e-3 + 1e-6).floor() * 1e-3;
            inputs.drive.friction = 0.15;
            inputs.drive.moment = if (0.0295..0.0395).contains(&begin) { -1e4 } else { 0.0 };
        }
    };
    let slips = |tolerance: f64, max_step: f64, h: f64| -> Vec<(f64, f64)> {
        let skip = (1e-3 / h).round() as usize;
        let seen = run(tolerance, max_step, h, 0.1, drive(h)).0;
        seen.iter().skip(skip - 1).step_by(skip).map(|o| (o.contact_slip_velocity, o.contact_stick_fraction)).collect()
    };
    let exact = slips(0.0, 1e-5, 1e-3);
    let loose = exact.iter().position(|o| o.1 == 0.0).unwrap();
    let caught = exact.iter().rposition(|o| o.1 == 0.0).unwrap();
    println!("loose after {loose} ms, caught after {caught} ms");
    let coarse = slips(defaults(), 0.1, 1e-3);
    let fine = slips(defaults(), 0.1, 2e-4);
    for (name, k) in [("loose", loose + 1), ("caught", caught)] {
        let rate = exact[k].0 - exact[k - 1].0;
        let late = |seen: &[(f64, f64)]| 1e-3 * ((exact[k].0 - seen[k].0) / rate).abs();
        let apart = 1e-3 * ((coarse[k].0 - fine[k].0) / rate).abs();
        println!("{name}: {:.1e} s, {:.1e} s from the exact time, {apart:.1e} s apart", late(&coarse), late(&fine));
        assert!(apart < RESOLUTION && late(&coarse) < 5.0 * RESOLUTION && late(&fine) < 5.0 * RESOLUTION);
    }
}

/// Contact forces \[N] after each millisecond of 40, while the load jumps at the given times [ms] to shares of the nominal
/// one, and the largest error of the force that the warning of missing energy told meanwhile.
fn shaken(name: &str, tolerance: f64, max_step: f64, jumps: &[(usize, f64)]) -> (Vec<f64>, f64) {
    let mut config = shipped(name);
    (config.tuning.tolerance, config.tuning.max_step) = (tolerance, max_step);
    let model = model(config);
    let mut inputs = Inputs::rolling(model.config());
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    let mut told = 0.0f64;
    let forces = (0..40).map(|k| {
        if let Some((_, share)) = jumps.iter().find(|(time, _)| *time == k) {
            inputs.drive.load = share * model.config().model.nominal_load;
        }
        simulation.advance(&inputs, 1e-3).unwrap();
        let text = simulation.describe_limit(Limit::Energy);
        let number = text.split("by at most ").nth(1).and_then(|rest| rest.split(" N").next()).unwrap();
        told = told.max(number.parse().unwrap());
        simulation.outputs().contact_force_y
    });
    (forces.collect(), told)
}

/// Largest difference of two courses of a force.
fn apart(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn after_jumps_of_the_load_the_force_of_a_wheel_on_the_rail_errs_by_less_than_the_warning_says() {
    let (doubled, changed): (&[_], &[_]) = (&[(5, 2.0)], &[(5, 0.8), (20, 1.2)]);
    let plane = ["paper_a", "paper_b", "paper_c", "paper_d", "railway"].map(|name| (name, vec![doubled, changed]));
    for (name, courses) in plane.into_iter().chain([("railway_ellipse", vec![changed])]) {
        for jumps in courses {
            let (exact, _) = shaken(name, 0.0, 5e-6, jumps);
            let (forces, told) = shaken(name, 2e-3, 0.1, jumps);
            let (error, load) = (apart(&forces, &exact), exact[0]);
            common::figure("jump.warned", &[error / told]);
            println!("{name}, {jumps:?}: error {:.4} of the load, told {:.4}", error / load, told / load);
            assert!(exact.iter().all(|force| *force > 0.0), "it left the rail");
            assert!(error < told && told < load, "{name}: {error:e} N, told {told:e} N");
        }
    }
}

#[test]
fn force_error_after_a_jump_of_the_load_falls_with_the_tolerance_where_nothing_is_damped() {
    let (exact, _) = shaken("paper_a", 0.0, 2e-6, &[(5, 2.0)]);
    let errors = [2e-3, 2e-4, 2e-5].map(|tolerance| apart(&shaken("paper_a", tolerance, 0.1, &[(5, 2.0)]).0, &exact));
    common::figure("load.jump", &errors.map(|error| error / exact[0]));
    println!("errors over the load: {:.4?}", errors.map(|error| error / exact[0]));
    assert!(errors.windows(2).all(|e| e[1] < 0.4 * e[0]));
    assert!(errors[2] < 0.01 * exact[0]);
    let text = |name: &str| {
        let model = model(shipped(name));
        let inputs = Inputs::rolling(model.config());
        Simulation::new(model, &inputs).unwrap().describe_limit(Limit::Energy)
    };
    assert!(text("paper_a").contains("lose their energy in steps of any length"));
    assert!(!text("railway").contains("in steps of any length"));
}
