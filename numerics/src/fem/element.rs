//! Four-node isoparametric quadrilateral with 2 × 2 Gauss points.

use super::FemError;

/// Reference corners, counter-clockwise.
const CORNERS: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
/// Gauss abscissa `1/√3`, weight 1.
const GAUSS: f64 = 0.577_350_269_189_625_8;

/// Shape functions and their gradients at one quadrature point.
#[derive(Clone, Copy, Debug)]
pub struct CellPoint {
    /// Position \[m].
    pub position: [f64; 2],
    /// `N_i` \[1].
    pub shape: [f64; 4],
    /// `∇N_i` [1/m].
    pub gradient: [[f64; 2]; 4],
    /// `|J| w` \[m²].
    pub dv: f64,
}

/// Shape functions and gradients at one quadrature point of an edge.
#[derive(Clone, Copy, Debug)]
pub struct EdgePoint {
    /// Position \[m].
    pub position: [f64; 2],
    /// `N_i` \[1].
    pub shape: [f64; 4],
    /// `∇N_i` [1/m].
    pub gradient: [[f64; 2]; 4],
    /// Outward normal times `ds` \[m].
    pub normal: [f64; 2],
}

/// `N_i(ξ, η)`.
pub fn shape(xi: f64, eta: f64) -> [f64; 4] {
    CORNERS.map(|c| 0.25 * (1.0 + c[0] * xi) * (1.0 + c[1] * eta))
}

/// Position, shape functions, gradients and `|J|` (as `dv`) at `(ξ, η)`.
pub fn point_at(corners: &[[f64; 2]; 4], xi: f64, eta: f64) -> Result<CellPoint, FemError> {
    let shape = shape(xi, eta);
    let reference = CORNERS.map(|c| [0.25 * c[0] * (1.0 + c[1] * eta), 0.25 * c[1] * (1.0 + c[0] * xi)]);
    let mut position = [0.0; 2];
    // jacobian[a][b] = ∂x_a/∂ξ_b
    let mut jacobian = [[0.0; 2]; 2];
    for (i, corner) in corners.iter().enumerate() {
        for a in 0..2 {
            position[a] += shape[i] * corner[a];
            for b in 0..2 {
                jacobian[a][b] += corner[a] * reference[i][b];
            }
        }
    }
    let [[a, b], [c, d]] = jacobian;
    let determinant = a * d - b * c;
    if determinant <= 0.0 || determinant.is_nan() {
        let [x, y] = position;
        return Err(FemError::InvertedCell { x, y, determinant });
    }
    let gradient = reference.map(|[gx, gy]| [(d * gx - c * gy) / determinant, (a * gy - b * gx) / determinant]);
    Ok(CellPoint { position, shape, gradient, dv: determinant })
}

/// The four Gauss points of a cell.
pub fn points(corners: &[[f64; 2]; 4]) -> Result<[CellPoint; 4], FemError> {
    let [a, b, c, d] = CORNERS.map(|c| point_at(corners, GAUSS * c[0], GAUSS * c[1]));
    Ok([a?, b?, c?, d?])
}

/// Two Gauss points of the edge from corner `edge` to the next.
pub fn edge_points(corners: &[[f64; 2]; 4], edge: usize) -> Result<[EdgePoint; 2], FemError> {
    let (from, to) = (edge % 4, (edge + 1) % 4);
    // Outward normal of a counter-clockwise boundary: tangent turned to the right; half of it per Gauss point.
    let tangent = [corners[to][0] - corners[from][0], corners[to][1] - corners[from][1]];
    let normal = [0.5 * tangent[1], -0.5 * tangent[0]];
    let at = |s: f64| -> Result<EdgePoint, FemError> {
        let along = |c: usize| 0.5 * ((1.0 - s) * CORNERS[from][c] + (1.0 + s) * CORNERS[to][c]);
        let p = point_at(corners, along(0), along(1))?;
        Ok(EdgePoint { position: p.position, shape: p.shape, gradient: p.gradient, normal })
    };
    Ok([at(-GAUSS)?, at(GAUSS)?])
}

#[cfg(test)]
mod tests {
    use super::*;

    const CELL: [[f64; 2]; 4] = [[0.1, -0.2], [1.3, 0.1], [1.1, 0.9], [-0.2, 1.2]];

    #[test]
    fn linear_fields_have_exact_gradients_on_a_distorted_cell() {
        let field = CELL.map(|[x, y]| 2.0 + 3.0 * x - 5.0 * y);
        for p in points(&CELL).unwrap() {
            let gradient = [0, 1].map(|c| (0..4).map(|i| field[i] * p.gradient[i][c]).sum::<f64>());
            assert!((gradient[0] - 3.0).abs() < 1e-13 && (gradient[1] + 5.0).abs() < 1e-13);
            let value: f64 = (0..4).map(|i| field[i] * p.shape[i]).sum();
            assert!((value - (2.0 + 3.0 * p.position[0] - 5.0 * p.position[1])).abs() < 1e-13);
        }
    }

    #[test]
    fn divergence_theorem_holds_on_a_distorted_cell() {
        let inside: f64 = points(&CELL).unwrap().iter().map(|p| 2.0 * p.dv).sum();
        let through: f64 = (0..4)
            .flat_map(|e| edge_points(&CELL, e).unwrap())
            .map(|p| p.position[0] * p.normal[0] + p.position[1] * p.normal[1])
            .sum();
        assert!((inside - through).abs() < 1e-13, "{inside} against {through}");
    }

    #[test]
    fn inverted_cells_are_refused() {
        let mut cell = CELL;
        cell.swap(1, 3);
        assert!(matches!(points(&cell), Err(FemError::InvertedCell { .. })));
    }
}
