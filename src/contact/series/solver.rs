//! Contact solver that takes the series where they hold, and the active set elsewhere.

use super::chebyshev::Arch;
use super::constants::Constants;
use super::contact::MOST_LINES;
use super::hot_layers::SeriesLayers;
use super::series_line::SeriesStart;
use super::state::{Past, PatchPast, SeriesState, Tractions};
use super::tables::{POWER, PRESSURE};
use super::{finish, laws, transfer};
use crate::axes::PerAxis;
use crate::contact::active_set::ActiveSetSolver;
use crate::contact::error::ContactError;
use crate::contact::line::LineHistory;
use crate::contact::problem::{ContactProblem, LineProblem, OneLine, RigidMotion};
use crate::contact::solver::{ContactScratch, ContactSolver, ContactState, Ports, SolverState};
use crate::contact::traction::Traction;
use crate::linalg::{DenseSystem, Lagrange, POINTS};
use crate::piecewise::Piecewise;
use nalgebra::DVector;

/// Shortest way of the material in a step, over the half-width of the patch \[1]: below, the series do not resolve what
/// is carried through it. Where all slips nothing is.
const SHORTEST_WAY: f64 = 1e-3;

/// Largest half-width of a start over the reach of the bodies \[1].
const LARGEST_START: f64 = 0.9;

/// Answer of the solver to a contact that is no single smooth patch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fallback {
    /// The active set on the grid solves it.
    ActiveSet,
    /// The solver refuses it.
    Refuse,
}

/// Contact as series on a single patch, and on a grid where there is none.
#[derive(Clone, Debug)]
pub struct SeriesSolver {
    grid: ActiveSetSolver,
    constants: Constants,
    fallback: Fallback,
}

impl SeriesSolver {
    /// Patches within `reach` \[m] of the contact point on bodies that lack the flexibility that lines have for
    /// themselves, beside a `grid`.
    pub fn new(grid: ActiveSetSolver, reach: f64, fallback: Fallback) -> Self {
        Self { grid, constants: Constants::new(Lagrange::new(reach)), fallback }
    }

    /// True if the active set solves contacts that are no single smooth patch.
    fn falls_back(&self) -> bool {
        match self.fallback {
            Fallback::ActiveSet => true,
            Fallback::Refuse => false,
        }
    }

    /// True if the material moves by less than a `way` \[m] in a step.
    fn hardly_moves(rigid: &PerAxis<RigidMotion>, line: &LineProblem, way: f64) -> bool {
        let [travel, rim] = [rigid.travel.start(), line.radius() * rigid.rotation.start()];
        0.5 * (travel.abs() + rim.abs()) < way * line.time.a0
    }

    /// Refuses problems in which a patch is not smooth, or whose past the series cannot carry.
    fn check(line: &LineProblem) -> Result<(), ContactError> {
        let (surfaces, placement, limits) = (line.surfaces, &line.placement, &line.limits);
        let refuse = |reason: &'static str| Err(ContactError::Unsuited { reason });
        if !surfaces.is_smooth() {
            return refuse("the surfaces have profiles");
        }
        if surfaces.is_uneven(placement) {
            return refuse("the surfaces are flattened");
        }
        if !limits.film.is_empty() {
            return refuse("a surface melts");
        }
        if line.time.b1 != 0.0 { refuse("the time formula remembers rates") } else { Ok(()) }
    }

    /// Counts the steps on the grid down. While the contact does not suit the series the count begins anew; material that
    /// begins to move is handed over at once, as long as both solvers remember the same and agree.
    fn rest(&self, rigid: &PerAxis<RigidMotion>, problem: &LineProblem, found: &mut ContactState) {
        let SolverState::Line(line) = &found.solver else { return };
        let rest = match line.rest.saturating_sub(1) {
            0 if Self::stands(rigid, problem, found) => 1,
            0 if !self.suits(rigid, problem, found) => transfer::REST,
            rest => rest,
        };
        if let SolverState::Line(line) = &mut found.solver {
            line.rest = rest;
        }
    }

    /// True if some of the material sticks and hardly moves, with a margin.
    fn stands(rigid: &PerAxis<RigidMotion>, problem: &LineProblem, found: &ContactState) -> bool {
        let half_width = found.traction.extent().map_or(0.0, |patch| 0.5 * (patch.high - patch.low));
        found.traction.stick_fraction > 0.0 && Self::hardly_moves(rigid, problem, 2.0 * SHORTEST_WAY * half_width)
    }

