//! A body as vibration modes plus residual flexibility.
//!
//! `y = Φ q + (static answer of the truncated modes)`: with hub or base fixed, `Φᵀ M Φ = 1`, `Φᵀ K Φ = diag(Ω²)`, the
//! surface displacement is `u = Φ_s q + F_res λ + …` with `F_res = G − Φ_s Ω⁻² Φ_sᵀ` and `G` the static compliance. The
//! static limit is exact; the truncated modes lie above the band of interest and follow their load at once. Ratios of modes
//! leave the kept modes uncoupled; dashpots couple them by `Φᵀ D Φ` and take no energy from the truncated ones.
//!
//! This is MacNeal's method: R. H. MacNeal, *Computers & Structures* 1 (1971) 581–601, there for free interfaces with
//! rigid modes, which hub and base take away here. Rubin's (*AIAA Journal* 13 (1975) 995–1006) would add the inertia of
//! the truncated modes to second order. Both: Craig & Kurdila, *Fundamentals of Structural Dynamics*, 2nd ed. (2006),
//! ch. 17.

use super::MechanicsError;
use super::damping::BodyDamping;
use super::kinds::ModeKinds;
use super::motion::{BodyResponse, Equations, centrifugal_work, column};
use super::products::{add_product, quadratic_form};
use super::reduction::{ReducedBasis, scale_columns};
use super::response::{BodyState, StepOperator, fit};
use super::solver::{Dense, Diagonal, StepSolver};
use crate::axes::{Axis, PerAxis};
use crate::linalg::dense::symmetrise;
use crate::linalg::vectorised::{self, dot};
use nalgebra::{DMatrix, DVector};
use std::borrow::Cow;

/// State: modal coordinates.
pub struct ReducedBody {
    /// Modes, kind by kind, and what else is constant.
    basis: ReducedBasis,
    kinds: ModeKinds,
    /// Surface values of the modes, a column for each port.
    by_port: DMatrix<f64>,
    /// Centrifugal load of the spinning wheel.
    centrifugal: bool,
    /// Damping of each mode; `None`: by dashpots at most.
    modal: Option<ModalRates>,
}

/// Damping that does not couple the modes.
struct ModalRates {
    /// `2 ζ ω` [1/s].
    rates: DVector<f64>,
    /// `Φᵀ T Φ`.
    transport: DMatrix<f64>,
}

impl ModalRates {
    /// Power that the damping of the modes takes while the stream adds `speed` times the `convected` rates [W/m].
    fn dissipation(&self, velocity: &[f64], speed: f64, convected: &[f64]) -> f64 {
        let of_material = velocity.iter().zip(convected).map(|(v, convected)| v + speed * convected);
        self.rates.as_slice().iter().zip(of_material).map(|(rate, v)| rate * v * v).sum()
    }
}

/// Solutions with the matrix `A = a0² + a0 D + diag(Ω²)` of a step.
struct Factorised {
    solver: Box<dyn StepSolver>,
    /// `Φ_s A⁻¹ Φ_sᵀ`.
    flexibility: DMatrix<f64>,
    /// `A⁻¹ Φᵀ M r_k`.
    answer: DMatrix<f64>,
}

impl ReducedBody {
    /// A body of these modes; `centrifugal`: with the load of the spinning wheel.
    pub fn new(basis: ReducedBasis, centrifugal: bool, damping: &BodyDamping) -> Self {
        let (kinds, basis) = basis.by_kinds();
        let (squares, character) = (&basis.squared_frequencies, &basis.character);
        let modal = (!damping.is_none())
            .then(|| ModalRates { rates: damping.modal(squares, character), transport: character.transport.clone() });
        Self { by_port: basis.shapes.transpose(), basis, kinds, centrifugal, modal }
    }

