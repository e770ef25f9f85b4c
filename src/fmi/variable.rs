//! Kinds of interface variables: what a row of [`super::variables`] can say.

use super::units::Measure;
use crate::config::Config;
use crate::simulation::{Drive, Inputs, Outputs};
use serde::{Deserialize, Serialize};

/// FMI value reference.
pub type Reference = u32;

/// A value on its way through the interface.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Value {
    Real(f64),
    /// Integers and enumeration items (counted from 1).
    Integer(i32),
    Boolean(bool),
    String(String),
}

impl Value {
    /// Name of the FMI type that carries the value.
    pub fn type_name(&self) -> &'static str {
        match self {
            Value::Real(_) => "Real",
            Value::Integer(_) => "Integer",
            Value::Boolean(_) => "Boolean",
            Value::String(_) => "String",
        }
    }
}

/// A list of named choices; item `i` of the list has the value `i + 1`.
#[derive(Debug, PartialEq, Eq)]
pub struct Enumeration {
    pub name: &'static str,
    pub description: &'static str,
    /// Name and meaning of every item.
    pub items: &'static [(&'static str, &'static str)],
}

/// FMI type with its attributes. Infinite bounds are open and do not appear in the model description.
#[derive(Clone, Copy, Debug)]
pub enum Kind {
    Real { measure: Measure, min: f64, max: f64, nominal: f64 },
    Integer { min: i32, max: i32 },
    Boolean,
    String,
    Enumeration(&'static Enumeration),
}

impl Kind {
    /// Name of the functions that read and write the variable (`fmi2Get…`).
    pub fn type_name(self) -> &'static str {
        match self {
            Kind::Real { .. } => "Real",
            Kind::Integer { .. } | Kind::Enumeration(_) => "Integer",
            Kind::Boolean => "Boolean",
            Kind::String => "String",
        }
    }
}

/// Where a variable lives. Parameters are fixed or tunable, inputs and real outputs continuous, the rest discrete.
#[derive(Clone, Copy)]
pub enum Access {
    /// Name of the preset file; the one parameter that is not part of [`Config`].
    Preset,
    RealParameter(fn(&mut Config) -> &mut f64),
    CountParameter(fn(&mut Config) -> &mut usize),
    FlagParameter(fn(&mut Config) -> &mut bool),
    /// Item number of an enumeration: getter and setter. The setter is only called with items of the list.
    ChoiceParameter(fn(&Config) -> i32, fn(&mut Config, i32)),
    RealInput(fn(&mut Drive) -> &mut f64),
    ChoiceInput(fn(&Inputs) -> i32, fn(&mut Inputs, i32)),
    RealOutput(fn(&Outputs) -> f64),
    CountOutput(fn(&Outputs) -> u64),
    /// One point of a profile across the contact patch, counted from 0.
    ProfileOutput(fn(&Outputs) -> &[f64], usize),
}

/// FMI causality of a variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Causality {
    Parameter,
    Input,
    Output,
}

/// What an output depends on in Initialization Mode.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Start {
    /// Zero by definition.
    Zero,
    /// The stationary state belonging to all inputs and parameters.
    Stationary,
}

/// One row of the table.
#[derive(Clone)]
pub struct Variable {
    pub reference: Reference,
    pub name: String,
    pub kind: Kind,
    pub access: Access,
    /// For outputs; ignored otherwise.
    pub start: Start,
    /// Whether a parameter may change between steps.
    pub tunable: bool,
    pub description: String,
}

impl Variable {
    pub fn causality(&self) -> Causality {
        match self.access {
            Access::RealInput(_) | Access::ChoiceInput(..) => Causality::Input,
            Access::RealOutput(_) | Access::CountOutput(_) | Access::ProfileOutput(..) => Causality::Output,
            _ => Causality::Parameter,
        }
    }

