//! Vibrations of the whole model die away as damping says, standing and rolling.

use crate::common::*;
use std::f64::consts::TAU;
use std::sync::Arc;
use wheelrail::analytic::hub_torsion;
use wheelrail::config::{Config, Damping};
use wheelrail::material::Isotropic;
use wheelrail::mechanics::{Basis, BodyDamping, BodyParameters};
use wheelrail::rolling::State;
use wheelrail::simulation::{Inputs, Model, Outputs, Rotation, Simulation};

/// Frictionless wheel under the nominal load.
fn frictionless(model: &Model, velocity: f64) -> Inputs {
    let mut inputs = prescribed(model, velocity, 0.0);
    inputs.drive.friction = 0.0;
    inputs
}

/// Damping ratio from the swings, first to last, between successive extremes of a decaying vibration.
fn ratio(signal: &[f64]) -> f64 {
    let mut extremes = Vec::new();
    for w in signal.windows(3) {
        let (left, right) = (w[1] - w[0], w[1] - w[2]);
        if left * right > 0.0 {
            // Vertex of the parabola.
            extremes.push(w[1] + (left - right).powi(2) / (8.0 * (left + right)));
        }
    }
    let swings: Vec<f64> = extremes.windows(2).map(|e| (e[1] - e[0]).abs()).collect();
    let first = 2;
    let last = swings.len() - 1;
    let decrement = 2.0 * (swings[first] / swings[last]).ln() / (last - first) as f64;
    decrement / (TAU * TAU + decrement * decrement).sqrt()
}

/// Moment at the hub that swings after the hub has been turned by a little.
fn ringing_torsion(model: &Arc<Model>, velocity: f64, dt: f64, duration: f64) -> Vec<f64> {
    let mut inputs = frictionless(model, velocity);
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    inputs.drive.omega += 1e-3;
    let mut moment = || {
        simulation.advance(&inputs, dt).unwrap();
        simulation.outputs().hub_moment
    };
    (0..(duration / dt) as usize).map(|_| moment()).skip(4).collect()
}

#[test]
fn torsion_on_the_hub_decays_with_its_ratio_standing_and_rolling() {
    let mut modal = preset("paper_d", 10);
    modal.thermal.enabled = false;
    modal.damping = Damping::default();
    let shear = Isotropic::from(&modal.material).shear_wave_speed();
    let omega = hub_torsion(modal.wheel.radius, modal.wheel.hub_radius, shear).frequency;
    let model = model(modal);
    for velocity in [0.0, 20.0] {
        let found = [2e-5, 1e-5].map(|dt| ratio(&ringing_torsion(&model, velocity, dt, 10.0 * TAU / omega)));
        figure("damping.torsion", &[found[1] / 1e-2 - 1.0]);
        println!("{velocity} m/s: damping ratios {found:?}");
        assert!((found[1] / 1e-2 - 1.0).abs() < 0.01 && (found[0] / found[1] - 1.0).abs() < 0.01);
    }
}

/// Swing of the contact force after a small change of the load, over `periods` periods of about `expected` [rad/s].
fn bounce(model: &Arc<Model>, velocity: f64, expected: f64, periods: usize, per_period: f64) -> Vec<f64> {
    let mut inputs = frictionless(model, velocity);
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    inputs.drive.load *= 1.001;
    let mut force = || {
        simulation.advance(&inputs, TAU / expected / per_period).unwrap();
        simulation.outputs().contact_force_y
    };
    (0..periods * per_period as usize).map(|_| force()).collect()
}

/// Frequency [rad/s] from the crossings of the mean.
fn frequency(signal: &[f64], dt: f64) -> f64 {
    let mean = signal.iter().sum::<f64>() / signal.len() as f64;
    let rising = |k: &usize| signal[*k] < mean && signal[k + 1] >= mean;
    let at = |k: usize| k as f64 + (mean - signal[k]) / (signal[k + 1] - signal[k]);
    let crossings: Vec<f64> = (0..signal.len() - 1).filter(rising).map(at).collect();
    TAU * (crossings.len() - 1) as f64 / (crossings[crossings.len() - 1] - crossings[0]) / dt
}

fn heavy_hub(elements: usize) -> Config {
    let mut config = preset("railway", elements);
    config.thermal.enabled = false;
    config.wheel.hub_mass = 3000.0;
    config.vehicle.damping = 0.0;
    config
}

/// That wheel with no damping at all.
fn undamped(elements: usize) -> Config {
    let mut config = heavy_hub(elements);
    config.damping = Damping::NONE;
    config
}

/// Mass of wheel and hub \[kg].
fn bouncing_mass(config: &Config) -> f64 {
    config.wheel.hub_mass + BodyParameters::from(config).wheel_mass() * config.model.contact_width
}

