//! Frictional contact on a uniform grid of paired nodes: unilateral contact and exact Coulomb friction.
//!
//! The bodies enter only through their surface compliance, so this room knows neither finite elements nor time
//! stepping. Everything is per metre of width. Forces are those on the *wheel*: `F_x > 0` drives it forward, `F_y > 0`
//! (pressure) lifts it; the rail receives the opposite.

pub mod active_set;
pub mod geometry;
pub mod kernel;
pub mod patch;
pub mod problem;
pub mod streamline;

pub use active_set::ContactError;
pub use geometry::ContactGrid;
pub use problem::{ContactProblem, ContactSolution, RigidMotion, SurfaceResponse};

use serde::{Deserialize, Serialize};

/// State of one pair of contact nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Status {
    /// No contact.
    Open,
    /// Closed, no slip.
    Stick,
    /// Closed and slipping; the friction force on the wheel points to `+x`.
    SlipForward,
    /// Closed and slipping; the friction force on the wheel points to `−x`.
    SlipBackward,
}

impl Status {
    /// Whether the pair is closed.
    pub fn is_active(self) -> bool {
        self != Status::Open
    }

    /// Direction of the friction force on the wheel: ±1 in slip, 0 otherwise.
    pub fn friction_direction(self) -> f64 {
        match self {
            Status::SlipForward => 1.0,
            Status::SlipBackward => -1.0,
            Status::Open | Status::Stick => 0.0,
        }
    }
}

/// Maximal runs of closed nodes as index ranges, x ascending: the contact patches.
pub fn patches(status: &[Status]) -> Vec<std::ops::Range<usize>> {
    let mut runs = Vec::new();
    let mut start = None;
    for (i, s) in status.iter().enumerate() {
        match (s.is_active(), start) {
            (true, None) => start = Some(i),
            (false, Some(first)) => {
                runs.push(first..i);
                start = None;
            }
            _ => {}
        }
    }
    if let Some(first) = start {
        runs.push(first..status.len());
    }
    runs
}
