//! The wheel as a slave: settings of the master, and the simulation behind them.
//!
//! Functions here speak of rows of the table; which variables of a version of FMI these are is a matter of
//! [`v2`](super::v2) and [`v3`](super::v3). Every function that fails leaves the wheel as it was.

mod course;
pub mod derivatives;
mod experiment;
mod notices;
mod owners;
mod partners;
mod running;
mod saving;
mod switching;

use super::settings::{SetValues, Settings};
use super::snapshot::WheelState;
use super::variable::{Causality, Value, Variable};
use crate::config::Config;
use crate::simulation::{Inputs, LONGEST_STEP, Model, Simulation, StepError, advice};
use notices::Notices;
use owners::Claim;
use std::borrow::Cow;
use std::path::PathBuf;
use std::sync::Arc;
use wheelrail_slave::{CallError, Life, Outcome, Slave, Snapshot, Status};

/// A wheel between its instantiation and its end.
pub type Instance = wheelrail_slave::Instance<WheelSlave>;

/// The simulation of an instance, started if it is not running yet.
pub fn simulation(instance: &mut Instance) -> Outcome<&mut Simulation> {
    let (wheel, life) = instance.parts();
    wheel.simulation(life)
}

/// Model of a wheel with what its master has set.
pub struct WheelSlave {
    resources: Option<PathBuf>,
    settings: Settings,
    /// Parameters that follow from the settings.
    config: Config,
    /// Kept over changes of parameters and resets, and reused when its parameters are wanted again.
    model: Option<Arc<Model>>,
    /// `None` until outputs are wanted, and again when an input or parameter changes in Initialization Mode.
    simulation: Option<Simulation>,
    /// Communication point, length and inputs of the last discarded step.
    failure: Option<(f64, f64, Inputs)>,
    /// True if the last discarded step had failed before.
    hopeless: bool,
    /// Warnings of this run.
    notices: Notices,
    /// The file that the run leaves behind.
    claim: Option<Claim>,
}

impl Slave for WheelSlave {
    type State = WheelState;

    const LONGEST_STEP: f64 = LONGEST_STEP;

    fn new(resources: Option<PathBuf>) -> Outcome<Self> {
        let settings = Settings::new(resources.as_deref()).map_err(CallError::error)?;
        Ok(Self {
            resources,
            config: settings.config(),
            settings,
            model: None,
            simulation: None,
            failure: None,
            hopeless: false,
            notices: Notices::default(),
            claim: None,
        })
    }

    fn reset(&mut self) -> Outcome {
        let fresh = Self::new(self.resources.clone())?;
        *self = Self { model: self.model.take(), ..fresh };
        Ok(())
    }

    fn set_tolerance(&mut self, tolerance: Option<f64>, life: &Life) {
        experiment::take_tolerance(&mut self.settings, tolerance, life.log());
        self.config = self.settings.config();
        self.simulation = None;
    }

    fn initialize(&mut self, life: &Life) -> Outcome<String> {
        saving::claim_file(&mut self.claim, &self.config, life)?;
        self.simulation(life)?;
        self.notices.of_settings(&self.settings, &self.config, life);
        if let Some(simulation) = &self.simulation {
            self.notices.of_profiles(simulation, life.log());
        }
        self.settings.inputs = self.settings.given(&self.config, true).into_owned();
        self.warn_of_limits(life.time(), life);
        Ok(self.settings.tolerance_in_use(&self.config))
    }

    fn terminate(&mut self, life: &Life) -> Outcome {
        if let Some(simulation) = &self.simulation {
            self.notices.of_way(simulation, life.log());
        }
        saving::save_profile(&mut self.claim, &self.config, self.simulation.as_ref(), life)
    }

    fn step(&mut self, start: f64, h: f64, life: &Life) -> Outcome {
        self.take_step(start, h, life, |simulation, inputs| simulation.advance(inputs, h).map(|()| h)).map(drop)
    }

    fn step_to_event(&mut self, start: f64, h: f64, life: &Life) -> Outcome<f64> {
        self.take_step(start, h, life, |simulation, inputs| simulation.advance_to_event(inputs, h))
    }

    fn is_hopeless(&self) -> bool {
        self.hopeless
    }

    fn save(&self) -> WheelState {
        let checkpoint = self.simulation.as_ref().map(|simulation| simulation.checkpoint().clone());
        WheelState { settings: self.settings.clone(), checkpoint }
    }

    fn restore(&mut self, state: &WheelState, life: &Life) -> Outcome {
        let config = state.settings.config();
        self.resume(state.checkpoint.as_ref(), &config, life)?;
        // A state of another wheel may name its file: no reason not to continue from there, but to say so in time.
        if config.files != self.config.files
            && let Err(refusal) = saving::claim_file(&mut self.claim, &config, life)
        {
            life.log().report(Status::Warning, &refusal.message);
        }
        (self.settings, self.config) = (state.settings.clone(), config);
        // A master may restore and repeat a discarded step for ever: the failure is remembered.
        self.hopeless = false;
        Ok(())
    }

    fn to_bytes(snapshot: &Snapshot<WheelState>) -> Result<Vec<u8>, String> {
        super::snapshot::to_bytes(snapshot)
    }

