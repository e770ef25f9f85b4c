//! Bodies and small meshes for the tests.

use crate::analytic::{self, Torsion};
use crate::axes::PerAxis;
use crate::fem::Mesh;
use crate::material::Isotropic;
use crate::mechanics::{
    BodyDamping, BodyParameters, BodyResponse, BodyState, Convection, Ends, FreeResponse, StepOperator,
};
use crate::multistep::TimeDerivative;
use nalgebra::DVector;
use std::f64::consts::PI;

/// The wheel and rail of Paper D with a choice of mesh.
pub fn paper_d(elements: usize) -> BodyParameters {
    let material = Isotropic {
        youngs_modulus: 200e9,
        poissons_ratio: 0.3,
        density: 8000.0,
        expansion: 4.8e-6,
        conductivity: 45.0,
        specific_heat: 460.0,
    };
    let mut bodies = BodyParameters {
        radius: 0.5,
        hub_radius: 0.05,
        rail_length: 1.0,
        rail_height: 0.1,
        rail_ends: Ends::Free,
        material,
        half_width: 0.0,
        reach: 0.0,
        elements,
        grid_elements: 10,
        reduced: true,
        modes: [80, 40],
        damping: [BodyDamping::NONE; 2],
        centrifugal: true,
    };
    bodies.half_width = half_width(&bodies, 1e5);
    bodies
}

/// Half-width of the contact under a load [N/m] \[m].
pub fn half_width(c: &BodyParameters, load: f64) -> f64 {
    analytic::hertz_half_width(load, c.radius, c.material.contact_modulus())
}

/// Torsion of the wheel on its hub, of the circle and in the continuum.
pub fn exact_torsion(c: &BodyParameters) -> Torsion {
    analytic::hub_torsion(c.radius, c.hub_radius, c.material.shear_wave_speed())
}

/// Unit square of `n × n` cells, inner nodes displaced by up to `distortion` cells, nothing fixed.
pub fn square(n: usize, distortion: f64) -> Mesh {
    let mut mesh = Mesh::default();
    let h = 1.0 / n as f64;
    for i in 0..=n {
        for j in 0..=n {
            let (x, y) = (j as f64 * h, i as f64 * h);
            let shift = distortion * h * (2.0 * PI * x).sin() * (2.0 * PI * y).sin();
            let alternate = if (i * 7 + j * 3) % 5 < 2 { 1.0 } else { -0.7 };
            let inner = i > 0 && j > 0 && i < n && j < n;
            let wobble = if inner { alternate * distortion * h * 0.5 } else { 0.0 };
            mesh.nodes.push([x + shift + wobble, y - shift + 0.6 * wobble]);
        }
    }
    for i in 0..n {
        for j in 0..n {
            let k = i * (n + 1) + j;
            mesh.cells.push([k, k + 1, k + n + 2, k + n + 1]);
        }
    }
    mesh
}

/// Nodes on the boundary of the unit square.
pub fn square_boundary(mesh: &Mesh) -> Vec<usize> {
    let edge = |v: f64| v.abs() < 1e-12 || (v - 1.0).abs() < 1e-12;
    (0..mesh.nodes.len()).filter(|&k| mesh.nodes[k].iter().any(|&v| edge(v))).collect()
}

/// Annulus with uniform cells, nothing fixed.
pub fn annulus(outer: f64, inner: f64, around: usize, across: usize) -> Mesh {
    let mut mesh = Mesh::default();
    for i in 0..=across {
        let r = outer + (inner - outer) * i as f64 / across as f64;
        for j in 0..around {
            let angle = 2.0 * PI * j as f64 / around as f64;
            mesh.nodes.push([r * angle.sin(), -r * angle.cos()]);
        }
    }
    for i in 0..across {
        for j in 0..around {
            let (next, row, below) = ((j + 1) % around, i * around, (i + 1) * around);
            mesh.cells.push([row + j, row + next, below + next, below + j]);
        }
    }
    mesh
}

/// [`BodyResponse::free_response`] in a new buffer.
pub fn free(
    body: &dyn BodyResponse,
    op: &StepOperator,
    state: &BodyState,
    td: &TimeDerivative,
    stream: Convection,
) -> FreeResponse {
    let mut response = FreeResponse::default();
    body.free_response(op, state, td, stream, &mut response);
    response
}

/// [`BodyResponse::commit`] into a new state.
pub fn committed(
    body: &dyn BodyResponse,
    op: &StepOperator,
    free: &FreeResponse,
    forces: &DVector<f64>,
    rigid: PerAxis<f64>,
    td: &TimeDerivative,
    state: &BodyState,
) -> BodyState {
    let mut next = BodyState::zeros(0);
    body.commit(op, free, forces, rigid, td, state, &mut next);
    next
}
