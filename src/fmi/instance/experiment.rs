//! What a master says about its experiment: times and tolerance.

use super::{Instance, Outcome};
use crate::config::Config;
use crate::fmi::lifecycle::Call;
use crate::fmi::log::{CallError, Status};
use crate::fmi::settings::{SetValues, with_parameters};
use crate::fmi::variable::Value;
use crate::fmi::variables::variables;

/// The parameter that the tolerance of an experiment sets.
const TOLERANCE: &str = "solver.tolerance";
/// Tolerances up to this one are those of a master's own solver, which it hands on unasked: 1e-3, 1e-4 and 1e-6 are usual
/// defaults there [1].
const OF_MASTERS: f64 = 1e-3;
/// Largest meaningful tolerance [1].
const LARGEST: f64 = 1.0;

impl Instance {
    /// Times \[s] and tolerance \[1] of the experiment.
    ///
    /// The tolerance becomes `solver.tolerance`, unless that is set explicitly, if it was given deliberately: it is
    /// neither the one of the model description, which masters hand back unasked, nor so small that it must be that of
    /// the master's own solver.
    pub fn setup_experiment(&mut self, tolerance: Option<f64>, start: f64, stop: Option<f64>) -> Outcome {
        self.allow(Call::SetupExperiment)?;
        if let Some(tolerance) = tolerance
            && !(tolerance.is_finite() && tolerance > 0.0)
        {
            return Err(CallError::error(format!("tolerance = {tolerance:?} is outside its range: positive numbers")));
        }
        if !start.is_finite() {
            return Err(CallError::error(format!("startTime = {start:?} s is outside its range: finite numbers")));
        }
        if let Some(stop) = stop
            && !(stop.is_finite() && stop >= start)
        {
            return Err(CallError::error(format!("stopTime = {stop:?} s is outside its range: at least {start:?} s")));
        }
        (self.time, self.stop) = (start, stop);
        self.take_tolerance(tolerance);
        Ok(())
    }

    fn take_tolerance(&mut self, given: Option<f64>) {
        self.experiment.clear();
        let parameter = variables().iter().find(|variable| variable.name == TOLERANCE);
        if let (Some(given), Some(parameter)) = (given, parameter)
            && given != Config::default().tuning.tolerance
        {
            if given > OF_MASTERS && given <= LARGEST {
                self.experiment.insert(parameter.reference, Value::Real(given));
            } else if !self.parameters.contains_key(&parameter.reference) {
                let range = format!("more than {OF_MASTERS:?}, at most {LARGEST:?}");
                let why = "smaller ones are taken for that of the master's own solver";
                self.log.report(
                    Status::Warning,
                    &format!(
                        "tolerance = {given:?} is not used, because it is outside its range: {range}; {why}. Set \
                         {TOLERANCE} to ask for it"
                    ),
                );
            }
        }
        self.config = with_parameters(&self.base, &self.experiment, &self.parameters);
        self.simulation = None;
    }

    /// The tolerance that holds now, and where it comes from.
    pub(super) fn tolerance_in_use(&self) -> String {
        let tolerance = self.config.tuning.tolerance;
        let reference = variables().iter().find(|variable| variable.name == TOLERANCE).map(|row| row.reference);
        let is_in = |values: &SetValues| reference.is_some_and(|r| values.contains_key(&r));
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