    /// True if a line that the grid has found could be taken back: hot layers leave a margin.
    fn suits(&self, rigid: &PerAxis<RigidMotion>, problem: &LineProblem, found: &ContactState) -> bool {
        let [edges] = found.traction.edges.as_slice() else { return false };
        let (centre, half_width) = (0.5 * (edges.low + edges.high), 0.5 * (edges.high - edges.low));
        let patch = Arch { centre, half_width, ..Arch::default() };
        let view = OneLine { line: problem, rigid, nominal_load: 0.0 };
        let bends = |layers: &SeriesLayers| laws::bends(layers, &view, half_width, 0.5 * laws::UNRESOLVED);
        Self::check(problem).is_ok()
            && Self::check_limits(problem, &found.traction).is_ok()
            && !SeriesLayers::new(&self.constants, &view, &patch).as_ref().is_some_and(bends)
    }

    /// Refuses a solution under which steel yields.
    fn check_limits(line: &LineProblem, traction: &Traction) -> Result<(), ContactError> {
        let limits = &line.limits;
        // Where it sticks friction shears the steel less; that is for the grid to find out.
        let borne = limits.borne(traction.friction.coefficient);
        let bears = |x: f64| limits.sheared_at(x, borne);
        let yields = |(x, p): (&f64, &f64)| *p > bears(*x);
        let pressure = &traction.pressure;
        let any = limits.is_limited()
            && (traction.pressure_max > bears(0.0) || pressure.x.iter().zip(&pressure.value).any(yields));
        if any { Err(ContactError::Unsuited { reason: "steel yields" }) } else { Ok(()) }
    }
}

impl SeriesSolver {
    /// Solves the contact of lines with a single patch each, which `starts` from the series.
    fn solve_patches(
        &self,
        problem: &ContactProblem,
        starts: &[&ContactState],
        found: &mut [&mut ContactState],
        system: &mut DenseSystem,
    ) -> Result<(), ContactError> {
        let begun: Option<Vec<_>> = starts.iter().map(|start| SeriesStart::of(start)).collect();
        let fits = |line: &LineProblem| line.bodies.shared.relative.nrows() == 2 * POINTS;
        let lines = problem.lines.len();
        let begun = begun.filter(|begun| begun.len() == lines && found.len() == lines && lines <= MOST_LINES);
        let Some(begun) = begun.filter(|_| problem.lines.iter().all(fits)) else {
            return Err(ContactError::ForeignState);
        };
        problem.lines.iter().try_for_each(Self::check)?;
        for (line, start) in problem.lines.iter().zip(&begun) {
            Self::check_motion(&problem.rigid, line, &start.before.tractions, start.before)?;
        }
        for (found, (start, begun)) in found.iter_mut().zip(starts.iter().zip(&begun)) {
            match &mut found.solver {
                SolverState::Series(state) => (**state).clone_from(begun.before),
                SolverState::Line(_) | SolverState::Stateless => {
                    found.solver = SolverState::Series(Box::new(begun.before.clone()))
                }
            }
            found.history.copy_from(&start.history);
            found.ports = start.ports;
        }
        laws::solve(&self.constants, problem, (&begun, system), |contact| {
            for ((at, line), found) in contact.lines.iter().enumerate().zip(&mut *found) {
                let ContactState { traction, history, energy, solver, .. } = &mut **found;
                let SolverState::Series(state) = solver else { continue };
                *energy = finish::finish((line, contact.growth(at)), state, history, traction);
            }
        })?;
        for ((line, found), begun) in problem.lines.iter().zip(&*found).zip(&begun) {
            let SolverState::Series(state) = &found.solver else { return Err(ContactError::ForeignState) };
            Self::check_motion(&problem.rigid, line, &state.tractions, begun.before)?;
            Self::check_limits(line, &found.traction)?;
        }
        Ok(())
    }

    /// Refuses a line that sticks somewhere while the material hardly moves.
    fn check_motion(
        rigid: &PerAxis<RigidMotion>,
        line: &LineProblem,
        tractions: &Tractions,
        before: &SeriesState,
    ) -> Result<(), ContactError> {
        let slow = Self::hardly_moves(rigid, line, SHORTEST_WAY * before.tractions.pressure.half_width);
        match slow && !tractions.slides() {
            true => Err(ContactError::Unsuited { reason: "the material hardly moves" }),
            false => Ok(()),
        }
    }
}

