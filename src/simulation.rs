//! Façade: configuration → ready model; inputs; advance; outputs; snapshot and restore.
//!
//! All quantities here are those of the whole wheel in SI units.
//!
//! ```no_run
//! use wheelrail::config::Config;
//! use wheelrail::simulation::{BasisStore, Inputs, Model, Simulation};
//!
//! let store = BasisStore::of_user();
//! let progress = &mut |what: &str, share: f64| println!("{what}: {:.0} %", 100.0 * share);
//! let model = Model::shared(Config::default(), &store, progress)?;
//! let mut inputs = Inputs::rolling(model.config());
//! let mut simulation = Simulation::new(model, &inputs)?;
//! inputs.drive.torque = 2000.0;
//! for _ in 0..1000 {
//!     simulation.advance(&inputs, 1e-3)?;
//! }
//! println!("{:.3} m/s", simulation.outputs().wheel_velocity);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod advice;
mod checkpoint;
mod foreign_state;
mod ingredients;
mod lock;
pub mod mistaken_units;
mod patch_file;
mod shared;
mod start;
mod store;
#[cfg(test)]
mod tests;
mod tools;
pub mod validity;

pub use checkpoint::Checkpoint;
pub use ingredients::PrepareError;
pub use store::{BasisStore, CACHE_VARIABLE, StoreError, basis_file_name};

use crate::config::{Config, Tuning};
use crate::heat::HeatError;
use crate::mechanics::{self, Basis};
use crate::rolling::{self, fields, outputs, sensitivity, stationary, substeps};
use crate::surface;
use checkpoint::{KEPT_POINTS, followed_back};
use foreign_state::is_plausible;
use ingredients::Ingredients;
use lock::lock;
use std::sync::{Arc, Mutex};
use tools::{Shelf, Tools};

pub use crate::rolling::control::{DriveRow, InputError};
pub use crate::rolling::creepages::{STANDSTILL, peripheral_velocity};
pub use crate::rolling::direction::Direction;
pub use crate::rolling::fields::{BodyField, FieldError, Fields, Stress, TemperatureField};
pub use crate::rolling::ramp::{RAMP_NUMBERS, STEEPEST};
pub use crate::rolling::substeps::LONGEST_STEP;
pub use crate::rolling::{
    Difference, Drive, Inputs, Lateral, MOST_LINES, Origin, OutputRow, Outputs, PROFILE_POINTS, Read, Rotation, State,
    StepError, Translation, Vertical,
};

/// Immutable model of one parameter set; instances with equal parameters may share it.
pub struct Model {
    rolling: rolling::RollingModel,
    /// The parameter `contact.rows` as it was given, before its file was read.
    rows: String,
    basis: Option<Arc<(String, Vec<u8>)>>,
    not_kept: Option<String>,
    /// The stationary start computed last, with its inputs: equal instances of a process mostly start alike.
    start: Mutex<Option<(Inputs, Checkpoint)>>,
    shelf: Shelf,
}

impl Inputs {
    /// Free rolling at the initial velocity under the nominal load, driven by (zero) force and moment.
    pub fn rolling(config: &Config) -> Self {
        let velocity = config.initial.velocity;
        let drive = Drive {
            omega: peripheral_velocity(velocity, config.initial.creepage.unwrap_or(0.0)) / config.wheel.radius,
            velocity,
            load: config.model.nominal_load,
            friction: config.friction.coefficient,
            temperature: config.thermal.reference,
            ..Drive::default()
        };
        Self { drive, ..Self::default() }
    }
}

impl Model {
    /// Validates the configuration and makes the model ready. The reduced basis is read from the store if it is there,
    /// and computed and kept there otherwise; `progress` hears what is being computed and its share done.
    pub fn prepare(
        config: Config,
        store: &BasisStore,
        progress: &mut dyn FnMut(&str, f64),
    ) -> Result<Arc<Self>, PrepareError> {
        Self::with_ingredients(Ingredients::read(config, store)?, store, progress)
    }

