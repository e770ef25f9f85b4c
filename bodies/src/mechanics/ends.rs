//! Ends of the modelled rail, at which material streams in and out and waves are reflected or absorbed.
//!
//! The balance of [`BodySystem::assemble`] has no term of the ends, so it holds for ends that do not move. Free ends
//! get the in/outflow (Robin) term of Paper B, eq. 12. Non-reflecting ones get dashpots that absorb plane waves at
//! right angles (Lysmer & Kuhlemeyer, *J. Eng. Mech. Div. ASCE* 95 (1969) 859–877). Derivation:
//! `docs/theory/rail-ends.md`.

use super::ale::Stream;
use super::system::BodySystem;
use crate::fem::assembly::{ElementMatrix, both_components};
use crate::fem::element::EdgePoint;
use crate::fem::{DofMap, FemError, Mesh, assemble_faces};
use crate::linalg::CsrMatrix;
use crate::material::Isotropic;

impl BodySystem {
    /// This body with free ends through which the material streams in and out.
    pub fn with_free_ends(self, mesh: &Mesh, material: &Isotropic, stream: Stream) -> Result<Self, FemError> {
        let ends = assemble_faces(mesh, &DofMap::new(mesh), |p| stream.outflow(p, material.density))?;
        Ok(Self { ale_inertia: CsrMatrix::combination(1.0, &self.ale_inertia, -1.0, &ends)?, ..self })
    }

    /// This body with ends that absorb waves: dashpots of `ρ (c ± V)` times the velocity in the frame, where `c` is the
    /// speed of pressure waves along the end's normal and that of shear waves across it.
    ///
    /// The dashpots hold `ρ c`. The symmetric half of the gyroscopic matrix, which acts on the ends alone, would cancel
    /// the part `± ρ V`; it is left out there.
    pub fn with_quiet_ends(self, mesh: &Mesh, material: &Isotropic, stream: Stream) -> Result<Self, FemError> {
        let (density, dofs) = (material.density, DofMap::new(mesh));
        let impedance = [material.pressure_wave_speed(), material.shear_wave_speed()].map(|speed| density * speed);
        let damping = assemble_faces(mesh, &dofs, |p| dashpots(p, impedance))?;
        let carried = assemble_faces(mesh, &dofs, |p| through(p, stream, density))?;
        let gyroscopic = CsrMatrix::combination(1.0, &self.gyroscopic, -0.5, &carried)?;
        Ok(Self { gyroscopic, damping: Some(damping), ..self })
    }
}

/// `∮ (Z_n (w·n)(u·n) + Z_t (w·t)(u·t))` on one face, with the impedances `Z_n`, `Z_t` [N s/m³] along the normal and
/// across it.
fn dashpots(points: &[EdgePoint; 2], [along, across]: [f64; 2]) -> ElementMatrix {
    let mut matrix = [[0.0; 8]; 8];
    for p in points {
        let length = libm::hypot(p.normal[0], p.normal[1]);
        let n = p.normal.map(|component| component / length);
        for (row, line) in matrix.iter_mut().enumerate() {
            for (column, value) in line.iter_mut().enumerate() {
                let (i, a, j, b) = (row / 2, row % 2, column / 2, column % 2);
                let alike = if a == b { across } else { 0.0 };
                *value += p.shape[i] * p.shape[j] * (alike + (along - across) * n[a] * n[b]) * length;
            }
        }
    }
    matrix
}

/// `ρ ∮ (v̄·n) w·u` on one face, per unit speed: twice the symmetric part of the gyroscopic matrix.
fn through(points: &[EdgePoint; 2], stream: Stream, density: f64) -> ElementMatrix {
    let mut matrix = [[0.0; 4]; 4];
    for p in points {
        let v = stream.direction(p.position);
        let flux = density * (v[0] * p.normal[0] + v[1] * p.normal[1]);
        for (row, ni) in matrix.iter_mut().zip(p.shape) {
            for (value, nj) in row.iter_mut().zip(p.shape) {
                *value += flux * ni * nj;
            }
        }
    }
    both_components(&matrix)
}
