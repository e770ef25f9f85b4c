//! The deformable wheel and rail, and their answers for the step sizes in use.

use super::state::State;
use crate::contact::{ContactSolver, Traction};
use crate::mechanics::response::{BodyResponse, BodyState, Convection, FreeResponse, StepOperator};
use crate::mechanics::{MechanicsError, Pair};
use crate::multistep::TimeDerivative;
use nalgebra::{DMatrix, DVector};
use std::sync::Arc;

/// Number of step sizes whose operators are kept.
const KEPT: usize = 3;

/// Wheel and rail.
pub struct Bodies {
    /// Annulus on its hub.
    pub wheel: Box<dyn BodyResponse>,
    /// Plate on its base.
    pub rail: Box<dyn BodyResponse>,
    /// Whether the correction of the contact solver is part of them, because it is damped as they are.
    hold_correction: bool,
}

/// Answers of both bodies for one step size, corrected for the contact solver.
pub struct Operators {
    /// Weight of the new value in the time formula [1/s].
    pub a0: f64,
    /// Of the wheel.
    pub wheel: StepOperator,
    /// Of the rail.
    pub rail: StepOperator,
    /// Sum of both surface compliances [m/(N/m)].
    pub relative: DMatrix<f64>,
}

/// Operators of recently used step sizes; never part of a state.
#[derive(Default)]
pub struct OperatorCache {
    recent: Vec<Arc<Operators>>,
}

impl Bodies {
    /// Wheel and rail as `solver` sees them.
    pub fn new(pair: Pair, solver: &dyn ContactSolver) -> Self {
        let Pair { mut wheel, mut rail, surface_x, .. } = pair;
        let ports = 2 * surface_x.len();
        let mut layers = [DMatrix::zeros(ports, ports), DMatrix::zeros(ports, ports)];
        let [of_wheel, of_rail] = &mut layers;
        solver.correct(of_wheel, of_rail);
        let hold_correction = wheel.take_layer(of_wheel) && rail.take_layer(of_rail);
        Self { wheel, rail, hold_correction }
    }

    /// Elastic energy of the contact solver's correction, unless the bodies count it [J/m].
    pub fn correction_energy(&self, solver: &dyn ContactSolver, traction: &Traction) -> f64 {
        if self.hold_correction { 0.0 } else { solver.correction_energy(traction) }
    }

    /// Operators for `a0`, from the cache if they are there.
    pub fn operators(
        &self,
        a0: f64,
        solver: &dyn ContactSolver,
        cache: &mut OperatorCache,
    ) -> Result<Arc<Operators>, MechanicsError> {
        let recent = &mut cache.recent;
        if let Some(at) = recent.iter().position(|o| o.a0 == a0) {
            recent[at..].rotate_left(1);
        } else {
            if recent.len() >= KEPT {
                recent.remove(0);
            }
            let (mut wheel, mut rail) = (self.wheel.operator(a0)?, self.rail.operator(a0)?);
            if !self.hold_correction {
                solver.correct(&mut wheel.surface, &mut rail.surface);
            }
            let relative = &wheel.surface + &rail.surface;
            recent.push(Arc::new(Operators { a0, wheel, rail, relative }));
        }
        Ok(recent[recent.len() - 1].clone())
    }

    /// Answers of wheel and rail known before the contact is solved; `streams` are those of wheel and rail.
    pub fn free_responses(
        &self,
        operators: &Operators,
        state: &State,
        td: &TimeDerivative,
        streams: [Convection; 2],
        out: &mut [FreeResponse; 2],
    ) {
        let [wheel, rail] = out;
        self.wheel.free_response(&operators.wheel, &state.wheel, td, streams[0], wheel);
        self.rail.free_response(&operators.rail, &state.rail, td, streams[1], rail);
    }

    /// Kinetic and elastic energy of the deformation, its coupling with the rigid velocities (V, U̇, Ω) included [J/m].
    pub fn energy(&self, state: &State, velocities: [f64; 3]) -> f64 {
        let forces = &state.contact.traction.port_forces;
        // Quadratic in the forces, so that their sign on the rail does not matter.
        self.wheel.energy(&state.wheel, forces, velocities) + self.rail.energy(&state.rail, forces, [0.0; 3])
    }

    /// Power that damping and open ends take out of the bodies [W/m].
    pub fn dissipation(&self, state: &State) -> f64 {
        let [velocity, _, omega] = state.motion.values();
        self.wheel.dissipation(&state.wheel, omega) + self.rail.dissipation(&state.rail, velocity)
    }

    /// Accepts the contact forces in `next`: writes the advanced deformation of both bodies to it. `accelerations` are
    /// the rigid ones (V̇, Ü, Ω̇); `opposite` is a buffer for the forces on the rail.
    #[allow(clippy::too_many_arguments)]
    pub fn commit(
        &self,
        operators: &Operators,
        free: &[FreeResponse; 2],
        accelerations: [f64; 3],
        td: &TimeDerivative,
        state: &State,
        next: &mut State,
        opposite: &mut DVector<f64>,
    ) {
        let forces = &next.contact.traction.port_forces;
        self.wheel.commit(&operators.wheel, &free[0], forces, accelerations, td, &state.wheel, &mut next.wheel);
        opposite.resize_vertically_mut(forces.len(), 0.0);
        opposite.iter_mut().zip(forces.iter()).for_each(|(o, f)| *o = -f);
        self.rail.commit(&operators.rail, &free[1], opposite, [0.0; 3], td, &state.rail, &mut next.rail);
    }

    /// Whether a state has the dimensions of these bodies.
    pub fn fits(&self, state: &State) -> bool {
        let fits = |body: &BodyState, response: &dyn BodyResponse| {
            let n = response.state_len();
            let arrays = [
                &body.displacement,
                &body.velocity,
                &body.acceleration,
                &body.displacement_before,
                &body.velocity_before,
            ];
            arrays.iter().all(|array| array.len() == n) && body.retarded.fits(response.retarded_len())
        };
        fits(&state.wheel, &*self.wheel) && fits(&state.rail, &*self.rail)
    }
}
