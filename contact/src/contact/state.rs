//! Result of a contact solution and start of the next one.

use super::line::{GridState, LineHistory};
use super::traction::Traction;
use serde::{Deserialize, Serialize};

/// Result of a contact solution on one line and start of the next one.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ContactState {
    /// Forces, motions and profiles.
    pub traction: Traction,
    /// Rim angle and friction that the next step refers to.
    pub history: LineHistory,
    /// Elastic energy of the flexibility that lines have for themselves [J/m].
    pub energy: f64,
    /// States of the nodes.
    pub grid: GridState,
}

impl ContactState {
    /// Takes away all slip and its dissipation: the state of a wheel at rest.
    pub fn rest(&mut self) {
        self.traction.rest();
        self.history.friction.rest();
    }

    /// Angle by which the rim under the contact has turned against the hub, positive where the tread moves towards `+x`
    /// \[rad].
    pub fn rim_angle(&self) -> f64 {
        self.history.rim_angle.now
    }
}
