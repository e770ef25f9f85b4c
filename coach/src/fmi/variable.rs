//! Values and variables of the interface.

use crate::coupling::{Driven, Running, Seen};

/// FMI value reference.
pub type Reference = u32;

/// A value of a variable.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// `fmi2Real`.
    Real(f64),
    /// `fmi2Integer`.
    Integer(i32),
    /// `fmi2Boolean`.
    Boolean(bool),
    /// `fmi2String`.
    String(String),
}

impl Value {
    /// Name of the FMI type.
    pub fn type_name(&self) -> &'static str {
        match self {
            Value::Real(_) => "Real",
            Value::Integer(_) => "Integer",
            Value::Boolean(_) => "Boolean",
            Value::String(_) => "String",
        }
    }
}

/// Where a variable lives. All variables are real but the valves.
#[derive(Clone, Copy)]
pub enum Access {
    /// A row of the parameters.
    Parameter(usize),
    /// Share of the full brake pressure.
    Demand,
    /// Input of an axle.
    Seen(usize, fn(&mut Seen) -> &mut f64),
    /// Output to an axle.
    Driven(usize, fn(&Driven) -> f64),
    /// Output of the coach.
    Output(fn(&Running) -> f64),
    /// What the valve of an axle does.
    Valve(usize),
}

/// A variable of the interface.
#[derive(Clone)]
pub struct Variable {
    /// Value reference.
    pub reference: Reference,
    /// Name.
    pub name: String,
    /// SI unit; empty for the valves.
    pub unit: &'static str,
    /// Smallest and largest value.
    pub range: [f64; 2],
    /// Value unless it is set.
    pub start: f64,
    /// Meaning, plain text.
    pub text: &'static str,
    /// Where it lives.
    pub access: Access,
}

impl Variable {
    /// Name of the FMI type.
    pub fn type_name(&self) -> &'static str {
        if matches!(self.access, Access::Valve(_)) { "Integer" } else { "Real" }
    }

    /// FMI causality.
    pub fn causality(&self) -> &'static str {
        match self.access {
            Access::Parameter(_) => "parameter",
            Access::Demand | Access::Seen(..) => "input",
            Access::Driven(..) | Access::Output(_) | Access::Valve(_) => "output",
        }
    }

    /// Refuses a value that is not finite or out of range; the text names all three.
    pub fn check(&self, value: f64) -> Result<(), String> {
        let [low, high] = self.range;
        if value.is_finite() && value >= low && value <= high {
            return Ok(());
        }
        Err(format!("{} = {value:?} is outside its range: {low:?} to {high:?} {}", self.name, self.unit))
    }
}
