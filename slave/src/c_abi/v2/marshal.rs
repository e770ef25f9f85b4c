//! C integers of FMI 2.0: matched, never trusted.

use super::types::{CO_SIMULATION, Question, fmi2Boolean};
use crate::c_abi::marshal::flag;
use crate::log::{CallError, Outcome};
use std::ffi::c_int;

/// The value of a C boolean.
pub fn boolean(value: fmi2Boolean, name: &str) -> Outcome<bool> {
    flag(value, 2, name)
}

/// Refuses every type of simulation but co-simulation.
pub fn co_simulation(kind: c_int) -> Outcome {
    if kind == CO_SIMULATION {
        return Ok(());
    }
    let only = format!("{CO_SIMULATION} (fmi2CoSimulation), the only type of this FMU");
    Err(CallError::error(format!("fmuType = {kind} is outside its range: {only}")))
}

/// The question about the last step that a master asks by a number.
pub fn question(kind: c_int) -> Outcome<Question> {
    Question::ALL.into_iter().find(|known| *known as c_int == kind).ok_or_else(|| {
        let known = Question::ALL.map(|known| format!("{} ({})", known as c_int, known.name()));
        CallError::error(format!("fmi2StatusKind = {kind} is outside its range: {}", known.join(", ")))
    })
}
