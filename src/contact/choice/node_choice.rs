//! Contact solver that hands a contact to the solver on the nodes that suit it.

use super::stay::Stay;
use super::transfer;
use crate::contact::active_set::ActiveSetSolver;
use crate::contact::error::ContactError;
use crate::contact::line::ContactGrid;
use crate::contact::problem::ContactProblem;
use crate::contact::series::SeriesSolver;
use crate::contact::solver::{ContactScratch, ContactSolver, ContactState, SolverState};
use crate::piecewise::Piecewise;
use std::hash::Hasher;

/// Contact on points that move with the patch where there are any and they describe it, and on fixed nodes elsewhere.
#[derive(Clone, Debug)]
pub struct NodeChoice {
    points: Option<SeriesSolver>,
    fixed: ActiveSetSolver,
}

impl NodeChoice {
    /// Contact on a `grid`, and on `points` for smooth patches.
    pub fn new(grid: ContactGrid, points: Option<SeriesSolver>) -> Self {
        Self { points, fixed: ActiveSetSolver::new(grid) }
    }

    /// Solver on the nodes of a state.
    fn of(&self, state: &ContactState) -> Option<&dyn ContactSolver> {
        match state.solver {
            SolverState::Series(_) => self.points.as_ref().map(|points| points as &dyn ContactSolver),
            SolverState::Grid(_) => Some(&self.fixed),
            SolverState::Stateless => None,
        }
    }

    /// Lines of the points on the grid.
    fn to_grid(&self, lines: &[&ContactState]) -> Option<Vec<ContactState>> {
        let points = self.points.as_ref()?;
        let moved = |line: &&ContactState| {
            let target = ContactState { stay: Stay::LONG, ..self.fixed.touching(0.0) };
            transfer::to_grid(points.constants(), line, self.fixed.grid(), target)
        };
        lines.iter().map(moved).collect()
    }

    /// Lines of a grid on the points, if none is to stay and all fit.
    fn to_points(&self, lines: &[&ContactState]) -> Option<Vec<ContactState>> {
        let points = self.points.as_ref().filter(|_| lines.iter().all(|line| line.stay.is_over()))?;
        lines.iter().map(|line| transfer::to_points(points.constants(), self.fixed.grid(), line)).collect()
    }
}

impl ContactSolver for NodeChoice {
    fn touching(&self, half_width: f64) -> ContactState {
        match &self.points {
            Some(points) if half_width < points.reach() => points.touching(half_width),
            Some(_) | None => self.fixed.touching(half_width),
        }
    }

    fn touching_at_rest(&self, half_width: f64) -> ContactState {
        ContactState { stay: Stay::LONG, ..self.fixed.touching(half_width) }
    }

    fn solve(
        &self,
        problem: &ContactProblem,
        start: &[&ContactState],
        found: &mut [&mut ContactState],
        scratch: &mut ContactScratch,
    ) -> Result<(), ContactError> {
        let first = start.first().ok_or(ContactError::ForeignState)?;
        let alike = start.iter().all(|line| line.on_points() == first.on_points());
        let solver = self.of(first).filter(|_| alike);
        solver.ok_or(ContactError::ForeignState)?.solve(problem, start, found, scratch)?;
        for (line, (start, found)) in problem.lines.iter().zip(start.iter().zip(found)) {
            let (rigid, traction) = (&problem.rigid, &found.traction);
            found.stay = match &self.points {
                Some(points) if !start.on_points() && !line.time.is_stationary() => start
                    .stay
                    .after_step(|| SeriesSolver::stands(rigid, line, traction), || points.suits(rigid, line, traction)),
                Some(_) | None => start.stay,
            };
        }
        Ok(())
    }

    fn fits(&self, state: &ContactState) -> bool {
        self.of(state).is_some_and(|solver| solver.fits(state))
    }

    fn decisions(&self, state: &ContactState, into: &mut dyn Hasher) {
        if let Some(solver) = self.of(state) {
            solver.decisions(state, into);
        }
    }

    fn on_other_nodes(&self, lines: &[&ContactState]) -> Option<Vec<ContactState>> {
        if lines.first()?.on_points() { self.to_grid(lines) } else { None }
    }

    fn on_preferred_nodes(&self, lines: &[&ContactState]) -> Option<Vec<ContactState>> {
        if lines.first()?.on_points() { None } else { self.to_points(lines) }
    }

    fn surface_strain(&self, state: &ContactState) -> [Piecewise; 2] {
        self.of(state).map_or_else(Default::default, |solver| solver.surface_strain(state))
    }
}