/// A mass on a spring and a damper: `c/(2 m ω)`.
#[test]
fn bounce_on_the_contact_decays_with_the_damper_between_hub_and_vehicle() {
    let guess = 370.0;
    let mut config = undamped(10);
    let mass = bouncing_mass(&config);
    config.vehicle.damping = 2.0 * 0.01 * guess * mass;
    let damping = config.vehicle.damping;
    let model = model(config);
    for velocity in [0.0, 20.0] {
        let signal = bounce(&model, velocity, guess, 10, 400.0);
        let omega = frequency(&signal, TAU / guess / 400.0);
        let found = ratio(&signal) / (0.5 * damping / (mass * omega));
        figure("damping.vehicle", &[found - 1.0]);
        println!("{velocity} m/s: {omega:.1} rad/s, found over closed form {found:.4}");
        assert!((found - 1.0).abs() < 0.01);
    }
}

/// Torsion, radial, one and more diameters of the wheel; all modes of the rail.
#[test]
fn modes_of_both_bodies_have_the_ratios_that_their_parameters_give() {
    let mut config = Config::default();
    let damping = &mut config.damping;
    (damping.wheel_torsion, damping.wheel_radial) = (0.1, 0.2);
    (damping.wheel_one_diameter, damping.wheel_more_diameters, damping.rail) = (0.3, 0.4, 0.5);
    let damping = BodyParameters::from(&config).damping;
    assert_eq!(damping, [BodyDamping { ratios: [0.1, 0.2, 0.3, 0.4] }, BodyDamping { ratios: [0.5; 4] }]);
}

/// Each mode gives its share `s_i` of the flexibility under the bounce the loss factor `2 ζ_i ω/ω_i`:
/// `ζ = Σ s_i ζ_i ω/ω_i`, with `s_i = f_i²/ω_i²/(δP δδ)` from two static states. Contact force and inertia of the
/// bouncing wheel make the modal force `f_i = φ_iᵀ (δλ − M r_y δP/m)`.
#[test]
fn bounce_on_the_contact_decays_with_the_share_of_the_damped_modes() {
    let mut config = heavy_hub(10);
    let damping = &mut config.damping;
    (damping.wheel_one_diameter, damping.wheel_radial, damping.wheel_more_diameters) = (0.2, 0.2, 0.2);
    damping.rail = 0.2;
    let model = model(config);
    let still = |share: f64| {
        let mut inputs = frictionless(&model, 0.0);
        inputs.drive.load *= share;
        Simulation::new(model.clone(), &inputs).unwrap()
    };
    let (low, high) = (still(0.999), still(1.001));
    let forces = |s: &Simulation| s.state().lines[0].contact.traction.port_forces.clone();
    let change = forces(&high) - forces(&low);
    let line_load =
        (high.outputs().contact_force_y - low.outputs().contact_force_y) / model.config().model.contact_width;
    let work = line_load * (high.outputs().contact_approach - low.outputs().contact_approach);
    let basis = Basis::from_bytes(&model.basis_file().unwrap().1).unwrap();
    let guess = 370.0;
    let signal = bounce(&model, 0.0, guess, 20, 400.0);
    let omega = frequency(&signal, TAU / guess / 400.0);
    let mut expected = 0.0;
    let acceleration = line_load * model.config().model.contact_width / bouncing_mass(model.config());
    for (basis, damping) in [&basis.wheel, &basis.rail].into_iter().zip(BodyParameters::from(model.config()).damping) {
        for (i, shape) in basis.shapes.column_iter().enumerate() {
            let (square, ratio) = (basis.squared_frequencies[i], damping.ratios[basis.character.group(i)]);
            // The contact lies within the middle of the paired nodes.
            let middle = shape.rows((shape.len() - change.len()) / 2, change.len());
            let force = middle.dot(&change) - basis.rigid[(i, 1)] * acceleration;
            expected += ratio * omega / square.sqrt() * force * force / square / work;
        }
    }
    let found = ratio(&signal);
    figure("damping.modal", &[found / expected - 1.0]);
    println!("damping ratio {found:.4e}, from the shares of the modes {expected:.4e}, at {omega:.1} rad/s");
    assert!((found / expected - 1.0).abs() < 0.015);
}

/// Speeds of the centre of mass [m/s] before and after an impact: the wheel is thrown up by its own contact, turned
/// back by a load until it falls at the share `turned` of the speed of the throw, and falls freely.
fn impact(model: &Arc<Model>, dt: f64, turned: f64) -> [f64; 2] {
    let mut inputs = frictionless(model, 0.0);
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    let nominal = inputs.drive.load;
    let basis = Basis::from_bytes(&model.basis_file().unwrap().1).unwrap().wheel;
    let share = model.config().model.contact_width / bouncing_mass(model.config());
    let centre =
        |state: &State| state.motion.hub_velocity.now + share * basis.rigid.column(1).dot(&state.wheel.velocity);
    let mut until = |load: f64, reached: &dyn Fn(f64, f64) -> bool| {
        inputs.drive.load = load;
        let mut before = 0.0;
        for _ in 0..(0.5 / dt) as usize {
            simulation.advance(&inputs, dt).unwrap();
            let velocity = centre(simulation.state());
            if reached(simulation.outputs().contact_force_y, velocity) {
                return [before, velocity];
            }
            before = velocity;
        }
        panic!("no end of this phase");
    };
    let [_, thrown] = until(0.0, &|force, _| force == 0.0);
    until(0.3 * nominal, &|_, velocity| velocity < -turned * thrown);
    let [falling, _] = until(0.0, &|force, _| force > 0.0);
    let [_, rising] = until(0.0, &|force, _| force == 0.0);
    [-falling, rising]
}

