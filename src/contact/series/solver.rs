//! The contact solver that takes the patch where it can, and the grid where it cannot.

use super::chebyshev::{Arch, HalfPlane};
use super::constants::{Constants, LayerTables};
use super::iterate::Iterate;
use super::state::{Past, SeriesState, Tractions};
use super::tables::{PRESSURE, Tables};
use super::transfer;
use crate::contact::active_set::ActiveSetSolver;
use crate::contact::error::ContactError;
use crate::contact::problem::{AxisDrive, ContactProblem};
use crate::contact::solver::{ContactSolver, ContactState, Scratch, SolverState};
use crate::contact::traction::Traction;
use crate::linalg::{Lagrange, POINTS};
use crate::piecewise::Piecewise;
use nalgebra::{DMatrix, DVector};

/// Shortest way of the material in a step, over the half-width of the patch \[1]: below, the series do not resolve what is
/// carried through it.
const SHORTEST_WAY: f64 = 0.01;

/// Largest difference of the velocities of both surfaces over their mean \[1]: beyond, the wheel slides, and its heat changes within
/// a step what the series take from the step before.
const MOST_SLIDING: f64 = 0.05;

/// Largest half-width of a start over the reach of the bodies \[1].
const LARGEST_START: f64 = 0.9;

/// Contact on a single patch, and on a grid where there is none.
#[derive(Clone, Debug)]
pub struct SeriesSolver {
    grid: ActiveSetSolver,
    constants: Constants,
    /// Whether there is no way to the grid.
    only: bool,
}

impl SeriesSolver {
    /// Patches within `reach` \[m] of the contact point on bodies that lack a half-plane each, beside a `grid`; `only`: which is
    /// never used.
    pub fn new(grid: ActiveSetSolver, half_plane: HalfPlane, reach: f64, only: bool) -> Self {
        let (points, tables, layers) = (Lagrange::new(reach), Tables::new(), LayerTables::new());
        let constants = Constants { half_plane, points, tables, layers };
        Self { grid, constants, only }
    }

    /// Refuses problems in which a patch is not smooth, or whose past is not what the series can carry.
    fn check(&self, problem: &ContactProblem, before: &SeriesState) -> Result<(), ContactError> {
        let (surfaces, placement, limits) = (problem.surfaces, &problem.placement, &problem.limits);
        let refuse = |reason: &'static str| Err(ContactError::Unsuited { reason });
        if surfaces.wheel.is_some() || surfaces.rail.is_some() {
            return refuse("the surfaces have profiles");
        }
        if placement.flattening.iter().any(|flattening| !flattening.is_empty()) {
            return refuse("the surfaces are flattened");
        }
        if problem.rigid.iter().any(|motion| matches!(motion.drive, AxisDrive::Braked { .. })) {
            return refuse("a brake may hold the wheel");
        }
        if !limits.film.is_empty() {
            return refuse("a surface melts");
        }
        if problem.friction.varies() {
            return refuse("the friction coefficient depends on the slip");
        }
        if problem.time.b1 != 0.0 {
            return refuse("the time formula remembers rates");
        }
        let [travel, rim] = [problem.rigid[0].start(), problem.radius() * problem.rigid[2].start()];
        let speed = travel.abs() + rim.abs();
        if !self.only && (travel - rim).abs() > 0.5 * MOST_SLIDING * speed {
            return refuse("the wheel slides");
        }
        let slow = 0.5 * speed < SHORTEST_WAY * before.tractions.pressure.half_width * problem.time.a0;
        if slow { refuse("the material hardly moves") } else { Ok(()) }
    }

    /// Refuses a solution under which steel yields.
    fn check_limits(problem: &ContactProblem, traction: &Traction) -> Result<(), ContactError> {
        let limits = &problem.limits;
        // Where it sticks friction shears the steel less; that is for the grid to find out.
        let bears = |x: f64| limits.sheared_at(x, traction.friction);
        let yields = |(x, p): (&f64, &f64)| *p > bears(*x);
        let pressure = &traction.pressure;
        let any = limits.is_limited()
            && (traction.pressure_max > bears(0.0) || pressure.x.iter().zip(&pressure.value).any(yields));
        if any { Err(ContactError::Unsuited { reason: "steel yields" }) } else { Ok(()) }
    }
}