    fn with_ingredients(
        ingredients: Ingredients,
        store: &BasisStore,
        progress: &mut dyn FnMut(&str, f64),
    ) -> Result<Arc<Self>, PrepareError> {
        let Ingredients { config, rows, surfaces } = ingredients;
        let (mut basis, mut file, mut not_kept) = (None, None, None);
        if config.solver.reduced {
            let (found, bytes) = match store.find(&config)? {
                Some(stored) => stored,
                None => {
                    let computed = Basis::compute(&(&config).into(), progress)?;
                    let bytes = computed.to_bytes()?;
                    not_kept = store.keep(&config, &bytes).err();
                    (computed, bytes)
                }
            };
            (basis, file) = (Some(found), Some(Arc::new((basis_file_name(&config), bytes))));
        }
        let bodies = mechanics::bodies(&(&config).into(), basis, progress)?;
        let rolling = rolling::RollingModel::new(config, bodies, surfaces)?;
        Ok(Arc::new(Self { rolling, rows, basis: file, not_kept, start: Mutex::default(), shelf: Shelf::default() }))
    }

    /// True if the model serves a configuration: all but the tunable parameters are equal.
    pub fn serves(&self, config: &Config) -> bool {
        let ours = self.config();
        let mut theirs = config.tuned_like(ours);
        if theirs.contact.rows == self.rows {
            theirs.contact.rows.clone_from(&ours.contact.rows);
        }
        theirs == *ours
    }

