//! The contact on a single smooth patch, `solver.contact = patch` and `auto`, on the bodies of the presets: against the
//! converged reference and the contact on the grid, and what a run has to keep.

mod common;
use common::*;
use std::sync::Arc;
use wheelrail::config::ContactMethod;
use wheelrail::simulation::{Drive, Inputs, Model, Outputs, Simulation, Vertical};

type Field = fn(&mut Drive) -> &mut f64;

fn paper_d(contact: ContactMethod) -> Arc<Model> {
    solved_by(contact, "paper_d", |config| config.physics.centrifugal = false)
}

/// Creepage ramp from 0 to −8e-4 in 70 % of `duration`, held to its end: `F/μP` at tenths of the duration.
fn creepage_ramp(model: &Arc<Model>, duration: f64, steps: usize) -> Vec<f64> {
    let mut inputs = prescribed(model, 50.0 * KMH, 0.0);
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    let mut tenths = Vec::new();
    for k in 1..=steps {
        let share = k as f64 / steps as f64;
        inputs.drive.omega = omega(model, 50.0 * KMH, -8e-4 * (share / 0.7).min(1.0));
        simulation.advance(&inputs, duration / steps as f64).unwrap();
        assert!(is_patch(&simulation) || model.config().solver.contact == ContactMethod::Grid);
        if k % (steps / 10) == 0 {
            tenths.push(signed_utilisation(&simulation, inputs.drive.friction));
        }
    }
    tenths
}

#[test]
fn steady_rolling_is_that_of_the_grid_and_of_the_reference() {
    let [patch, grid] = [ContactMethod::Patch, ContactMethod::Grid].map(paper_d);
    let reference = [
        (0.0, -0.003556),
        (-1e-4, 0.298297),
        (-3e-4, 0.741135),
        (-5e-4, 0.967564),
        (-8e-4, 1.0),
        (1e-4, -0.304676),
        (4e-4, -0.882458),
    ];
    for (xi, expected) in reference {
        let [ours, theirs] = [&patch, &grid].map(|model| {
            let simulation = Simulation::new(model.clone(), &prescribed(model, 50.0 * KMH, xi)).unwrap();
            (signed_utilisation(&simulation, 0.4), simulation.outputs().clone())
        });
        figure("points.from.nodes", &[ours.0 - theirs.0]);
        figure("points.from.reference", &[ours.0 - expected]);
        println!("{xi:e}: patch {:.6}, grid {:.6}, reference {expected:.6}", ours.0, theirs.0);
        assert!((ours.0 - theirs.0).abs() < 1e-3 && (ours.0 - expected).abs() < 1.5e-3);
        let relative = |get: fn(&Outputs) -> f64| get(&ours.1) / get(&theirs.1) - 1.0;
        assert!(relative(|o| o.contact_half_width).abs() < 5e-4 && relative(|o| o.contact_pressure_max).abs() < 3e-4);
        assert!(relative(|o| o.contact_approach).abs() < 1e-4);
        let power = (ours.1.friction_power - theirs.1.friction_power).abs();
        println!("friction power {:.4} W and {power:.4} W", ours.1.friction_power);
        assert!(power < 1e-3 * theirs.1.friction_power + 1e-3);
        assert!((ours.1.contact_stick_fraction - theirs.1.contact_stick_fraction).abs() < 0.02);
        // Independently computed: half-width 7.611e-4 ± 4e-7 m, pressure 83.65 ± 0.03 MPa.
        assert!((ours.1.contact_half_width - 7.611e-4).abs() < 4e-7);
        assert!((ours.1.contact_pressure_max - 83.65e6).abs() < 3e4);
    }
}

#[test]
fn the_railway_wheel_creeps_as_on_the_grid_from_a_tenth_of_the_load_to_nearly_twice_it() {
    [false, true].into_iter().for_each(creeps);
}

