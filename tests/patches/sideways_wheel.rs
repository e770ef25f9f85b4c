//! A wheel with lateral creepage and spin as its master sees it: forces held together, locking with an angle of attack, energy and
//! momentum from outside, symmetry, states, and what is refused.

use crate::common::*;
use std::sync::Arc;
use wheelrail::config::Config;
use wheelrail::simulation::{Drive, Inputs, Lateral, Model, Outputs, Rotation, Simulation, Translation};

/// Share of a balance that an outside observer may miss \[1].
const CLOSED: f64 = 1e-4;

/// The elliptical patch with lateral creepage, on a number of lines.
fn sideways(lines: usize, change: impl Fn(&mut Config)) -> Arc<Model> {
    let mut config = preset("railway_ellipse", 8);
    (config.contact.lines, config.contact.lateral) = (lines, true);
    (config.thermal.enabled, config.initial.velocity) = (false, 20.0);
    config.physics.yielding = false;
    config.tuning.tolerance = 0.0;
    change(&mut config);
    model(config)
}

/// Inputs that prescribe velocity, creepage, lateral velocity and spin.
fn moving(model: &Model, creepage: f64, lateral: f64, spin: f64) -> Inputs {
    let mut inputs = prescribed(model, 20.0, creepage);
    (inputs.drive.lateral_velocity, inputs.drive.spin) = (lateral * 20.0, spin);
    inputs
}

fn start(model: &Arc<Model>, inputs: &Inputs) -> Outputs {
    Simulation::new(model.clone(), inputs).unwrap().outputs().clone()
}

#[test]
fn without_lateral_motion_and_spin_the_patch_is_the_longitudinal_one() {
    let models = [false, true].map(|lateral| sideways(7, |config| config.contact.lateral = lateral));
    for creepage in [5e-4, 2e-3, 1e-2] {
        let of = |model: &Arc<Model>| {
            start(model, &moving(model, creepage, if model.config().contact.lateral { HARDLY } else { 0.0 }, 0.0))
        };
        let [along, both] = models.each_ref().map(of);
        let limit = 0.3 * 1e5;
        let missed = (both.contact_force_x - along.contact_force_x) / limit;
        let aside = [both.contact_force_z / limit, both.contact_moment_y / (limit * along.contact_half_width)];
        figure("sideways.none", &[missed]);
        println!("creepage {creepage}: force {missed:+.1e}, lateral force and moment {aside:?}");
        assert!(missed.abs() < 2e-3 && aside.iter().all(|share| share.abs() < 1e-6));
    }
}

/// A wheel that has not moved across computes nothing there. A step with a lateral velocity that is taken back leaves no trace in
/// the buffers of the next one.
#[test]
fn a_lateral_step_that_is_taken_back_leaves_no_trace() {
    let model = sideways(5, |_| {});
    let still = moving(&model, 1e-3, 0.0, 0.0);
    let mut simulation = Simulation::new(model.clone(), &still).unwrap();
    let before = simulation.checkpoint().clone();
    let mut step = |lateral: f64| {
        simulation.recall(before.clone()).unwrap();
        simulation.advance(&moving(&model, 1e-3, lateral, 0.2 * lateral), 1e-3).unwrap();
        simulation.outputs().clone()
    };
    let [first, across, again] = [0.0, 1e-3, 0.0].map(&mut step);
    assert!(across.contact_force_z.abs() > 100.0 && across.contact_moment_y != 0.0);
    assert!(first == again && first.contact_moment_y == 0.0);
}

