//! Forces by which retarded layers relieve the hub.
//!
//! Betti's theorem, on which the lever arms rest, holds between forces and the displacement that they cause themselves.
//! The displacement of a [`RetardedSurface`] belongs to the elastic part of the forces; the part that runs ahead of it
//! does work on its slope, which is not dissipated. Derivation: `docs/theory/lever-arms.md`, section 4a.

use super::grid::ContactGrid;
use super::others::LineForces;
use super::vectors::copy;
use crate::contact::problem::{LineProblem, RetardedSurface};
use nalgebra::DVector;

/// Forces of the retarded layers of wheel and rail, and the memory to compute them.
#[derive(Default)]
pub struct Retarded {
    /// Of wheel and rail, at the rim [N/m].
    pub force: [f64; 2],
    /// Elastic nodal forces of the layer at hand [N/m].
    elastic: DVector<f64>,
    /// Their displacement \[m].
    displacement: DVector<f64>,
}

impl Retarded {
    /// Takes the forces that belong to the forces of all lines; returns the change of their sum [N/m].
    pub fn update(&mut self, grid: &ContactGrid, problem: &LineProblem, all: LineForces) -> f64 {
        let LineForces { contact: forces, pull: pulls } = all;
        let before: f64 = self.force.iter().sum();
        self.force = [0.0; 2];
        if !problem.time.is_stationary() {
            for (body, layer) in problem.bodies.retarded.iter().enumerate() {
                let Some(layer) = layer else { continue };
                self.displace(grid, layer, forces, &pulls[body], if body == 0 { 1.0 } else { -1.0 });
                self.force[body] = match body {
                    0 => self.sum(grid, forces, &pulls[0], 1.0, 1.0 / problem.surfaces.radius),
                    _ => self.sum(grid, forces, &pulls[1], -1.0, 0.0),
                };
            }
        }
        self.force.iter().sum::<f64>() - before
    }

    /// Elastic forces of a layer and their displacement; `sign` turns forces on the wheel into those on its body.
    fn displace(
        &mut self,
        grid: &ContactGrid,
        layer: &RetardedSurface,
        forces: &DVector<f64>,
        pull: &[f64],
        sign: f64,
    ) {
        let Self { elastic, displacement, .. } = self;
        copy(elastic, layer.known);
        elastic.axpy(sign * layer.share, forces, 1.0);
        pull.iter().enumerate().for_each(|(i, pull)| elastic[grid.port(i)] += layer.share * pull);
        copy(displacement, layer.known);
        displacement.gemv(1.0, layer.flexibility, elastic, 0.0);
    }

    /// `Σ l·D u` with the forces `l` that run ahead and the displacement `u` of the layer, less
    /// `Σ (l_n u_x − l_t u_y)` times the curvature `turning` of a wheel [N/m].
    fn sum(&self, grid: &ContactGrid, forces: &DVector<f64>, pull: &[f64], sign: f64, turning: f64) -> f64 {
        let Self { elastic, displacement, .. } = self;
        let of_node = |i: usize| {
            let port = grid.port(i);
            let pull = pull.get(i).copied().unwrap_or(0.0);
            let tangential = sign * forces[port] + pull - elastic[port];
            let normal = sign * forces[port + 1] - elastic[port + 1];
            let turned = normal * displacement[port] - tangential * displacement[port + 1];
            tangential * grid.slope(displacement, i, 0) + normal * grid.slope(displacement, i, 1) - turning * turned
        };
        (0..grid.len()).map(of_node).sum()
    }
}
