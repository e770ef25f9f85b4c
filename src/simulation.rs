//! Façade: configuration → ready model; inputs; advance; outputs; snapshot and restore.
//!
//! All quantities here are those of the whole wheel in SI units.
//!
//! ```no_run
//! use wheelrail::config::Config;
//! use wheelrail::simulation::{BasisStore, Inputs, Model, Simulation};
//!
//! let config: Config = serde_json::from_str(&std::fs::read_to_string("resources/railway.json")?)?;
//! let model = Model::shared(config, &BasisStore::of_user(), &mut |what, share| println!("{what}: {:.0} %", 100.0 * share))?;
//! let mut inputs = Inputs::rolling(model.config());
//! let mut simulation = Simulation::new(model, &inputs)?;
//! inputs.drive.moment = -2000.0;
//! for _ in 0..1000 {
//!     simulation.advance(&inputs, 1e-3)?;
//! }
//! println!("{:.3} m/s", simulation.outputs().wheel_velocity);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod advice;
mod plausible;
mod shared;
mod store;
mod validity;

pub use store::{BasisStore, CACHE_VARIABLE, StoreError, basis_file_name};
pub use validity::Limit;

use crate::config::{Config, ConfigError, Response};
use crate::mechanics::{self, Basis, BasisError, MechanicsError};
use crate::rolling::{self, Workspace};
use plausible::plausible;
use serde::{Deserialize, Serialize};
use std::sync::{Arc, Mutex};

pub use crate::rolling::control::{INPUT_RANGES, InputError, STANDSTILL, peripheral_velocity};
pub use crate::rolling::fields::{BodyField, FieldError, Fields, Stress, TemperatureField};
pub use crate::rolling::stepping::LONGEST_STEP;
pub use crate::rolling::{
    Difference, Drive, Inputs, Origin, Outputs, PROFILE_POINTS, Rotation, State, StepError, Translation, Vertical,
};

