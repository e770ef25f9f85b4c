//! One implicit step of a body, written once for modal and nodal coordinates.
//!
//! With `ẏ = a0 y + h_v` and `ÿ = a0² y + h` ([`BodyState::velocity_offsets`], [`BodyState::acceleration_offsets`]) the
//! momentum balance of [`super::response`] becomes `(a0² M + a0 D + K) y = Sᵀλ − M r_k ẇ_k + load`, where
//! `load = −M h − D (h_v + Ω L y_n) − 2Ω C ẏ_n − Ω̇ C y_n + Ω² S y_n + Ω² M X` is known before the contact is solved.

use super::MechanicsError;
use super::response::{BodyState, Convection, FreeResponse, StepOperator, fit};
use crate::axes::PerAxis;
use crate::linalg::vectorised::dot;
use crate::multistep::TimeDerivative;
use nalgebra::{DMatrix, DVector};

/// The equations of motion of a body in its own coordinates, per metre of width.
pub trait Equations {
    /// `load ← −M a`.
    fn set_inertia(&self, acceleration: &DVector<f64>, load: &mut DVector<f64>);

    /// True if there is a damping matrix.
    fn is_damped(&self) -> bool;

    /// `load ← load − D (v + s L y)` at the stream speed `s` with the deformation `y` of `state`; `velocity` comes as
    /// `v` and is used up.
    fn subtract_damping(&self, speed: f64, state: &BodyState, velocity: &mut DVector<f64>, load: &mut DVector<f64>);

    /// Keeps with a state what damping in the next step and its dissipation need of it.
    fn convect(&self, _state: &mut BodyState) {}

    /// `load ← load − C x`.
    fn subtract_gyroscopic(&self, rate: &DVector<f64>, load: &mut DVector<f64>);

    /// `load ← load + s² (S − B) y`.
    fn add_ale_inertia(&self, square: f64, displacement: &DVector<f64>, load: &mut DVector<f64>);

    /// Centrifugal load `M X` per `Ω²`; `None` if it is switched off.
    fn centrifugal(&self) -> Option<&DVector<f64>>;

    /// `M r_k` of the rigid accelerations, three columns.
    fn rigid(&self) -> &DMatrix<f64>;

    /// Surface displacement of the coordinates `y`, with that of static remainders under the stream speed squared
    /// `square`.
    fn set_surface(&self, y: &DVector<f64>, square: f64, surface: &mut DVector<f64>);

    /// `load ← load + Sᵀ λ`.
    fn add_surface_forces(&self, forces: &DVector<f64>, load: &mut DVector<f64>);
}

/// A deformable body behind the contact; all quantities per metre of width.
pub trait BodyResponse: Equations + Send + Sync {
    /// Number of coordinates in a [`BodyState`] of this body.
    fn state_len(&self) -> usize;

    /// Answer to unit port loads when `ÿ = a0² y + …` (0: static).
    fn operator(&self, a0: f64) -> Result<StepOperator, MechanicsError>;

    /// The part of the answer known before the contact is solved; overwrites `out` and reuses its memory.
    ///
    /// Holds the history of `state`, the centrifugal load (if enabled) and the convective terms of the `stream`,
    /// evaluated with the displacement and velocity of `state`. `op` must come from this body with `a0 = td.a0`.
    fn free_response(
        &self,
        op: &StepOperator,
        state: &BodyState,
        td: &TimeDerivative,
        stream: Convection,
        out: &mut FreeResponse,
    ) {
        let FreeResponse { surface, momentum, load, acceleration, velocity, product } = out;
        state.acceleration_offsets(td, acceleration);
        fit(load, acceleration.len());
        fit(product, acceleration.len());
        self.set_inertia(acceleration, load);
        if self.is_damped() {
            state.velocity_offsets(td, velocity);
            self.subtract_damping(stream.speed, state, velocity, load);
        }
        let square = stream.speed * stream.speed;
        if stream.speed != 0.0 || stream.acceleration != 0.0 {
            let twice = 2.0 * stream.speed;
            let moving = state.velocity.as_slice().iter().zip(state.displacement.as_slice());
            for (rate, (v, y)) in product.as_mut_slice().iter_mut().zip(moving) {
                *rate = v * twice + stream.acceleration * y;
            }
            self.subtract_gyroscopic(product, load);
            self.add_ale_inertia(square, &state.displacement, load);
            if let Some(centrifugal) = self.centrifugal() {
                add_column(square, centrifugal.as_slice(), load);
            }
        }
        product.copy_from(load);
        op.solver.solve_in_place(product);
        self.set_surface(product, square, surface);
        let a0_squared = op.a0 * op.a0;
        for (value, known) in product.as_mut_slice().iter_mut().zip(acceleration.as_slice()) {
            *value = *value * a0_squared + known;
        }
        *momentum = PerAxis::from_fn(|axis| dot(column(self.rigid(), axis.number()), product.as_slice()));
    }

