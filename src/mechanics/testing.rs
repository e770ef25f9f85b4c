//! Configurations and small meshes for the tests.

use crate::config::*;
use crate::fem::Mesh;
use std::f64::consts::PI;

/// The wheel and rail of Paper D with a choice of mesh.
pub fn paper_d(elements: usize) -> Config {
    Config {
        model: ModelParameters { contact_width: 1.0, nominal_load: 1e5 },
        wheel: Wheel { radius: 0.5, hub_radius: 0.05, hub_mass: 0.0, hub_inertia: 0.0 },
        vehicle: Vehicle { mass: 0.0 },
        rail: Rail { length: 1.0, height: 0.1 },
        material: Material { youngs_modulus: 2e11, poissons_ratio: 0.3, density: 8000.0 },
        friction: Friction { coefficient: 0.4 },
        physics: Physics { centrifugal: true },
        mesh: MeshParameters { elements_per_half_width: elements },
        solver: SolverParameters {
            response: Response::Reduced,
            modes_wheel: 80,
            modes_rail: 40,
            time_scheme: TimeScheme::Bdf2,
            theta: 1.0,
            max_step: 1e-3,
        },
        initial: Initial { velocity: 50.0 / 3.6, creepage: 0.0 },
    }
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