#[test]
fn mirror_images_of_the_motion_have_mirror_images_of_the_forces() {
    let model = sideways(5, |_| {});
    let run = |sign: f64| {
        let inputs = moving(&model, 1e-3, sign * 5e-4, sign * 0.2);
        let seen = run(&model, inputs, (1e-4, 40), |inputs, t| {
            inputs.drive.lateral_velocity = sign * (0.01 + 0.02 * (300.0 * t).sin());
            inputs.drive.contact_angle = sign * 0.1 * (200.0 * t).sin();
        });
        seen[40].clone()
    };
    let [right, left] = [1.0, -1.0].map(run);
    let limit = 0.3 * 1e5;
    let differences = [
        (right.contact_force_x - left.contact_force_x) / limit,
        (right.contact_force_z + left.contact_force_z) / limit,
        (right.contact_moment_y + left.contact_moment_y) / (limit * right.contact_half_width),
        (right.contact_spin + left.contact_spin) / right.contact_spin,
    ];
    println!("{differences:?} of {:.0} N and {:.0} N", right.contact_force_x, right.contact_force_z);
    assert!(differences.iter().all(|difference| difference.abs() < 1e-9));
    assert!(right.contact_force_z.abs() > 0.05 * limit);
}

#[test]
fn signs_are_those_of_the_figure() {
    let model = sideways(5, |_| {});
    let push = start(&model, &moving(&model, 0.0, 2e-3, 0.0));
    assert!(push.contact_force_z < 0.0 && push.hub_force_z == -push.contact_force_z);
    assert!(push.contact_lateral_creepage > 0.0 && push.hub_lateral_power > 0.0);
    let turn = start(&model, &moving(&model, 0.0, 0.0, 0.5));
    assert!(turn.contact_moment_y > 0.0 && (turn.contact_spin - 0.5).abs() < 1e-3 && turn.hub_spin_power > 0.0);
    let mut inputs = moving(&model, 0.0, 0.0, 0.0);
    inputs.drive.contact_angle = 0.05;
    let tilted = start(&model, &inputs);
    let expected = -0.05_f64.sin() / model.config().wheel.radius;
    println!("spin of a right-hand wheel at 50 mrad: {:.4} 1/m, expected {expected:.4}", tilted.contact_spin);
    assert!((tilted.contact_spin / expected - 1.0).abs() < 1e-2);
    // Spin makes a lateral force, as in Kalker's table C23: w_z = σ x slides to the right in front, where it counts more.
    println!("lateral force by spin 0.5 1/m: {:.0} N", turn.contact_force_z);
    assert!(turn.contact_force_z != 0.0);
}

#[test]
fn a_lateral_and_a_forward_force_are_held_together() {
    let model = sideways(5, |config| config.vehicle.mass = 0.0);
    let mut inputs = Inputs::rolling(model.config());
    inputs.lateral = Lateral::Force;
    (inputs.drive.lateral_force, inputs.drive.moment, inputs.drive.force) = (8e3, -4e3, 4e3 / 0.46);
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    let first = simulation.outputs().clone();
    assert!((first.contact_force_z / -8e3 - 1.0).abs() < 1e-9, "{}", first.contact_force_z);
    let speed = first.wheel_lateral_velocity;
    for _ in 0..100 {
        simulation.advance(&inputs, 1e-3).unwrap();
    }
    let last = simulation.outputs();
    println!(
        "F_z {:.1} N, F_x {:.1} N, drift {:.3} mm/s, then {:.3} mm/s",
        last.contact_force_z,
        last.contact_force_x,
        1e3 * speed,
        1e3 * last.wheel_lateral_velocity
    );
    assert!(speed > 0.0 && (last.wheel_lateral_velocity / speed - 1.0).abs() < 1e-2);
    assert!((last.contact_force_z / -8e3 - 1.0).abs() < 1e-3);
}

