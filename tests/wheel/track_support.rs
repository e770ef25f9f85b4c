//! The track below the rail base: springs, dampers and mass that move with it.

use crate::common::*;
use nalgebra::{Complex, Matrix4};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;
use wheelrail::config::Config;
use wheelrail::simulation::{Inputs, Model, Outputs, Rotation, Simulation, Translation};

/// Vertical stiffness per wheel of the track of Zhai et al. \[N/m].
const VERTICAL: f64 = 81e6;

/// The default wheel without heat on a base that is fixed in both directions.
fn fixed(elements: usize) -> Config {
    let mut config = preset("railway", elements);
    config.thermal.enabled = false;
    (config.rail.restraint_stiffness, config.rail.restraint_damping) = (0.0, 0.0);
    config
}

/// The default wheel without heat.
fn restrained(elements: usize) -> Config {
    let mut config = preset("railway", elements);
    config.thermal.enabled = false;
    config
}

/// Displacement of the base \[m].
fn base(simulation: &Simulation) -> [f64; 2] {
    simulation.state().base.displacement.map(|b| b.now)
}

#[test]
fn the_base_gives_way_by_force_over_stiffness() {
    for reduced in [true, false] {
        let mut config = restrained(4);
        config.solver.reduced = reduced;
        (config.rail.support_stiffness, config.rail.support_damping) = (VERTICAL, 1e5);
        let stiffness = [config.rail.restraint_stiffness, config.rail.support_stiffness];
        let mut rigid = config.clone();
        (rigid.rail.restraint_stiffness, rigid.rail.restraint_damping) = (0.0, 0.0);
        (rigid.rail.support_stiffness, rigid.rail.support_damping) = (0.0, 0.0);
        let (moving, rigid) = (model(config), model(rigid));
        let inputs = prescribed(&moving, 20.0, -1e-3);
        let [moving, rigid] = [moving, rigid].map(|model| Simulation::new(model, &inputs).unwrap());
        let outputs = moving.outputs();
        let (b, force) = (base(&moving), [-outputs.contact_force_x, -outputs.contact_force_y]);
        println!("reduced {reduced}: base at {b:?} m under {force:?} N");
        for k in 0..2 {
            assert!((b[k] * stiffness[k] / force[k] - 1.0).abs() < 1e-9);
        }
        // The hub follows the rail; nothing else moves.
        let sunk = outputs.contact_approach - rigid.outputs().contact_approach;
        assert!((sunk / -b[1] - 1.0).abs() < 1e-6, "{sunk} m");
        if let Ok(fields) = moving.fields() {
            let bottom = fields.rail.mesh.fixed.iter().map(|&node| fields.rail.displacement[node]);
            assert!(bottom.into_iter().all(|u| u == b) && !reduced);
        }
    }
}

/// A shift of a uniform rail is no change of geometry: force and approach are those of the fixed base.
#[test]
fn stationary_creepage_curves_do_not_know_the_restraint() {
    let (moving, rigid) = (model(restrained(10)), model(fixed(10)));
    let mut worst = [0.0_f64; 3];
    for creepage in [-1e-2, -2e-3, -5e-4, -1e-4, 0.0, 2e-4, 1e-3, 5e-3] {
        let inputs = prescribed(&moving, 80.0 * KMH, creepage);
        let run = |model: &Arc<Model>| Simulation::new(model.clone(), &inputs).unwrap().outputs().clone();
        let (a, b) = (run(&moving), run(&rigid));
        let limit = inputs.drive.friction * inputs.drive.load;
        worst[0] = worst[0].max((a.contact_force_x - b.contact_force_x).abs() / limit);
        worst[1] = worst[1].max((a.contact_force_y / b.contact_force_y - 1.0).abs());
        worst[2] = worst[2].max((a.contact_approach / b.contact_approach - 1.0).abs());
    }
    round_off("track.restraint", &worst[..1], 1e-11);
    println!("largest differences: F_x {:.1e} of its limit, F_y {:.1e}, approach {:.1e}", worst[0], worst[1], worst[2]);
    assert!(worst.iter().all(|difference| *difference < 1e-9), "{worst:?}");
}