impl ContactSolver for SeriesSolver {
    fn touching(&self, half_width: f64) -> ContactState {
        let reach = self.constants.points.reach;
        if half_width >= reach && self.falls_back() {
            return self.grid.touching(half_width);
        }
        let half_width = half_width.min(LARGEST_START * reach);
        let mut pressure = Arch { centre: 0.0, half_width, count: PRESSURE, ..Arch::default() };
        // That of a cylinder is found in the first iteration.
        pressure.terms[0] = 1.0;
        let stick = Arch { terms: Default::default(), ..pressure };
        let tractions = Tractions { pressure, slide: 1.0, stick, directions: None };
        let past = [(); 2].map(|()| Past::Patch(PatchPast::default()));
        let state = SeriesState { tractions, past, ..SeriesState::default() };
        let zeros = || DVector::zeros(2 * POINTS);
        let [loads, surface] = [(); 2].map(|()| [zeros(), zeros()]);
        let traction = Traction { port_forces: zeros(), loads, surface, ..Traction::default() };
        let solver = SolverState::Series(Box::new(state));
        ContactState { ports: Ports::Smooth, traction, history: LineHistory::none(POWER), energy: 0.0, solver }
    }

    fn touching_at_rest(&self, half_width: f64) -> ContactState {
        if !self.falls_back() {
            return self.touching(half_width);
        }
        let mut state = self.grid.touching(half_width);
        if let SolverState::Line(line) = &mut state.solver {
            line.rest = transfer::REST;
        }
        state
    }

    fn solve(
        &self,
        problem: &ContactProblem,
        start: &[&ContactState],
        found: &mut [&mut ContactState],
        scratch: &mut ContactScratch,
    ) -> Result<(), ContactError> {
        if start.iter().all(|start| matches!(start.solver, SolverState::Series(_))) {
            return self.solve_patches(problem, start, found, &mut scratch.series);
        }
        self.grid.solve(problem, start, found, scratch)?;
        for (line, found) in problem.lines.iter().zip(found) {
            if !line.time.is_stationary() {
                self.rest(&problem.rigid, line, found);
            }
        }
        Ok(())
    }

    fn fits(&self, state: &ContactState) -> bool {
        let SolverState::Series(series) = &state.solver else { return self.grid.fits(state) };
        let traction = &state.traction;
        let arches = [&series.tractions.pressure, &series.tractions.stick];
        let vectors = traction.loads.iter().chain(&traction.surface).chain([&traction.port_forces]);
        state.ports == Ports::Smooth
            && arches.iter().all(|arch| arch.is_sound())
            && series.past.iter().all(Past::is_sound)
            && series.kernel.is_sound()
            && state.history.friction.fits(POWER)
            && vectors.into_iter().all(|values| values.len() == 2 * POINTS)
            && traction.port_forces.iter().all(|f| f.is_finite())
    }

    fn same_branch(&self, a: &ContactState, b: &ContactState) -> bool {
        match (&a.solver, &b.solver) {
            (SolverState::Series(a), SolverState::Series(b)) => a.tractions.same_branch(&b.tractions),
            (SolverState::Series(_) | SolverState::Line(_) | SolverState::Stateless, _) => self.grid.same_branch(a, b),
        }
    }

    fn widened(&self, state: &ContactState) -> Option<ContactState> {
        match &state.solver {
            SolverState::Series(_) if !self.falls_back() => None,
            SolverState::Series(series) => {
                let target = self.grid.touching(series.tractions.pressure.half_width);
                let grid = self.grid.grid(target.ports)?;
                Some(transfer::to_grid(&self.constants, state, series, grid, target))
            }
            SolverState::Line(_) | SolverState::Stateless => self.grid.widened(state),
        }
    }

    fn narrowed(&self, state: &ContactState, nominal_load: f64) -> Option<ContactState> {
        match state.ports {
            Ports::Smooth => None,
            Ports::Narrow | Ports::Wide => self
                .grid
                .narrowed(state, nominal_load)
                .or_else(|| transfer::to_patch(&self.constants, self.grid.grid(state.ports)?, state)),
        }
    }

    fn surface_strain(&self, state: &ContactState) -> [Piecewise; 2] {
        self.grid.surface_strain(state)
    }
}
