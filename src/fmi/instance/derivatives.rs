//! Derivatives: of inputs in time, of outputs by inputs and in time.

use crate::fmi::settings::Settings;
use crate::fmi::variable::{Access, Causality, Variable};
use crate::simulation::{Difference, Direction, Simulation};
use wheelrail_slave::{CallError, Outcome};

/// Highest order of input derivatives that masters may set, so that inputs are ramps within a step.
pub const INPUT_DERIVATIVE_ORDER: i32 = 1;

/// Highest order of output derivatives that masters may get.
pub const OUTPUT_DERIVATIVE_ORDER: i32 = 1;

/// Refuses derivatives of a variable of another order than the highest, which is the first.
fn first_order(variable: &Variable, order: i32, highest: i32) -> Outcome {
    if order == highest {
        return Ok(());
    }
    Err(CallError::error(format!("derivative of {} of order {order}: only order {highest} is possible", variable.name)))
}

/// Time derivatives of real inputs, for the next step only; all or none. Each comes with its order. Refused where an input of
/// its own gives the derivative.
pub(super) fn set_rates(settings: &mut Settings, derivatives: &[(&Variable, i32, f64)]) -> Outcome {
    let mut new = settings.rates;
    for (variable, order, value) in derivatives {
        let name = &variable.name;
        let Access::RealInput(field) = variable.access else {
            return Err(CallError::error(format!("{name} is not an input")));
        };
        first_order(variable, *order, INPUT_DERIVATIVE_ORDER)?;
        if !value.is_finite() {
            return Err(CallError::error(format!("der({name}) = {value:?} is outside its range: finite numbers")));
        }
        if let Some(ramp) = settings.ramp_of(variable) {
            return Err(CallError::error(format!(
                "der({name}) is already given by {ramp}: set that to 0, or leave this"
            )));
        }
        *field(&mut new) = *value;
    }
    settings.rates = new;
    Ok(())
}

/// Direction of the known inputs, of which each has its component.
pub(super) fn direction(known: &[(&Variable, f64)]) -> Outcome<Direction> {
    let mut direction = Direction::default();
    for (variable, seed) in known {
        let name = &variable.name;
        let component = match variable.access {
            Access::RealInput(field) => field(&mut direction.drive),
            Access::Ramp(field) => field(&mut direction.rate),
            _ => return Err(CallError::error(format!("{name} is not an input: derivatives are by real inputs"))),
        };
        if !seed.is_finite() {
            return Err(CallError::error(format!("seed of {name} = {seed:?} is outside its range: finite numbers")));
        }
        *component += seed;
    }
    Ok(direction)
}

/// Derivatives of outputs from the difference that a direction makes.
pub(super) fn quotients(difference: &Difference, outputs: &[&Variable]) -> Outcome<Vec<f64>> {
    let quotient = |variable: &&Variable| {
        let value = difference.quotient(|o| variable.real_output(o));
        let name = &variable.name;
        let failed = || CallError::error(format!("directional derivative of {name} = {value}: the seed is too large"));
        value.is_finite().then_some(value).ok_or_else(failed)
    };
    outputs.iter().map(quotient).collect()
}

/// Time derivatives of outputs, each of an order: of deferred ones the difference over the last communication step.
pub(super) fn rates(simulation: &Simulation, outputs: &[(&Variable, i32)]) -> Vec<f64> {
    let deferred = outputs.iter().any(|(variable, _)| variable.is_deferred());
    let ends = deferred.then(|| simulation.step_ends()).flatten();
    let rate = |variable: &Variable| match &ends {
        _ if !variable.is_deferred() => simulation.rate(|o| variable.real_output(o)),
        Some([(from, before), (to, now)]) => (variable.real_output(now) - variable.real_output(before)) / (to - from),
        None => 0.0,
    };
    outputs.iter().map(|(variable, _)| rate(variable)).collect()
}

/// Refuses variables that are no outputs, and orders other than the first.
pub(super) fn check_orders(outputs: &[(&Variable, i32)]) -> Outcome {
    outputs.iter().try_for_each(|(variable, order)| {
        check_outputs(&[*variable])?;
        first_order(variable, *order, OUTPUT_DERIVATIVE_ORDER)
    })
}

/// Refuses derivatives of profiles while those of a chosen line of the patch are shown, which have none.
pub(super) fn check_shown<'a>(line: usize, outputs: impl IntoIterator<Item = &'a Variable>) -> Outcome {
    match outputs.into_iter().find(|variable| line > 0 && variable.is_profile()) {
        Some(variable) => Err(CallError::error(format!(
            "{} has derivatives with contact.shown_line = 0 only, but that is {line}",
            variable.name
        ))),
        None => Ok(()),
    }
}

/// Refuses variables that are no outputs.
pub(super) fn check_outputs(variables: &[&Variable]) -> Outcome {
    match variables.iter().find(|variable| variable.causality() != Causality::Output) {
        Some(variable) => Err(CallError::error(format!("{} is not an output", variable.name))),
        None => Ok(()),
    }
}
