//! Getting and setting values of variables.

use super::{Instance, Outcome};
use crate::fmi::lifecycle::{Call, Phase};
use crate::fmi::log::CallError;
use crate::fmi::presets;
use crate::fmi::settings::{SetValues, with_inputs, with_parameters};
use crate::fmi::variable::{Access, Causality, Kind, Reference, Value, Variable};
use crate::fmi::variables::{find, variables};
use crate::simulation::{Inputs, Rotation, Simulation, Translation, Vertical};

impl Instance {
    /// Values of variables of the FMI type `type_name`, in the order of the references.
    pub fn get(&mut self, references: &[Reference], type_name: &str) -> Outcome<Vec<Value>> {
        self.allow(Call::Get)?;
        let variables = lookup(references, type_name)?;
        if variables.iter().any(|variable| variable.causality() == Causality::Output) {
            self.simulation()?;
        }
        let mut inputs = self.effective_inputs();
        let outputs = self.simulation.as_ref().map(Simulation::outputs);
        let value = |variable: &Variable| {
            let value = match variable.causality() {
                Causality::Output => outputs.and_then(|outputs| variable.output(outputs)),
                Causality::Input => variable.input(&mut inputs),
                Causality::Parameter => variable.parameter(&self.preset, &self.config),
            };
            value.ok_or_else(|| CallError::error(format!("{} has no value yet", variable.name)))
        };
        variables.into_iter().map(value).collect()
    }

    /// Sets variables, all or none. Each must be within its own range; whether all go together shows at the end of
    /// initialization, or when outputs are asked for, so that the order of calls does not matter.
    pub fn set(&mut self, references: &[Reference], values: Vec<Value>) -> Outcome {
        self.allow(Call::Set)?;
        let Some(first) = values.first() else { return Ok(()) };
        let variables = lookup(references, first.type_name())?;
        let early = matches!(self.phase, Phase::Instantiated | Phase::Initialization);
        let (mut preset, mut base) = (self.preset.clone(), self.base.clone());
        let (mut parameters, mut rates) = (self.parameters.clone(), self.rates);
        let (mut inputs, mut bumpless) = (self.inputs.clone(), self.bumpless.clone());
        let mut experiment = self.experiment.clone();
        for (variable, value) in variables.iter().zip(values) {
            match variable.causality() {
                Causality::Output => {
                    return Err(CallError::error(format!("{} is an output and cannot be set", variable.name)));
                }
                Causality::Parameter if !early && !variable.tunable => {
                    let why = "is a fixed parameter and can only be set before the end of initialization";
                    let instead = changes(variable.name);
                    return Err(CallError::error(format!("{} {why}{instead}", variable.name)));
                }
                _ => variable.check(&value).map_err(CallError::error)?,
            }
            match (variable.access, &value) {
                (Access::Preset, Value::String(name)) => {
                    base = presets::load(self.resources.as_deref(), name).map_err(CallError::error)?;
                    preset.clone_from(name);
                }
                (Access::RealInput(field), _) => {
                    *field(&mut rates) = 0.0;
                    inputs.insert(variable.reference, value);
                }
                (Access::ChoiceInput(..), _) => drop(inputs.insert(variable.reference, value)),
                _ => {
                    parameters.insert(variable.reference, value);
                    if !early {
                        experiment.remove(&variable.reference);
                    }
                }
            }
        }
        let config = with_parameters(&base, &experiment, &parameters);
        if !early {
            self.take_over(&with_inputs(&config, &bumpless, &inputs, rates), &mut bumpless);
        }
        if !early && config != self.config {
            config.validate().map_err(|error| CallError::error(error.to_string()))?;
            if config.files != self.config.files {
                Self::try_to_save(&config)?;
            }
            if let Some(simulation) = &mut self.simulation {
                simulation.retune(&config.tuning);
                self.model = Some(simulation.model().clone());
            }
        }
        (self.preset, self.base, self.experiment, self.config) = (preset, base, experiment, config);
        (self.parameters, self.inputs, self.bumpless, self.rates) = (parameters, inputs, bumpless, rates);
        if early {
            self.simulation = None;
        }
        Ok(())
    }

    /// A quantity that becomes prescribed during a run takes over its present value, unless the master has set it; a
    /// reaction beyond its range as far as that goes.
    fn take_over(&self, next: &Inputs, bumpless: &mut SetValues) {
        let Some(simulation) = &self.simulation else { return };
        let (now, outputs) = (self.effective_inputs(), simulation.outputs());
        let rotation = match next.rotation {
            Rotation::Velocity => ("drive.omega", outputs.wheel_omega),
            Rotation::Moment => ("drive.moment", outputs.hub_moment),
        };
        let translation = match next.translation {
            Translation::Velocity => ("drive.velocity", outputs.wheel_velocity),
            Translation::Force => ("drive.force", outputs.hub_force_x),
        };
        let vertical = match next.vertical {
            Vertical::Force => ("drive.load", -outputs.hub_force_y - now.drive.load_change),
            Vertical::Displacement => ("drive.displacement", outputs.hub_height),
        };
        for (switched, (name, present)) in [
            (now.rotation != next.rotation, rotation),
            (now.translation != next.translation, translation),
            (now.vertical != next.vertical, vertical),
        ] {
            let row = variables().iter().find(|variable| variable.name == name);
            if let (true, Some(Variable { reference, kind: Kind::Real { min, max, .. }, .. })) = (switched, row) {
                bumpless.insert(*reference, Value::Real(present.clamp(*min, *max)));
            }
        }
    }
}

/// Points to the input that changes during a run what a parameter gives at its start; empty where there is none.
fn changes(parameter: &str) -> String {
    let input = match parameter {
        "friction.coefficient" => "rail.friction",
        "thermal.reference" => "rail.temperature",
        "model.nominal_load" => "drive.load",
        "initial.velocity" => "drive.velocity",
        _ => return String::new(),
    };
    format!("; during the run set the input {input}")
}

/// Rows of the table, refusing unknown references and other types.
pub(super) fn lookup(references: &[Reference], type_name: &str) -> Outcome<Vec<&'static Variable>> {
    let row = |reference: &Reference| {
        let unknown = || CallError::error(format!("value reference {reference} is unknown"));
        let variable = find(*reference).ok_or_else(unknown)?;
        let theirs = variable.kind.type_name();
        if theirs == type_name {
            return Ok(variable);
        }
        Err(CallError::error(format!("{} (value reference {reference}) is {theirs}, not {type_name}", variable.name)))
    };
    references.iter().map(row).collect()
}