fn creeps(heat: bool) {
    let [patch, grid] = [ContactMethod::Patch, ContactMethod::Grid].map(|method| {
        solved_by(method, "railway", |config| {
            config.thermal.enabled = heat;
            // At nearly twice the load steel yields under its shear, for which the patch method is not made.
            config.physics.yielding = false;
        })
    });
    for share in [0.1, 1.0, 1.9] {
        for xi in [-6e-3, -2e-3, -5e-4, 0.0, 1e-3, 3e-3] {
            for velocity in [1.0, 80.0 * KMH, -20.0] {
                let [ours, theirs] = [&patch, &grid].map(|model| {
                    let mut inputs = prescribed(model, velocity, xi);
                    inputs.drive.load *= share;
                    let simulation = Simulation::new(model.clone(), &inputs).unwrap();
                    signed_utilisation(&simulation, inputs.drive.friction)
                });
                if !heat {
                    figure(if share < 0.5 { "points.railway.light" } else { "points.railway" }, &[ours - theirs]);
                }
                println!(
                    "heat {heat}, {share} of the load, {velocity:.0} m/s, {xi:e}: {ours:.6} and {:.1e}",
                    ours - theirs
                );
                // A tenth of the load has six cells of the grid to a half-width.
                let bound = if share < 0.5 { 6e-3 } else { 1e-3 };
                assert!((ours - theirs).abs() < bound, "{ours} {theirs}");
            }
        }
    }
}

/// Errors of the reference are up to 0.0059; where they exceed the 0.003 asked for, they are the bound.
#[test]
fn creepage_ramps_match_the_reference() {
    let [patch, grid] = [ContactMethod::Patch, ContactMethod::Grid].map(paper_d);
    let cases = [
        (
            1e-3,
            [-0.0025, -0.0008, 0.0062, 0.0232, 0.0561, 0.1088, 0.1853, 0.2853, 0.4091, 0.5491],
            [0.0015, 0.0015, 0.0015, 0.0015, 0.0016, 0.0016, 0.0018, 0.0018, 0.002, 0.0026],
        ),
        (
            1e-2,
            [0.0558, 0.3206, 0.5996, 0.8415, 0.9818, 1.0, 1.0, 1.0, 1.0, 1.0],
            [0.0016, 0.0023, 0.0022, 0.0038, 0.0059, 0.0015, 0.0015, 0.0015, 0.0015, 0.0015],
        ),
        (
            1e-1,
            [0.3034, 0.5891, 0.7975, 0.9326, 0.9949, 1.0, 1.0, 1.0, 1.0, 1.0],
            [0.003, 0.003, 0.0037, 0.0044, 0.0037, 0.0015, 0.0015, 0.0015, 0.0015, 0.0015],
        ),
    ];
    for (duration, reference, errors) in cases {
        let (curve, on_grid) = (creepage_ramp(&patch, duration, 400), creepage_ramp(&grid, duration, 400));
        let differences: Vec<f64> = curve.iter().zip(&reference).map(|(a, b)| a - b).collect();
        let from_grid = curve.iter().zip(&on_grid).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        differences.iter().for_each(|difference| figure("points.ramps", &[*difference]));
        figure("points.ramps.nodes", &[from_grid]);
        println!("{duration:.0e} s: {curve:.4?}, from the reference {differences:.4?}, from the grid {from_grid:.5}");
        assert!(from_grid < 1e-3);
        for (difference, error) in differences.iter().zip(errors) {
            assert!(difference.abs() <= f64::max(3e-3, error) + 4e-4, "{difference}");
        }
    }
}

/// Rolling under a brake moment that steps on and off; outputs after every millisecond.
fn braked(model: &Arc<Model>, steps: usize) -> (Simulation, Inputs, Vec<Outputs>) {
    let mut inputs = Inputs::rolling(model.config());
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    let mut seen = Vec::new();
    for k in 0..steps {
        inputs.drive.moment = if k % 100 < 60 { -7000.0 } else { 2000.0 };
        simulation.advance(&inputs, 1e-3).unwrap();
        seen.push(simulation.outputs().clone());
    }
    (simulation, inputs, seen)
}

#[test]
fn a_braked_wheel_moves_as_on_the_grid_and_its_energy_is_accounted_for() {
    let run = |method| braked(&solved_by(method, "railway", |_| {}), 200).2;
    let [ours, theirs] = [ContactMethod::Auto, ContactMethod::Grid].map(run);
    let load = ours[0].contact_force_y;
    let worst = |get: fn(&Outputs) -> f64, scale: f64| {
        ours.iter().zip(&theirs).map(|(a, b)| (get(a) - get(b)).abs() / scale).fold(0.0, f64::max)
    };
    let force = worst(|o| o.contact_force_x, 0.3 * load);
    let normal = worst(|o| o.contact_force_y, load);
    let speed = worst(|o| o.wheel_velocity, ours[0].wheel_velocity);
    let residual = ours.iter().map(|o| o.energy_residual.abs()).fold(0.0, f64::max);
    let on_grid = theirs.iter().map(|o| o.energy_residual.abs()).fold(0.0, f64::max);
    println!(
        "force {force:.1e}, load {normal:.1e}, speed {speed:.1e}, residual {residual:.1e} ({on_grid:.1e} on the grid)"
    );
    assert!(force < 3e-3 && normal < 3e-4 && speed < 1e-6);
    assert!(residual < 5e-3);
}