/// Slope of load over approach [N/m] about the nominal load on a fixed base.
fn contact_stiffness(model: &Arc<Model>) -> f64 {
    let approach = |share: f64| {
        let mut inputs = prescribed(model, 0.0, 0.0);
        (inputs.drive.friction, inputs.drive.load) = (0.0, inputs.drive.load * share);
        Simulation::new(model.clone(), &inputs).unwrap().outputs().contact_approach
    };
    0.02 * model.config().model.nominal_load / (approach(1.01) - approach(0.99))
}

/// Slowest oscillating eigenvalue [1/s] of a mass on a contact spring on a second mass on spring and damper.
fn two_degrees(mass: [f64; 2], contact: f64, support: f64, damping: f64) -> Complex<f64> {
    let [m1, m2] = mass;
    #[rustfmt::skip]
    let matrix = Matrix4::new(
        0.0, 0.0, 1.0, 0.0,
        0.0, 0.0, 0.0, 1.0,
        -contact / m1, contact / m1, 0.0, 0.0,
        contact / m2, -(contact + support) / m2, 0.0, -damping / m2,
    );
    let oscillating = matrix.complex_eigenvalues().iter().copied().filter(|s| s.im > 0.0).collect::<Vec<_>>();
    oscillating.into_iter().min_by(|a, b| a.im.total_cmp(&b.im)).unwrap()
}

/// Frequency [rad/s] and decay rate [1/s] from crossings and extremes of a vibration about zero, sampled every `dt`,
/// without its first period.
fn vibration(signal: &[f64], dt: f64) -> [f64; 2] {
    let (mut crossings, mut peaks) = (Vec::new(), Vec::new());
    for k in 1..signal.len() - 1 {
        let [before, now, after] = [signal[k - 1], signal[k], signal[k + 1]];
        if before < 0.0 && now >= 0.0 {
            crossings.push((k as f64 - now / (now - before)) * dt);
        }
        if now > before && now >= after && now > 0.0 {
            let (slope, bend) = (0.5 * (after - before), after - 2.0 * now + before);
            peaks.push((k as f64 * dt - dt * slope / bend, now - 0.5 * slope * slope / bend));
        }
    }
    let (first, last) = (crossings[1], crossings[crossings.len() - 1]);
    let (high, low) = (peaks[1], peaks[peaks.len() - 1]);
    [TAU * (crossings.len() - 2) as f64 / (last - first), (high.1 / low.1).ln() / (low.0 - high.0)]
}

/// A hub far heavier than the wheel bounces on contact, track mass, spring and damper.
#[test]
fn a_wheel_bounces_on_its_track_as_two_masses_on_springs_and_a_damper() {
    let mut config = fixed(10);
    (config.wheel.hub_mass, config.vehicle.damping) = (3000.0, 0.0);
    let contact = contact_stiffness(&model(config.clone()));
    let rail = &mut config.rail;
    (rail.support_stiffness, rail.support_damping, rail.support_mass) = (VERTICAL, 1.2e5, 400.0);
    let track = rail.support_mass + rail.length * rail.height * config.material.density * config.model.contact_width;
    let area = PI * (config.wheel.radius.powi(2) - config.wheel.hub_radius.powi(2));
    let wheel = config.wheel.hub_mass + config.material.density * area * config.model.contact_width;
    let expected = two_degrees([wheel, track], contact, VERTICAL, config.rail.support_damping);
    let model = model(config);
    let mut inputs = prescribed(&model, 0.0, 0.0);
    inputs.drive.friction = 0.0;
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    inputs.drive.load *= 1.001;
    let settled = Simulation::new(model, &inputs).unwrap().outputs().contact_approach;
    let dt = TAU / expected.im / 400.0;
    let mut step = || {
        simulation.advance(&inputs, dt).unwrap();
        simulation.outputs().contact_approach - settled
    };
    let signal: Vec<f64> = (0..400 * 6).map(|_| step()).collect();
    let [frequency, decay] = vibration(&signal, dt);
    figure_within(1e-3, "track.bounce", &[frequency, decay]);
    println!("{frequency:.3} rad/s, {decay:.3} 1/s; closed form {expected:.3}");
    assert!((frequency / expected.im - 1.0).abs() < 0.01, "{frequency} rad/s");
    assert!((decay / -expected.re - 1.0).abs() < 0.01, "{decay} 1/s");
}

