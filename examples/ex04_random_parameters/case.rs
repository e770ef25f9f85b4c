//! One random parameter set, random inputs and a few steps, through the slave behind the C functions.

use super::random::Random;
use std::path::PathBuf;
use std::sync::{Arc, Mutex};
use wheelrail::fmi::instance::Instance;
use wheelrail::fmi::log::{CallError, Log, Status};
use wheelrail::fmi::presets;
use wheelrail::fmi::v2::access::type_of;
use wheelrail::fmi::v2::variables::variables;
use wheelrail::fmi::variable::{Access, Causality, Kind, Value, Variable};

/// Communication steps of a case.
const STEPS: usize = 5;
/// Temperature below the coldest source that counts as none \[K], and the same relative to the span of the sources
/// \[1].
const COLDER: f64 = 0.1;
const COLDER_SHARE: f64 = 0.005;
/// Residual of the energy balance beyond which a warning has to say why \[1].
const UNBALANCED: f64 = 0.05;
/// Names in messages that belong to arguments of calls instead of variables.
const ARGUMENTS: [&str; 2] = ["communicationStepSize", "currentCommunicationPoint"];

/// How a case ended; the text is what the slave said or which value was wrong.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// All steps were computed, all outputs finite and within their declared ranges.
    Simulated,
    /// A call was refused with a message that names a variable.
    Refused(String),
    /// A step was discarded with a message that names a variable.
    Discarded(String),
    /// A refusal or a discarded step whose message names no variable.
    Unexplained(String),
    /// An output that is not finite, outside its declared range or colder than every source, or energy that is missing
    /// without a warning, although its call succeeded.
    Wrong(String),
}

impl Verdict {
    /// True where the slave behaved as the model description promises.
    pub fn acceptable(&self) -> bool {
        !matches!(self, Verdict::Unexplained(_) | Verdict::Wrong(_))
    }
}

/// A parameter set with inputs and a step.
#[derive(Clone)]
pub struct Case {
    preset: String,
    values: Vec<(&'static Variable, Value)>,
    /// Communication step [s].
    step: f64,
}

impl Case {
    /// The case that belongs to a seed: a preset, on a coarse mesh with few modes (a fine one takes seconds to
    /// prepare), with some or all of its parameters and inputs replaced by values from their declared ranges. In most
    /// cases the lengths fit each other and nothing is lateral, or nearly every set would be refused.
    pub fn new(seed: u64) -> Self {
        let mut random = Random(seed);
        let presets = presets::available(Some(&resources()));
        let preset = presets[random.below(presets.len())].clone();
        let (share, input_share) = (random.of(&[0.03, 0.1, 0.3, 1.0]), random.of(&[0.0, 0.2, 0.5]));
        let coarse = random.between(0.0, 1.0) < 0.95;
        let plane = !seed.is_multiple_of(8);
        let lateral = |name: &str| {
            ["contact.lateral", "drive.spin", "drive.contact_angle"].contains(&name)
                || name.starts_with("drive.lateral")
        };
        let mut values = Vec::new();
        for variable in variables() {
            let changed = random.between(0.0, 1.0);
            let chosen = match variable.causality() {
                _ if matches!(variable.access, Access::Preset) => None,
                Causality::Output => None,
                _ if plane && lateral(variable.name) => None,
                Causality::Parameter if coarse && variable.name == "mesh.elements_per_half_width" => {
                    Some(Value::Integer(4 + random.below(5) as i32))
                }
                Causality::Parameter => (changed < share).then(|| draw(variable, &mut random)),
                Causality::Input => (changed < input_share).then(|| draw(variable, &mut random)),
            };
            values.extend(chosen.map(|value| (variable, value)));
        }
        if random.below(5) > 0 {
            fit_lengths(&mut values, &mut random);
        }
        Case { preset, values, step: random.logarithmic(1e-5, 0.1) }
    }