    /// Rates of the modes by a stream of speed 1, as they were kept or anew.
    fn convected<'a>(&self, modal: &ModalRates, state: &'a BodyState) -> Cow<'a, [f64]> {
        if state.convected.len() == state.displacement.len() {
            return Cow::Borrowed(state.convected.as_slice());
        }
        let mut convected = DVector::zeros(0);
        self.write_convected(modal, state, &mut convected);
        Cow::Owned(convected.as_slice().to_vec())
    }

    fn write_convected(&self, modal: &ModalRates, state: &BodyState, out: &mut DVector<f64>) {
        fit(out, self.basis.modes());
        out.fill(0.0);
        self.kinds.add_odd(1.0, &modal.transport, &state.displacement, out);
    }

    fn factorised(&self, a0: f64) -> Result<Factorised, MechanicsError> {
        let ReducedBasis { squared_frequencies, shapes, rigid, damping, .. } = &self.basis;
        let square = a0 * a0;
        let mut diagonal = squared_frequencies.map(|w| square + w);
        if let Some(modal) = &self.modal {
            diagonal.axpy(a0, &modal.rates, 1.0);
        }
        let Some(damping) = damping else {
            let inverse = diagonal.map(|value| 1.0 / value);
            let mut flexibility = scale_columns(shapes, &inverse) * &self.by_port;
            symmetrise(&mut flexibility);
            let answer = DMatrix::from_fn(self.basis.modes(), Axis::COUNT, |i, k| inverse[i] * rigid[(i, k)]);
            return Ok(Factorised { solver: Box::new(Diagonal { inverse }), flexibility, answer });
        };
        let mut matrix = damping * a0;
        matrix.set_diagonal(&(matrix.diagonal() + diagonal));
        let solver = Dense::new(matrix)?;
        let mut flexibility = shapes * solver.solve(&self.by_port);
        symmetrise(&mut flexibility);
        let answer = solver.solve(rigid);
        Ok(Factorised { solver: Box::new(solver), flexibility, answer })
    }
}

impl Equations for ReducedBody {
    fn set_inertia(&self, acceleration: &DVector<f64>, load: &mut DVector<f64>) {
        load.as_mut_slice().iter_mut().zip(acceleration.as_slice()).for_each(|(load, a)| *load = -a);
    }

    fn is_damped(&self) -> bool {
        self.modal.is_some() || self.basis.damping.is_some()
    }

    fn subtract_damping(&self, speed: f64, state: &BodyState, velocity: &mut DVector<f64>, load: &mut DVector<f64>) {
        if let Some(damping) = &self.basis.damping {
            add_product(-1.0, damping, velocity, load);
        }
        if let Some(modal) = &self.modal {
            if speed != 0.0 {
                let convected = self.convected(modal, state);
                velocity
                    .as_mut_slice()
                    .iter_mut()
                    .zip(convected.iter())
                    .for_each(|(v, convected)| *v += speed * convected);
            }
            let rates = modal.rates.as_slice().iter().zip(velocity.as_slice());
            load.as_mut_slice().iter_mut().zip(rates).for_each(|(load, (rate, v))| *load -= rate * v);
        }
    }

    fn convect(&self, state: &mut BodyState) {
        let Some(modal) = &self.modal else { return };
        let mut convected = std::mem::take(&mut state.convected);
        self.write_convected(modal, state, &mut convected);
        state.convected = convected;
    }

    fn subtract_gyroscopic(&self, rate: &DVector<f64>, load: &mut DVector<f64>) {
        self.kinds.add_odd(-1.0, &self.basis.gyroscopic, rate, load);
    }

    fn add_ale_inertia(&self, square: f64, displacement: &DVector<f64>, load: &mut DVector<f64>) {
        self.kinds.add_even(square, &self.basis.ale_inertia, displacement, load);
    }

    fn centrifugal(&self) -> Option<&DVector<f64>> {
        self.centrifugal.then_some(&self.basis.centrifugal)
    }

    fn rigid(&self) -> &DMatrix<f64> {
        &self.basis.rigid
    }

    fn set_surface(&self, y: &DVector<f64>, square: f64, surface: &mut DVector<f64>) {
        fit(surface, self.basis.shapes.nrows());
        surface.fill(0.0);
        add_product(1.0, &self.basis.shapes, y, surface);
        if self.centrifugal {
            surface.axpy(square, &self.basis.centrifugal_residual, 1.0);
        }
    }