/// A wheel without damping comes back as fast as it fell but for what its vibrations keep. The steps are fixed: their control
/// would refine the coarse ones.
///
/// The contact begins and ends anywhere within a step, and the error of the step, at most some `(ω Δt)²` of the speed,
/// depends on that place: means are those over wheels that are turned back to several speeds.
#[test]
fn rebound_of_a_dropped_wheel_without_damping_converges_with_the_step_to_one_without_loss() {
    let mut config = undamped(10);
    config.tuning.tolerance = 0.0;
    let model = model(config);
    let [coarse, middle, fine] = [1e-4, 5e-5, 2.5e-5].map(|dt| {
        let losses = [0.685, 0.69, 0.695, 0.7, 0.705, 0.71].map(|turned| {
            let [before, after] = impact(&model, dt, turned);
            1.0 - after / before
        });
        println!("step {dt}: losses {losses:+.6?}");
        losses.iter().sum::<f64>() / losses.len() as f64
    });
    figure("rebound", &[coarse, middle, fine]);
    assert!(fine.abs() < 1e-3 && fine.abs() < coarse.abs(), "{coarse} {middle} {fine}");
}

/// Reduced and full response with damped modes: 1 ms ramp of the creepage.
#[test]
fn damped_reduced_and_full_response_agree_within_a_thousandth_of_the_load() {
    let mut config = preset("paper_d", 6);
    config.thermal.enabled = false;
    config.damping = Damping::default();
    let reduced = model(config.clone());
    config.solver.reduced = false;
    let full = model(config);
    let mut inputs = prescribed(&reduced, 50.0 * KMH, 0.0);
    let [mut a, mut b] = [&reduced, &full].map(|m| Simulation::new(m.clone(), &inputs).unwrap());
    let difference = |a: &Outputs, b: &Outputs| {
        let x = (a.contact_force_x - b.contact_force_x).abs();
        x.max((a.contact_force_y - b.contact_force_y).abs())
    };
    let still = difference(a.outputs(), b.outputs()) / inputs.drive.load;
    let mut worst = 0.0_f64;
    for k in 1..=50 {
        inputs.drive.omega = omega(&reduced, 50.0 * KMH, -8e-4 * (f64::from(k) / 35.0).min(1.0));
        a.advance(&inputs, 2e-5).unwrap();
        b.advance(&inputs, 2e-5).unwrap();
        worst = worst.max(difference(a.outputs(), b.outputs()) / inputs.drive.load);
    }
    figure("damping.reduced", &[worst]);
    println!("largest difference over the load: stationary {still:.1e}, ramp {worst:.1e}");
    assert!(still < 1e-3 && worst < 1e-3);
}

/// Braking with a held stop; `change` sets the damping. Returns residual, and damping over friction [1].
fn braking(change: &dyn Fn(&mut Config)) -> [f64; 2] {
    let mut config = preset("railway", 10);
    config.thermal.enabled = false;
    config.initial.velocity = 2.0;
    change(&mut config);
    let model = model(config);
    let mut inputs = Inputs::rolling(model.config());
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    let (dt, mut friction) = (5e-4, 0.0);
    for k in 0..6000 {
        if simulation.outputs().wheel_velocity < 0.05 {
            inputs.rotation = Rotation::Velocity;
            inputs.drive.omega = 0.0;
        } else {
            inputs.drive.moment = -8e3 * (f64::from(k) * dt / 0.2).min(1.0);
        }
        simulation.advance(&inputs, dt).unwrap();
        friction += dt * simulation.outputs().friction_power / model.config().model.contact_width;
    }
    let outputs = simulation.outputs();
    [outputs.energy_residual, simulation.state().audit.dissipation() / friction - 1.0]
}

#[test]
fn energy_of_a_braking_stop_stays_balanced_with_damping() {
    // The damper of the track takes what is left at the stop, 14 % of the little that a gentle brake loses to friction.
    let none = braking(&|c| {
        c.damping = Damping::NONE;
        (c.rail.restraint_stiffness, c.rail.restraint_damping) = (0.0, 0.0);
    });
    let modal = braking(&|_| {});
    let strong = braking(&|c| c.damping = Damping::all(0.1));
    println!("residual, damping over friction: none {none:?}, default {modal:?}, strong {strong:?}");
    // At a change of solver the power of friction, which is an output, is that of its work within 1e-7 of the whole.
    assert!(none[1].abs() < 1e-6);
    for [residual, _] in [none, modal, strong] {
        assert!(residual.abs() < 5e-3);
    }
}