    /// Sets, initializes, steps and looks at every output after each of them.
    pub fn run(&self) -> Verdict {
        match self.simulate() {
            Ok(None) => Verdict::Simulated,
            Ok(Some(wrong)) => Verdict::Wrong(wrong),
            Err(refusal) => {
                let text = refusal.message;
                match refusal.status {
                    _ if !named(&text) => Verdict::Unexplained(text),
                    Status::Discard => Verdict::Discarded(text),
                    _ => Verdict::Refused(text),
                }
            }
        }
    }

    fn simulate(&self) -> Result<Option<String>, CallError> {
        let warnings = Arc::new(Mutex::new(String::new()));
        let heard = warnings.clone();
        let listen = move |_, _: &str, text: &str| {
            if let Ok(mut heard) = heard.lock() {
                *heard += text;
            }
        };
        let mut instance = Instance::new(Some(resources()), Log::new(Box::new(listen), true))?;
        let row = variables().iter().find(|v| matches!(v.access, Access::Preset)).map(|v| v.reference);
        instance.set(row.as_slice(), vec![Value::String(self.preset.clone())])?;
        for (variable, value) in &self.values {
            instance.set(&[variable.reference], vec![value.clone()])?;
        }
        instance.setup_experiment(None, 0.0, None)?;
        instance.enter_initialization()?;
        instance.exit_initialization()?;
        let coldest = self.coldest(&mut instance)?;
        let explained = || warnings.lock().is_ok_and(|text| text.contains("solver.energy_residual"));
        for k in 0..=STEPS {
            let time = k as f64 * self.step;
            if k > 0 {
                instance.do_step(time - self.step, self.step)?;
            }
            let wrong = match outside(&mut instance)? {
                None => too_cold(&mut instance, coldest)?,
                found => found,
            };
            let wrong = match wrong {
                None => unbalanced(&mut instance)?.filter(|_| !explained()),
                found => found,
            };
            if let Some(wrong) = wrong {
                return Ok(Some(format!("t = {time:.3e} s: {wrong}")));
            }
        }
        Ok(None)
    }

    /// Temperature below which nothing may fall \[K]: that of the coldest source. Without heat, with reversible cooling
    /// or with brake blocks that cool there is none.
    fn coldest(&self, instance: &mut Instance) -> Result<f64, CallError> {
        let reversible = matches!(one(instance, "physics.thermoelastic_heating")?, Value::Boolean(true));
        let enabled = matches!(one(instance, "thermal.enabled")?, Value::Boolean(true));
        if !enabled || reversible || real(instance, "drive.tread_heat")? < 0.0 {
            return Ok(f64::NEG_INFINITY);
        }
        let reference = real(instance, "thermal.reference")?;
        let sources =
            [reference, reference + real(instance, "thermal.wheel_excess")?, real(instance, "rail.temperature")?];
        let [low, high] = sources.iter().fold([f64::MAX, f64::MIN], |[low, high], t| [low.min(*t), high.max(*t)]);
        Ok(low - COLDER.max(COLDER_SHARE * (high - low)))
    }
}

impl std::fmt::Display for Case {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        write!(f, "preset {}, step {:e} s", self.preset, self.step)?;
        self.values.iter().try_for_each(|(variable, value)| match value {
            Value::Real(v) => write!(f, ", {} {v:e}", variable.name),
            Value::Integer(v) => write!(f, ", {} {v}", variable.name),
            Value::Boolean(v) => write!(f, ", {} {v}", variable.name),
            Value::String(v) => write!(f, ", {} {v}", variable.name),
            Value::Reals(v) => write!(f, ", {} {v:?}", variable.name),
        })
    }
}

/// Directory of the presets.
fn resources() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("resources")
}