/// Braked by its angular velocity until it is locked, with an angle of attack of 20 mrad.
#[test]
fn a_wheel_that_locks_with_an_angle_of_attack_slides_where_it_goes() {
    let model = sideways(5, |_| {});
    let inputs = moving(&model, 0.0, 0.02, 0.0);
    let omega = inputs.drive.omega;
    let seen = run(&model, inputs, (2e-4, 300), |inputs, t| inputs.drive.omega = omega * (1.0 - t / 0.03).max(0.0));
    let (first, last) = (&seen[0], &seen[300]);
    let limit = 0.3 * last.contact_force_y;
    let direction = last.contact_force_z.atan2(last.contact_force_x) + std::f64::consts::PI;
    figure_within(1e-3, "sideways.angle.of.attack", &[last.contact_slip_direction]);
    figure("sideways.angle.of.force", &[direction - last.contact_slip_direction]);
    println!(
        "rolling: F_z {:.3} of the limit; locked: F_x {:.4}, F_z {:.5}, direction of force {direction:.5}, of slip {:.5} rad",
        first.contact_force_z / limit,
        last.contact_force_x / limit,
        last.contact_force_z / limit,
        last.contact_slip_direction
    );
    assert!(first.contact_force_z < -0.8 * limit);
    assert!((last.contact_force_x.hypot(last.contact_force_z) / limit - 1.0).abs() < 5e-3);
    assert!((last.contact_slip_direction - 0.02_f64.atan()).abs() < 1e-4);
    assert!((direction.rem_euclid(2.0 * std::f64::consts::PI) - last.contact_slip_direction).abs() < 1e-3);
}

/// Observation of a run from its outputs alone: works and impulses by the trapezoidal rule.
fn observed(
    model: &Arc<Model>,
    mut inputs: Inputs,
    (step, count): (f64, usize),
    at: impl Fn(f64) -> [f64; 2],
) -> [f64; 2] {
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    let power = |seen: &Outputs| {
        seen.hub_force_x * seen.wheel_velocity
            + seen.hub_force_y * seen.hub_vertical_velocity
            + seen.hub_moment * seen.wheel_omega
            + seen.hub_lateral_power
            + seen.hub_spin_power
    };
    let push = |seen: &Outputs| seen.hub_force_z + seen.contact_force_z;
    let (mut before, mut work, mut impulse, mut driven) = (simulation.outputs().clone(), 0.0, 0.0, 0.0);
    let first = before.clone();
    for k in 1..=count {
        let [from, to] = [k - 1, k].map(|k| at(k as f64 * step));
        [inputs.drive.lateral_force, inputs.drive.spin] = from;
        [inputs.rate.lateral_force, inputs.rate.spin] = [0, 1].map(|i| (to[i] - from[i]) / step);
        simulation.advance(&inputs, step).unwrap();
        let now = simulation.outputs().clone();
        work += 0.5 * step * (power(&before) + power(&now));
        impulse += 0.5 * step * (push(&before) + push(&now));
        driven += 0.5 * step * (before.hub_force_z.abs() + now.hub_force_z.abs());
        before = now;
    }
    let gone = before.stored_energy + before.friction_energy + before.damping_energy - before.thermal_work;
    let width = model.config().wheel.lateral_mass + before.wheel_mass;
    let momentum = width * (before.wheel_lateral_velocity - first.wheel_lateral_velocity);
    println!(
        "work {work:.3} J, gone {gone:.3} J (friction {:.3}, damping {:.4}); impulse {impulse:.5} N s, momentum {momentum:.5} N s",
        before.friction_energy, before.damping_energy
    );
    [(work - gone) / before.friction_energy, (impulse - momentum) / driven]
}

#[test]
fn an_outside_observer_balances_energy_and_lateral_momentum() {
    let rigid = sideways(5, |config| config.wheel.lateral_mass = 500.0);
    let mut inputs = Inputs::rolling(rigid.config());
    (inputs.lateral, inputs.translation, inputs.drive.moment) = (Lateral::Force, Translation::Velocity, -6e3);
    let at = |t: f64| [6e3 * (1.0 - (150.0 * t).cos()), 0.1 * (1.0 - (100.0 * t).cos())];
    let missed = observed(&rigid, inputs, (5e-5, 1200), at);
    figure("sideways.balance.rigid", &missed);
    println!("energy {:+.1e}, momentum {:+.1e}", missed[0], missed[1]);
    assert!(missed.iter().all(|missed| missed.abs() < CLOSED));
}

