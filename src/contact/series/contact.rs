//! Lines side by side on their way to a solution: what they share.

use super::series_line::SeriesLine;
use super::surface::{AtPoints, Moments, SmoothSurfaces, displaced_by_powers};
use crate::axes::{Axis, PerAxis};
use crate::contact::flexibility::ByMoments;
use crate::contact::problem::{AxisDrive, RigidMotion, SurfaceResponse};
use crate::linalg::DenseSystem;

/// Largest number of lines side by side.
pub const MOST_LINES: usize = 16;

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
    /// Equations of all lines.
    pub system: DenseSystem,
}

impl<'a> SeriesContact<'a> {
    /// Contact of at least one line.
    pub fn new(mut lines: Vec<SeriesLine<'a>>, rigid: &'a PerAxis<RigidMotion>) -> Self {
        let mut pulls = [AtPoints::default(); 2];
        for line in &lines {
            let share = line.problem.line.share;
            for (sum, pull) in pulls.as_flattened_mut().iter_mut().zip(line.pulls.as_flattened()) {
                *sum += share * pull;
            }
        }
        lines.iter_mut().for_each(|line| line.mean_pulls = pulls);
        let by_powers = displaced_by_powers(&lines[0].problem.line.bodies, &lines[0].constants.points);
        Self { lines, rigid, pulls, moments: Moments::default(), by_powers, system: DenseSystem::default() }
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
