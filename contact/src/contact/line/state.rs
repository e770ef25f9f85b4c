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

/// Slipping of a node along and across: its friction has a direction, and turns against the slip that turns.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Slide {
    /// Direction of friction on the wheel, of length 1.
    pub direction: [f64; 2],
    /// Slip across this direction per force across it that the node loses when it turns by it [m/s/(N/m)].
    pub turn: f64,
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

/// States of the candidates of a line, with gaps and slips, and the history of their displacements. Of quantities along and
/// across the latter are empty where tractions and slips have no lateral part.
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
    /// Slip velocity of the wheel relative to the rail at closed nodes as the friction law sees it, along and across, with
    /// upwind differences; zero elsewhere [m/s].
    pub slip: [Vec<f64>; 2],
    /// Friction that stuck candidates left unused one step ago [N/m], or the slip of those that slipped, negative [m/s]; empty: there
    /// is no such step.
    pub reserve: Vec<f64>,
    /// Slides of the candidates one step ago; empty: there is no such step, or friction has no part across.
    pub slid: Vec<Slide>,
    /// Gap at open nodes, zero elsewhere \[m].
    pub gap: Vec<f64>,
    /// Displacement of the wheel less that of the rail, along and across, and its history \[m].
    pub moved: [Vec<History>; 2],
    /// Part of it that becomes smaller where a line becomes wider, and its history \[m]: the displacement goes down by as
    /// much as this does. It is that of the line's own logarithm less twice the growth of that by all lines
    /// ([`Between::growth`](crate::contact::flexibility::Between)); empty: the line is in no patch.
    pub widened: [Vec<History>; 2],
    /// Contact forces on the wheel, x and y of every node [N/m].
    pub forces: DVector<f64>,
    /// Lateral forces on the wheel at the candidates [N/m].
    pub lateral: Vec<f64>,
    /// Displacements of wheel and rail, x and y of every node \[m].
    pub surface: [DVector<f64>; 2],
    /// Pulls of hot layers at the candidates, on wheel and rail [N/m]; empty: there are none.
    pub pull: [Vec<f64>; 2],
}

/// Becomes equal to another vector of each direction or body and keeps its memory.
fn clone_each<T: Clone>(ours: &mut [Vec<T>; 2], others: &[Vec<T>; 2]) {
    ours.iter_mut().zip(others).for_each(|(ours, other)| ours.clone_from(other));
}

impl GridState {
    /// Directions in which tractions and slips are: 1, or 2 with a lateral part.
    pub fn directions(&self) -> usize {
        if self.lateral.is_empty() { 1 } else { 2 }
    }

    /// Makes room for a lateral part of `n` candidates, of which further ones have had no force.
    pub fn reach_across(&mut self, n: usize) {
        self.lateral.resize(n, 0.0);
        self.slip[1].resize(n, 0.0);
        self.moved[1].resize(n, History::default());
    }

    /// True if it is that of `n` candidates and of nodes with so many `components`, whose forces and slips are finite.
    pub fn fits(&self, n: usize, components: usize) -> bool {
        let along = [self.status.len(), self.yielded.len(), self.gap.len(), self.slip[0].len(), self.moved[0].len()];
        let across = [self.lateral.len(), self.slip[1].len(), self.moved[1].len()];
        let mut of_nodes = self.surface.iter().chain([&self.forces]);
        let mut numbers = self.forces.iter().chain(&self.lateral).chain(self.slip.iter().flatten());
        let mut slides = self.slid.iter().flat_map(|slide| [slide.direction[0], slide.direction[1], slide.turn]);
        let none_or = |length: usize, n: usize| length == 0 || length == n;
        along == [n; 5]
            && (across == [0; 3] || across == [n; 3])
            && of_nodes.all(|values| values.len() == components)
            && numbers.all(|value| value.is_finite())
            && slides.all(|value| value.is_finite())
            && [self.size, self.share].iter().all(|size| *size > 0.0 && size.is_finite())
            && [self.reserve.len(), self.slid.len()].iter().all(|length| none_or(*length, n))
            && self.widened.iter().all(|widened| none_or(widened.len(), n))
            && self.pull.iter().all(|pull| none_or(pull.len(), n))
    }

    /// Becomes equal to another state and keeps its memory.
    pub(crate) fn copy_from(&mut self, other: &Self) {
        (self.size, self.share) = (other.size, other.share);
        self.status.clone_from(&other.status);
        self.yielded.clone_from(&other.yielded);
        self.gap.clone_from(&other.gap);
        self.reserve.clone_from(&other.reserve);
        self.slid.clone_from(&other.slid);
        self.lateral.clone_from(&other.lateral);
        clone_each(&mut self.slip, &other.slip);
        clone_each(&mut self.moved, &other.moved);
        clone_each(&mut self.widened, &other.widened);
        clone_each(&mut self.pull, &other.pull);
        copy(&mut self.forces, &other.forces);
        self.surface.iter_mut().zip(&other.surface).for_each(|(ours, theirs)| copy(ours, theirs));
    }
}