/// Why a model could not be prepared.
#[derive(Debug, thiserror::Error)]
pub enum PrepareError {
    #[error(transparent)]
    Config(#[from] ConfigError),
    #[error("finite-element model: {0}")]
    Mechanics(#[from] MechanicsError),
    #[error(transparent)]
    Model(#[from] rolling::ModelError),
    #[error(transparent)]
    Store(#[from] StoreError),
    #[error("computed basis: {0}")]
    Basis(#[from] BasisError),
}

/// Immutable model of one parameter set; instances with equal parameters may share it.
pub struct Model {
    rolling: rolling::Model,
    basis: Option<Arc<(String, Vec<u8>)>>,
    not_kept: Option<String>,
    /// The stationary start computed last: equal instances of a process mostly start alike.
    start: Mutex<Option<(Inputs, Memory)>>,
}

impl Inputs {
    /// Free rolling at the initial velocity under the nominal load, driven by (zero) force and moment.
    pub fn rolling(config: &Config) -> Self {
        let velocity = config.initial.velocity;
        let drive = Drive {
            omega: peripheral_velocity(velocity, config.initial.creepage) / config.wheel.radius,
            velocity,
            load: config.model.nominal_load,
            friction: config.friction.coefficient,
            ..Drive::default()
        };
        let (rotation, translation, vertical) = (Rotation::Moment, Translation::Force, Vertical::Force);
        Self { rotation, translation, vertical, drive, rate: Drive::default() }
    }
}

impl Model {
    /// Validates the configuration and makes the model ready. The reduced basis is read from the store if it is there, and
    /// computed and kept there otherwise; `progress` hears what is being computed and its share done.
    pub fn prepare(
        config: Config,
        store: &BasisStore,
        progress: &mut dyn FnMut(&str, f64),
    ) -> Result<Arc<Self>, PrepareError> {
        config.validate()?;
        let (mut basis, mut file, mut not_kept) = (None, None, None);
        if config.solver.response == Response::Reduced {
            let (found, bytes) = match store.find(&config)? {
                Some(stored) => stored,
                None => {
                    let computed = Basis::compute(&config, progress)?;
                    let bytes = computed.to_bytes()?;
                    not_kept = store.keep(&config, &bytes).err();
                    (computed, bytes)
                }
            };
            (basis, file) = (Some(found), Some(Arc::new((basis_file_name(&config), bytes))));
        }
        let bodies = mechanics::bodies(&config, basis, progress)?;
        let rolling = rolling::Model::new(config, bodies)?;
        Ok(Arc::new(Self { rolling, basis: file, not_kept, start: Mutex::default() }))
    }

    /// The same model with other tunable parameters (see [`Config::tuned_like`]); `None` if the configurations differ in
    /// anything else.
    pub fn retuned(&self, config: &Config) -> Option<Arc<Self>> {
        let rolling = self.rolling.retuned(config)?;
        Some(Arc::new(Self { rolling, basis: self.basis.clone(), not_kept: None, start: Mutex::default() }))
    }

    /// Parameters of the model.
    pub fn config(&self) -> &Config {
        &self.rolling.config
    }

    /// Why the basis, which had to be computed, could not be kept for the next time.
    pub fn not_kept(&self) -> Option<&str> {
        self.not_kept.as_deref()
    }

    /// File name and content of the reduced basis; `None` for the full response.
    pub fn basis_file(&self) -> Option<(String, Vec<u8>)> {
        self.basis.as_deref().cloned()
    }
}

/// All that a simulation needs to continue bit for bit, besides its model.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Memory {
    pub state: State,
    /// Parameters with which the state was computed; tunable ones may have changed since.
    pub config: Config,
    /// What the state came from, for derivatives by inputs.
    pub origin: Origin,
    /// Times [s] and outputs of the communication points before, latest first, for derivatives in time.
    pub before: Vec<(f64, Outputs)>,
}

/// Communication points kept for derivatives in time.
const KEPT_POINTS: usize = 2;
/// Largest ratio of the last step to the one before that counts in them.
const LARGEST_RATIO: f64 = 10.0;
/// How far a stationary motion is followed back from the start for them [s].
const LEAD: f64 = 1e-3;

impl Memory {
    /// Memory of a stationary start.
    fn stationary(model: &Model, inputs: &Inputs, workspace: &mut Workspace) -> Result<Self, StepError> {
        if let Some((_, known)) = shared::lock(&model.start).as_ref().filter(|(known, _)| known == inputs) {
            return Ok(known.clone());
        }
        let state = model.rolling.stationary(inputs, workspace)?;
        let mut earlier = model.rolling.outputs(&state);
        earlier.wheel_distance -= LEAD * earlier.wheel_velocity;
        earlier.wheel_angle -= LEAD * earlier.wheel_omega;
        earlier.wheel_velocity -= LEAD * earlier.wheel_acceleration;
        earlier.wheel_omega -= LEAD * earlier.wheel_angular_acceleration;
        let (before, origin) = (vec![(state.time - LEAD, earlier)], Origin::Stationary(*inputs));
        let memory = Self { state, config: model.config().clone(), origin, before };
        *shared::lock(&model.start) = Some((*inputs, memory.clone()));
        Ok(memory)
    }
}

/// One wheel on one rail: model, memory, scratch space and outputs.
pub struct Simulation {
    model: Arc<Model>,
    memory: Memory,
    outputs: Outputs,
    workspace: Workspace,
}

impl Simulation {
    /// Starts from the stationary state for the inputs.
    pub fn new(model: Arc<Model>, inputs: &Inputs) -> Result<Self, StepError> {
        let mut workspace = Workspace::default();
        let memory = Memory::stationary(&model, inputs, &mut workspace)?;
        let outputs = model.rolling.outputs(&memory.state);
        Ok(Self { model, memory, outputs, workspace })
    }

    /// Advances by `h` seconds; on error the state stays as it was and the run can go on.
    pub fn advance(&mut self, inputs: &Inputs, h: f64) -> Result<(), StepError> {
        let next = self.model.rolling.advance(&self.memory.state, inputs, h, &mut self.workspace)?;
        if next.pending > 0.0 {
            self.memory.state = next;
            return Ok(());
        }
        let outputs = std::mem::replace(&mut self.outputs, self.model.rolling.outputs(&next));
        let state = std::mem::replace(&mut self.memory.state, next);
        self.memory.before.insert(0, (state.time, outputs));
        self.memory.before.truncate(KEPT_POINTS);
        if self.memory.config != *self.model.config() {
            self.memory.config = self.model.config().clone();
        }
        self.memory.origin = Origin::Step { state: Box::new(state), inputs: *inputs, length: h };
        Ok(())
    }

    /// Goes on with other tunable parameters; refuses a model that differs in anything else.
    pub fn retune(&mut self, config: &Config) -> Result<(), StepError> {
        self.model = self.model.retuned(config).ok_or(StepError::NotTunable)?;
        Ok(())
    }

    /// Replaces everything by the stationary state for the inputs.
    pub fn restart(&mut self, inputs: &Inputs) -> Result<(), StepError> {
        self.memory = Memory::stationary(&self.model, inputs, &mut self.workspace)?;
        self.outputs = self.model.rolling.outputs(&self.memory.state);
        Ok(())
    }

    /// Outputs a little before and behind the present ones along a direction of the inputs that led to them: those of
    /// the last communication step, or of the stationary start. See [`crate::rolling::sensitivity`].
    pub fn difference(&mut self, direction: &Drive) -> Result<Difference, StepError> {
        let Memory { state, config, origin, .. } = &self.memory;
        let model = if config == self.model.config() { None } else { self.model.retuned(config) };
        let model = model.as_ref().unwrap_or(&self.model);
        model.rolling.difference(state, origin, direction, &mut self.workspace)
    }

    /// Time derivative of an output: second-order backward difference of the last communication points, which the
    /// stationary motion precedes.
    pub fn rate(&self, output: impl Fn(&Outputs) -> f64) -> f64 {
        let now = output(&self.outputs);
        let slope = |(time, before): &(f64, Outputs)| (now - output(before)) / (self.memory.state.time - time);
        let points = &self.memory.before;
        match (points.first(), points.get(1)) {
            (Some(a), Some(b)) => {
                let (h, total) = (self.memory.state.time - a.0, self.memory.state.time - b.0);
                // A much shorter step before would amplify its rounding.
                slope(a) + (slope(a) - slope(b)) * (h / (total - h)).min(LARGEST_RATIO)
            }
            (Some(a), _) => slope(a),
            (None, _) => 0.0,
        }
    }

    /// Outputs of the present state.
    pub fn outputs(&self) -> &Outputs {
        &self.outputs
    }

    /// Displacement, velocity, stress and temperature in the whole bodies.
    pub fn fields(&self) -> Result<Fields, FieldError> {
        self.model.rolling.fields(&self.memory.state)
    }

    /// The model this simulation runs on.
    pub fn model(&self) -> &Arc<Model> {
        &self.model
    }

    /// All that a restart needs.
    pub fn memory(&self) -> &Memory {
        &self.memory
    }

    /// The physical state.
    pub fn state(&self) -> &State {
        &self.memory.state
    }

    /// Continues from the memory of a simulation with an equal model.
    pub fn resume(model: Arc<Model>, memory: Memory) -> Result<Self, StepError> {
        let origin = match &memory.origin {
            Origin::Stationary(_) => None,
            Origin::Step { state, .. } => Some(&**state),
        };
        if !origin.into_iter().chain([&memory.state]).all(|state| model.rolling.fits(state) && plausible(state)) {
            return Err(StepError::ForeignState);
        }
        let outputs = model.rolling.outputs(&memory.state);
        Ok(Self { model, memory, outputs, workspace: Workspace::default() })
    }

    /// Goes back, or on, to the memory of a simulation with an equal model.
    pub fn recall(&mut self, memory: Memory) -> Result<(), StepError> {
        let resumed = Self::resume(self.model.clone(), memory)?;
        *self = Self { workspace: std::mem::take(&mut self.workspace), ..resumed };
        Ok(())
    }

    /// Time since the start [s].
    pub fn time(&self) -> f64 {
        self.memory.state.time + self.memory.state.pending
    }
}
