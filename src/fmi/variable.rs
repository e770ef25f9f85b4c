//! Interface variables: rows of [`super::table`], and elements of rows that are arrays.

use crate::config::Config;
use crate::config::row::{Level, Row};
use crate::simulation::{Drive, Inputs, OutputRow, Outputs, Read};

pub use crate::config::value::{Enumeration, Kind, Value};
pub use wheelrail_slave::Reference;
use wheelrail_slave::Scalar;

/// Place of the value of a variable. Parameters are fixed or tunable, inputs and real outputs continuous, the rest
/// discrete.
#[derive(Clone, Copy)]
pub enum Access {
    /// Name of the preset file; the one parameter that is not part of [`Config`].
    Preset,
    /// A row of the configuration.
    Parameter(&'static Row<Config>),
    /// A real input.
    RealInput(fn(&mut Drive) -> &mut f64),
    /// The time derivative of a real input.
    Ramp(fn(&mut Drive) -> &mut f64),
    /// A choice between partners: getter and setter, which ignores values of another type.
    ChoiceInput(fn(&Inputs) -> Value, fn(&mut Inputs, &Value)),
    /// An output.
    Output(&'static OutputRow),
}

/// FMI causality of a variable. A point of a profile is an output like the whole profile; FMI 2.0 declares it `local`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Causality {
    /// Set before the start, or tuned during a run.
    Parameter,
    /// Set between steps.
    Input,
    /// Read.
    Output,
}

/// Group of variables that people look for together. Variables are listed in the order of their groups.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Group {
    /// Parameters for all users.
    Basic,
    /// Inputs but for time derivatives of others.
    Input,
    /// Outputs, whole profiles among them.
    Output,
    /// Parameters with defaults that are meant to be kept.
    Expert,
    /// Points of profiles.
    Point,
    /// Time derivatives of inputs.
    Rate,
}

/// Dependence of an output in Initialization Mode.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Start {
    /// Zero by definition.
    Zero,
    /// The stationary state belonging to all inputs and parameters.
    Stationary,
}

/// One row of the table. It owns no memory: rows are kept in statics, and what those own is lost when the library is
/// unloaded.
#[derive(Clone, Copy)]
pub struct Variable {
    /// Value reference.
    pub reference: Reference,
    /// Name in the form `group.name`.
    pub name: &'static str,
    /// Type, unit and range; those of the elements of an array.
    pub kind: Kind,
    /// Number of elements of an array; `None` for a scalar.
    pub dimension: Option<usize>,
    /// Index of the element of an array that this variable is; `None` for a row of the table.
    pub element: Option<usize>,
    /// Place of the value.
    pub access: Access,
    /// Dependence of an output; ignored otherwise.
    pub start: Start,
    /// True if a parameter may change between steps.
    pub tunable: bool,
    /// Meaning, plain text.
    pub description: &'static str,
}

impl Variable {
    /// FMI causality.
    pub fn causality(&self) -> Causality {
        match self.access {
            Access::Preset | Access::Parameter(_) => Causality::Parameter,
            Access::RealInput(_) | Access::Ramp(_) | Access::ChoiceInput(..) => Causality::Input,
            Access::Output(_) => Causality::Output,
        }
    }

    /// The group in which the variable is listed.
    pub fn group(&self) -> Group {
        match self.access {
            Access::Preset => Group::Basic,
            Access::Parameter(row) => match row.level {
                Level::Basic => Group::Basic,
                Level::Expert => Group::Expert,
            },
            Access::RealInput(_) if self.name.ends_with("_rate") => Group::Rate,
            Access::RealInput(_) | Access::ChoiceInput(..) => Group::Input,
            Access::Output(_) if self.element.is_some() => Group::Point,
            Access::Output(_) => Group::Output,
            Access::Ramp(_) => Group::Rate,
        }
    }

    /// The elements of an array, whose references follow its own; a scalar itself.
    pub fn elements(&self) -> Vec<Variable> {
        let (Access::Output(output), Some(_)) = (self.access, self.dimension) else { return vec![*self] };
        let element = |(point, &(name, description))| Variable {
            reference: self.reference + 1 + point as Reference,
            name,
            dimension: None,
            element: Some(point),
            description,
            ..*self
        };
        output.points.iter().enumerate().map(element).collect()
    }

