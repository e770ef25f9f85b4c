//! Bodies less the half-plane: what is left of their surface compliance is smooth.
//!
//! Close to a load every body answers like a half-plane. A contact solver that knows the half-plane in closed form
//! needs of the body only the difference, which varies over the size of the body, and therefore only a polynomial of
//! it: its ports are the displacements at a few points of the contact zone. The modes are those of the body with all
//! its surface nodes. Derivation: `docs/theory/patch-contact.md`.

use super::reduction::ReducedBasis;
use super::remainder::{from_components, remainder};
use crate::analytic::HalfPlane;
use crate::linalg::Lagrange;
pub use crate::linalg::POINTS;

impl ReducedBasis {
    /// The body less a half-plane, on the points of `basis`; `x` are its surface nodes \[m]. `None` where there are too
    /// few.
    pub(super) fn smooth(&self, x: &[f64], basis: &Lagrange, half_plane: HalfPlane, side: f64) -> Option<Self> {
        let (compliance, matrix) = (self.compliance(), basis.projection(x)?);
        let fitted = from_components(POINTS, |component| {
            &matrix * remainder(&compliance, component, x, half_plane, side) * matrix.transpose()
        });
        Some(self.on_surface(&matrix, fitted))
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
            let (exact, rest) = (body.compliance(), smooth.compliance());
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
