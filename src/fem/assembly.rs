//! From element matrices to sparse ones; fixed degrees of freedom are left out.

use super::element::{self, EdgePoint, Point};
use super::{FemError, Mesh};
use crate::linalg::CsrMatrix;
use nalgebra::DVector;

/// Element matrix of the displacement: row and column `2·corner + component`.
pub type ElementMatrix = [[f64; 8]; 8];

/// Numbers the free displacement components of a mesh.
#[derive(Clone, Debug)]
pub struct DofMap {
    /// Unknown of `2·node + component`.
    unknown: Vec<Option<usize>>,
    len: usize,
}

impl DofMap {
    /// All components are free except those of the mesh's fixed nodes.
    pub fn new(mesh: &Mesh) -> Self {
        let mut fixed = vec![false; mesh.nodes.len()];
        for &node in &mesh.fixed {
            fixed[node] = true;
        }
        let mut len = 0;
        let unknown = (0..2 * mesh.nodes.len())
            .map(|k| {
                (!fixed[k / 2]).then(|| {
                    len += 1;
                    len - 1
                })
            })
            .collect();
        Self { unknown, len }
    }

    /// Number of unknowns.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether every component is fixed.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Unknown of one displacement component (0: x, 1: y), `None` if fixed.
    pub fn unknown(&self, node: usize, component: usize) -> Option<usize> {
        self.unknown[2 * node + component]
    }

    fn cell(&self, nodes: [usize; 4]) -> [Option<usize>; 8] {
        std::array::from_fn(|k| self.unknown(nodes[k / 2], k % 2))
    }
}

/// The same scalar bilinear form for both displacement components.
pub fn both_components(scalar: &[[f64; 4]; 4]) -> ElementMatrix {
    std::array::from_fn(|i| std::array::from_fn(|j| if i % 2 == j % 2 { scalar[i / 2][j / 2] } else { 0.0 }))
}

fn scatter(dofs: &[Option<usize>; 8], matrix: &ElementMatrix, triplets: &mut Vec<(usize, usize, f64)>) {
    for (row, values) in dofs.iter().zip(matrix) {
        for (column, &value) in dofs.iter().zip(values) {
            if let (Some(i), Some(j)) = (row, column)
                && value != 0.0
            {
                triplets.push((*i, *j, value));
            }
        }
    }
}

/// Sums element matrices over all cells.
pub fn assemble(
    mesh: &Mesh,
    dofs: &DofMap,
    element: impl Fn(&[Point; 4]) -> ElementMatrix,
) -> Result<CsrMatrix, FemError> {
    let mut triplets = Vec::with_capacity(64 * mesh.cells.len());
    for (cell, nodes) in mesh.cells.iter().enumerate() {
        let points = element::points(&mesh.corners(cell))?;
        scatter(&dofs.cell(*nodes), &element(&points), &mut triplets);
    }
    Ok(CsrMatrix::from_triplets(dofs.len(), dofs.len(), &triplets)?)
}

/// Sums boundary matrices over the mesh's open ends.
pub fn assemble_faces(
    mesh: &Mesh,
    dofs: &DofMap,
    face: impl Fn(&[EdgePoint; 2]) -> ElementMatrix,
) -> Result<CsrMatrix, FemError> {
    let mut triplets = Vec::new();
    for end in &mesh.ends {
        let points = element::edge_points(&mesh.corners(end.cell), end.edge)?;
        scatter(&dofs.cell(mesh.cells[end.cell]), &face(&points), &mut triplets);
    }
    Ok(CsrMatrix::from_triplets(dofs.len(), dofs.len(), &triplets)?)
}

/// Sums element matrices times a nodal field (fixed nodes included) into a vector of the unknowns.
pub fn assemble_vector(
    mesh: &Mesh,
    dofs: &DofMap,
    element: impl Fn(&[Point; 4]) -> ElementMatrix,
    field: impl Fn([f64; 2]) -> [f64; 2],
) -> Result<DVector<f64>, FemError> {
    let mut vector = DVector::zeros(dofs.len());
    for (cell, nodes) in mesh.cells.iter().enumerate() {
        let corners = mesh.corners(cell);
        let matrix = element(&element::points(&corners)?);
        let values = corners.map(&field);
        for (row, unknown) in dofs.cell(*nodes).iter().enumerate() {
            if let Some(i) = unknown {
                vector[*i] += (0..8).map(|j| matrix[row][j] * values[j / 2][j % 2]).sum::<f64>();
            }
        }
    }
    Ok(vector)
}
