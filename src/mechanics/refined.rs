//! Reduced bodies with more surface nodes than their finite elements have: the contact on a grid needs them closer than
//! the bodies do.
//!
//! Close to a load every body answers like a half-plane, whose answer at the nodes of any grid is known in closed form
//! ([`nodal`]). What [remains](super::remainder) of the compliance varies over the size of the bodies, as do the vibration
//! modes, so that it is interpolated between the nodes of the finite elements by cubic polynomials. Theory:
//! `docs/theory/kernel-correction.md`.

use super::reduction::{ReducedBasis, scale_columns};
use super::remainder::{from_components, nodal, remainder};
use crate::analytic::HalfPlane;
use crate::linalg::dense::symmetrise;
use nalgebra::DMatrix;

/// Nodes of a cubic polynomial.
const STENCIL: usize = 4;

/// The nodes `x` \[m], ascending, and those that divide every cell between them into `parts` equal ones.
pub(super) fn divided(x: &[f64], parts: usize) -> Vec<f64> {
    let between = |pair: &[f64]| -> Vec<f64> {
        (0..parts).map(|k| pair[0] + (pair[1] - pair[0]) * k as f64 / parts as f64).collect()
    };
    x.windows(2).flat_map(between).chain(x.last().copied()).collect()
}

impl ReducedBasis {
    /// This body, whose surface nodes are `x` \[m], with the surface nodes `finer` \[m]; `half_plane` has the elasticity
    /// of the body, which lies above its surface (`side` 1) or below it (−1).
    pub(super) fn refined(&self, x: &[f64], finer: &[f64], half_plane: HalfPlane, side: f64) -> Self {
        let between = interpolation(x, finer);
        let compliance = self.compliance();
        let finer_compliance = from_components(finer.len(), |(c, d)| {
            let mut fine = &between * remainder(&compliance, (c, d), x, half_plane, side) * between.transpose();
            for (i, j) in (0..finer.len()).flat_map(|i| (0..finer.len()).map(move |j| (i, j))) {
                fine[(i, j)] += nodal(half_plane, (c, d), finer, (i, j), side);
            }
            fine
        });
        self.on_surface(&between, finer_compliance)
    }

    /// This body with a surface whose values follow from those of its own by the matrix `between` and whose `compliance` is
    /// given [m/(N/m)].
    pub(super) fn on_surface(&self, between: &DMatrix<f64>, compliance: DMatrix<f64>) -> Self {
        let (shapes, mut residual) = (rows_between(between, &self.shapes), compliance);
        let weighted = scale_columns(&shapes, &self.squared_frequencies.map(f64::recip));
        residual.gemm(-1.0, &weighted, &shapes.transpose(), 1.0);
        symmetrise(&mut residual);
        let centrifugal = self.centrifugal_residual.as_slice();
        let centrifugal = DMatrix::from_column_slice(centrifugal.len(), 1, centrifugal);
        Self {
            residual,
            rigid_residual: rows_between(between, &self.rigid_residual),
            centrifugal_residual: rows_between(between, &centrifugal).column(0).into_owned(),
            carried: self.carried.as_ref().map(|carried| rows_between(between, carried)),
            shapes,
            ..self.clone()
        }
    }
}

/// Matrix that takes values at the nodes `x` to places `to` between them, by cubic polynomials.
fn interpolation(x: &[f64], to: &[f64]) -> DMatrix<f64> {
    let mut matrix = DMatrix::zeros(to.len(), x.len());
    let count = STENCIL.min(x.len());
    for (row, &place) in to.iter().enumerate() {
        let cell = x.partition_point(|node| *node <= place).saturating_sub(1);
        let first = (cell + 1).saturating_sub(count / 2).min(x.len() - count);
        for k in first..first + count {
            let others = (first..first + count).filter(|l| *l != k);
            matrix[(row, k)] = others.map(|l| (place - x[l]) / (x[k] - x[l])).product();
        }
    }
    matrix
}