impl ContactSolver for SeriesSolver {
    fn correct(&self, wheel: &mut DMatrix<f64>, rail: &mut DMatrix<f64>) {
        if wheel.nrows() != 2 * POINTS {
            self.grid.correct(wheel, rail);
        }
    }

    fn correction_energy(&self, state: &ContactState) -> f64 {
        match &state.solver {
            SolverState::Series(patch) => patch.energy,
            _ => self.grid.correction_energy(state),
        }
    }

    fn touching(&self, half_width: f64) -> ContactState {
        let reach = self.constants.points.reach;
        if half_width >= reach && !self.only {
            return self.grid.touching(half_width);
        }
        let half_width = half_width.min(LARGEST_START * reach);
        let mut pressure = Arch { centre: 0.0, half_width, count: PRESSURE, ..Arch::default() };
        // That of a cylinder is found in the first iteration.
        pressure.terms[0] = 1.0;
        let tractions = Tractions { pressure, slide: 1.0, stick: Arch { terms: Default::default(), ..pressure } };
        let past = [(); 2].map(|()| Past::Patch(Tractions::default(), [0.0; POINTS]));
        let state = SeriesState { tractions, past, ..SeriesState::default() };
        let ports = || DVector::zeros(2 * POINTS);
        let [loads, surface] = [(); 2].map(|()| [ports(), ports()]);
        let traction = Traction { port_forces: ports(), loads, surface, ..Traction::default() };
        ContactState { traction, solver: SolverState::Series(Box::new(state)) }
    }

    fn solve(
        &self,
        problem: &ContactProblem,
        start: &ContactState,
        found: &mut ContactState,
        scratch: &mut Scratch,
    ) -> Result<(), ContactError> {
        let SolverState::Series(before) = &start.solver else {
            self.grid.solve(problem, start, found, scratch)?;
            if let (SolverState::Line(grid), false) = (&mut found.solver, problem.time.is_stationary()) {
                grid.rest = grid.rest.saturating_sub(1);
            }
            return Ok(());
        };
        if problem.bodies.relative.nrows() != 2 * POINTS {
            return Err(ContactError::ForeignState);
        }
        self.check(problem, before)?;
        let mut iterate = Iterate::new(&self.constants, problem, before, start.traction.rigid[1]);
        iterate.run()?;
        let ContactState { traction, solver } = found;
        match solver {
            SolverState::Series(state) => state.clone_from(before),
            _ => *solver = SolverState::Series(before.clone()),
        }
        let SolverState::Series(state) = solver else { return Err(ContactError::ForeignState) };
        iterate.finish(state, traction);
        Self::check_limits(problem, traction)
    }

    fn widened(&self, state: &ContactState) -> Option<ContactState> {
        match &state.solver {
            SolverState::Series(_) if self.only => None,
            SolverState::Series(patch) => {
                let half_width = patch.tractions.pressure.half_width;
                let target = self.grid.touching(half_width);
                let grid = self.grid.grid(target.traction.port_forces.len())?;
                Some(transfer::to_grid(&self.constants, patch, &state.traction, grid, target))
            }
            _ => self.grid.widened(state),
        }
    }

    fn narrowed(&self, state: &ContactState, nominal_load: f64) -> Option<ContactState> {
        if matches!(state.solver, SolverState::Series(_)) {
            return None;
        }
        self.grid.narrowed(state, nominal_load).or_else(|| {
            let (travel, slip) = (state.traction.rigid[0], state.traction.tread_slip);
            if slip.abs() > MOST_SLIDING * travel.abs() {
                return None;
            }
            let grid = self.grid.grid(state.traction.port_forces.len())?;
            transfer::to_patch(&self.constants, grid, state)
        })
    }

    fn surface_strain(&self, traction: &Traction) -> [Piecewise; 2] {
        self.grid.surface_strain(traction)
    }

    fn fits(&self, state: &ContactState) -> bool {
        let SolverState::Series(patch) = &state.solver else { return self.grid.fits(state) };
        let traction = &state.traction;
        let arches = [&patch.tractions.pressure, &patch.tractions.stick];
        let vectors = traction.loads.iter().chain(&traction.surface).chain([&traction.port_forces]);
        arches.iter().all(|arch| arch.is_sound())
            && patch.past.iter().all(Past::is_sound)
            && vectors.into_iter().all(|values| values.len() == 2 * POINTS)
            && traction.port_forces.iter().all(|f| f.is_finite())
    }
}
