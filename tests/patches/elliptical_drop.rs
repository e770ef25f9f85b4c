//! A wheel that is dropped on the rail and touches it in an ellipse, against Hertz's law of impact.

use crate::common::*;
use std::sync::Arc;
use wheelrail::config::{Config, Damping};
use wheelrail::simulation::{Inputs, Model, Simulation, Vertical};

/// Elastic bodies without heat, friction or damping.
fn elastic(lines: usize, elements: usize, hub_mass: f64) -> Config {
    let mut config = preset("railway_ellipse", elements);
    config.contact.lines = lines;
    (config.thermal.enabled, config.physics.yielding, config.damping) = (false, false, Damping::NONE);
    (config.wheel.hub_mass, config.vehicle.damping) = (hub_mass, 0.0);
    config
}

/// Frictionless wheel at rest.
fn at_rest(model: &Model, load: f64) -> Inputs {
    let mut inputs = prescribed(model, 0.0, 0.0);
    (inputs.drive.friction, inputs.drive.load) = (0.0, load);
    inputs
}

/// A wheel that has been held `height` \[m] above the rail and is let loose under a load \[N].
fn dropped(model: &Arc<Model>, height: f64, load: f64) -> (Simulation, Inputs) {
    let mut inputs = at_rest(model, load);
    (inputs.vertical, inputs.drive.displacement) = (Vertical::Displacement, height);
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    (0..3).for_each(|_| simulation.advance(&inputs, 1e-4).unwrap());
    inputs.vertical = Vertical::Force;
    (simulation, inputs)
}

/// The largest force \[N] and approach \[m] by the balance of energy: the load falls by the height and the approach,
/// and the contact stores `⅖ N δ` where `N = k δ^{3/2}`, a spring in series with it `½ c N²`.
fn by_energy(model: &Model, spring: f64, height: f64, load: f64) -> [f64; 2] {
    let hertz = model.config().hertz();
    let missing = |force: f64| {
        let approach = hertz.under(force).approach;
        let stored = 0.4 * force * approach + 0.5 * spring * force * force;
        load * (height + approach + spring * force) - stored
    };
    // Above the load, where the force is largest, the balance changes its sign once.
    let (mut low, mut high) = (load, 100.0 * load);
    for _ in 0..80 {
        let middle = 0.5 * (low + high);
        *(if missing(middle) > 0.0 { &mut low } else { &mut high }) = middle;
    }
    [low, hertz.under(low).approach + spring * low]
}

/// A hub of 20 t, beside which the deformation carries no momentum worth mentioning. Bodies of the structural width are
/// a linear spring in series with the contact, whose compliance is that at rest, 3.67e-10 m/N from 10 to 190 kN.
/// Measured: force and approach to 6e-4 and 4e-4, energy 1.4e-4 of what the load does, momentum 1.4e-5 of the impulse.
#[test]
fn a_dropped_wheel_strikes_as_hertz_says_and_comes_back() {
    for (lines, elements, step) in [(7, 10, 1e-4), (7, 10, 2.5e-5), (5, 20, 1e-4)] {
        let model = model(elastic(lines, elements, 2e4));
        let hertz = model.config().hertz();
        let [light, spring] = [2e4, 1.9e5].map(|load| {
            let start = Simulation::new(model.clone(), &at_rest(&model, load)).unwrap();
            (start.outputs().contact_approach - hertz.under(load).approach) / load
        });
        assert!((light / spring - 1.0).abs() < 0.01, "{light:e} {spring:e} m/N");
        for height in [1e-6, 1e-5, 5e-5] {
            let load = 2e4;
            let (mut simulation, inputs) = dropped(&model, height, load);
            let (mut found, mut impulse, mut time, mut struck) = ([0.0_f64; 2], 0.0, 0.0, false);
            let mut missing = 0.0_f64;
            while !struck || simulation.outputs().contact_force_max > 0.0 {
                simulation.advance(&inputs, step).unwrap();
                let o = simulation.outputs();
                found = [found[0].max(o.contact_force_max), found[1].max(o.contact_approach)];
                (impulse, time) = (impulse + o.contact_impulse, time + step);
                struck |= o.contact_force_max > 0.0;
                let balance = o.hub_work - o.stored_energy - o.damping_energy - o.friction_energy;
                missing = missing.max(balance.abs() / (load * (height + found[1])));
                assert!(time < 0.2, "no bounce");
            }
            let expected = by_energy(&model, spring, height, load);
            let [force, approach] = [0, 1].map(|k| found[k] / expected[k] - 1.0);
            let o = simulation.outputs();
            let momentum = (impulse - load * time - o.wheel_mass * o.hub_vertical_velocity) / impulse;
            figure("ellipse.drop", &[force, approach]);
            println!(
                "{lines} lines, {elements} elements, {step:e} s, from {height:e} m: {:.0} N ({force:+.1e}), {:.2} µm \
                 ({approach:+.1e}), energy {missing:.1e}, momentum {momentum:+.1e}, spring {spring:.3e} m/N",
                found[0],
                1e6 * found[1],
            );
            assert!(force.abs() < 1e-3 && approach.abs() < 1e-3, "{found:?} {expected:?}");
            assert!(missing < 5e-4 && momentum.abs() < 5e-5, "{missing} {momentum}");
        }
    }
}

