//! The full finite-element equations of a body behind the contact (verification).

use super::MechanicsError;
use super::damping::{BodyDamping, DampedModes};
use super::motion::{BodyResponse, Equations, centrifugal_work};
use super::products::quadratic_form;
use super::reduction::scale_columns;
use super::response::{BodyState, StepOperator, fit};
use super::smooth::SmoothPorts;
use super::solver::{Dense, StepSolver};
use super::system::BodySystem;
use crate::analytic::HalfPlane;
use crate::axes::PerAxis;
use crate::linalg::dense::symmetrise;
use crate::linalg::{Cholesky, CholeskyPattern, CsrMatrix, LinalgError};
use nalgebra::{DMatrix, DVector};
use std::sync::Arc;

/// State: all free nodal displacements.
pub struct FullBody {
    system: BodySystem,
    pattern: CholeskyPattern,
    centrifugal: bool,
    /// The modes that ratios damp, and through which the stream carries strain.
    damping: Option<Arc<DampedModes>>,
    /// Components of the ports by those of the surface nodes; `None`: these are the ports.
    on_points: Option<DMatrix<f64>>,
    /// Flexibility that the finite elements lack between the ports: none between surface nodes, and at the points of
    /// [`SmoothPorts`] the error between near nodes, less a half-plane [m/(N/m)].
    lacking: DMatrix<f64>,
}

/// `a0² M + a0 D + K` with dashpots `D`; the pattern does not depend on `a0`.
fn step_matrix(system: &BodySystem, a0: f64) -> Result<CsrMatrix, LinalgError> {
    let matrix = CsrMatrix::combination(a0 * a0, &system.mass, 1.0, &system.stiffness)?;
    match &system.damping {
        Some(damping) => CsrMatrix::combination(1.0, &matrix, a0, damping),
        None => Ok(matrix),
    }
}

impl FullBody {
    /// Analyses the pattern of `a0² M + a0 D + K` once for all `a0`; `centrifugal`: with the centrifugal load.
    pub fn new(system: BodySystem, centrifugal: bool) -> Result<Self, MechanicsError> {
        let pattern = CholeskyPattern::new(&step_matrix(&system, 0.0)?)?;
        let ports = system.surface.len();
        Ok(Self { system, pattern, centrifugal, damping: None, on_points: None, lacking: DMatrix::zeros(ports, ports) })
    }

    /// Body with damping, for which the lowest `modes` vibration modes are computed.
    pub fn damped(
        system: BodySystem,
        centrifugal: bool,
        damping: &BodyDamping,
        modes: usize,
    ) -> Result<Self, MechanicsError> {
        let mut body = Self::new(system, centrifugal)?;
        if damping.is_none() {
            return Ok(body);
        }
        body.damping = Some(Arc::new(DampedModes::compute(&body.system, modes, damping)?));
        Ok(body)
    }

    /// This body, whose ports are its surface nodes, less a half-plane on points of their zone.
    pub(super) fn smooth(self, ports: &SmoothPorts, half_plane: HalfPlane, side: f64) -> Result<Self, MechanicsError> {
        let (compliance, on_points) = (self.operator(0.0)?.surface, ports.components());
        let mut lacking = ports.remainder(&compliance, half_plane, side);
        lacking -= &on_points * compliance * on_points.transpose();
        symmetrise(&mut lacking);
        Ok(Self { on_points: Some(on_points), lacking, ..self })
    }

    /// Several fields at the ports.
    fn rows_on_ports(&self, fields: &DMatrix<f64>) -> DMatrix<f64> {
        let on_surface = self.system.rows_on_surface(fields);
        match &self.on_points {
            Some(on_points) => on_points * on_surface,
            None => on_surface,
        }
    }

    /// Answer of the ports to unit forces on them through the elements alone [m/(N/m)]; `factor` is that of the matrix of
    /// the step.
    fn compliance(&self, factor: &Cholesky) -> DMatrix<f64> {
        let Some(on_points) = &self.on_points else { return self.system.surface_compliance(factor) };
        let mut columns = DMatrix::zeros(self.system.unknowns(), on_points.nrows());
        for (&unknown, weights) in self.system.surface.iter().zip(on_points.column_iter()) {
            columns.row_mut(unknown).copy_from(&weights.transpose());
        }
        factor.solve_columns(&mut columns);
        let mut compliance = self.rows_on_ports(&columns);
        symmetrise(&mut compliance);
        compliance
    }
}

impl DampedModes {
    /// Correction `L W Lᵀ` of the inverse of the matrix `A` of the step by the damping of modes by ratios, which its
    /// `factor` does not contain.
    fn correction(&self, system: &BodySystem, factor: &Cholesky, a0: f64) -> Result<Correction, MechanicsError> {
        match system.damping {
            None => Ok(self.uncoupled(a0)),
            Some(_) => self.coupled(system, factor, a0),
        }
    }

