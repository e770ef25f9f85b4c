//! One slave: parameters, inputs, communication points and the simulation, without a word of C.
//!
//! Every refused call leaves the instance as it was, so a master may report the error and go on.

use super::lifecycle::{Call, Phase};
use super::log::{Log, Refusal, Status};
use super::presets;
use super::settings::{Explicit, with_inputs, with_parameters};
use super::snapshot::Snapshot;
use super::variable::{Access, Causality, Kind, Reference, Value, Variable};
use super::variables::find;
use crate::config::Config;
use crate::simulation::{Drive, Inputs, LONGEST_STEP, Model, Rotation, Simulation, Translation, Vertical};
use std::path::PathBuf;
use std::sync::Arc;

/// Largest mismatch of a communication point, relative to the step, besides rounding.
const POINT_TOLERANCE: f64 = 1e-3;
/// How far a step may end past the stop time, relative to its length, besides rounding: sums of many steps are off.
const STOP_TOLERANCE: f64 = 0.1;

/// A slave between `fmi2Instantiate` and `fmi2FreeInstance`.
pub struct Instance {
    log: Log,
    resources: Option<PathBuf>,
    phase: Phase,
    preset: String,
    /// Parameters of the preset.
    base: Config,
    /// Explicitly set parameters, which override the preset.
    parameters: Explicit,
    /// `base` with `parameters`.
    config: Config,
    /// Explicitly set inputs; the others follow from the parameters.
    inputs: Explicit,
    /// Present values that inputs took over when a control was switched to them; explicit ones override them.
    taken: Explicit,
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
}

type Outcome<T = ()> = Result<T, Refusal>;

impl Instance {
    /// `resources` is the directory `resources` of the unpacked FMU, if known.
    pub fn new(resources: Option<PathBuf>, log: Log) -> Outcome<Instance> {
        let base = presets::load(resources.as_deref(), presets::DEFAULT).map_err(Refusal::error)?;
        Ok(Instance {
            log,
            resources,
            phase: Phase::Instantiated,
            preset: presets::DEFAULT.to_owned(),
            config: base.clone(),
            base,
            parameters: Explicit::new(),
            inputs: Explicit::new(),
            taken: Explicit::new(),
            rates: Drive::default(),
            time: 0.0,
            stop: None,
            model: None,
            simulation: None,
            last_step: Status::Ok,
            failure: None,
            hopeless: false,
        })
    }

