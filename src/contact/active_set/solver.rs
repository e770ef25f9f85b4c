//! Contact solver that finds the states of a line by an active set.

use super::search::ActiveSet;
use crate::contact::error::ContactError;
use crate::contact::line::ContactGrid;
use crate::contact::line::contact_line::{LineStart, Resumed};
use crate::contact::line::history::LineHistory;
use crate::contact::line::state::{GridState, NodeStatus};
use crate::contact::line::vectors::copy;
use crate::contact::problem::{Begin, ContactProblem, LineProblem};
use crate::contact::solver::{ContactScratch, ContactSolver, ContactState, SolverState};
use crate::contact::traction::Traction;
use crate::linalg::POINTS;
use crate::multistep::History;
use crate::piecewise::Piecewise;
use nalgebra::DVector;
use std::hash::{Hash, Hasher};

/// Contact solver on the paired nodes of a line.
#[derive(Clone, Debug)]
pub struct ActiveSetSolver {
    grid: ContactGrid,
}

impl ActiveSetSolver {
    /// A solver whose patches stay within a grid.
    pub fn new(grid: ContactGrid) -> Self {
        Self { grid }
    }

    /// Grid within which patches stay.
    pub fn grid(&self) -> &ContactGrid {
        &self.grid
    }
}

/// Makes `found` the start of a search, which begins with its states where they are `resumed`.
fn begin<'a>(start: &ContactState, found: &'a mut ContactState, resumed: bool) -> Result<LineStart<'a>, ContactError> {
    let before = start.solver.grid().ok_or(ContactError::ForeignState)?;
    let size_before = before.size;
    let ContactState { traction, history, energy, damping, solver, .. } = found;
    if !matches!(solver, SolverState::Grid(_)) {
        *solver = SolverState::Grid(Box::default());
    }
    let SolverState::Grid(state) = solver else { return Err(ContactError::ForeignState) };
    let resumed = resumed.then(|| Resumed::take(state));
    state.copy_from(before);
    history.copy_from(&start.history);
    let (friction, old) = (&mut traction.friction, &start.traction.friction);
    (friction.tread_slip, friction.law_slope) = (old.tread_slip, old.law_slope);
    for (ours, theirs) in traction.surface.iter_mut().zip(&start.traction.surface) {
        copy(ours, theirs);
    }
    Ok(LineStart { state, history, traction, energy, damping, resumed, size_before })
}

impl ActiveSetSolver {
    /// Solves a problem, on nodes that follow the load where they are to and may.
    fn find(
        &self,
        (problem, follow): (&ContactProblem, bool),
        start: &[&ContactState],
        found: &mut [&mut ContactState],
        scratch: &mut ContactScratch,
    ) -> Result<(), ContactError> {
        let resumed = follow && problem.begin == Begin::Found && !problem.is_sideways();
        let begun = start.iter().zip(found).map(|(start, found)| begin(start, found, resumed));
        let mut starts = begun.collect::<Result<Vec<_>, _>>()?;
        for LineStart { state, history, .. } in starts.iter_mut().filter(|_| problem.is_sideways()) {
            state.reach_across(self.grid.len());
            history.friction.reach(2 * self.grid.len());
        }
        ActiveSet::new(&self.grid, (problem, follow), starts, &mut scratch.active_set).run()
    }
}

impl ContactSolver for ActiveSetSolver {
    fn touching(&self, half_width: f64) -> ContactState {
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
            solver: SolverState::Grid(Box::new(state)),
            ..ContactState::default()
        }
    }

    fn solve(
        &self,
        problem: &ContactProblem,
        start: &[&ContactState],
        found: &mut [&mut ContactState],
        scratch: &mut ContactScratch,
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

    fn fits(&self, state: &ContactState) -> bool {
        let Some(line) = state.solver.grid() else { return false };
        let (n, components) = (self.grid.len(), self.grid.components());
        line.fits(n, components) && state.history.friction.fits(n * line.directions()) && state.traction.fits()
    }

    fn decisions(&self, state: &ContactState, mut into: &mut dyn Hasher) {
        let Some(state) = state.solver.grid() else { return };
        for (status, yielded) in state.status.iter().zip(&state.yielded) {
            (*status as u8 + 4 * u8::from(*yielded)).hash(&mut into);
        }
    }

    fn surface_strain(&self, state: &ContactState) -> [Piecewise; 2] {
        let Some(line) = state.solver.grid() else { return Default::default() };
        let grid = &self.grid.scaled(line.size);
        let strains = |u| (0..grid.len()).map(|i| grid.slope(u, i, 0)).collect();
        line.surface.each_ref().map(|u| Piecewise { x: grid.x.clone(), value: strains(u) })
    }
}
