//! Temperatures at points of a body, and at all nodes of its mesh.

use super::heat::Heat;
use super::mesh::body::HeatBody;
use super::mesh::kernels::dot;
use crate::fem::Mesh;
use crate::heat::error::HeatError;
use crate::heat::observation::TemperatureField;
use crate::heat::state::HeatState;
use crate::linalg::vectorised::add_columns;

impl Heat {
    /// Surface temperatures of wheel and rail at x \[m] within the contact zone, linear between nodes \[K].
    pub fn surface_temperatures(&self, state: &HeatState, x: f64) -> Result<[f64; 2], HeatError> {
        self.check_state(state)?;
        Ok([0, 1].map(|body| self.temperature(body, state, x, 0.0)))
    }

    /// Temperature of the wheel at the distance `s` along the tread from the contact point and the depth `z` below it,
    /// both in \[m], over the reference \[K].
    pub fn wheel_temperature(&self, state: &HeatState, s: f64, z: f64) -> Result<f64, HeatError> {
        self.check_state(state)?;
        Ok(self.temperature(0, state, s, z))
    }

    /// Temperature of a body (0: wheel, 1: rail) at one point.
    fn temperature(&self, body: usize, state: &HeatState, s: f64, z: f64) -> f64 {
        let across = self.layout.bodies()[body].modes.at(z);
        let (rows, xi) = self.columns_at(body, state, s);
        let (from, to) = rows.split_at(across.len());
        (1.0 - xi) * dot(from, &across) + xi * dot(to, &across)
    }

    /// Temperatures below the two surface nodes of a body (0: wheel, 1: rail) beside the distance `s` along the
    /// surface, mode by mode, and its place between them from 0 to 1.
    fn columns_at(&self, body: usize, state: &HeatState, s: f64) -> (Vec<f64>, f64) {
        let (field, body_at) = (self.layout.split(&state.values)[body], self.layout.bodies()[body]);
        let nm = body_at.modes.len();
        let (nodes, xi) = element(body_at, s);
        let mut rows = Vec::with_capacity(2 * nm);
        nodes.iter().for_each(|node| rows.extend_from_slice(&field[node * nm..(node + 1) * nm]));
        if let Some(latent) = self.melting_within(state.range) {
            latent.cool(body, &body_at.nodal, &mut rows);
        }
        (rows, xi)
    }

    /// Adds the temperatures of a body (0: wheel, 1: rail) at the distance `s` \[m] along its surface to `column`, at the
    /// depths at which the modes have the values `weights`, mode by mode.
    pub(super) fn fill_column(&self, body: usize, state: &HeatState, s: f64, weights: &[f64], column: &mut [f64]) {
        let (mut rows, xi) = self.columns_at(body, state, s);
        let (from, to) = rows.split_at_mut(self.layout.bodies()[body].modes.len());
        from.iter_mut().zip(to).for_each(|(from, to)| *from += xi * (*to - *from));
        add_columns(1.0, weights, column.len(), from, column);
    }

    /// Temperature fields of wheel and rail.
    pub(super) fn temperature_fields(&self, state: &HeatState) -> [TemperatureField; 2] {
        let radius = self.layout.config.radius;
        let polar = |s: f64, z: f64| [(radius - z) * libm::sin(s / radius), -(radius - z) * libm::cos(s / radius)];
        let [mut wheel, mut rail] = self.layout.split(&state.values).map(|field| field.to_vec());
        if let Some(latent) = self.melting_within(state.range) {
            latent.cool(0, &self.layout.wheel.nodal, &mut wheel);
            latent.cool(1, &self.layout.rail.nodal, &mut rail);
        }
        [field(&self.layout.wheel, &wheel, polar), field(&self.layout.rail, &rail, |s, z| [s, -z])]
    }
}

/// Nodal temperatures, where `place` puts the distance along the surface and the depth into the plane.
fn field(body: &HeatBody, modes: &[f64], place: impl Fn(f64, f64) -> [f64; 2]) -> TemperatureField {
    let HeatBody { streamline, modes: across, .. } = body;
    let (along, depths) = (streamline.len(), across.depths.len());
    let mut mesh = Mesh::default();
    let mut temperature = Vec::with_capacity(along * depths);
    for (&s, values) in streamline.nodes.iter().zip(modes.chunks_exact(across.len())) {
        for (i, &z) in across.depths.iter().enumerate() {
            mesh.nodes.push(place(s, z));
            // A fixed last node has no row.
            let free = i < across.shapes.nrows();
            let shape: Vec<f64> = if free { across.shapes.row(i).iter().copied().collect() } else { Vec::new() };
            temperature.push(dot(values, &shape));
        }
    }
    for element in 0..streamline.lengths.len() {
        let (from, to) = (element * depths, streamline.after(element) * depths);
        // Counter-clockwise: below the contact point depth points down in the rail, up in the wheel.
        let wheel = streamline.closed > 0.0;
        let cell = |(upper, lower): (usize, usize)| [from + lower, to + lower, to + upper, from + upper];
        mesh.cells.extend((1..depths).map(|i| cell(if wheel { (i, i - 1) } else { (i - 1, i) })));
    }
    TemperatureField { mesh, temperature }
}

/// Nodes of the element at a distance along the surface, and the place within it from 0 to 1; outside an open
/// streamline that of its end.
fn element(body: &HeatBody, s: f64) -> ([usize; 2], f64) {
    let streamline = &body.streamline;
    let mut s = s;
    if streamline.closed > 0.0 {
        s = streamline.nodes[0] + (s - streamline.nodes[0]).rem_euclid(streamline.closed);
    }
    let element = streamline.nodes.partition_point(|&x| x <= s).saturating_sub(1).min(streamline.lengths.len() - 1);
    let xi = ((s - streamline.nodes[element]) / streamline.lengths[element]).clamp(0.0, 1.0);
    ([element, streamline.after(element)], xi)
}
