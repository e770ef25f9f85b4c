//! No temperature below the coldest datum and none far above molten steel, whatever the parameters, the steps and the
//! motion.

use crate::common::{self, Random};
use crate::heat_common::Run;
use std::f64::consts::PI;
use wheelrail::config::value::{Kind, Value};
use wheelrail::config::{Config, StartTemperature};
use wheelrail::heat::*;
use wheelrail::piecewise::Piecewise;
use wheelrail::rolling::thermal::heat_parameters;
use wheelrail::simulation::advice::{failed_preparation, failed_start, failed_step};
use wheelrail::simulation::{Inputs, Model, Rotation, Simulation, StepError, Translation};

/// Undershoot that counts as none [K].
const SLIGHT: f64 = 0.1;
/// Excess over the liquidus that a molten contact may reach [K].
const OVERHEATING: f64 = 50.0;
/// Coupled parameter sets of every test run; the environment variable asks for more.
const SETS: u64 = 8;
const SETS_VARIABLE: &str = "WHEELRAIL_TEMPERATURE_SETS";
const STEPS: usize = 50;
/// Parameter sets of the heat model alone.
const HEAT_SETS: u64 = 40;

/// Groups of parameters that act on temperatures and leave the bases of the bodies alone.
const VARIED: [&str; 3] = ["thermal.", "friction.", "physics."];
const VARIED_MATERIAL: [&str; 7] = [
    "material.conductivity",
    "material.specific_heat",
    "material.expansion",
    "material.solidus",
    "material.liquidus",
    "material.latent_heat",
    "material.film_friction",
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

/// How many sets a test takes unless the environment says otherwise.
fn sets(usual: u64) -> u64 {
    std::env::var(SETS_VARIABLE).map_or(usual, |text| text.parse().unwrap())
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

/// True for a message that names a parameter or an input.
fn named(message: &str) -> bool {
    ["drive.", "mesh."].iter().any(|group| message.contains(group))
        || Config::rows().iter().any(|row| message.contains(row.name))
}

enum Outcome {
    Simulated,
    Refused(String),
    /// Where and by how much a bound is broken.
    Outside(String),
}

fn run(seed: u64) -> (Outcome, String) {
    let (config, mut random, text) = set(seed);
    let outcome = simulate(&config, &mut random);
    (outcome.unwrap_or_else(Outcome::Refused), text)
}

fn simulate(config: &Config, random: &mut Random) -> Result<Outcome, String> {
    let model = Model::prepare(config.clone(), &common::store(), &mut |_, _| {});
    let model = model.map_err(|error| failed_preparation(&error, config))?;
    let mut inputs = Inputs::rolling(config);
    (inputs.rotation, inputs.translation) = (Rotation::Velocity, Translation::Velocity);
    let mut simulation = Simulation::new(model, &inputs).map_err(|error| failed_start(&error, config, &inputs))?;
    let mut bounds = Bounds::new(config, &simulation);
    for step in 0..STEPS {
        let dt = random.logarithmic(1e-6, 1e-2);
        if random.below(8) == 0 {
            let other = config.thermal.reference + random.of(&[0.0, -100.0, -30.0, 30.0, 100.0]);
            inputs.drive.temperature = other.clamp(1.0, 1e4);
            bounds.join(inputs.drive.temperature);
        }
        let radius = config.wheel.radius;
        if random.below(8) == 0 {
            let speed = inputs.drive.velocity;
            inputs.drive.omega = random.of(&[0.0, speed, 1.1 * speed, 0.5 * speed, 0.99 * speed]) / radius;
            inputs.drive.tread_heat = random.of(&[0.0, 0.0, 45e3, 1e6]);
            inputs.drive.load = config.model.nominal_load * random.between(0.5, 1.0);
        }
        simulation.advance(&inputs, dt).map_err(|error| failed_step(&error, config))?;
        if let Some(broken) = bounds.broken(&simulation) {
            return Ok(Outcome::Outside(format!("step {step} of {dt:.2e} s: {broken}")));
        }
    }
    Ok(Outcome::Simulated)
}

/// Absolute temperatures between which a run must stay [K]: the whole bodies above the lower one, the contact below the
/// upper one. Brake blocks heat the tread as they are told to.
struct Bounds([f64; 2]);

impl Bounds {
    /// For a run that starts with `simulation`.
    fn new(config: &Config, simulation: &Simulation) -> Self {
        let (thermal, material) = (&config.thermal, &config.material);
        let coldest = thermal.reference + thermal.wheel_excess.min(0.0);
        // Reversible heating cools for real; then only absolute zero is the bound.
        let low = if config.physics.thermoelastic_heating { 0.0 } else { coldest - SLIGHT };
        let melts = material.latent_heat > 0.0 && thermal.reference < material.solidus && material.film_friction < 1.0;
        let liquidus = if melts { material.liquidus + OVERHEATING } else { f64::INFINITY };
        // The stationary start knows no melting.
        let hottest = thermal.reference + thermal.wheel_excess.max(0.0);
        Self([low, liquidus.max(hottest).max(hottest_contact(simulation))])
    }

    /// Takes the temperature of another source in \[K].
    fn join(&mut self, source: f64) {
        self.0 = [self.0[0].min(source - SLIGHT), self.0[1].max(source + SLIGHT)];
    }

    /// Faults of a state.
    fn broken(&self, simulation: &Simulation) -> Option<String> {
        let [low, high] = self.0;
        let fields = simulation.temperature_fields().unwrap();
        let nodes = fields.iter().flatten().flat_map(|field| &field.temperature);
        let (lowest, hottest) = (nodes.copied().fold(f64::INFINITY, f64::min), hottest_contact(simulation));
        let inside = lowest > 0.0 && lowest >= low && hottest <= high;
        (!inside).then(|| format!("{lowest} K to {hottest} K where {low} K to {high} K are the bounds"))
    }
}

/// Highest absolute temperature of the contact [K].
fn hottest_contact(simulation: &Simulation) -> f64 {
    let outputs = simulation.outputs();
    outputs.temperature_wheel_max.max(outputs.temperature_rail_max)
}

#[test]
fn temperatures_of_random_parameter_sets_stay_within_their_bounds_or_the_step_is_refused_by_name() {
    let sets = sets(SETS);
    let (mut simulated, mut wrong) = (0, Vec::new());
    for seed in 0..sets {
        match run(seed) {
            (Outcome::Simulated, _) => simulated += 1,
            (Outcome::Refused(why), _) if named(&why) => {}
            (Outcome::Refused(why), text) => wrong.push(format!("{seed}: unexplained: {why}{text}")),
            (Outcome::Outside(why), text) => wrong.push(format!("{seed}: {why}{text}")),
        }
    }
    println!("{simulated} of {sets} sets were simulated");
    assert!(wrong.is_empty(), "{} of {sets}:\n{}", wrong.len(), wrong.join("\n"));
    assert!(simulated >= sets / 4, "{simulated}");
}

/// A contact with random patch and friction heat that lies in the zone of the model.
fn exchange(c: &HeatParameters, random: &mut Random) -> Exchange {
    let half = c.half_width * random.between(0.3, 1.2).min(0.9 * c.zone / c.half_width);
    let centre = random.sign() * random.between(0.0, 0.9 * c.zone - half);
    let ellipse = |x: f64| (1.0 - ((x - centre) / half).powi(2)).max(0.0).sqrt();
    let power = random.of(&[0.0, 1e7, 1e9, 5e9]);
    let profile = |peak: f64| Piecewise::sampled(centre - half, centre + half, 40, |x| peak * ellipse(x));
    let heat = random.of(&[0.0, 0.0, 1e6]);
    Exchange {
        patches: vec![Interval { low: centre - half, high: centre + half }],
        friction_power: profile(power),
        friction_excess: random.between(-1.0, 3.0),
        sources: vec![HeatSource::on_tread(random.between(-PI, PI), 0.5, heat)],
        ..Exchange::default()
    }
}

#[test]
fn heat_model_keeps_random_runs_above_the_coldest_datum_and_keeps_their_heat() {
    let sets = sets(HEAT_SETS);
    let (mut wrong, mut completed, mut lowest) = (Vec::new(), 0, 0.0_f64);
    for seed in 0..sets {
        let (config, mut random, text) = set(seed);
        let (half_width, bulk) = (random.of(&[1e-3, 3e-3, 6e-3]), config.thermal.wheel_excess);
        let (contact_width, zone) = (config.model.contact_width, 1.5 * half_width);
        let parameters = heat_parameters(&config, half_width, zone, zone);
        let config = HeatParameters { contact_width, elements_per_half_width: 4, ..parameters };
        let Ok(heat) = Heat::new(&config) else { continue };
        let (mut state, mut scratch, mut speed) = (heat.initial(bulk, 0.0), HeatScratch::default(), 30.0);
        let mut acting = exchange(&config, &mut random);
        let mut omega = speed / config.radius;
        for step in 0..STEPS {
            if random.below(5) == 0 {
                acting = exchange(&config, &mut random);
                speed = random.sign() * random.of(&[0.0, 1e-3, 1.0, 20.0, 60.0]);
                omega = random.of(&[0.0, 0.9, 1.0, 1.2]) * speed / config.radius;
            }
            let dt = random.logarithmic(1e-6, 1e-1);
            let mut next = HeatState::default();
            let mut line = [HeatLine::new(&state, &mut next, &acting)];
            let flows = match heat.step(&mut line, dt, speed, omega, &mut scratch).map(|()| line[0].flows) {
                Ok(flows) => flows,
                Err(error) if named(&error.to_string()) => break,
                Err(error) => {
                    wrong.push(format!("{seed}, step {step}: {error}{text}"));
                    break;
                }
            };
            // Lifted heat is taken elsewhere: heat contents grow by what is stored.
            let [before, after] = [&state, &next].map(|state| heat.heat_content(state).unwrap());
            let stored = [flows.stored_wheel, flows.stored_rail].map(|flow| dt * flow);
            let error = |i: usize| (after[i] - before[i] - stored[i]).abs() / (1.0 + after[i].abs() + before[i].abs());
            let balance = error(0).max(error(1));
            state = next;
            if step % 5 != 4 {
                continue;
            }
            let fields = heat.fields(&state).unwrap();
            let coldest = fields.iter().flat_map(|f| &f.temperature).fold(f64::INFINITY, |low, &t| low.min(t));
            lowest = lowest.min(coldest - bulk.min(0.0));
            completed += usize::from(step == STEPS - 1);
            if coldest.is_nan() || coldest < bulk.min(0.0) - SLIGHT || balance > 1e-8 || balance.is_nan() {
                wrong.push(format!("{seed}, step {step} of {dt:.1e} s: {coldest} K, balance {balance:.1e}{text}"));
                break;
            }
        }
        assert!(heat.observed(&state).lowest.is_finite());
    }
    println!("{completed} of {sets} runs were completed; at most {lowest:.3} K below the coldest datum");
    assert!(wrong.is_empty(), "{} of {sets}:\n{}", wrong.len(), wrong.join("\n"));
    assert!(completed >= sets as usize / 2, "{completed}");
}

/// Runs `steps` steps of `dt` seconds within the bounds of temperature, or until one is refused by name; how many were
/// taken.
fn watched(config: Config, change: impl Fn(&mut Inputs), steps: usize, dt: f64) -> usize {
    watched_within(config, 0.0, change, steps, dt)
}

/// Run with temperatures up to `highest` \[K] allowed, where that is more than the bounds allow.
fn watched_within(config: Config, highest: f64, change: impl Fn(&mut Inputs), steps: usize, dt: f64) -> usize {
    let model = common::model(config.clone());
    let mut inputs = Inputs::rolling(&config);
    let mut simulation = match Simulation::new(model, &inputs) {
        Ok(simulation) => simulation,
        Err(error) => {
            let message = failed_start(&error, &config, &inputs);
            assert!(named(&message), "{message}");
            println!("start: {message}");
            return 0;
        }
    };
    let mut bounds = Bounds::new(&config, &simulation);
    bounds.0[1] = bounds.0[1].max(highest);
    change(&mut inputs);
    for step in 0..steps {
        if let Err(error) = simulation.advance(&inputs, dt) {
            let message = failed_step(&error, &config);
            assert!(named(&message), "{message}");
            println!("step {step}: {message}");
            return step;
        }
        assert_eq!(bounds.broken(&simulation), None, "step {step}");
    }
    println!("{steps} steps of {dt} s, contact at last {:.1} K", hottest_contact(&simulation));
    steps
}

/// A wheel that locks at once.
fn locked(inputs: &mut Inputs) {
    (inputs.rotation, inputs.translation) = (Rotation::Velocity, Translation::Velocity);
    inputs.drive.omega = 0.0;
}

/// Values inside the declared ranges that once led to −7.4e8 K under error control.
#[rustfmt::skip]
const ONCE_UNPHYSICAL: [(&str, Value); 29] = [
    ("wheel.hub_mass", Value::Real(19991.98310772364)),
    ("wheel.hub_inertia", Value::Real(4.021364887751837)),
    ("vehicle.mass", Value::Real(1000000000.0)),
    ("friction.coefficient", Value::Real(0.0013702356508097093)),
    ("material.expansion", Value::Real(0.0)),
    ("material.conductivity", Value::Real(0.8651489509439562)),
    ("material.specific_heat", Value::Real(3536.9992523768774)),
    ("friction.falling_ratio", Value::Real(1.0)),
    ("friction.falling_decay", Value::Real(6.334398869080201)),
    ("friction.softening", Value::Real(0.023227635531237842)),
    ("friction.softening_floor", Value::Real(0.5226465173500937)),
    ("thermal.enabled", Value::Boolean(true)),
    ("thermal.reference", Value::Real(2050.11177212302)),
    ("thermal.wheel_excess", Value::Real(-1000.0)),
    ("thermal.conductance", Value::Real(953533339900.4451)),
    ("thermal.heat_ratio", Value::Real(0.5001459173453247)),
    ("thermal.hub", Value::Integer(1)),
    ("thermal.convection", Value::Real(15.816949561325892)),
    ("thermal.max_speed", Value::Real(17.615534848864463)),
    ("thermal.smallest_load_ratio", Value::Real(0.15423840704681732)),
    ("thermal.tread_angle", Value::Real(-2.886074660945239)),
    ("thermal.tread_width", Value::Real(0.11728512647814232)),
    ("thermal.tread_blocks", Value::Integer(2)),
    ("thermal.austenitisation", Value::Real(105.14662002887738)),
    ("physics.thermoelastic_heating", Value::Boolean(false)),
    ("solver.max_step", Value::Real(0.07512109154422084)),
    ("solver.tolerance", Value::Real(0.011606516610588783)),
    ("initial.velocity", Value::Real(47.22406652459799)),
    ("initial.creepage", Value::Real(2.0)),
];

#[test]
fn the_parameter_set_that_once_fell_far_below_absolute_zero_keeps_its_bounds_or_is_refused_by_name() {
    // Where steel yields, it is too soft at 2050 K to start at all.
    for (tolerance, yielding) in [(None, true), (None, false), (Some(0.0), false)] {
        let mut config = common::preset("railway", 10);
        for row in Config::rows() {
            if let Some((_, value)) = ONCE_UNPHYSICAL.iter().find(|(name, _)| *name == row.name) {
                (row.write)(&mut config, value);
            }
        }
        (config.thermal.wheel_share, config.physics.centrifugal) = (0.0, false);
        config.physics.yielding = yielding;
        config.tuning.tolerance = tolerance.unwrap_or(config.tuning.tolerance);
        let moment = |inputs: &mut Inputs| inputs.drive.moment = -18893.015878717044;
        watched(config, moment, 20, 3e-3);
    }
}

#[test]
fn a_nearly_perfect_conductance_in_a_locked_slide_cools_nothing_below_the_coldest_datum_at_any_step() {
    // Shear waves need 0.14 ms from the hub to the tread.
    for (steps, dt) in [(30, 1e-3), (400, 1e-6)] {
        let mut config = common::preset("railway", 10);
        (config.thermal.conductance, config.initial.velocity) = (1e12, 20.0);
        assert_eq!(watched(config, locked, steps, dt), steps);
    }
}

#[test]
fn friction_that_does_not_soften_melts_the_contact_and_heats_it_no_further_at_any_step() {
    for (steps, dt) in [(150, 1e-3), (300, 2e-4), (800, 5e-5)] {
        let mut config = common::preset("railway", 6);
        (config.tuning.softening, config.initial.velocity) = (0.0, 60.0 / 3.6);
        let dry = |inputs: &mut Inputs| {
            locked(inputs);
            inputs.drive.friction = 0.4;
        };
        assert_eq!(watched(config, dry, steps, dt), steps);
    }
}

/// Cold, hot and very hot wheels, slow and fast, coarse and fine: a stationary start chills the tread in passing, and
/// no point becomes colder than its datum.
#[test]
fn wheels_of_any_temperature_below_the_solidus_start_within_the_bounds_and_roll_or_are_refused_by_name() {
    let mut refused = Vec::new();
    for (elements, excess, velocity) in [
        (10, -250.0, 55.0),
        (20, -250.0, 1.0),
        (10, 500.0, 20.0),
        (20, 500.0, 55.0),
        (10, 800.0, 20.0),
        (20, 900.0, 5.0),
        (10, 1000.0, 20.0),
        (10, 1000.0, 1.0),
        (20, 1100.0, 55.0),
        (10, 1300.0, 5.0),
    ] {
        let mut config = common::preset("railway", elements);
        (config.thermal.wheel_excess, config.initial.velocity) = (excess, velocity);
        config.initial.temperature = StartTemperature::Stationary;
        let inputs = Inputs::rolling(&config);
        let simulation = match Simulation::new(common::model(config.clone()), &inputs) {
            Err(StepError::Softened { .. }) => {
                refused.push(excess);
                continue;
            }
            started => started.unwrap(),
        };
        assert_eq!(Bounds::new(&config, &simulation).broken(&simulation), None, "{excess} K at {velocity} m/s");
        // The rail halves the difference where it meets the tread: bodies of one steel share their contact temperature.
        let rail = simulation.outputs().temperature_rail_max - config.thermal.reference;
        assert!(excess < 0.0 || (0.4..0.65).contains(&(rail / excess)), "{rail} K of {excess} K");
        assert!(watched(config, |_| (), 3, 1e-3) > 0);
    }
    println!("refused at {refused:?} K");
    assert!(refused.len() <= 1 && refused.iter().all(|excess| *excess >= 1000.0), "{refused:?}");
}

#[test]
fn wheels_that_start_hot_lock_within_the_bounds_or_are_refused_by_name_and_molten_ones_are_refused_as_such() {
    let mut config = common::preset("railway", 10);
    (config.thermal.wheel_excess, config.initial.velocity) = (500.0, 20.0);
    assert_eq!(watched(config.clone(), locked, 20, 1e-3), 20);
    for excess in [1000.0, 1500.0] {
        config.thermal.wheel_excess = excess;
        watched(config.clone(), locked, 20, 1e-3);
    }
    config.thermal.wheel_excess = 5000.0;
    let refusal = config.validate().unwrap_err().to_string();
    assert!(refusal.contains("thermal.wheel_excess = 5000 ") && refusal.contains("material.liquidus"), "{refusal}");
}

#[test]
fn reversible_cooling_ends_above_absolute_zero_or_is_refused_by_name() {
    for expansion in [1.2e-5, 4.8e-4] {
        let mut config = common::preset("railway", 10);
        config.physics.thermoelastic_heating = true;
        (config.material.expansion, config.initial.velocity) = (expansion, 20.0);
        for dt in [1e-3, 1e-5] {
            let taken = watched(config.clone(), locked, 30, dt);
            // Steel as it is never comes near the bound.
            assert!(expansion > 1e-4 || taken == 30, "{taken}");
        }
    }
}
