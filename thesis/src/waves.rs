//! Waves in a plate that is held at its base, after a push on its top: Paper A, section 2.5 and figures 5 and 6.
//!
//! The bodies are the product's; `tests/wheel/rail_ends.rs` of the product uses this file, too.

use nalgebra::DVector;
use std::error::Error;
use std::f64::consts::FRAC_PI_2;
use wheelrail::axes::PerAxis;
use wheelrail::config::{Config, RailEnds};
use wheelrail::fem::{DofMap, Face, FemError, Mesh, assemble};
use wheelrail::linalg::CsrMatrix;
use wheelrail::material::Isotropic;
use wheelrail::mechanics::ale::Stream;
use wheelrail::mechanics::elasticity::{self, Lame};
use wheelrail::mechanics::{BodyResponse, BodyState, BodySystem, Convection, FreeResponse, FullBody};
use wheelrail::multistep::TimeDerivative;

/// Angular frequency of the push \[rad/s].
const FREQUENCY: f64 = 5e4;

/// The steel of Paper A.
pub fn steel() -> Isotropic {
    Isotropic { youngs_modulus: 200e9, density: 8000.0, ..Isotropic::from(&Config::default().material) }
}

/// Plate `|x| ≤ length/2`, `−height ≤ y ≤ 0` of square cells of the size `h` \[m] on a fixed base; all of its top are
/// ports.
pub fn plate(length: f64, height: f64, h: f64) -> Mesh {
    let [along, up] = [length, height].map(|size| (size / h).round() as usize);
    let mut mesh = Mesh::default();
    for i in 0..=up {
        let y = -height * (1.0 - i as f64 / up as f64);
        mesh.nodes.extend((0..=along).map(|j| [length * (j as f64 / along as f64 - 0.5), y]));
    }
    for i in 0..up {
        for j in 0..along {
            let (cell, below) = (mesh.cells.len(), i * (along + 1) + j);
            mesh.cells.push([below, below + 1, below + along + 2, below + along + 1]);
            if j == 0 {
                mesh.ends.push(Face { cell, edge: 3 });
            }
            if j == along - 1 {
                mesh.ends.push(Face { cell, edge: 1 });
            }
        }
    }
    mesh.fixed = (0..=along).collect();
    mesh.surface = (up * (along + 1)..(up + 1) * (along + 1)).collect();
    mesh
}

/// Matrices of the plate with its ends. Fixed ends have to be those of the mesh.
pub fn system(mesh: &Mesh, ends: RailEnds) -> Result<BodySystem, FemError> {
    let (material, stream) = (steel(), Stream::Translation);
    let system = BodySystem::assemble(mesh, &material, stream)?;
    match ends {
        RailEnds::Fixed => Ok(system),
        RailEnds::Free => system.with_free_ends(mesh, &material, stream),
        RailEnds::Nonreflecting => system.with_quiet_ends(mesh, &material, stream),
    }
}

/// Mass and stiffness of the cells within half a metre of the middle.
fn central(mesh: &Mesh) -> Result<[CsrMatrix; 2], FemError> {
    let (material, dofs) = (steel(), DofMap::new(mesh));
    let within = |cell: &[usize; 4]| cell.iter().all(|&node| mesh.nodes[node][0].abs() < 0.5 + 1e-9);
    let part = Mesh { cells: mesh.cells.iter().copied().filter(within).collect(), ..mesh.clone() };
    Ok([
        assemble(&part, &dofs, |p| elasticity::mass(p, material.density))?,
        assemble(&part, &dofs, |p| elasticity::stiffness(p, Lame::from(&material)))?,
    ])
}

/// A run: length of the plate \[m], its ends, speed of the stream [m/s], size of its cells \[m], steps of the push.
#[derive(Clone, Copy, Debug)]
pub struct Push {
    /// Length of the plate \[m].
    pub length: f64,
    /// Its ends.
    pub ends: RailEnds,
    /// Speed of the stream [m/s].
    pub speed: f64,
    /// Size of the square cells \[m].
    pub size: f64,
    /// Time steps of the quarter period that the push lasts.
    pub quarter: i32,
}

impl Push {
    /// Time step \[s].
    pub fn step(&self) -> f64 {
        FRAC_PI_2 / FREQUENCY / f64::from(self.quarter)
    }

    /// Energy in the central metre [J/m] over time by the trapezoidal rule, from the end of the push, a quarter period
    /// of a point load of 5·10⁴ rad/s on the middle of the top, to eleven times that.
    pub fn energies(&self) -> Result<Vec<f64>, Box<dyn Error>> {
        let mesh = plate(self.length, 0.1, self.size);
        let [mass, stiffness] = central(&mesh)?;
        let body = FullBody::new(system(&mesh, self.ends)?, false)?;
        let dt = self.step();
        let td = TimeDerivative { a0: 2.0 / dt, a1: -2.0 / dt, a2: 0.0, b1: -1.0 };
        let op = body.operator(td.a0)?;
        let middle = 2 * (mesh.surface.len() / 2) + 1;
        let (mut state, mut next) = (BodyState::zeros(body.state_len()), BodyState::zeros(0));
        let mut known = FreeResponse::default();
        let mut history = Vec::new();
        for k in 1..=11 * self.quarter {
            let mut forces = DVector::zeros(op.surface.nrows());
            if k < self.quarter {
                forces[middle] = -1e5 * (FREQUENCY * f64::from(k) * dt).sin();
            }
            let convection = Convection { speed: self.speed, acceleration: 0.0 };
            body.free_response(&op, &state, &td, convection, &mut known);
            body.commit(&op, &known, &forces, PerAxis::default(), &td, &state, &mut next);
            std::mem::swap(&mut state, &mut next);
            let (y, v) = (state.displacement.as_slice(), state.velocity.as_slice());
            if k >= self.quarter {
                history.push(0.5 * (stiffness.bilinear(y, y) + mass.bilinear(v, v)));
            }
        }
        Ok(history)
    }
}

/// Largest difference of two histories over the first value of the second.
pub fn deviation(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / b[0]
}
