//! A wheel rolls over waves, without friction: the contact filters them, and the wheel swings on the contact.
//!
//! Closed form (`docs/theory/profiles.md`): waves of amplitude A and length λ act with `A J₀(2πa/λ)`, the mean over the
//! Hertzian patch of half-width a, and a mass m on the contact spring K, which a damper c holds, answers with the force
//! `K |i ω c − m ω²|/|K + i ω c − m ω²|` per displacement, `K = m ω₀²`.

use crate::common::{self, KMH, model, prescribed, preset};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;
use wheelrail::analytic::hertz_half_width;
use wheelrail::config::Config;
use wheelrail::material::Isotropic;
use wheelrail::mechanics::BodyParameters;
use wheelrail::simulation::{Inputs, Model, Simulation};

/// Contact resonance of the wheel of Paper A, from an independent eigenvalue analysis [rad/s].
const RESONANCE: f64 = 2922.0;
/// Damping ratio of that resonance in Paper A, here by a damper between hub and vehicle.
const RATIO: f64 = 0.5 * 1e-4 * RESONANCE;

/// The wheel of Paper A without friction and heat, on waves of the rail or of the wheel [m].
fn waved(elements: usize, body: &str, amplitude: f64, length: f64, ratio: f64) -> Arc<Model> {
    let mut config = preset("paper_a", elements);
    config.thermal.enabled = false;
    config.vehicle.damping = 2.0 * ratio * RESONANCE * mass(&config);
    config.tuning.tolerance = 0.0;
    let waves = format!("sinusoid(amplitude = {amplitude:?}, wavelength = {length:?})");
    *(if body == "rail" { &mut config.rail.profile } else { &mut config.wheel.profile }) = waves;
    model(config)
}

fn inputs(model: &Model, velocity: f64) -> Inputs {
    let mut inputs = prescribed(model, velocity, 0.0);
    inputs.drive.friction = 0.0;
    inputs
}

/// Half-width of the patch [m].
fn half_width(config: &Config) -> f64 {
    hertz_half_width(
        config.model.nominal_load,
        config.wheel.radius,
        Isotropic::from(&config.material).contact_modulus(),
    )
}

/// `J₀(z)` by its integral.
fn bessel(z: f64) -> f64 {
    let n = 200;
    (0..n).map(|k| (z * (PI * (f64::from(k) + 0.5) / f64::from(n)).sin()).cos()).sum::<f64>() / f64::from(n)
}

/// Mass of the wheel [kg].
fn mass(config: &Config) -> f64 {
    BodyParameters::from(config).wheel_mass() * config.model.contact_width
}

/// Force per displacement of the mass on the contact spring [N/m].
fn answer(config: &Config, omega: f64) -> f64 {
    let (k, m) = (mass(config) * RESONANCE * RESONANCE, mass(config) * omega * omega);
    let damper = omega * config.vehicle.damping;
    k * m.hypot(damper) / (k - m).hypot(damper)
}

/// Amplitude of the contact force at the frequency with which waves pass, after the start has died away [N].
fn amplitude(model: &Arc<Model>, velocity: f64, length: f64) -> f64 {
    let (steps, settling, waves) = (80, 0.03, 4);
    let inputs = inputs(model, velocity);
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    let period = length / velocity;
    for _ in 0..(settling / period).ceil() as usize * steps {
        simulation.advance(&inputs, period / steps as f64).unwrap();
    }
    let mut sum = [0.0; 2];
    for k in 0..waves * steps {
        simulation.advance(&inputs, period / steps as f64).unwrap();
        let (sin, cos) = (TAU * k as f64 / steps as f64).sin_cos();
        let force = simulation.outputs().contact_force_y;
        sum = [sum[0] + force * cos, sum[1] + force * sin];
    }
    2.0 * sum[0].hypot(sum[1]) / (waves * steps) as f64
}

