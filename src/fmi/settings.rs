//! What a master has set, laid over what follows without it.

use super::presets;
use super::variable::{Reference, Value, Variable};
use super::variables::find;
use crate::config::{Config, Given};
use crate::simulation::{Drive, Inputs};
use std::collections::BTreeMap;

/// Set values by value reference.
pub type SetValues = BTreeMap<Reference, Value>;

/// Start value of an input or parameter that the description declares, that of the default preset; `None` for outputs.
pub fn start_value(variable: &Variable) -> Option<Value> {
    of_preset(variable, &Config::default())
}

/// Value of a parameter, or of an input that follows from the parameters, under `config`.
pub fn of_preset(variable: &Variable, config: &Config) -> Option<Value> {
    let parameter = variable.parameter(presets::DEFAULT, config);
    parameter.or_else(|| variable.input(&mut Inputs::rolling(config)))
}

/// The configuration `base` with what the experiment asks for and, above it, explicit parameters. Those that say what `base`
/// says anyway count only if `initial.given` is `written`: a creepage that is not sought, the tolerance of the experiment.
pub fn with_parameters(base: &Config, experiment: &SetValues, parameters: &SetValues) -> Config {
    let mut config = base.clone();
    let write = |config: &mut Config, (reference, value): (&Reference, &Value)| {
        if let Some(variable) = find(*reference) {
            variable.set_parameter(config, value);
        }
    };
    parameters.iter().for_each(|set| write(&mut config, set));
    let all = config.initial.given == Given::Written;
    config.clone_from(base);
    let says_more = |(reference, value): &(&Reference, &Value)| {
        all || find(**reference).is_none_or(|row| row.parameter("", base).as_ref() != Some(*value))
    };
    experiment.iter().chain(parameters.iter().filter(says_more)).for_each(|set| write(&mut config, set));
    config
}

/// Whether an input that is written with `value` says no more than the declared start does, which the preset `base` leaves as
/// it is.
pub fn is_start(variable: &Variable, value: &Value, base: &Config) -> bool {
    [start_value(variable), of_preset(variable, base)].iter().all(|start| start.as_ref() == Some(value))
}

/// The inputs that follow from the configuration, overridden by those taken over when a control was switched and by
/// explicit ones, with their time derivatives.
pub fn with_inputs(config: &Config, bumpless: &SetValues, explicit: &SetValues, rate: Drive) -> Inputs {
    let mut inputs = Inputs::rolling(config);
    for (reference, value) in bumpless.iter().chain(explicit) {
        if let Some(variable) = find(*reference) {
            variable.set_input(&mut inputs, value);
        }
    }
    Inputs { rate, ..inputs }
}
