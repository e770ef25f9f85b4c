//! Rolling: the deformable bodies, the contact between them and the rigid motion of the wheel, advanced in time.
//!
//! Everything in this room is per metre of width; [`output`] scales to the whole wheel.

pub mod control;
mod coupling;
pub mod fields;
pub mod output;
mod reversible;
pub mod sensitivity;
pub mod state;
pub mod stationary;
pub mod stepping;
pub mod thermal;
pub mod transient;

pub use control::{Drive, InputError, Inputs, Rotation, Translation, Vertical};
pub use output::{Outputs, PROFILE_POINTS};
pub use sensitivity::{Difference, Origin};
pub use state::State;

use crate::config::Config;
use crate::contact::kernel::KernelCorrection;
use crate::contact::{ContactError, ContactGrid};
use crate::heat::{Heat, HeatError, Scratch};
use crate::mechanics::response::{BodyResponse, StepOperator};
use crate::mechanics::{self, MechanicsError, Pair};
use std::sync::Arc;

/// Why a step or a stationary state could not be computed; the state before it is kept.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StepError {
    #[error("no contact state found at t = {time:.9e} s with an internal step of {step:.1e} s: {source}")]
    Contact { time: f64, step: f64, source: ContactError },
    #[error(
        "the contact patch needs more than the candidate zone of ±{zone:.3e} m at a wheel load of {load:.6e} N: raise \
         the parameter model.nominal_load (now {nominal:.6e} N), or change prescribed velocities more gently"
    )]
    ZoneExceeded { zone: f64, load: f64, nominal: f64 },
    #[error("the motion grew beyond all numbers at t = {time:.9e} s with an internal step of {step:.1e} s")]
    NotFinite { time: f64, step: f64 },
    #[error("the motion leaves the range of the model: {0}")]
    Motion(InputError),
    #[error("no equilibrium: {0}")]
    NoEquilibrium(&'static str),
    #[error(transparent)]
    Input(#[from] InputError),
    #[error("communication step = {step} s is outside its range: above 0 to {longest} s")]
    StepSize { step: f64, longest: f64 },
    #[error("no derivative at t = {time:.9e} s: contact states change at once to both sides")]
    NoDerivative { time: f64 },
    #[error("heat: {0}")]
    Heat(HeatError),
    #[error("body response failed: {0}")]
    Body(String),
    #[error("only tunable parameters may change during a run")]
    NotTunable,
    #[error("the state belongs to a model with other dimensions")]
    ForeignState,
}

/// Why a model could not be built.
#[derive(Debug, thiserror::Error)]
pub enum ModelError {
    #[error("finite-element model: {0}")]
    Mechanics(#[from] MechanicsError),
    #[error("heat model: {0}")]
    Heat(#[from] HeatError),
}

/// Everything that does not change during a run but for tunable parameters; shared between instances.
#[derive(Clone)]
pub struct Model {
    pub config: Config,
    pub grid: ContactGrid,
    wheel: Arc<dyn BodyResponse>,
    rail: Arc<dyn BodyResponse>,
    kernel: KernelCorrection,
    heat: Option<Arc<Heat>>,
    /// Undeformed gap at the candidates [m].
    gap: Vec<f64>,
    /// Inertia per metre of width: in x (with vehicle), in y, about the axle.
    inertia: [f64; 3],
}

/// Compliances of both bodies for one step size, kernel correction included.
pub struct Operators {
    pub a0: f64,
    pub wheel: StepOperator,
    pub rail: StepOperator,
}

/// Operators of recently used step sizes; never part of a state.
#[derive(Default)]
pub struct Workspace {
    operators: Vec<Arc<Operators>>,
    heat: Scratch,
}

/// Number of step sizes whose operators are kept.
const KEPT_OPERATORS: usize = 3;

impl Model {
    /// Builds the model on given bodies.
    pub fn new(config: Config, bodies: Pair) -> Result<Self, ModelError> {
        let grid = ContactGrid {
            x: bodies.surface_x[bodies.candidates.clone()].to_vec(),
            spacing: bodies.spacing,
            guard: bodies.candidates.start,
            radius: config.wheel.radius,
        };
        let (wheel, rail) = (bodies.wheel.operator(0.0)?, bodies.rail.operator(0.0)?);
        let kernel = KernelCorrection::new(&(wheel.surface + rail.surface), mechanics::contact_modulus(&config));
        let width = config.model.contact_width;
        let mass = mechanics::wheel_mass(&config) + config.wheel.hub_mass / width;
        let moment = mechanics::wheel_inertia(&config) + config.wheel.hub_inertia / width;
        let inertia = [mass + config.vehicle.mass / width, mass, moment];
        let half_width = mechanics::nominal_half_width(&config);
        let zone = grid.x.last().map_or(0.0, |x| x + grid.spacing);
        let heat = match config.thermal.enabled {
            true => Some(Arc::new(Heat::new(&thermal::heat_config(&config, half_width, zone))?)),
            false => None,
        };
        let gap = (0..grid.len()).map(|i| grid.undeformed_gap(i)).collect();
        let (wheel, rail) = (Arc::from(bodies.wheel), Arc::from(bodies.rail));
        Ok(Self { config, grid, wheel, rail, kernel, heat, gap, inertia })
    }

    /// The same model with other tunable parameters; `None` if the configurations differ in anything else.
    pub fn retuned(&self, config: &Config) -> Option<Self> {
        (self.config.tuned_like(config) == *config).then(|| Self { config: config.clone(), ..self.clone() })
    }

    /// Nominal wheel load per metre of width [N/m].
    pub fn nominal_line_load(&self) -> f64 {
        self.config.model.nominal_load / self.config.model.contact_width
    }

    /// Elastic energy of the contact under the nominal load, from its Hertzian penetration `a²/2r` [J/m].
    fn contact_energy(&self) -> f64 {
        let penetration = mechanics::nominal_half_width(&self.config).powi(2) / (2.0 * self.grid.radius);
        0.5 * self.nominal_line_load() * penetration
    }

    /// Refuses motions (V, U, Ω) outside the ranges of the inputs that could prescribe them, and velocities at which
    /// loads outrun the surface waves of rail or wheel: the moving frames have no stable solution there.
    fn check_motion(&self, [velocity, displacement, omega]: [f64; 3]) -> Result<(), StepError> {
        Drive { velocity, displacement, omega, ..Drive::default() }.validate().map_err(StepError::Motion)?;
        let wave = self.config.material.rayleigh_speed();
        for (name, value, limit) in
            [("drive.velocity", velocity, wave), ("drive.omega", omega, wave / self.grid.radius)]
        {
            if value.abs() >= limit {
                return Err(StepError::Motion(InputError { name, value, low: -limit, high: limit }));
            }
        }
        Ok(())
    }

    /// Operators for `a0`, from the workspace if they are there.
    fn operators(&self, a0: f64, workspace: &mut Workspace) -> Result<Arc<Operators>, StepError> {
        if let Some(at) = workspace.operators.iter().position(|o| o.a0 == a0) {
            let found = workspace.operators.remove(at);
            workspace.operators.push(found.clone());
            return Ok(found);
        }
        if workspace.operators.len() >= KEPT_OPERATORS {
            workspace.operators.remove(0);
        }
        let failed = |e: MechanicsError| StepError::Body(e.to_string());
        let mut wheel = self.wheel.operator(a0).map_err(failed)?;
        let mut rail = self.rail.operator(a0).map_err(failed)?;
        self.kernel.add_to(&mut wheel.surface, 0.5);
        self.kernel.add_to(&mut rail.surface, 0.5);
        let operators = Arc::new(Operators { a0, wheel, rail });
        workspace.operators.push(operators.clone());
        Ok(operators)
    }

    /// Turns a contact failure into a step failure.
    fn contact_failure(&self, source: ContactError, time: f64, step: f64) -> StepError {
        match source {
            ContactError::ZoneExceeded { zone, load } => {
                let load = load * self.config.model.contact_width;
                StepError::ZoneExceeded { zone, load, nominal: self.config.model.nominal_load }
            }
            source => StepError::Contact { time, step, source },
        }
    }
}

impl Model {
    /// Whether a state has the dimensions of this model and only finite numbers in its contact forces.
    pub fn fits(&self, state: &State) -> bool {
        let body = |b: &crate::mechanics::response::BodyState, n: usize| {
            [&b.displacement, &b.velocity, &b.acceleration, &b.displacement_before, &b.velocity_before]
                .iter()
                .all(|v| v.len() == n)
        };
        let (n, dofs) = (self.grid.len(), self.grid.surface_dofs());
        let contact = &state.contact;
        body(&state.wheel, self.wheel.state_len())
            && body(&state.rail, self.rail.state_len())
            && [
                contact.status.len(),
                contact.slip.len(),
                contact.centred_slip.len(),
                contact.gap.len(),
                state.shift.len(),
            ] == [n; 5]
            && [contact.forces.len(), contact.wheel_surface.len(), contact.rail_surface.len()] == [dofs; 3]
            && match (&state.thermal, &self.heat) {
                (Some(thermal), Some(heat)) => thermal.fits(heat, n),
                (None, None) => true,
                _ => false,
            }
            && contact.forces.iter().all(|f| f.is_finite())
    }
}
