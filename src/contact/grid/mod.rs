//! Contact on a uniform grid of paired surface nodes: exact Coulomb friction by an active set.
//!
//! [`rows`] writes gap, slip and balance as rows of a linear system, [`streamline`] gives the slip its upwind
//! differences, [`active_set`] finds the states of the nodes, [`kernel`] corrects the compliance at grid scale, and
//! [`observe`] reads the traction off the solution. Theory: `docs/theory/contact.md`.

mod active_set;
mod candidates;
pub mod kernel;
pub mod observe;
mod rows;
pub mod streamline;

pub use active_set::MAX_ITERATIONS;
pub use candidates::ContactGrid;

use super::{ContactError, ContactProblem, ContactSolver, ContactState, Scratch, SolverState, Traction};
use crate::linalg::DenseSystem;
use crate::multistep::History;
use crate::piecewise::Piecewise;
use active_set::Iteration;
use kernel::KernelCorrection;
use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};
use streamline::Upwind;

/// State of one pair of contact nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Status {
    /// No contact.
    Open,
    /// Closed, no slip.
    Stick,
    /// Closed and slipping; the friction force on the wheel points to `+x`.
    SlipForward,
    /// Closed and slipping; the friction force on the wheel points to `−x`.
    SlipBackward,
}

impl Status {
    /// Whether the pair is closed.
    pub fn is_active(self) -> bool {
        self != Status::Open
    }

    /// Direction of the friction force on the wheel: ±1 in slip, 0 otherwise.
    pub fn friction_direction(self) -> f64 {
        match self {
            Status::SlipForward => 1.0,
            Status::SlipBackward => -1.0,
            Status::Open | Status::Stick => 0.0,
        }
    }
}

/// Calls `f` with every maximal run of closed nodes as an index range, x ascending: the contact patches.
pub fn for_each_patch(status: &[Status], mut f: impl FnMut(std::ops::Range<usize>)) {
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
    fn copy_from(&mut self, other: &Self) {
        self.status.clone_from(&other.status);
        self.slip.clone_from(&other.slip);
        self.gap.clone_from(&other.gap);
        self.tangential_gap.clone_from(&other.tangential_gap);
    }
}

/// Buffers of [`GridSolver`].
#[derive(Default)]
pub struct GridScratch {
    system: DenseSystem,
    /// Nodes and axes whose forces and motions are unknown.
    closed: Vec<usize>,
    stuck: Vec<usize>,
    axes: Vec<usize>,
    /// Undeformed gap at the candidates [m].
    gap: Vec<f64>,
    /// Known part of `d_t` of the tangential gap [m/s].
    slip_offset: Vec<f64>,
    /// Displacement of wheel and rail without contact forces and unknown motions [m].
    known: [DVector<f64>; 2],
    upwind: Vec<Upwind>,
    upwind_before: Vec<Upwind>,
    status_before: Vec<Status>,
    /// Coefficients of all port forces in the row at hand.
    row: Vec<f64>,
    /// Slip velocity with centred differences: what dissipates. The upwind one counts its own numerical dissipation.
    centred_slip: Vec<f64>,
}

/// The contact solver on a grid.
#[derive(Clone, Debug)]
pub struct GridSolver {
    grid: ContactGrid,
    kernel: KernelCorrection,
}

impl GridSolver {
    /// From the static compliances of wheel and rail [m/(N/m)] and their contact modulus `E*` \[Pa].
    pub fn new(grid: ContactGrid, wheel: &DMatrix<f64>, rail: &DMatrix<f64>, contact_modulus: f64) -> Self {
        let kernel = KernelCorrection::new(&(wheel + rail), contact_modulus);
        Self { grid, kernel }
    }
}

impl ContactSolver for GridSolver {
    fn correct(&self, wheel: &mut DMatrix<f64>, rail: &mut DMatrix<f64>) {
        self.kernel.add_to(wheel, 0.5);
        self.kernel.add_to(rail, 0.5);
    }

    fn correction_energy(&self, traction: &Traction) -> f64 {
        self.kernel.energy(&traction.port_forces)
    }

    fn touching(&self, half_width: f64) -> ContactState {
        let reach = half_width.max(0.5 * self.grid.spacing);
        let touches = |x: &f64| if x.abs() < reach { Status::Stick } else { Status::Open };
        let (n, ports) = (self.grid.len(), DVector::zeros(self.grid.ports()));
        let state = GridState {
            status: self.grid.x.iter().map(touches).collect(),
            slip: vec![0.0; n],
            gap: vec![0.0; n],
            tangential_gap: vec![History::default(); n],
        };
        let traction = Traction { port_forces: ports.clone(), surface: [ports.clone(), ports], ..Traction::default() };
        ContactState { traction, solver: SolverState::Grid(state) }
    }

    fn solve(
        &self,
        problem: &ContactProblem,
        start: &ContactState,
        found: &mut ContactState,
        scratch: &mut Scratch,
    ) -> Result<(), ContactError> {
        let SolverState::Grid(before) = &start.solver else { return Err(ContactError::ForeignState) };
        let ContactState { traction, solver } = found;
        if !matches!(solver, SolverState::Grid(_)) {
            *solver = SolverState::Grid(GridState::default());
        }
        let SolverState::Grid(state) = solver else { return Err(ContactError::ForeignState) };
        state.copy_from(before);
        copy(&mut traction.port_forces, &start.traction.port_forces);
        for (ours, theirs) in traction.surface.iter_mut().zip(&start.traction.surface) {
            copy(ours, theirs);
        }
        let scratch = &mut scratch.grid;
        Iteration { grid: &self.grid, problem, state, traction, scratch }.run()?;
        let [wheel, rail] = &traction.surface;
        for (i, history) in state.tangential_gap.iter_mut().enumerate() {
            let port = self.grid.port(i);
            let value = wheel[port] - rail[port];
            match problem.time.is_stationary() {
                true => *history = History::constant(value),
                false => history.push(&problem.time, value),
            }
        }
        let wheel = [problem.radius(), problem.friction];
        observe::read_off(&self.grid, wheel, state, &scratch.centred_slip, traction);
        Ok(())
    }

    fn surface_strain(&self, traction: &Traction) -> [Piecewise; 2] {
        [0, 1].map(|body| {
            let u = &traction.surface[body];
            let strain = |i: usize| {
                let port = self.grid.port(i);
                (u[port + 2] - u[port - 2]) / (2.0 * self.grid.spacing)
            };
            Piecewise { x: self.grid.x.clone(), value: (0..self.grid.len()).map(strain).collect() }
        })
    }

    fn fits(&self, state: &ContactState) -> bool {
        let SolverState::Grid(grid) = &state.solver else { return false };
        let (n, ports, traction) = (self.grid.len(), self.grid.ports(), &state.traction);
        [grid.status.len(), grid.slip.len(), grid.gap.len(), grid.tangential_gap.len()] == [n; 4]
            && [traction.port_forces.len(), traction.surface[0].len(), traction.surface[1].len()] == [ports; 3]
            && traction.port_forces.iter().all(|f| f.is_finite())
    }
}

/// Copies without allocating where the lengths agree.
fn copy(target: &mut DVector<f64>, source: &DVector<f64>) {
    if target.len() == source.len() { target.copy_from(source) } else { target.clone_from(source) }
}