    /// Accepts a step: solves for the new coordinates and writes the state after it into `next`, whose memory is
    /// reused.
    ///
    /// `forces` are the nodal forces on this body (`2n`) [N/m], `rigid` the accelerations `V̇`, `Ü` [m/s²] and `Ω̇`
    /// [rad/s²] of the hub, or those of the base (x, y; the third is ignored); `op`, `free`, `td` and `state` are those
    /// of [`Self::free_response`].
    #[allow(clippy::too_many_arguments)]
    fn commit(
        &self,
        op: &StepOperator,
        free: &FreeResponse,
        forces: &DVector<f64>,
        rigid: PerAxis<f64>,
        td: &TimeDerivative,
        state: &BodyState,
        next: &mut BodyState,
    ) {
        let new = &mut next.displacement;
        fit(new, free.load.len());
        new.copy_from(&free.load);
        self.add_surface_forces(forces, new);
        for (axis, acceleration) in rigid.iter() {
            add_column(-acceleration, column(self.rigid(), axis.number()), new);
        }
        op.solver.solve_in_place(new);
        state.advance(td, next);
        self.convect(next);
    }

    /// Elastic energy + kinetic energy `½ vᵀMv` of the deformation + its coupling `Σ_k w_k r_kᵀ M v` with the rigid
    /// velocities `w = (V, U̇, Ω)`, less the work `Ω² XᵀM y` of the centrifugal load [J/m]; `forces` feed the static
    /// part of a reduced body.
    fn energy(&self, state: &BodyState, forces: &DVector<f64>, rigid_velocity: PerAxis<f64>) -> f64;

    /// Power that damping dissipates and the ends radiate while the material streams with `speed` [W/m]; zero without
    /// damping.
    fn dissipation(&self, state: &BodyState, speed: f64) -> f64;
}

/// Work `Ω² XᵀM y` of the centrifugal load on the deformation, at the angular velocity `omega` [rad/s], in J/m.
pub(super) fn centrifugal_work(body: &impl Equations, state: &BodyState, omega: f64) -> f64 {
    body.centrifugal().map_or(0.0, |load| omega * omega * load.dot(&state.displacement))
}

/// `out ← out + factor · x`.
fn add_column(factor: f64, x: &[f64], out: &mut DVector<f64>) {
    out.as_mut_slice().iter_mut().zip(x).for_each(|(out, x)| *out += factor * x);
}

