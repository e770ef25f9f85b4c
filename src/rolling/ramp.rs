//! Time derivatives of inputs that are inputs themselves.

use crate::config::units::Measure;

/// The row of the time derivative of a real input, an input as well.
#[derive(Clone, Copy, Debug)]
pub struct RampRow {
    /// Fixed number: [`RAMP_NUMBERS`] more than that of the input.
    pub number: u32,
    /// Name in the form `group.name`.
    pub name: &'static str,
    /// Unit.
    pub measure: Measure,
    /// Usual size.
    pub nominal: f64,
    /// Meaning, plain text.
    pub text: &'static str,
}

/// Distance of the number of a ramp from that of its input.
pub const RAMP_NUMBERS: u32 = 20;

/// Largest time derivative that is an input, in units of the input per second.
pub const STEEPEST: f64 = 1e15;
