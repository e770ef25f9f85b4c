//! Temperature of whole bodies at the nodes of their meshes.

use super::layout::Heat;
use super::modal::{HeatBody, dot};
use super::state::HeatState;
use crate::fem::Mesh;
use crate::heat::error::HeatError;

/// Temperature of one body.
#[derive(Clone, Debug)]
pub struct TemperatureField {
    /// The wheel about its centre, the rail with the contact point at the origin; cells between all nodes, those in the
    /// middle of the quadratic layers included.
    pub mesh: Mesh,
    /// At the nodes, over the reference \[K].
    pub temperature: Vec<f64>,
}

impl Heat {
    /// Surface temperatures of wheel and rail at x \[m] within the contact zone, linear between nodes \[K].
    pub fn surface_temperatures(&self, state: &HeatState, x: f64) -> Result<[f64; 2], HeatError> {
        Ok([self.wheel_temperature(state, x, 0.0)?, self.rail_temperature(state, x, 0.0)?])
    }

    /// Temperature of the wheel at the distance `s` along the tread from the contact point and the depth `z` below it,
    /// both in \[m], over the reference \[K].
    pub fn wheel_temperature(&self, state: &HeatState, s: f64, z: f64) -> Result<f64, HeatError> {
        self.check_state(state)?;
        self.temperature(0, state, s, z)
    }

    /// Temperature of the rail at `x` and the depth `z`, both in \[m], over the reference \[K].
    pub fn rail_temperature(&self, state: &HeatState, x: f64, z: f64) -> Result<f64, HeatError> {
        self.check_state(state)?;
        self.temperature(1, state, x, z)
    }

    /// Temperature of a body (0: wheel, 1: rail) at one point.
    fn temperature(&self, body: usize, state: &HeatState, s: f64, z: f64) -> Result<f64, HeatError> {
        let across = [&self.wheel, &self.rail][body].modes.at(z);
        let (rows, xi) = self.columns_at(body, state, s);
        let (from, to) = rows.split_at(across.len());
        Ok((1.0 - xi) * dot(from, &across) + xi * dot(to, &across))
    }

    /// Temperatures below the two surface nodes of a body (0: wheel, 1: rail) beside the distance `s` along the surface, mode
    /// by mode, and its place between them from 0 to 1.
    fn columns_at(&self, body: usize, state: &HeatState, s: f64) -> (Vec<f64>, f64) {
        let (wheel, rail) = self.split(state);
        let (field, body_at) = [(wheel, &self.wheel), (rail, &self.rail)][body];
        let nm = body_at.modes.len();
        let (nodes, xi) = element(body_at, s);
        let mut rows: Vec<f64> = nodes.iter().flat_map(|node| &field[node * nm..(node + 1) * nm]).copied().collect();
        self.cool_columns(body, state, &mut rows);
        (rows, xi)
    }

    /// Weights of the modes at given depths \[m] of the wheel, for [`Heat::wheel_column`]: a row of them for each depth.
    pub fn wheel_depths(&self, depths: &[f64]) -> Vec<f64> {
        depths.iter().flat_map(|&z| self.wheel.modes.at(z)).collect()
    }

    /// Fills `column` with the temperatures of the wheel at the distance `s` \[m] along the tread from the contact point and
    /// the depths that `weights` were made for, over the reference \[K]; zeros for a state of
    /// another model.
    pub fn wheel_column(&self, state: &HeatState, s: f64, weights: &[f64], column: &mut [f64]) {
        column.fill(0.0);
        if !self.fits(state) {
            return;
        }
        let nm = self.wheel.modes.len();
        let (rows, xi) = self.columns_at(0, state, s);
        let (from, to) = rows.split_at(nm);
        for (value, weights) in column.iter_mut().zip(weights.chunks_exact(nm)) {
            *value = (1.0 - xi) * dot(from, weights) + xi * dot(to, weights);
        }
    }

    /// Fields of wheel and rail.
    pub fn fields(&self, state: &HeatState) -> Result<[TemperatureField; 2], HeatError> {
        self.check_state(state)?;
        let radius = self.config.wheel.radius;
        let polar = |s: f64, z: f64| [(radius - z) * (s / radius).sin(), -(radius - z) * (s / radius).cos()];
        let (wheel, rail) = self.split(state);
        let (mut wheel, mut rail) = (wheel.to_vec(), rail.to_vec());
        self.cool_columns(0, state, &mut wheel);
        self.cool_columns(1, state, &mut rail);
        Ok([field(&self.wheel, &wheel, polar), field(&self.rail, &rail, |s, z| [s, -z])])
    }
}

/// Nodal temperatures, where `place` puts the distance along the surface and the depth into the plane.
fn field(body: &HeatBody, modes: &[f64], place: impl Fn(f64, f64) -> [f64; 2]) -> TemperatureField {
    let HeatBody { line, modes: across, .. } = body;
    let (along, depths) = (line.len(), across.depths.len());
    let mut mesh = Mesh::default();
    let mut temperature = Vec::with_capacity(along * depths);
    for (&s, values) in line.nodes.iter().zip(modes.chunks_exact(across.len())) {
        for (i, &z) in across.depths.iter().enumerate() {
            mesh.nodes.push(place(s, z));
            // A fixed last node has no row.
            let free = i < across.shapes.nrows();
            let shape: Vec<f64> = if free { across.shapes.row(i).iter().copied().collect() } else { Vec::new() };
            temperature.push(dot(values, &shape));
        }
    }
    for element in 0..line.lengths.len() {
        let (from, to) = (element * depths, line.after(element) * depths);
        // Counter-clockwise: below the contact point depth points down in the rail, up in the wheel.
        let wheel = line.closed > 0.0;
        let cell = |(upper, lower): (usize, usize)| [from + lower, to + lower, to + upper, from + upper];
        mesh.cells.extend((1..depths).map(|i| cell(if wheel { (i, i - 1) } else { (i - 1, i) })));
    }
    TemperatureField { mesh, temperature }
}

/// Nodes of the element at a distance along the surface, and the place within it from 0 to 1; outside an open streamline
/// that of its end.
fn element(body: &HeatBody, s: f64) -> ([usize; 2], f64) {
    let line = &body.line;
    let mut s = s;
    if line.closed > 0.0 {
        s = line.nodes[0] + (s - line.nodes[0]).rem_euclid(line.closed);
    }
    let element = line.nodes.partition_point(|&x| x <= s).saturating_sub(1).min(line.lengths.len() - 1);
    let xi = ((s - line.nodes[element]) / line.lengths[element]).clamp(0.0, 1.0);
    ([element, line.after(element)], xi)
}
