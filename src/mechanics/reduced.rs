//! A body as vibration modes plus residual flexibility.
//!
//! `y = Φ q + (static answer of the truncated modes)`: with hub or base fixed, `Φᵀ M Φ = 1`, `Φᵀ K Φ = diag(Ω²)`, the
//! surface displacement is `u = Φ_s q + F_res λ + …` with `F_res = G − Φ_s Ω⁻² Φ_sᵀ` and `G` the static compliance.
//! The static limit is exact; the truncated modes lie above the band of interest and follow their load at once.
//! Source: Craig & Kurdila, *Fundamentals of Structural Dynamics*, 2nd ed. (2006), ch. 17 (Rubin's method).

use super::MechanicsError;
use super::response::{BodyResponse, BodyState, Convection, FreeResponse, StepOperator, StepSolver, TimeDerivative};
use super::system::{BodySystem, symmetrise};
use crate::linalg::{Cholesky, CsrMatrix, lowest_modes};
use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

/// Constant data of a reduced body with `m` modes and `n` surface nodes, per metre of width.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ReducedBasis {
    /// `Ω²` [rad²/s²], ascending, `m`.
    pub squared_frequencies: DVector<f64>,
    /// Modes on the surface `Φ_s`, `2n × m` [√(m/kg)].
    pub shapes: DMatrix<f64>,
    /// Residual flexibility `F_res`, `2n × 2n` [m/(N/m)].
    pub residual: DMatrix<f64>,
    /// `Φᵀ M r_k`, `m × 3` (zero for the rail).
    pub rigid: DMatrix<f64>,
    /// Static surface answer of the truncated modes to unit rigid accelerations, `2n × 3`.
    pub rigid_residual: DMatrix<f64>,
    /// `Φᵀ M X`, `m`.
    pub centrifugal: DVector<f64>,
    /// Static surface answer of the truncated modes to the centrifugal load per `Ω²`, `2n`.
    pub centrifugal_residual: DVector<f64>,
    /// `Φᵀ C Φ`, `m × m`.
    pub convection: DMatrix<f64>,
    /// `Φᵀ (S − B) Φ`, `m × m`.
    pub curvature: DMatrix<f64>,
}

impl ReducedBasis {
    /// Reduces a body to its `count` lowest modes; `progress` receives the share of the work done.
    pub fn compute(system: &BodySystem, count: usize, progress: &mut dyn FnMut(f64)) -> Result<Self, MechanicsError> {
        let factor = Cholesky::new(&system.stiffness)?;
        let mut modes_progress = |share: f64| progress(0.8 * share);
        let modes = lowest_modes(&system.stiffness, &factor, &system.mass, count, &mut modes_progress)?;
        let phi = &modes.shapes;
        let flexibility = modes.squared_frequencies.map(f64::recip);
        let shapes = system.rows_on_surface(phi);
        let weighted = scale_columns(&shapes, &flexibility);
        let mut residual = system.surface_compliance(&factor);
        residual.gemm(-1.0, &weighted, &shapes.transpose(), 1.0);
        symmetrise(&mut residual);
        let rigid = phi.tr_mul(&system.rigid);
        let centrifugal = phi.tr_mul(&system.centrifugal);
        let mut rigid_static = system.rigid.clone();
        factor.solve_columns(&mut rigid_static);
        let mut centrifugal_static = system.centrifugal.clone();
        factor.solve_in_place(centrifugal_static.as_mut_slice());
        let projected = |matrix: &CsrMatrix| {
            let phi_t = phi.transpose();
            &phi_t * matrix.multiply_columns(phi)
        };
        let basis = Self {
            rigid_residual: system.rows_on_surface(&rigid_static) - &weighted * &rigid,
            centrifugal_residual: system.on_surface(&centrifugal_static) - &weighted * &centrifugal,
            convection: projected(&system.convection),
            curvature: projected(&system.curvature),
            squared_frequencies: modes.squared_frequencies,
            shapes,
            residual,
            rigid,
            centrifugal,
        };
        progress(1.0);
        Ok(basis)
    }

    /// Number of modes.
    pub fn modes(&self) -> usize {
        self.squared_frequencies.len()
    }

