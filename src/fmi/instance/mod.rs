//! One slave: parameters, inputs, communication points and the simulation, without a word of C.
//!
//! Every refused call leaves the instance as it was, so a master may report the error and go on.

pub mod aside;
pub mod derivatives;
mod experiment;
mod notices;
mod running;
mod saving;
mod values;
mod warned;

use self::aside::Aside;
use super::lifecycle::{Call, Phase};
use super::log::{CallError, Log, Status};
use super::presets;
use super::settings::{SetValues, is_start, with_inputs};
use super::variable::{Access, Value};
use super::variables::{find, variables};
use crate::config::{Config, Given};
use crate::simulation::{Drive, Inputs, LONGEST_STEP, Model, Simulation, advice};
use std::borrow::Cow;
use std::path::PathBuf;
use std::sync::Arc;
use warned::Warned;

/// Largest mismatch of a communication point, relative to the step, besides rounding.
const POINT_TOLERANCE: f64 = 1e-3;
/// How far a step may end past the stop time, relative to its length, besides rounding: sums of many steps are off.
const STOP_TOLERANCE: f64 = 0.1;

/// A slave between `fmi2Instantiate` and `fmi2FreeInstance`.
pub struct Instance {
    log: Log,
    /// Where long computations run.
    aside: Aside,
    resources: Option<PathBuf>,
    phase: Phase,
    preset: String,
    /// Parameters of the preset.
    base: Config,
    /// Parameters that follow from `fmi2SetupExperiment` and override the preset.
    experiment: SetValues,
    /// Explicitly set parameters, which override both.
    parameters: SetValues,
    /// `base` with `experiment` and `parameters`.
    config: Config,
    /// Explicitly set inputs; the others follow from the parameters.
    inputs: SetValues,
    /// Present values that inputs took over when a control was switched to them; explicit ones override them.
    bumpless: SetValues,
    /// Time derivatives of the inputs during the next step.
    rates: Drive,
    time: f64,
    stop: Option<f64>,
    /// Kept over changes of parameters and resets, and reused when its parameters are wanted again.
    model: Option<Arc<Model>>,
    /// `None` until outputs are wanted, and again when an input or parameter changes in Initialization Mode.
    simulation: Option<Simulation>,
    last_step: Status,
    /// Communication point, length and inputs of the last discarded step.
    failure: Option<(f64, f64, Inputs)>,
    hopeless: bool,
    /// What the user has been warned of in this run.
    warned: Warned,
}

type Outcome<T = ()> = Result<T, CallError>;

impl Instance {
    /// `resources` is the directory `resources` of the unpacked FMU, if known.
    pub fn new(resources: Option<PathBuf>, log: Log) -> Outcome<Instance> {
        let base = presets::load(resources.as_deref(), presets::DEFAULT).map_err(CallError::error)?;
        Ok(Instance {
            log,
            aside: aside::here,
            resources,
            phase: Phase::Instantiated,
            preset: presets::DEFAULT.to_owned(),
            config: base.clone(),
            base,
            experiment: SetValues::new(),
            parameters: SetValues::new(),
            inputs: SetValues::new(),
            bumpless: SetValues::new(),
            rates: Drive::default(),
            time: 0.0,
            stop: None,
            model: None,
            simulation: None,
            last_step: Status::Ok,
            failure: None,
            hopeless: false,
            warned: Warned::default(),
        })
    }

    /// Long computations run there from now on.
    pub fn compute_on(&mut self, aside: Aside) {
        self.aside = aside;
    }

    /// Where messages go.
    pub fn log(&self) -> &Log {
        &self.log
    }
    /// Where in its life the instance is.
    pub fn phase(&self) -> Phase {
        self.phase
    }
    /// Status of the last step.
    pub fn last_step(&self) -> Status {
        self.last_step
    }
    /// Communication point up to which the instance has simulated \[s].
    pub fn last_successful_time(&self) -> f64 {
        self.time
    }
    /// Whether repeating the last, discarded step is pointless: the same step has failed twice.
    pub fn terminated(&self) -> bool {
        self.hopeless
    }

    /// Parameters that hold now.
    pub fn config(&self) -> &Config {
        &self.config
    }

    /// Offers a prepared model, which is used while the parameters are its own.
    pub fn offer_model(&mut self, model: Arc<Model>) {
        self.model = Some(model);
    }

    /// Marks the instance as beyond repair, after a panic.
    pub fn give_up(&mut self) {
        self.phase = Phase::Fatal;
    }

    /// Refuses calls that are illegal in the present phase.
    pub fn allow(&self, call: Call) -> Outcome {
        if call.legal(self.phase) {
            return Ok(());
        }
        let status = if self.phase == Phase::Fatal { Status::Fatal } else { Status::Error };
        Err(CallError { status, message: format!("{call:?} is not allowed in phase {:?}", self.phase) })
    }

    /// Switches log messages on or off, all or those of some categories.
    pub fn set_debug_logging(&mut self, on: bool, categories: &[String]) -> Outcome {
        self.allow(Call::SetDebugLogging)?;
        self.log.switch(on, categories)
    }

    /// Begins Initialization Mode.
    pub fn enter_initialization(&mut self) -> Outcome {
        self.allow(Call::EnterInitializationMode)?;
        self.phase = Phase::Initialization;
        Ok(())
    }

