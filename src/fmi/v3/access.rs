//! Access to the wheel as FMI 3.0 has it: value references stand for rows of the table, arrays among them.

use super::description;
use crate::fmi::instance::WheelSlave;
use crate::fmi::table::{find, of_type};
use crate::fmi::variable::{Causality, Kind, Variable};
use wheelrail_slave::array_access::check_length;
use wheelrail_slave::course::Course;
use wheelrail_slave::lifecycle::Phase;
use wheelrail_slave::{ArrayAccess, CallError, ElementType, Life, Outcome, Reference, Scalar};

/// Type of the elements of a kind.
pub fn element_type_of(kind: Kind) -> ElementType {
    match kind {
        Kind::Real { .. } => ElementType::Float64,
        Kind::Integer { .. } => ElementType::Int32,
        Kind::Enumeration(_) => ElementType::Int64,
        Kind::Boolean => ElementType::Boolean,
        Kind::String => ElementType::String,
    }
}

/// Rows of one type, refusing unknown references and other types.
fn rows(references: &[Reference], wanted: ElementType) -> Outcome<Vec<&'static Variable>> {
    of_type(references, wanted, find, element_type_of)
}

/// Elements of rows, one after the other.
fn elements(rows: &[&Variable]) -> Vec<Variable> {
    rows.iter().flat_map(|row| row.elements()).collect()
}

impl ArrayAccess for WheelSlave {
    fn token() -> String {
        // Together with the description all tables are made, so that no later call needs stack for them.
        let _ = find(0);
        description::token()
    }

    fn read(&mut self, references: &[Reference], wanted: ElementType, life: &Life) -> Outcome<Vec<Scalar>> {
        let rows = rows(references, wanted)?;
        if life.phase() == Phase::Instantiated
            && let Some(output) = rows.iter().find(|row| row.causality() == Causality::Output)
        {
            let why = "is an output, which has no start value: read it from Initialization Mode on";
            return Err(CallError::error(format!("{} {why}", output.name)));
        }
        let elements = elements(&rows);
        let values = self.values(&elements.iter().collect::<Vec<_>>(), life)?;
        Ok(values.into_iter().filter_map(|value| value.try_into().ok()).collect())
    }

    fn write(&mut self, references: &[Reference], wanted: ElementType, values: Vec<Scalar>, life: &Life) -> Outcome {
        let elements = elements(&rows(references, wanted)?);
        check_length("nValues", values.len(), elements.len())?;
        self.set_values(elements.iter().zip(values.into_iter().map(Into::into)), life)
    }

    fn directional(
        &mut self,
        unknowns: &[Reference],
        knowns: &[Reference],
        seed: &[f64],
        life: &Life,
    ) -> Outcome<Vec<f64>> {
        let knowns: Vec<_> = rows(knowns, ElementType::Float64)?.into_iter().zip(seed.iter().copied()).collect();
        let unknowns = elements(&rows(unknowns, ElementType::Float64)?);
        self.directional_derivative(&unknowns.iter().collect::<Vec<_>>(), &knowns, life)
    }

    fn output_rates(&mut self, references: &[Reference], orders: &[i32], life: &Life) -> Outcome<Vec<f64>> {
        let rows = rows(references, ElementType::Float64)?;
        let outputs: Vec<_> =
            rows.iter().zip(orders).flat_map(|(row, order)| row.elements().into_iter().map(|e| (e, *order))).collect();
        self.output_derivatives(&outputs.iter().map(|(element, order)| (element, *order)).collect::<Vec<_>>(), life)
    }

    const INTERMEDIATE_UPDATE: bool = true;

    fn is_intermediate(reference: Reference) -> bool {
        find(reference).is_some_and(Variable::is_ramped)
    }

    fn present(&mut self, references: &[Reference], life: &Life) -> Outcome<Vec<(f64, f64)>> {
        Ok(self.present_inputs(&rows(references, ElementType::Float64)?, life))
    }

    fn check_present(&self, reference: Reference, value: f64) -> Outcome {
        let rows = rows(&[reference], ElementType::Float64)?;
        rows.into_iter().try_for_each(|row| self.check_within_step(row, value))
    }

    fn step_along(&mut self, start: f64, course: &Course, life: &Life) -> Outcome<f64> {
        self.take_course(start, &rows(&course.references, ElementType::Float64)?, &course.points, life)
    }
}
