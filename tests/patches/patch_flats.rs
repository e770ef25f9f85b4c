//! Wheels on several lines over flats, squats, joints and dents of their own: all of the documented range run.

use crate::common::{self, KMH, Random, model, preset};
use wheelrail::config::{Config, Wear};
use wheelrail::simulation::{Inputs, Rotation, Simulation};

const STEP: f64 = 1e-3;
/// Random runs of every test run; the environment variable asks for more, on the mesh that presets have.
const RUNS: u64 = 6;
const RUNS_VARIABLE: &str = "WHEELRAIL_FLAT_RUNS";
const SHAPES: [&str; 3] = ["railway_ellipse", "railway_s1002_0mm", "railway_s1002_3mm"];
/// Position of the middle of what wheels roll over \[m], and the way to its end and a little farther.
const MIDDLE: f64 = 0.08;
const WAY: f64 = 0.15;

/// Passage of a wheel over a defect.
#[derive(Clone, Debug)]
struct Pass {
    shape: &'static str,
    lines: usize,
    /// Profiles of wheel and rail.
    profiles: [String; 2],
    /// Speed \[km/h].
    speed: f64,
    /// Load and moment over the nominal load and what friction carries of it \[1].
    load: f64,
    moment: f64,
}

impl Pass {
    /// A fresh flat of a length \[m] on seven lines of an ellipse under the nominal load at a speed \[km/h].
    fn flat(length: f64, speed: f64) -> Self {
        let wheel = format!("flat(position = {MIDDLE}, length = {length})");
        Self { shape: SHAPES[0], lines: 7, profiles: [wheel, String::new()], speed, load: 1.0, moment: 0.0 }
    }

    fn random(seed: u64) -> Self {
        let mut random = Random(seed);
        let (length, depth) = (random.between(0.02, 0.08), random.logarithmic(3e-5, 3e-4));
        let wheel = match random.below(4) {
            0 | 1 => format!("flat(position = {MIDDLE}, length = {length:.4})"),
            2 => format!("flat(position = {MIDDLE}, length = {length:.4}, shape = rounded)"),
            _ => String::new(),
        };
        let rail = match random.below(2) {
            _ if !wheel.is_empty() => String::new(),
            0 => format!("squat(position = {MIDDLE}, length = {length:.4}, depth = {depth:.2e})"),
            _ => format!(
                "joint(position = {MIDDLE}, angle = {:.3}, length = 0.2, gap = {:.4})",
                20.0 * depth,
                length / 8.0
            ),
        };
        Self {
            shape: random.of(&SHAPES),
            lines: 1 + random.below(13),
            profiles: [wheel, rail],
            speed: random.between(15.0, 140.0),
            load: random.between(0.1, 1.9),
            moment: random.between(-0.6, 0.6),
        }
    }

    /// Largest force over the nominal load.
    fn run(&self, elements: Option<usize>) -> f64 {
        let mut config = elements.map_or_else(|| common::shipped(self.shape), |number| preset(self.shape, number));
        config.contact.lines = self.lines;
        [config.wheel.profile, config.rail.profile] = self.profiles.clone();
        config.initial.velocity = self.speed * KMH;
        let steps = (WAY / config.initial.velocity / STEP).max(20.0) as usize;
        let (nominal, radius) = (config.model.nominal_load, config.wheel.radius);
        let mut inputs = Inputs::rolling(&config);
        inputs.drive.load = self.load * nominal;
        inputs.drive.moment = self.moment * inputs.drive.friction * inputs.drive.load * radius;
        let mut simulation = started(config, &inputs);
        let forces = (0..steps).map(|k| {
            if let Err(error) = simulation.advance(&inputs, STEP) {
                panic!("{self:?}, step {k}: {error}");
            }
            simulation.outputs().contact_force_y
        });
        let most = forces.fold(0.0, f64::max) / nominal;
        println!("{self:?}: {most:.2}");
        assert!(most > 0.5 * self.load && most < 20.0);
        most
    }
}

fn started(config: Config, inputs: &Inputs) -> Simulation {
    Simulation::new(model(config), inputs).unwrap()
}

#[test]
fn wheels_roll_over_flats_squats_and_joints_of_random_lengths_at_any_speed() {
    let asked = std::env::var(RUNS_VARIABLE).ok().map(|text| text.parse().unwrap());
    for seed in 0..asked.unwrap_or(RUNS) {
        Pass::random(seed).run(if asked.is_some() { None } else { Some(6) });
    }
}

/// Lengths and speeds at which runs ended while lines gave way less than nothing beyond their layout.
#[test]
fn wheels_roll_over_fresh_flats_of_every_length() {
    for (length, speed) in [(0.02, 90.0), (0.04, 15.0), (0.06, 30.0), (0.08, 30.0), (0.08, 140.0)] {
        let most = Pass::flat(length, speed).run(Some(6));
        assert!(most > 1.2, "a strike");
    }
}

#[test]
fn a_wheel_rolls_on_over_the_flat_that_it_has_worn_and_pressed_while_it_was_locked() {
    let mut config = preset(SHAPES[0], 6);
    config.damage.wear = Wear::TGamma;
    config.initial.velocity = 8.0;
    let turn = std::f64::consts::TAU * config.wheel.radius / config.initial.velocity;
    let mut inputs = Inputs::rolling(&config);
    let rolling = inputs.drive.omega;
    inputs.rotation = Rotation::Velocity;
    let mut simulation = started(config, &inputs);
    let (locked, released) = (0.3, 0.35);
    for k in 0..((released + 1.2 * turn) / STEP) as usize {
        let time = k as f64 * STEP;
        let share = if time < locked { 1.0 - time / 0.02 } else { (time - locked) / (released - locked) };
        inputs.drive.omega = rolling * share.clamp(0.0, 1.0);
        simulation.advance(&inputs, STEP).unwrap_or_else(|error| panic!("{time}: {error}"));
    }
    let o = simulation.outputs();
    println!("flat of {:.1} mm, {:.0} um deep", 1e3 * o.flat_length, 1e6 * o.flat_depth);
    assert!(o.flat_length > 0.01);
}
