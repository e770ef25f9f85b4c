//! The finite-element equations of one body before any reduction.

use super::ale::Stream;
use super::elasticity::{self, Lame};
use crate::config::Material;
use crate::fem::{DofMap, FemError, Mesh, assemble, assemble_faces, assemble_vector};
use crate::linalg::CsrMatrix;
use nalgebra::{DMatrix, DVector};

/// Matrices of one body on its free degrees of freedom, per metre of width.
#[derive(Clone, Debug)]
pub struct BodySystem {
    /// `K` [N/m per m].
    pub stiffness: CsrMatrix,
    /// Consistent mass `M` [kg/m].
    pub mass: CsrMatrix,
    /// `C = ρ ∫ w·∂u` (per unit stream speed).
    pub convection: CsrMatrix,
    /// `S − B`: minus the weak form of `ρ ∂∂u` (per unit stream speed squared); `B` is the Robin term of open ends.
    pub curvature: CsrMatrix,
    /// `M r_k` for unit rigid accelerations in x, y and Ω (`r_Ω = (y, −x)`), hub nodes included; zero for the rail.
    pub rigid: DMatrix<f64>,
    /// Centrifugal load `M X` per `Ω²`; zero for the rail.
    pub centrifugal: DVector<f64>,
    /// Unknown of each surface component, `2·node + component`.
    pub surface: Vec<usize>,
}

impl BodySystem {
    /// Integrates all matrices of a body whose material streams as `stream`.
    pub fn assemble(mesh: &Mesh, material: &Material, stream: Stream) -> Result<Self, FemError> {
        let dofs = DofMap::new(mesh);
        let (lame, density) = (Lame::from(material), material.density);
        let mass = |p: &_| elasticity::mass(p, density);
        let load = |field: fn([f64; 2]) -> [f64; 2]| match stream {
            Stream::Rotation => assemble_vector(mesh, &dofs, mass, field),
            Stream::Translation => Ok(DVector::zeros(dofs.len())),
        };
        let rigid = [load(|_| [1.0, 0.0])?, load(|_| [0.0, 1.0])?, load(|[x, y]| [y, -x])?];
        let inner = assemble(mesh, &dofs, |p| stream.curvature(p, density))?;
        let ends = assemble_faces(mesh, &dofs, |p| stream.outflow(p, density))?;
        let unknowns = |&node: &usize| [dofs.unknown(node, 0), dofs.unknown(node, 1)];
        Ok(Self {
            stiffness: assemble(mesh, &dofs, |p| elasticity::stiffness(p, lame))?,
            mass: assemble(mesh, &dofs, mass)?,
            convection: assemble(mesh, &dofs, |p| stream.convection(p, density))?,
            curvature: CsrMatrix::combination(1.0, &inner, -1.0, &ends)?,
            rigid: DMatrix::from_columns(&rigid),
            centrifugal: load(|x| x)?,
            surface: mesh.surface.iter().flat_map(unknowns).flatten().collect(),
        })
    }

    /// Number of unknowns.
    pub fn unknowns(&self) -> usize {
        self.mass.rows()
    }

    /// Picks the surface components of a field.
    pub fn on_surface(&self, field: &DVector<f64>) -> DVector<f64> {
        DVector::from_iterator(self.surface.len(), self.surface.iter().map(|&i| field[i]))
    }

    /// Picks the surface components of several fields.
    pub fn rows_on_surface(&self, fields: &DMatrix<f64>) -> DMatrix<f64> {
        fields.select_rows(self.surface.iter())
    }

    /// `A⁻¹ Sᵀ`: answer of the whole body to unit nodal forces on the surface, reduced to the surface.
    pub fn surface_compliance(&self, factor: &crate::linalg::Cholesky) -> DMatrix<f64> {
        /// Right-hand sides solved together.
        const BATCH: usize = 16;
        let (n, ports) = (self.unknowns(), self.surface.len());
        let mut compliance = DMatrix::zeros(ports, ports);
        for first in (0..ports).step_by(BATCH) {
            let width = BATCH.min(ports - first);
            let mut columns = DMatrix::zeros(n, width);
            for j in 0..width {
                columns[(self.surface[first + j], j)] = 1.0;
            }
            factor.solve_columns(&mut columns);
            compliance.columns_mut(first, width).copy_from(&self.rows_on_surface(&columns));
        }
        symmetrise(&mut compliance);
        compliance
    }
}

/// Removes the round-off between `a_ij` and `a_ji`.
pub fn symmetrise(a: &mut DMatrix<f64>) {
    for i in 0..a.nrows() {
        for j in 0..i {
            let mean = 0.5 * (a[(i, j)] + a[(j, i)]);
            a[(i, j)] = mean;
            a[(j, i)] = mean;
        }
    }
}
