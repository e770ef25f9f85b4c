//! Seam behind which contact is solved.

use super::active_set::ActiveSetScratch;
use super::choice::Stay;
use super::error::ContactError;
use super::line::LineHistory;
use super::line::state::GridState;
use super::problem::ContactProblem;
use super::series::state::SeriesState;
use super::traction::Traction;
use crate::linalg::DenseSystem;
use crate::piecewise::Piecewise;
use serde::{Deserialize, Serialize};
use std::hash::Hasher;

/// Finds the contact forces of one step, or of a stationary state.
///
/// A [`ContactState`] is that of one line; a solver may refuse problems of several lines
/// ([`ContactError::SingleLine`]).
pub trait ContactSolver: Send + Sync {
    /// A start for [`Self::solve`]: bodies that touch and stick within `half_width` \[m] of the contact point, without
    /// forces yet.
    fn touching(&self, half_width: f64) -> ContactState;

    /// A start for bodies that rest and stick: on other nodes, if [`Self::solve`] takes the first steps on them.
    fn touching_at_rest(&self, half_width: f64) -> ContactState {
        self.touching(half_width)
    }

    /// Solves `problem` from the results `start` of the step before, one for each of its lines, and writes all of
    /// `found`; on error `found` is meaningless.
    fn solve(
        &self,
        problem: &ContactProblem,
        start: &[&ContactState],
        found: &mut [&mut ContactState],
        scratch: &mut ContactScratch,
    ) -> Result<(), ContactError>;

    /// True if a state has the dimensions of this solver.
    fn fits(&self, state: &ContactState) -> bool;

    /// Writes the decisions between open, stick and slip with which a state was found: along states with the same ones the
    /// solution is a smooth function of the data.
    fn decisions(&self, _state: &ContactState, _into: &mut dyn Hasher) {}

    /// The lines of a contact on other nodes, on which [`Self::solve`] may find it where it has not on theirs; all are
    /// on the same ones. `None` if there are no others.
    fn on_other_nodes(&self, _lines: &[&ContactState]) -> Option<Vec<ContactState>> {
        None
    }

    /// The lines of a contact on nodes that the solver prefers to theirs, if the contact fits on them; all are on the same ones.
    fn on_preferred_nodes(&self, _lines: &[&ContactState]) -> Option<Vec<ContactState>> {
        None
    }

    /// Tangential strains `∂u_x/∂x` of the surfaces of wheel and rail \[1]; empty where the solver does not know them.
    fn surface_strain(&self, _state: &ContactState) -> [Piecewise; 2] {
        Default::default()
    }
}

/// Result of a contact solution and start of the next one.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ContactState {
    /// Forces, motions and profiles.
    pub traction: Traction,
    /// History that the next step refers to.
    pub history: LineHistory,
    /// Elastic energy of the flexibility that lines have for themselves [J/m].
    pub energy: f64,
    /// Power that this flexibility takes where it is retarded [W/m].
    pub damping: f64,
    /// Memory of the solver.
    pub solver: SolverState,
    /// Memory of the choice between kinds of nodes.
    pub stay: Stay,
}

/// Memory of a contact solver from step to step. States are stored, so that this is the one list of solvers; each looks
/// at its own alone.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub enum SolverState {
    /// No memory.
    #[default]
    Stateless,
    /// Of a line on paired nodes.
    Grid(Box<GridState>),
    /// Of a line as series.
    Series(Box<SeriesState>),
}

impl SolverState {
    /// Memory of a line on paired nodes, if it is one.
    pub fn grid(&self) -> Option<&GridState> {
        if let Self::Grid(state) = self { Some(state) } else { None }
    }

    /// Memory of a line as series, if it is one.
    pub fn series(&self) -> Option<&SeriesState> {
        if let Self::Series(state) = self { Some(state) } else { None }
    }
}

impl ContactState {
    /// True if it is on points that move with the patch.
    pub fn on_points(&self) -> bool {
        matches!(self.solver, SolverState::Series(_))
    }

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

/// Buffers of the contact solvers; nothing in them outlives a solution.
#[derive(Default)]
pub struct ContactScratch {
    /// Of the active set on paired nodes.
    pub active_set: ActiveSetScratch,
    /// Equations of all lines on series.
    pub series: DenseSystem,
    /// Times that the law of friction was made linear for the last contact on points with lateral tractions.
    pub linear_laws: usize,
}