    pub fn log(&self) -> &Log {
        &self.log
    }
    pub fn phase(&self) -> Phase {
        self.phase
    }
    /// Status of the last step.
    pub fn last_step(&self) -> Status {
        self.last_step
    }
    /// Communication point up to which the instance has simulated [s].
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
        Err(Refusal { status, message: format!("{call:?} is not allowed in phase {:?}", self.phase) })
    }

    pub fn set_debug_logging(&mut self, on: bool, categories: &[String]) -> Outcome {
        self.allow(Call::SetDebugLogging)?;
        self.log.switch(on, categories)
    }

    /// Times [s]; the solver chooses its own tolerances, so that of the master is only checked.
    pub fn setup_experiment(&mut self, tolerance: Option<f64>, start: f64, stop: Option<f64>) -> Outcome {
        self.allow(Call::SetupExperiment)?;
        if tolerance.is_some_and(|t| !(t.is_finite() && t > 0.0)) {
            return Err(Refusal::error(format!("tolerance = {tolerance:?} is outside its range: positive numbers")));
        }
        if !start.is_finite() {
            return Err(Refusal::error(format!("startTime = {start} s is outside its range: finite numbers")));
        }
        if let Some(stop) = stop
            && !(stop.is_finite() && stop >= start)
        {
            return Err(Refusal::error(format!("stopTime = {stop} s is outside its range: at least {start} s")));
        }
        (self.time, self.stop) = (start, stop);
        Ok(())
    }

    pub fn enter_initialization(&mut self) -> Outcome {
        self.allow(Call::EnterInitializationMode)?;
        self.phase = Phase::Initialization;
        Ok(())
    }

    pub fn exit_initialization(&mut self) -> Outcome {
        self.allow(Call::ExitInitializationMode)?;
        self.simulation()?;
        self.phase = Phase::StepComplete;
        self.log.report(Status::Ok, &format!("initialized at t = {} s", self.time));
        Ok(())
    }

    pub fn terminate(&mut self) -> Outcome {
        self.allow(Call::Terminate)?;
        self.phase = Phase::Terminated;
        self.log.report(Status::Ok, &format!("terminated at t = {} s", self.time));
        Ok(())
    }

    /// Back to the state after instantiation; only the model is kept for reuse.
    pub fn reset(&mut self) -> Outcome {
        self.allow(Call::Reset)?;
        let base = presets::load(self.resources.as_deref(), presets::DEFAULT).map_err(Refusal::error)?;
        self.phase = Phase::Instantiated;
        self.preset = presets::DEFAULT.to_owned();
        self.config = base.clone();
        self.base = base;
        self.parameters.clear();
        self.inputs.clear();
        self.taken.clear();
        self.rates = Drive::default();
        (self.time, self.stop) = (0.0, None);
        self.simulation = None;
        self.last_step = Status::Ok;
        (self.failure, self.hopeless) = (None, false);
        self.log.report(Status::Ok, "reset");
        Ok(())
    }

    /// Values of variables of the FMI type `type_name`, in the order of the references.
    pub fn get(&mut self, references: &[Reference], type_name: &str) -> Outcome<Vec<Value>> {
        self.allow(Call::Get)?;
        let variables = lookup(references, type_name)?;
        if variables.iter().any(|variable| variable.causality() == Causality::Output) {
            self.simulation()?;
        }
        let mut config = self.config.clone();
        let mut inputs = self.effective_inputs();
        let outputs = self.simulation.as_ref().map(Simulation::outputs);
        let value = |variable: &Variable| {
            let value = variable.parameter(&self.preset, &mut config).or_else(|| variable.input(&mut inputs));
            let value = value.or_else(|| variable.output(outputs?));
            value.ok_or_else(|| Refusal::error(format!("{} has no value yet", variable.name)))
        };
        variables.into_iter().map(value).collect()
    }

    /// Sets variables, all or none.
    pub fn set(&mut self, references: &[Reference], values: Vec<Value>) -> Outcome {
        self.allow(Call::Set)?;
        let Some(first) = values.first() else { return Ok(()) };
        let variables = lookup(references, first.type_name())?;
        let early = matches!(self.phase, Phase::Instantiated | Phase::Initialization);
        let (mut preset, mut base) = (self.preset.clone(), self.base.clone());
        let (mut parameters, mut rates) = (self.parameters.clone(), self.rates);
        let (mut inputs, mut taken) = (self.inputs.clone(), self.taken.clone());
        for (variable, value) in variables.iter().zip(values) {
            match variable.causality() {
                Causality::Output => {
                    return Err(Refusal::error(format!("{} is an output and cannot be set", variable.name)));
                }
                Causality::Parameter if !early && !variable.tunable => {
                    let why = "is a fixed parameter and can only be set before the end of initialization";
                    return Err(Refusal::error(format!("{} {why}", variable.name)));
                }
                _ => variable.check(&value).map_err(Refusal::error)?,
            }
            match (variable.access, &value) {
                (Access::Preset, Value::String(name)) => {
                    base = presets::load(self.resources.as_deref(), name).map_err(Refusal::error)?;
                    preset.clone_from(name);
                }
                (Access::RealInput(field), _) => {
                    *field(&mut rates) = 0.0;
                    inputs.insert(variable.reference, value);
                }
                (Access::ChoiceInput(..), _) => drop(inputs.insert(variable.reference, value)),
                _ => drop(parameters.insert(variable.reference, value)),
            }
        }
        let config = with_parameters(&base, &parameters);
        if !early {
            self.take_over(&with_inputs(&config, &taken, &inputs, rates), &mut taken);
        }
        with_inputs(&config, &taken, &inputs, rates).validate().map_err(|error| Refusal::error(error.to_string()))?;
        if !early && config != self.config {
            config.validate().map_err(|error| Refusal::error(error.to_string()))?;
            if let Some(simulation) = &mut self.simulation {
                simulation.retune(&config.tuning);
            }
        }
        (self.preset, self.base, self.config) = (preset, base, config);
        (self.parameters, self.inputs, self.taken, self.rates) = (parameters, inputs, taken, rates);
        if early {
            self.simulation = None;
        }
        Ok(())
    }

    /// A quantity that becomes prescribed during a run takes over its present value, unless the master has set it; a
    /// reaction beyond its range as far as that goes.
    fn take_over(&self, next: &Inputs, taken: &mut Explicit) {
        let Some(simulation) = &self.simulation else { return };
        let (now, outputs) = (self.effective_inputs(), simulation.outputs());
        let rotation = match next.rotation {
            Rotation::Velocity => ("drive.omega", outputs.wheel_omega),
            Rotation::Moment => ("drive.moment", outputs.hub_moment),
        };
        let translation = match next.translation {
            Translation::Velocity => ("drive.velocity", outputs.wheel_velocity),
            Translation::Force => ("drive.force", outputs.hub_force_x),
        };
        let vertical = match next.vertical {
            Vertical::Force => ("drive.load", -outputs.hub_force_y),
            Vertical::Displacement => ("drive.displacement", -outputs.contact_approach),
        };
        for (switched, (name, present)) in [
            (now.rotation != next.rotation, rotation),
            (now.translation != next.translation, translation),
            (now.vertical != next.vertical, vertical),
        ] {
            let row = super::variables::variables().iter().find(|variable| variable.name == name);
            if let (true, Some(Variable { reference, kind: Kind::Real { min, max, .. }, .. })) = (switched, row) {
                taken.insert(*reference, Value::Real(present.clamp(*min, *max)));
            }
        }
    }

    /// First time derivatives of real inputs, for the next step only; all or none.
    pub fn set_input_derivatives(&mut self, references: &[Reference], orders: &[i32], values: &[f64]) -> Outcome {
        self.allow(Call::SetRealInputDerivatives)?;
        let mut rates = self.rates;
        for ((variable, order), value) in lookup(references, "Real")?.into_iter().zip(orders).zip(values) {
            let name = &variable.name;
            let Access::RealInput(field) = variable.access else {
                return Err(Refusal::error(format!("{name} is not an input")));
            };
            if *order != super::description::INPUT_DERIVATIVE_ORDER {
                return Err(Refusal::error(format!("derivative of {name} of order {order}: only order 1 is possible")));
            }
            if !value.is_finite() {
                return Err(Refusal::error(format!("der({name}) = {value} is outside its range: finite numbers")));
            }
            *field(&mut rates) = *value;
        }
        let inputs = with_inputs(&self.config, &self.taken, &self.inputs, rates);
        inputs.validate().map_err(|error| Refusal::error(error.to_string()))?;
        self.rates = rates;
        Ok(())
    }

    /// Derivative of the unknown outputs along a direction of the known inputs (see [`Simulation::difference`]).
    pub fn directional_derivative(
        &mut self,
        unknown: &[Reference],
        known: &[Reference],
        seed: &[f64],
    ) -> Outcome<Vec<f64>> {
        self.allow(Call::GetDirectionalDerivative)?;
        let mut direction = Drive::default();
        for (variable, seed) in lookup(known, "Real")?.into_iter().zip(seed) {
            let name = &variable.name;
            let Access::RealInput(field) = variable.access else {
                return Err(Refusal::error(format!("{name} is not an input: derivatives are by real inputs")));
            };
            if !seed.is_finite() {
                return Err(Refusal::error(format!("seed of {name} = {seed} is outside its range: finite numbers")));
            }
            *field(&mut direction) += seed;
        }
        let outputs = real_outputs(unknown)?;
        let failed = |error| Refusal::error(format!("directional derivative: {error}"));
        let difference = self.simulation()?.difference(&direction).map_err(failed)?;
        let quotient = |variable: &Variable| {
            let value = difference.quotient(|o| variable.real_output(o));
            let name = &variable.name;
            let failed =
                || Refusal::error(format!("directional derivative of {name} = {value}: the seed is too large"));
            value.is_finite().then_some(value).ok_or_else(failed)
        };
        outputs.into_iter().map(quotient).collect()
    }

    /// Time derivatives of outputs (see [`Simulation::rate`]).
    pub fn output_derivatives(&mut self, references: &[Reference], orders: &[i32]) -> Outcome<Vec<f64>> {
        self.allow(Call::GetRealOutputDerivatives)?;
        let outputs = real_outputs(references)?;
        for (variable, order) in outputs.iter().zip(orders) {
            if *order != super::description::OUTPUT_DERIVATIVE_ORDER {
                let name = &variable.name;
                return Err(Refusal::error(format!("derivative of {name} of order {order}: only order 1 is possible")));
            }
        }
        let simulation = self.simulation()?;
        Ok(outputs.into_iter().map(|variable| simulation.rate(|o| variable.real_output(o))).collect())
    }

    /// Simulates from the communication point `start` over `h` [s]; inputs are those set now, ramped by their
    /// derivatives, and hold their final values afterwards.
    pub fn do_step(&mut self, start: f64, h: f64) -> Outcome {
        self.allow(Call::DoStep)?;
        if !(h > 0.0 && h <= LONGEST_STEP) {
            let range = format!("more than 0, at most {LONGEST_STEP} s");
            return Err(Refusal::error(format!("communicationStepSize = {h} s is outside its range: {range}")));
        }
        let rounding = |t: f64| 16.0 * f64::EPSILON * t.abs();
        let current = (start - self.time).abs() <= POINT_TOLERANCE * h + rounding(self.time);
        if !current {
            let expected = self.time;
            let message = format!("currentCommunicationPoint = {start} s is outside its range: {expected} s");
            return Err(Refusal::error(message));
        }
        if let Some(stop) = self.stop
            && start + h > stop + STOP_TOLERANCE * h + rounding(stop)
        {
            let message = format!("step from {start} s over {h} s ends after stopTime = {stop} s");
            return Err(Refusal::error(message));
        }
        let inputs = self.effective_inputs();
        let end = inputs.at(h);
        end.validate().map_err(|error| Refusal::error(format!("at the end of the step {error}")))?;
        match self.simulation()?.advance(&inputs, h) {
            Ok(()) => {
                self.hold(end);
                self.time = start + h;
                (self.phase, self.last_step) = (Phase::StepComplete, Status::Ok);
                (self.failure, self.hopeless) = (None, false);
                Ok(())
            }
            Err(error) => {
                self.hopeless =
                    self.failure.is_some_and(|(t, length, with)| t == start && h >= length && with == inputs);
                self.failure = Some((start, h, inputs));
                (self.phase, self.last_step) = (Phase::StepFailed, Status::Discard);
                Err(Refusal::discard(format!("step from {start} s over {h} s failed: {error}")))
            }
        }
    }

    /// Copy of everything that is needed to continue from here.
    pub fn snapshot(&self) -> Outcome<Snapshot> {
        self.allow(Call::FmuState)?;
        Ok(Snapshot {
            phase: self.phase,
            preset: self.preset.clone(),
            base: self.base.clone(),
            parameters: self.parameters.clone(),
            inputs: self.inputs.clone(),
            taken: self.taken.clone(),
            rates: self.rates,
            time: self.time,
            stop: self.stop,
            checkpoint: self.simulation.as_ref().map(|simulation| simulation.checkpoint().clone()),
        })
    }

    /// Continues from a snapshot, of this instance or another; on failure nothing changes.
    pub fn restore(&mut self, snapshot: &Snapshot) -> Outcome {
        self.allow(Call::FmuState)?;
        let config = with_parameters(&snapshot.base, &snapshot.parameters);
        let refused = |error| Refusal::error(format!("state cannot be set: {error}"));
        match (&snapshot.checkpoint, &mut self.simulation) {
            (None, _) => self.simulation = None,
            (Some(checkpoint), Some(simulation)) if simulation.model().serves(&config) => {
                simulation.recall(&config.tuning, checkpoint.clone()).map_err(refused)?;
            }
            (Some(checkpoint), _) => {
                let model = self.model(config.clone())?;
                let resumed = Simulation::resume(model, config.tuning.clone(), checkpoint.clone());
                self.simulation = Some(resumed.map_err(refused)?);
            }
        }
        self.phase = snapshot.phase;
        self.preset.clone_from(&snapshot.preset);
        self.base.clone_from(&snapshot.base);
        self.parameters.clone_from(&snapshot.parameters);
        self.config = config;
        self.inputs.clone_from(&snapshot.inputs);
        self.taken.clone_from(&snapshot.taken);
        self.rates = snapshot.rates;
        (self.time, self.stop) = (snapshot.time, snapshot.stop);
        // A master may restore and repeat a discarded step for ever: the failure is remembered.
        (self.last_step, self.hopeless) = (Status::Ok, false);
        Ok(())
    }

    /// The simulation, brought up to date with parameters and inputs if it is not running yet.
    pub fn simulation(&mut self) -> Outcome<&mut Simulation> {
        if self.simulation.is_none() {
            let model = self.model(self.config.clone())?;
            let inputs = self.effective_inputs();
            let failed = |error| Refusal::error(format!("no stationary state for these inputs: {error}"));
            let tuning = self.config.tuning.clone();
            self.simulation = Some(Simulation::start(model, tuning, &inputs).map_err(failed)?);
        }
        self.simulation.as_mut().ok_or_else(|| Refusal::error("no simulation"))
    }

    /// The model with these parameters; prepared now, with logged progress, unless it is the present one.
    fn model(&mut self, config: Config) -> Outcome<Arc<Model>> {
        if let Some(model) = self.model.as_ref().filter(|model| model.serves(&config)) {
            return Ok(model.clone());
        }
        let log = &self.log;
        let mut last = (String::new(), 0.0);
        let mut progress = |what: &str, share: f64| {
            if what != last.0 || share >= last.1 + 0.1 {
                log.progress(&format!("{what}: {:.0} %", 100.0 * share));
                last = (what.to_owned(), share);
            }
        };
        let model = Model::prepare(config, self.resources.as_deref(), &mut progress);
        let model = model.map_err(|error| Refusal::error(error.to_string()))?;
        self.model = Some(model.clone());
        Ok(model)
    }

    fn effective_inputs(&self) -> Inputs {
        with_inputs(&self.config, &self.taken, &self.inputs, self.rates)
    }

    /// Keeps the values at the end of a ramp as the new inputs.
    fn hold(&mut self, mut end: Drive) {
        if self.rates == Drive::default() {
            return;
        }
        for variable in super::variables::variables() {
            if let Access::RealInput(field) = variable.access
                && *field(&mut self.rates) != 0.0
            {
                self.inputs.insert(variable.reference, Value::Real(*field(&mut end)));
            }
        }
        self.rates = Drive::default();
    }
}

/// Rows of real outputs, refusing everything else.
fn real_outputs(references: &[Reference]) -> Outcome<Vec<&'static Variable>> {
    let rows = lookup(references, "Real")?;
    match rows.iter().find(|variable| variable.causality() != Causality::Output) {
        Some(variable) => Err(Refusal::error(format!("{} is not an output", variable.name))),
        None => Ok(rows),
    }
}

/// Rows of the table, refusing unknown references and other types.
fn lookup(references: &[Reference], type_name: &str) -> Outcome<Vec<&'static Variable>> {
    let row = |reference: &Reference| {
        let unknown = || Refusal::error(format!("value reference {reference} is unknown"));
        let variable = find(*reference).ok_or_else(unknown)?;
        let theirs = variable.kind.type_name();
        if theirs == type_name {
            return Ok(variable);
        }
        Err(Refusal::error(format!("{} (value reference {reference}) is {theirs}, not {type_name}", variable.name)))
    };
    references.iter().map(row).collect()
}
