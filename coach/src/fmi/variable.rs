//! Variables of the interface.

use crate::coupling::{Driven, Running, Seen};
use wheelrail_slave::{ElementType, Reference, Type};

/// Place of the value of a variable. All variables are real but the valves.
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
    /// Action of the valve of an axle.
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
    /// Place of its value.
    pub access: Access,
}

impl Variable {
    /// Type of FMI 2.0.
    pub fn kind(&self) -> Type {
        if matches!(self.access, Access::Valve(_)) { Type::Integer } else { Type::Real }
    }

    /// Type of FMI 3.0.
    pub fn element_type(&self) -> ElementType {
        if matches!(self.access, Access::Valve(_)) { ElementType::Int32 } else { ElementType::Float64 }
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