    /// True for an input that changes within a step as its master says: by a time derivative, or by values within the step.
    pub fn is_ramped(&self) -> bool {
        let reference = self.reference;
        matches!(self.access, Access::RealInput(_))
            && Drive::ROWS.iter().any(|row| row.number == reference && row.ramp.is_some())
    }

    /// Value of a parameter; `None` for other variables.
    pub fn parameter(&self, preset: &str, config: &Config) -> Option<Value> {
        match self.access {
            Access::Preset => Some(Value::String(preset.to_owned())),
            Access::Parameter(row) => Some((row.read)(config)),
            _ => None,
        }
    }

    /// Writes a parameter. Values of another type and variables that are not part of [`Config`] are left alone.
    pub fn set_parameter(&self, config: &mut Config, value: &Value) {
        if let Access::Parameter(row) = self.access {
            (row.write)(config, value);
        }
    }

    /// Value of an input; `None` for other variables.
    pub fn input(&self, inputs: &mut Inputs) -> Option<Value> {
        match self.access {
            Access::RealInput(field) => Some(Value::Real(*field(&mut inputs.drive))),
            Access::Ramp(field) => Some(Value::Real(*field(&mut inputs.rate))),
            Access::ChoiceInput(get, _) => Some(get(inputs)),
            _ => None,
        }
    }

    /// Writes an input. Values of another type and other variables are left alone.
    pub fn set_input(&self, inputs: &mut Inputs, value: &Value) {
        match (self.access, value) {
            (Access::RealInput(field), Value::Real(v)) => *field(&mut inputs.drive) = *v,
            (Access::Ramp(field), Value::Real(v)) => *field(&mut inputs.rate) = *v,
            (Access::ChoiceInput(_, set), value) => set(inputs, value),
            _ => {}
        }
    }

    /// Value of an output; `None` for other variables.
    pub fn output(&self, outputs: &Outputs) -> Option<Value> {
        let Access::Output(row) = self.access else { return None };
        Some(match row.read {
            Read::Real(get) => Value::Real(get(outputs)),
            Read::Count(get) => Value::Integer(i32::try_from(get(outputs)).unwrap_or(i32::MAX)),
            Read::Flag(get) => Value::Boolean(get(outputs)),
            Read::Profile(get) | Read::Deferred(get) => match self.element {
                Some(point) => Value::Real(get(outputs).get(point).copied().unwrap_or(0.0)),
                None => Value::Reals(get(outputs).to_vec()),
            },
        })
    }

    /// True for an output that is computed only when it is asked for.
    pub fn is_deferred(&self) -> bool {
        matches!(self.access, Access::Output(OutputRow { read: Read::Deferred(_), .. }))
    }

    /// True for a point of a profile, or a whole one: those that are of one line of the patch.
    pub fn is_profile(&self) -> bool {
        self.name.starts_with("profile.")
    }

    /// Value of a real output, 0 for other variables.
    pub fn real_output(&self, outputs: &Outputs) -> f64 {
        match self.output(outputs) {
            Some(Value::Real(value)) => value,
            _ => 0.0,
        }
    }

    /// Refuses a value of the wrong type, not finite or outside the declared range; the text names all three.
    pub fn check(&self, value: &Value) -> Result<(), String> {
        self.kind.check(self.name, value)
    }
}

impl From<Scalar> for Value {
    fn from(scalar: Scalar) -> Self {
        match scalar {
            Scalar::Real(value) => Value::Real(value),
            Scalar::Integer(value) => Value::Integer(value),
            Scalar::Boolean(value) => Value::Boolean(value),
            Scalar::String(value) => Value::String(value),
        }
    }
}

/// Arrays are no scalars: their elements are.
impl TryFrom<Value> for Scalar {
    type Error = ();

    fn try_from(value: Value) -> Result<Self, ()> {
        match value {
            Value::Real(value) => Ok(Scalar::Real(value)),
            Value::Integer(value) => Ok(Scalar::Integer(value)),
            Value::Boolean(value) => Ok(Scalar::Boolean(value)),
            Value::String(value) => Ok(Scalar::String(value)),
            Value::Reals(_) => Err(()),
        }
    }
}
