//! What the contact sees of a deformable body: one interface for the reduced and the full finite-element model.
//!
//! A body is a linear system with *ports*: the Cartesian displacement components of its surface nodes near the contact
//! (node-major, `2·node + component`, x ascending) and, for the wheel, the three rigid accelerations of its hub
//! (`V̇`, `Ü`, `Ω̇`; Ω positive for forward rolling, rigid field `r_Ω = (y, −x)`), whose conjugates are the rates of
//! deformation momentum `r_kᵀ M ÿ`. Displacements `y` are relative to the rigid hub (wheel) or base (rail).
//! Everything is per metre of width.
//!
//! Momentum balance of the wheel (Paper D, eq. 9) after discretisation in space, with `C = ρ∫ w·∂u`,
//! `S = ρ∫ ∂w·∂u` and `∂ = v̄·∇/speed` the derivative along the streamlines (`−∂_φ` in the wheel, `−∂_x` in the rail):
//!
//! `M ÿ + 2Ω C ẏ + Ω̇ C y − Ω² S y + K y = Sᵀλ + Ω² M X − M (r_x V̇ + r_y Ü + r_Ω Ω̇)`.
//!
//! The rail has the same form with `V` in place of `Ω`, no rigid ports, no centrifugal load and the in/outflow (Robin)
//! term of Paper B, eq. 12. The convective terms are small, so they are evaluated on a known state (`convected`).

use super::MechanicsError;
use crate::linalg::Cholesky;
use crate::multistep::TimeDerivative;
use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

/// A deformable body behind the contact; all quantities per metre of width.
pub trait BodyResponse: Send + Sync {
    /// Number of coordinates in a [`BodyState`] of this body.
    fn state_len(&self) -> usize;

    /// Answer to unit port loads when `ÿ = a0² y + …` (0: static).
    fn operator(&self, a0: f64) -> Result<StepOperator, MechanicsError>;

    /// The part of the answer known before the contact is solved.
    ///
    /// Holds the history of `state`, the centrifugal load (if enabled) and the convective terms, evaluated with the
    /// displacement and velocity of `convected`. `op` must come from this body with `a0 = td.a0`.
    fn free(
        &self,
        op: &StepOperator,
        state: &BodyState,
        td: &TimeDerivative,
        convection: Convection,
        convected: &BodyState,
    ) -> FreeResponse;

    /// Accepts a step: solves for the new coordinates and advances `state`.
    ///
    /// `forces` are the nodal forces on this body (`2n`) [N/m], `rigid` the accelerations `V̇`, `Ü` [m/s²] and `Ω̇`
    /// [rad/s²] (ignored by the rail).
    fn commit(
        &self,
        op: &StepOperator,
        free: &FreeResponse,
        forces: &DVector<f64>,
        rigid: [f64; 3],
        td: &TimeDerivative,
        state: &mut BodyState,
    );

    /// Elastic energy + kinetic energy `½ vᵀMv` of the deformation + its coupling `Σ_k w_k r_kᵀ M v` with the rigid
    /// velocities `w = (V, U̇, Ω)` [J/m]; `forces` feed the static part of a reduced body.
    fn energy(&self, state: &BodyState, forces: &DVector<f64>, rigid_velocity: [f64; 3]) -> f64;
}

/// Speed and acceleration of the material stream: `(Ω, Ω̇)` for the wheel, `(V, V̇)` for the rail.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Convection {
    pub speed: f64,
    pub acceleration: f64,
}

/// Deformation of one body and the history its time discretisation needs; coordinates are modal or nodal.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BodyState {
    /// Coordinates `y`.
    pub displacement: DVector<f64>,
    /// `d_t y`.
    pub velocity: DVector<f64>,
    /// `d_tt y`.
    pub acceleration: DVector<f64>,
    /// `y` one step earlier.
    pub displacement_before: DVector<f64>,
    /// `d_t y` one step earlier.
    pub velocity_before: DVector<f64>,
}

