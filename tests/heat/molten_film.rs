//! A film of molten steel is where the surface is molten, and nowhere else: what a slide has melted before decides nothing.

use crate::common::*;
use std::path::Path;
use wheelrail::simulation::{Inputs, Outputs, Rotation, Simulation, Translation};

/// Time in which the rotation is stopped \[s].
const LOCK: f64 = 0.02;
/// Speed of the slides [m/s].
const SPEED: f64 = 22.2;

/// Names of all presets.
fn names() -> Vec<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("resources");
    let files = std::fs::read_dir(folder).unwrap().map(|file| file.unwrap().file_name().into_string().unwrap());
    let mut names: Vec<_> = files.filter_map(|name| name.strip_suffix(".json").map(str::to_owned)).collect();
    names.sort();
    names
}

/// A wheel of a preset that is locked, on a rail with the friction `first` for a time \[s] and with `then` until `end`: outputs after
/// every step of 1 ms.
fn locked(name: &str, elements: usize, (first, time): (f64, f64), then: f64, end: f64) -> (Vec<Outputs>, f64) {
    let h = 1e-3;
    let mut config = preset(name, elements);
    config.initial.velocity = SPEED;
    let solidus = config.material.solidus;
    let model = model(config);
    let mut inputs = Inputs::rolling(model.config());
    (inputs.rotation, inputs.translation) = (Rotation::Velocity, Translation::Velocity);
    let omega = inputs.drive.omega;
    inputs.drive.friction = first;
    let mut simulation = Simulation::new(model, &inputs).unwrap();
    let steps = (1..=(end / h).round() as usize).map(|k| {
        let now = k as f64 * h;
        inputs.drive.omega = omega * (1.0 - now / LOCK).max(0.0);
        inputs.drive.friction = if now > time + 0.5 * h { then } else { first };
        simulation.advance(&inputs, h).unwrap_or_else(|error| panic!("{name}, {now} s: {error}"));
        simulation.outputs().clone()
    });
    (steps.collect(), solidus)
}

fn hottest(o: &Outputs) -> f64 {
    o.temperature_wheel_max.max(o.temperature_rail_max)
}

/// A film that stayed as long as the contact was beyond 400 °C held a wheel at .58 of its friction, 1.90 kN in place of 3.26, and
/// one with less friction braked more.
#[test]
fn a_wheel_that_has_melted_slides_on_like_one_that_never_did() {
    let run = |dry: f64, then: f64| locked("railway_wet", 10, (dry, 0.08), then, 0.6).0;
    let [melted, never, lower] = [(0.3, 0.08), (0.08, 0.08), (0.3, 0.06)].map(|(dry, then)| run(dry, then));
    let last = |run: &[Outputs]| run.last().map(|o| [-o.contact_force_x, hottest(o) - 273.15]).unwrap();
    let [a, b, c] = [&melted, &never, &lower].map(|run| last(run));
    figure_within(0.01, "film.force [N]", &[a[0], b[0], c[0]]);
    figure_within(0.01, "film.temperature [°C]", &[a[1], b[1]]);
    assert!(melted[79].melted > 0.0 && melted[79].molten > 0.0 && never.iter().all(|o| o.melted == 0.0));
    assert!(a.iter().zip(b).all(|(a, b)| (a / b - 1.0).abs() < 0.03));
    assert!(c[0] < 0.8 * a[0]);
}