    fn add_surface_forces(&self, forces: &DVector<f64>, load: &mut DVector<f64>) {
        add_product(1.0, &self.by_port, forces, load);
    }
}

impl BodyResponse for ReducedBody {
    fn state_len(&self) -> usize {
        self.basis.modes()
    }

    fn operator(&self, a0: f64) -> Result<StepOperator, MechanicsError> {
        let basis = &self.basis;
        let Factorised { solver, flexibility: mut surface, answer } = self.factorised(a0)?;
        vectorised::add_columns(1.0, basis.residual.as_slice(), surface.len(), &[1.0], surface.as_mut_slice());
        let mut modal = DMatrix::zeros(basis.shapes.nrows(), Axis::COUNT);
        let ports = modal.nrows();
        for (modal, answer) in modal.as_mut_slice().chunks_exact_mut(ports.max(1)).zip(answer.column_iter()) {
            vectorised::add_columns(1.0, basis.shapes.as_slice(), ports, answer.as_slice(), modal);
        }
        let square = a0 * a0;
        let momentum = modal.transpose() * square;
        let inertial_response = -(modal + &basis.rigid_residual);
        let deformation_inertia = basis.rigid.tr_mul(&answer) * -square;
        Ok(StepOperator { a0, surface, inertial_response, momentum, deformation_inertia, solver })
    }

    fn energy(&self, state: &BodyState, forces: &DVector<f64>, rigid_velocity: PerAxis<f64>) -> f64 {
        let basis = &self.basis;
        let (y, v) = (state.displacement.as_slice(), state.velocity.as_slice());
        let modal: f64 = y.iter().zip(basis.squared_frequencies.as_slice()).map(|(y, w)| w * y * y).sum();
        let residual = quadratic_form(&basis.residual, forces);
        let kinetic = dot(v, v);
        let coupling: f64 =
            rigid_velocity.iter().map(|(axis, w)| w * dot(column(&basis.rigid, axis.number()), v)).sum();
        0.5 * (modal + residual + kinetic) + coupling - centrifugal_work(self, state, rigid_velocity.rotation)
    }

