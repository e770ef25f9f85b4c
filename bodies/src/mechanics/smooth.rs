//! Bodies less the half-plane: what is left of their surface compliance is smooth.
//!
//! Close to a load every body answers like a half-plane. A contact solver that knows the half-plane in closed form
//! needs of the body only the difference, which varies over the size of the body, and therefore only a polynomial of
//! it: its ports are the displacements at a few points of the contact zone. The modes, or the finite elements, are those
//! of the body with all its surface nodes. Derivation: `docs/theory/contact.md`, section 2.

use super::reduction::{ReducedBasis, scale_columns};
use crate::analytic::HalfPlane;
use crate::fem::graded::GUARDS;
pub use crate::linalg::POINTS;
use crate::linalg::dense::symmetrise;
use crate::linalg::{Lagrange, LinalgError};
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

/// Nodes within which the compliance of finite elements is not yet that of the elastic body.
const NEAR: usize = 8;

/// Points of a polynomial on a zone of surface nodes, and what the nodes tell of it.
pub(super) struct SmoothPorts {
    /// The polynomials; they reach to the outermost nodes that may carry contact.
    pub basis: Lagrange,
    /// The surface nodes, ascending \[m].
    x: Vec<f64>,
    /// Values at the points by those at the nodes.
    projection: DMatrix<f64>,
    /// Values of the polynomials at the nodes, a row for each polynomial.
    values: DMatrix<f64>,
    /// Pairs of nodes fewer cells apart than these take no part in a fit: the finite elements err between them.
    near: usize,
    /// Normal equations of a polynomial of two variables at all other pairs.
    normal: Cholesky<f64, Dyn>,
}

impl SmoothPorts {
    /// Points on the zone of the surface nodes `x` \[m], ascending, each of which counts the same: most of them lie where
    /// the contact does.
    pub fn new(x: &[f64]) -> Result<Self, LinalgError> {
        let basis = Lagrange::new(x[x.len().saturating_sub(1 + GUARDS)]);
        let values = DMatrix::from_fn(POINTS, x.len(), |k, i| basis.values(x[i])[k]);
        let near = NEAR.min(x.len() / 4);
        let normal = normal_equations(&values, near).cholesky().ok_or_else(|| {
            let reason = format!("{} surface nodes for polynomials through {POINTS} points", x.len());
            LinalgError::NotPositiveDefinite { size: POINTS * POINTS, reason }
        })?;
        Ok(Self { projection: basis.projection(x)?, x: x.to_vec(), basis, values, near, normal })
    }

    /// Components x and y at the points by those of the surface nodes.
    pub fn components(&self) -> DMatrix<f64> {
        DMatrix::from_fn(2 * POINTS, 2 * self.x.len(), |i, j| match i % 2 == j % 2 {
            true => self.projection[(i / 2, j / 2)],
            false => 0.0,
        })
    }

    /// Compliance of the points, of a body whose nodes have the static `compliance`, less that of a half-plane: the body
    /// lies above its surface (`side` 1) or below it (−1) [m/(N/m)].
    pub fn remainder(&self, compliance: &DMatrix<f64>, half_plane: HalfPlane, side: f64) -> DMatrix<f64> {
        let mut whole = DMatrix::zeros(2 * POINTS, 2 * POINTS);
        for (c, d) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            let rest = DMatrix::from_fn(self.x.len(), self.x.len(), |i, j| match i.abs_diff(j) < self.near {
                true => 0.0,
                false => {
                    let distance = self.x[i] - self.x[j];
                    compliance[(2 * i + c, 2 * j + d)] - half_plane.displacement(c, d, distance, side)
                }
            });
            let known = &self.values * rest * self.values.transpose();
            let fitted = self.normal.solve(&DVector::from_column_slice(known.as_slice()));
            for (at, value) in fitted.iter().enumerate() {
                whole[(2 * (at % POINTS) + c, 2 * (at / POINTS) + d)] = *value;
            }
        }
        whole
    }
}

/// Matrix of the least squares of a polynomial of two variables at all pairs of nodes `near` cells apart or more; `values`
/// are those of the polynomials at the nodes.
fn normal_equations(values: &DMatrix<f64>, near: usize) -> DMatrix<f64> {
    let squares: Vec<_> = values.column_iter().map(|values| values * values.transpose()).collect();
    let mut sum = DMatrix::zeros(POINTS * POINTS, POINTS * POINTS);
    for (j, second) in squares.iter().enumerate() {
        let far = squares.iter().enumerate().filter(|(i, _)| i.abs_diff(j) >= near);
        let first = far.fold(DMatrix::zeros(POINTS, POINTS), |sum, (_, first)| sum + first);
        sum += second.kronecker(&first);
    }
    sum
}

