//! Hot layers under the surfaces of a line: they swell, and their membrane forces pull along the bodies.

use super::grid::ContactGrid;
use super::vectors::copy;
use crate::contact::problem::LineProblem;
use crate::linalg::vectorised::add_columns;
use nalgebra::{DMatrix, DVector};

/// Swelling, pull and displacement of the hot layers of wheel and rail.
#[derive(Default)]
pub struct HotLayers {
    /// Swelling at the candidates \[m]; empty without any.
    pub swelling: [Vec<f64>; 2],
    /// Pull at the candidates [N/m]; empty without any.
    pub pull: [Vec<f64>; 2],
    /// Displacement of all ports by the membrane forces \[m]; empty without any.
    pub membrane: [DVector<f64>; 2],
    /// Membrane force of the body at hand at the candidates [N/m], then displacement of all nodes \[m].
    force: Vec<f64>,
}

impl HotLayers {
    /// Finds those of one body, and adds their displacement to `known` \[m].
    pub fn find(&mut self, grid: &ContactGrid, problem: &LineProblem, body: usize, known: &mut DVector<f64>) {
        let (force, layer) = (problem.membrane[body], problem.placement.swelling[body]);
        let (swelling, membrane) = (&mut self.swelling[body], &mut self.membrane[body]);
        let (pull, at_candidates) = (&mut self.pull[body], &mut self.force);
        pull.clear();
        swelling.clear();
        if !layer.is_empty() {
            layer.sample(&grid.x, swelling);
        }
        if force.is_empty() {
            *membrane = DVector::zeros(0);
            return;
        }
        copy(membrane, known);
        membrane.fill(0.0);
        force.sample(&grid.x, at_candidates);
        let last = grid.len().saturating_sub(1);
        for i in 0..=last {
            pull.push(-0.5 * (at_candidates[(i + 1).min(last)] - at_candidates[i.saturating_sub(1)]));
        }
        displace(grid, problem.share, problem.bodies.shared.compliance[body], pull, membrane);
        if let Some(alone) = problem.alone() {
            alone.displace(0, grid.port(0) / 2, pull, at_candidates);
            let nodes = membrane.as_mut_slice().as_chunks_mut::<2>().0;
            nodes.iter_mut().zip(&*at_candidates).for_each(|([along, _], moved)| *along += moved);
        }
        *known += &*membrane;
    }

    /// Adds the displacement of one body by the `pull` of other lines' layers, at the candidates [N/m], to that by its
    /// own and to `known` \[m].
    pub fn add_pull(
        &mut self,
        grid: &ContactGrid,
        compliance: &DMatrix<f64>,
        body: usize,
        pull: &[f64],
        known: &mut DVector<f64>,
    ) {
        let mut by_others = DVector::zeros(known.len());
        displace(grid, 1.0, compliance, pull, &mut by_others);
        let membrane = &mut self.membrane[body];
        if membrane.is_empty() {
            membrane.clone_from(&by_others)
        } else {
            *membrane += &by_others
        }
        *known += by_others;
    }

    /// Swelling of one body at candidate `i` \[m].
    pub fn swelling_at(&self, body: usize, i: usize) -> f64 {
        self.swelling[body].get(i).copied().unwrap_or(0.0)
    }
}

/// Adds the displacement by tangential forces `pull` at the candidates [N/m], a `share` of which the bodies feel.
fn displace(grid: &ContactGrid, share: f64, compliance: &DMatrix<f64>, pull: &[f64], displacement: &mut DVector<f64>) {
    let ports = displacement.len();
    // Every other column belongs to a normal force.
    let columns = &compliance.as_slice()[grid.port(0) * ports..];
    add_columns(share, columns, 2 * ports, pull, displacement.as_mut_slice());
}
