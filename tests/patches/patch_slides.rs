//! Slides, brakes and friction that falls with the slip: against closed forms and more contact nodes.

use crate::common::*;
use std::sync::Arc;
use wheelrail::config::Config;
use wheelrail::simulation::{Inputs, Model, Outputs, Rotation, Simulation};

/// Outputs after every step of a run whose inputs `course` gives for a time.
fn run(model: &Arc<Model>, inputs: Inputs, [h, end]: [f64; 2], course: impl Fn(f64, &mut Inputs)) -> Vec<Outputs> {
    let mut inputs = inputs;
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    let mut seen = Vec::new();
    for k in 1..=(end / h).round() as usize {
        course(k as f64 * h, &mut inputs);
        simulation.advance(&inputs, h).unwrap();
        seen.push(simulation.outputs().clone());
    }
    seen
}

/// Outputs of one run on ten nodes and on twenty.
fn both(
    change: impl Fn(&mut Config),
    inputs: impl Fn(&Model) -> Inputs,
    times: [f64; 2],
    course: impl Fn(f64, &mut Inputs),
) -> [Vec<Outputs>; 2] {
    [10, 20].map(|nodes| {
        let model = without_heat("railway", |config| {
            (config.mesh.elements_per_half_width, config.mesh.grid_elements_per_half_width) = (10, nodes);
            change(config);
        });
        run(&model, inputs(&model), times, &course)
    })
}

/// Largest difference of an output between two runs.
fn apart(runs: &[Vec<Outputs>; 2], get: impl Fn(&Outputs) -> f64) -> f64 {
    runs[0].iter().zip(&runs[1]).map(|(a, b)| (get(a) - get(b)).abs()).fold(0.0, f64::max)
}

/// The wheel is stopped within 20 ms, by speed or by brake, at a tenth, all and nearly twice the load, forwards and
/// backwards; then the rail slides under it.
#[test]
fn a_locked_wheel_slides_with_all_the_friction_of_its_load_and_turns_its_way_into_heat() {
    for (speed, share, brake, h) in [
        (15.0, 1.0, false, 1e-3),
        (-15.0, 1.0, false, 1e-3),
        (15.0, 0.1, false, 1e-3),
        (40.0, 1.9, false, 1e-3),
        (15.0, 1.0, false, 1e-4),
        (15.0, 1.0, true, 1e-3),
        (-15.0, 1.0, true, 1e-4),
        (8.0, 1.0, true, 1e-3),
        (15.0, 1.0, false, 1e-2),
    ] {
        let model = without_heat("railway", |config| {
            (config.initial.velocity, config.physics.yielding) = (speed, false);
        });
        let mut inputs = prescribed(&model, speed, 0.0);
        inputs.drive.load *= share;
        if brake {
            inputs.rotation = Rotation::Moment;
        }
        let rolling = inputs.drive.omega;
        let seen = run(&model, inputs, [h, 0.2], |t, inputs| {
            inputs.drive.omega = rolling * (1.0 - t / 0.02).max(0.0);
            inputs.drive.torque = if brake { 60e3 * (t / 0.02).min(1.0) } else { 0.0 };
        });
        let (half, last) = (&seen[seen.len() / 2 - 1], &seen[seen.len() - 1]);
        let limit = inputs.drive.friction * last.contact_force_y;
        let lost = (half.wheel_distance - last.wheel_distance).abs() * limit;
        let power: f64 = seen[seen.len() / 2..].iter().map(|o| o.friction_power * h).sum();
        let force = last.contact_force_x + limit * speed.signum();
        round_off("slide.force", &[force / limit], 1e-12);
        figure("slide.work", &[power / lost - 1.0]);
        figure("slide.residual", &[last.energy_residual]);
        println!(
            "{speed} m/s, {share} of the load, brake {brake}, {h} s: force {:.1e} off, work {:.1e} off, residual {:.1e}",
            force / limit,
            power / lost - 1.0,
            last.energy_residual
        );
        assert_eq!(last.wheel_omega, 0.0);
        assert_eq!(last.brake_locked, brake);
        assert!(force.abs() < 1e-6 * limit, "friction is all that the load allows");
        assert!((power / lost - 1.0).abs() < 1e-3 && last.energy_residual.abs() < 1e-3);
    }
}