    /// True if the files that the parameters name say what they said when the model was made.
    pub fn is_up_to_date(&self, store: &BasisStore) -> bool {
        let mut given = self.config().clone();
        given.contact.rows.clone_from(&self.rows);
        Ingredients::read(given, store)
            .is_ok_and(|now| now.config == *self.config() && now.surfaces == self.rolling.contact.surfaces)
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

impl Checkpoint {
    /// Checkpoint of a stationary start.
    fn stationary(model: &Model, tuning: &Tuning, inputs: &Inputs) -> Result<Self, StepError> {
        let known = |(with, known): &(Inputs, Self)| (with == inputs && known.tuning == *tuning).then(|| known.clone());
        if let Some(known) = lock(&model.start).as_ref().and_then(known) {
            return Ok(known);
        }
        let state =
            model.shelf.lend(|tools| stationary::start(&model.rolling, tuning, inputs, &mut tools.workspace))?;
        let before = vec![followed_back(state.clock.time, outputs::observe(&model.rolling, &state))];
        let origin = Origin::Stationary(*inputs);
        let checkpoint = Self { state, tuning: tuning.clone(), origin, before };
        *lock(&model.start) = Some((*inputs, checkpoint.clone()));
        Ok(checkpoint)
    }
}

/// One wheel on one rail: model, tunable parameters, checkpoint and outputs.
pub struct Simulation {
    model: Arc<Model>,
    tuning: Tuning,
    checkpoint: Checkpoint,
    outputs: Outputs,
}

impl Simulation {
    /// Starts from the stationary state for the inputs, with the tunable parameters of the model's configuration.
    pub fn new(model: Arc<Model>, inputs: &Inputs) -> Result<Self, StepError> {
        let tuning = model.config().tuning.clone();
        Self::start(model, tuning, inputs)
    }

    /// Starts from the stationary state for the inputs.
    pub fn start(model: Arc<Model>, tuning: Tuning, inputs: &Inputs) -> Result<Self, StepError> {
        let checkpoint = Checkpoint::stationary(&model, &tuning, inputs)?;
        Ok(Self::at(model, tuning, checkpoint))
    }

    fn at(model: Arc<Model>, tuning: Tuning, checkpoint: Checkpoint) -> Self {
        let outputs = outputs::observe(&model.rolling, &checkpoint.state);
        Self { model, tuning, checkpoint, outputs }
    }

    /// Advances by at most `h` seconds, to the internal step after which the brake holds or no longer holds the wheel, or contact
    /// is lost or made again; returns the time \[s]. On error the state stays as it was and the run can go on.
    pub fn advance_to_event(&mut self, inputs: &Inputs, h: f64) -> Result<f64, StepError> {
        self.model.clone().shelf.lend(|Tools { workspace, spare }| {
            let Self { model, tuning, checkpoint, .. } = self;
            let (inputs, reached) =
                substeps::advance_to_event(&model.rolling, tuning, &checkpoint.state, (inputs, h), workspace, spare)?;
            self.commit(&inputs, reached, spare);
            Ok(reached)
        })
    }

    /// Advances by `h` seconds; on error the state stays as it was and the run can go on.
    // Whose instructions tools/instructions.py counts by this name.
    #[inline(never)]
    pub fn advance(&mut self, inputs: &Inputs, h: f64) -> Result<(), StepError> {
        self.model.clone().shelf.lend(|Tools { workspace, spare }| {
            let Self { model, tuning, checkpoint, .. } = self;
            substeps::advance(&model.rolling, tuning, &checkpoint.state, inputs, h, workspace, spare)?;
            self.commit(inputs, h, spare);
            Ok(())
        })
    }

    /// Goes on from the state `spare` after a step of `h` seconds, which gets the memory of a state before.
    fn commit(&mut self, inputs: &Inputs, h: f64, spare: &mut State) {
        let Self { model, tuning, checkpoint, outputs } = self;
        std::mem::swap(&mut checkpoint.state, spare);
        if checkpoint.state.clock.pending > 0.0 {
            return;
        }
        let present = outputs::observe(&model.rolling, &checkpoint.state);
        let mut before = std::mem::replace(outputs, present);
        // A state does not depend on who has asked for what.
        outputs::forget(&mut before);
        checkpoint.before.insert(0, (spare.clock.time, before));
        checkpoint.before.truncate(KEPT_POINTS);
        checkpoint.tuning.clone_from(tuning);
        // The state before becomes the origin, and the memory of the origin before that the spare one.
        match &mut checkpoint.origin {
            Origin::Step { state, inputs: with, length } => {
                std::mem::swap(&mut **state, spare);
                (*with, *length) = (*inputs, h);
            }
            origin => *origin = Origin::Step { state: Box::new(std::mem::take(spare)), inputs: *inputs, length: h },
        }
    }

    /// Goes on with other tunable parameters.
    pub fn retune(&mut self, tuning: &Tuning) {
        self.tuning.clone_from(tuning);
    }

    /// Tunable parameters of the coming steps.
    pub fn tuning(&self) -> &Tuning {
        &self.tuning
    }

    /// Replaces everything by the stationary state for the inputs.
    pub fn restart(&mut self, inputs: &Inputs) -> Result<(), StepError> {
        self.checkpoint = Checkpoint::stationary(&self.model, &self.tuning, inputs)?;
        self.outputs = outputs::observe(&self.model.rolling, &self.checkpoint.state);
        Ok(())
    }

    /// Outputs a little before and behind the present ones along a direction of the inputs that led to them: those of
    /// the last communication step, or of the stationary start. See [`crate::rolling::sensitivity`].
    pub fn difference(&mut self, direction: impl Into<Direction>) -> Result<Difference, StepError> {
        let direction = &direction.into();
        let Checkpoint { state, tuning, origin, .. } = &self.checkpoint;
        let rolling = &self.model.rolling;
        self.model
            .shelf
            .lend(|tools| sensitivity::difference(rolling, tuning, state, origin, direction, &mut tools.workspace))
    }

    /// Time derivative of an output: see [`Checkpoint::rate`].
    pub fn rate(&self, output: impl Fn(&Outputs) -> f64) -> f64 {
        self.checkpoint.rate(&self.outputs, output)
    }

    /// Outputs of the present state, but for deferred ones.
    pub fn outputs(&self) -> &Outputs {
        &self.outputs
    }

    /// Outputs of the present state, deferred ones included.
    pub fn all_outputs(&mut self) -> &Outputs {
        if self.outputs.profile_wheel_below.is_empty() {
            outputs::complete(&self.model.rolling, &self.checkpoint.state, &mut self.outputs);
        }
        &self.outputs
    }

    /// Outputs of the present state, deferred ones included, with the profiles of a line of the patch, counted from 1.
    pub fn outputs_on_line(&mut self, number: usize) -> Outputs {
        let outputs = self.all_outputs().clone();
        outputs::on_line(&self.model.rolling, &self.checkpoint.state, number, outputs)
    }

    /// Times and outputs at both ends of the last communication step, deferred ones included; `None` before the first.
    pub fn step_ends(&self) -> Option<[(f64, Outputs); 2]> {
        let Checkpoint { state, before, origin, .. } = &self.checkpoint;
        let (Origin::Step { state: earlier, .. }, Some((time, before))) = (origin, before.first()) else { return None };
        let ends = [(*time, before, &**earlier), (state.clock.time, &self.outputs, state)];
        Some(ends.map(|(time, outputs, state)| {
            let mut outputs = outputs.clone();
            outputs::complete(&self.model.rolling, state, &mut outputs);
            (time, outputs)
        }))
    }

    /// Displacement, velocity, stress and temperature in the whole bodies.
    pub fn fields(&self) -> Result<Fields, FieldError> {
        fields::fields(&self.model.rolling, &self.checkpoint.state)
    }

    /// Absolute temperatures at all nodes of wheel (about its centre) and rail; `None` if they are not computed.
    pub fn temperature_fields(&self) -> Result<Option<[TemperatureField; 2]>, HeatError> {
        fields::temperatures(&self.model.rolling, &self.checkpoint.state)
    }

    /// Present profile of the wheel, worn and flattened: positions around the tread, angle times radius, and heights
    /// over the circle \[m].
    pub fn wheel_profile(&self) -> Vec<[f64; 2]> {
        outputs::tread(&self.model.rolling, &self.checkpoint.state)
    }

    /// Present profile of the wheel as the text of a file that `wheel.profile` reads.
    pub fn wheel_profile_file(&self) -> String {
        surface::csv(&self.wheel_profile())
    }

    /// The model this simulation runs on.
    pub fn model(&self) -> &Arc<Model> {
        &self.model
    }

    /// All that a restart needs.
    pub fn checkpoint(&self) -> &Checkpoint {
        &self.checkpoint
    }

    /// The physical state.
    pub fn state(&self) -> &State {
        &self.checkpoint.state
    }

    /// Continues from the checkpoint of a simulation with an equal model.
    pub fn resume(model: Arc<Model>, tuning: Tuning, checkpoint: Checkpoint) -> Result<Self, StepError> {
        let origin = match &checkpoint.origin {
            Origin::Stationary(_) => None,
            Origin::Step { state, .. } => Some(&**state),
        };
        if !origin.into_iter().chain([&checkpoint.state]).all(|state| model.rolling.fits(state) && is_plausible(state))
        {
            return Err(StepError::ForeignState);
        }
        Ok(Self::at(model, tuning, checkpoint))
    }

    /// Goes back, or on, to the checkpoint of a simulation with an equal model.
    pub fn recall(&mut self, checkpoint: Checkpoint) -> Result<(), StepError> {
        *self = Self::resume(self.model.clone(), self.tuning.clone(), checkpoint)?;
        Ok(())
    }

    /// Inputs that led to the present state.
    pub fn latest_inputs(&self) -> &Inputs {
        match &self.checkpoint.origin {
            Origin::Stationary(inputs) | Origin::Step { inputs, .. } => inputs,
        }
    }

    /// Time since the start \[s].
    pub fn time(&self) -> f64 {
        self.checkpoint.state.clock.time + self.checkpoint.state.clock.pending
    }
}
