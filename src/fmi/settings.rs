//! What a master has set, laid over what follows without it.

use super::variable::{Reference, Value};
use super::variables::find;
use crate::config::Config;
use crate::simulation::{Drive, Inputs};
use std::collections::BTreeMap;

/// Set values by value reference.
pub type SetValues = BTreeMap<Reference, Value>;

/// The configuration `base` with what the experiment asks for and, above it, explicit parameters.
pub fn with_parameters(base: &Config, experiment: &SetValues, parameters: &SetValues) -> Config {
    let mut config = base.clone();
    for (reference, value) in experiment.iter().chain(parameters) {
        if let Some(variable) = find(*reference) {
            variable.set_parameter(&mut config, value);
        }
    }
    config
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
