//! Friction that depends on the slip of the tread: what it excites, and that it is found at every size of step.

mod common;

use common::*;
use std::sync::Arc;
use wheelrail::analytic::{Torsion, hub_torsion};
use wheelrail::config::{Config, Tuning};
use wheelrail::simulation::{Inputs, Model, Rotation, Simulation};

/// Friction coefficient on the rail [1].
const FRICTION: f64 = 0.4;
/// Slip velocity of the sliding wheel [m/s].
const SLIP: f64 = 0.1;
/// Share of the coefficient that remains at high slip.
const RATIO: f64 = 0.4;

/// The wheel of Paper D without heat, on a hub so heavy that the torsion meets it at rest.
fn heavy_hub() -> Arc<Model> {
    let mut config = preset("paper_d", 8);
    config.thermal.enabled = false;
    config.wheel.hub_inertia = 1e6;
    config.initial.velocity = 2.0;
    model(config)
}

fn torsion(config: &Config) -> Torsion {
    let material = &config.material;
    let shear = 0.5 * material.youngs_modulus / (1.0 + material.poissons_ratio);
    hub_torsion(config.wheel.radius, config.wheel.hub_radius, (shear / material.density).sqrt())
}

/// The law `μ₀ (A + (1 − A) e^{−B s})` with the slope `slope` [s/m] at [`SLIP`]; beyond the range of the interface it may
/// rise.
fn law_of_slope(config: &Config, slope: f64) -> Tuning {
    // At s no such law is steeper than that with B = 1/s.
    let ratio = if slope > 0.0 { 2.0 - RATIO } else { RATIO };
    let steep = |decay: f64| FRICTION * (ratio - 1.0) * decay * (-decay * SLIP).exp();
    let (mut low, mut high) = (0.0, 1.0 / SLIP);
    assert!(steep(high).abs() > slope.abs(), "{slope} is out of reach");
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if steep(middle).abs() < slope.abs() { low = middle } else { high = middle }
    }
    Tuning { falling_ratio: ratio, falling_decay: low, softening: 0.0, ..config.tuning.clone() }
}

/// A wheel that slides steadily under a moment, and its inputs.
fn sliding(model: &Arc<Model>, tuning: &Tuning) -> (Simulation, Inputs) {
    let config = model.config();
    let v = config.initial.velocity;
    let mut inputs = prescribed(model, v, 0.0);
    inputs.drive.friction = FRICTION;
    inputs.drive.omega = (v - SLIP) / config.wheel.radius;
    let held = Simulation::start(model.clone(), tuning.clone(), &inputs).unwrap();
    inputs.rotation = Rotation::Moment;
    inputs.drive.moment = held.outputs().hub_moment;
    (held, inputs)
}

/// Growth rate [1/s] and frequency [rad/s] of an oscillation, from the amplitudes of its half-waves.
fn growth(values: &[f64], h: f64) -> (f64, f64) {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let mut crossings = Vec::new();
    for (k, pair) in values.windows(2).enumerate() {
        let (a, b) = (pair[0] - mean, pair[1] - mean);
        if a * b < 0.0 {
            crossings.push((k as f64 + a / (a - b)) * h);
        }
    }
    // Energy between every second crossing: whole periods.
    let mut points = Vec::new();
    for period in crossings.windows(3).step_by(2) {
        let inside = |k: &usize| (*k as f64 * h) >= period[0] && (*k as f64 * h) < period[2];
        let square: f64 = (0..values.len()).filter(inside).map(|k| (values[k] - mean).powi(2)).sum::<f64>() * h;
        points.push((0.5 * (period[0] + period[2]), 0.5 * (square / (period[2] - period[0])).ln()));
    }
    let frequency = std::f64::consts::PI * (crossings.len() - 1) as f64 / (crossings[crossings.len() - 1] - crossings[0]);
    let n = points.len() as f64;
    let (x, y) = points.iter().fold((0.0, 0.0), |(x, y), p| (x + p.0 / n, y + p.1 / n));
    let (xy, xx) = points.iter().fold((0.0, 0.0), |(xy, xx), p| (xy + (p.0 - x) * (p.1 - y), xx + (p.0 - x).powi(2)));
    (xy / xx, frequency)
}

/// Slip of the tread of the sliding wheel, after a short dip of the friction available, in steps of `h`.
fn rings(model: &Arc<Model>, tuning: &Tuning, h: f64, time: f64) -> Vec<f64> {
    let (mut simulation, inputs) = sliding(model, tuning);
    let quarter = 0.25 * 2.0 * std::f64::consts::PI / torsion(model.config()).frequency;
    let mut slips = Vec::new();
    for k in 0..(time / h).round() as usize {
        let mut now = inputs;
        now.drive.friction *= if (k as f64) * h < quarter { 0.99 } else { 1.0 };
        simulation.advance(&now, h).unwrap();
        if k as f64 * h > 8.0 * quarter {
            slips.push(simulation.outputs().contact_tread_slip);
        }
    }
    slips
}

/// Growth rate [1/s] and frequency [rad/s] of the torsion for friction of this slope, and the rate in closed form: a force
/// `−μ(s) P` at the rim on the modal mass `m = ρ · rim_area` gives `q̈ + (P μ′/m) q̇ + ω² q = 0`.
fn grown(model: &Arc<Model>, slope: f64, h: f64) -> [f64; 3] {
    let config = model.config();
    let mass = config.material.density * torsion(config).rim_area * config.model.contact_width;
    let (rate, frequency) = growth(&rings(model, &law_of_slope(config, slope), h, 0.15), h);
    let expected = -0.5 * config.model.nominal_load * slope / mass;
    println!("h {h:.0e}, slope {slope:+.2} s/m: rate {rate:+.4} 1/s, closed form {expected:+.4}, {frequency:.1} rad/s");
    [rate, frequency, expected]
}

#[test]
fn falling_friction_excites_the_torsion_at_half_its_slope_over_the_mass_and_rising_friction_damps_it() {
    let model = heavy_hub();
    let exact = torsion(model.config()).frequency;
    assert!((exact / 1777.3 - 1.0).abs() < 1e-3, "{exact}");
    for h in [2e-5, 1e-5] {
        // Constant friction neither damps nor excites; what is left is the energy that streams out with the rail, and the
        // damping of the time formula.
        let [constant, ..] = grown(&model, 0.0, h);
        assert!(constant < 0.0 && constant > -0.1, "{constant}");
        for slope in [-0.2, -0.4, -0.8, 0.4] {
            let [rate, frequency, expected] = grown(&model, slope, h);
            assert!(rate.signum() == -slope.signum(), "{rate}");
            assert!((rate / expected - 1.0).abs() < 0.05, "{rate} for {expected}");
            assert!((frequency / exact - 1.0).abs() < 0.01, "{frequency} for {exact}");
        }
    }
}