/// A torque beyond adhesion locks the wheel, holds it and lets it go.
#[test]
fn a_brake_locks_the_wheel_and_lets_it_go_as_on_more_nodes() {
    for (falling, h) in [(1.0, 1e-3), (1.0, 1e-4), (0.4, 1e-3)] {
        let runs = both(
            |config| (config.tuning.falling_ratio, config.tuning.falling_decay) = (falling, 0.6),
            |model| Inputs::rolling(model.config()),
            [h, 0.5],
            |t, inputs| inputs.drive.torque = if t < 0.25 { 30e3 * (t / 0.1).min(1.0) } else { 0.0 },
        );
        let held = runs.each_ref().map(|seen| {
            let times = seen.iter().enumerate().filter(|(_, o)| o.brake_locked);
            let times: Vec<f64> = times.map(|(k, _)| (k + 1) as f64 * h).collect();
            [times[0], times[times.len() - 1]]
        });
        let limit = 0.3 * runs[1][0].contact_force_y;
        let force = apart(&runs, |o| o.contact_force_x) / limit;
        let [speed, turn] = [apart(&runs, |o| o.wheel_velocity), 0.46 * apart(&runs, |o| o.wheel_omega)];
        let residual = runs.each_ref().map(|seen| seen[seen.len() - 1].energy_residual);
        figure("brake.apart [m/s]", &[turn]);
        println!(
            "falling to {falling}, {h} s: held {held:?}, force {force:.1e}, {speed:.1e} and {turn:.1e} m/s, {residual:?}"
        );
        assert!(held[0].iter().zip(held[1]).all(|(a, b)| (a - b).abs() <= 1.001e-3));
        assert!(speed < 1e-3 && residual[0].abs() < 1e-3);
        // Where the wheel locks and breaks loose the force falls or rises by all of it within a step.
        let apart: Vec<f64> =
            runs[0].iter().zip(&runs[1]).map(|(a, b)| (a.contact_force_x - b.contact_force_x).abs()).collect();
        let mean = apart.iter().sum::<f64>() / apart.len() as f64;
        assert!(mean < 1e-3 * limit, "{mean} N of {limit} N");
        // The held wheel takes what friction gives, and no more than the brake has.
        assert!(runs[0].iter().all(|o| o.brake_moment.abs() <= 30e3 * (1.0 + 1e-9)));
        assert!(runs[0].iter().filter(|o| o.brake_locked).all(|o| o.wheel_omega == 0.0));
    }
}

/// Friction that falls with the slip excites the torsion of the rim on the hub, whose speed is held at 3 % slip: tread
/// and rail stick and slip in turn.
#[test]
fn falling_friction_sticks_and_slips_as_on_more_nodes() {
    for h in [2e-4, 1e-3] {
        let runs = both(
            |config| {
                (config.tuning.falling_ratio, config.tuning.falling_decay) = (0.4, 0.6);
                config.tuning.tolerance = 0.0;
            },
            |model| prescribed(model, 80.0 * KMH, 0.0),
            [h, 0.12],
            |t, inputs| inputs.drive.omega *= if t < 0.03 { 1.0 - 0.03 * h / 0.03 } else { 1.0 },
        );
        let later = 0.06 / h;
        let [ours, theirs] = runs.each_ref().map(|seen| {
            let force: Vec<f64> =
                seen[later as usize..].iter().map(|o| o.contact_force_x / o.contact_force_y).collect();
            let mean = force.iter().sum::<f64>() / force.len() as f64;
            let (low, high) = range(&force);
            [mean, low, high]
        });
        let early = runs.each_ref().map(|seen| seen[..(0.03 / h) as usize].to_vec());
        let early = apart(&early, |o| o.contact_force_x / o.contact_force_y);
        ours.iter().zip(&theirs).for_each(|(a, b)| figure("stick.slip.nodes", &[a - b]));
        println!("{h} s: mean and range {ours:.5?}, on more nodes {theirs:.5?}; {early:.1e} apart before it starts");
        assert!(early < 2e-3);
        assert!(ours.iter().zip(&theirs).all(|(a, b)| (a - b).abs() < 6e-3), "{ours:?} {theirs:?}");
        for o in runs.iter().flatten() {
            assert!(o.contact_force_x.abs() <= 0.3 * o.contact_force_y * (1.0 + 1e-9), "no more than friction");
        }
    }
}

/// Below the heat at which steel yields.
#[test]
fn a_hot_slide_is_as_hot_as_on_more_nodes_and_its_energy_is_accounted_for() {
    for (slip, speed, h, share) in
        [(0.05, 60.0, 1e-3, 1.0), (0.2, 60.0, 1e-3, 1.0), (0.2, -60.0, 1e-3, 1.9), (0.1, 60.0, 1e-4, 0.1)]
    {
        let runs = both(
            |config| {
                (config.thermal.enabled, config.tuning.softening, config.physics.yielding) = (true, 0.0, share < 1.5)
            },
            |model| {
                let mut inputs = prescribed(model, speed * KMH, 0.0);
                inputs.drive.load *= share;
                inputs
            },
            [h, 0.1],
            |t, inputs| inputs.drive.omega *= if t < 0.05 { 1.0 - slip * h / 0.05 } else { 1.0 },
        );
        let ends = runs.each_ref().map(|seen| &seen[seen.len() - 1]);
        let rise = ends.map(|o| o.temperature_wheel_max - 293.15);
        let (limit, [ours, theirs]) = (0.3 * ends[0].contact_force_y, ends.map(|o| o.energy_residual));
        println!(
            "slip {slip} at {speed} km/h, {h} s, {share} of the load: rise {rise:.2?} K, force {:.1e} of its limit off, \
             residual {ours:.1e} and {theirs:.1e}",
            ends[0].contact_force_x.abs() / limit - 1.0,
        );
        let coarse = if share < 0.5 { 10.0 } else { 1.0 };
        assert!((rise[0] / rise[1] - 1.0).abs() < 8e-3 * coarse);
        assert!((ends[0].contact_force_x.abs() / limit - 1.0).abs() < 1e-4 && ours.abs() < 1e-3);
    }
}
