//! Contact solver of lines with a single smooth patch each.

use super::chebyshev::Arch;
use super::constants::Constants;
use super::contact::MOST_LINES;
use super::hot_layers::SeriesLayers;
use super::series_line::SeriesStart;
use super::state::{Past, SeriesPast, SeriesState, Tractions};
use super::tables::{POWER, PRESSURE};
use super::{finish, laws};
use crate::axes::PerAxis;
use crate::contact::error::ContactError;
use crate::contact::line::LineHistory;
use crate::contact::problem::{ContactProblem, LineProblem, OneLine, RigidMotion, Spin};
use crate::contact::solver::{ContactScratch, ContactSolver, ContactState, SolverState};
use crate::contact::traction::Traction;
use crate::linalg::{Lagrange, POINTS};
use crate::piecewise::Interval;
use std::hash::{Hash, Hasher};

/// Shortest way of the material in a step, over the half-width of the patch \[1]: below, the series do not resolve what
/// is carried through it. Where all slips nothing is.
const SHORTEST_WAY: f64 = 1e-3;

/// Largest half-width of a start over the zone \[1].
const LARGEST_START: f64 = 0.9;

/// Contact as series on a single patch.
#[derive(Clone, Debug)]
pub struct SeriesSolver {
    constants: Constants,
}

impl SeriesSolver {
    /// Patches on bodies that lack the flexibility that lines have for themselves and are known up to `reach` \[m] from the
    /// contact point.
    pub fn new(reach: f64) -> Self {
        Self { constants: Constants::new(Lagrange::new(reach)) }
    }

    /// Patches that lie within a `zone` \[m] about the contact point.
    pub fn within(mut self, zone: f64) -> Self {
        self.constants.zone = zone;
        self
    }

    /// Distance from the contact point within which patches lie \[m].
    pub fn reach(&self) -> f64 {
        self.constants.zone
    }

    /// Constants of all problems.
    pub(in crate::contact) fn constants(&self) -> &Constants {
        &self.constants
    }

    /// True if the material moves by less than a `way` \[m] in a step.
    fn hardly_moves(rigid: &PerAxis<RigidMotion>, line: &LineProblem, way: f64) -> bool {
        let [travel, rim] = [rigid.travel.start(), line.radius() * rigid.rotation.start()];
        0.5 * (travel.abs() + rim.abs()) < way * line.time.a0
    }

    /// Refuses problems in which a patch is not smooth, or whose past the series cannot carry.
    fn check(line: &LineProblem) -> Result<(), ContactError> {
        let (surfaces, placement, limits) = (line.surfaces, &line.placement, &line.limits);
        let refuse = |reason| Err(ContactError::Unsuited { reason });
        if !surfaces.is_smooth() {
            return refuse("the surfaces have profiles (wheel.profile, rail.profile)");
        }
        if surfaces.is_uneven(placement) {
            return refuse("the surfaces are flattened (physics.yielding, damage.wear)");
        }
        if !limits.film.is_empty() {
            return refuse("a surface melts (material.latent_heat, material.film_friction)");
        }
        match line.time.b1 != 0.0 {
            true => refuse("the time formula remembers rates"),
            false => Ok(()),
        }
    }

    /// Refuses a line that sticks somewhere while the material hardly moves.
    fn check_motion(
        rigid: &PerAxis<RigidMotion>,
        line: &LineProblem,
        tractions: &Tractions,
        before: &SeriesState,
    ) -> Result<(), ContactError> {
        if line.is_sideways() {
            return Ok(());
        }
        let slow = Self::hardly_moves(rigid, line, SHORTEST_WAY * before.tractions.pressure.half_width);
        match slow && !tractions.slides() {
            true => Err(ContactError::Unsuited { reason: "the material hardly moves" }),
            false => Ok(()),
        }
    }

    /// True if some of the material under a `traction` sticks and hardly moves, with a margin.
    pub fn stands(rigid: &PerAxis<RigidMotion>, problem: &LineProblem, traction: &Traction) -> bool {
        let half_width = traction.extent().map_or(0.0, Interval::half_length);
        if problem.is_sideways() {
            return false;
        }
        traction.stick_fraction > 0.0 && Self::hardly_moves(rigid, problem, 2.0 * SHORTEST_WAY * half_width)
    }

