//! Contact solver that hands a contact to the solver on the nodes that suit it.

use super::regrid;
use super::stay::Stay;
use super::transfer;
use crate::contact::active_set::ActiveSetSolver;
use crate::contact::error::ContactError;
use crate::contact::line::ContactGrid;
use crate::contact::problem::ContactProblem;
use crate::contact::series::SeriesSolver;
use crate::contact::solver::{ContactScratch, ContactSolver, ContactState, Ports};
use crate::piecewise::Piecewise;
use std::hash::Hasher;

/// Contact on points that move with the patch where there are any and they describe it, and on fixed nodes elsewhere.
#[derive(Clone, Debug)]
pub struct NodeChoice {
    points: Option<SeriesSolver>,
    narrow: ActiveSetSolver,
    wide: Option<ActiveSetSolver>,
}

impl NodeChoice {
    /// Contact on a `narrow` grid, on a `wide` one whose innermost nodes are those of the narrow one, and on `points`
    /// for smooth patches.
    pub fn new(narrow: ContactGrid, wide: Option<ContactGrid>, points: Option<SeriesSolver>) -> Self {
        Self { points, narrow: ActiveSetSolver::new(narrow), wide: wide.map(ActiveSetSolver::new) }
    }

    /// Solver on the nodes of given ports.
    fn on(&self, ports: Ports) -> Option<&dyn ContactSolver> {
        match ports {
            Ports::Smooth => self.points.as_ref().map(|points| points as &dyn ContactSolver),
            Ports::Narrow | Ports::Wide => self.on_grid(ports).map(|fixed| fixed as &dyn ContactSolver),
        }
    }

    /// Solver on the grid of given ports.
    fn on_grid(&self, ports: Ports) -> Option<&ActiveSetSolver> {
        match ports {
            Ports::Narrow => Some(&self.narrow),
            Ports::Wide => self.wide.as_ref(),
            Ports::Smooth => None,
        }
    }

    /// The narrowest grid with room for a patch of the given half-width \[m], or the widest.
    fn grid_for(&self, half_width: f64) -> (Ports, &ActiveSetSolver) {
        let holds = self.narrow.grid().x.last().is_some_and(|end| half_width < *end);
        match &self.wide {
            Some(wide) if !holds => (Ports::Wide, wide),
            Some(_) | None => (Ports::Narrow, &self.narrow),
        }
    }

    /// Lines of the points on a grid with room for all of them.
    fn to_grid(&self, lines: &[&ContactState]) -> Option<Vec<ContactState>> {
        let points = self.points.as_ref()?;
        let half_width = |line: &&ContactState| Some(line.solver.series()?.tractions.pressure.half_width);
        let (ports, fixed) = self.grid_for(lines.iter().filter_map(half_width).fold(0.0, f64::max));
        let moved = |line: &&ContactState| {
            let target = ContactState { ports, stay: Stay::LONG, ..fixed.touching(0.0) };
            transfer::to_grid(points.constants(), line, fixed.grid(), target)
        };
        lines.iter().map(moved).collect()
    }

    /// Lines of the wide grid on the narrow one, if all of them fit.
    fn to_narrow(&self, lines: &[&ContactState], nominal_load: f64) -> Option<Vec<ContactState>> {
        let (narrow, wide) = (self.narrow.grid(), self.wide.as_ref()?.grid());
        let fits = |line: &&ContactState| regrid::fits_into([narrow, wide], line, nominal_load);
        let moved = |line: &&ContactState| regrid::moved(line, narrow, Ports::Narrow);
        lines.iter().all(fits).then(|| lines.iter().map(moved).collect())?
    }

    /// Lines of a grid on the points, if none is to stay and all fit.
    fn to_points(&self, lines: &[&ContactState], grid: &ContactGrid) -> Option<Vec<ContactState>> {
        let points = self.points.as_ref().filter(|_| lines.iter().all(|line| line.stay.is_over()))?;
        lines.iter().map(|line| transfer::to_points(points.constants(), grid, line)).collect()
    }
}

impl ContactSolver for NodeChoice {
    fn touching(&self, half_width: f64) -> ContactState {
        match &self.points {
            Some(points) if half_width < points.reach() => points.touching(half_width),
            Some(_) | None => {
                let (ports, fixed) = self.grid_for(half_width);
                ContactState { ports, ..fixed.touching(half_width) }
            }
        }
    }

    fn touching_at_rest(&self, half_width: f64) -> ContactState {
        let (ports, fixed) = self.grid_for(half_width);
        ContactState { ports, stay: Stay::LONG, ..fixed.touching(half_width) }
    }

    fn solve(
        &self,
        problem: &ContactProblem,
        start: &[&ContactState],
        found: &mut [&mut ContactState],
        scratch: &mut ContactScratch,
    ) -> Result<(), ContactError> {
        let ports = start.first().map(|line| line.ports).ok_or(ContactError::ForeignState)?;
        let solver = self.on(ports).filter(|_| start.iter().all(|line| line.ports == ports));
        solver.ok_or(ContactError::ForeignState)?.solve(problem, start, found, scratch)?;
        for (line, (start, found)) in problem.lines.iter().zip(start.iter().zip(found)) {
            let (rigid, traction) = (&problem.rigid, &found.traction);
            found.stay = match &self.points {
                Some(points) if ports != Ports::Smooth && !line.time.is_stationary() => start
                    .stay
                    .after_step(|| SeriesSolver::stands(rigid, line, traction), || points.suits(rigid, line, traction)),
                Some(_) | None => start.stay,
            };
        }
        Ok(())
    }

    fn fits(&self, state: &ContactState) -> bool {
        self.on(state.ports).is_some_and(|solver| solver.fits(state))
    }

    fn decisions(&self, state: &ContactState, into: &mut dyn Hasher) {
        if let Some(solver) = self.on(state.ports) {
            solver.decisions(state, into);
        }
    }

    fn on_other_nodes(&self, lines: &[&ContactState]) -> Option<Vec<ContactState>> {
        match lines.first()?.ports {
            Ports::Smooth => self.to_grid(lines),
            Ports::Narrow => {
                let wide = self.wide.as_ref()?.grid();
                lines.iter().map(|line| regrid::moved(line, wide, Ports::Wide)).collect()
            }
            Ports::Wide => None,
        }
    }

    fn on_preferred_nodes(&self, lines: &[&ContactState], nominal_load: f64) -> Option<Vec<ContactState>> {
        let ports = lines.first()?.ports;
        let narrow = match ports {
            Ports::Wide => self.to_narrow(lines, nominal_load),
            Ports::Narrow | Ports::Smooth => None,
        };
        narrow.or_else(|| self.to_points(lines, self.on_grid(ports)?.grid()))
    }

    fn surface_strain(&self, state: &ContactState) -> [Piecewise; 2] {
        self.on(state.ports).map_or_else(Default::default, |solver| solver.surface_strain(state))
    }
}
