//! Derivatives: of inputs in time, of outputs by inputs and in time.

use super::values::lookup;
use super::{Instance, Outcome};
use crate::fmi::lifecycle::Call;
use crate::fmi::log::CallError;
use crate::fmi::variable::{Access, Causality, Reference, Variable};
use crate::simulation::Drive;

/// Highest order of input derivatives that masters may set, so that inputs are ramps within a step.
pub const INPUT_DERIVATIVE_ORDER: i32 = 1;

/// Highest order of output derivatives that masters may get.
pub const OUTPUT_DERIVATIVE_ORDER: i32 = 1;

impl Instance {
    /// First time derivatives of real inputs, for the next step only; all or none.
    pub fn set_input_derivatives(&mut self, references: &[Reference], orders: &[i32], values: &[f64]) -> Outcome {
        self.allow(Call::SetRealInputDerivatives)?;
        let mut rates = self.rates;
        for ((variable, order), value) in lookup(references, "Real")?.into_iter().zip(orders).zip(values) {
            let name = &variable.name;
            let Access::RealInput(field) = variable.access else {
                return Err(CallError::error(format!("{name} is not an input")));
            };
            if *order != INPUT_DERIVATIVE_ORDER {
                return Err(CallError::error(format!(
                    "derivative of {name} of order {order}: only order 1 is possible"
                )));
            }
            if !value.is_finite() {
                return Err(CallError::error(format!("der({name}) = {value:?} is outside its range: finite numbers")));
            }
            *field(&mut rates) = *value;
        }
        self.rates = rates;
        Ok(())
    }

    /// Derivative of the unknown outputs along a direction of the known inputs (see
    /// [`difference`](crate::simulation::Simulation::difference)).
    pub fn directional_derivative(
        &mut self,
        unknown: &[Reference],
        known: &[Reference],
        seed: &[f64],
    ) -> Outcome<Vec<f64>> {
        self.allow(Call::GetDirectionalDerivative)?;
        let mut direction = Drive::default();
        for (variable, seed) in lookup(known, "Real")?.into_iter().zip(seed) {
            let name = &variable.name;
            let Access::RealInput(field) = variable.access else {
                return Err(CallError::error(format!("{name} is not an input: derivatives are by real inputs")));
            };
            if !seed.is_finite() {
                return Err(CallError::error(format!(
                    "seed of {name} = {seed:?} is outside its range: finite numbers"
                )));
            }
            *field(&mut direction) += seed;
        }
        let outputs = real_outputs(unknown)?;
        let failed = |error| CallError::error(format!("directional derivative: {error}"));
        let difference = self.compute(|simulation| simulation.difference(&direction))?.map_err(failed)?;
        let quotient = |variable: &Variable| {
            let value = difference.quotient(|o| variable.real_output(o));
            let name = &variable.name;
            let failed =
                || CallError::error(format!("directional derivative of {name} = {value}: the seed is too large"));
            value.is_finite().then_some(value).ok_or_else(failed)
        };
        outputs.into_iter().map(quotient).collect()
    }

    /// Time derivatives of outputs (see [`rate`](crate::simulation::Simulation::rate)).
    pub fn output_derivatives(&mut self, references: &[Reference], orders: &[i32]) -> Outcome<Vec<f64>> {
        self.allow(Call::GetRealOutputDerivatives)?;
        let outputs = real_outputs(references)?;
        for (variable, order) in outputs.iter().zip(orders) {
            if *order != OUTPUT_DERIVATIVE_ORDER {
                let name = &variable.name;
                return Err(CallError::error(format!(
                    "derivative of {name} of order {order}: only order 1 is possible"
                )));
            }
        }
        let simulation = self.simulation()?;
        Ok(outputs.into_iter().map(|variable| simulation.rate(|o| variable.real_output(o))).collect())
    }
}

/// Rows of real outputs, refusing everything else.
fn real_outputs(references: &[Reference]) -> Outcome<Vec<&'static Variable>> {
    let rows = lookup(references, "Real")?;
    match rows.iter().find(|variable| variable.causality() != Causality::Output) {
        Some(variable) => Err(CallError::error(format!("{} is not an output", variable.name))),
        None => Ok(rows),
    }
}