/// An implicit master looks for the velocities of free rolling: the answer to small ones has the slope of Carter's
/// tractions on both sides, down to a millionth of friction.
#[test]
fn small_creep_forces_of_both_signs_have_one_slope() {
    const SMALL: [f64; 5] = [-2e-5, -2.5e-6, -1e-6, 1e-6, 2e-5];
    for h in [4e-3, 1e-3] {
        let model = solved_by(ContactMethod::Patch, "railway", |_| ());
        let start = |xi: f64| Simulation::new(model.clone(), &prescribed(&model, 2.0, xi)).unwrap();
        let (mut low, mut high) = (-3e-4, 3e-4);
        assert!(start(low).outputs().contact_force_x > 0.0 && start(high).outputs().contact_force_x < 0.0);
        for _ in 0..45 {
            let middle = 0.5 * (low + high);
            *(if start(middle).outputs().contact_force_x > 0.0 { &mut low } else { &mut high }) = middle;
        }
        let force = |turning: f64| {
            let mut inputs = prescribed(&model, 2.0, low);
            let mut simulation = start(low);
            inputs.drive.omega += turning;
            simulation.advance(&inputs, h).unwrap();
            simulation.outputs().contact_force_x
        };
        let slopes = SMALL.map(|turning| (force(turning) - force(0.0)) / turning);
        println!("steps of {h} s: {slopes:?} N s/rad");
        assert!(slopes.iter().all(|slope| (slope / slopes[0] - 1.0).abs() < 5e-3));
    }
}

#[test]
fn a_state_of_the_patch_goes_back_and_through_bytes_bit_for_bit() {
    [false, true].into_iter().for_each(goes_back);
}

fn goes_back(heat: bool) {
    // The moment jumps in such a way that the grid takes over in between.
    let model = solved_by(ContactMethod::Auto, "railway", |config| {
        (config.mesh.elements_per_half_width, config.thermal.enabled) = (10, heat);
    });
    let (mut simulation, inputs, _) = braked(&model, 30);
    assert!(is_patch(&simulation));
    let checkpoint = simulation.checkpoint().clone();
    let bytes = postcard::to_stdvec(&checkpoint).unwrap();
    let go_on = |simulation: &mut Simulation| {
        for k in 0..30 {
            let mut inputs = inputs;
            inputs.drive.moment = -1e4 * f64::from(k % 3);
            simulation.advance(&inputs, 1e-3 * (1.0 + f64::from(k % 2))).unwrap();
        }
        simulation.state().clone()
    };
    let first = go_on(&mut simulation);
    simulation.recall(checkpoint).unwrap();
    assert!(go_on(&mut simulation) == first);
    let restored = postcard::from_bytes(&bytes).unwrap();
    let mut other = Simulation::resume(model.clone(), model.config().tuning.clone(), restored).unwrap();
    assert!(go_on(&mut other) == first);
}

#[test]
fn derivatives_by_the_inputs_are_those_of_steps_taken_anew() {
    [false, true].into_iter().for_each(derivatives);
}

fn derivatives(heat: bool) {
    let model = solved_by(ContactMethod::Patch, "railway", |config| {
        (config.tuning.tolerance, config.thermal.enabled) = (0.0, heat);
    });
    let (mut simulation, mut inputs, _) = braked(&model, 30);
    let before = simulation.checkpoint().clone();
    inputs.drive.moment = -7500.0;
    simulation.advance(&inputs, 1e-3).unwrap();
    let fields: [(&str, Field, f64); 3] =
        [("moment", |d| &mut d.moment, 40.0), ("load", |d| &mut d.load, 20.0), ("friction", |d| &mut d.friction, 1e-4)];
    for (name, field, step) in fields {
        let mut direction = Drive::default();
        *field(&mut direction) = 1.0;
        let found = simulation.difference(&direction).unwrap().quotient(|o| o.contact_force_x);
        let [low, high] = [-step, step].map(|by| {
            let mut inputs = inputs;
            *field(&mut inputs.drive) += by;
            let mut again = Simulation::resume(model.clone(), model.config().tuning.clone(), before.clone()).unwrap();
            again.advance(&inputs, 1e-3).unwrap();
            again.outputs().contact_force_x
        });
        let expected = (high - low) / (2.0 * step);
        println!("d force_x / d {name}: {found:.8e}, by steps taken anew {expected:.8e}");
        assert!((found / expected - 1.0).abs() < 1e-5);
    }
}

