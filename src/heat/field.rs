//! Temperature of whole bodies at the nodes of their meshes.

use super::modal::{Body, dot};
use super::{Heat, HeatError, HeatState};
use crate::fem::Mesh;

/// Temperature of one body.
#[derive(Clone, Debug)]
pub struct TemperatureField {
    /// The wheel about its centre, the rail with the contact point at the origin; cells between all nodes, those in the
    /// middle of the quadratic layers included.
    pub mesh: Mesh,
    /// At the nodes, over the reference [K].
    pub temperature: Vec<f64>,
}

impl Heat {
    /// Fields of wheel and rail.
    pub fn fields(&self, state: &HeatState) -> Result<[TemperatureField; 2], HeatError> {
        self.check_state(state)?;
        let radius = self.config.wheel_radius;
        let polar = |s: f64, z: f64| [(radius - z) * (s / radius).sin(), -(radius - z) * (s / radius).cos()];
        Ok([field(&self.wheel, &state.wheel, polar), field(&self.rail, &state.rail, |s, z| [s, -z])])
    }
}

/// Nodal temperatures, where `place` puts the distance along the surface and the depth into the plane.
fn field(body: &Body, modes: &[f64], place: impl Fn(f64, f64) -> [f64; 2]) -> TemperatureField {
    let Body { line, modes: across, .. } = body;
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