    /// The modes are eigenvectors of `A`: `L = Φ` and `W = diag(1/(s + 2ζω a0) − 1/s)` with `s = a0² + ω²`.
    fn uncoupled(&self, a0: f64) -> Correction {
        let Self { squared_frequencies, rates, shapes } = self;
        let weights = squared_frequencies.zip_map(rates, |square, rate| {
            let without = a0 * a0 + square;
            1.0 / (without + rate * a0) - 1.0 / without
        });
        Correction { shapes: shapes.clone(), weights: DMatrix::from_diagonal(&weights) }
    }

    /// Dashpots couple the modes: `L = A⁻¹ M Φ R`, `W = −a0 (1 + a0 R Φᵀ M A⁻¹ M Φ R)⁻¹` with `R² = diag(2ζω)`
    /// (Woodbury).
    fn coupled(&self, system: &BodySystem, factor: &Cholesky, a0: f64) -> Result<Correction, MechanicsError> {
        let Self { rates, shapes, .. } = self;
        let loads = scale_columns(&system.mass.multiply_columns(shapes), &rates.map(f64::sqrt));
        let mut answers = loads.clone();
        factor.solve_columns(&mut answers);
        let one = DMatrix::identity(rates.len(), rates.len());
        let mut capacity = &one + loads.tr_mul(&answers) * a0;
        symmetrise(&mut capacity);
        let weights = Dense::new(capacity)?.solve(&(one * -a0));
        Ok(Correction { shapes: Arc::new(answers), weights })
    }

    /// `v ← v + s Φ Φᵀ T y`: the rate of the material, from that at a fixed place of the frame.
    fn follow_stream(&self, system: &BodySystem, speed: f64, y: &DVector<f64>, velocity: &mut DVector<f64>) {
        if speed == 0.0 {
            return;
        }
        let modal = self.shapes.tr_mul(&product(&system.transport, y));
        velocity.gemv(speed, &self.shapes, &modal, 1.0);
    }
}

/// `A x`.
fn product(a: &CsrMatrix, x: &DVector<f64>) -> DVector<f64> {
    let mut result = DVector::zeros(x.len());
    a.multiply(x.as_slice(), result.as_mut_slice());
    result
}

/// A matrix `L W Lᵀ` of small rank, which is added to an inverse.
struct Correction {
    /// `L`, a column for each damped mode.
    shapes: Arc<DMatrix<f64>>,
    /// `W`, symmetric.
    weights: DMatrix<f64>,
}

/// The factor of a matrix without modal damping, and what that changes.
struct Corrected {
    factor: Cholesky,
    correction: Correction,
}

impl StepSolver for Corrected {
    fn solve_in_place(&self, f: &mut DVector<f64>) {
        let Correction { shapes, weights } = &self.correction;
        let modal = weights * shapes.tr_mul(f);
        self.factor.solve_in_place(f.as_mut_slice());
        f.gemv(1.0, shapes, &modal, 1.0);
    }
}

impl Equations for FullBody {
    fn set_inertia(&self, acceleration: &DVector<f64>, load: &mut DVector<f64>) {
        load.fill(0.0);
        self.system.mass.multiply_add(-1.0, acceleration.as_slice(), load.as_mut_slice());
    }

    fn is_damped(&self) -> bool {
        self.damping.is_some() || self.system.damping.is_some()
    }

    fn subtract_damping(&self, speed: f64, state: &BodyState, velocity: &mut DVector<f64>, load: &mut DVector<f64>) {
        if let Some(dashpots) = &self.system.damping {
            dashpots.multiply_add(-1.0, velocity.as_slice(), load.as_mut_slice());
        }
        let Some(damping) = &self.damping else { return };
        damping.follow_stream(&self.system, speed, &state.displacement, velocity);
        let DampedModes { shapes, rates, .. } = &**damping;
        let modal = shapes.tr_mul(&product(&self.system.mass, velocity)).component_mul(rates);
        let field = &**shapes * modal;
        self.system.mass.multiply_add(-1.0, field.as_slice(), load.as_mut_slice());
    }

    fn subtract_gyroscopic(&self, rate: &DVector<f64>, load: &mut DVector<f64>) {
        self.system.gyroscopic.multiply_add(-1.0, rate.as_slice(), load.as_mut_slice());
    }

    fn add_ale_inertia(&self, square: f64, displacement: &DVector<f64>, load: &mut DVector<f64>) {
        self.system.ale_inertia.multiply_add(square, displacement.as_slice(), load.as_mut_slice());
    }

    fn centrifugal(&self) -> Option<&DVector<f64>> {
        self.centrifugal.then_some(&self.system.centrifugal)
    }

    fn rigid(&self) -> &DMatrix<f64> {
        &self.system.rigid
    }

