//! Configurations and small meshes for the tests.

use crate::analytic::{self, Torsion};
use crate::axes::PerAxis;
use crate::config::{Config, presets};
use crate::fem::Mesh;
use crate::material::Isotropic;
use crate::mechanics::{BodyResponse, BodyState, Convection, FreeResponse, StepOperator};
use crate::multistep::TimeDerivative;
use nalgebra::DVector;
use std::f64::consts::PI;

/// The wheel and rail of Paper D with a choice of mesh.
pub fn paper_d(elements: usize) -> Config {
    let mut config = presets::parse(include_str!("../../resources/paper_d.json")).unwrap();
    config.mesh.elements_per_half_width = elements;
    config
}

/// Torsion of the wheel on its hub, of the circle and in the continuum.
pub fn exact_torsion(config: &Config) -> Torsion {
    let speed = Isotropic::from(&config.material).shear_wave_speed();
    analytic::hub_torsion(config.wheel.radius, config.wheel.hub_radius, speed)
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
