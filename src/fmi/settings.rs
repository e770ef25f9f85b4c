//! What a master has set, laid over what follows without it.

use super::variable::{Access, Kind, Reference, Value};
use super::variables::{find, variables};
use crate::config::Config;
use crate::simulation::{Drive, Inputs};
use std::collections::BTreeMap;

/// Explicitly set values by value reference.
pub type Explicit = BTreeMap<Reference, Value>;

/// The configuration `base` with explicit parameters.
pub fn with_parameters(base: &Config, parameters: &Explicit) -> Config {
    let mut config = base.clone();
    for (reference, value) in parameters {
        if let Some(variable) = find(*reference) {
            variable.set_parameter(&mut config, value);
        }
    }
    config
}

/// The inputs that follow from the configuration, with explicit ones and their time derivatives.
pub fn with_inputs(config: &Config, explicit: &Explicit, rate: Drive) -> Inputs {
    let mut inputs = Inputs::rolling(config);
    for (reference, value) in explicit {
        if let Some(variable) = find(*reference) {
            variable.set_input(&mut inputs, value);
        }
    }
    Inputs { rate, ..inputs }
}

/// Inputs after a time `h` [s], at rest there.
pub fn ramp_end(inputs: &Inputs, h: f64) -> Inputs {
    let (mut end, mut rate) = (*inputs, inputs.rate);
    for variable in variables() {
        if let Access::RealInput(field) = variable.access {
            let by = h * *field(&mut rate);
            let value = field(&mut end.drive);
            let rounding = 4.0 * f64::EPSILON * (value.abs() + by.abs());
            *value += by;
            // A ramp to the end of the range must not be refused for rounding.
            if let Kind::Real { min, max, .. } = variable.kind
                && (*value - value.clamp(min, max)).abs() <= rounding
            {
                *value = value.clamp(min, max);
            }
        }
    }
    Inputs { rate: Drive::default(), ..end }
}
