//! The contact solver on a grid, behind the seam that all contact solvers share.

use super::brake::founding_brakes;
use super::iterate::{Iterate, copy};
use crate::contact::error::ContactError;
use crate::contact::line::ContactGrid;
use crate::contact::line::kernel::KernelCorrection;
use crate::contact::line::regrid;
use crate::contact::line::rim::{RimFrame, sagitta};
use crate::contact::line::state::{FrictionHistory, LineState, Status};
use crate::contact::problem::ContactProblem;
use crate::contact::solver::{ContactSolver, ContactState, Scratch, SolverState};
use crate::contact::traction::Traction;
use crate::multistep::History;
use crate::piecewise::Piecewise;
use nalgebra::{DMatrix, DVector};

/// The contact solver on a grid.
#[derive(Clone, Debug)]
pub struct ActiveSetSolver {
    /// The grid for ordinary patches, and a wider one about the same middle for wide ones, if there is any.
    grids: Vec<ContactGrid>,
    kernel: KernelCorrection,
}

impl ActiveSetSolver {
    /// From the static compliances of wheel and rail [m/(N/m)] and their contact modulus `E*` \[Pa].
    pub fn new(grid: ContactGrid, wheel: &DMatrix<f64>, rail: &DMatrix<f64>, contact_modulus: f64) -> Self {
        let kernel = KernelCorrection::new(&(wheel + rail), contact_modulus);
        Self { grids: vec![grid], kernel }
    }

    /// With a wider grid for patches that reach the end of the first one; its innermost nodes are those of the first.
    pub fn with_wider(mut self, wider: ContactGrid) -> Self {
        self.grids.push(wider);
        self
    }

    /// The grid to which so many ports belong.
    pub(in crate::contact) fn grid(&self, ports: usize) -> Option<&ContactGrid> {
        self.grids.iter().find(|grid| grid.ports() == ports)
    }
}

/// A state on the nodes of another grid.
fn moved(state: &ContactState, grid: &ContactGrid) -> Option<ContactState> {
    let mut moved = state.clone();
    let ContactState { traction, solver } = &mut moved;
    let SolverState::Line(own) = solver else { return None };
    regrid::move_to(grid, own, traction);
    Some(moved)
}

impl ContactSolver for ActiveSetSolver {
    fn correct(&self, wheel: &mut DMatrix<f64>, rail: &mut DMatrix<f64>) {
        self.kernel.add_to(wheel, 0.5);
        self.kernel.add_to(rail, 0.5);
    }

    fn correction_energy(&self, state: &ContactState) -> f64 {
        self.kernel.energy(&state.traction.port_forces)
    }

    fn touching(&self, half_width: f64) -> ContactState {
        let holds = |grid: &&ContactGrid| grid.x.last().is_some_and(|end| half_width < *end);
        let Some(grid) = self.grids.iter().find(holds).or(self.grids.last()) else { return ContactState::default() };
        let reach = half_width.max(0.5 * grid.spacing);
        let touches = |x: &f64| if x.abs() < reach { Status::Stick } else { Status::Open };
        let (n, ports) = (grid.len(), DVector::zeros(grid.ports()));
        let state = LineState {
            status: grid.x.iter().map(touches).collect(),
            yielded: vec![false; n],
            slip: vec![0.0; n],
            gap: vec![0.0; n],
            tangential_gap: vec![History::default(); n],
            friction: FrictionHistory::none(n),
            rim_angle: History::default(),
            rest: 0,
        };
        let [loads, surface] = [(); 2].map(|()| [ports.clone(), ports.clone()]);
        let traction = Traction { port_forces: ports, loads, surface, ..Traction::default() };
        ContactState { traction, solver: SolverState::Line(Box::new(state)) }
    }

    fn solve(
        &self,
        problem: &ContactProblem,
        start: &ContactState,
        found: &mut ContactState,
        scratch: &mut Scratch,
    ) -> Result<(), ContactError> {
        let SolverState::Line(before) = &start.solver else { return Err(ContactError::ForeignState) };
        let ContactState { traction, solver } = found;
        if !matches!(solver, SolverState::Line(_)) {
            *solver = SolverState::Line(Box::default());
        }
        let SolverState::Line(state) = solver else { return Err(ContactError::ForeignState) };
        state.copy_from(before);
        copy(&mut traction.port_forces, &start.traction.port_forces);
        traction.tread_slip = start.traction.tread_slip;
        for (ours, theirs) in traction.surface.iter_mut().zip(&start.traction.surface) {
            copy(ours, theirs);
        }
        let scratch = &mut scratch.active_set;
        let grid = self.grid(problem.bodies.relative.nrows()).ok_or(ContactError::ForeignState)?;
        let radius = problem.surfaces.radius;
        let mut heights = std::mem::take(&mut scratch.sagitta);
        sagitta(grid, radius, &mut heights);
        let frame = RimFrame { grid, radius, sagitta: &heights, rim_angle: 0.0 };
        let brakes = founding_brakes(problem);
        let solved = Iterate { grid, problem, state, traction, scratch, frame, surface_angle: 0.0, brakes }.run();
        scratch.sagitta = heights;
        solved
    }

    fn widened(&self, state: &ContactState) -> Option<ContactState> {
        let own = self.grid(state.traction.port_forces.len())?;
        let wider = self.grids.iter().find(|grid| grid.ports() > own.ports())?;
        moved(state, wider)
    }

    fn narrowed(&self, state: &ContactState, nominal_load: f64) -> Option<ContactState> {
        let (own, narrow) = (self.grid(state.traction.port_forces.len())?, self.grids.first()?);
        let SolverState::Line(grid) = &state.solver else { return None };
        let may = own.ports() > narrow.ports() && regrid::fits_into(narrow, own, grid, &state.traction, nominal_load);
        if may { moved(state, narrow) } else { None }
    }

    fn surface_strain(&self, traction: &Traction) -> [Piecewise; 2] {
        let Some(grid) = self.grid(traction.port_forces.len()) else { return Default::default() };
        [0, 1].map(|body| {
            let u = &traction.surface[body];
            let strain = |i: usize| {
                let port = grid.port(i);
                (u[port + 2] - u[port - 2]) / grid.span(i)
            };
            Piecewise { x: grid.x.clone(), value: (0..grid.len()).map(strain).collect() }
        })
    }

    fn fits(&self, state: &ContactState) -> bool {
        let (SolverState::Line(grid), Some(own)) = (&state.solver, self.grid(state.traction.port_forces.len())) else {
            return false;
        };
        let (n, ports, traction) = (own.len(), own.ports(), &state.traction);
        let FrictionHistory { force, impulse, slip, .. } = &grid.friction;
        [grid.status.len(), grid.slip.len(), grid.gap.len(), grid.tangential_gap.len()] == [n; 4]
            && [force.len(), impulse.len(), slip.len(), grid.yielded.len()] == [n; 4]
            && traction.loads.iter().chain(&traction.surface).all(|values| values.len() == ports)
            && traction.port_forces.iter().all(|f| f.is_finite())
    }
}
