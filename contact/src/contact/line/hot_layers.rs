//! Hot layers under the surfaces of a line: they swell, and their membrane forces pull along the bodies.

use super::alone::{Alone, OwnDisplacement};
use super::grid::ContactGrid;
use super::state::NodeStatus;
use crate::contact::problem::LineProblem;
use nalgebra::DVector;
use std::ops::RangeInclusive;

/// Distance from a patch within which layers pull, over its length \[1].
const BESIDE: f64 = 0.5;

/// Swelling, pull and displacement of the hot layers of wheel and rail.
#[derive(Default)]
pub struct HotLayers {
    /// Swelling at the candidates \[m]; empty without any.
    pub swelling: [Vec<f64>; 2],
    /// Pull at the candidates [N/m]; empty without any.
    pub pull: [Vec<f64>; 2],
    /// Pull on the ports of the bodies [N/m].
    pub on_ports: [DVector<f64>; 2],
    /// Displacement of all nodes by the membrane forces \[m]; empty without any.
    pub membrane: [DVector<f64>; 2],
    /// Membrane force of the body at hand at the candidates [N/m], then the pulls at all nodes.
    force: Vec<f64>,
    own: OwnDisplacement,
}

impl HotLayers {
    /// Finds those of one body, and what the line itself displaces by them. Layers pull in the middle of
    /// the grid, and close to the patch of the `status` before where that is longer. Farther away their heat stays as it is, and
    /// what differs there is the error of wide cells.
    pub fn find(&mut self, grid: &ContactGrid, problem: &LineProblem, body: usize, status: &[NodeStatus]) {
        let (force, layer) = (problem.membrane[body], problem.surfaces.swelling[body]);
        let (swelling, membrane, pull) = (&mut self.swelling[body], &mut self.membrane[body], &mut self.pull[body]);
        pull.clear();
        swelling.clear();
        if !layer.is_empty() {
            layer.sample(&grid.x, swelling);
        }
        if force.is_empty() {
            (*membrane, self.on_ports[body]) = (DVector::zeros(0), DVector::zeros(0));
            return;
        }
        force.sample(&grid.x, &mut self.force);
        let last = grid.len().saturating_sub(1);
        let near = near_long_patch(grid, status);
        for i in 0..=last {
            let gradient = 0.5 * (self.force[(i + 1).min(last)] - self.force[i.saturating_sub(1)]);
            let pulls = in_the_middle(grid, i) || near.as_ref().is_some_and(|near| near.contains(&grid.x[i]));
            pull.push(if pulls { -gradient } else { 0.0 });
        }
        self.force.clear();
        self.force.resize(grid.components(), 0.0);
        pull.iter().enumerate().for_each(|(i, pull)| self.force[grid.component(i)] = *pull);
        self.on_ports[body] = grid.moments(&self.force);
        Alone { kernel: problem.kernel, grid }.find(&self.force, &mut self.own);
        *membrane = DVector::zeros(grid.components());
        self.own.add_to(body, membrane);
    }

    /// Adds the displacement of all nodes of one body.
    pub fn add_to(&self, body: usize, displacement: &mut DVector<f64>) {
        if !self.membrane[body].is_empty() {
            *displacement += &self.membrane[body];
        }
    }

    /// Adds the displacement of a body's `ports` by the layers of all lines \[m] to that of all nodes by the own ones and to
    /// the `displacement` of all.
    pub fn moved_by_bodies(
        &mut self,
        grid: &ContactGrid,
        body: usize,
        ports: &DVector<f64>,
        displacement: &mut DVector<f64>,
    ) {
        let membrane = &mut self.membrane[body];
        if membrane.is_empty() {
            *membrane = DVector::zeros(grid.components());
        }
        grid.add_expanded(ports, membrane);
        grid.add_expanded(ports, displacement);
    }

    /// Swelling of one body at candidate `i` \[m].
    pub fn swelling_at(&self, body: usize, i: usize) -> f64 {
        self.swelling[body].get(i).copied().unwrap_or(0.0)
    }
}

/// True if candidate `i` is in the middle of the grid, where nodes have one distance.
fn in_the_middle(grid: &ContactGrid, i: usize) -> bool {
    grid.share(i) == 1.0
}

/// Stretch around closed nodes that lie beyond the middle of the grid \[m]; `None`: there are none.
fn near_long_patch(grid: &ContactGrid, status: &[NodeStatus]) -> Option<RangeInclusive<f64>> {
    let closed = |status: &NodeStatus| status.is_active();
    let (first, last) = status.iter().position(closed).zip(status.iter().rposition(closed))?;
    let beside = BESIDE * (grid.x[last] - grid.x[first]) + grid.spacing;
    let long = !in_the_middle(grid, first) || !in_the_middle(grid, last);
    long.then(|| grid.x[first] - beside..=grid.x[last] + beside)
}
