//! A wheel that slides, is released and rolls on: what its material has gone through, through the façade.

use crate::common::{self, KMH, model, prescribed};
use std::sync::Arc;
use wheelrail::config::Config;
use wheelrail::simulation::{Checkpoint, Inputs, Model, Outputs, Simulation};

const SPEED: f64 = 60.0 * KMH;

/// The railway wheel with few elements per half-width.
fn coarse() -> Config {
    let mut config = common::preset("railway", 6);
    config.initial.velocity = SPEED;
    config
}

fn rolling(model: &Arc<Model>) -> (Simulation, Inputs) {
    let inputs = prescribed(model, SPEED, 0.0);
    (Simulation::new(model.clone(), &inputs).unwrap(), inputs)
}

/// Takes the angular velocity to `share` of that of rolling within 20 ms and holds it there until `duration` is over,
/// in steps of `h` seconds; returns for how long the contact was above Ac1.
fn turn(simulation: &mut Simulation, inputs: &mut Inputs, share: f64, duration: f64, h: f64) -> f64 {
    let (from, to) = (inputs.drive.omega, share * SPEED / simulation.model().config().wheel.radius);
    let ac1 = simulation.tuning().austenitisation;
    let mut hot = 0.0;
    for k in 1..=(duration / h).round() as usize {
        inputs.drive.omega = from + (to - from) * (k as f64 * h / 0.02).min(1.0);
        simulation.advance(inputs, h).unwrap();
        hot += if simulation.outputs().temperature_wheel_max > ac1 { h } else { 0.0 };
    }
    hot
}

/// Locks for `slide`, releases and rolls on for `on` \[s].
fn flat(config: Config, slide: f64, on: f64, h: f64) -> Outputs {
    let model = model(config);
    let (mut simulation, mut inputs) = rolling(&model);
    turn(&mut simulation, &mut inputs, 0.0, slide, h);
    turn(&mut simulation, &mut inputs, 1.0, on, h);
    let o = simulation.outputs().clone();
    println!(
        "{slide} s, steps of {h} s: {:.0} K, {:.4} s above Ac1, Ac1 to {:.4} mm, {:.1} K/s, martensite to {:.4} mm, {} flat",
        o.peak_temperature,
        o.austenitised_time,
        1e3 * o.ac1_depth,
        o.cooling_rate,
        1e3 * o.martensite_depth,
        o.flats
    );
    o
}

/// Depth at which the highest temperatures over depth fall below Ac1, linear between points \[m].
fn crossing(o: &Outputs, ac1: f64) -> f64 {
    let (z, t) = (&o.profile_depth, &o.profile_peak);
    let last = t.iter().rposition(|t| *t > ac1).unwrap();
    z[last] + (t[last] - ac1) / (t[last] - t[last + 1]) * (z[last + 1] - z[last])
}

#[test]
fn a_slide_of_a_second_leaves_a_flat_of_martensite_independent_of_ring_mesh_and_step() {
    let with = |resolution: f64, h: f64| {
        let mut config = coarse();
        config.damage.resolution = resolution;
        flat(config, 1.0, 2.0, h)
    };
    let [usual, fine, long] = [with(1.0, 1e-3), with(0.5, 1e-3), with(1.0, 5e-3)];
    assert!(usual.flats == 1 && usual.ac1_depth > 1e-3 && usual.cooling_rate > 100.0);
    assert!((usual.martensite_depth / usual.ac1_depth - 1.0).abs() < 0.05, "all that was austenite is martensite");
    let read = crossing(&usual, coarse().tuning.austenitisation);
    println!("Ac1 to {:.4} mm in the profile", 1e3 * read);
    assert!((read / usual.ac1_depth - 1.0).abs() < 0.01, "{read}");
    for other in [fine, long] {
        for read in [
            |o: &Outputs| o.ac1_depth,
            |o: &Outputs| o.cooling_rate,
            |o: &Outputs| o.martensite_depth,
            |o: &Outputs| o.austenitised_time,
        ] {
            let (a, b) = (read(&usual), read(&other));
            assert!((a / b - 1.0).abs() < 0.05, "{a} and {b}");
        }
    }
}

