//! States of the nodes, and the patches they form.

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

/// Calls `f` with every maximal run of closed nodes as an index range, x ascending: the contact patches.
pub fn for_each_patch(status: &[Status], mut f: impl FnMut(std::ops::Range<usize>)) {
    let mut start = None;
    for (i, s) in status.iter().enumerate() {
        match (s.is_active(), start) {
            (true, None) => start = Some(i),
            (false, Some(first)) => {
                f(first..i);
                start = None;
            }
            _ => {}
        }
    }
    if let Some(first) = start {
        f(first..status.len());
    }
}