/// A column of a matrix.
pub(super) fn column(a: &DMatrix<f64>, j: usize) -> &[f64] {
    &a.as_slice()[j * a.nrows()..(j + 1) * a.nrows()]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::{Cholesky, CsrMatrix, lowest_modes};
    use crate::mechanics::Ends;
    use crate::mechanics::testing::{committed, free, paper_d};
    use crate::mechanics::{BodyDamping, BodySystem, FullBody, ReducedBasis, ReducedBody};
    use crate::mechanics::{rail_system, wheel_system};

    /// Trapezoidal rule.
    fn trapezoidal(dt: f64) -> TimeDerivative {
        TimeDerivative { a0: 2.0 / dt, a1: -2.0 / dt, a2: 0.0, b1: -1.0 }
    }

    /// A body reduced to `modes` and full.
    fn pair(system: BodySystem, modes: usize) -> [Box<dyn BodyResponse>; 2] {
        let basis = ReducedBasis::compute(&system, modes, &mut |_| {}).unwrap();
        [Box::new(ReducedBody::new(basis, false, &BodyDamping::NONE)), Box::new(FullBody::new(system, false).unwrap())]
    }

    /// The next state under surface forces, without convection and rigid motion.
    fn after(
        body: &dyn BodyResponse,
        op: &StepOperator,
        state: &BodyState,
        td: &TimeDerivative,
        forces: &DVector<f64>,
    ) -> BodyState {
        let known = free(body, op, state, td, Convection::default());
        committed(body, op, &known, forces, PerAxis::default(), td, state)
    }

    /// Rail whose ends swallow plane waves.
    fn rail_with_quiet_ends() -> BodySystem {
        let mut bodies = paper_d(4);
        bodies.rail_ends = Ends::Nonreflecting;
        rail_system(&bodies).unwrap()
    }

    /// Wheel with one dashpot between its hub and the middle of its surface.
    fn wheel_with_a_dashpot() -> BodySystem {
        let system = wheel_system(&paper_d(4)).unwrap();
        let (n, middle) = (system.unknowns(), system.surface.len() / 2);
        let at = |component: usize| system.surface[middle / 2 * 2 + component];
        let triplets = [0, 1].map(|component| (at(component), at(component), 3e5));
        BodySystem { damping: Some(CsrMatrix::from_triplets(n, n, &triplets).unwrap()), ..system }
    }

    /// `D = α M` damps every mode alike: `q = e^{−αt/2} (cos ω t + α/2ω sin ω t)`, `ω² = Ω² − α²/4`. The trapezoidal
    /// rule replaces `e^{λ Δt}`, `λ = −α/2 + iω`, by `z = (2 + λ Δt)/(2 − λ Δt)`, with the same factors of the two
    /// terms.
    #[test]
    fn a_damped_mode_decays_as_its_closed_form() {
        let mut system = rail_system(&paper_d(4)).unwrap();
        let factor = Cholesky::new(&system.stiffness).unwrap();
        let modes = lowest_modes(&factor, &system.mass, 6, &mut |_| {}).unwrap();
        let square = modes.squared_frequencies[0];
        let alpha = 0.1 * square.sqrt();
        system.damping = Some(CsrMatrix::combination(alpha, &system.mass, 0.0, &system.mass).unwrap());
        let omega = (square - 0.25 * alpha * alpha).sqrt();
        let dt = 0.02 / omega;
        let td = trapezoidal(dt);
        let shape = modes.shapes.column(0).into_owned();
        let unit = DVector::from_fn(6, |i, _| f64::from(i == 0));
        for (body, shape) in pair(system, 6).iter().zip([unit, shape]) {
            let op = body.operator(td.a0).unwrap();
            let none = DVector::zeros(op.surface.nrows());
            let mut state = BodyState::zeros(body.state_len());
            state.displacement = shape.clone();
            state.acceleration = &shape * -square;
            let (re, im) = (2.0 - 0.5 * alpha * dt, omega * dt);
            let back = 2.0 + 0.5 * alpha * dt;
            let size = (re * re + im * im).sqrt() / (back * back + im * im).sqrt();
            let angle = im.atan2(re) + im.atan2(back);
            let form = |k: f64, decay: f64, phase: f64| {
                decay.powf(k) * ((k * phase).cos() + 0.5 * alpha / omega * (k * phase).sin())
            };
            let at = shape.iamax();
            for k in 1..=1000 {
                state = after(body.as_ref(), &op, &state, &td, &none);
                let (found, k) = (state.displacement[at] / shape[at], f64::from(k));
                let discrete = form(k, size, angle);
                assert!((found - discrete).abs() < 1e-8, "step {k}: {found} against {discrete}");
                let exact = form(k, (-0.5 * alpha * dt).exp(), omega * dt);
                assert!((found - exact).abs() < 1e-3, "step {k}: {found} against {exact}");
            }
        }
    }

    /// The trapezoidal rule conserves exactly: what the energy loses in a step is `Δt` times the dissipation at the
    /// mean of the velocities at both ends.
    #[test]
    fn energy_that_dashpots_take_is_what_the_body_loses() {
        for (name, system) in [("rail", rail_with_quiet_ends()), ("wheel", wheel_with_a_dashpot())] {
            for body in pair(system, 20) {
                let body = body.as_ref();
                let still = body.operator(0.0).unwrap();
                let ports = still.surface.nrows();
                let forces = DVector::from_fn(ports, |i, _| if i.abs_diff(ports / 2) < 4 { -2e4 } else { 0.0 });
                let state = BodyState::zeros(body.state_len());
                let loaded = after(body, &still, &state, &TimeDerivative::default(), &forces);
                assert_eq!(body.dissipation(&loaded, 0.0), 0.0);
                // A short step of backward Euler supplies the acceleration after the release.
                let (start, none) = (TimeDerivative { a0: 1e7, a1: -1e7, a2: 0.0, b1: 0.0 }, DVector::zeros(ports));
                let mut state = after(body, &body.operator(start.a0).unwrap(), &loaded, &start, &none);
                let dt = 4e-5;
                let td = trapezoidal(dt);
                let op = body.operator(td.a0).unwrap();
                let initial = body.energy(&state, &none, PerAxis::default());
                let mut dissipated = 0.0;
                for _ in 0..100 {
                    let next = after(body, &op, &state, &td, &none);
                    let velocity = 0.5 * (&state.velocity + &next.velocity);
                    let step = dt * body.dissipation(&BodyState { velocity, ..next.clone() }, 0.0);
                    assert!(step >= 0.0);
                    dissipated += step;
                    state = next;
                }
                let lost = initial - body.energy(&state, &none, PerAxis::default());
                println!(
                    "{name}: {:.3} of the energy lost, imbalance {:.1e}",
                    lost / initial,
                    (lost - dissipated) / initial
                );
                assert!((lost - dissipated).abs() < 1e-9 * initial && lost > 0.05 * initial);
            }
        }
    }

    /// The modes that are left out have no damping: what a reduced body misses of a dashpot vanishes with more modes.
    #[test]
    fn damped_reduced_body_converges_to_the_full_one_with_its_modes() {
        let full = FullBody::new(rail_with_quiet_ends(), false).unwrap().operator(1.5e3).unwrap();
        let error = |modes: usize| {
            let basis = ReducedBasis::compute(&rail_with_quiet_ends(), modes, &mut |_| {}).unwrap();
            let reduced = ReducedBody::new(basis, false, &BodyDamping::NONE).operator(1.5e3).unwrap();
            (reduced.surface - &full.surface).amax() / full.surface.amax()
        };
        let errors = [15, 60, 240].map(error);
        println!("errors with 15, 60 and 240 modes: {errors:?}");
        assert!(errors[1] < 0.5 * errors[0] && errors[2] < 0.5 * errors[1]);
    }
}