/// A vibration of the wheel on its track loses what the damper takes: the imbalance is of second order over two
/// halvings of the fixed steps.
#[test]
fn the_damper_takes_what_the_vibration_loses() {
    let residual = |step: f64| {
        let mut config = restrained(6);
        config.tuning.tolerance = 0.0;
        let rail = &mut config.rail;
        (rail.support_stiffness, rail.support_damping, rail.support_mass) = (VERTICAL, 1.2e5, 200.0);
        let model = model(config);
        let mut inputs = prescribed(&model, 0.0, 0.0);
        inputs.drive.friction = 0.0;
        let mut simulation = Simulation::new(model, &inputs).unwrap();
        let (height, load) = (simulation.outputs().contact_approach, inputs.drive.load);
        inputs.drive.load *= 1.2;
        (0..(0.2 / step).round() as usize).for_each(|_| simulation.advance(&inputs, step).unwrap());
        let audit = simulation.state().audit;
        let freed = 0.5 * 0.2 * load * (simulation.outputs().contact_approach - height);
        let dissipated = audit.dissipation() * simulation.model().config().model.contact_width;
        [audit.imbalance() / audit.dissipation(), dissipated / freed]
    };
    let found = [2e-4, 1e-4, 5e-5].map(residual);
    println!("imbalance over dissipated energy, dissipated over freed energy: {found:?}");
    // The load step frees ½ ΔF Δz, but for the bend of the contact law.
    assert!((found[2][1] - 1.0).abs() < 0.01);
    let [coarse, middle, fine] = found.map(|f| f[0].abs());
    assert!(fine < 5e-4 && middle < 0.5 * coarse && fine < 0.09 * coarse);
}

/// How a wheel is stopped.
#[derive(Clone, Copy, Debug)]
struct Stop {
    /// From this speed [m/s].
    speed: f64,
    /// Load over the nominal one.
    load: f64,
    /// Moment over that at the limit of adhesion; 1: the wheel is locked at once and slides.
    brake: f64,
    /// Travels backwards.
    reversed: bool,
}

/// Contact force \[N] over the time after a wheel under default settings has been stopped and held, every millisecond.
fn held_stop(model: &Arc<Model>, stop: Stop, step: f64) -> Vec<f64> {
    let config = model.config();
    let direction = if stop.reversed { -1.0 } else { 1.0 };
    let load = stop.load * config.model.nominal_load;
    let peak = stop.brake * config.friction.coefficient * load * config.wheel.radius;
    let mut inputs = Inputs::rolling(config);
    inputs.drive.load = load;
    (inputs.translation, inputs.drive.velocity) = (Translation::Velocity, stop.speed * direction);
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    inputs.translation = Translation::Force;
    let mut time = 0.0_f64;
    let hold = |inputs: &mut Inputs| (inputs.rotation, inputs.drive.omega) = (Rotation::Velocity, 0.0);
    if stop.brake == 1.0 {
        hold(&mut inputs);
    }
    while simulation.outputs().wheel_velocity * direction > 0.05 {
        inputs.drive.moment = -direction * peak * (time / 0.2).min(1.0);
        simulation.advance(&inputs, step).unwrap();
        time += step;
        assert!(time < 100.0, "no stop");
    }
    hold(&mut inputs);
    let every = (1e-3 / step).round() as usize;
    let mut force = || {
        (0..every).for_each(|_| simulation.advance(&inputs, step).unwrap());
        simulation.outputs().contact_force_x
    };
    (0..2200).map(|_| force()).collect()
}

/// Swings: largest magnitude between changes of sign, with their times in samples.
fn swings(signal: &[f64]) -> Vec<(usize, f64)> {
    let mut found: Vec<(usize, f64)> = vec![(0, 0.0)];
    for (k, pair) in signal.windows(2).enumerate() {
        if pair[0] * pair[1] < 0.0 {
            found.push((k + 1, 0.0));
        }
        let last = found.len() - 1;
        if pair[1].abs() > found[last].1 {
            found[last] = (k + 1, pair[1].abs());
        }
    }
    found
}

