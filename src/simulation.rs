//! Façade: configuration → ready model; inputs; advance; outputs; snapshot and restore.
//!
//! All quantities here are those of the whole wheel in SI units.
//!
//! ```no_run
//! use wheelrail::config::Config;
//! use wheelrail::simulation::{Inputs, Model, Simulation};
//!
//! let config: Config = serde_json::from_str(&std::fs::read_to_string("resources/railway.json")?)?;
//! let model = Model::prepare(config, None, &mut |what, share| println!("{what}: {:.0} %", 100.0 * share))?;
//! let mut inputs = Inputs::rolling(model.config());
//! let mut simulation = Simulation::new(model, &inputs)?;
//! inputs.drive.moment = -2000.0;
//! for _ in 0..1000 {
//!     simulation.advance(&inputs, 1e-3)?;
//! }
//! println!("{:.3} m/s", simulation.outputs().wheel_velocity);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use crate::config::{Config, ConfigError, Response};
use crate::mechanics::{self, Basis, BasisError, MechanicsError};
use crate::rolling::{self, Workspace};
use std::path::Path;
use std::sync::Arc;

pub use crate::rolling::control::{INPUT_RANGES, InputError, STANDSTILL, peripheral_velocity};
pub use crate::rolling::fields::{BodyField, FieldError, Fields, Stress, TemperatureField};
pub use crate::rolling::{Drive, Inputs, Outputs, PROFILE_POINTS, Rotation, State, StepError, Translation, Vertical};

/// Why a model could not be prepared.
#[derive(Debug, thiserror::Error)]
pub enum PrepareError {
    #[error(transparent)]
    Config(#[from] ConfigError),
    #[error("finite-element model: {0}")]
    Mechanics(#[from] MechanicsError),
    #[error(transparent)]
    Model(#[from] rolling::ModelError),
    #[error("stored basis {file}: {source}")]
    Basis { file: String, source: BasisError },
}

/// Immutable model of one parameter set; instances with equal parameters may share it.
pub struct Model {
    rolling: rolling::Model,
    basis: Option<(String, Vec<u8>)>,
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

/// File name of the stored basis of a configuration, below a resource directory.
pub fn basis_file_name(config: &Config) -> String {
    format!("{}.bin", mechanics::basis::key(config))
}

impl Model {
    /// Validates the configuration and makes the model ready. The reduced basis is read from
    /// `<directory>/basis/` if it is stored there and computed otherwise; `progress` hears what is being computed and its share done.
    pub fn prepare(
        config: Config,
        directory: Option<&Path>,
        progress: &mut dyn FnMut(&str, f64),
    ) -> Result<Arc<Self>, PrepareError> {
        config.validate()?;
        let (basis, stored) = match config.solver.response {
            Response::Full => (None, None),
            Response::Reduced => {
                let name = basis_file_name(&config);
                let path = directory.map(|d| d.join("basis").join(&name));
                let bytes = path.as_deref().and_then(|p| std::fs::read(p).ok());
                match bytes {
                    Some(bytes) => {
                        let basis = Basis::from_bytes(&bytes)
                            .map_err(|source| PrepareError::Basis { file: name.clone(), source })?;
                        (Some(basis), Some((name, bytes)))
                    }
                    None => {
                        let basis = Basis::compute(&config, progress)?;
                        let bytes =
                            basis.to_bytes().map_err(|source| PrepareError::Basis { file: name.clone(), source })?;
                        (Some(basis), Some((name, bytes)))
                    }
                }
            }
        };
        let bodies = mechanics::bodies(&config, basis, progress)?;
        let rolling = rolling::Model::new(config, bodies)?;
        Ok(Arc::new(Self { rolling, basis: stored }))
    }

    /// Parameters of the model.
    pub fn config(&self) -> &Config {
        &self.rolling.config
    }

    /// File name and content of the reduced basis; `None` for the full response.
    pub fn basis_file(&self) -> Option<(String, Vec<u8>)> {
        self.basis.clone()
    }
}

/// One wheel on one rail: model, state, scratch space and outputs.
pub struct Simulation {
    model: Arc<Model>,
    state: State,
    outputs: Outputs,
    workspace: Workspace,
}

impl Simulation {
    /// Starts from the stationary state for the inputs.
    pub fn new(model: Arc<Model>, inputs: &Inputs) -> Result<Self, StepError> {
        let mut workspace = Workspace::default();
        let state = model.rolling.stationary(inputs, &mut workspace)?;
        let outputs = model.rolling.outputs(&state);
        Ok(Self { model, state, outputs, workspace })
    }

    /// Advances by `h` seconds; on error the state stays as it was and the run can go on.
    pub fn advance(&mut self, inputs: &Inputs, h: f64) -> Result<(), StepError> {
        self.state = self.model.rolling.advance(&self.state, inputs, h, &mut self.workspace)?;
        self.outputs = self.model.rolling.outputs(&self.state);
        Ok(())
    }

    /// Replaces the state by the stationary one for the inputs.
    pub fn restart(&mut self, inputs: &Inputs) -> Result<(), StepError> {
        self.state = self.model.rolling.stationary(inputs, &mut self.workspace)?;
        self.outputs = self.model.rolling.outputs(&self.state);
        Ok(())
    }

    /// Outputs of the present state.
    pub fn outputs(&self) -> &Outputs {
        &self.outputs
    }

    /// Present values of all quantities that can be prescribed.
    pub fn present(&self) -> Drive {
        let outputs = &self.outputs;
        Drive {
            omega: outputs.wheel_omega,
            moment: outputs.hub_moment,
            velocity: outputs.wheel_velocity,
            force: outputs.hub_force_x,
            load: (-outputs.hub_force_y).max(0.0),
            displacement: -outputs.contact_approach,
            friction: self.state.friction,
            tread_heat: 0.0,
        }
    }

    /// Displacement, velocity, stress and temperature in the whole bodies.
    pub fn fields(&self) -> Result<Fields, FieldError> {
        self.model.rolling.fields(&self.state)
    }

    /// The model this simulation runs on.
    pub fn model(&self) -> &Arc<Model> {
        &self.model
    }

    /// All that a restart needs.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Continues from a state of a simulation with the same model.
    pub fn set_state(&mut self, state: State) -> Result<(), StepError> {
        if !self.model.rolling.fits(&state) {
            return Err(StepError::Body("the state belongs to a model with other dimensions".into()));
        }
        self.outputs = self.model.rolling.outputs(&state);
        self.state = state;
        Ok(())
    }

    /// Time since the start [s].
    pub fn time(&self) -> f64 {
        self.state.time
    }
}