impl BodyState {
    /// The undeformed body at rest with `n` coordinates.
    pub fn zeros(n: usize) -> Self {
        let z = DVector::zeros(n);
        Self {
            displacement: z.clone(),
            velocity: z.clone(),
            acceleration: z.clone(),
            displacement_before: z.clone(),
            velocity_before: z,
        }
    }

    /// The part of `d_tt y` known before the step: `a0 h_v + h_a` with the offsets of velocity and acceleration.
    pub fn acceleration_offsets(&self, td: &TimeDerivative) -> DVector<f64> {
        let mut sum = offsets(td, &self.velocity, &self.velocity_before, &self.acceleration);
        sum.axpy(td.a0, &offsets(td, &self.displacement, &self.displacement_before, &self.velocity), 1.0);
        sum
    }

    /// Moves on to the displacement `new`; velocity and acceleration follow from `td`, the histories shift.
    ///
    /// Stationary: velocity and acceleration vanish and the history is the new displacement.
    pub fn advance(&mut self, td: &TimeDerivative, new: DVector<f64>) {
        let mut velocity = offsets(td, &self.displacement, &self.displacement_before, &self.velocity);
        velocity.axpy(td.a0, &new, 1.0);
        let mut acceleration = offsets(td, &self.velocity, &self.velocity_before, &self.acceleration);
        acceleration.axpy(td.a0, &velocity, 1.0);
        if td.is_stationary() {
            self.displacement_before = new.clone();
            self.velocity_before = velocity.clone();
        } else {
            self.displacement_before = std::mem::take(&mut self.displacement);
            self.velocity_before = std::mem::take(&mut self.velocity);
        }
        self.displacement = new;
        self.velocity = velocity;
        self.acceleration = acceleration;
    }
}

/// Part of `d_t y` known before the step, of all coordinates.
fn offsets(td: &TimeDerivative, now: &DVector<f64>, before: &DVector<f64>, rate: &DVector<f64>) -> DVector<f64> {
    let mut sum = now * td.a1;
    sum.axpy(td.a2, before, 1.0);
    sum.axpy(td.b1, rate, 1.0);
    sum
}

/// Answer of a body to unit port loads for one value of `a0` (0: static).
pub struct StepOperator {
    pub a0: f64,
    /// Surface displacement per unit nodal force, symmetric, `2n × 2n` [m/(N/m)].
    pub surface: DMatrix<f64>,
    /// Surface displacement per unit rigid acceleration (V̇, Ü, Ω̇), `2n × 3`; zero for the rail.
    pub loads: DMatrix<f64>,
    /// Rate of deformation momentum per unit nodal force, `3 × 2n`.
    pub momentum: DMatrix<f64>,
    /// Rate of deformation momentum per unit rigid acceleration, `3 × 3`.
    pub momentum_loads: DMatrix<f64>,
    /// What the implementation keeps to solve with (modal denominators or a sparse factorisation).
    pub solver: StepSolver,
}

/// Part of a body's answer that is known before the contact is solved.
pub struct FreeResponse {
    /// Surface displacement without contact forces and rigid accelerations, `2n` [m].
    pub surface: DVector<f64>,
    /// Rate of deformation momentum (x, y, Ω) without contact forces and rigid accelerations.
    pub momentum: [f64; 3],
    /// Right-hand side in the body's own coordinates, for `commit`.
    pub load: DVector<f64>,
}

/// How a step's equations `(a0² M + K) y = f` are solved.
pub enum StepSolver {
    /// `1/(a0² + Ω²)` of each mode.
    Modal(DVector<f64>),
    /// Sparse Cholesky factor.
    Sparse(Cholesky),
}

impl StepSolver {
    /// `f ← (a0² M + K)⁻¹ f`.
    pub fn solve_in_place(&self, f: &mut DVector<f64>) {
        match self {
            Self::Modal(flexibility) => f.component_mul_assign(flexibility),
            Self::Sparse(factor) => factor.solve_in_place(f.as_mut_slice()),
        }
    }
}