/// A wheel that slows down to a crawl and speeds up again at constant creepage: the patch gives way to the grid and
/// takes over again. How much the forces jump at a change of solver is by what their change in a step exceeds that of a
/// run on the grid.
#[test]
fn a_change_of_solver_does_not_make_the_forces_jump_whatever_the_step() {
    [5e-5, 2e-4, 1e-3, 5e-3, 2e-2].into_iter().for_each(|h| changes_smoothly(10, false, h));
    [5e-5, 1e-3, 2e-2].into_iter().for_each(|h| changes_smoothly(10, true, h));
    [5e-5, 1e-3].into_iter().for_each(|h| changes_smoothly(20, false, h));
}

fn changes_smoothly(elements: usize, heat: bool, h: f64) {
    let (xi, steps) = (-1.5e-3, 400_u32);
    // A half-width is 6 mm: at its fastest the material moves by as much in a step, or with 2 m/s.
    let top = f64::min(6e-3 / h, 2.0);
    let run = |method| {
        let model = solved_by(method, "railway", |config| {
            (config.tuning.tolerance, config.thermal.enabled) = (0.0, heat);
            config.mesh.elements_per_half_width = elements;
        });
        let mut inputs = prescribed(&model, top, xi);
        let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
        let (mut forces, mut patch) = (Vec::new(), Vec::new());
        for k in 0..steps {
            let turn = std::f64::consts::TAU * f64::from(k) / f64::from(steps);
            inputs.drive.velocity = top * (0.5001 + 0.4999 * turn.cos()).powi(2);
            inputs.drive.omega = omega(&model, inputs.drive.velocity, xi);
            simulation.advance(&inputs, h).unwrap();
            let o = simulation.outputs();
            forces.push([o.contact_force_x / o.contact_force_y, o.contact_force_y / inputs.drive.load]);
            patch.push(is_patch(&simulation));
        }
        (forces, patch)
    };
    let ((forces, patch), (on_grid, _)) = (run(ContactMethod::Auto), run(ContactMethod::Grid));
    let excess = |k: usize, axis: usize| forces[k][axis] - on_grid[k][axis];
    let changes: Vec<usize> = (3..steps as usize - 2).filter(|&k| patch[k] != patch[k - 1]).collect();
    let largest = [0, 1].map(|axis| {
        let jump = |k: usize| (excess(k, axis) - excess(k - 1, axis)).abs();
        changes.iter().map(|&k| jump(k).max(jump(k + 1))).fold(0.0, f64::max)
    });
    let on = patch.iter().filter(|on| **on).count();
    figure(if heat { "points.change.heat" } else { "points.change" }, &largest);
    println!(
        "{elements} elements, heat {heat}, {h} s: changes at {changes:?}, {on} of {steps} steps on the patch, largest jumps \
         {:.1e}, {:.1e}",
        largest[0], largest[1]
    );
    assert!(changes.len() >= 2 && largest.iter().all(|jump| *jump < 1e-4));
}

#[test]
fn auto_takes_the_grid_where_the_patch_does_not_hold_and_patch_alone_refuses() {
    // Under three times the load the patch outgrows what is known of the smooth bodies.
    let model = solved_by(ContactMethod::Auto, "railway", |_| {});
    let mut inputs = Inputs::rolling(model.config());
    inputs.drive.load *= 3.0;
    let wide = Simulation::new(model.clone(), &inputs).unwrap();
    assert!(!is_patch(&wide));
    let only = solved_by(ContactMethod::Patch, "railway", |_| {});
    let mut inputs = Inputs::rolling(only.config());
    inputs.drive.load *= 3.0;
    assert!(Simulation::new(only.clone(), &inputs).is_err());
    // Reversible heating needs strains that only the grid has.
    let hot = solved_by(ContactMethod::Auto, "railway", |config| {
        (config.thermal.enabled, config.physics.thermoelastic_heating) = (true, true);
    });
    assert!(!is_patch(&Simulation::new(hot.clone(), &Inputs::rolling(hot.config())).unwrap()));
}