#[test]
fn a_state_gone_back_to_is_the_same_to_the_bit() {
    let model = sideways(5, |_| ());
    let mut inputs = moving(&model, 1e-3, 1e-3, 0.1);
    let mut simulation = Simulation::new(model, &inputs).unwrap();
    simulation.advance(&inputs, 1e-3).unwrap();
    let saved = simulation.checkpoint().clone();
    let mut ends = Vec::new();
    for _ in 0..2 {
        simulation.recall(saved.clone()).unwrap();
        inputs.drive.lateral_velocity = 0.08;
        simulation.advance(&inputs, 1e-3).unwrap();
        ends.push(simulation.outputs().clone());
    }
    assert!(ends[0] == ends[1]);
}

/// Creep coefficients of the present state: derivatives of forces and moment by lateral velocity and spin.
#[test]
fn derivatives_of_the_present_state_are_those_of_two_states_beside_it() {
    let model = sideways(5, |_| {});
    let inputs = moving(&model, 2e-4, 2e-4, 0.02);
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    type Input = fn(&mut Drive) -> &mut f64;
    let directions: [(&str, Input, f64); 2] =
        [("lateral velocity", |drive| &mut drive.lateral_velocity, 1e-4), ("spin", |drive| &mut drive.spin, 1e-3)];
    for (name, input, size) in directions {
        let mut direction = Drive::default();
        *input(&mut direction) = 1.0;
        let found = simulation.difference(&direction).unwrap();
        let of: [fn(&Outputs) -> f64; 2] = [|seen| seen.contact_force_z, |seen| seen.contact_moment_y];
        for of in of {
            let ends = [-1.0, 1.0].map(|sign| {
                let mut inputs = inputs;
                *input(&mut inputs.drive) += sign * size;
                of(&start(&model, &inputs))
            });
            let (quotient, difference) = (found.quotient(of), (ends[1] - ends[0]) / (2.0 * size));
            println!("{name}: derivative {quotient:.5e}, difference {difference:.5e}");
            assert!((quotient / difference - 1.0).abs() < 1e-2);
        }
    }
}

#[test]
fn a_skew_slide_flashes_as_a_straight_one_of_the_same_speed() {
    let model = sideways(7, |config| {
        config.thermal.enabled = true;
        config.tuning.softening = 0.0;
    });
    let slide = 0.03;
    let rise = |direction: f64| {
        let (along, aside) = (slide * direction.cos(), slide * direction.sin());
        let inputs = moving(&model, along, aside, 0.0);
        let seen = run(&model, inputs, (1e-3, 40), |_, _| {});
        (seen[40].temperature_wheel_max - 293.0, seen[40].friction_power)
    };
    let [(straight, power), (skew, other)] = [0.0, 1.0].map(rise);
    figure_within(0.005, "sideways.flash", &[skew * power / (straight * other)]);
    println!("straight {straight:.2} K under {power:.0} W, skew {skew:.2} K under {other:.0} W");
    assert!((other / power - 1.0).abs() < 2e-2 && (skew * power / (straight * other) - 1.0).abs() < 1e-2);
}

