//! Frame that turns with the rim, and the rim angle as a function of the forces.
//!
//! The torsion of the wheel between hub and rim turns the rim as a whole. For a round rim that is no change of
//! geometry, but in linear kinematics a turn `θ` moves the surface by `θ (√(r² − x²), x)`: it tilts the gap and moves
//! the patch to `−θr`. Gap, strains and lever arms are therefore those of the displacement *relative to the turned
//! rim*, `û = u − θ (√(r² − x²), x)`, where `θ` makes the pressure-weighted mean of `û_x` vanish. The material passes
//! the contact with the velocity of the rim, `r (Ω − θ̇)`. Derivation: `docs/theory/lever-arms.md`.

use super::alone::{Alone, signs};
use super::grid::ContactGrid;
use crate::axes::PerAxis;
use crate::contact::kernel::LineKernel;
use crate::contact::problem::LineProblem;
use crate::linalg::POINTS;
use nalgebra::DVector;

/// Displacements of the wheel surface as seen from the turned rim.
#[derive(Clone, Copy)]
pub(in crate::contact) struct RimFrame<'a> {
    pub grid: &'a ContactGrid,
    /// Radius of the round wheel [m].
    pub radius: f64,
    /// Height of the circle over its lowest point at all nodes, guards included [m].
    pub sagitta: &'a [f64],
    /// Angle of the rim against the hub, positive where the tread moves towards `+x` [rad].
    pub rim_angle: f64,
}

impl RimFrame<'_> {
    /// `û_x` [m] at an x port of the displacement `u` of the wheel surface.
    pub fn tangential(&self, u: &DVector<f64>, port: usize) -> f64 {
        u[port] - self.rim_angle * (self.radius - self.sagitta[port / 2])
    }

    /// `û_y` [m] at candidate `i`.
    pub fn normal(&self, u: &DVector<f64>, i: usize) -> f64 {
        u[self.grid.component(i) + 1] - self.rim_angle * self.grid.x[i]
    }

    /// Angle [rad] at which the mean of `û_x`, weighted with the nodal normal `forces`, vanishes; without any, that at
    /// which it vanishes at the middle of the zone.
    pub fn angle_of(&self, u: &DVector<f64>, forces: &DVector<f64>) -> f64 {
        self.weights(forces).map(|(port, weight)| weight * u[port]).sum()
    }

    /// Weights of the displacements at the x ports in this angle [1/m].
    pub fn weights(&self, forces: &DVector<f64>) -> impl Iterator<Item = (usize, f64)> {
        let grid = self.grid;
        let normal = move |i: usize| forces[grid.component(i) + 1].max(0.0);
        let arm = |i: usize| self.radius - self.sagitta[grid.component(i) / 2];
        let sum: f64 = (0..grid.len()).map(|i| normal(i) * arm(i)).sum();
        let middle = (sum == 0.0).then(|| (grid.component(grid.len() / 2), 1.0 / self.radius));
        let loaded = (0..grid.len()).filter(move |&i| normal(i) > 0.0);
        loaded.map(move |i| (grid.component(i), normal(i) / sum)).chain(middle)
    }
}

/// Writes the height of a circle over its lowest point at all nodes of the grid, guards included [m].
pub(in crate::contact) fn sagitta(grid: &ContactGrid, radius: f64, heights: &mut Vec<f64>) {
    heights.clear();
    heights.extend(grid.nodes().iter().map(|x| x * x / (radius + (radius * radius - x * x).max(0.0).sqrt())));
}

/// Rim angle as an affine function of port forces and rigid accelerations.
#[derive(Default)]
pub struct RimAngleRow {
    /// Coefficients of the forces of all lines on the ports [rad/(N/m)].
    pub by_ports: DVector<f64>,
    /// Those of the tangential and of the normal forces of the line at all nodes, by the flexibility that it has for itself.
    pub tangential: Vec<f64>,
    pub normal: Vec<f64>,
    /// Coefficients of the accelerations of the rigid motions [rad/(m/s²), rad/(rad/s²)].
    pub accelerations: PerAxis<f64>,
    /// Constant \[rad].
    pub constant: f64,
    /// Its value in the present solution, with the weights of the one before \[rad].
    pub value: f64,
    /// Weights of the displacements along at all nodes [1/m].
    weights: Vec<f64>,
}

impl RimAngleRow {
    /// Takes the mean of [`RimFrame::angle_of`] with the weights of the present port `forces`; `known`: displacement of
    /// the wheel without contact forces and without accelerations that are sought \[m].
    pub fn update(
        &mut self,
        frame: &RimFrame,
        (problem, kernel): (&LineProblem, &LineKernel),
        known: &DVector<f64>,
        forces: &DVector<f64>,
    ) {
        let (grid, bodies) = (frame.grid, &problem.bodies);
        self.constant = 0.0;
        self.weights.clear();
        self.weights.resize(grid.nodes().len(), 0.0);
        let mut at_points = [0.0; POINTS];
        for (component, weight) in frame.weights(forces) {
            self.weights[component / 2] = weight;
            self.constant += weight * known[component];
            let values = grid.values[component / 2];
            at_points.iter_mut().zip(values).for_each(|(sum, value)| *sum += weight * value);
        }
        let at_points = |of: &dyn Fn(usize) -> f64| (0..POINTS).map(|k| at_points[k] * of(2 * k)).sum::<f64>();
        self.accelerations = PerAxis::from_fn(|axis| at_points(&|port| bodies.inertial_at(port)[axis]));
        let compliance = bodies.shared.compliance[0];
        self.by_ports = DVector::from_fn(2 * POINTS, |by, _| at_points(&|port| compliance[(port, by)]));
        Alone { kernel: *kernel, grid }.displace(0, 0, &self.weights, &mut self.tangential);
        self.normal.clear();
        self.normal.extend(signs(&self.weights).map(|sign| 0.5 * kernel.coupling * sign));
    }

    /// Part of the angle by the line's own `forces` at all nodes \[rad].
    pub fn by_own(&self, grid: &ContactGrid, forces: &DVector<f64>) -> f64 {
        let of_candidate = |i: usize| {
            let (node, at) = (i + grid.guard, grid.component(i));
            self.tangential[node] * forces[at] + self.normal[node] * forces[at + 1]
        };
        (0..grid.len()).map(of_candidate).sum()
    }
}