impl ReducedBasis {
    /// This body with a surface whose values follow from those of its own by the matrix `between` and whose `compliance` is
    /// given [m/(N/m)].
    fn on_surface(&self, between: &DMatrix<f64>, compliance: DMatrix<f64>) -> Self {
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
            shapes,
            ..self.clone()
        }
    }

    /// The body less a half-plane, on points of the zone of its surface nodes.
    pub(super) fn smooth(&self, ports: &SmoothPorts, half_plane: HalfPlane, side: f64) -> Self {
        self.on_surface(&ports.projection, ports.remainder(&self.compliance(), half_plane, side))
    }
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
    use crate::mechanics::testing::{committed, free, half_width, paper_d};
    use crate::mechanics::{
        BodyDamping, BodyResponse, BodyState, Convection, FullBody, ReducedBody, contact_zone, rail_system,
        wheel_system,
    };
    use crate::multistep::TimeDerivative;

    /// The compliance of the mesh between all nodes far apart is that of the half-plane and the polynomial together.
    #[test]
    fn half_plane_and_polynomial_are_the_body_over_the_whole_zone() {
        let mut railway = paper_d(10);
        (railway.radius, railway.hub_radius, railway.material.youngs_modulus) = (0.46, 0.046, 210e9);
        railway.half_width = half_width(&railway, 1e5 / 0.014);
        for (name, bodies) in [("paper_d", paper_d(10)), ("railway", railway)] {
            let (steel, x) = (bodies.material, contact_zone(&bodies).surface_x());
            let half_plane = steel.half_plane();
            assert!((half_plane.kernel * std::f64::consts::PI * steel.contact_modulus() - 1.0).abs() < 1e-14);
            let ports = SmoothPorts::new(&x).unwrap();
            for (system, side) in [(wheel_system(&bodies).unwrap(), 1.0), (rail_system(&bodies).unwrap(), -1.0)] {
                let body = ReducedBasis::compute(&system, 6, &mut |_| {}).unwrap();
                let (exact, rest) = (body.compliance(), body.smooth(&ports, half_plane, side).compliance());
                let mut worst = [0.0_f64; 4];
                let pairs = (0..x.len()).flat_map(|i| (0..x.len()).map(move |j| (i, j)));
                for (i, j) in pairs.filter(|(i, j)| i.abs_diff(*j) >= NEAR) {
                    for (worst, (c, d)) in worst.iter_mut().zip([(0, 0), (0, 1), (1, 0), (1, 1)]) {
                        let mut sum = half_plane.displacement(c, d, x[i] - x[j], side);
                        for (k, l) in (0..POINTS).flat_map(|k| (0..POINTS).map(move |l| (k, l))) {
                            sum += ports.values[(k, i)] * rest[(2 * k + c, 2 * l + d)] * ports.values[(l, j)];
                        }
                        let error = sum - exact[(2 * i + c, 2 * j + d)];
                        *worst = worst.max(error.abs() / half_plane.kernel);
                    }
                }
                println!("{name}, side {side}: {worst:?} of the kernel (xx, xy, yx, yy)");
                assert!(worst.iter().all(|error| *error < 2e-3));
            }
        }
    }

    /// A body of `paper_d`: with modes, at all surface nodes and at the points, and with its finite elements at the points.
    struct Twice {
        reduced: [ReducedBody; 2],
        full: FullBody,
        ports: SmoothPorts,
        kernel: f64,
    }

    fn twice(damping: &BodyDamping) -> [Twice; 2] {
        let bodies = paper_d(5);
        let half_plane = bodies.material.half_plane();
        let systems = [(wheel_system(&bodies).unwrap(), 1.0), (rail_system(&bodies).unwrap(), -1.0)];
        systems.map(|(system, side)| {
            let ports = SmoothPorts::new(&contact_zone(&bodies).surface_x()).unwrap();
            let basis = ReducedBasis::compute(&system, 40, &mut |_| {}).unwrap();
            let (smooth, turns) = (basis.smooth(&ports, half_plane, side), side > 0.0);
            let reduced = [basis, smooth].map(|basis| ReducedBody::new(basis, turns, damping));
            let full = FullBody::damped(system, turns, damping, 40).unwrap();
            let full = full.smooth(&ports, half_plane, side).unwrap();
            Twice { reduced, full, ports, kernel: half_plane.kernel }
        })
    }

    /// Largest difference between two matrices over the largest entry of the second \[1].
    fn apart(a: &DMatrix<f64>, b: &DMatrix<f64>) -> f64 {
        (a - b).amax() / b.amax()
    }

    /// Static answers to forces, accelerations and rotation, and those of steps of 1 and .1 ms.
    #[test]
    fn full_and_reduced_bodies_have_the_same_points() {
        for Twice { reduced: [_, reduced], full, kernel, .. } in twice(&BodyDamping::NONE) {
            let bodies = [&reduced as &dyn BodyResponse, &full];
            for (a0, bound) in [(0.0, 1e-8), (1.5e3, 1e-3), (1.5e4, 5e-2)] {
                let [r, f] = bodies.map(|body| body.operator(a0).unwrap());
                let surface = (&r.surface - &f.surface).amax() / kernel;
                let inertial = apart(&r.inertial_response, &f.inertial_response);
                println!("a0 = {a0}: {surface:.1e} of the kernel, {inertial:.1e} by accelerations");
                assert!(surface < bound && inertial < bound);
            }
            let turning = Convection { speed: 80.0, acceleration: 0.0 };
            let [r, f] = bodies.map(|body| {
                let (op, state) = (body.operator(0.0).unwrap(), BodyState::zeros(body.state_len()));
                free(body, &op, &state, &TimeDerivative::default(), turning).surface
            });
            assert!((&r - &f).amax() <= 1e-9 * f.amax(), "{r} {f}");
        }
    }

    #[test]
    fn forces_at_the_points_store_the_energy_that_their_compliance_gives() {
        for Twice { reduced: [_, reduced], full, .. } in twice(&BodyDamping::NONE) {
            for body in [&reduced as &dyn BodyResponse, &full] {
                let op = body.operator(0.0).unwrap();
                let forces = DVector::from_fn(2 * POINTS, |i, _| ((i * 37) % 11) as f64 - 5.0);
                let (time, rest) = (TimeDerivative::default(), Convection::default());
                let state = BodyState::zeros(body.state_len());
                let known = free(body, &op, &state, &time, rest);
                let state = committed(body, &op, &known, &forces, PerAxis::default(), &time, &state);
                let (found, expected) =
                    (body.energy(&state, &forces, PerAxis::default()), 0.5 * forces.dot(&(&op.surface * &forces)));
                assert!((found / expected - 1.0).abs() < 1e-9, "{found:e} J/m, {expected:e} J/m");
            }
        }
    }

    /// A body after a step: displacements of its ports, dissipated power and energy, and coordinates.
    struct Moment {
        surface: DVector<f64>,
        power: f64,
        energy: f64,
        coordinates: DVector<f64>,
    }

    /// 30 steps of .2 ms in a stream under pressure and shear on the middle of the zone, which grow in the first ten: on
    /// the nodes, or by their moments on the points.
    fn run(body: &dyn BodyResponse, ports: &SmoothPorts, at_points: bool) -> Vec<Moment> {
        let dt = 2e-4;
        let td = TimeDerivative { a0: 1.5 / dt, a1: -2.0 / dt, a2: 0.5 / dt, b1: 0.0 };
        let op = body.operator(td.a0).unwrap();
        let (mut state, n) = (BodyState::zeros(body.state_len()), ports.x.len());
        let load = DVector::from_fn(2 * n, |i, _| match ((i / 2).abs_diff(n / 2) < 5, i % 2) {
            (true, 1) => -2e4,
            (true, _) => 4e3,
            _ => 0.0,
        });
        let moments = DMatrix::from_fn(2 * POINTS, 2 * n, |i, j| match i % 2 == j % 2 {
            true => ports.values[(i / 2, j / 2)],
            false => 0.0,
        });
        let load = if at_points { moments * load } else { load };
        let step = |k: i32| {
            let forces = &load * (f64::from(k) / 10.0).min(1.0);
            let known = free(body, &op, &state, &td, Convection { speed: 40.0, acceleration: 0.0 });
            let surface = &known.surface + &op.surface * &forces;
            state = committed(body, &op, &known, &forces, PerAxis::default(), &td, &state);
            let energy = body.energy(&state, &forces, PerAxis::default());
            Moment { surface, power: body.dissipation(&state, 40.0), energy, coordinates: state.displacement.clone() }
        };
        (1..=30).map(step).collect()
    }

    /// In the rail the stream carries much of what the truncated modes hold, which only the full body knows.
    #[test]
    fn damped_bodies_move_alike_with_all_nodes_and_points() {
        let damping = BodyDamping { ratios: [3e-2, 2e-2, 5e-2, 1e-2] };
        for (Twice { reduced: [nodes, reduced], full, ports, .. }, carried) in
            twice(&damping).into_iter().zip([2e-2, 0.1])
        {
            let [at_nodes, modal, elements] =
                [(&nodes as &dyn BodyResponse, false), (&reduced, true), (&full, true)].map(|(b, p)| run(b, &ports, p));
            // Largest difference over the largest value.
            let worst = |pairs: &mut dyn Iterator<Item = (f64, f64)>| {
                let both =
                    pairs.fold((0.0_f64, 0.0_f64), |worst, (apart, size)| (worst.0.max(apart), worst.1.max(size)));
                both.0 / both.1
            };
            let steps = || modal.iter().zip(&elements);
            let surface = worst(&mut steps().map(|(a, b)| ((&a.surface - &b.surface).amax(), b.surface.amax())));
            let power = worst(&mut steps().map(|(a, b)| ((a.power - b.power).abs(), b.power.abs())));
            let energy = worst(&mut steps().map(|(a, b)| ((a.energy - b.energy).abs(), b.energy.abs())));
            let steps = modal.iter().zip(&at_nodes).map(|(a, b)| (&a.coordinates, &b.coordinates));
            let coordinates = worst(&mut steps.map(|(a, b)| ((a - b).amax(), b.amax())));
            println!("from elements: surface {surface:.1e}, power {power:.1e}, energy {energy:.1e}");
            println!("coordinates from those by nodes: {coordinates:.1e}");
            assert!(surface < 2e-3 && power < carried && energy < 2e-2 && coordinates < 1e-6);
        }
    }
}