/// Impulse of the rail: that of the load, less what the damper of the vehicle has taken on the way: from rest to
/// rest over some bounces. Measured: 1e-7 of the impulse.
#[test]
fn a_wheel_that_bounces_until_it_rests_has_lost_no_momentum() {
    for step in [1e-3_f64, 2e-4] {
        let mut config = elastic(5, 6, 277.0);
        (config.vehicle.damping, config.damping) = (1e5, Damping::default());
        let model = model(config);
        let (mut simulation, inputs) = dropped(&model, 1e-4, 1e5);
        let height = simulation.outputs().hub_height;
        let (mut impulse, mut largest, count) = (0.0, 0.0_f64, (0.6 / step).round());
        for _ in 0..count as usize {
            simulation.advance(&inputs, step).unwrap();
            impulse += simulation.outputs().contact_impulse;
            largest = largest.max(simulation.outputs().contact_force_max);
        }
        let o = simulation.outputs();
        let taken = 1e5 * step * count + 1e5 * (o.hub_height - height);
        let (lost, air, left) = (impulse / taken - 1.0, 1e3 * o.contact_lost_time, o.hub_vertical_velocity);
        figure("ellipse.rest", &[lost]);
        println!("{step} s: {lost:.1e} of {taken:.3} N s; {largest:.0} N, {air:.2} ms in the air, {left:.1e} m/s");
        assert!(lost.abs() < 5e-7 && largest > 2e5 && air > 1.0, "{lost} {largest} {air}");
        assert!(left.abs() < 1e-12 && (o.contact_force_y / 1e5 - 1.0).abs() < 1e-9);
    }
}

/// Forces and moments that jump have their exact impulse, as with one line: momentum of vehicle and wheel, and angular
/// momentum of the wheel, which the resistance of the contact to rolling has a part in.
#[test]
fn momentum_is_the_impulse_of_forces_that_jump() {
    let mut config = elastic(3, 6, 277.0);
    config.damping = Damping::default();
    let model = model(config);
    for step in [1e-3_f64, 5e-3, 2e-2] {
        let mut inputs = Inputs::rolling(model.config());
        inputs.drive.friction = 0.0;
        let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
        let start = simulation.outputs().clone();
        let (mut total, mut most, mut resistance) = (0.0, 0.0_f64, 0.0);
        for k in 0..(1.4 / step).round() as usize {
            let share = [0.0, 1.0, 0.01, -0.7, -0.68].get((k as f64 * step / 0.08 + 1e-9) as usize).unwrap_or(&0.0);
            (inputs.drive.force, inputs.drive.moment) = (2e4 * share, -5e3 * share);
            simulation.advance(&inputs, step).unwrap();
            resistance += step * simulation.outputs().contact_moment;
            total += step * share;
            most = most.max(total.abs());
        }
        let (end, config) = (simulation.outputs(), model.config());
        let mass = end.wheel_mass + config.vehicle.mass;
        let moved = mass * (end.wheel_velocity - start.wheel_velocity) / 2e4 - total;
        let turned = (end.wheel_inertia * (end.wheel_omega - start.wheel_omega) - resistance) / -5e3 - total;
        round_off("ellipse.jumps", &[(moved / most).abs().max((turned / most).abs())], 1e-10);
        println!("steps of {step} s: {:.1e}, {:.1e} of the largest impulse", moved / most, turned / most);
        assert!(moved.abs() < 1e-9 * most && turned.abs() < 3e-8 * most);
    }
}
