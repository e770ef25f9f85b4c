//! Directions in which inputs change, for derivatives by them.

use super::control::{Drive, Inputs};

/// Direction in which inputs change: their values at the start of a step, and their time derivatives.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Direction {
    /// Components of the values.
    pub drive: Drive,
    /// Components of the time derivatives.
    pub rate: Drive,
}

impl From<&Drive> for Direction {
    fn from(drive: &Drive) -> Self {
        Direction { drive: *drive, rate: Drive::default() }
    }
}

impl Direction {
    /// Inputs that lie a distance away from others along the direction.
    pub fn away(&self, from: &Inputs, by: f64) -> Inputs {
        let away = |value: f64, component: f64| value + by * component;
        Inputs { drive: from.drive.zip(&self.drive, away), rate: from.rate.zip(&self.rate, away), ..*from }
    }
}