#[test]
fn a_wheel_with_its_brake_on_moves_as_on_the_grid_with_auto() {
    let [auto, grid] = [ContactMethod::Auto, ContactMethod::Grid].map(|method| {
        let model = solved_by(method, "railway", |_| {});
        let mut inputs = Inputs::rolling(model.config());
        let mut simulation = Simulation::new(model, &inputs).unwrap();
        inputs.drive.torque = 4e3;
        (0..100).for_each(|_| {
            simulation.advance(&inputs, 1e-3).unwrap();
            assert_eq!(is_patch(&simulation), method == ContactMethod::Auto);
        });
        simulation.outputs().clone()
    });
    let change = |get: fn(&Outputs) -> f64| (get(&auto) / get(&grid) - 1.0).abs();
    println!("force {:.3e}, angular velocity {:.3e}", change(|o| o.contact_force_x), change(|o| o.wheel_omega));
    assert!((auto.brake_moment + 4e3).abs() < 1.0 && change(|o| o.contact_force_x) < 1e-3);
    assert!(change(|o| o.wheel_omega) < 1e-6);
}

/// Locks the wheel with a moment far beyond adhesion, and lets it go again.
#[test]
fn a_wheel_that_locks_and_recovers_runs_through_as_on_the_grid() {
    let run = |method| {
        let model = solved_by(method, "railway", |_| {});
        let mut inputs = Inputs::rolling(model.config());
        let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
        let (mut seen, mut on_patch) = (Vec::new(), 0);
        for k in 0..400 {
            inputs.drive.moment = if k < 120 { -40e3 } else { 0.0 };
            simulation.advance(&inputs, 1e-3).unwrap();
            on_patch += usize::from(is_patch(&simulation));
            seen.push((simulation.outputs().wheel_omega, simulation.outputs().wheel_velocity));
        }
        println!("{method:?}: {on_patch} of 400 steps end on a patch, last {:?}", seen[399]);
        seen
    };
    let (ours, theirs) = (run(ContactMethod::Auto), run(ContactMethod::Grid));
    let end = |seen: &[(f64, f64)]| seen[399];
    assert!((end(&ours).1 / end(&theirs).1 - 1.0).abs() < 1e-5);
    assert!((end(&ours).0 / end(&theirs).0 - 1.0).abs() < 1e-3);
}

/// From rest under a driving moment, lifted off the rail, put down again and braked to a stop.
#[test]
fn a_wheel_that_starts_lifts_off_and_stops_runs_through_as_on_the_grid() {
    let run = |method| {
        let model = solved_by(method, "railway", |config| config.initial.velocity = 0.5);
        let mut inputs = Inputs::rolling(model.config());
        let mut on_patch = 0;
        let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
        let mut seen = Vec::new();
        for k in 0..600 {
            inputs.drive.moment = if k < 200 { 3000.0 } else { -6000.0 };
            let lifted = (100..110).contains(&k);
            inputs.vertical = if lifted { Vertical::Displacement } else { Vertical::Force };
            inputs.drive.displacement = if lifted { 2e-5 } else { 0.0 };
            simulation.advance(&inputs, 1e-3).unwrap();
            on_patch += usize::from(is_patch(&simulation));
            seen.push(simulation.outputs().clone());
        }
        let open = seen.iter().filter(|o| o.contact_force_y == 0.0).count();
        println!("{method:?}: {on_patch} of 600 steps end on the patch, {open} without contact");
        assert!(open > 5);
        seen
    };
    let (ours, theirs) = (run(ContactMethod::Auto), run(ContactMethod::Grid));
    for k in [99, 150, 250, 400, 599] {
        let (a, b) = (&ours[k], &theirs[k]);
        println!(
            "{k}: {:.6} and {:.6} m/s, {:.5} and {:.5} rad/s",
            a.wheel_velocity, b.wheel_velocity, a.wheel_omega, b.wheel_omega
        );
        assert!(
            (a.wheel_velocity - b.wheel_velocity).abs() < 1e-3 && (a.contact_force_y - b.contact_force_y).abs() < 2e3
        );
    }
}
