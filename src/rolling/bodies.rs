//! The deformable wheel and rail, and their answers for the step sizes in use.

use super::lines;
use super::state::State;
use super::support::{CondensedBase, TrackSupport};
use crate::axes::PerAxis;
use crate::contact::{Influence, LineKernel};
use crate::lru::Lru;
use crate::mechanics::response::{BodyState, Convection, FreeResponse, StepOperator};
use crate::mechanics::{BodyResponse, MechanicsError};
use crate::multistep::TimeDerivative;
use nalgebra::DMatrix;
use std::sync::Arc;

/// Wheel and rail, less the half-planes that contact lines know for themselves, and what carries the rail.
pub struct Bodies {
    /// Annulus on its hub, plate on its base.
    pair: [Box<dyn BodyResponse>; 2],
    /// Track below its base; `None`: the base is fixed.
    pub support: Option<TrackSupport>,
    /// Flexibility of one body that belongs to lines, where they have one of their own in the place of the body's.
    apart: Option<LineKernel>,
}

/// Answers of both bodies for one step size.
pub struct Operators {
    /// Of the wheel.
    pub wheel: StepOperator,
    /// Of the rail on its support.
    pub rail: StepOperator,
    /// Its base, unless it is fixed.
    pub base: Option<CondensedBase>,
    /// Sum of both surface compliances [m/(N/m)].
    pub relative: DMatrix<f64>,
    /// Sums and parts of the compliances that all lines share; `None`: there is a single line.
    shared: Option<Compliances>,
    /// See [`crate::contact::SurfaceResponse::lift`].
    pub lift: f64,
}

/// Compliances of wheel and rail, and their sum [m/(N/m)].
type Compliances = ([DMatrix<f64>; 2], DMatrix<f64>);

impl Operators {
    /// Displacements by the forces of all lines.
    pub fn shared(&self) -> Influence<'_> {
        match &self.shared {
            Some(shared) => influence(shared),
            None => Influence { compliance: [&self.wheel.surface, &self.rail.surface], relative: &self.relative },
        }
    }
}

fn influence(([wheel, rail], relative): &Compliances) -> Influence<'_> {
    Influence { compliance: [wheel, rail], relative }
}

/// Operators of a dozen step sizes, those of steps that are halved and joined again, by their `a0`; never part of a state.
pub type KeptOperators = Lru<f64, Arc<Operators>, 12>;

impl Bodies {
    /// Wheel and rail, the rail on its `support`.
    pub fn new(wheel: Box<dyn BodyResponse>, rail: Box<dyn BodyResponse>, support: Option<TrackSupport>) -> Self {
        Self { pair: [wheel, rail], support, apart: None }
    }

    /// Both bodies at rest, undeformed.
    pub fn at_rest(&self) -> [BodyState; 2] {
        self.pair.each_ref().map(|body| BodyState::zeros(body.state_len()))
    }

    /// Takes from each body the constant of the flexibility `kernel`, in whose place lines have one of their own.
    pub fn with_lines(self, kernel: LineKernel) -> Self {
        Self { apart: Some(kernel), ..self }
    }

    /// Compliances of wheel and rail less the constants that belong to lines, where they have their own.
    fn shared(&self, surfaces: [&DMatrix<f64>; 2]) -> Option<Compliances> {
        let kernel = self.apart.as_ref()?;
        // A constant is the same at all points, and the polynomials of a force add up to one.
        let constant = |i: usize, j: usize| if i % 2 == j % 2 { kernel.along(i % 2).displacement(0.0) } else { 0.0 };
        let [wheel, rail] = surfaces
            .map(|surface| DMatrix::from_fn(surface.nrows(), surface.ncols(), |i, j| surface[(i, j)] - constant(i, j)));
        let sum = &wheel + &rail;
        Some(([wheel, rail], sum))
    }

    /// Elastic energy of the contact that the bodies do not count, less that which they count in its place [J/m].
    pub fn energy_of_contact(&self, state: &State) -> f64 {
        let of_lines = state.sum(|line| line.contact.energy);
        let Some(apart) = &self.apart else { return of_lines };
        let sum = |body: usize, component: usize| state.loads(body).iter().skip(component).step_by(2).sum::<f64>();
        let constant = |component: usize| apart.along(component).displacement(0.0);
        let of_body = |body: usize| [0, 1].map(|c| 0.5 * constant(c) * sum(body, c).powi(2)).iter().sum::<f64>();
        of_lines + state.sum(|line| line.layout.energy) - of_body(0) - of_body(1)
    }

