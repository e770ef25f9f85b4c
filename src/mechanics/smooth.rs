//! Bodies less the half-plane: what is left of their surface compliance is smooth.
//!
//! Close to a load every body answers like a half-plane. A contact solver that knows the half-plane in closed form
//! needs of the body only the difference, which varies over the size of the body, and therefore only a polynomial of
//! it: its ports are the displacements at a few points of the contact zone. The modes are those of the body with all
//! its surface nodes. Derivation: `docs/theory/patch-contact.md`.

use super::reduction::{ReducedBasis, scale_columns};
use super::remainder::remainder;
use crate::analytic::HalfPlane;
use crate::linalg::Lagrange;
pub use crate::linalg::POINTS;
use crate::linalg::dense::symmetrise;
use nalgebra::DMatrix;

impl ReducedBasis {
    /// The body less a half-plane, on the points of `basis`; `x` are its surface nodes \[m]. `None` where there are too
    /// few.
    pub(super) fn smooth(&self, x: &[f64], basis: &Lagrange, half_plane: HalfPlane, side: f64) -> Option<Self> {
        let compliance = self.compliance();
        let projection = Projection::new(x, basis)?;
        let shapes = projection.of(&self.shapes);
        let mut residual = projection.fit(|c, d| remainder(&compliance, (c, d), x, half_plane, side));
        let weighted = scale_columns(&shapes, &self.squared_frequencies.map(f64::recip));
        residual.gemm(-1.0, &weighted, &shapes.transpose(), 1.0);
        symmetrise(&mut residual);
        let centrifugal = DMatrix::from_column_slice(2 * x.len(), 1, self.centrifugal_residual.as_slice());
        Some(Self {
            shapes,
            residual,
            rigid_residual: projection.of(&self.rigid_residual),
            centrifugal_residual: projection.of(&centrifugal).column(0).into_owned(),
            ..self.clone()
        })
    }
}

/// From surface nodes to the points of a polynomial.
struct Projection {
    matrix: DMatrix<f64>,
}

impl Projection {
    fn new(x: &[f64], basis: &Lagrange) -> Option<Self> {
        Some(Self { matrix: basis.projection(x)? })
    }

    /// Rows of surface components at the nodes as rows at the points.
    fn of(&self, rows: &DMatrix<f64>) -> DMatrix<f64> {
        let mut projected = DMatrix::zeros(2 * POINTS, rows.ncols());
        for component in 0..2 {
            let own = DMatrix::from_fn(rows.nrows() / 2, rows.ncols(), |i, j| rows[(2 * i + component, j)]);
            let own = &self.matrix * own;
            for k in 0..POINTS {
                projected.row_mut(2 * k + component).copy_from(&own.row(k));
            }
        }
        projected
    }

    /// The polynomial of two places, by components `c` and `d`, next to the values `rest` at all pairs of nodes.
    fn fit(&self, rest: impl Fn(usize, usize) -> DMatrix<f64>) -> DMatrix<f64> {
        let mut fitted = DMatrix::zeros(2 * POINTS, 2 * POINTS);
        for (c, d) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            let values = &self.matrix * rest(c, d) * self.matrix.transpose();
            for (k, l) in (0..POINTS).flat_map(|k| (0..POINTS).map(move |l| (k, l))) {
                fitted[(2 * k + c, 2 * l + d)] = values[(k, l)];
            }
        }
        fitted
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::Isotropic;
    use crate::mechanics::testing::paper_d;
    use crate::mechanics::{nominal_half_width, rail_system, wheel_system};

    /// The compliance of the mesh between nodes far apart is that of the half-plane and the polynomial together.
    #[test]
    fn half_plane_and_polynomial_are_the_body() {
        let config = paper_d(10);
        let steel = Isotropic::from(&config.material);
        let half_plane = steel.half_plane();
        assert!((half_plane.kernel * std::f64::consts::PI * steel.contact_modulus() - 1.0).abs() < 1e-14);
        for (system, side) in [(wheel_system(&config).unwrap(), 1.0), (rail_system(&config).unwrap(), -1.0)] {
            let body = ReducedBasis::compute(&system, 6, &mut |_| {}).unwrap();
            let n = body.residual.nrows() / 2;
            let (h, half) = (nominal_half_width(&config) / 10.0, 16);
            let body = body.cut(2 * (n / 2 - half)..2 * (n / 2 + half + 1));
            let x: Vec<f64> = (0..=2 * half).map(|i| h * (i as f64 - half as f64)).collect();
            let basis = Lagrange::new(h * half as f64);
            let smooth = body.smooth(&x, &basis, half_plane, side).unwrap();
            let statics = |body: &ReducedBasis| {
                let weighted = scale_columns(&body.shapes, &body.squared_frequencies.map(f64::recip));
                &body.residual + weighted * body.shapes.transpose()
            };
            let (exact, rest) = (statics(&body), statics(&smooth));
            let mut worst = 0.0_f64;
            for (i, j) in [(0, 30), (3, 20), (10, 22), (31, 12), (16, 32)] {
                let (at, from) = (basis.values(x[i]), basis.values(x[j]));
                for (c, d) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                    let mut sum = half_plane.displacement(c, d, x[i] - x[j], side);
                    for (k, l) in (0..POINTS).flat_map(|k| (0..POINTS).map(move |l| (k, l))) {
                        sum += at[k] * from[l] * rest[(2 * k + c, 2 * l + d)];
                    }
                    worst = worst.max((sum - exact[(2 * i + c, 2 * j + d)]).abs());
                }
            }
            println!("side {side}: {:.2e} of the kernel", worst / half_plane.kernel);
            assert!(worst < 2e-3 * half_plane.kernel);
        }
    }
}