    fn set_surface(&self, y: &DVector<f64>, _square: f64, surface: &mut DVector<f64>) {
        fit(surface, self.lacking.nrows());
        let Some(on_points) = &self.on_points else {
            surface.iter_mut().zip(&self.system.surface).for_each(|(value, &i)| *value = y[i]);
            return;
        };
        surface.fill(0.0);
        let weights = self.system.surface.iter().zip(on_points.column_iter());
        weights.for_each(|(&i, weights)| surface.axpy(y[i], &weights, 1.0));
    }

    fn add_surface_forces(&self, forces: &DVector<f64>, load: &mut DVector<f64>) {
        let Some(on_points) = &self.on_points else {
            self.system.surface.iter().zip(forces).for_each(|(&i, force)| load[i] += force);
            return;
        };
        let weights = self.system.surface.iter().zip(on_points.column_iter());
        weights.for_each(|(&i, weights)| load[i] += weights.dot(forces));
    }
}

impl BodyResponse for FullBody {
    fn state_len(&self) -> usize {
        self.system.unknowns()
    }

    fn operator(&self, a0: f64) -> Result<StepOperator, MechanicsError> {
        let system = &self.system;
        let factor = self.pattern.factorise(&step_matrix(system, a0)?)?;
        let mut surface = self.compliance(&factor);
        let mut rigid = system.rigid.clone();
        factor.solve_columns(&mut rigid);
        let solver: Box<dyn StepSolver> = match &self.damping {
            None => Box::new(factor),
            Some(damping) => {
                let correction = damping.correction(system, &factor, a0)?;
                let Correction { shapes, weights } = &correction;
                rigid += &**shapes * (weights * shapes.tr_mul(&system.rigid));
                let on_ports = self.rows_on_ports(shapes);
                surface.gemm(1.0, &(&on_ports * weights), &on_ports.transpose(), 1.0);
                symmetrise(&mut surface);
                Box::new(Corrected { factor, correction })
            }
        };
        let inertial_response = -self.rows_on_ports(&rigid);
        let momentum = inertial_response.transpose() * -(a0 * a0);
        let deformation_inertia = system.rigid.tr_mul(&rigid) * -(a0 * a0);
        surface += &self.lacking;
        Ok(StepOperator { a0, surface, inertial_response, momentum, deformation_inertia, solver })
    }

    fn energy(&self, state: &BodyState, forces: &DVector<f64>, rigid_velocity: PerAxis<f64>) -> f64 {
        let system = &self.system;
        let (y, v) = (state.displacement.as_slice(), state.velocity.as_slice());
        let elastic = 0.5 * system.stiffness.bilinear(y, y);
        let kinetic = 0.5 * system.mass.bilinear(v, v);
        let momentum = system.rigid.column_iter().map(|m_r| m_r.dot(&state.velocity));
        let coupling: f64 = momentum.zip(rigid_velocity.values()).map(|(p, w)| p * w).sum();
        let lacking = 0.5 * quadratic_form(&self.lacking, forces);
        elastic + kinetic + coupling + lacking - centrifugal_work(self, state, rigid_velocity.rotation)
    }

    fn dissipation(&self, state: &BodyState, speed: f64) -> f64 {
        let (system, v) = (&self.system, state.velocity.as_slice());
        let dashpots = system.damping.as_ref().map_or(0.0, |damping| damping.bilinear(v, v));
        let Some(damping) = &self.damping else { return dashpots };
        let mut velocity = state.velocity.clone();
        damping.follow_stream(system, speed, &state.displacement, &mut velocity);
        let momentum = product(&system.mass, &velocity);
        let modal = damping.shapes.tr_mul(&momentum);
        dashpots + modal.iter().zip(&damping.rates).map(|(v, rate)| rate * v * v).sum::<f64>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanics::Ends;
    use crate::mechanics::rail_system;
    use crate::mechanics::testing::paper_d;

    /// Ratios of modes beside dashpots: the residual of the equations of the step.
    #[test]
    fn the_matrix_of_a_step_with_dashpots_and_damped_modes_is_inverted() {
        let mut bodies = paper_d(3);
        bodies.rail_ends = Ends::Nonreflecting;
        let system = rail_system(&bodies).unwrap();
        let damping = BodyDamping { ratios: [0.1; 4] };
        let body = FullBody::damped(system.clone(), false, &damping, 8).unwrap();
        let a0 = 2e4;
        let f = DVector::from_fn(system.unknowns(), |i, _| ((i * 37) % 101) as f64 - 50.0);
        let mut y = f.clone();
        body.operator(a0).unwrap().solver.solve_in_place(&mut y);
        let modes = body.damping.as_ref().unwrap();
        let momentum = product(&system.mass, &y);
        let modal = modes.shapes.tr_mul(&momentum).component_mul(&modes.rates);
        let field = &momentum * (a0 * a0) + product(&system.mass, &(&*modes.shapes * modal)) * a0;
        let elastic = product(&system.stiffness, &y);
        let residual = field + elastic + product(system.damping.as_ref().unwrap(), &y) * a0 - &f;
        assert!(residual.amax() < 1e-9 * f.amax(), "{:e}", residual.amax());
    }
}
