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
    let frequency =
        std::f64::consts::PI * (crossings.len() - 1) as f64 / (crossings[crossings.len() - 1] - crossings[0]);
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

/// Polach's law on a dry rail, slip and heat of a dry-braked wheel.
fn polach(response_heat: bool) -> Arc<Model> {
    let mut config = preset("railway_dry", 8);
    config.thermal.enabled = response_heat;
    model(config)
}

/// Advances in steps of `h`, and checks after each that coefficient and slip belong together.
fn drive(simulation: &mut Simulation, inputs: &Inputs, h: f64, steps: usize) {
    let tuning = simulation.tuning().clone();
    for _ in 0..steps {
        simulation.advance(inputs, h).unwrap();
        let o = simulation.outputs();
        let falling = (1.0 - tuning.falling_ratio) * (-tuning.falling_decay * o.contact_tread_slip.abs()).exp();
        let law = inputs.drive.friction * (tuning.falling_ratio + falling);
        assert!((o.friction / law - 1.0).abs() < 1e-9, "{} for {law} at {} s", o.friction, simulation.time());
        assert!(o.contact_utilisation < 1.0 + 1e-9);
    }
}

#[test]
fn lock_up_breaking_loose_reversal_and_standstill_find_their_coefficient_at_every_step_size() {
    let model = polach(false);
    for (h, load) in [(5e-3, 1.0), (1e-3, 1.0), (1e-4, 1.0), (1e-3, 0.1), (1e-3, 1.9)] {
        let steps = |time: f64| (time / h).round() as usize;
        let mut inputs = prescribed(&model, 8.0, 0.0);
        inputs.drive.load *= load;
        let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
        // Locked within 20 ms, held, released to the grip of the rail, spun backwards, braked to a stop.
        inputs.drive.omega = 0.0;
        drive(&mut simulation, &inputs, h, steps(0.05));
        assert_eq!(simulation.outputs().contact_stick_fraction, 0.0);
        inputs.rotation = Rotation::Moment;
        drive(&mut simulation, &inputs, h, steps(0.15));
        inputs.rotation = Rotation::Velocity;
        inputs.drive.omega = -5.0;
        drive(&mut simulation, &inputs, h, steps(0.05));
        (inputs.drive.omega, inputs.drive.velocity) = (0.0, 0.0);
        drive(&mut simulation, &inputs, h, steps(0.1));
        let o = simulation.outputs();
        println!(
            "h {h:.0e} s, load {load}: at rest slip {:+.2e} m/s, friction {:.4}",
            o.contact_tread_slip, o.friction
        );
        assert!(o.contact_tread_slip.abs() < 0.1 && o.friction > 0.5, "{}", o.contact_tread_slip);
    }
}

#[test]
fn a_law_that_slip_does_not_change_costs_no_iteration() {
    let iterations = |ratio: f64, decay: f64| {
        let model = polach(false);
        let tuning = Tuning { falling_ratio: ratio, falling_decay: decay, ..model.config().tuning.clone() };
        let mut inputs = prescribed(&model, 20.0, 0.0);
        let mut simulation = Simulation::start(model, tuning, &inputs).unwrap();
        (0..100u32)
            .map(|k| {
                inputs.drive.omega = 20.0 / 0.46 * (1.0 - 1e-5 * f64::from(k));
                simulation.advance(&inputs, 1e-3).unwrap();
                simulation.outputs().iterations
            })
            .sum::<u64>()
    };
    let [constant, idle] = [iterations(1.0, 0.0), iterations(1.0, 5.0)];
    println!("{constant} iterations");
    assert_eq!(constant, idle);
}

#[test]
fn a_remembering_contact_follows_the_law_over_the_sliding_distance() {
    let model = polach(false);
    let length = 0.2;
    let tuning = Tuning { memory_length: length, ..model.config().tuning.clone() };
    let mut inputs = prescribed(&model, 10.0, 0.0);
    inputs.drive.omega = 9.0 / 0.46;
    let mut simulation = Simulation::start(model, tuning.clone(), &inputs).unwrap();
    let (slip, start) = (simulation.outputs().contact_tread_slip, simulation.outputs().friction);
    // The rail turns dirty at once, the contact over a distance.
    let fresh = inputs.drive.friction;
    inputs.drive.friction = 0.5 * fresh;
    let h = 1e-3;
    for k in 1..=400 {
        simulation.advance(&inputs, h).unwrap();
        let o = simulation.outputs();
        let law =
            0.5 * fresh * (tuning.falling_ratio + (1.0 - tuning.falling_ratio) * (-tuning.falling_decay * slip).exp());
        let expected = law + (start - law) * (-slip * f64::from(k) * h / length).exp();
        // The slip rings a little while the force falls.
        assert!((o.friction / expected - 1.0).abs() < 0.02, "{} for {expected} after {k} ms", o.friction);
    }
    let o = simulation.outputs();
    println!("friction {start:.4} to {:.4} over {:.2} m", o.friction, slip * 0.4);
}

#[test]
fn a_state_with_a_memory_of_friction_continues_bit_for_bit() {
    let model = polach(true);
    let tuning = Tuning { memory_length: 0.01, ..model.config().tuning.clone() };
    let mut inputs = Inputs::rolling(model.config());
    inputs.drive.moment = -30e3;
    let mut simulation = Simulation::start(model.clone(), tuning.clone(), &inputs).unwrap();
    for _ in 0..30 {
        simulation.advance(&inputs, 1e-3).unwrap();
    }
    let kept = simulation.checkpoint().clone();
    let mut other = Simulation::resume(model, tuning, kept.clone()).unwrap();
    for _ in 0..20 {
        simulation.advance(&inputs, 1e-3).unwrap();
        other.advance(&inputs, 1e-3).unwrap();
    }
    assert_eq!(simulation.checkpoint(), other.checkpoint());
    assert!(simulation.state() != &kept.state);
}

#[test]
fn derivatives_see_the_friction_that_falls() {
    let model = polach(false);
    let mut inputs = prescribed(&model, 10.0, 0.0);
    inputs.drive.omega = 9.0 / 0.46;
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    for _ in 0..300 {
        simulation.advance(&inputs, 1e-3).unwrap();
    }
    let direction = wheelrail::simulation::Drive { velocity: 1.0, ..Default::default() };
    let slope = simulation.difference(&direction).unwrap().quotient(|o| o.friction);
    // Once more with other ends.
    let again = |by: f64| {
        let tuning = simulation.tuning().clone();
        let wheelrail::rolling::sensitivity::Origin::Step { state, inputs, length } = &simulation.checkpoint().origin
        else {
            panic!("a step")
        };
        let mut inputs = *inputs;
        inputs.drive.velocity += by;
        let checkpoint =
            wheelrail::simulation::Checkpoint { state: (**state).clone(), ..simulation.checkpoint().clone() };
        let mut repeated = Simulation::resume(model.clone(), tuning, checkpoint).unwrap();
        repeated.advance(&inputs, *length).unwrap();
        repeated.outputs().friction
    };
    let quotient = (again(1e-4) - again(-1e-4)) / 2e-4;
    println!("d mu/dV = {slope:e} and {quotient:e} s/m");
    assert!(slope < 0.0 && (slope / quotient - 1.0).abs() < 1e-4);
}
