//! The full finite-element equations of a body behind the contact (verification).

use super::MechanicsError;
use super::response::{BodyResponse, BodyState, Convection, FreeResponse, StepOperator, StepSolver};
use super::system::BodySystem;
use crate::linalg::{CholeskyPattern, CsrMatrix};
use crate::multistep::TimeDerivative;
use nalgebra::DVector;

/// State: all free nodal displacements.
pub struct FullBody {
    system: BodySystem,
    pattern: CholeskyPattern,
    centrifugal: bool,
}

impl FullBody {
    /// Analyses the pattern of `a0² M + K` once for all `a0`.
    pub fn new(system: BodySystem, centrifugal: bool) -> Result<Self, MechanicsError> {
        let pattern = CholeskyPattern::new(&CsrMatrix::combination(0.0, &system.mass, 1.0, &system.stiffness)?)?;
        Ok(Self { system, pattern, centrifugal })
    }

    /// The matrices behind the response.
    pub fn system(&self) -> &BodySystem {
        &self.system
    }

    fn momentum(&self, rate: &DVector<f64>) -> [f64; 3] {
        std::array::from_fn(|k| self.system.rigid.column(k).dot(rate))
    }
}

impl BodyResponse for FullBody {
    fn state_len(&self) -> usize {
        self.system.unknowns()
    }

    fn operator(&self, a0: f64) -> Result<StepOperator, MechanicsError> {
        let system = &self.system;
        let matrix = CsrMatrix::combination(a0 * a0, &system.mass, 1.0, &system.stiffness)?;
        let factor = self.pattern.factorise(&matrix)?;
        let surface = system.surface_compliance(&factor);
        let mut rigid = system.rigid.clone();
        factor.solve_columns(&mut rigid);
        let loads = -system.rows_on_surface(&rigid);
        let momentum = loads.transpose() * -(a0 * a0);
        let momentum_loads = system.rigid.tr_mul(&rigid) * -(a0 * a0);
        Ok(StepOperator { a0, surface, loads, momentum, momentum_loads, solver: StepSolver::Sparse(factor) })
    }

    fn free(
        &self,
        op: &StepOperator,
        state: &BodyState,
        td: &TimeDerivative,
        convection: Convection,
        convected: &BodyState,
    ) -> FreeResponse {
        let Convection { speed, acceleration } = convection;
        let system = &self.system;
        let mut load = DVector::zeros(self.state_len());
        let inertial = state.acceleration_offsets(td);
        system.mass.multiply_add(-1.0, inertial.as_slice(), load.as_mut_slice());
        if speed != 0.0 || acceleration != 0.0 {
            let mut rate = &convected.velocity * (2.0 * speed);
            rate.axpy(acceleration, &convected.displacement, 1.0);
            system.convection.multiply_add(-1.0, rate.as_slice(), load.as_mut_slice());
            let square = speed * speed;
            system.curvature.multiply_add(square, convected.displacement.as_slice(), load.as_mut_slice());
            if self.centrifugal {
                load.axpy(square, &system.centrifugal, 1.0);
            }
        }
        let mut free = load.clone();
        op.solver.solve_in_place(&mut free);
        let surface = system.on_surface(&free);
        let momentum = self.momentum(&(free * (op.a0 * op.a0) + inertial));
        FreeResponse { surface, momentum, load }
    }

    fn commit(
        &self,
        op: &StepOperator,
        free: &FreeResponse,
        forces: &DVector<f64>,
        rigid: [f64; 3],
        td: &TimeDerivative,
        state: &mut BodyState,
    ) {
        let mut new = free.load.clone();
        for (&i, force) in self.system.surface.iter().zip(forces.iter()) {
            new[i] += force;
        }
        for (k, acceleration) in rigid.iter().enumerate() {
            new.axpy(-acceleration, &self.system.rigid.column(k), 1.0);
        }
        op.solver.solve_in_place(&mut new);
        state.advance(td, new);
    }

    fn energy(&self, state: &BodyState, _forces: &DVector<f64>, rigid_velocity: [f64; 3]) -> f64 {
        let (y, v) = (state.displacement.as_slice(), state.velocity.as_slice());
        let elastic = 0.5 * self.system.stiffness.bilinear(y, y);
        let kinetic = 0.5 * self.system.mass.bilinear(v, v);
        let coupling: f64 = self.momentum(&state.velocity).iter().zip(rigid_velocity).map(|(p, w)| p * w).sum();
        elastic + kinetic + coupling
    }
}
