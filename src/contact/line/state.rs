//! What the solver on the grid remembers: the states of the pairs of nodes and their history.

use crate::multistep::History;
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

/// Friction at the end of the last step, and what the time formula attributes to that step.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FrictionHistory {
    /// Friction forces on the wheel at the candidates [N/m].
    pub force: Vec<f64>,
    /// Their impulses in the last step [N s/m].
    pub impulse: Vec<f64>,
    /// Slip velocities there with central differences [m/s].
    pub slip: Vec<f64>,
    /// The rest of the power: of pressure on the sliding slope of the rail, less that of expanding material [W/m].
    pub slope_power: f64,
    /// Its work in the last step [J/m].
    pub slope_work: f64,
}

impl FrictionHistory {
    /// Nothing has acted yet at `n` candidates.
    pub fn none(n: usize) -> Self {
        let zeros = || vec![0.0; n];
        Self { force: zeros(), impulse: zeros(), slip: zeros(), slope_power: 0.0, slope_work: 0.0 }
    }

    /// Becomes equal to another one and keeps its memory.
    fn copy_from(&mut self, other: &Self) {
        self.force.clone_from(&other.force);
        self.impulse.clone_from(&other.impulse);
        self.slip.clone_from(&other.slip);
        (self.slope_power, self.slope_work) = (other.slope_power, other.slope_work);
    }
}

/// What the solver on the grid remembers from step to step.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct LineState {
    /// States of the candidates.
    pub status: Vec<Status>,
    /// Whether the pressure of a closed pair is at its limit: the steel yields.
    pub yielded: Vec<bool>,
    /// Slip velocity of the wheel relative to the rail at closed nodes as the friction law sees it, with upwind
    /// differences; zero elsewhere [m/s].
    pub slip: Vec<f64>,
    /// Gap at open nodes, zero elsewhere \[m].
    pub gap: Vec<f64>,
    /// Tangential displacement of the wheel less that of the rail, and its history \[m].
    pub tangential_gap: Vec<History>,
    /// What the work of friction in the coming step depends on.
    pub friction: FrictionHistory,
    /// Angle by which the rim under the contact has turned against the hub, and its history, positive where the tread
    /// moves towards `+x` \[rad].
    pub rim_angle: History,
    /// Steps before another solver is tried again.
    pub rest: u32,
}

impl LineState {
    /// Becomes equal to another state and keeps its memory.
    pub(crate) fn copy_from(&mut self, other: &Self) {
        self.status.clone_from(&other.status);
        self.yielded.clone_from(&other.yielded);
        self.slip.clone_from(&other.slip);
        self.gap.clone_from(&other.gap);
        self.tangential_gap.clone_from(&other.tangential_gap);
        self.friction.copy_from(&other.friction);
        (self.rim_angle, self.rest) = (other.rim_angle, other.rest);
    }
}
