//! From element matrices to sparse ones; fixed degrees of freedom are left out.

use super::element::{self, CellPoint, EdgePoint};
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

    /// True if every component is fixed.
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

/// Matrix of a scalar bilinear form that is equal for both displacement components and does not couple them.
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

/// Which unknowns share a cell: where the entries of element matrices go, the same for every matrix of a mesh.
pub struct AssemblyPattern {
    /// Points of integration of every cell.
    points: Vec<[CellPoint; 4]>,
    /// Rows of the matrix: place of the first entry of each, and of the end of the last.
    starts: Vec<usize>,
    /// Columns, ascending within a row; both components of every node that shares a cell.
    columns: Vec<usize>,
    /// Unknown of the first component of the corners of each cell, `None` if they are fixed.
    corners: Vec<[Option<usize>; 4]>,
}

impl AssemblyPattern {
    /// Nodes next to each other on a mesh, and where its cells are integrated.
    pub fn new(mesh: &Mesh, dofs: &DofMap) -> Result<Self, FemError> {
        let points =
            (0..mesh.cells.len()).map(|cell| element::points(&mesh.corners(cell))).collect::<Result<_, _>>()?;
        let corners: Vec<[Option<usize>; 4]> =
            mesh.cells.iter().map(|nodes| nodes.map(|node| dofs.unknown(node, 0))).collect();
        let mut neighbours: Vec<Vec<usize>> = vec![Vec::with_capacity(9); dofs.len() / 2];
        for cell in &corners {
            for row in cell.iter().flatten() {
                let known = &mut neighbours[row / 2];
                for column in cell.iter().flatten() {
                    if let Err(place) = known.binary_search(column) {
                        known.insert(place, *column);
                    }
                }
            }
        }
        let (mut starts, mut columns) = (vec![0], Vec::new());
        for neighbours in &neighbours {
            for _ in 0..2 {
                columns.extend(neighbours.iter().flat_map(|column| [*column, column + 1]));
                starts.push(columns.len());
            }
        }
        Ok(Self { points, starts, columns, corners })
    }

    /// Sums element matrices over all cells.
    pub fn assemble(&self, element: impl Fn(&[CellPoint; 4]) -> ElementMatrix) -> CsrMatrix {
        let mut values = vec![0.0; self.columns.len()];
        for (points, corners) in self.points.iter().zip(&self.corners) {
            let matrix = element(points);
            for (i, row) in corners.iter().enumerate() {
                let Some(row) = *row else { continue };
                let (start, width) = (self.starts[row], self.starts[row + 1] - self.starts[row]);
                let columns = &self.columns[start..start + width];
                for (j, column) in corners.iter().enumerate() {
                    let Some(place) = column.and_then(|column| columns.iter().position(|c| *c == column)) else {
                        continue;
                    };
                    for (a, line) in matrix[2 * i..2 * i + 2].iter().enumerate() {
                        let at = start + a * width + place;
                        values[at] += line[2 * j];
                        values[at + 1] += line[2 * j + 1];
                    }
                }
            }
        }
        let rows = self.starts.len() - 1;
        CsrMatrix::from_pattern(rows, &self.starts, &self.columns, &values)
    }
}

/// Sums element matrices over all cells.
pub fn assemble(
    mesh: &Mesh,
    dofs: &DofMap,
    element: impl Fn(&[CellPoint; 4]) -> ElementMatrix,
) -> Result<CsrMatrix, FemError> {
    Ok(AssemblyPattern::new(mesh, dofs)?.assemble(element))
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
    element: impl Fn(&[CellPoint; 4]) -> ElementMatrix,
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