/// Sliding on steel that is solid everywhere, all of friction is in use, in the very step in which it has frozen, too. Where
/// steel yields its strength in shear may bear less: friction is low here.
#[test]
fn all_friction_acts_in_every_step_that_ends_on_solid_steel() {
    for name in names() {
        let (seen, solidus) = locked(&name, 10, (0.6, 0.06), 0.05, 0.12);
        let slides = |o: &&Outputs| o.wheel_omega == 0.0 && o.contact_stick_fraction == 0.0;
        let solid: Vec<&Outputs> = seen.iter().filter(slides).filter(|o| hottest(o) < solidus).collect();
        let molten = seen.iter().filter(|o| o.molten > 0.0).count();
        let worst = solid.iter().map(|o| (o.contact_utilisation - 1.0).abs()).fold(0.0, f64::max);
        let film = solid.iter().map(|o| o.molten).fold(0.0, f64::max);
        round_off("film.solid", &[worst], 1e-12);
        println!(
            "{name}: {molten} steps with a film, {} on solid steel: {worst:.1e} off, {film} under a film",
            solid.len()
        );
        assert!(solid.len() > 20 && worst < 1e-3 && film == 0.0, "{name}");
    }
}

/// A node bears the mean of the film within its reach, and its heat goes to the places that the film leaves: all of it.
#[test]
fn friction_under_a_film_becomes_heat_to_the_last_joule() {
    let seen = locked("railway_dry", 10, (0.5, 0.06), 0.5, 0.06).0;
    let molten = seen.iter().filter(|o| o.molten > 0.5);
    let off = molten.clone().map(|o| ((o.heat_to_wheel + o.heat_to_rail) / o.friction_power - 1.0).abs());
    let worst = off.fold(0.0, f64::max);
    round_off("film.heat", &[worst], 1e-12);
    assert!(molten.count() > 10 && worst < 1e-10);
}

/// Wheel of a dry preset whose brake grows to 40 kN m within 50 ms under a load that swings, for 100 ms: force along the track \[N]
/// and highest temperature \[K] at the end.
fn braked(tolerance: f64, h: f64) -> [f64; 2] {
    let mut config = shipped("railway_dry");
    config.initial.velocity = 20.0;
    config.tuning.tolerance = tolerance;
    let model = model(config);
    let mut inputs = Inputs::rolling(model.config());
    let mut simulation = Simulation::new(model, &inputs).unwrap();
    let load = |t: f64| 1e5 * (1.0 + 0.05 * (40.0 * t).sin());
    let torque = |t: f64| 40e3 * (t / 0.05).min(1.0);
    for k in 0..(0.1 / h).round() as usize {
        let [from, to] = [k, k + 1].map(|k| k as f64 * h);
        (inputs.drive.load, inputs.drive.torque) = (load(from), torque(from));
        (inputs.rate.load, inputs.rate.torque) = ((load(to) - load(from)) / h, (torque(to) - torque(from)) / h);
        simulation.advance(&inputs, h).unwrap();
    }
    let o = simulation.outputs();
    [-o.contact_force_x, hottest(o)]
}

/// A film that opened in the step of the stop, and closed only where that step was short, made the force fall by 8 % at a tenth of
/// the tolerance and come back at a hundredth.
#[test]
fn a_locking_dry_wheel_converges_with_the_tolerance() {
    let default = shipped("railway_dry").tuning.tolerance;
    let runs = [(default, 1e-3), (2e-4, 1e-3), (2e-5, 1e-3), (default, 1e-4)];
    let found = runs.map(|(tolerance, h)| (tolerance, h, braked(tolerance, h)));
    let [_, _, (_, _, finest), _] = found;
    let off = found.map(|(_, _, [force, highest])| [force / finest[0] - 1.0, highest / finest[1] - 1.0]);
    round_off("film.tolerance", &[off[0][0], off[1][0], off[3][0]], 0.01);
    round_off("film.tolerance.temperature", &[off.iter().map(|[_, b]| b.abs()).fold(0.0, f64::max)], 0.01);
    for (tolerance, h, [force, highest]) in found {
        let [a, b] = [force / finest[0] - 1.0, highest / finest[1] - 1.0];
        println!("tolerance {tolerance}, steps of {h} s: {force:.0} N, {highest:.0} K, {a:+.4} and {b:+.4} off");
        assert!(a.abs() < 0.02 && b.abs() < 0.02);
    }
}