/// Share of the first swing that is left 2 s after it, and the decay rate [1/s] over ten periods.
fn rocking(model: &Arc<Model>, stop: Stop, step: f64) -> [f64; 2] {
    let swings = swings(&held_stop(model, stop, step));
    let (start, first) = swings[1];
    let late = swings.iter().filter(|(k, _)| *k >= start + 1950).map(|(_, size)| *size).fold(0.0, f64::max);
    let (k, size) = swings[21];
    let periods = (k - start) as f64 * 1e-3;
    let (decay, frequency) = ((first / size).ln() / periods, 10.0 / periods);
    println!(
        "{stop:?} {step} s: first swing {first:.0} N, after 2 s {:.2} %, {frequency:.2} Hz, decay {decay:.3} 1/s, \
         {:.2} % of critical",
        100.0 * late / first,
        100.0 * decay / (TAU * frequency)
    );
    [late / first, decay]
}

#[test]
fn a_held_stop_comes_to_rest_with_default_settings() {
    let model = model(preset("railway", 10));
    let stop = Stop { speed: 2.0, load: 1.0, brake: 0.4, reversed: false };
    let found = [1e-3, 2e-4].map(|step| rocking(&model, stop, step));
    assert!(found.iter().all(|[late, _]| *late < 0.05), "{found:?}");
    figure("rocking", &[found[0][0], found[1][0], found[0][1] / found[1][1] - 1.0]);
    assert!((found[0][1] / found[1][1] - 1.0).abs() < 0.1, "{found:?}");
}

#[test]
fn a_held_stop_comes_to_rest_whatever_stopped_it() {
    let model = model(preset("railway", 10));
    let plain = Stop { speed: 2.0, load: 1.0, brake: 0.4, reversed: false };
    let stops = [Stop { load: 0.1, ..plain }, Stop { load: 1.9, ..plain }, Stop { reversed: true, ..plain }];
    let found = stops.map(|stop| rocking(&model, stop, 1e-3)[0]);
    assert!(found.iter().all(|late| *late < 0.05), "{found:?}");
}

/// A patch that has slid is hot and rough: near reversals of the motion its expansion makes the forces jump from step
/// to step, so that the control takes steps down to some 20 µs, in which the contact has to be solved to round-off. On
/// a coarse mesh and from a low speed to save time; from 2 m/s with ten elements 3.5 % of the first swing are left.
#[test]
fn a_locked_wheel_comes_to_rest_on_its_hot_patch() {
    let model = model(preset("railway", 6));
    let stop = Stop { speed: 0.5, load: 1.0, brake: 1.0, reversed: false };
    let [late, _] = rocking(&model, stop, 2e-4);
    assert!(late < 0.05, "{late}");
}

/// Modes and all finite elements on a base that moves in both directions, in a braking ramp of 50 ms.
#[test]
fn both_responses_move_alike_on_their_track() {
    let run = |reduced: bool| -> Vec<[f64; 4]> {
        let mut config = restrained(4);
        (config.solver.reduced, config.tuning.tolerance) = (reduced, 0.0);
        let rail = &mut config.rail;
        (rail.support_stiffness, rail.support_damping, rail.support_mass) = (VERTICAL, 1e5, 100.0);
        let model = model(config);
        let mut inputs = Inputs::rolling(model.config());
        let mut simulation = Simulation::new(model, &inputs).unwrap();
        let step = |k: u32| {
            inputs.drive.load = 1e5 * (1.0 + f64::from(k) / 100.0);
            inputs.drive.moment = -100.0 * f64::from(k);
            simulation.advance(&inputs, 5e-4).unwrap();
            let (outputs, [x, y]) = (simulation.outputs(), base(&simulation));
            [outputs.contact_force_x, outputs.contact_force_y, x, y]
        };
        (1..=100).map(step).collect()
    };
    let (reduced, full) = (run(true), run(false));
    for k in 0..4 {
        let size = full.iter().map(|values| values[k].abs()).fold(0.0, f64::max);
        let differences = reduced.iter().zip(&full).map(|(a, b)| (a[k] - b[k]).abs());
        let worst = differences.fold(0.0, f64::max) / size;
        figure(if k < 2 { "track.reduced.force" } else { "track.reduced.base" }, &[worst]);
        println!("quantity {k}: {worst:.1e}");
        assert!(worst < 1e-3, "{worst:e}");
    }
}

