//! Momentum: held, ramped and jumping forces have their exact impulse, whatever the step.

use crate::common::{self, model, preset};
use std::f64::consts::PI;
use std::sync::Arc;
use wheelrail::config::Config;
use wheelrail::simulation::{Drive, Inputs, Model, Simulation};

/// Share of the largest force over time.
type Course = fn(f64) -> f64;

fn frictionless(change: impl Fn(&mut Config)) -> Arc<Model> {
    let mut config = preset("railway", 6);
    (config.solver.modes_wheel, config.solver.modes_rail) = (20, 10);
    config.thermal.enabled = false;
    config.friction.coefficient = 0.0;
    change(&mut config);
    model(config)
}

/// Mass moving in x and moment of inertia of the whole wheel [kg, kg m²].
fn inertia(config: &Config) -> [f64; 2] {
    let (r, i) = (config.wheel.radius, config.wheel.hub_radius);
    let surface = PI * config.material.density * config.model.contact_width;
    let mass = surface * (r * r - i * i) + config.wheel.hub_mass + config.vehicle.mass;
    [mass, 0.5 * surface * (r.powi(4) - i.powi(4)) + config.wheel.hub_inertia]
}

/// Momentum and angular momentum less the impulses of force and moment, relative to the largest of these, a second
/// after they have ended: until then the deformation has momentum of its own. The contact resists rolling with some mN
/// m, whose impulse is summed up here with the values at the ends of the steps: that limits what is seen of the angular
/// momentum. `held`: values hold during a step, otherwise they follow their course with its rate.
fn lost(model: &Arc<Model>, step: f64, held: bool, course: Course) -> [f64; 2] {
    const END: f64 = 0.4;
    let mut inputs = Inputs::rolling(model.config());
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    let start = simulation.outputs().clone();
    let (mut total, mut most, mut resistance) = (0.0, 0.0f64, 0.0);
    let steps = ((END + 1.0) / step).round() as usize;
    for k in 0..steps {
        let at = |k: usize| if k as f64 * step < END - 1e-9 { course(k as f64 * step) } else { 0.0 };
        let (now, next) = (at(k), at(k + 1));
        let [force, moment] = [2e4, -5e3].map(|size| size * now);
        inputs.drive = Drive { force, moment, ..inputs.drive };
        if !held {
            let slope = (next - now) / step;
            inputs.rate = Drive { force: 2e4 * slope, moment: -5e3 * slope, ..inputs.rate };
        }
        simulation.advance(&inputs, step).unwrap();
        resistance += step * simulation.outputs().contact_moment;
        total += step * if held { now } else { 0.5 * (now + next) };
        most = most.max(total.abs());
    }
    let (end, [mass, moment]) = (simulation.outputs(), inertia(model.config()));
    [
        (mass * (end.wheel_velocity - start.wheel_velocity) / 2e4 - total) / most,
        ((moment * (end.wheel_omega - start.wheel_omega) - resistance) / -5e3 - total) / most,
    ]
}

#[test]
fn momentum_is_the_impulse_of_ramps_and_jumps_of_every_size_at_every_step() {
    let ramp: Course = |t| (t / 0.3).min(1.0);
    let jumps: Course = |t| [0.0, 1.0, 0.01, -0.7, -0.68][(t / 0.08) as usize];
    let waves: Course = |t| (15.0 * t).sin();
    let model = frictionless(|_| {});
    for step in [1e-4, 1e-3, 5e-3, 2e-2] {
        for (course, held) in [(ramp, true), (ramp, false), (jumps, true), (waves, true), (waves, false)] {
            let lost = lost(&model, step, held, course);
            common::figure("impulse", &lost);
            println!("{} ms, held {held}: {lost:?}", step * 1e3);
            assert!(lost[0].abs() < 1e-9 && lost[1].abs() < 3e-8, "step {step} s: {lost:?}");
        }
    }
}