    /// Whether all arrays belong to `ports` surface components and hold finite numbers.
    pub fn is_consistent(&self, ports: usize) -> bool {
        let m = self.modes();
        self.shapes.shape() == (ports, m)
            && self.residual.shape() == (ports, ports)
            && self.rigid.shape() == (m, 3)
            && self.rigid_residual.shape() == (ports, 3)
            && self.centrifugal.len() == m
            && self.centrifugal_residual.len() == ports
            && self.convection.shape() == (m, m)
            && self.curvature.shape() == (m, m)
            && self.squared_frequencies.iter().all(|w| *w > 0.0 && w.is_finite())
            && self.shapes.iter().chain(&self.residual).all(|x| x.is_finite())
            && self.convection.iter().chain(&self.curvature).all(|x| x.is_finite())
    }
}

/// Columns of `a` times the entries of `factors`.
fn scale_columns(a: &DMatrix<f64>, factors: &DVector<f64>) -> DMatrix<f64> {
    let mut scaled = a.clone();
    for (mut column, factor) in scaled.column_iter_mut().zip(factors.iter()) {
        column *= *factor;
    }
    scaled
}

/// State: modal coordinates.
pub struct ReducedBody {
    pub basis: ReducedBasis,
    /// Centrifugal load of the spinning wheel.
    pub centrifugal: bool,
}

impl BodyResponse for ReducedBody {
    fn state_len(&self) -> usize {
        self.basis.modes()
    }

    fn operator(&self, a0: f64) -> Result<StepOperator, MechanicsError> {
        let basis = &self.basis;
        let square = a0 * a0;
        let flexibility = basis.squared_frequencies.map(|w| 1.0 / (square + w));
        let weighted = scale_columns(&basis.shapes, &flexibility);
        let mut surface = basis.residual.clone();
        surface.gemm(1.0, &weighted, &basis.shapes.transpose(), 1.0);
        symmetrise(&mut surface);
        let modal = &weighted * &basis.rigid;
        let momentum = modal.transpose() * square;
        let loads = -(modal + &basis.rigid_residual);
        let answer = DMatrix::from_fn(basis.modes(), 3, |i, k| flexibility[i] * basis.rigid[(i, k)]);
        let momentum_loads = basis.rigid.tr_mul(&answer) * -square;
        Ok(StepOperator { a0, surface, loads, momentum, momentum_loads, solver: StepSolver::Modal(flexibility) })
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
        let basis = &self.basis;
        let inertial = state.acceleration_offsets(td);
        let mut load = -&inertial;
        let square = speed * speed;
        if speed != 0.0 || acceleration != 0.0 {
            let mut rate = &convected.velocity * (2.0 * speed);
            rate.axpy(acceleration, &convected.displacement, 1.0);
            load.gemv(-1.0, &basis.convection, &rate, 1.0);
            load.gemv(square, &basis.curvature, &convected.displacement, 1.0);
            if self.centrifugal {
                load.axpy(square, &basis.centrifugal, 1.0);
            }
        }
        let mut free = load.clone();
        op.solver.solve_in_place(&mut free);
        let mut surface = &basis.shapes * &free;
        if self.centrifugal {
            surface.axpy(square, &basis.centrifugal_residual, 1.0);
        }
        let rate = free * (op.a0 * op.a0) + inertial;
        let momentum = std::array::from_fn(|k| basis.rigid.column(k).dot(&rate));
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
        new.gemv_tr(1.0, &self.basis.shapes, forces, 1.0);
        for (k, acceleration) in rigid.iter().enumerate() {
            new.axpy(-acceleration, &self.basis.rigid.column(k), 1.0);
        }
        op.solver.solve_in_place(&mut new);
        state.advance(td, new);
    }

    fn energy(&self, state: &BodyState, forces: &DVector<f64>, rigid_velocity: [f64; 3]) -> f64 {
        let basis = &self.basis;
        let modal: f64 = (state.displacement.iter().zip(&basis.squared_frequencies)).map(|(y, w)| w * y * y).sum();
        let residual = forces.dot(&(&basis.residual * forces));
        let kinetic = state.velocity.norm_squared();
        let coupling: f64 =
            rigid_velocity.iter().enumerate().map(|(k, w)| w * basis.rigid.column(k).dot(&state.velocity)).sum();
        0.5 * (modal + residual + kinetic) + coupling
    }
}