/// A ramp of the brake in 0.1 s: the restraint shows while the force changes, by its creep `ḃ = Ḟ/k`, and not in the
/// end.
#[test]
fn a_braking_ramp_feels_the_restraint_only_while_the_force_changes() {
    let run = |config: Config| -> Vec<Outputs> {
        let model = model(config);
        let mut inputs = Inputs::rolling(model.config());
        let mut simulation = Simulation::new(model, &inputs).unwrap();
        let step = |k: u32| {
            inputs.drive.moment = -8280.0 * (f64::from(k) / 100.0).min(1.0);
            simulation.advance(&inputs, 1e-3).unwrap();
            simulation.outputs().clone()
        };
        (1..=200).map(step).collect()
    };
    let (moving, rigid) = (run(restrained(10)), run(fixed(10)));
    let difference = |k: usize| (moving[k].contact_force_x - rigid[k].contact_force_x).abs();
    let creepage = |k: usize| (moving[k].contact_creepage - rigid[k].contact_creepage).abs();
    let worst = (0..200).map(difference).fold(0.0, f64::max);
    let late = (190..200).map(difference).fold(0.0, f64::max);
    let slip = (20..100).map(creepage).fold(0.0, f64::max);
    println!("force differs by up to {worst:.2} N in the ramp, {late:.2e} N after it; creepage by {slip:.2e}");
    assert!(worst < 100.0 && late < 1.0);
}

/// Springs, dampers and mass in both directions, on the way to a lock-up: going back repeats the run bit by bit.
#[test]
fn a_run_on_a_moving_base_resumes_bit_by_bit() {
    let mut config = preset("railway", 6);
    let rail = &mut config.rail;
    (rail.support_stiffness, rail.support_damping, rail.support_mass) = (VERTICAL, 1e5, 100.0);
    let model = model(config);
    let mut inputs = Inputs::rolling(model.config());
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    inputs.drive.moment = -5000.0;
    let go = |simulation: &mut Simulation| {
        (0..20).for_each(|_| simulation.advance(&inputs, 1e-3).unwrap());
        (simulation.outputs().clone(), simulation.state().base)
    };
    go(&mut simulation);
    let bytes = postcard::to_stdvec(simulation.checkpoint()).unwrap();
    let first = go(&mut simulation);
    let checkpoint = postcard::from_bytes(&bytes).unwrap();
    let mut again = Simulation::resume(model.clone(), model.config().tuning.clone(), checkpoint).unwrap();
    assert_eq!(go(&mut again), first);
    assert!(first.1.velocities().iter().all(|v| *v != 0.0));
}

#[test]
fn dampers_and_mass_without_a_spring_are_refused_by_name() {
    let refused = |change: fn(&mut Config), words: &[&str]| {
        let mut config = fixed(6);
        change(&mut config);
        let message = config.validate().unwrap_err().to_string();
        println!("{message}");
        assert!(words.iter().all(|word| message.contains(word)), "{message}");
    };
    refused(|c| c.rail.restraint_damping = 1e5, &["rail.restraint_damping = ", "rail.restraint_stiffness = 0"]);
    refused(|c| c.rail.support_damping = 1e5, &["rail.support_damping = ", "rail.support_stiffness = 0"]);
    let springs = ["rail.support_mass = ", "rail.support_stiffness = 0", "rail.restraint_stiffness = 0"];
    refused(|c| c.rail.support_mass = 100.0, &springs);
    refused(|c| c.rail.support_stiffness = 1e3, &["rail.support_stiffness = 1000", "model.nominal_load"]);
}
