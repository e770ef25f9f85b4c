//! Lines side by side on their way to a solution: what they share.

use super::series_line::SeriesLine;
use super::surface::{AtPoints, Moments, SmoothSurfaces, displaced_by_powers};
use crate::axes::{Axis, PerAxis};
use crate::contact::flexibility::ByMoments;
use crate::contact::problem::{AxisDrive, ContactProblem, LineProblem, RigidMotion, SurfaceResponse};
use crate::linalg::DenseSystem;
use std::cell::OnceCell;

/// Largest number of lines side by side.
pub const MOST_LINES: usize = 16;

/// Problem whose layouts follow the load, and memory for those that are not taken yet.
#[derive(Clone, Copy)]
pub struct Relaid<'a> {
    pub problem: &'a ContactProblem<'a>,
    pub memory: &'a [OnceCell<Vec<LineProblem<'a>>>],
}

/// Contact of one or several lines in the present iterate.
pub struct SeriesContact<'a> {
    /// The lines, each with the same rigid motions.
    pub lines: Vec<SeriesLine<'a>>,
    /// Rigid motions of the wheel, brakes in given states.
    pub rigid: &'a PerAxis<RigidMotion>,
    /// Moments of the pulls of hot layers on wheel and rail, the mean of all lines.
    pulls: [AtPoints; 2],
    /// Moments of the tractions, the mean of all lines.
    moments: Moments,
    /// See [`displaced_by_powers`].
    pub by_powers: [ByMoments; 2],
    /// Lines in other layouts.
    relaid: Relaid<'a>,
    /// Equations of all lines.
    pub system: DenseSystem,
    /// Times that the law of friction along and across was made linear.
    pub linear_laws: usize,
    /// Times that a patch seemed to open.
    pub opened: usize,
    /// True if some lines may be apart.
    pub partly: bool,
}

impl<'a> SeriesContact<'a> {
    /// Contact of at least one line.
    pub fn new(lines: Vec<SeriesLine<'a>>, rigid: &'a PerAxis<RigidMotion>, relaid: Relaid<'a>) -> Self {
        relaid.problem.layouts.inspect(|layouts| layouts.begin());
        let (pulls, moments, system) = Default::default();
        let by_powers = displaced_by_powers(&lines[0].problem.line.bodies, &lines[0].constants.points);
        let mut contact =
            Self { lines, rigid, pulls, moments, by_powers, relaid, system, linear_laws: 0, opened: 0, partly: false };
        contact.share_pulls();
        contact
    }

    /// Gives lines the layout of the load that they carry; returns the change of their share \[1].
    pub fn follow_load(&mut self) -> f64 {
        let Relaid { problem, memory: [free, rest @ ..] } = self.relaid else { return 0.0 };
        let Some(layouts) = problem.layouts.and_then(|layouts| layouts.under(self.load())) else { return 0.0 };
        let lines = || problem.lines.iter().zip(&layouts).map(|(line, layout)| line.laid_out(layout)).collect();
        let lines: &Vec<_> = free.get_or_init(lines);
        self.relaid.memory = rest;
        let factor = self.lines[0].problem.line.share / lines[0].share;
        self.lines.iter_mut().zip(lines).for_each(|(line, relaid)| line.relay(relaid, factor));
        self.share_pulls();
        (factor - 1.0).abs()
    }

    /// Gives all lines the mean pulls of their hot layers.
    fn share_pulls(&mut self) {
        self.pulls = Default::default();
        for line in &self.lines {
            let share = line.problem.line.share;
            for (sum, pull) in self.pulls.as_flattened_mut().iter_mut().zip(line.pulls.as_flattened()) {
                *sum += share * pull;
            }
        }
        self.lines.iter_mut().for_each(|line| line.mean_pulls = self.pulls);
    }

    /// Linear answer of the bodies.
    pub fn bodies(&self) -> &SurfaceResponse<'a> {
        &self.lines[0].problem.line.bodies
    }

    /// Sum of a quantity per metre of width over all lines, per metre of the bodies' width.
    pub fn sum(&self, of: impl Fn(&SeriesLine) -> f64) -> f64 {
        self.lines.iter().map(|line| line.problem.line.share * of(line)).sum()
    }

    /// Moments of the tractions, the mean of all lines.
    fn mean_moments(&self) -> Moments {
        let mut mean = Moments::default();
        self.lines.iter().for_each(|line| mean.add(line.problem.line.share, &line.moments));
        mean
    }

    /// Smooth displacements under the present moments of all lines.
    pub fn surface(&mut self) -> SmoothSurfaces {
        self.moments = self.mean_moments();
        SmoothSurfaces::new(self.bodies(), &self.moments, &self.pulls, self.lines[0].accelerations())
    }

    /// Gives all lines the smooth displacements under the present tractions.
    pub fn displace(&mut self) {
        let (surface, load) = (self.surface(), self.load());
        for line in &mut self.lines {
            line.mean_load = load;
            line.displace(surface);
        }
    }

    /// Load of all lines [N/m].
    pub fn load(&self) -> f64 {
        self.sum(|line| line.load())
    }

    /// Forces of the contact on the wheel: x, y [N/m], forward moment \[N].
    pub fn resultant(&self) -> PerAxis<f64> {
        let mut sum = PerAxis::default();
        self.lines.iter().for_each(|line| sum.add(line.problem.line.share, line.resultant()));
        sum
    }

    /// Axes along the surfaces whose motions are not prescribed.
    pub fn free_axes(&self) -> impl Iterator<Item = Axis> + Clone + use<'a> {
        let rigid = self.rigid;
        Axis::along().filter(|&axis| rigid[axis].target().is_none())
    }

    /// Changes a rigid motion of all lines.
    pub fn speed_up(&mut self, axis: Axis, change: f64) {
        self.lines.iter_mut().for_each(|line| line.rigid[axis] += change);
    }

    /// Residual of the balance of a rigid motion under the present moments and a contact `force` [N/m, N].
    pub fn unbalance(&self, axis: Axis, force: f64) -> f64 {
        match self.rigid[axis].drive {
            AxisDrive::Free { load } => self.reaction(axis, force) - load,
            AxisDrive::Prescribed { .. } | AxisDrive::Braked { .. } => 0.0,
        }
    }

    /// Force [N/m] or moment \[N] that a rigid motion takes under the present moments and a contact
    /// `force`.
    pub fn reaction(&self, axis: Axis, force: f64) -> f64 {
        let (bodies, motion, row) = (self.bodies(), &self.rigid[axis], axis.number());
        let mut sum = motion.momentum - force;
        for (k, (t, n)) in self.moments.tangential.iter().zip(&self.moments.normal).enumerate() {
            sum += bodies.momentum[(row, 2 * k)] * (t + self.pulls[0][k]) + bodies.momentum[(row, 2 * k + 1)] * n;
        }
        for (other, acceleration) in self.lines[0].accelerations().iter() {
            sum += self.inertia(axis, other) * acceleration;
        }
        sum
    }

    /// Inertia of an axis against the acceleration of another [kg/m, kg, kg m].
    pub fn inertia(&self, axis: Axis, other: Axis) -> f64 {
        let own = if axis == other { self.rigid[axis].inertia } else { 0.0 };
        own + self.bodies().deformation_inertia[(axis.number(), other.number())]
    }
}
