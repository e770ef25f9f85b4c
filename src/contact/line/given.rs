//! Part of a line that is known before its contact forces are: gap, displacements and strength without them.

use super::grid::ContactGrid;
use super::hot_layers::HotLayers;
use super::rim;
use super::state::GridState;
use super::strength::Strength;
use super::vectors::copy;
use crate::axes::PerAxis;
use crate::contact::problem::{Influence, LineProblem};
use nalgebra::DVector;

/// Known part of one problem; nothing in it changes while the forces are sought.
#[derive(Default)]
pub struct KnownPart {
    /// Undeformed gap at the candidates \[m].
    pub gap: Vec<f64>,
    /// Known part of `d_t` of the tangential gap [m/s].
    pub slip_offset: Vec<f64>,
    /// Displacement of wheel and rail without contact forces and without accelerations that are sought \[m].
    pub displacement: [DVector<f64>; 2],
    /// Thermal part of it.
    pub layers: HotLayers,
    /// Slope of the depth by which the rail lies below its plane, at the candidates \[1]; empty without any.
    pub rail_slope: Vec<f64>,
    /// Depths by which the surfaces of wheel and rail lie below circle and plane, at the candidates and one node beyond
    /// on each side \[m].
    pub depth: Vec<[f64; 2]>,
    /// Strength of the steel.
    pub strength: Strength,
    /// Height of the round wheel over its lowest point at all nodes \[m], see [`rim::RimFrame::sagitta`].
    pub sagitta: Vec<f64>,
}

impl KnownPart {
    /// Finds all of it under rigid `accelerations` of the wheel that are known; `forces` are the port forces of the
    /// start.
    pub fn find(
        &mut self,
        grid: &ContactGrid,
        problem: &LineProblem,
        state: &GridState,
        forces: &DVector<f64>,
        accelerations: PerAxis<f64>,
    ) {
        rim::sagitta(grid, problem.surfaces.radius, &mut self.sagitta);
        for (body, known) in self.displacement.iter_mut().enumerate() {
            copy(known, problem.bodies.free[body]);
            self.layers.find(grid, problem, body, known);
        }
        for (axis, acceleration) in accelerations.iter() {
            self.displacement[0].axpy(acceleration, &problem.bodies.inertial.column(axis.number()), 1.0);
        }
        self.gap.clear();
        let layers = &self.layers;
        self.gap.extend(grid.x.iter().enumerate().map(|(i, &x)| {
            let swollen = layers.swelling_at(0, i) + layers.swelling_at(1, i);
            problem.surfaces.round_gap(x, &problem.placement) - swollen
        }));
        self.slip_offset.clear();
        self.slip_offset.extend(state.tangential_gap.iter().map(|h| h.offset(&problem.time)));
        self.strength.find(grid, &problem.limits, forces, &state.across.force);
        self.find_unevenness(grid, problem);
    }

    /// Adds the displacements by the `pull` of other lines' hot layers on wheel and rail, at the candidates [N/m].
    pub fn add_pulls_of_others(&mut self, grid: &ContactGrid, others: &Influence, pull: &[Vec<f64>; 2]) {
        for (body, pull) in pull.iter().enumerate().filter(|(_, pull)| !pull.is_empty()) {
            self.layers.add_pull(grid, others.compliance[body], body, pull, &mut self.displacement[body]);
        }
    }

    /// Adds the depths of wheel and rail below circle and plane to the gap, and takes the slope of the rail.
    fn find_unevenness(&mut self, grid: &ContactGrid, problem: &LineProblem) {
        let Self { gap, rail_slope, depth, .. } = self;
        rail_slope.clear();
        if !problem.surfaces.is_uneven(&problem.placement) {
            return;
        }
        let around = &grid.nodes()[grid.guard - 1..=grid.guard + grid.len()];
        depth.clear();
        depth.extend(around.iter().map(|&x| problem.surfaces.depth(x, &problem.placement)));
        gap.iter_mut().zip(&depth[1..]).for_each(|(gap, [wheel, rail])| *gap += wheel + rail);
        rail_slope.extend((0..grid.len()).map(|i| (depth[i + 2][1] - depth[i][1]) / grid.span(i)));
    }
}