/// The load falls to nothing within 20 ms, so that the wheel flies, and comes back within 10 ms: it bounces a few times.
#[test]
fn a_wheel_that_slips_sideways_flies_lands_and_bounces() {
    for lateral in [Lateral::Velocity, Lateral::Force] {
        let model = sideways(7, |config| config.tuning.tolerance = 2e-3);
        let mut inputs = Inputs::rolling(model.config());
        (inputs.lateral, inputs.drive.lateral_velocity) = (lateral, 0.05);
        let seen = run(&model, inputs, (1e-3, 120), |inputs, t| {
            let share = (1.0 - t / 0.02).max(0.0) + ((t - 0.05) / 0.01).clamp(0.0, 1.0);
            inputs.drive.load = 1e5 * share;
            inputs.drive.lateral_force = 5e3 * share;
        });
        let touches: Vec<_> = seen.iter().map(|outputs| outputs.contact_force_y > 0.0).collect();
        let landings = touches.windows(2).filter(|pair| !pair[0] && pair[1]).count();
        let (last, most) = (&seen[120], seen.iter().fold(0.0, |most: f64, it| most.max(it.contact_force_y)));
        println!("{lateral:?}: {landings} landings, {most:.3e} N at most, {:.3e} N at the end", last.contact_force_y);
        assert!((1..20).contains(&landings) && most > 1.5e5 && most < 4e5);
        assert!(seen.iter().all(|it| it.contact_force_z.abs() <= 0.5 * it.contact_force_y + 1e-6));
    }
}

#[test]
fn inputs_to_the_side_are_refused_where_the_contact_has_none() {
    let along = sideways(5, |config| config.contact.lateral = false);
    let refused = |change: &dyn Fn(&mut Inputs)| {
        let mut inputs = Inputs::rolling(along.config());
        change(&mut inputs);
        Simulation::new(along.clone(), &inputs).err().unwrap().to_string()
    };
    for (change, words) in [
        (
            &(|inputs: &mut Inputs| inputs.drive.lateral_velocity = 0.1) as &dyn Fn(&mut Inputs),
            "drive.lateral_velocity = 0.1",
        ),
        (&|inputs| inputs.drive.spin = 0.2, "drive.spin = 0.2"),
        (&|inputs| inputs.drive.contact_angle = 0.1, "drive.contact_angle = 0.1"),
        (&|inputs| inputs.lateral = Lateral::Force, "control.lateral = force"),
    ] {
        let text = refused(change);
        assert!(text.contains(words) && text.contains("set contact.lateral = true"), "{text}");
    }
}

#[test]
fn more_lateral_force_than_friction_carries_is_no_start() {
    let model = sideways(5, |_| {});
    let mut inputs = Inputs::rolling(model.config());
    (inputs.lateral, inputs.drive.lateral_force) = (Lateral::Force, 4e4);
    inputs.rotation = Rotation::Moment;
    let text = Simulation::new(model, &inputs).err().unwrap().to_string();
    assert!(text.contains("drive.lateral_force") && text.contains("4.000000e4 N"), "{text}");
}

/// A step that ends early, where the brake locks the wheel, leaves the lateral velocity on its way to the end of the whole step.
#[test]
fn a_step_that_ends_early_has_moved_aside_as_far_as_it_would_have_by_then() {
    let model = sideways(5, |config| config.tuning.max_step = 5e-4);
    let mut inputs = Inputs::rolling(model.config());
    (inputs.translation, inputs.drive.torque) = (Translation::Velocity, 2e4);
    let mut simulation =
        Simulation::new(model, &Inputs { drive: Drive { torque: 0.0, ..inputs.drive }, ..inputs }).unwrap();
    let h = 5e-3;
    for k in 1.. {
        let before = simulation.outputs().wheel_lateral_velocity;
        inputs.drive.lateral_velocity = 0.01 * f64::from(k);
        let reached = simulation.advance_to_event(&inputs, h).unwrap();
        let moved = simulation.outputs().wheel_lateral_velocity - before;
        assert!(
            (moved - reached / h * (inputs.drive.lateral_velocity - before)).abs() < 1e-12,
            "{moved} in {reached} s"
        );
        if reached < h {
            println!("ended after {reached:.2e} of {h} s, in the step {k}: {moved:.5} m/s aside");
            assert!(simulation.outputs().brake_locked && k > 1);
            return;
        }
        assert!(k < 100, "the wheel locks: {} rad/s", simulation.outputs().wheel_omega);
    }
}
