//! Values that a master has set, laid over those that hold without it.

use super::presets;
use super::table::{find, named, table};
use super::variable::{Access, Causality, Reference, Value, Variable};
use crate::config::Config;
use crate::simulation::{Drive, Inputs, RAMP_NUMBERS};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::path::Path;

/// Set values by value reference.
pub type SetValues = BTreeMap<Reference, Value>;

/// Parameter that the tolerance of an experiment sets.
pub const TOLERANCE: &str = "solver.tolerance";

/// Start value of an input or parameter that the description declares, that of the default preset; `None` for outputs.
pub fn start_value(variable: &Variable) -> Option<Value> {
    of_preset(variable, &Config::default())
}

/// Value of a parameter, or of an input that follows from the parameters, under `config`.
pub fn of_preset(variable: &Variable, config: &Config) -> Option<Value> {
    let parameter = variable.parameter(presets::DEFAULT, config);
    parameter.or_else(|| variable.input(&mut Inputs::rolling(config)))
}

/// True if an input that is written with `value` says no more than the declared start does, which the preset `base`
/// leaves as it is.
fn is_start(variable: &Variable, value: &Value, base: &Config) -> bool {
    [start_value(variable), of_preset(variable, base)].iter().all(|start| start.as_ref() == Some(value))
}

/// Everything that a master has set.
#[derive(Clone, Serialize, Deserialize)]
pub struct Settings {
    /// Name of the preset.
    pub preset: String,
    /// Parameters of the preset before explicit ones override them.
    pub base: Config,
    /// Parameters that follow from `fmi2SetupExperiment` and override the preset.
    pub experiment: SetValues,
    /// Explicitly set parameters, which override both.
    pub parameters: SetValues,
    /// Explicitly set inputs; the others follow from the parameters.
    pub inputs: SetValues,
    /// Present values that inputs took over when a control was switched to them; explicit ones override them.
    pub bumpless: SetValues,
    /// Time derivatives of the inputs during the next step, besides those that are inputs themselves.
    pub rates: Drive,
}

impl Settings {
    /// Settings of a master that has set nothing.
    pub fn new(resources: Option<&Path>) -> Result<Settings, String> {
        Ok(Settings {
            preset: presets::DEFAULT.to_owned(),
            base: presets::load(resources, presets::DEFAULT)?,
            experiment: SetValues::new(),
            parameters: SetValues::new(),
            inputs: SetValues::new(),
            bumpless: SetValues::new(),
            rates: Drive::default(),
        })
    }

    /// The preset with what the experiment asks for and, above it, explicit parameters. Those that say what the preset
    /// says anyway count only if `initial.given` is `written`: a creepage that is not sought, the tolerance of the
    /// experiment.
    pub fn config(&self) -> Config {
        let mut config = self.base.clone();
        let write = |config: &mut Config, (reference, value): (&Reference, &Value)| {
            if let Some(variable) = find(*reference) {
                variable.set_parameter(config, value);
            }
        };
        self.parameters.iter().for_each(|set| write(&mut config, set));
        let all = config.initial.given.counts_start_values();
        config.clone_from(&self.base);
        let says_more = |(reference, value): &(&Reference, &Value)| {
            all || find(**reference).is_none_or(|row| row.parameter("", &self.base).as_ref() != Some(*value))
        };
        let parameters = self.parameters.iter().filter(says_more);
        self.experiment.iter().chain(parameters).for_each(|set| write(&mut config, set));
        config
    }

