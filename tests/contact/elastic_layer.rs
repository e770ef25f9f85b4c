//! An elastic layer between wheel and rail (`contact.layer_flexibility`): closed forms of a layer alone, a contact with
//! lateral forces against one without, energy in every step, and what the layer does to a measured creep curve.

use crate::common::*;
use crate::half_planes::{FRICTION, HalfPlanes, NOMINAL, RADIUS, modulus};
use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;
use wheelrail::analytic::hertz_half_width;
use wheelrail::config::Config;
use wheelrail::simulation::{Inputs, Model, Outputs, Simulation};

/// Force over friction on a layer alone between rigid bodies under Hertz's pressure, for `k = ξa/(μ p₀ L)`: shear grows as
/// `k(1 − t)` from the leading edge on until it is that of friction.
fn brush(k: f64) -> f64 {
    let t = (k * k - 1.0) / (k * k + 1.0);
    let slips = 0.5 * (t * (1.0 - t * t).sqrt() + t.asin() + FRAC_PI_2);
    (0.5 * k * (1.0 - t) * (1.0 - t) + slips) / FRAC_PI_2
}

/// Half-planes, the layer between which is a hundred times as flexible as they are.
#[test]
fn half_planes_with_a_soft_layer_creep_as_a_brush_on_the_grid() {
    let a = hertz_half_width(NOMINAL, RADIUS, modulus());
    let peak = 2.0 * NOMINAL / (PI * a);
    let missed = |per_half_width: usize, k: f64| {
        let mut bodies = HalfPlanes::new(per_half_width);
        // Of half-planes `πaE*/2` would be the slope `dF/dξ`, of the layer it is `2a²/L`.
        bodies.layer.shear = 400.0 * a / (PI * modulus());
        let creepage = k * FRICTION * peak * bodies.layer.shear / a;
        let found = bodies.roll(NOMINAL, creepage, &bodies.start()).unwrap();
        -k.signum() * found.traction.resultant.travel / (FRICTION * NOMINAL) - brush(k.abs())
    };
    for k in [0.05, 0.3, 1.0, 3.0, -0.3] {
        let [coarse, fine] = [10, 40].map(|n| missed(n, k));
        figure("layer.brush", &[coarse, fine]);
        println!("k {k}: brush {:.4}, missed by {coarse:+.4} (a/10), {fine:+.4} (a/40)", brush(k.abs()));
        assert!(coarse.abs() < 0.03 && fine.abs() < 0.01, "{k}: {coarse}, {fine}");
    }
}

/// The railway wheel with a layer.
fn railway(layer: f64, change: impl Fn(&mut Config)) -> Arc<Model> {
    without_heat("railway", |config| {
        config.contact.layer_flexibility = layer;
        config.physics.yielding = false;
        change(config);
    })
}

fn start(model: &Arc<Model>, creepage: f64) -> Outputs {
    let mut inputs = prescribed(model, 20.0, creepage);
    inputs.drive.lateral_velocity = if model.config().contact.lateral { HARDLY } else { 0.0 };
    Simulation::new(model.clone(), &inputs).unwrap().outputs().clone()
}

#[test]
fn a_vanishing_layer_is_none_and_both_directions_agree() {
    for xi in [-5e-3, -1e-3, -2e-4, 5e-5, 5e-4, 2e-3] {
        let of = |layer: f64| start(&railway(layer, |_| {}), xi).contact_force_x / 3e4;
        let along = [0.0, 1e-17, 1e-14, 5e-14, 1.5e-13, 1e-12].map(of);
        println!("{xi:e}: {along:.5?}");
        assert!(along.windows(2).all(|pair| pair[1].abs() < pair[0].abs() + 1e-3), "a layer takes force away");
        assert!((along[1] - along[0]).abs() < 1e-3);
    }
    let ellipse = |lateral: bool| {
        let mut config = preset("railway_ellipse", 20);
        (config.contact.lateral, config.contact.layer_flexibility) = (lateral, 1.5e-13);
        (config.thermal.enabled, config.physics.yielding) = (false, false);
        model(config)
    };
    let (both, along) = (ellipse(true), ellipse(false));
    for xi in [-5e-3, -1e-3, 2e-4, 2e-3] {
        let [ours, theirs] = [&both, &along].map(|model| start(model, xi));
        let forces = [ours.contact_force_x, theirs.contact_force_x].map(|force| force / 3e4);
        println!("{xi:e}: {forces:.4?} of friction, {:.2} and {:.2} W", ours.friction_power, theirs.friction_power);
        figure("layer.sideways", &[forces[0] - forces[1], ours.friction_power / theirs.friction_power - 1.0]);
        assert!((forces[0] - forces[1]).abs() < 0.015);
        assert!((ours.friction_power / theirs.friction_power - 1.0).abs() < 0.05);
    }
}

