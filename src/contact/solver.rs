//! The seam behind which contact is solved.

use super::active_set::iterate::ActiveSetScratch;
use super::error::ContactError;
use super::line::state::LineState;
use super::problem::ContactProblem;
use super::series::state::{SeriesState, SlipHistory};
use super::traction::Traction;
use crate::piecewise::Piecewise;
use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

/// Finds the contact forces of one step, or of a stationary state.
pub trait ContactSolver: Send + Sync {
    /// Corrects the surface compliances of wheel and rail [m/(N/m)] for the way in which this solver discretises the
    /// surface; called once for every new step size, before any [`Self::solve`] with them.
    fn correct(&self, _wheel: &mut DMatrix<f64>, _rail: &mut DMatrix<f64>) {}

    /// Elastic energy that the correction stores, or what else of the bodies only the solver knows [J/m].
    fn correction_energy(&self, _state: &ContactState) -> f64 {
        0.0
    }

    /// A start for [`Self::solve`]: bodies that touch and stick within `half_width` \[m] of the contact point, without
    /// forces yet.
    fn touching(&self, half_width: f64) -> ContactState;

    /// Solves `problem` from the result `start` of the step before and writes all of `found`; on error `found` is
    /// meaningless.
    fn solve(
        &self,
        problem: &ContactProblem,
        start: &ContactState,
        found: &mut ContactState,
        scratch: &mut Scratch,
    ) -> Result<(), ContactError>;

    /// The same state with room for wider patches or for more than one, where [`Self::solve`] found them to exceed the zone or
    /// what it can describe; its `port_forces` are those of another surface. `None` if there is no more room.
    fn widened(&self, _state: &ContactState) -> Option<ContactState> {
        None
    }

    /// The same state without that room, if it has it and the patches under about the load `nominal_load` [N/m] no longer
    /// need it.
    fn narrowed(&self, _state: &ContactState, _nominal_load: f64) -> Option<ContactState> {
        None
    }

    /// Tangential strains `∂u_x/∂x` of the surfaces of wheel and rail \[1]; empty where the solver does not know them.
    fn surface_strain(&self, _traction: &Traction) -> [Piecewise; 2] {
        Default::default()
    }

    /// Whether a state has the dimensions of this solver.
    fn fits(&self, state: &ContactState) -> bool;
}

/// Result of a contact solution and start of the next one.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ContactState {
    /// What the contact is for everyone else.
    pub traction: Traction,
    /// What its solver remembers.
    pub solver: SolverState,
}

/// Memory of a contact solver from step to step.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub enum SolverState {
    /// Nothing but the traction.
    #[default]
    Stateless,
    /// Of the active set on paired nodes.
    Line(Box<LineState>),
    /// Of the series on a single patch.
    Series(Box<SeriesState>),
}

impl ContactState {
    /// Takes away all slip, and what it dissipates: the state of a wheel at rest.
    pub fn rest(&mut self) {
        self.traction.rest();
        match &mut self.solver {
            SolverState::Line(grid) => {
                grid.slip.fill(0.0);
                grid.friction.slip.fill(0.0);
                grid.friction.slope_power = 0.0;
            }
            SolverState::Series(patch) => {
                patch.friction = SlipHistory { slip: Default::default(), slope_power: 0.0, ..patch.friction };
            }
            SolverState::Stateless => {}
        }
    }

    /// Angle by which the rim under the contact has turned against the hub, positive where the tread moves towards `+x` \[rad].
    pub fn rim_angle(&self) -> f64 {
        match &self.solver {
            SolverState::Line(line) => line.rim_angle.now,
            SolverState::Series(series) => series.rim_angle.now,
            SolverState::Stateless => 0.0,
        }
    }

    /// Whether both were found with the same decisions between open, stick and slip everywhere: along such states the
    /// solution is a smooth function of the data.
    pub fn same_branch(&self, other: &Self) -> bool {
        match (&self.solver, &other.solver) {
            (SolverState::Line(a), SolverState::Line(b)) => a.status == b.status && a.yielded == b.yielded,
            (SolverState::Series(a), SolverState::Series(b)) => a.tractions.same_branch(&b.tractions),
            (SolverState::Stateless, SolverState::Stateless) => true,
            _ => false,
        }
    }
}

/// Buffers of the contact solvers; nothing in them outlives a solution.
#[derive(Default)]
pub struct Scratch {
    /// Of the active set on paired nodes.
    pub active_set: ActiveSetScratch,
}