    /// Operators for `a0`, which are kept.
    pub fn operators(&self, a0: f64, kept: &mut KeptOperators) -> Result<Arc<Operators>, MechanicsError> {
        if !kept.find(|of| *of == a0) {
            let [wheel, rail] = &self.pair;
            let (wheel, mut rail) = (wheel.operator(a0)?, rail.operator(a0)?);
            let base = self.support.as_ref().map(|support| support.condense(&mut rail));
            let relative = &wheel.surface + &rail.surface;
            let shared = self.shared([&wheel.surface, &rail.surface]);
            let lift = self.apart.as_ref().map_or(0.0, |LineKernel { tangential, normal, .. }| {
                normal.factor * normal.reach - tangential.factor * tangential.reach
            });
            kept.keep(a0, Arc::new(Operators { wheel, rail, base, relative, shared, lift }));
        }
        Ok(kept.present().clone())
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
        let [wheel, rail] = &self.pair;
        wheel.free_response(&operators.wheel, &state.wheel, td, streams[0], &mut out[0]);
        rail.free_response(&operators.rail, &state.rail, td, streams[1], &mut out[1]);
        if let Some(base) = &operators.base {
            base.move_free(&state.base, td, &mut out[1]);
        }
    }

    /// Kinetic and elastic energy of the deformation and of the track, the coupling with the rigid velocities (V, U̇,
    /// Ω) included [J/m].
    pub fn energy(&self, state: &State, velocities: PerAxis<f64>) -> f64 {
        let [on_wheel, on_rail] = [0, 1].map(|body| state.loads(body));
        let track = self.support.as_ref().map_or(0.0, |support| support.energy(&state.base));
        let of_base = along_base(state.base.velocities());
        let [wheel, rail] = &self.pair;
        wheel.energy(&state.wheel, &on_wheel, velocities) + rail.energy(&state.rail, &on_rail, of_base) + track
    }

    /// Power that damping and open ends take out of the bodies and the track [W/m].
    pub fn dissipation(&self, state: &State) -> f64 {
        let track = self.support.as_ref().map_or(0.0, |support| support.dissipation(&state.base));
        let motion = state.motion.values();
        let [wheel, rail] = &self.pair;
        wheel.dissipation(&state.wheel, motion.rotation) + rail.dissipation(&state.rail, motion.travel) + track
    }

    /// Accepts the contact forces in `next`: writes the advanced deformation of both bodies and the motion of the rail
    /// base to it. `accelerations` are the rigid ones (V̇, Ü, Ω̇).
    pub fn commit(
        &self,
        operators: &Operators,
        free: &[FreeResponse; 2],
        accelerations: PerAxis<f64>,
        td: &TimeDerivative,
        state: &State,
        next: &mut State,
    ) {
        let [wheel, rail] = &self.pair;
        let on_wheel = lines::mean(&next.lines, |line| &line.contact.traction.loads[0]);
        let on_rail = lines::mean(&next.lines, |line| &line.contact.traction.loads[1]);
        wheel.commit(&operators.wheel, &free[0], &on_wheel, accelerations, td, &state.wheel, &mut next.wheel);
        next.base = match &operators.base {
            Some(base) => base.advance(&state.base, td, &free[1], &on_rail),
            None => state.base,
        };
        let of_base = along_base(next.base.accelerations());
        rail.commit(&operators.rail, &free[1], &on_rail, of_base, td, &state.rail, &mut next.rail);
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
            let convected = body.convected.len();
            arrays.iter().all(|array| array.len() == n) && (convected == 0 || convected == n)
        };
        let [wheel, rail] = &self.pair;
        fits(&state.wheel, &**wheel) && fits(&state.rail, &**rail)
    }
}

/// Motions of the base of the rail, which does not turn, from those in x and y.
fn along_base([travel, height]: [f64; 2]) -> PerAxis<f64> {
    PerAxis { travel, height, ..PerAxis::default() }
}
