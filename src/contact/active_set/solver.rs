//! Contact solver that finds the states of a line by an active set.

use super::search::ActiveSet;
use crate::contact::error::ContactError;
use crate::contact::line::ContactGrid;
use crate::contact::line::contact_line::LineStart;
use crate::contact::line::history::LineHistory;
use crate::contact::line::regrid;
use crate::contact::line::state::{LineState, NodeStatus};
use crate::contact::line::vectors::copy;
use crate::contact::problem::{ContactProblem, LineProblem};
use crate::contact::solver::{ContactScratch, ContactSolver, ContactState, Ports, SolverState};
use crate::contact::traction::Traction;
use crate::multistep::History;
use crate::piecewise::Piecewise;
use nalgebra::DVector;

/// Contact solver on the paired nodes of a line.
#[derive(Clone, Debug)]
pub struct ActiveSetSolver {
    /// Grid for ordinary patches.
    narrow: ContactGrid,
    /// Grid about the same middle for wide ones.
    wide: Option<ContactGrid>,
}

impl ActiveSetSolver {
    /// A solver whose patches stay within one grid.
    pub fn new(grid: ContactGrid) -> Self {
        Self { narrow: grid, wide: None }
    }

    /// With a wider grid for patches that reach the end of the first one; its innermost nodes are those of the first.
    pub fn with_wider(mut self, wider: ContactGrid) -> Self {
        self.wide = Some(wider);
        self
    }

    /// Grid of the nodes that are ports.
    pub(in crate::contact) fn grid(&self, ports: Ports) -> Option<&ContactGrid> {
        match ports {
            Ports::Narrow => Some(&self.narrow),
            Ports::Wide => self.wide.as_ref(),
            Ports::Smooth => None,
        }
    }

    /// A state on the nodes of another grid.
    fn moved(&self, state: &ContactState, ports: Ports) -> Option<ContactState> {
        let grid = self.grid(ports)?;
        let mut moved = state.clone();
        let ContactState { traction, history, solver, .. } = &mut moved;
        let SolverState::Line(own) = solver else { return None };
        regrid::move_to(grid, own, &mut history.friction, traction);
        moved.ports = ports;
        Some(moved)
    }
}

/// Makes `found` the start of a search.
fn begin<'a>(start: &ContactState, found: &'a mut ContactState) -> Result<LineStart<'a>, ContactError> {
    let SolverState::Line(before) = &start.solver else { return Err(ContactError::ForeignState) };
    let ContactState { ports, traction, history, energy, solver } = found;
    if !matches!(solver, SolverState::Line(_)) {
        *solver = SolverState::Line(Box::default());
    }
    let SolverState::Line(state) = solver else { return Err(ContactError::ForeignState) };
    state.copy_from(before);
    history.copy_from(&start.history);
    *ports = start.ports;
    copy(&mut traction.port_forces, &start.traction.port_forces);
    traction.friction.tread_slip = start.traction.friction.tread_slip;
    for (ours, theirs) in traction.surface.iter_mut().zip(&start.traction.surface) {
        copy(ours, theirs);
    }
    Ok(LineStart { state, history, traction, energy })
}

impl ContactSolver for ActiveSetSolver {
    fn touching(&self, half_width: f64) -> ContactState {
        let holds = self.narrow.x.last().is_some_and(|end| half_width < *end);
        let (ports, grid) = match &self.wide {
            Some(wide) if !holds => (Ports::Wide, wide),
            Some(_) | None => (Ports::Narrow, &self.narrow),
        };
        let reach = half_width.max(0.5 * grid.spacing);
        let touches = |x: &f64| if x.abs() < reach { NodeStatus::Stick } else { NodeStatus::Open };
        let (n, zeros) = (grid.len(), DVector::zeros(grid.ports()));
        let state = LineState {
            status: grid.x.iter().map(touches).collect(),
            yielded: vec![false; n],
            slip: vec![0.0; n],
            gap: vec![0.0; n],
            tangential_gap: vec![History::default(); n],
            rest: 0,
        };
        let [loads, surface] = [(); 2].map(|()| [zeros.clone(), zeros.clone()]);
        let traction = Traction { port_forces: zeros, loads, surface, ..Traction::default() };
        let solver = SolverState::Line(Box::new(state));
        ContactState { ports, traction, history: LineHistory::none(n), energy: 0.0, solver }
    }

    fn solve(
        &self,
        problem: &ContactProblem,
        start: &[&ContactState],
        found: &mut [&mut ContactState],
        scratch: &mut ContactScratch,
    ) -> Result<(), ContactError> {
        let ports = start.first().ok_or(ContactError::ForeignState)?.ports;
        let grid = self.grid(ports).ok_or(ContactError::ForeignState)?;
        let fits = |line: &LineProblem| line.bodies.shared.relative.nrows() == grid.ports();
        if !problem.lines.iter().all(fits) || [start.len(), found.len()] != [problem.lines.len(); 2] {
            return Err(ContactError::ForeignState);
        }
        let begun = start.iter().zip(found).map(|(start, found)| begin(start, found));
        let starts = begun.collect::<Result<Vec<_>, _>>()?;
        ActiveSet::new(grid, problem, starts, &mut scratch.active_set).run()
    }

    fn fits(&self, state: &ContactState) -> bool {
        let (SolverState::Line(line), Some(grid)) = (&state.solver, self.grid(state.ports)) else { return false };
        let (n, traction) = (grid.len(), &state.traction);
        let vectors = traction.loads.iter().chain(&traction.surface).chain([&traction.port_forces]);
        [line.status.len(), line.slip.len(), line.gap.len(), line.tangential_gap.len(), line.yielded.len()] == [n; 5]
            && state.history.friction.fits(n)
            && vectors.into_iter().all(|values| values.len() == grid.ports())
            && traction.port_forces.iter().all(|f| f.is_finite())
    }

    fn same_branch(&self, a: &ContactState, b: &ContactState) -> bool {
        match (&a.solver, &b.solver) {
            (SolverState::Line(a), SolverState::Line(b)) => a.status == b.status && a.yielded == b.yielded,
            (SolverState::Line(_) | SolverState::Series(_) | SolverState::Stateless, _) => false,
        }
    }

    fn widened(&self, state: &ContactState) -> Option<ContactState> {
        match state.ports {
            Ports::Narrow => self.moved(state, Ports::Wide),
            Ports::Wide | Ports::Smooth => None,
        }
    }

    fn narrowed(&self, state: &ContactState, nominal_load: f64) -> Option<ContactState> {
        let (Ports::Wide, Some(wide), SolverState::Line(line)) = (state.ports, &self.wide, &state.solver) else {
            return None;
        };
        let may = regrid::fits_into(&self.narrow, wide, line, &state.traction, nominal_load);
        if may { self.moved(state, Ports::Narrow) } else { None }
    }

    fn surface_strain(&self, state: &ContactState) -> [Piecewise; 2] {
        let Some(grid) = self.grid(state.ports) else { return Default::default() };
        [0, 1].map(|body| {
            let u = &state.traction.surface[body];
            let strain = |i: usize| {
                let port = grid.port(i);
                (u[port + 2] - u[port - 2]) / grid.span(i)
            };
            Piecewise { x: grid.x.clone(), value: (0..grid.len()).map(strain).collect() }
        })
    }
}
