//! The deformable wheel and rail, and their answers for the step sizes in use.

use super::state::State;
use super::support::{CondensedBase, TrackSupport};
use crate::contact::line::kernel::KernelCorrection;
use crate::contact::{ContactState, Ports};
use crate::mechanics::response::{BodyResponse, BodyState, Convection, FreeResponse, StepOperator};
use crate::mechanics::{MechanicsError, Pair};
use crate::multistep::TimeDerivative;
use nalgebra::DMatrix;
use std::sync::Arc;

/// Number of step sizes whose operators are kept.
const KEPT: usize = 3;

/// Wheel and rail, and what carries the rail.
///
/// Their coordinates do not depend on the [`Ports`] through which the contact of a state sees them.
pub struct Bodies {
    /// Annulus on its hub, plate on its base; of their surfaces only the ports of ordinary patches.
    narrow: [Box<dyn BodyResponse>; 2],
    /// Both with the ports of wide ones.
    wide: Option<[Box<dyn BodyResponse>; 2]>,
    /// Both less half-planes, for a solver that knows those.
    smooth: Option<[Box<dyn BodyResponse>; 2]>,
    /// Track below its base; `None`: the base is fixed.
    pub support: Option<TrackSupport>,
    /// Correction of their compliance at grid scale, if there is any.
    correction: Option<KernelCorrection>,
    /// True if this correction is part of them, because it is damped as they are.
    hold_correction: bool,
}

/// Answers of both bodies for one step size, corrected at grid scale.
pub struct Operators {
    /// Weight of the new value in the time formula [1/s].
    pub a0: f64,
    /// Ports to which they belong.
    pub ports: Ports,
    /// Of the wheel.
    pub wheel: StepOperator,
    /// Of the rail on its support.
    pub rail: StepOperator,
    /// Its base, unless it is fixed.
    pub base: Option<CondensedBase>,
    /// Sum of both surface compliances [m/(N/m)].
    pub relative: DMatrix<f64>,
}

/// Operators of recently used step sizes; never part of a state.
#[derive(Default)]
pub struct OperatorCache {
    recent: Vec<Arc<Operators>>,
}

impl Bodies {
    /// Wheel and rail, the rail on its `support`, with a `correction` of their compliance at grid scale.
    pub fn new(pair: Pair, support: Option<TrackSupport>, correction: Option<KernelCorrection>) -> Self {
        let (wide, mut hold_correction) = (pair.wide, false);
        let mut corrected = |wheel: Box<dyn BodyResponse>, rail: Box<dyn BodyResponse>, ports: usize| {
            let mut bodies = [wheel, rail];
            let mut layers = [DMatrix::zeros(ports, ports), DMatrix::zeros(ports, ports)];
            correct(correction.as_ref(), layers.each_mut());
            let taken = bodies.iter_mut().zip(&layers).map(|(body, layer)| body.take_layer(layer));
            hold_correction = taken.fold(true, |all, one| all & one);
            bodies
        };
        let narrow = corrected(pair.wheel, pair.rail, 2 * pair.surface_x.len());
        let wide = wide.map(|pair| corrected(pair.wheel, pair.rail, 2 * pair.surface_x.len()));
        let smooth = pair.smooth.map(|pair| [pair.wheel, pair.rail]);
        Self { narrow, wide, smooth, support, correction, hold_correction }
    }

    /// Wheel and rail as the contact of a state sees them.
    fn of(&self, state: &State) -> [&dyn BodyResponse; 2] {
        let other = match state.contact.ports {
            Ports::Narrow => None,
            Ports::Wide => self.wide.as_ref(),
            Ports::Smooth => self.smooth.as_ref(),
        };
        let [wheel, rail] = other.unwrap_or(&self.narrow);
        [&**wheel, &**rail]
    }

    /// Both bodies at rest, undeformed.
    pub fn at_rest(&self) -> [BodyState; 2] {
        [0, 1].map(|body| BodyState::zeros(self.narrow[body].state_len()))
    }

    /// Elastic energy of the contact that the bodies do not count [J/m].
    pub fn correction_energy(&self, contact: &ContactState) -> f64 {
        match (contact.ports, &self.correction) {
            _ if self.hold_correction => 0.0,
            (Ports::Narrow | Ports::Wide, Some(correction)) => correction.energy(&contact.traction.port_forces),
            (Ports::Narrow | Ports::Wide, None) | (Ports::Smooth, _) => contact.energy,
        }
    }

