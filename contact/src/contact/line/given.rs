//! Part of a line that is known before its contact forces are: gap, displacements and strength without them.

use super::grid::ContactGrid;
use super::hot_layers::HotLayers;
use super::rim;
use super::state::GridState;
use super::strength::Strength;
use super::vectors::copy;
use crate::axes::PerAxis;
use crate::contact::flexibility::ByPowers;
use crate::contact::problem::LineProblem;
use nalgebra::DVector;

/// Known part of one problem; nothing in it changes while the forces are sought.
#[derive(Default)]
pub struct KnownPart {
    /// Undeformed gap at the candidates \[m].
    pub gap: Vec<f64>,
    /// Known part of `d_t` of the tangential gap [m/s].
    pub slip_offset: Vec<f64>,
    /// Displacement of the ports of wheel and rail without contact forces and without accelerations that are sought \[m].
    pub ports: [DVector<f64>; 2],
    /// That of all nodes, with what hot layers of the line itself displace \[m].
    pub displacement: [DVector<f64>; 2],
    /// Thermal part of it.
    pub layers: HotLayers,
    /// Slope of the depth by which the rail lies below its plane, at the candidates \[1]; empty without any.
    pub rail_slope: Vec<f64>,
    /// Depths by which the surfaces of wheel and rail lie below circle and plane, at the candidates and one node beyond
    /// on each side \[m].
    pub depth: Vec<[f64; 2]>,
    /// Powers of the places of the candidates \[1]; empty: the line is in no patch.
    pub powers: Vec<ByPowers>,
    /// Strength of the steel.
    pub strength: Strength,
    /// Height of the round wheel over its lowest point at all nodes \[m], see [`rim::RimFrame::sagitta`].
    pub sagitta: Vec<f64>,
}

impl KnownPart {
    /// Finds all of it but what other lines do, under rigid `accelerations` of the wheel that are known.
    pub fn find(&mut self, grid: &ContactGrid, problem: &LineProblem, state: &GridState, accelerations: PerAxis<f64>) {
        rim::sagitta(grid, problem.surfaces.radius, &mut self.sagitta);
        for body in 0..2 {
            copy(&mut self.ports[body], problem.bodies.free[body]);
            self.layers.find(grid, problem, body, &state.status);
        }
        for (axis, acceleration) in accelerations.iter() {
            self.ports[0].axpy(acceleration, &problem.bodies.inertial.column(axis.number()), 1.0);
        }
        for body in 0..2 {
            grid.expand(&self.ports[body], &mut self.displacement[body]);
            self.layers.add_to(body, &mut self.displacement[body]);
        }
        self.gap.clear();
        let layers = &self.layers;
        self.gap.extend(grid.x.iter().enumerate().map(|(i, &x)| {
            let swollen = layers.swelling_at(0, i) + layers.swelling_at(1, i);
            problem.surfaces.round_gap(x) - swollen
        }));
        self.powers.clear();
        if let Some(patch) = problem.patch {
            self.powers.extend(patch.powers(&grid.x));
        }
        self.slip_offset.clear();
        self.slip_offset.extend(state.moved[0].iter().map(|h| h.offset(&problem.time)));
        self.strength.find(grid, problem, state);
        self.find_unevenness(grid, problem);
    }

    /// Adds the displacement of a body's `ports` by the hot layers of all lines \[m].
    pub fn add_pulled(&mut self, grid: &ContactGrid, body: usize, ports: &DVector<f64>) {
        self.ports[body] += ports;
        self.layers.moved_by_bodies(grid, body, ports, &mut self.displacement[body]);
    }

    /// Adds the depths of wheel and rail below circle and plane to the gap, and takes the slope of the rail.
    fn find_unevenness(&mut self, grid: &ContactGrid, problem: &LineProblem) {
        let Self { gap, rail_slope, depth, .. } = self;
        rail_slope.clear();
        let Some(uneven) = problem.surfaces.uneven else { return };
        let around = &grid.nodes()[grid.guard - 1..=grid.guard + grid.len()];
        depth.clear();
        depth.extend(around.iter().map(|&x| uneven.depth(x)));
        gap.iter_mut().zip(&depth[1..]).for_each(|(gap, [wheel, rail])| *gap += wheel + rail);
        rail_slope.extend((0..grid.len()).map(|i| (depth[i + 2][1] - depth[i][1]) / grid.span(i)));
    }
}
