//! The full finite-element equations of a body behind the contact (verification).

use super::MechanicsError;
use super::motion::{self, Equations};
use super::response::{BodyResponse, BodyState, Convection, FreeResponse, StepOperator, fit};
use super::system::BodySystem;
use crate::linalg::{CholeskyPattern, CsrMatrix, LinalgError};
use crate::multistep::TimeDerivative;
use nalgebra::{DMatrix, DVector};

/// State: all free nodal displacements.
pub struct FullBody {
    system: BodySystem,
    pattern: CholeskyPattern,
    centrifugal: bool,
}

/// `a0² M + a0 D + K`; the pattern does not depend on `a0`.
fn step_matrix(system: &BodySystem, a0: f64) -> Result<CsrMatrix, LinalgError> {
    let undamped = CsrMatrix::combination(a0 * a0, &system.mass, 1.0, &system.stiffness)?;
    match &system.damping {
        Some(damping) => CsrMatrix::combination(1.0, &undamped, a0, damping),
        None => Ok(undamped),
    }
}

impl FullBody {
    /// Analyses the pattern of `a0² M + a0 D + K` once for all `a0`; `centrifugal`: with the centrifugal load.
    pub fn new(system: BodySystem, centrifugal: bool) -> Result<Self, MechanicsError> {
        let pattern = CholeskyPattern::new(&step_matrix(&system, 0.0)?)?;
        Ok(Self { system, pattern, centrifugal })
    }
}

impl Equations for FullBody {
    fn set_inertia(&self, acceleration: &DVector<f64>, load: &mut DVector<f64>) {
        load.fill(0.0);
        self.system.mass.multiply_add(-1.0, acceleration.as_slice(), load.as_mut_slice());
    }

    fn is_damped(&self) -> bool {
        self.system.damping.is_some()
    }

    fn subtract_damping(&self, velocity: &DVector<f64>, load: &mut DVector<f64>) {
        if let Some(damping) = &self.system.damping {
            damping.multiply_add(-1.0, velocity.as_slice(), load.as_mut_slice());
        }
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
        fit(surface, self.system.surface.len());
        surface.iter_mut().zip(&self.system.surface).for_each(|(value, &i)| *value = y[i]);
    }

    fn add_surface_forces(&self, forces: &DVector<f64>, load: &mut DVector<f64>) {
        self.system.surface.iter().zip(forces).for_each(|(&i, force)| load[i] += force);
    }
}

impl BodyResponse for FullBody {
    fn state_len(&self) -> usize {
        self.system.unknowns()
    }

    fn operator(&self, a0: f64) -> Result<StepOperator, MechanicsError> {
        let system = &self.system;
        let factor = self.pattern.factorise(&step_matrix(system, a0)?)?;
        let surface = system.surface_compliance(&factor);
        let mut rigid = system.rigid.clone();
        factor.solve_columns(&mut rigid);
        let inertial_response = -system.rows_on_surface(&rigid);
        let momentum = inertial_response.transpose() * -(a0 * a0);
        let deformation_inertia = system.rigid.tr_mul(&rigid) * -(a0 * a0);
        Ok(StepOperator { a0, surface, inertial_response, momentum, deformation_inertia, solver: Box::new(factor) })
    }

    fn free_response(
        &self,
        op: &StepOperator,
        state: &BodyState,
        td: &TimeDerivative,
        stream: Convection,
        out: &mut FreeResponse,
    ) {
        motion::free_response(self, op, state, td, stream, out);
    }

    fn commit(
        &self,
        op: &StepOperator,
        free: &FreeResponse,
        forces: &DVector<f64>,
        rigid: [f64; 3],
        td: &TimeDerivative,
        state: &BodyState,
        next: &mut BodyState,
    ) {
        motion::commit(self, op, free, forces, rigid, td, state, next);
    }

    fn energy(&self, state: &BodyState, _forces: &DVector<f64>, rigid_velocity: [f64; 3]) -> f64 {
        let system = &self.system;
        let (y, v) = (state.displacement.as_slice(), state.velocity.as_slice());
        let elastic = 0.5 * system.stiffness.bilinear(y, y);
        let kinetic = 0.5 * system.mass.bilinear(v, v);
        let momentum = system.rigid.column_iter().map(|m_r| m_r.dot(&state.velocity));
        let coupling: f64 = momentum.zip(rigid_velocity).map(|(p, w)| p * w).sum();
        elastic + kinetic + coupling
    }

    fn dissipation(&self, state: &BodyState) -> f64 {
        let v = state.velocity.as_slice();
        self.system.damping.as_ref().map_or(0.0, |damping| damping.bilinear(v, v))
    }
}