    /// The inputs that count under `config`: all that are set; of those set before the end of initialization (`early`)
    /// only what says more than the declared start values do, unless `initial.given` is `written`.
    pub fn given(&self, config: &Config, early: bool) -> Cow<'_, SetValues> {
        if !early || config.initial.given.counts_start_values() {
            return Cow::Borrowed(&self.inputs);
        }
        let mut given = self.inputs.clone();
        given.retain(|reference, value| find(*reference).is_some_and(|row| !is_start(row, value, &self.base)));
        Cow::Owned(given)
    }

    /// The inputs that follow from `config`, overridden by those taken over when a control was switched and by those
    /// that count, with their time derivatives.
    pub fn inputs(&self, config: &Config, early: bool) -> Inputs {
        let mut inputs = Inputs::rolling(config);
        for (reference, value) in self.bumpless.iter().chain(self.given(config, early).iter()) {
            if let Some(variable) = find(*reference) {
                variable.set_input(&mut inputs, value);
            }
        }
        // One of both is zero.
        Inputs { rate: inputs.rate.zip(&self.rates, |ramp, derivative| ramp + derivative), ..inputs }
    }

    /// Sets one variable, within its own range and, after the end of initialization, only what may change then.
    pub fn set(&mut self, row: &Variable, value: Value, early: bool, resources: Option<&Path>) -> Result<(), String> {
        match row.causality() {
            Causality::Output => return Err(format!("{} is an output and cannot be set", row.name)),
            Causality::Parameter if !early && !row.tunable => {
                let why = "is a fixed parameter and can only be set before the end of initialization";
                return Err(format!("{} {why}{}", row.name, replacement(row.name)));
            }
            _ => row.check(&value)?,
        }
        match (row.access, value) {
            (Access::Preset, Value::String(name)) => {
                self.base = presets::load(resources, &name)?;
                self.preset = name;
            }
            (Access::RealInput(field), value) => {
                *field(&mut self.rates) = 0.0;
                self.inputs.insert(row.reference, value);
            }
            (Access::Ramp(field), Value::Real(ramp)) if ramp != 0.0 && *field(&mut self.rates) != 0.0 => {
                let why = "has been given to the next step by a derivative of its input: give one of both";
                return Err(format!("{} {why}", row.name));
            }
            (Access::Ramp(_) | Access::ChoiceInput(..), value) => drop(self.inputs.insert(row.reference, value)),
            (_, value) => {
                self.parameters.insert(row.reference, value);
                if !early {
                    self.experiment.remove(&row.reference);
                }
            }
        }
        Ok(())
    }

    /// Name of the input that gives the time derivative of a real input, if it is set to other than zero.
    pub fn ramp_of(&self, input: &Variable) -> Option<&'static str> {
        let ramp = find(input.reference + RAMP_NUMBERS).filter(|row| matches!(row.access, Access::Ramp(_)))?;
        let value = self.inputs.get(&ramp.reference)?;
        (*value != Value::Real(0.0)).then_some(ramp.name)
    }

    /// Keeps the values at the end of ramps as the new inputs; derivatives that are no inputs themselves go.
    pub fn hold(&mut self, mut rates: Drive, mut end: Drive) {
        if rates == Drive::default() {
            return;
        }
        for variable in table() {
            if let Access::RealInput(field) = variable.access
                && *field(&mut rates) != 0.0
            {
                self.inputs.insert(variable.reference, Value::Real(*field(&mut end)));
            }
        }
        self.rates = Drive::default();
    }

    /// The tolerance that holds under `config`, and its source.
    pub fn tolerance_in_use(&self, config: &Config) -> String {
        let tolerance = config.tuning.tolerance;
        let is_in = |values: &SetValues| named(TOLERANCE).is_some_and(|row| values.contains_key(&row.reference));
        let source = if is_in(&self.parameters) {
            "as set".to_owned()
        } else if is_in(&self.experiment) {
            "as the experiment asks".to_owned()
        } else {
            format!("of preset \"{}\"", self.preset)
        };
        format!("{TOLERANCE} = {tolerance:?} {source}")
    }
}

/// Hint at the input that changes during a run what a parameter gives at its start; empty where there is none.
fn replacement(parameter: &str) -> String {
    let input = match parameter {
        "friction.coefficient" => "rail.friction",
        "thermal.reference" => "rail.temperature",
        "model.nominal_load" => "drive.load",
        "initial.velocity" => "drive.velocity",
        _ => return String::new(),
    };
    format!("; during the run set the input {input}")
}