#[test]
fn a_run_recalled_with_hot_spots_is_the_first_bit_for_bit() {
    let model = model(coarse());
    let (mut simulation, mut inputs) = rolling(&model);
    turn(&mut simulation, &mut inputs, 0.0, 0.05, 1e-3);
    // Locked, and released on another place of the tread, which has a second spot.
    for _ in 0..2 {
        let (saved, with) = (simulation.checkpoint().clone(), inputs);
        let bytes = postcard::to_stdvec(&saved).unwrap();
        let mut go_on = |simulation: &mut Simulation| {
            inputs = with;
            turn(simulation, &mut inputs, 1.0, 0.03, 1e-3);
            turn(simulation, &mut inputs, 0.0, 0.04, 1e-3);
            simulation.checkpoint().clone()
        };
        let first = go_on(&mut simulation);
        simulation.recall(saved).unwrap();
        assert_eq!(go_on(&mut simulation), first);
        let read: Checkpoint = postcard::from_bytes(&bytes).unwrap();
        let mut resumed = Simulation::resume(model.clone(), simulation.tuning().clone(), read).unwrap();
        assert_eq!(go_on(&mut resumed), first);
    }
    let damage = &simulation.state().lines[0].thermal.as_ref().unwrap().damage;
    println!("{} flats, {} spots", damage.places, damage.spots.len());
    assert!(damage.spots.iter().filter(|spot| spot.is_hot()).count() > 1);
}

#[test]
fn a_state_with_a_spot_of_another_mesh_is_refused() {
    let (one, mut other) = (model(coarse()), coarse());
    other.damage.resolution = 2.0;
    let (mut simulation, mut inputs) = rolling(&one);
    turn(&mut simulation, &mut inputs, 0.0, 0.05, 1e-3);
    let checkpoint = simulation.checkpoint().clone();
    let tuning = simulation.tuning().clone();
    assert!(Simulation::resume(one, tuning.clone(), checkpoint.clone()).is_ok());
    assert!(Simulation::resume(model(other), tuning, checkpoint).is_err());
}

#[test]
fn a_rolling_slide_of_a_fifth_counts_the_passes_of_a_point_and_opens_no_spot() {
    let mut config = coarse();
    config.tuning.austenitisation = 600.0;
    let radius = config.wheel.radius;
    let model = model(config);
    let (mut simulation, mut inputs) = rolling(&model);
    let hot = turn(&mut simulation, &mut inputs, 0.8, 0.6, 1e-3);
    let o = simulation.outputs();
    let pass = 2.0 * o.contact_half_width / (o.wheel_omega * radius);
    let turns = o.wheel_angle / std::f64::consts::TAU;
    println!(
        "contact above {hot:.3} s, longest of a point {:.3} ms, at most {:.3} ms in a pass, {turns:.2} turns",
        1e3 * o.austenitised_time,
        1e3 * pass
    );
    assert!(hot > 0.2 && o.flats == 0);
    // The hot field trails a little behind the patch.
    assert!(o.austenitised_time > 0.3 * pass && o.austenitised_time < 1.2 * pass * turns.ceil());
    assert!(o.austenitised_time < 0.02 * hot);
}

#[test]
fn ordinary_braking_leaves_no_spot_and_no_memory_for_one() {
    // A model that other tests share has memory of theirs.
    let model = Model::prepare(coarse(), &common::store(), &mut |_, _| {}).unwrap();
    let (mut simulation, mut inputs) = rolling(&model);
    turn(&mut simulation, &mut inputs, 0.998, 0.2, 1e-3);
    let damage = &simulation.state().lines[0].thermal.as_ref().unwrap().damage;
    assert!(damage.spots.capacity() == 0 && damage.tread == Default::default());
    let o = simulation.outputs();
    assert!(o.peak_temperature > 293.0 && (o.flats, o.ac1_depth, o.austenitised_time) == (0, 0.0, 0.0));
    assert!(o.rail_peak > 293.0 && o.rail_heat > 0.0);
    assert!((o.rail_heat * o.wheel_velocity / o.heat_to_rail - 1.0).abs() < 1e-12);
}