    /// True if the series describe a contact that has this `traction`: hot layers leave a margin.
    pub fn suits(&self, rigid: &PerAxis<RigidMotion>, problem: &LineProblem, traction: &Traction) -> bool {
        let [edges] = traction.edges.as_slice() else { return false };
        let half_width = edges.half_length();
        let patch = Arch { centre: edges.middle(), half_width, ..Arch::default() };
        let view = OneLine { line: problem, rigid, spin: Spin::default() };
        let bends = |layers: &SeriesLayers| laws::bends(layers, &view, half_width, 0.5 * laws::UNRESOLVED);
        Self::check(problem).is_ok()
            && Self::check_limits(problem, traction).is_ok()
            && !SeriesLayers::new(&self.constants, &view, &patch).as_ref().is_some_and(bends)
    }

    /// Finds the contact of all lines; see [`ContactSolver::solve`].
    fn find(
        &self,
        problem: &ContactProblem,
        start: &[&ContactState],
        found: &mut [&mut ContactState],
        scratch: &mut ContactScratch,
    ) -> Result<(), ContactError> {
        let begun: Option<Vec<_>> = start.iter().map(|start| SeriesStart::of(start)).collect();
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
        for (found, (start, begun)) in found.iter_mut().zip(start.iter().zip(&begun)) {
            match &mut found.solver {
                SolverState::Series(state) => (**state).clone_from(begun.before),
                other => *other = SolverState::Series(Box::new(begun.before.clone())),
            }
            found.history.copy_from(&start.history);
        }
        let ContactScratch { series, linear_laws, .. } = scratch;
        laws::solve(&self.constants, problem, &begun, series, |contact| {
            *linear_laws = contact.linear_laws;
            for ((at, line), found) in contact.lines.iter().enumerate().zip(&mut *found) {
                let ContactState { traction, history, energy, solver, .. } = &mut **found;
                let SolverState::Series(state) = solver else { continue };
                *energy = finish::finish(line, contact.growth(at), state, history, traction);
                traction.pull_work = traction.work_of_pulls_since(&start[at].traction);
            }
        })?;
        for ((line, found), begun) in problem.lines.iter().zip(&*found).zip(&begun) {
            let state = found.solver.series().ok_or(ContactError::ForeignState)?;
            Self::check_motion(&problem.rigid, line, &state.tractions, begun.before)?;
            Self::check_limits(line, &found.traction)?;
        }
        Ok(())
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
        if any { Err(ContactError::Unsuited { reason: "steel yields (physics.yielding)" }) } else { Ok(()) }
    }
}

impl ContactSolver for SeriesSolver {
    fn touching(&self, half_width: f64) -> ContactState {
        let half_width = half_width.min(LARGEST_START * self.reach());
        let mut pressure = Arch { centre: 0.0, half_width, count: PRESSURE, ..Arch::default() };
        // That of a cylinder is found in the first iteration.
        pressure.terms[0] = 1.0;
        let stick = Arch { terms: Default::default(), ..pressure };
        let tractions = Tractions { pressure, slide: 1.0, stick, directions: None, lateral: Arch::default() };
        let past = [(); 2].map(|()| Past::Series(SeriesPast::default()));
        let state = SeriesState { tractions, past, ..SeriesState::default() };
        ContactState {
            traction: Traction::without_forces(),
            history: LineHistory::none(POWER),
            solver: SolverState::Series(Box::new(state)),
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
        self.find(problem, start, found, scratch)
    }

    fn fits(&self, state: &ContactState) -> bool {
        let Some(series) = state.solver.series() else { return false };
        let arches = [&series.tractions.pressure, &series.tractions.stick];
        arches.iter().all(|arch| arch.is_sound())
            && series.past.iter().all(Past::is_sound)
            && series.kernel.is_sound()
            && series.size.is_finite()
            && series.size >= 0.0
            && series.uncorrected.is_sound()
            && (state.history.friction.fits(POWER) || state.history.friction.fits(2 * POWER))
            && state.traction.fits()
    }

    fn decisions(&self, state: &ContactState, mut into: &mut dyn Hasher) {
        state.solver.series().map(|series| series.tractions.branch()).hash(&mut into);
    }
}