    /// Ends Initialization Mode. If parameters and inputs do not go together, it stays, so that they can be corrected.
    pub fn exit_initialization(&mut self) -> Outcome {
        self.allow(Call::ExitInitializationMode)?;
        Self::try_to_save(&self.config)?;
        self.simulation()?;
        self.warn_of_settings();
        self.inputs = self.given().into_owned();
        self.phase = Phase::StepComplete;
        self.warn_of_limits();
        self.log.report(Status::Ok, &format!("initialized at t = {} s, {}", self.time, self.tolerance_in_use()));
        Ok(())
    }

    /// Ends the run and writes the profile of the wheel, if asked for; outputs can still be read.
    pub fn terminate(&mut self) -> Outcome {
        self.allow(Call::Terminate)?;
        self.save_profile()?;
        self.phase = Phase::Terminated;
        self.log.report(Status::Ok, &format!("terminated at t = {} s", self.time));
        Ok(())
    }

    /// Back to the state after instantiation; only the model is kept for reuse.
    pub fn reset(&mut self) -> Outcome {
        self.allow(Call::Reset)?;
        let base = presets::load(self.resources.as_deref(), presets::DEFAULT).map_err(CallError::error)?;
        self.phase = Phase::Instantiated;
        self.preset = presets::DEFAULT.to_owned();
        self.config = base.clone();
        self.base = base;
        self.experiment.clear();
        self.parameters.clear();
        self.inputs.clear();
        self.bumpless.clear();
        self.rates = Drive::default();
        (self.time, self.stop) = (0.0, None);
        self.simulation = None;
        self.last_step = Status::Ok;
        (self.failure, self.hopeless) = (None, false);
        self.warned = Warned::default();
        self.log.report(Status::Ok, "reset");
        Ok(())
    }

    /// Simulates from the communication point `start` over `h` \[s]; inputs are those set now, ramped by their
    /// derivatives, and hold their final values afterwards.
    pub fn do_step(&mut self, start: f64, h: f64) -> Outcome {
        self.allow(Call::DoStep)?;
        if !(h > 0.0 && h <= LONGEST_STEP) {
            let range = format!("more than 0, at most {LONGEST_STEP} s");
            return Err(CallError::error(format!("communicationStepSize = {h:?} s is outside its range: {range}")));
        }
        let rounding = |t: f64| 16.0 * f64::EPSILON * t.abs();
        let current = (start - self.time).abs() <= POINT_TOLERANCE * h + rounding(self.time);
        if !current {
            let expected = self.time;
            let message = format!("currentCommunicationPoint = {start:?} s is outside its range: {expected:?} s");
            return Err(CallError::error(message));
        }
        if let Some(stop) = self.stop
            && start + h > stop + STOP_TOLERANCE * h + rounding(stop)
        {
            let message = format!("step from {start:?} s over {h:?} s ends after stopTime = {stop:?} s");
            return Err(CallError::error(message));
        }
        let inputs = self.effective_inputs();
        let end = inputs.at(h);
        end.validate().map_err(|error| CallError::error(format!("at the end of the step {error}")))?;
        self.warn_of_inputs(&inputs);
        match self.compute(|simulation| simulation.advance(&inputs, h))? {
            Ok(()) => {
                self.hold(end);
                self.time = start + h;
                (self.phase, self.last_step) = (Phase::StepComplete, Status::Ok);
                (self.failure, self.hopeless) = (None, false);
                self.warn_of_limits();
                self.warn_of_reversal(&inputs);
                Ok(())
            }
            Err(error) => {
                self.hopeless =
                    self.failure.is_some_and(|(t, length, with)| t == start && h >= length && with == inputs);
                self.failure = Some((start, h, inputs));
                (self.phase, self.last_step) = (Phase::StepFailed, Status::Discard);
                let why = advice::failed_step(&error, &self.config);
                Err(CallError::discard(format!("step from {start:?} s over {h:?} s failed: {why}")))
            }
        }
    }

    fn effective_inputs(&self) -> Inputs {
        with_inputs(&self.config, &self.bumpless, &self.given(), self.rates)
    }

    /// The inputs that count: all that are set; of those set before the end of initialization only what says more than the
    /// declared start values do, unless `initial.given` is `written`.
    fn given(&self) -> Cow<'_, SetValues> {
        let early = matches!(self.phase, Phase::Instantiated | Phase::Initialization);
        if !early || self.config.initial.given == Given::Written {
            return Cow::Borrowed(&self.inputs);
        }
        let mut given = self.inputs.clone();
        given.retain(|reference, value| find(*reference).is_some_and(|row| !is_start(row, value, &self.base)));
        Cow::Owned(given)
    }

    /// Keeps the values at the end of a ramp as the new inputs.
    fn hold(&mut self, mut end: Drive) {
        if self.rates == Drive::default() {
            return;
        }
        for variable in variables() {
            if let Access::RealInput(field) = variable.access
                && *field(&mut self.rates) != 0.0
            {
                self.inputs.insert(variable.reference, Value::Real(*field(&mut end)));
            }
        }
        self.rates = Drive::default();
    }
}