/// A value from the declared range: an end of it, uniform, or uniform in the logarithm.
fn draw(variable: &Variable, random: &mut Random) -> Value {
    match variable.kind {
        Kind::Real { min, max, .. } => {
            let small = 1e-9 * max.abs().max(min.abs());
            Value::Real(match random.below(6) {
                0 => random.of(&[min, max]),
                1 | 2 => random.between(min, max),
                _ if min > 0.0 => random.logarithmic(min, max).clamp(min, max),
                _ if min == 0.0 => random.logarithmic(small, max).min(max),
                _ => (random.sign() * random.logarithmic(small, max.abs().max(min.abs()))).clamp(min, max),
            })
        }
        Kind::Integer { min, max } => Value::Integer(min + random.below((max - min + 1) as usize) as i32),
        Kind::Enumeration(list) => Value::Integer(1 + random.below(list.items.len()) as i32),
        Kind::Boolean => Value::Boolean(random.below(2) == 0),
        Kind::String => Value::String(String::new()),
    }
}

/// Replaces hub radius and rail dimensions, where they were drawn with a wheel radius, by some that fit it.
fn fit_lengths(values: &mut [(&'static Variable, Value)], random: &mut Random) {
    let Some(Value::Real(radius)) = values.iter().find(|v| v.0.name == "wheel.radius").map(|v| v.1.clone()) else {
        return;
    };
    for (variable, value) in values {
        let share = match variable.name {
            "wheel.hub_radius" => random.between(0.02, 0.9),
            "rail.length" => random.logarithmic(0.2, 5.0),
            "rail.height" => random.logarithmic(0.02, 1.0),
            _ => continue,
        };
        if let Kind::Real { min, max, .. } = variable.kind {
            *value = Value::Real((share * radius).clamp(min, max));
        }
    }
}

/// The first output that is not finite or outside its declared range.
fn outside(instance: &mut Instance) -> Result<Option<String>, CallError> {
    for variable in variables().iter().filter(|v| v.causality() == Causality::Output) {
        for value in instance.get(&[variable.reference], type_of(variable.kind))? {
            if let Err(why) = variable.check(&value) {
                return Ok(Some(why.to_string()));
            }
        }
    }
    Ok(None)
}

/// The first temperature of a surface that is below `coldest` \[K].
fn too_cold(instance: &mut Instance, coldest: f64) -> Result<Option<String>, CallError> {
    let surface = |name: &str| name.starts_with("temperature.") || name.starts_with("profile.temperature");
    for variable in variables().iter().filter(|v| v.causality() == Causality::Output && surface(v.name)) {
        for value in instance.get(&[variable.reference], type_of(variable.kind))? {
            let lowest = match value {
                Value::Real(value) => value,
                Value::Reals(values) => values.into_iter().fold(f64::MAX, f64::min),
                _ => continue,
            };
            if lowest < coldest {
                return Ok(Some(format!("{} = {lowest} K, where nothing may be below {coldest} K", variable.name)));
            }
        }
    }
    Ok(None)
}

/// Energy that is missing in the balance.
fn unbalanced(instance: &mut Instance) -> Result<Option<String>, CallError> {
    let residual = real(instance, "solver.energy_residual")?;
    Ok((residual.abs() > UNBALANCED).then(|| format!("solver.energy_residual = {residual} without a warning")))
}

/// Value of a variable with one entry.
fn one(instance: &mut Instance, name: &str) -> Result<Value, CallError> {
    let row = variables().iter().find(|variable| variable.name == name).expect("a variable of this name");
    let values = instance.get(&[row.reference], type_of(row.kind))?;
    Ok(values.into_iter().next().expect("one value"))
}

/// Value of a real variable.
fn real(instance: &mut Instance, name: &str) -> Result<f64, CallError> {
    match one(instance, name)? {
        Value::Real(value) => Ok(value),
        other => panic!("{name} is {other:?}"),
    }
}

/// True for a message that names a variable of the interface or an argument of the call.
fn named(message: &str) -> bool {
    let mut names = variables().iter().map(|v| v.name).chain(ARGUMENTS);
    names.any(|name| message.contains(name))
}
