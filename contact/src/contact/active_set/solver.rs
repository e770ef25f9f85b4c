//! Contact solver that finds the states of a line by an active set.

use super::search::{ActiveSet, ActiveSetScratch};
use crate::contact::error::ContactError;
use crate::contact::line::ContactGrid;
use crate::contact::line::contact_line::{LineStart, Resumed};
use crate::contact::line::history::LineHistory;
use crate::contact::line::state::{GridState, NodeStatus};
use crate::contact::line::vectors::copy;
use crate::contact::problem::{Begin, ContactProblem, LineProblem};
use crate::contact::state::ContactState;
use crate::contact::traction::Traction;
use crate::linalg::POINTS;
use crate::multistep::History;
use crate::piecewise::Piecewise;
use nalgebra::DVector;
use std::hash::{Hash, Hasher};

/// Contact solver on the paired nodes of a line: finds the contact forces of one step, or of a stationary state. A
/// [`ContactState`] is that of one line.
#[derive(Clone, Debug)]
pub struct ActiveSetSolver {
    grid: ContactGrid,
}

impl ActiveSetSolver {
    /// A solver whose patches stay within a grid.
    pub fn new(grid: ContactGrid) -> Self {
        Self { grid }
    }
}

/// Makes `found` the start of a search, which begins with its states where they are `resumed`.
fn begin<'a>(start: &ContactState, found: &'a mut ContactState, resumed: bool) -> LineStart<'a> {
    let before = &start.grid;
    let size_before = before.size;
    let ContactState { traction, history, energy, grid: state } = found;
    let resumed = resumed.then(|| Resumed::take(state));
    state.copy_from(before);
    history.copy_from(&start.history);
    let (friction, old) = (&mut traction.friction, &start.traction.friction);
    (friction.tread_slip, friction.law_slope) = (old.tread_slip, old.law_slope);
    for (ours, theirs) in traction.surface.iter_mut().zip(&start.traction.surface) {
        copy(ours, theirs);
    }
    LineStart { state, history, traction, energy, resumed, size_before }
}

impl ActiveSetSolver {
    /// Solves a problem, on nodes that follow the load where they are to and may.
    fn find(
        &self,
        (problem, follow): (&ContactProblem, bool),
        start: &[&ContactState],
        found: &mut [&mut ContactState],
        scratch: &mut ActiveSetScratch,
    ) -> Result<(), ContactError> {
        // Once lines have a lateral part they keep it; before, nothing is sought across.
        let sideways = problem.moves_sideways() || start.iter().any(|start| start.grid.directions() > 1);
        let resumed = follow && problem.begin == Begin::Found && !sideways;
        let begun = start.iter().zip(found).map(|(start, found)| begin(start, found, resumed));
        let mut starts: Vec<_> = begun.collect();
        for LineStart { state, history, .. } in starts.iter_mut().filter(|_| sideways) {
            state.reach_across(self.grid.len());
            history.friction.reach(2 * self.grid.len());
        }
        ActiveSet::new(&self.grid, (problem, follow), starts, scratch).run()
    }

    /// A start for [`Self::solve`]: bodies that touch and stick within `half_width` \[m] of the contact point, without
    /// forces yet.
    pub fn touching(&self, half_width: f64) -> ContactState {
        let reach = half_width.max(0.5 * self.grid.spacing);
        let touches = |x: &f64| if x.abs() < reach { NodeStatus::Stick } else { NodeStatus::Open };
        let (n, nodal) = (self.grid.len(), || DVector::zeros(self.grid.components()));
        let state = GridState {
            size: 1.0,
            share: 1.0,
            status: self.grid.x.iter().map(touches).collect(),
            yielded: vec![false; n],
            slip: [vec![0.0; n], Vec::new()],
            gap: vec![0.0; n],
            moved: [vec![History::default(); n], Vec::new()],
            forces: nodal(),
            surface: [nodal(), nodal()],
            ..GridState::default()
        };
        ContactState {
            traction: Traction::without_forces(),
            history: LineHistory::none(n),
            grid: state,
            ..ContactState::default()
        }
    }

    /// Solves `problem` from the results `start` of the step before, one for each of its lines, and writes all of
    /// `found`; on error `found` is meaningless.
    pub fn solve(
        &self,
        problem: &ContactProblem,
        start: &[&ContactState],
        found: &mut [&mut ContactState],
        scratch: &mut ActiveSetScratch,
    ) -> Result<(), ContactError> {
        let fits = |line: &LineProblem| line.bodies.shared.relative.nrows() == 2 * POINTS;
        if !problem.lines.iter().all(fits) || [start.len(), found.len()] != [problem.lines.len(); 2] {
            return Err(ContactError::ForeignState);
        }
        match self.find((problem, true), start, found, scratch) {
            // A patch that outgrows small nodes in one step has room on those of the grid.
            Err(ContactError::ZoneExceeded { .. }) if problem.lines.iter().any(LineProblem::is_on_small_nodes) => {
                self.find((problem, false), start, found, scratch)
            }
            solved => solved,
        }
    }

    /// True if a state has the dimensions of this solver.
    pub fn fits(&self, state: &ContactState) -> bool {
        let ContactState { grid, history, traction, .. } = state;
        let (n, components) = (self.grid.len(), self.grid.components());
        grid.fits(n, components) && history.friction.fits(n * grid.directions()) && traction.fits()
    }

    /// Writes the decisions between open, stick and slip with which a state was found: along states with the same ones the
    /// solution is a smooth function of the data.
    pub fn decisions(&self, state: &ContactState, into: &mut impl Hasher) {
        for (status, yielded) in state.grid.status.iter().zip(&state.grid.yielded) {
            (*status as u8 + 4 * u8::from(*yielded)).hash(into);
        }
    }

    /// Tangential strains `∂u_x/∂x` of the surfaces of wheel and rail \[1].
    pub fn surface_strain(&self, state: &ContactState) -> [Piecewise; 2] {
        let grid = &self.grid.scaled(state.grid.size);
        let strains = |u| (0..grid.len()).map(|i| grid.slope(u, i, 0)).collect();
        state.grid.surface.each_ref().map(|u| Piecewise { x: grid.x.clone(), value: strains(u) })
    }
}
