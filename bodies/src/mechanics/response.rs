//! Response of a deformable body to the contact: one interface for the reduced and the full finite-element model.
//!
//! A body is a linear system with *ports*: the Cartesian displacement components of its surface nodes near the contact
//! (node-major, `2·node + component`, x ascending) and the rigid accelerations of hub (`V̇`, `Ü`, `Ω̇`; Ω positive for
//! forward rolling, rigid field `r_Ω = (y, −x)`) or base (x, y), whose conjugates are the rates of
//! deformation momentum `r_kᵀ M ÿ`. Displacements `y` are relative to the rigid hub (wheel) or base (rail).
//! Everything is per metre of width.
//!
//! Momentum balance of the wheel (Paper D, eq. 9) after discretisation in space, with `C = ρ∫ w·∂u`,
//! `S = ρ∫ ∂w·∂u`, `∂ = v̄·∇/speed` the derivative along the streamlines (`−∂_φ` in the wheel, `−∂_x` in the rail) and
//! the damping `D`, symmetric and positive semidefinite, on the rate of the material (`L`: see [`super::damping`]):
//!
//! `M ÿ + D (ẏ + Ω L y) + 2Ω C ẏ + Ω̇ C y − Ω² S y + K y = Sᵀλ + Ω² M X − M (r_x V̇ + r_y Ü + r_Ω Ω̇)`.
//!
//! The rail has the same form with `V` in place of `Ω`, the acceleration of its base, no centrifugal load and the
//! in/outflow (Robin) term of Paper B, eq. 12. The convective terms are small, so they are evaluated on the state
//! before the step.

pub(super) use super::products::fit;
use super::solver::StepSolver;
use crate::axes::PerAxis;
use crate::multistep::TimeDerivative;
use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

/// Speed and acceleration of the material stream: `(Ω, Ω̇)` for the wheel, `(V, V̇)` for the rail.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Convection {
    /// `Ω` [rad/s] or `V` [m/s].
    pub speed: f64,
    /// `Ω̇` [rad/s²] or `V̇` [m/s²].
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
    /// `L y`, the part of the material's rate of deformation by a stream of speed 1, after steps of modes that are damped;
    /// otherwise empty.
    pub convected: DVector<f64>,
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
            convected: DVector::zeros(0),
        }
    }

    /// Displacement, velocity, acceleration, and the first two one step earlier, all of one length.
    fn slices(&self) -> [&[f64]; 5] {
        let Self { displacement, velocity, acceleration, displacement_before, velocity_before, .. } = self;
        let all = [displacement, velocity, acceleration, displacement_before, velocity_before];
        all.map(|values| &values.as_slice()[..displacement.len()])
    }

    /// Writes the part of `d_t y` known before the step into `out`.
    pub fn velocity_offsets(&self, td: &TimeDerivative, out: &mut DVector<f64>) {
        let [y, v, _, y_before, _] = self.slices();
        fit(out, y.len());
        for (i, value) in out.as_mut_slice()[..y.len()].iter_mut().enumerate() {
            *value = td.offset(y[i], y_before[i], v[i]);
        }
    }

    /// Writes the part of `d_tt y` known before the step into `out`: `a0 h_v + h_a` with the offsets of velocity and
    /// acceleration.
    pub fn acceleration_offsets(&self, td: &TimeDerivative, out: &mut DVector<f64>) {
        let [y, v, a, y_before, v_before] = self.slices();
        fit(out, y.len());
        for (i, value) in out.as_mut_slice()[..y.len()].iter_mut().enumerate() {
            *value = td.a0 * td.offset(y[i], y_before[i], v[i]) + td.offset(v[i], v_before[i], a[i]);
        }
    }

    /// Completes `next`, whose displacement is that at the end of a step from this state: velocity and acceleration
    /// follow from `td`, the histories shift.
    ///
    /// Stationary: velocity and acceleration vanish and the history is the new displacement.
    pub fn advance(&self, td: &TimeDerivative, next: &mut Self) {
        let [y, v, a, y_before, v_before] = self.slices();
        let n = y.len();
        let Self { displacement, velocity, acceleration, displacement_before, velocity_before, .. } = next;
        for values in [&mut *velocity, &mut *acceleration, &mut *displacement_before, &mut *velocity_before] {
            fit(values, n);
        }
        let displacement = &displacement.as_slice()[..n];
        let [velocity, acceleration] = [velocity, acceleration].map(|values| &mut values.as_mut_slice()[..n]);
        for i in 0..n {
            velocity[i] = td.a0 * displacement[i] + td.offset(y[i], y_before[i], v[i]);
            acceleration[i] = td.a0 * velocity[i] + td.offset(v[i], v_before[i], a[i]);
        }
        let stationary = td.is_stationary();
        displacement_before.as_mut_slice().copy_from_slice(if stationary { displacement } else { y });
        velocity_before.as_mut_slice().copy_from_slice(if stationary { velocity } else { v });
    }
}

/// Answer of a body to unit port loads for one value of `a0` (0: static).
pub struct StepOperator {
    /// Weight of the new value in the time formula [1/s].
    pub a0: f64,
    /// Surface displacement per unit nodal force, symmetric, `2n × 2n` [m/(N/m)].
    pub surface: DMatrix<f64>,
    /// Surface displacement per unit rigid acceleration (V̇, Ü, Ω̇), `2n × 3`; the third is zero for the rail.
    pub inertial_response: DMatrix<f64>,
    /// Rate of deformation momentum per unit nodal force, `3 × 2n`.
    pub momentum: DMatrix<f64>,
    /// Rate of deformation momentum per unit rigid acceleration, `3 × 3`.
    pub deformation_inertia: DMatrix<f64>,
    /// Solves the equations of the step.
    pub solver: Box<dyn StepSolver>,
}

/// Part of a body's answer that is known before the contact is solved.
#[derive(Clone, Debug)]
pub struct FreeResponse {
    /// Surface displacement without contact forces and rigid accelerations, `2n` \[m].
    pub surface: DVector<f64>,
    /// Rate of deformation momentum (x, y, Ω) without contact forces and rigid accelerations.
    pub momentum: PerAxis<f64>,
    /// Right-hand side in the body's own coordinates, for [`super::BodyResponse::commit`].
    pub load: DVector<f64>,
    /// Scratch: what is known of acceleration and velocity, and a vector for products.
    pub(super) acceleration: DVector<f64>,
    pub(super) velocity: DVector<f64>,
    pub(super) product: DVector<f64>,
}

impl Default for BodyState {
    fn default() -> Self {
        Self::zeros(0)
    }
}

impl Default for FreeResponse {
    /// Buffers that take their size at the first use.
    fn default() -> Self {
        let empty = || DVector::zeros(0);
        let (surface, load, acceleration, velocity, product) = (empty(), empty(), empty(), empty(), empty());
        Self { surface, momentum: PerAxis::default(), load, acceleration, velocity, product }
    }
}
