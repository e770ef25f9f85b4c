//! States of the pairs of nodes of a line and the history of their displacements.

use super::vectors::copy;
use crate::multistep::History;
use nalgebra::DVector;
use serde::{Deserialize, Serialize};

/// State of one pair of contact nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum NodeStatus {
    /// No contact.
    Open,
    /// Closed, no slip.
    Stick,
    /// Closed and slipping; the friction force on the wheel points to `+x`.
    SlipForward,
    /// Closed and slipping; the friction force on the wheel points to `−x`.
    SlipBackward,
}

impl NodeStatus {
    /// True if the pair is closed.
    pub fn is_active(self) -> bool {
        match self {
            NodeStatus::Open => false,
            NodeStatus::Stick | NodeStatus::SlipForward | NodeStatus::SlipBackward => true,
        }
    }

    /// True if the pair is closed and does not slip.
    pub fn is_stuck(self) -> bool {
        match self {
            NodeStatus::Stick => true,
            NodeStatus::Open | NodeStatus::SlipForward | NodeStatus::SlipBackward => false,
        }
    }

    /// Direction of the friction force on the wheel: ±1 in slip, 0 otherwise.
    pub fn friction_direction(self) -> f64 {
        match self {
            NodeStatus::SlipForward => 1.0,
            NodeStatus::SlipBackward => -1.0,
            NodeStatus::Open | NodeStatus::Stick => 0.0,
        }
    }
}

/// Contact patches: calls `f` with every maximal run of closed nodes as an index range, x ascending.
pub fn for_each_patch(status: &[NodeStatus], mut f: impl FnMut(std::ops::Range<usize>)) {
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

/// States of the candidates of a line, with gaps and slips, and the history of their displacements.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct GridState {
    /// Size of the nodes over those of the grid \[1].
    pub size: f64,
    /// Width of the line over that of the bodies \[1].
    pub share: f64,
    /// States of the candidates.
    pub status: Vec<NodeStatus>,
    /// Yielding of the candidates: true where the pressure of a closed pair is at its limit.
    pub yielded: Vec<bool>,
    /// Slip velocity of the wheel relative to the rail at closed nodes as the friction law sees it, with upwind
    /// differences; zero elsewhere [m/s].
    pub slip: Vec<f64>,
    /// Gap at open nodes, zero elsewhere \[m].
    pub gap: Vec<f64>,
    /// Tangential displacement of the wheel less that of the rail, and its history \[m].
    pub tangential_gap: Vec<History>,
    /// Part of it that becomes smaller where a line becomes wider, and its history \[m]: the displacement goes down by as
    /// much as this does. It is that of the line's own logarithm less twice the growth of that by all lines
    /// ([`Between::growth`](crate::contact::flexibility::Between)); empty: the line is in no patch.
    pub widened: Vec<History>,
    /// Contact forces on the wheel, x and y of every node [N/m].
    pub forces: DVector<f64>,
    /// Displacements of wheel and rail, x and y of every node \[m].
    pub surface: [DVector<f64>; 2],
    /// Pulls of hot layers at the candidates, on wheel and rail [N/m]; empty: there are none.
    pub pull: [Vec<f64>; 2],
    /// Elastic forces on wheel and rail, x and y of every node, and their histories [N/m]; empty: the line answers at once.
    pub elastic: [Vec<History>; 2],
    /// Lateral part.
    pub across: AcrossNodes,
}

/// Lateral part of the states of the candidates; empty where tractions and slips have none.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct AcrossNodes {
    /// Lateral forces on the wheel [N/m].
    pub force: Vec<f64>,
    /// Lateral slip velocity of the wheel relative to the rail at closed nodes as the friction law sees it; zero elsewhere
    /// [m/s].
    pub slip: Vec<f64>,
    /// Lateral displacement of the wheel less that of the rail, and its history \[m].
    pub gap: Vec<History>,
    /// Part of it that becomes smaller where a line becomes wider, see [`GridState::widened`].
    pub widened: Vec<History>,
}

impl AcrossNodes {
    /// Makes room for `n` candidates, of which further ones have had no force.
    pub fn reach(&mut self, n: usize) {
        self.force.resize(n, 0.0);
        self.slip.resize(n, 0.0);
        self.gap.resize(n, History::default());
    }

    /// True if it is empty or has `n` finite candidates.
    pub fn fits(&self, n: usize) -> bool {
        let lengths = [self.force.len(), self.slip.len(), self.gap.len()];
        let widened = self.widened.is_empty() || self.widened.len() == n;
        widened
            && (lengths == [0; 3] || lengths == [n; 3])
            && self.force.iter().chain(&self.slip).all(|value| value.is_finite())
    }
}

impl GridState {
    /// Becomes equal to another state and keeps its memory.
    pub(crate) fn copy_from(&mut self, other: &Self) {
        self.status.clone_from(&other.status);
        self.yielded.clone_from(&other.yielded);
        self.slip.clone_from(&other.slip);
        self.gap.clone_from(&other.gap);
        self.tangential_gap.clone_from(&other.tangential_gap);
        self.widened.clone_from(&other.widened);
        (self.size, self.share) = (other.size, other.share);
        copy(&mut self.forces, &other.forces);
        self.surface.iter_mut().zip(&other.surface).for_each(|(ours, theirs)| copy(ours, theirs));
        self.pull.iter_mut().zip(&other.pull).for_each(|(ours, theirs)| ours.clone_from(theirs));
        self.elastic.iter_mut().zip(&other.elastic).for_each(|(ours, theirs)| ours.clone_from(theirs));
        let (across, other) = (&mut self.across, &other.across);
        across.force.clone_from(&other.force);
        across.slip.clone_from(&other.slip);
        across.gap.clone_from(&other.gap);
        across.widened.clone_from(&other.widened);
    }
}