/// Rows of surface components, x and y of every node, at other nodes.
fn rows_between(between: &DMatrix<f64>, rows: &DMatrix<f64>) -> DMatrix<f64> {
    let mut out = DMatrix::zeros(2 * between.nrows(), rows.ncols());
    for component in 0..2 {
        let own = DMatrix::from_fn(rows.nrows() / 2, rows.ncols(), |i, j| rows[(2 * i + component, j)]);
        let values = between * own;
        for i in 0..values.nrows() {
            out.row_mut(2 * i + component).copy_from(&values.row(i));
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::axes::PerAxis;
    use crate::material::Isotropic;
    use crate::mechanics::motion::Equations;
    use crate::mechanics::testing::paper_d;
    use crate::mechanics::{BodyDamping, BodyState, FullBody, ReducedBody};
    use crate::mechanics::{BodyResponse, BodySystem, contact_zone, rail_system, wheel_system};
    use nalgebra::DVector;

    /// Surface nodes of the uniform zone with `elements` per half-width, and the body of a system on them.
    fn body(elements: usize, system: &BodySystem) -> (Vec<f64>, ReducedBasis) {
        let zone = contact_zone(&paper_d(elements));
        let (x, wing) = (zone.surface_x(), zone.wing_nodes());
        let basis = ReducedBasis::compute(system, 12, &mut |_| {}).unwrap();
        (x[wing..x.len() - wing].to_vec(), basis.cut(2 * wing..2 * (x.len() - wing)))
    }

    /// Largest difference of the bodies with `elements` per half-width on nodes twice as close from those with twice as
    /// many elements: of the compliance, static and in steps of a millisecond, over the kernel of a half-plane, and of
    /// the answer to rigid accelerations.
    fn differences(elements: usize) -> [f64; 2] {
        let half_plane = Isotropic::from(&paper_d(elements).material).half_plane();
        let systems = |elements: usize| {
            let config = paper_d(elements);
            [(wheel_system(&config).unwrap(), 1.0), (rail_system(&config).unwrap(), -1.0)]
        };
        let mut worst = [0.0_f64; 2];
        for ((coarse, side), (fine, _)) in systems(elements).into_iter().zip(systems(2 * elements)) {
            let ((x, coarse), (finer, fine)) = (body(elements, &coarse), body(2 * elements, &fine));
            let divided = divided(&x, 2);
            let offset = divided.iter().position(|x| (x - finer[0]).abs() < 1e-9 * finer[0].abs()).unwrap();
            let refined = coarse.refined(&x, &divided, half_plane, side).cut(2 * offset..2 * (offset + finer.len()));
            let fine = fine.refined(&finer, &finer, half_plane, side);
            for a0 in [0.0, 1.5e3] {
                let surface = |basis: &ReducedBasis| {
                    ReducedBody::new(basis.clone(), true, &BodyDamping::NONE).operator(a0).unwrap().surface
                };
                worst[0] = worst[0].max((surface(&refined) - surface(&fine)).amax() / half_plane.kernel);
            }
            let inertial = (&refined.rigid_residual - &fine.rigid_residual).amax() / fine.rigid_residual.amax();
            worst[1] = worst[1].max(inertial);
        }
        worst
    }

    #[test]
    fn finer_nodes_see_the_body_that_finer_elements_have() {
        let [coarse, fine] = [5, 10].map(differences);
        println!("{coarse:?} with 5 elements, {fine:?} with 10");
        assert!(coarse[0] < 5e-2 && fine[0] < 0.5 * coarse[0] && coarse[1] < 2e-2 && fine[1] < coarse[1]);
    }

    /// With as many contact nodes as finite elements have: static, in steps of 0.1 ms, and with the energy of nodal
    /// forces.
    #[test]
    fn full_and_reduced_bodies_have_the_flexibility_between_near_nodes_that_finite_elements_lack() {
        let config = paper_d(5);
        let half_plane = Isotropic::from(&config.material).half_plane();
        let (system, x) = (rail_system(&config).unwrap(), contact_zone(&config).surface_x());
        let basis = ReducedBasis::compute(&system, 40, &mut |_| {}).unwrap();
        let reduced = ReducedBody::new(basis.refined(&x, &x, half_plane, -1.0), false, &BodyDamping::NONE);
        let plain = FullBody::new(system.clone(), false).unwrap().operator(0.0).unwrap().surface;
        let full = FullBody::new(system, false).unwrap().corrected(&x, half_plane, -1.0).unwrap();
        for a0 in [0.0, 1.5e4] {
            let [one, other] = [full.operator(a0).unwrap().surface, reduced.operator(a0).unwrap().surface];
            let difference = (&one - &other).amax() / one.amax();
            println!("a0 = {a0}: {difference:.1e}");
            assert!(difference < 1e-3, "{difference:e}");
        }
        let compliance = full.operator(0.0).unwrap().surface;
        assert!((&compliance - &plain).amax() > 0.05 * half_plane.kernel, "the elements must lack some");
        let forces = DVector::from_fn(compliance.nrows(), |i, _| ((i * 37) % 11) as f64 - 5.0);
        let mut state = BodyState::zeros(full.state_len());
        let mut load = DVector::zeros(full.state_len());
        full.add_surface_forces(&forces, &mut load);
        full.operator(0.0).unwrap().solver.solve_in_place(&mut load);
        state.displacement = load;
        let (found, expected) =
            (full.energy(&state, &forces, PerAxis::default()), 0.5 * forces.dot(&(&compliance * &forces)));
        assert!((found / expected - 1.0).abs() < 1e-9, "{found:e} J/m, {expected:e} J/m");
    }

    #[test]
    fn a_division_of_cells_keeps_all_nodes_and_a_cubic_polynomial_is_interpolated_exactly() {
        let x = [-3.0, -1.5, -0.5, 0.0, 0.5, 1.5, 3.0];
        let finer = divided(&x, 3);
        assert_eq!((finer.len(), finer[3], finer[18], finer[1]), (19, -1.5, 3.0, -2.5));
        let cubic = |x: &f64| 1.0 + x * (2.0 - x * (0.5 + 0.3 * x));
        let values = interpolation(&x, &finer) * DMatrix::from_iterator(7, 1, x.iter().map(cubic));
        assert!(finer.iter().zip(values.iter()).all(|(x, value)| (cubic(x) - value).abs() < 1e-12));
    }
}