    /// Value of a parameter; `None` for other variables.
    pub fn parameter(&self, preset: &str, config: &mut Config) -> Option<Value> {
        Some(match self.access {
            Access::Preset => Value::String(preset.to_owned()),
            Access::RealParameter(field) => Value::Real(*field(config)),
            Access::CountParameter(field) => Value::Integer(i32::try_from(*field(config)).unwrap_or(i32::MAX)),
            Access::FlagParameter(field) => Value::Boolean(*field(config)),
            Access::ChoiceParameter(get, _) => Value::Integer(get(config)),
            _ => return None,
        })
    }

    /// Writes a parameter. Values of another type and variables that are not part of [`Config`] are left alone.
    pub fn set_parameter(&self, config: &mut Config, value: &Value) {
        match (self.access, value) {
            (Access::RealParameter(field), Value::Real(v)) => *field(config) = *v,
            (Access::CountParameter(field), Value::Integer(v)) => *field(config) = usize::try_from(*v).unwrap_or(0),
            (Access::FlagParameter(field), Value::Boolean(v)) => *field(config) = *v,
            (Access::ChoiceParameter(_, set), Value::Integer(v)) => set(config, *v),
            _ => {}
        }
    }

    /// Value of an input; `None` for other variables.
    pub fn input(&self, inputs: &mut Inputs) -> Option<Value> {
        match self.access {
            Access::RealInput(field) => Some(Value::Real(*field(&mut inputs.drive))),
            Access::ChoiceInput(get, _) => Some(Value::Integer(get(inputs))),
            _ => None,
        }
    }

    /// Writes an input. Values of another type and other variables are left alone.
    pub fn set_input(&self, inputs: &mut Inputs, value: &Value) {
        match (self.access, value) {
            (Access::RealInput(field), Value::Real(v)) => *field(&mut inputs.drive) = *v,
            (Access::ChoiceInput(_, set), Value::Integer(v)) => set(inputs, *v),
            _ => {}
        }
    }

    /// Value of an output; `None` for other variables.
    pub fn output(&self, outputs: &Outputs) -> Option<Value> {
        match self.access {
            Access::RealOutput(get) => Some(Value::Real(get(outputs))),
            Access::CountOutput(get) => Some(Value::Integer(i32::try_from(get(outputs)).unwrap_or(i32::MAX))),
            Access::ProfileOutput(get, point) => Some(Value::Real(get(outputs).get(point).copied().unwrap_or(0.0))),
            _ => None,
        }
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
        let name = &self.name;
        let outside = |value: &dyn std::fmt::Display, range: String| {
            Err(format!("{name} = {value} is outside its range: {range}"))
        };
        match (self.kind, value) {
            (Kind::Real { min, max, .. }, Value::Real(v)) => {
                if *v >= min && *v <= max && v.is_finite() {
                    return Ok(());
                }
                let range = match (min.is_finite(), max.is_finite()) {
                    (true, true) => format!("{min} to {max}"),
                    (true, false) => format!("finite, at least {min}"),
                    (false, true) => format!("finite, at most {max}"),
                    (false, false) => "finite numbers".to_owned(),
                };
                outside(&format_args!("{v:?}"), range)
            }
            (Kind::Integer { min, max }, Value::Integer(v)) => {
                if (min..=max).contains(v) {
                    Ok(())
                } else {
                    outside(v, format!("{min} to {max}"))
                }
            }
            (Kind::Enumeration(list), Value::Integer(v)) => {
                let count = list.items.len() as i32;
                if (1..=count).contains(v) {
                    return Ok(());
                }
                let items: Vec<_> = (1..).zip(list.items).map(|(i, item)| format!("{i} ({})", item.0)).collect();
                outside(v, items.join(", "))
            }
            (Kind::Boolean, Value::Boolean(_)) | (Kind::String, Value::String(_)) => Ok(()),
            (kind, value) => Err(format!("{name} is of type {}, not {}", kind.type_name(), value.type_name())),
        }
    }
}