/// Kalker's simplified theory, in which the bodies are a layer: `F = 8a²bξ/3L` in both directions under small creepages, and
/// `πa³bφ/4L` by spin.
#[test]
fn a_soft_layer_on_an_ellipse_has_the_forces_of_the_simplified_theory_in_both_directions() {
    let layer = 2e-11;
    let mut config = preset("railway_ellipse", 8);
    // The slope of the layer's displacement is of first order.
    config.mesh.grid_elements_per_half_width = 80;
    (config.contact.lateral, config.contact.layer_flexibility) = (true, layer);
    (config.thermal.enabled, config.initial.velocity, config.physics.yielding) = (false, 20.0, false);
    let model = model(config);
    let (creepage, spin) = (1e-3, 0.05);
    let of = |along: f64, across: f64, turn: f64| {
        let mut inputs = prescribed(&model, 20.0, along * creepage);
        (inputs.drive.lateral_velocity, inputs.drive.spin) = (across * creepage * 20.0, turn * spin);
        Simulation::new(model.clone(), &inputs).unwrap().outputs().clone()
    };
    let ellipse = model.config().hertz().under(1e5);
    let (a, b) = (ellipse.a, ellipse.b);
    let expected = 8.0 * a * a * b * creepage / (3.0 * layer);
    let free = of(0.0, 0.0, 0.0);
    let along = of(1.0, 0.0, 0.0).contact_force_x - free.contact_force_x;
    let across = of(0.0, 1.0, 0.0).contact_force_z - free.contact_force_z;
    let by_spin = of(0.0, 0.0, 1.0).contact_force_z - free.contact_force_z;
    let of_spin = PI * a.powi(3) * b * spin / (4.0 * layer);
    figure("layer.ellipse", &[-along / expected - 1.0]);
    figure("layer.ellipse", &[-across / expected - 1.0]);
    figure("layer.ellipse.spin", &[by_spin.abs() / of_spin - 1.0]);
    println!(
        "along {along:.1}, across {across:.1}, expected {expected:.1} N; by spin {by_spin:.2}, expected {of_spin:.2} N"
    );
    assert!((-along / expected - 1.0).abs() < 0.03 && (-across / expected - 1.0).abs() < 0.03);
    assert!((by_spin.abs() / of_spin - 1.0).abs() < 0.05);
}

/// The slope of the creep curve at its beginning: flexibilities of bodies and layer add up but for the shape of the shear.
#[test]
fn slopes_of_bodies_and_layer_add_up_as_springs_in_a_row() {
    let slope = |layer: f64| {
        let model = railway(layer, |_| {});
        let [more, less] = [1e-6, -1e-6].map(|xi| start(&model, xi).contact_force_x);
        (less - more) / 2e-6
    };
    let (bodies, layer) = (slope(0.0), 1.5e-13);
    let model = railway(0.0, |_| {});
    let a = start(&model, 0.0).contact_half_width;
    let alone = 2.0 * a * a * model.config().model.contact_width / layer;
    let (found, springs) = (slope(layer), 1.0 / (1.0 / bodies + 1.0 / alone));
    figure("layer.slope", &[found / springs - 1.0]);
    figure_within(0.02, "layer.steeper", &[bodies / found]);
    println!("bodies {bodies:.3e}, layer {alone:.3e}, both {found:.3e}, springs in a row {springs:.3e} N");
    assert!((found / springs - 1.0).abs() < 0.15 && found < 0.4 * bodies);
}

/// Energy that an observer outside misses over a run: work of the hub less friction, stored and kinetic energy.
fn missed(model: &Arc<Model>, step: f64, count: usize, change: impl Fn(&mut Inputs, f64)) -> (f64, Vec<Outputs>) {
    let seen = run(model, Inputs::rolling(model.config()), (step, count), change);
    (seen.iter().map(|outputs| outputs.energy_residual.abs()).fold(0.0, f64::max), seen)
}

#[test]
fn energy_is_kept_while_everything_varies_and_while_the_wheel_locks() {
    for step in [1e-3, 1e-4] {
        for layer in [0.0, 1.5e-13] {
            let model = railway(layer, |config| config.initial.velocity = 20.0);
            let count = (0.04 / step) as usize;
            let (varying, seen) = missed(&model, step, count, vary);
            let friction = seen[count].friction_energy;
            let (locking, locked) = missed(&model, step, count, |inputs, t| {
                inputs.drive.torque = 40e3 * (t / 0.02).min(1.0);
            });
            let omega = locked[count].wheel_omega;
            println!(
                "{layer:e} {step:e}: {varying:.1e}, friction {friction:.2} J; locking {locking:.1e}, {omega:.2} rad/s"
            );
            // Longer steps miss as much of clean bodies.
            let most = if step > 5e-4 { [4e-3, 1.2e-2] } else { [3e-3, 4e-3] };
            assert!(varying < most[0] && locking < most[1]);
        }
    }
}

#[test]
fn energy_is_kept_sideways_while_everything_varies() {
    let missed = |layer: f64, step: f64| {
        let mut config = preset("railway_ellipse", 8);
        (config.contact.lateral, config.contact.layer_flexibility) = (true, layer);
        (config.thermal.enabled, config.initial.velocity, config.physics.yielding) = (false, 20.0, false);
        let model = model(config);
        let (missed, seen) = missed(&model, step, (0.04 / step) as usize, |inputs, t| {
            vary(inputs, t);
            inputs.drive.lateral_velocity = 0.02 * (250.0 * t).sin();
            inputs.drive.spin = 0.1 * (150.0 * t).sin();
        });
        let last = seen.last().unwrap();
        println!(
            "{layer:e}, {step:e} s: {missed:.1e}, friction {:.2} J, F_z {:.0} N",
            last.friction_energy, last.contact_force_z
        );
        missed
    };
    for step in [1e-3, 1e-4] {
        let [clean, layered] = [0.0, 1.5e-13].map(|layer| missed(layer, step));
        assert!(layered < 2.0 * clean + 1e-3, "{layered} and {clean}");
    }
}
