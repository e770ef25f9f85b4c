//! Friction that depends on the slip of the tread: that it is found at every size of step.

use crate::common::*;
use std::sync::Arc;
use wheelrail::config::Tuning;
use wheelrail::simulation::{Inputs, Model, Rotation, Simulation};

/// A sliding distance within which nothing happens [m].
const AT_ONCE: f64 = 1e-12;

/// Polach's law on a dry rail without memory, slip and heat of a dry-braked wheel.
fn polach(response_heat: bool) -> Arc<Model> {
    let mut config = preset("railway_dry", 8);
    config.tuning.memory_length = AT_ONCE;
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
        // A memory of 1e-12 m is left behind within nanometres of sliding.
        assert!((o.friction / law - 1.0).abs() < 1e-6, "{} for {law} at {} s", o.friction, simulation.time());
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
        let tuning =
            Tuning { falling_ratio: ratio, falling_decay: decay, memory_length: 0.0, ..model.config().tuning.clone() };
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
    let start = simulation.outputs().friction;
    // The wheel slips more at once, and the friction falls over a distance.
    inputs.drive.omega = 7.0 / 0.46;
    let (h, mut slid) = (1e-3, 0.0);
    for k in 1..=400 {
        simulation.advance(&inputs, h).unwrap();
        let o = simulation.outputs();
        slid += o.contact_tread_slip * h;
        let falling = (1.0 - tuning.falling_ratio) * (-tuning.falling_decay * o.contact_tread_slip).exp();
        let law = inputs.drive.friction * (tuning.falling_ratio + falling);
        let expected = law + (start - law) * (-slid / length).exp();
        // The slip rings a little while the force falls.
        assert!((o.friction / expected - 1.0).abs() < 0.02, "{} for {expected} after {k} ms", o.friction);
    }
    let o = simulation.outputs();
    println!("friction {start:.4} to {:.4} over {slid:.2} m", o.friction);
    assert!(o.friction < 0.8 * start && slid > 4.0 * length);
}

#[test]
fn a_state_with_a_memory_of_friction_continues_bit_for_bit() {
    let model = polach(true);
    let tuning = Tuning { memory_length: 0.01, ..model.config().tuning.clone() };
    let mut inputs = Inputs::rolling(model.config());
    let mut simulation = Simulation::start(model.clone(), tuning.clone(), &inputs).unwrap();
    // More than friction carries: the wheel is on its way to lock when the state is kept.
    inputs.drive.moment = -30e3;
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

/// Without a memory slip and friction jump in every internal step: samples of the force look converged at 29.9 kN where
/// the mean is 24.1 kN. With it the torsion sticks and slips, and what the held speeds put in is what friction and
/// damping take out.
#[test]
fn sampled_force_energy_and_moment_of_a_held_slip_agree_where_friction_falls_by_default() {
    for (load, h) in [(0.5_f64, 1e-4_f64), (0.5, 2e-5), (0.1, 1e-4), (0.95, 1e-4)] {
        let mut config = preset("railway", 10);
        config.thermal.enabled = false;
        config.model.nominal_load = 200e3;
        (config.initial.velocity, config.friction.coefficient) = (15.0, 0.4);
        (config.tuning.falling_ratio, config.tuning.falling_decay) = (0.4, 0.6);
        assert_eq!(config.tuning.memory_length, 0.0);
        let (model, slip, speed, end) = (model(config), 2.0, 15.0, 0.3);
        let radius = model.config().wheel.radius;
        let mut inputs = prescribed(&model, speed, 0.0);
        inputs.drive.load = load * 200e3;
        let mut simulation = Simulation::new(model, &inputs).unwrap();
        let (mut force, mut moment, mut count, mut taken) = (0.0, 0.0, 0.0, 0.0);
        let lost = |simulation: &Simulation| simulation.outputs().friction_energy + simulation.outputs().damping_energy;
        for k in 1..=(end / h).round() as usize {
            let time = k as f64 * h;
            inputs.drive.omega = (speed - slip * (time / 0.01).min(1.0)) / radius;
            let before = lost(&simulation);
            simulation.advance(&inputs, h).unwrap();
            if time > 0.5 * end {
                let o = simulation.outputs();
                (force, moment, count) = (force - o.contact_force_x, moment - o.hub_moment / radius, count + 1.0);
                taken += (lost(&simulation) - before) / slip;
            }
        }
        let [sampled, energy, moment] = [force / count, taken / (count * h), (moment / count).abs()];
        println!(
            "load {load}, steps of {h} s: {sampled:.0} N sampled, {energy:.0} N by energy, {moment:.0} N by moment"
        );
        assert!((energy / sampled - 1.0).abs() < 0.01, "{energy} for {sampled}");
        // Samples of the moment, whose swing is larger, scatter a little more under nearly twice the nominal load per
        // patch.
        assert!((moment / sampled - 1.0).abs() < if load > 0.9 { 0.02 } else { 0.01 }, "{moment} for {sampled}");
    }
}

/// Largest friction over load of a wheel that coasts onto a rail of another friction and brakes there, in steps of `h`, and the
/// friction coefficient at the end of coasting.
fn on_another_rail(name: &str, h: f64, available: f64) -> [f64; 2] {
    let mut config = preset(name, 8);
    config.initial.velocity = 20.0;
    let model = model(config);
    let mut inputs = Inputs::rolling(model.config());
    let mut simulation = Simulation::new(model, &inputs).unwrap();
    inputs.drive.friction = available;
    let mut advance = |inputs: &Inputs, time: f64| {
        let mut used = 0.0_f64;
        for _ in 0..(time / h).round() as usize {
            simulation.advance(inputs, h).unwrap();
            let o = simulation.outputs();
            used = used.max(o.contact_force_x.abs() / o.contact_force_y);
        }
        [used, simulation.outputs().friction]
    };
    let [_, found] = advance(&inputs, 0.1);
    inputs.drive.torque = 3e3;
    let [used, _] = advance(&inputs, 0.1);
    [used, found]
}

/// A wheel that hardly slips remembers its share of the friction that the rail has, not the rail that it has left.
#[test]
fn friction_of_the_rail_acts_where_the_wheel_rolls_onto_it_although_the_law_has_a_memory() {
    for name in ["railway", "railway_dry", "railway_wet", "railway_low_adhesion"] {
        for h in [5e-3, 1e-3, 1e-4] {
            for available in [0.02, 0.05] {
                let [used, found] = on_another_rail(name, h, available);
                println!(
                    "{name}, steps of {h} s, rail {available}: friction {found:.5} when it coasts, used {used:.5}"
                );
                assert!((found / available - 1.0).abs() < 0.01, "{found}");
                assert!(used <= available * (1.0 + 1e-9) && used > 0.5 * available, "{used}");
            }
        }
    }
}
