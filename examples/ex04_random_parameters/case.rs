//! One random parameter set, random inputs and a few steps, through the slave behind the C functions.

use crate::random::Random;
use std::path::PathBuf;
use wheelrail::fmi::instance::Instance;
use wheelrail::fmi::log::{CallError, Log, Status};
use wheelrail::fmi::presets;
use wheelrail::fmi::variable::{Access, Causality, Kind, Value, Variable};
use wheelrail::fmi::variables::variables;

/// Communication steps of a case.
const STEPS: usize = 5;
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
    /// An output that is not finite or outside its declared range, although its call succeeded.
    Wrong(String),
}

impl Verdict {
    /// Whether the slave behaved as the model description promises.
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
    /// cases the lengths fit each other, or nearly every set would be refused for its geometry.
    pub fn new(seed: u64) -> Self {
        let mut random = Random(seed);
        let presets = presets::available(Some(&resources()));
        let preset = presets[random.below(presets.len())].clone();
        let (share, input_share) = (random.of(&[0.03, 0.1, 0.3, 1.0]), random.of(&[0.0, 0.2, 0.5]));
        let coarse = random.between(0.0, 1.0) < 0.95;
        let mut values = Vec::new();
        for variable in variables() {
            let changed = random.between(0.0, 1.0);
            let size = ["mesh.elements_per_half_width", "solver.modes_wheel", "solver.modes_rail"];
            let chosen = match variable.causality() {
                _ if matches!(variable.access, Access::Preset) => None,
                Causality::Output => None,
                Causality::Parameter if coarse && size.contains(&variable.name) => {
                    Some(Value::Integer(4 + random.below(5) as i32))
                }
                Causality::Parameter if variable.name == "solver.response" && coarse => Some(Value::Integer(1)),
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
        let silent = Log::new(Box::new(|_, _, _| {}), false);
        let mut instance = Instance::new(Some(resources()), silent)?;
        let row = variables().iter().find(|v| matches!(v.access, Access::Preset)).map(|v| v.reference);
        instance.set(row.as_slice(), vec![Value::String(self.preset.clone())])?;
        for (variable, value) in &self.values {
            instance.set(&[variable.reference], vec![value.clone()])?;
        }
        instance.setup_experiment(None, 0.0, None)?;
        instance.enter_initialization()?;
        instance.exit_initialization()?;
        let mut wrong = outside(&mut instance, 0.0)?;
        for k in 0..STEPS {
            if wrong.is_none() {
                instance.do_step(k as f64 * self.step, self.step)?;
                wrong = outside(&mut instance, (k + 1) as f64 * self.step)?;
            }
        }
        Ok(wrong)
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
fn outside(instance: &mut Instance, time: f64) -> Result<Option<String>, CallError> {
    for variable in variables().iter().filter(|v| v.causality() == Causality::Output) {
        for value in instance.get(&[variable.reference], variable.kind.type_name())? {
            if let Err(why) = variable.check(&value) {
                return Ok(Some(format!("t = {time:.3e} s: {why}")));
            }
        }
    }
    Ok(None)
}

/// Whether a message names a variable of the interface or an argument of the call.
fn named(message: &str) -> bool {
    let mut names = variables().iter().map(|v| v.name).chain(ARGUMENTS);
    names.any(|name| message.contains(name))
}
