//! No temperature below the coldest datum, whatever the parameters, the steps and the motion.

mod common;

use common::Random;
use wheelrail::config::Config;
use wheelrail::config::value::{Kind, Value};
use wheelrail::simulation::advice::{failed_preparation, failed_start, failed_step};
use wheelrail::simulation::{Inputs, Model, Rotation, Simulation, Translation};

/// Undershoot that counts as none [K].
const SLIGHT: f64 = 0.1;
const SETS: u64 = 8;
const STEPS: usize = 50;

/// Groups of parameters that act on temperatures and leave the bases of the bodies alone.
const VARIED: [&str; 3] = ["thermal.", "friction.", "physics."];
const VARIED_MATERIAL: [&str; 6] = [
    "material.conductivity",
    "material.specific_heat",
    "material.expansion",
    "material.solidus",
    "material.liquidus",
    "material.latent_heat",
];

/// A value from the declared range: an end of it, uniform, or uniform in the logarithm.
fn drawn(kind: &Kind, random: &mut Random) -> Value {
    match *kind {
        Kind::Real { min, max, .. } => Value::Real(match random.below(4) {
            0 => random.of(&[min, max]),
            1 => random.between(min, max),
            _ if min > 0.0 => random.logarithmic(min, max).clamp(min, max),
            _ => random.logarithmic(1e-9 * max, max).min(max),
        }),
        Kind::Integer { min, max } => Value::Integer(min + random.below((max - min + 1) as usize) as i32),
        Kind::Enumeration(list) => Value::Integer(1 + random.below(list.items.len()) as i32),
        Kind::Boolean => Value::Boolean(random.below(2) == 0),
        Kind::String => Value::String(String::new()),
    }
}

fn set(seed: u64) -> (Config, Random, String) {
    let mut random = Random(seed);
    let mut config = common::preset("railway", 4);
    (config.solver.modes_wheel, config.solver.modes_rail) = (12, 20);
    // Error control at every tenth set only: it takes many short steps in such runs.
    config.tuning.tolerance = if random.below(10) == 0 { 0.01 } else { 0.0 };
    let share = random.of(&[0.05, 0.15, 0.4, 1.0]);
    let mut text = String::new();
    for row in Config::rows() {
        let varied = VARIED.iter().any(|name| row.name.starts_with(name)) || VARIED_MATERIAL.contains(&row.name);
        if varied && row.name != "thermal.enabled" && random.between(0.0, 1.0) < share {
            let before = config.clone();
            (row.write)(&mut config, &drawn(&row.kind, &mut random));
            // Most sets should run: a value that its partners do not allow is left at what it was.
            if config.validate().is_err() && random.below(20) > 0 {
                config = before;
            } else {
                text += &format!(", {} {:?}", row.name, (row.read)(&config));
            }
        }
    }
    (config, random, text)
}

/// Whether a message names a parameter or an input.
fn named(message: &str) -> bool {
    ["drive.", "mesh."].iter().any(|group| message.contains(group))
        || Config::rows().iter().any(|row| message.contains(row.name))
}

enum Outcome {
    Simulated,
    Refused(String),
    /// Deviation below the coldest datum [K], time of it.
    TooCold(String),
}

fn run(seed: u64) -> (Outcome, String) {
    let (config, mut random, text) = set(seed);
    let outcome = simulate(&config, &mut random);
    (outcome.unwrap_or_else(Outcome::Refused), text)
}

fn simulate(config: &Config, random: &mut Random) -> Result<Outcome, String> {
    let model = Model::prepare(config.clone(), &common::store(), &mut |_, _| {});
    let model = model.map_err(|error| failed_preparation(&error, config))?;
    let coldest = config.thermal.reference + config.thermal.wheel_excess.min(0.0);
    // Reversible heating cools for real; then only absolute zero is the bound.
    let bound = if config.physics.thermoelastic_heating { 0.0 } else { coldest - SLIGHT };
    let mut inputs = Inputs::rolling(config);
    (inputs.rotation, inputs.translation) = (Rotation::Velocity, Translation::Velocity);
    let mut simulation = Simulation::new(model, &inputs).map_err(|error| failed_start(&error, config))?;
    for step in 0..STEPS {
        let dt = random.logarithmic(1e-6, 1e-2);
        let radius = config.wheel.radius;
        if random.below(8) == 0 {
            let speed = inputs.drive.velocity;
            inputs.drive.omega = random.of(&[0.0, speed, 1.1 * speed, 0.5 * speed, 0.99 * speed]) / radius;
            inputs.drive.tread_heat = random.of(&[0.0, 0.0, 45e3, 1e6]);
            inputs.drive.load = config.model.nominal_load * random.between(0.5, 1.0);
        }
        simulation.advance(&inputs, dt).map_err(|error| failed_step(&error, config))?;
        let fields = simulation.temperature_fields().map_err(|error| error.to_string())?;
        let nodes = fields.iter().flatten().flat_map(|field| &field.temperature);
        let lowest = nodes.copied().fold(f64::INFINITY, f64::min);
        if lowest.is_nan() || lowest < bound {
            return Ok(Outcome::TooCold(format!("step {step} of {dt:.2e} s: {lowest} K, coldest datum {coldest} K")));
        }
    }
    Ok(Outcome::Simulated)
}

#[test]
fn temperatures_of_random_parameter_sets_stay_above_the_coldest_datum_or_the_step_is_refused_by_name() {
    let (mut simulated, mut wrong) = (0, Vec::new());
    for seed in 0..SETS {
        match run(seed) {
            (Outcome::Simulated, _) => simulated += 1,
            (Outcome::Refused(why), _) if named(&why) => {}
            (Outcome::Refused(why), text) => wrong.push(format!("{seed}: unexplained: {why}{text}")),
            (Outcome::TooCold(why), text) => wrong.push(format!("{seed}: {why}{text}")),
        }
    }
    println!("{simulated} of {SETS} sets were simulated");
    assert!(wrong.is_empty(), "{} of {SETS}:\n{}", wrong.len(), wrong.join("\n"));
    assert!(simulated >= SETS / 4, "{simulated}");
}
