//! What the solver on the grid remembers, and its buffers.

use super::status::Status;
use super::streamline::Upwind;
use crate::linalg::DenseSystem;
use crate::multistep::History;
use nalgebra::DVector;
use serde::{Deserialize, Serialize};

/// What the solver on the grid remembers from step to step.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct GridState {
    /// States of the candidates.
    pub status: Vec<Status>,
    /// Slip velocity of the wheel relative to the rail at closed nodes as the friction law sees it, with upwind
    /// differences; zero elsewhere [m/s].
    pub slip: Vec<f64>,
    /// Gap at open nodes, zero elsewhere \[m].
    pub gap: Vec<f64>,
    /// Tangential displacement of the wheel less that of the rail, and its history \[m].
    pub tangential_gap: Vec<History>,
}

impl GridState {
    pub(super) fn copy_from(&mut self, other: &Self) {
        self.status.clone_from(&other.status);
        self.slip.clone_from(&other.slip);
        self.gap.clone_from(&other.gap);
        self.tangential_gap.clone_from(&other.tangential_gap);
    }
}

/// Buffers of the solver on the grid.
#[derive(Default)]
pub struct GridScratch {
    pub(super) system: DenseSystem,
    /// Nodes and axes whose forces and motions are unknown.
    pub(super) closed: Vec<usize>,
    pub(super) stuck: Vec<usize>,
    pub(super) axes: Vec<usize>,
    /// Undeformed gap at the candidates [m].
    pub(super) gap: Vec<f64>,
    /// Known part of `d_t` of the tangential gap [m/s].
    pub(super) slip_offset: Vec<f64>,
    /// Displacement of wheel and rail without contact forces and unknown motions [m].
    pub(super) known: [DVector<f64>; 2],
    pub(super) upwind: Vec<Upwind>,
    pub(super) upwind_before: Vec<Upwind>,
    pub(super) status_before: Vec<Status>,
    /// Coefficients of all port forces in the row at hand.
    pub(super) row: Vec<f64>,
    /// Slip velocity with centred differences: what dissipates. The upwind one counts its own numerical dissipation.
    pub(super) centred_slip: Vec<f64>,
}

/// Copies without allocating where the lengths agree.
pub(super) fn copy(target: &mut DVector<f64>, source: &DVector<f64>) {
    if target.len() == source.len() { target.copy_from(source) } else { target.clone_from(source) }
}