    fn dissipation(&self, state: &BodyState, speed: f64) -> f64 {
        let damping = self.basis.damping.as_ref();
        let dashpots = damping.map_or(0.0, |damping| quadratic_form(damping, &state.velocity));
        let modes = self
            .modal
            .as_ref()
            .map_or(0.0, |modal| modal.dissipation(state.velocity.as_slice(), speed, &self.convected(modal, state)));
        dashpots + modes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    use crate::mechanics::testing::{committed, free, paper_d};
    use crate::mechanics::{Convection, FullBody, rail_system, wheel_system};
    use crate::multistep::TimeDerivative;

    /// Wheel and rail, each reduced to `modes` and full.
    fn pairs(modes: usize) -> [(ReducedBody, FullBody); 2] {
        let bodies = paper_d(5);
        [(wheel_system(&bodies).unwrap(), true), (rail_system(&bodies).unwrap(), false)].map(|(system, centrifugal)| {
            let basis = ReducedBasis::compute(&system, modes, &mut |_| {}).unwrap();
            (ReducedBody::new(basis, centrifugal, &BodyDamping::NONE), FullBody::new(system, centrifugal).unwrap())
        })
    }

    fn difference(a: &DMatrix<f64>, b: &DMatrix<f64>) -> f64 {
        (a - b).amax() / b.amax().max(f64::MIN_POSITIVE)
    }

    /// Pressure and shear on the middle of the surface [N/m].
    fn load(ports: usize, normal: f64, shear: f64) -> DVector<f64> {
        let middle = ports as f64 / 4.0;
        DVector::from_fn(ports, |i, _| {
            let s = ((i / 2) as f64 - middle + 0.5) / 5.0;
            let shape = (1.0 - s * s).max(0.0).sqrt();
            shape * if i % 2 == 1 { normal } else { shear }
        })
    }

    #[test]
    fn reduced_body_is_exact_in_statics() {
        for (reduced, full) in pairs(12) {
            let (r, f) = (reduced.operator(0.0).unwrap(), full.operator(0.0).unwrap());
            assert!(difference(&r.surface, &f.surface) < 1e-9);
            assert!(difference(&r.inertial_response, &f.inertial_response) < 1e-9);
            assert!(r.momentum.amax() == 0.0 && r.deformation_inertia.amax() == 0.0);
            let (td, rest) = (TimeDerivative::default(), Convection { speed: 80.0, acceleration: 0.0 });
            let (sr, sf) = (BodyState::zeros(reduced.state_len()), BodyState::zeros(full.state_len()));
            let centrifugal = [free(&reduced, &r, &sr, &td, rest), free(&full, &f, &sf, &td, rest)];
            let error = (&centrifugal[0].surface - &centrifugal[1].surface).amax();
            assert!(error <= 1e-9 * centrifugal[1].surface.amax(), "{error:e}");
        }
    }

    /// Tolerances for the momentum of deformation of wheel and rail: the truncated modes carry the rest. Those of the
    /// rail are many, but the momentum of its deformation is a small part of that of its base.
    const MOMENTUM: [f64; 2] = [2e-3, 2e-2];

    /// Tolerance: 1e-4 of the largest compliance at 1500/s.
    #[test]
    fn reduced_and_full_bodies_answer_a_step_alike() {
        for ((reduced, full), tolerance) in pairs(40).into_iter().zip(MOMENTUM) {
            let (r, f) = (reduced.operator(1.5e3).unwrap(), full.operator(1.5e3).unwrap());
            let differences = [
                difference(&r.surface, &f.surface),
                difference(&r.inertial_response, &f.inertial_response),
                difference(&r.momentum, &f.momentum),
                difference(&r.deformation_inertia, &f.deformation_inertia),
            ];
            println!("{differences:?}");
            assert!(differences[0] < 1e-4 && differences[1] < 1e-4);
            assert!(differences[2] < 0.5 * tolerance && differences[3] < 0.5 * tolerance);
            // Reciprocity of the ports.
            let reciprocal = f.inertial_response.transpose() * -1.5e3_f64.powi(2);
            assert!((&f.momentum - reciprocal).amax() < 1e-12 * f.momentum.amax());
        }
    }

    /// 24 BDF2 steps of 0.5 ms of a rolling body under a ramped load; tolerance 1e-3 of the largest displacement.
    #[test]
    fn reduced_and_full_bodies_move_alike() {
        let dt = 5e-4;
        let td = TimeDerivative { a0: 1.5 / dt, a1: -2.0 / dt, a2: 0.5 / dt, b1: 0.0 };
        for ((reduced, full), tolerance) in pairs(40).into_iter().zip(MOMENTUM) {
            let mut histories = Vec::new();
            for body in [&reduced as &dyn BodyResponse, &full] {
                let op = body.operator(td.a0).unwrap();
                let mut state = BodyState::zeros(body.state_len());
                let mut history = Vec::new();
                for step in 0..40 {
                    let t = (step + 1) as f64 * dt;
                    let forces = load(op.surface.nrows(), -2e4 * (t / 5e-3).min(1.0), 3e3 * (800.0 * t).sin());
                    let rising = (t / 5e-3).min(1.0);
                    let rigid = PerAxis { travel: 2.0 * rising, rotation: -30.0 * rising, ..PerAxis::default() };
                    let convection = Convection { speed: 30.0 + t, acceleration: 1.0 };
                    let free = free(body, &op, &state, &td, convection);
                    let surface = &free.surface
                        + &op.surface * &forces
                        + &op.inertial_response * DVector::from_row_slice(&rigid.values());
                    let momentum = DVector::from_row_slice(&free.momentum.values())
                        + &op.momentum * &forces
                        + &op.deformation_inertia * DVector::from_row_slice(&rigid.values());
                    state = committed(body, &op, &free, &forces, rigid, &td, &state);
                    // The predicted rate of momentum is r_kᵀ M ÿ of the accepted state.
                    let rate = BodyState { velocity: state.acceleration.clone(), ..state.clone() };
                    // What is odd in the rigid velocities; the work of the centrifugal load is even.
                    let energy = |w: PerAxis<f64>| body.energy(&rate, &forces, w);
                    let coupled = |w: PerAxis<f64>| 0.5 * (energy(w) - energy(w.map(|w| -w)));
                    for axis in Axis::ALL {
                        let w = PerAxis::unit(axis).map(|one| 1e3 * one);
                        let kinetic = body.energy(&rate, &forces, PerAxis::default());
                        let error = (coupled(w) - 1e3 * momentum[axis.number()]).abs();
                        assert!(error <= 1e-7 * (1e3 * momentum.amax()) + 1e-12 * kinetic, "{error:e}");
                    }
                    history.push((
                        surface,
                        momentum,
                        body.energy(&state, &forces, PerAxis { travel: 10.0, rotation: 20.0, ..PerAxis::default() }),
                    ));
                }
                histories.push(history);
            }
            let mut sizes = [0.0_f64; 3];
            for (surface, momentum, energy) in &histories[1] {
                let each = [surface.amax(), momentum.amax(), energy.abs()];
                sizes.iter_mut().zip(each).for_each(|(size, value)| *size = size.max(value));
            }
            let mut worst = [0.0_f64; 3];
            for (a, b) in histories[0].iter().zip(&histories[1]) {
                worst[0] = worst[0].max((&a.0 - &b.0).amax() / sizes[0]);
                worst[1] = worst[1].max((&a.1 - &b.1).amax() / sizes[1].max(1e-30));
                worst[2] = worst[2].max((a.2 - b.2).abs() / sizes[2]);
            }
            println!("surface {:.1e}, momentum {:.1e}, energy {:.1e}", worst[0], worst[1], worst[2]);
            assert!(worst[0] < 1e-3 && worst[1] < tolerance && worst[2] < 5e-3);
        }
    }

    #[test]
    fn trapezoidal_rule_conserves_the_energy_of_free_vibration() {
        let dt = 1e-4;
        let td = TimeDerivative { a0: 2.0 / dt, a1: -2.0 / dt, a2: 0.0, b1: -1.0 };
        let [wheel, _] = pairs(20);
        for body in [&wheel.0 as &dyn BodyResponse, &wheel.1] {
            let still = body.operator(0.0).unwrap();
            let mut state = BodyState::zeros(body.state_len());
            let rest = Convection::default();
            let stationary = TimeDerivative::default();
            let loaded = free(body, &still, &state, &stationary, rest);
            let forces = load(still.surface.nrows(), -2e4, 5e3);
            state = committed(body, &still, &loaded, &forces, PerAxis::default(), &stationary, &state);
            assert!(state.velocity.amax() == 0.0 && state.displacement == state.displacement_before);
            // Released: without forces the acceleration is −M⁻¹ K y; one short backward Euler step supplies it.
            let start = TimeDerivative { a0: 1e6, a1: -1e6, a2: 0.0, b1: 0.0 };
            let none = DVector::zeros(still.surface.nrows());
            let op = body.operator(start.a0).unwrap();
            let released = free(body, &op, &state, &start, rest);
            state = committed(body, &op, &released, &none, PerAxis::default(), &start, &state);
            let op = body.operator(td.a0).unwrap();
            let initial = body.energy(&state, &none, PerAxis::default());
            for _ in 0..50 {
                let moving = free(body, &op, &state, &td, rest);
                state = committed(body, &op, &moving, &none, PerAxis::default(), &td, &state);
            }
            let change = body.energy(&state, &none, PerAxis::default()) / initial - 1.0;
            println!("energy changes by {change:.1e}");
            assert!(change.abs() < 1e-8 && state.velocity.amax() > 0.0);
        }
    }
}