#[test]
fn forces_over_waves_are_those_of_the_filtered_wave_on_the_contact_spring() {
    let (size, length) = (5e-6, 0.05);
    let model = waved(10, "rail", size, length, RATIO);
    let config = model.config();
    let filter = bessel(TAU * half_width(config) / length);
    for (speed, tolerance) in [(50.0, 0.03), (75.0, 0.03), (85.7, 0.03), (100.0, 0.03), (150.0, 0.1)] {
        let velocity = speed * KMH;
        let found = amplitude(&model, velocity, length);
        let expected = size * filter * answer(config, TAU * velocity / length);
        common::figure(if speed < 150.0 { "waves.force" } else { "waves.force.fast" }, &[found / expected - 1.0]);
        println!("{speed} km/h: {:.4} MN, closed form {:.4} MN", 1e-6 * found, 1e-6 * expected);
        assert!((found / expected - 1.0).abs() < tolerance, "{found} {expected}");
    }
    // The peak, from a parabola through three forces.
    let [low, top, high] = [83.0, 86.0, 89.0].map(|speed| amplitude(&model, speed * KMH, length));
    let at = 86.0 + 1.5 * (low - high) / (low - 2.0 * top + high);
    let omega = TAU * at * KMH / length;
    common::figure_within(1e-3, "waves.peak [rad/s]", &[omega]);
    println!("peak at {omega:.0} rad/s");
    assert!((omega / 2992.0 - 1.0).abs() < 0.01, "{omega}");
}

#[test]
fn the_patch_evens_out_the_first_null_of_its_filter_and_small_waves_act_in_proportion() {
    let length = 2.613 * half_width(waved(20, "rail", 1e-6, 0.05, RATIO).config());
    let model = waved(20, "rail", 0.5e-6, length, RATIO);
    let velocity = 25.0 * KMH;
    let left = amplitude(&model, velocity, length) / (0.5e-6 * answer(model.config(), TAU * velocity / length));
    common::figure("waves.null", &[left]);
    println!("at the null {left:.4} of the wave is left");
    assert!(left < 0.03, "{left}");
    let slope = |size: f64| amplitude(&waved(10, "rail", size, 0.05, RATIO), 50.0 * KMH, 0.05) / size;
    let ratio = slope(5e-6) / slope(1e-6);
    common::figure_within(2e-3, "waves.proportion", &[ratio]);
    common::figure_within(0.01, "waves.five", &[ratio - 1.0]);
    println!("5 um act {ratio:.4} times as much in proportion as 1 um");
    assert!((ratio - 1.0).abs() < 0.02);
}

/// The hub drives the wheel up the waves and is driven down again: without damping nothing is lost, and waves of the
/// wheel take a moment where waves of the rail take a force.
#[test]
fn what_the_hub_does_on_waves_is_stored_and_given_back() {
    let radius = preset("paper_a", 10).wheel.radius;
    let (length, velocity, steps) = (TAU * radius / 58.0, 10.0, 100);
    let mut worst = Vec::new();
    for body in ["rail", "wheel"] {
        let model = waved(10, body, 5e-6, length, 0.0);
        let inputs = inputs(&model, velocity);
        let mut simulation = Simulation::new(model, &inputs).unwrap();
        let (mut lost, mut moved, mut drive) = (0.0f64, 0.0f64, [0.0f64; 2]);
        for _ in 0..4 * steps {
            simulation.advance(&inputs, length / velocity / steps as f64).unwrap();
            let outputs = simulation.outputs();
            lost = lost.max((outputs.hub_work - outputs.stored_energy).abs());
            moved = moved.max(outputs.stored_energy.abs());
            drive = [drive[0].max(outputs.contact_force_x.abs()), drive[1].max(outputs.contact_moment.abs() / radius)];
        }
        common::figure("waves.undamped", &[lost / moved]);
        println!("{body}: {lost:.4} J of {moved:.3} J are lost, force and moment over radius up to {drive:.0?} N");
        assert!(lost < 0.02 * moved, "{lost} {moved}");
        let idle = if body == "rail" { drive[1] } else { drive[0] };
        assert!(idle < 0.02 * drive[0].max(drive[1]), "{drive:?}");
        worst.push(lost);
    }
    assert!((worst[0] / worst[1] - 1.0).abs() < 0.1, "{worst:?}");
}