    /// Operators for `a0` on the ports of `state`, from the cache if they are there.
    pub fn operators(
        &self,
        a0: f64,
        state: &State,
        cache: &mut OperatorCache,
    ) -> Result<Arc<Operators>, MechanicsError> {
        let (recent, ports) = (&mut cache.recent, state.contact.ports);
        if let Some(at) = recent.iter().position(|o| o.a0 == a0 && o.ports == ports) {
            recent[at..].rotate_left(1);
        } else {
            if recent.len() >= KEPT {
                recent.remove(0);
            }
            let [wheel, rail] = self.of(state);
            let (mut wheel, mut rail) = (wheel.operator(a0)?, rail.operator(a0)?);
            let base = self.support.as_ref().map(|support| support.condense(&mut rail));
            match ports {
                Ports::Narrow | Ports::Wide if !self.hold_correction => {
                    correct(self.correction.as_ref(), [&mut wheel.surface, &mut rail.surface]);
                }
                Ports::Narrow | Ports::Wide | Ports::Smooth => {}
            }
            let relative = &wheel.surface + &rail.surface;
            recent.push(Arc::new(Operators { a0, ports, wheel, rail, base, relative }));
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
        let [wheel, rail] = self.of(state);
        wheel.free_response(&operators.wheel, &state.wheel, td, streams[0], &mut out[0]);
        rail.free_response(&operators.rail, &state.rail, td, streams[1], &mut out[1]);
        if let Some(base) = &operators.base {
            base.move_free(&state.base, td, &mut out[1]);
        }
    }

    /// Kinetic and elastic energy of the deformation and of the track, the coupling with the rigid velocities (V, U̇,
    /// Ω) included [J/m].
    pub fn energy(&self, state: &State, velocities: [f64; 3]) -> f64 {
        let [on_wheel, on_rail] = &state.contact.traction.loads;
        let track = self.support.as_ref().map_or(0.0, |support| support.energy(&state.base));
        let [x, y] = state.base.velocities();
        let [wheel, rail] = self.of(state);
        wheel.energy(&state.wheel, on_wheel, velocities) + rail.energy(&state.rail, on_rail, [x, y, 0.0]) + track
    }

    /// Power that damping and open ends take out of the bodies and the track [W/m].
    pub fn dissipation(&self, state: &State) -> f64 {
        let track = self.support.as_ref().map_or(0.0, |support| support.dissipation(&state.base));
        let [velocity, _, omega] = state.motion.values();
        let [wheel, rail] = self.of(state);
        wheel.dissipation(&state.wheel, omega) + rail.dissipation(&state.rail, velocity) + track
    }

    /// Accepts the contact forces in `next`: writes the advanced deformation of both bodies and the motion of the rail
    /// base to it. `accelerations` are the rigid ones (V̇, Ü, Ω̇).
    pub fn commit(
        &self,
        operators: &Operators,
        free: &[FreeResponse; 2],
        accelerations: [f64; 3],
        td: &TimeDerivative,
        state: &State,
        next: &mut State,
    ) {
        let ([wheel, rail], [on_wheel, on_rail]) = (self.of(next), &next.contact.traction.loads);
        wheel.commit(&operators.wheel, &free[0], on_wheel, accelerations, td, &state.wheel, &mut next.wheel);
        next.base = match &operators.base {
            Some(base) => base.advance(&state.base, td, &free[1], on_rail),
            None => state.base,
        };
        let [x, y] = next.base.accelerations();
        rail.commit(&operators.rail, &free[1], on_rail, [x, y, 0.0], td, &state.rail, &mut next.rail);
    }

    /// True if a state has the dimensions of these bodies.
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
        let [wheel, rail] = self.of(state);
        fits(&state.wheel, wheel) && fits(&state.rail, rail)
    }
}

/// Adds half of a correction to the surface compliance of each body.
fn correct(correction: Option<&KernelCorrection>, compliances: [&mut DMatrix<f64>; 2]) {
    let Some(correction) = correction else { return };
    compliances.into_iter().for_each(|compliance| correction.add_to(compliance, 0.5));
}

/// Number of surface components that the contact of a state sees.
pub fn ports(state: &State) -> usize {
    state.contact.traction.port_forces.len()
}
