//! Access to the wheel as FMI 2.0 has it: value references and types of scalar variables stand for rows of the table
//! and elements of arrays.

use super::description;
use super::variables::find;
use crate::fmi::instance::WheelSlave;
use crate::fmi::table::{self, of_type};
use crate::fmi::variable::{Kind, Value, Variable};
use wheelrail_slave::{CallError, Life, Outcome, Reference, Scalar, ScalarAccess, Type};

/// FMI type of the values of a kind.
pub fn type_of(kind: Kind) -> Type {
    match kind {
        Kind::Real { .. } => Type::Real,
        Kind::Integer { .. } | Kind::Enumeration(_) => Type::Integer,
        Kind::Boolean => Type::Boolean,
        Kind::String => Type::String,
    }
}

/// Variables of one type, refusing unknown references and other types.
fn lookup(references: &[Reference], wanted: Type) -> Outcome<Vec<&'static Variable>> {
    of_type(references, wanted, find, type_of)
}

impl ScalarAccess for WheelSlave {
    type Value = Value;

    fn guid() -> String {
        // Together with the description all tables are made, so that no later call needs stack for them.
        let _ = find(0);
        let _ = table::find(0);
        description::guid()
    }

    fn name_of(reference: Reference) -> Option<String> {
        find(reference).map(|variable| variable.name.to_owned())
    }

    fn get(&mut self, references: &[Reference], wanted: Type, life: &Life) -> Outcome<Vec<Value>> {
        self.values(&lookup(references, wanted)?, life)
    }

    fn set(&mut self, references: &[Reference], values: Vec<Value>, life: &Life) -> Outcome {
        let Some(first) = values.first() else { return Ok(()) };
        let wanted = Scalar::try_from(first.clone()).map_err(|()| CallError::error("an array is no scalar"))?.of();
        self.set_values(lookup(references, wanted)?.into_iter().zip(values), life)
    }

    fn directional_derivative(
        &mut self,
        unknown: &[Reference],
        known: &[Reference],
        seed: &[f64],
        life: &Life,
    ) -> Outcome<Vec<f64>> {
        let known: Vec<_> = lookup(known, Type::Real)?.into_iter().zip(seed.iter().copied()).collect();
        self.directional_derivative(&lookup(unknown, Type::Real)?, &known, life)
    }

    fn set_input_derivatives(&mut self, references: &[Reference], orders: &[i32], values: &[f64]) -> Outcome {
        let variables = lookup(references, Type::Real)?.into_iter();
        let derivatives: Vec<_> =
            variables.zip(orders).zip(values).map(|((v, order), value)| (v, *order, *value)).collect();
        self.set_rates(&derivatives)
    }

    fn output_derivatives(&mut self, references: &[Reference], orders: &[i32], life: &Life) -> Outcome<Vec<f64>> {
        let outputs: Vec<_> = lookup(references, Type::Real)?.into_iter().zip(orders.iter().copied()).collect();
        self.output_derivatives(&outputs, life)
    }
}
