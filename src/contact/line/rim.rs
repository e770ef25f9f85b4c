//! The frame that turns with the rim.
//!
//! The torsion of the wheel between hub and rim turns the rim as a whole. For a round rim that is no change of geometry,
//! but in linear kinematics a turn `θ` moves the surface by `θ (√(r² − x²), x)`: it tilts the gap and moves the patch to
//! `−θr`. Gap, strains and lever arms are therefore those of the displacement *relative to the turned rim*,
//! `û = u − θ (√(r² − x²), x)`, where `θ` makes the pressure-weighted mean of `û_x` vanish. The material passes the contact
//! with the velocity of the rim, `r (Ω − θ̇)`. Derivation: `docs/theory/lever-arms.md`.

use super::grid::ContactGrid;
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
        u[self.grid.port(i) + 1] - self.rim_angle * self.grid.x[i]
    }

    /// Angle [rad] at which the mean of `û_x`, weighted with the nodal normal `forces`, vanishes; without any, that at which it
    /// vanishes at the middle of the zone.
    pub fn angle_of(&self, u: &DVector<f64>, forces: &DVector<f64>) -> f64 {
        self.weights(forces).map(|(port, weight)| weight * u[port]).sum()
    }

    /// What the displacements at the x ports contribute to this angle [1/m].
    pub fn weights(&self, forces: &DVector<f64>) -> impl Iterator<Item = (usize, f64)> {
        let grid = self.grid;
        let normal = move |i: usize| forces[grid.port(i) + 1].max(0.0);
        let arm = |i: usize| self.radius - self.sagitta[grid.port(i) / 2];
        let sum: f64 = (0..grid.len()).map(|i| normal(i) * arm(i)).sum();
        let middle = (sum == 0.0).then(|| (grid.port(grid.len() / 2), 1.0 / self.radius));
        let loaded = (0..grid.len()).filter(move |&i| normal(i) > 0.0);
        loaded.map(move |i| (grid.port(i), normal(i) / sum)).chain(middle)
    }
}

/// Writes the height of a circle over its lowest point at all nodes of the grid, guards included [m].
pub(in crate::contact) fn sagitta(grid: &ContactGrid, radius: f64, heights: &mut Vec<f64>) {
    heights.clear();
    heights.extend(grid.nodes().iter().map(|x| x * x / (radius + (radius * radius - x * x).max(0.0).sqrt())));
}