    fn from_bytes(bytes: &[u8]) -> Result<Snapshot<WheelState>, String> {
        super::snapshot::from_bytes(bytes)
    }
}

impl WheelSlave {
    /// Parameters that hold now.
    pub fn config(&self) -> &Config {
        &self.config
    }

    /// Offers a prepared model, which is used while the parameters are its own.
    pub fn offer_model(&mut self, model: Arc<Model>) {
        self.model = Some(model);
    }

    /// Values of variables.
    pub fn values(&mut self, variables: &[&Variable], life: &Life) -> Outcome<Vec<Value>> {
        let (line, mut on_line) = (self.config.tuning.shown_line, None);
        if variables.iter().any(|variable| variable.causality() == Causality::Output) {
            let simulation = self.simulation(life)?;
            if line > 0 && variables.iter().any(|variable| variable.is_profile()) {
                on_line = Some(simulation.outputs_on_line(line));
            } else if variables.iter().any(|variable| variable.is_deferred()) {
                simulation.all_outputs();
            }
        }
        let mut inputs = self.inputs(life);
        let outputs = on_line.as_ref().or(self.simulation.as_ref().map(Simulation::outputs));
        let value = |variable: &&Variable| {
            let value = match variable.causality() {
                Causality::Output => outputs.and_then(|outputs| variable.output(outputs)),
                Causality::Input => variable.input(&mut inputs),
                Causality::Parameter => variable.parameter(&self.settings.preset, &self.config),
            };
            value.ok_or_else(|| CallError::error(format!("{} has no value yet", variable.name)))
        };
        variables.iter().map(value).collect()
    }

    /// Sets variables, all or none. Each must be within its own range; whether all go together shows at the end of
    /// initialization, or when outputs are asked for, so that the order of calls does not matter.
    pub fn set_values<'a>(&mut self, values: impl Iterator<Item = (&'a Variable, Value)>, life: &Life) -> Outcome {
        let (early, mut settings) = (life.is_early(), self.settings.clone());
        for (variable, value) in values {
            settings.set(variable, value, early, self.resources.as_deref()).map_err(CallError::error)?;
        }
        let config = settings.config();
        if !early {
            let next = settings.inputs(&config, false);
            if let Some(simulation) = &self.simulation {
                switching::take_over(simulation.outputs(), &self.inputs(life), &next, &mut settings.bumpless);
            }
        }
        if !early && config != self.config {
            config.validate().map_err(|error| CallError::error(error.to_string()))?;
            if config.files != self.config.files {
                saving::claim_file(&mut self.claim, &config, life)?;
            }
            if let Some(simulation) = &mut self.simulation {
                simulation.retune(&config.tuning);
                self.model = Some(simulation.model().clone());
            }
        }
        (self.settings, self.config) = (settings, config);
        if early {
            self.simulation = None;
        }
        Ok(())
    }

    /// Simulates over `h` \[s] from `start`, or less, as `advance` does; returns how long.
    fn take_step(
        &mut self,
        start: f64,
        h: f64,
        life: &Life,
        advance: impl FnOnce(&mut Simulation, &Inputs) -> Result<f64, StepError> + Send,
    ) -> Outcome<f64> {
        let inputs = self.inputs(life);
        inputs.at(h).validate().map_err(|error| CallError::error(format!("at the end of the step {error}")))?;
        if let Some(simulation) = &self.simulation {
            self.notices.of_inputs(&inputs, simulation, &self.settings, &self.config, life);
        }
        match self.compute(life, |simulation| advance(simulation, &inputs))? {
            Ok(reached) => {
                self.settings.hold(inputs.rate, inputs.at(reached));
                (self.failure, self.hopeless) = (None, false);
                let time = start + reached;
                self.warn_of_limits(time, life);
                if let Some(simulation) = &self.simulation {
                    self.notices.of_reversal(&inputs, simulation.outputs(), &self.config, time, life.log());
                }
                Ok(reached)
            }
            Err(error) => {
                self.hopeless =
                    self.failure.is_some_and(|(t, length, with)| t == start && h >= length && with == inputs);
                self.failure = Some((start, h, inputs));
                let why = advice::failed_step(&error, &self.config);
                Err(CallError::discard(format!("step from {start:?} s over {h:?} s failed: {why}")))
            }
        }
    }

    /// The inputs that act now.
    fn inputs(&self, life: &Life) -> Inputs {
        self.settings.inputs(&self.config, life.is_early())
    }

    /// The set inputs that count now.
    fn given(&self, life: &Life) -> Cow<'_, SetValues> {
        self.settings.given(&self.config, life.is_early())
    }

    /// Sets time derivatives of inputs during the next step, each with its order; all or none.
    pub fn set_rates(&mut self, values: &[(&Variable, i32, f64)]) -> Outcome {
        derivatives::set_rates(&mut self.settings, values)
    }

    fn warn_of_limits(&mut self, time: f64, life: &Life) {
        if let Some(simulation) = &self.simulation {
            self.notices.of_limits(simulation, time, life.log());
        }
    }
}
