//! Forces by which retarded flexibility relieves the hub.
//!
//! Betti's theorem, on which the lever arms rest, holds between forces and the displacement that they cause themselves.
//! The displacement of a [`RetardedSurface`](crate::contact::RetardedSurface) belongs to the elastic part of the forces; the
//! part that runs ahead of it does work on its slope, which is not dissipated. Derivation: `docs/theory/lever-arms.md`,
//! section 4a.

use super::alone::{Alone, OwnDisplacement};
use super::given::KnownPart;
use super::grid::ContactGrid;
use crate::contact::problem::{LineProblem, RetardedSurface};
use crate::linalg::POINTS;
use nalgebra::DVector;

/// Forces of the retarded flexibility of wheel and rail, and the memory to compute them.
#[derive(Default)]
pub struct Retarded {
    /// Of wheel and rail, at the rim [N/m].
    pub force: [f64; 2],
    /// Elastic forces on the body at hand, x and y of every node [N/m].
    elastic: Vec<f64>,
    /// Forces ahead of them [N/m], and the displacement by the elastic ones \[m].
    ahead: Vec<f64>,
    own: OwnDisplacement,
    displacement: DVector<f64>,
}

/// Forces of all lines on the ports of the bodies, each line weighted with its share of the width.
#[derive(Default)]
pub struct PortForces {
    /// Contact forces on the wheel [N/m].
    pub contact: DVector<f64>,
    /// Pulls of hot layers on wheel and rail [N/m]; empty: there are none.
    pub pull: [DVector<f64>; 2],
}

impl PortForces {
    /// All forces on wheel (0) or rail (1) [N/m].
    fn on(&self, body: usize) -> DVector<f64> {
        let sign = if body == 0 { 1.0 } else { -1.0 };
        let contact = &self.contact * sign;
        if self.pull[body].is_empty() { contact } else { contact + &self.pull[body] }
    }
}

/// Writes the forces of a line on wheel (0) or rail (1), x and y of every node [N/m].
pub fn nodal_loads(grid: &ContactGrid, contact: &DVector<f64>, pull: &[f64], body: usize, loads: &mut Vec<f64>) {
    let sign = if body == 0 { 1.0 } else { -1.0 };
    loads.clear();
    loads.extend(contact.iter().map(|force| sign * force));
    pull.iter().enumerate().for_each(|(i, pull)| loads[grid.component(i)] += pull);
}

impl Retarded {
    /// Takes the forces that belong to the contact forces `own` of the line at all nodes and to those of `all`; returns the
    /// change of their sum [N/m].
    pub fn update(
        &mut self,
        grid: &ContactGrid,
        problem: &LineProblem,
        given: &KnownPart,
        (own, all): (&DVector<f64>, &PortForces),
    ) -> f64 {
        let before: f64 = self.force.iter().sum();
        self.force = [0.0; 2];
        if !problem.time.is_stationary() {
            for (body, layer) in problem.bodies.retarded.iter().enumerate() {
                let Some(layer) = layer else { continue };
                nodal_loads(grid, own, &given.layers.pull[body], body, &mut self.ahead);
                let turning = if body == 0 { 1.0 / problem.surfaces.radius } else { 0.0 };
                let alone = Alone { kernel: problem.kernel.without_reach(), grid };
                self.force[body] = self.of_line(alone, body, layer, &given.elastic[body], turning)
                    + of_body(grid, layer, &all.on(body), turning);
            }
        }
        self.force.iter().sum::<f64>() - before
    }

    /// `Σ l·D u` with the forces `l` that run ahead and the displacement `u` of the line's own flexibility, less
    /// `Σ (l_n u_x − l_t u_y)` times the curvature `turning` of a wheel [N/m].
    fn of_line(&mut self, alone: Alone, body: usize, layer: &RetardedSurface, known: &[f64], turning: f64) -> f64 {
        let Self { elastic, ahead, own, displacement, .. } = self;
        elastic.clear();
        elastic.extend(ahead.iter().zip(known).map(|(load, known)| layer.share * load + known));
        alone.find(elastic, own);
        let grid = alone.grid;
        if displacement.len() != grid.components() {
            *displacement = DVector::zeros(grid.components());
        }
        displacement.fill(0.0);
        own.add_to(body, displacement);
        ahead.iter_mut().zip(&*elastic).for_each(|(load, elastic)| *load -= elastic);
        let of_node = |i: usize| {
            let at = grid.component(i);
            let turned = ahead[at + 1] * displacement[at] - ahead[at] * displacement[at + 1];
            ahead[at] * grid.slope(displacement, i, 0) + ahead[at + 1] * grid.slope(displacement, i, 1)
                - turning * turned
        };
        (0..grid.len()).map(of_node).sum()
    }
}

/// Force of a body's own flexibility likewise, under `forces` on its ports.
fn of_body(grid: &ContactGrid, layer: &RetardedSurface, forces: &DVector<f64>, turning: f64) -> f64 {
    let elastic = layer.share * forces + layer.known;
    let (ahead, moved) = (forces - &elastic, layer.flexibility * &elastic);
    let polynomials = [0, 1].map(|c| grid.points.polynomial(&std::array::from_fn(|k| moved[2 * k + c])));
    let of_point = |k: usize| {
        let (x, [along, normal]) = (grid.points.nodes()[k], [ahead[2 * k], ahead[2 * k + 1]]);
        let turned = normal * moved[2 * k] - along * moved[2 * k + 1];
        along * polynomials[0].slope(x) + normal * polynomials[1].slope(x) - turning * turned
    };
    (0..POINTS).map(of_point).sum()
}
