//! The trait of a model, and the instance that a master drives around it.

use crate::aside::Aside;
use crate::course::Inquiry;
use crate::life::Life;
use crate::lifecycle::{Call, Phase};
use crate::log::{CallError, Log, Outcome, Status};
use crate::snapshot::Snapshot;
use crate::value::{Reference, Scalar, Type};
use std::path::PathBuf;

/// A model that can be driven as a slave of co-simulation, whatever the version of the standard.
///
/// An [`Instance`] calls these functions only where the standard allows it. A function that returns an error leaves the
/// model as it was.
pub trait Slave: Sized + 'static {
    /// Memory that is needed to continue a run, besides phase and times.
    type State: Clone;

    /// Longest communication step \[s].
    const LONGEST_STEP: f64;

    /// A model with its default parameters. `resources` is the directory `resources` of the unpacked FMU, if known.
    fn new(resources: Option<PathBuf>) -> Outcome<Self>;

    /// Takes the relative tolerance \[1] of the experiment, `None` if the master defines none.
    fn set_tolerance(&mut self, _tolerance: Option<f64>, _life: &Life) {}

    /// Ends the initialization: parameters and inputs are complete. Returns a remark for the log, or an empty text.
    fn initialize(&mut self, life: &Life) -> Outcome<String>;

    /// Ends the run; outputs can still be read.
    fn terminate(&mut self, _life: &Life) -> Outcome {
        Ok(())
    }

    /// Returns to the state after instantiation.
    fn reset(&mut self) -> Outcome;

    /// Simulates from `start` over `h` \[s]. An error of status [`Status::Discard`] says that the step could not be
    /// computed; the model then stands where it was.
    fn step(&mut self, start: f64, h: f64, life: &Life) -> Outcome;

    /// Simulates from `start` over at most `h` \[s], to an event that its master wants to know of; returns the time it took, exactly
    /// `h` without one. Errors are those of [`Slave::step`].
    fn step_to_event(&mut self, start: f64, h: f64, life: &Life) -> Outcome<f64> {
        self.step(start, h, life).map(|()| h)
    }

    /// True if repeating the last, discarded step is pointless.
    fn is_hopeless(&self) -> bool {
        false
    }

    /// Copy of everything that is needed to continue from here.
    fn save(&self) -> Self::State;

    /// Continues from a saved state, of this model or another of its kind.
    fn restore(&mut self, state: &Self::State, life: &Life) -> Outcome;

    /// A saved state as bytes.
    fn to_bytes(_snapshot: &Snapshot<Self::State>) -> Result<Vec<u8>, String> {
        Err("states of this FMU cannot be serialized".to_owned())
    }

    /// The saved state that bytes contain.
    fn from_bytes(_bytes: &[u8]) -> Result<Snapshot<Self::State>, String> {
        Err("states of this FMU cannot be serialized".to_owned())
    }
}

/// Access to a slave through scalar variables, as FMI 2.0 has it.
pub trait ScalarAccess: Slave {
    /// Values of variables as the model keeps them.
    type Value: From<Scalar> + TryInto<Scalar>;

    /// The GUID of the model description.
    fn guid() -> String;

    /// Name of a variable, for messages.
    fn name_of(reference: Reference) -> Option<String>;

    /// Values of variables of one type, in the order of the references.
    fn get(&mut self, references: &[Reference], wanted: Type, life: &Life) -> Outcome<Vec<Self::Value>>;

    /// Sets variables, all or none; there is a value for every reference.
    fn set(&mut self, references: &[Reference], values: Vec<Self::Value>, life: &Life) -> Outcome;

    /// Derivatives of outputs along a direction of inputs: `seed` has a component for every known.
    fn directional_derivative(
        &mut self,
        _unknown: &[Reference],
        _known: &[Reference],
        _seed: &[f64],
        _life: &Life,
    ) -> Outcome<Vec<f64>> {
        Err(CallError::error("directional derivatives are not provided"))
    }

    /// Sets time derivatives of real inputs during the next step, all or none.
    fn set_input_derivatives(&mut self, _references: &[Reference], _orders: &[i32], _values: &[f64]) -> Outcome {
        Err(CallError::error("inputs are held: derivatives cannot be set"))
    }

    /// Time derivatives of real outputs.
    fn output_derivatives(&mut self, _references: &[Reference], _orders: &[i32], _life: &Life) -> Outcome<Vec<f64>> {
        Err(CallError::error("derivatives of outputs are not provided"))
    }
}

/// A slave between its instantiation and its release: a model with its life, without a word of C.
///
/// Every refused call leaves the instance as it was, so a master may report the error and go on.
pub struct Instance<S: Slave> {
    life: Life,
    slave: S,
    /// Variables that the master may set within steps, in their order.
    pub(crate) intermediate: Vec<Reference>,
    /// Questions about the step that comes next, while they are asked.
    pub(crate) inquiry: Option<Inquiry>,
}

impl<S: Slave> Instance<S> {
    /// A new instance. `resources` is the directory `resources` of the unpacked FMU, if known.
    pub fn new(resources: Option<PathBuf>, log: Log) -> Outcome<Self> {
        Ok(Self { life: Life::new(log), slave: S::new(resources)?, intermediate: Vec::new(), inquiry: None })
    }

    /// Runs long computations by `aside` from now on.
    pub fn compute_on(&mut self, aside: Aside) {
        self.life.aside = aside;
    }

    /// Lets steps end early, at events.
    pub fn allow_early_return(&mut self, allowed: bool) {
        self.life.early_return = allowed;
    }

    /// Takes the name by which the master knows the instance.
    pub fn take_name(&mut self, name: String) {
        self.life.name = name;
    }

    /// Phase, communication point and log.
    pub fn life(&self) -> &Life {
        &self.life
    }

    /// Receiver of messages.
    pub fn log(&self) -> &Log {
        &self.life.log
    }

    /// The model.
    pub fn slave(&self) -> &S {
        &self.slave
    }

    /// The model, to be changed, with its life.
    pub fn parts(&mut self) -> (&mut S, &Life) {
        (&mut self.slave, &self.life)
    }

    /// Status of the last step.
    pub fn last_step(&self) -> Status {
        self.life.last_step
    }

    /// Communication point up to which the instance has simulated \[s].
    pub fn last_successful_time(&self) -> f64 {
        self.life.time
    }

    /// True if repeating the last, discarded step is pointless.
    pub fn terminated(&self) -> bool {
        self.slave.is_hopeless()
    }

    /// Begins another phase of life.
    pub(crate) fn enter(&mut self, phase: Phase) {
        self.life.phase = phase;
    }

    /// Marks the instance as beyond repair, after a panic.
    pub fn give_up(&mut self) {
        self.life.phase = Phase::Fatal;
    }

    /// Switches log messages on or off, all or those of some categories.
    pub fn set_debug_logging(&mut self, on: bool, categories: &[String]) -> Outcome {
        self.life.allow(Call::SetDebugLogging)?;
        self.life.log.switch(on, categories)
    }

    /// Takes times \[s] and relative tolerance \[1] of the experiment.
    pub fn setup_experiment(&mut self, tolerance: Option<f64>, start: f64, stop: Option<f64>) -> Outcome {
        self.life.allow(Call::SetupExperiment)?;
        if let Some(tolerance) = tolerance
            && !(tolerance.is_finite() && tolerance > 0.0)
        {
            return Err(CallError::error(format!("tolerance = {tolerance:?} is outside its range: positive numbers")));
        }
        self.life.set_times(start, stop)?;
        self.slave.set_tolerance(tolerance, &self.life);
        Ok(())
    }

    /// Begins Initialization Mode.
    pub fn enter_initialization(&mut self) -> Outcome {
        self.life.allow(Call::EnterInitializationMode)?;
        self.life.phase = Phase::Initialization;
        Ok(())
    }

    /// Ends Initialization Mode. If parameters and inputs do not go together, it stays, so that they can be corrected.
    pub fn exit_initialization(&mut self) -> Outcome {
        self.life.allow(Call::ExitInitializationMode)?;
        let remark = self.slave.initialize(&self.life)?;
        self.life.phase = Phase::StepComplete;
        let separator = if remark.is_empty() { "" } else { ", " };
        self.life.log.report(Status::Ok, &format!("initialized at t = {} s{separator}{remark}", self.life.time));
        Ok(())
    }

    /// Ends the run; outputs can still be read.
    pub fn terminate(&mut self) -> Outcome {
        self.life.allow(Call::Terminate)?;
        self.slave.terminate(&self.life)?;
        self.life.phase = Phase::Terminated;
        self.life.log.report(Status::Ok, &format!("terminated at t = {} s", self.life.time));
        Ok(())
    }

    /// Returns to the state after instantiation.
    pub fn reset(&mut self) -> Outcome {
        self.life.allow(Call::Reset)?;
        self.slave.reset()?;
        self.life.reset();
        self.life.log.report(Status::Ok, "reset");
        Ok(())
    }

    /// Simulates from the communication point `start` over `h` \[s] with the inputs set now, or to an event where steps may end
    /// early. The time reached is that of [`Instance::last_successful_time`].
    pub fn do_step(&mut self, start: f64, h: f64) -> Outcome {
        self.step_by(start, h, |slave, life| match life.early_return {
            true => slave.step_to_event(start, h, life),
            false => slave.step(start, h, life).map(|()| h),
        })
    }

    /// Simulates one step as `compute` does, which returns the time it took \[s].
    pub(crate) fn step_by(
        &mut self,
        start: f64,
        h: f64,
        compute: impl FnOnce(&mut S, &Life) -> Outcome<f64>,
    ) -> Outcome {
        self.life.allow(Call::DoStep)?;
        self.life.check_step(start, h, S::LONGEST_STEP)?;
        let done = compute(&mut self.slave, &self.life);
        match &done {
            Ok(reached) => {
                self.life.time = start + reached;
                (self.life.phase, self.life.last_step) = (Phase::StepComplete, Status::Ok);
            }
            Err(error) if error.status == Status::Discard => {
                (self.life.phase, self.life.last_step) = (Phase::StepFailed, Status::Discard);
            }
            Err(_) => {}
        }
        done.map(drop)
    }

    /// Copy of everything that is needed to continue from here.
    pub fn snapshot(&self) -> Outcome<Snapshot<S::State>> {
        self.life.allow(Call::FmuState)?;
        let Life { phase, time, stop, .. } = self.life;
        Ok(Snapshot { phase, time, stop, state: self.slave.save() })
    }

    /// Continues from a snapshot, of this instance or another.
    pub fn restore(&mut self, snapshot: &Snapshot<S::State>) -> Outcome {
        self.life.allow(Call::FmuState)?;
        self.slave.restore(&snapshot.state, &self.life)?;
        (self.life.phase, self.life.last_step) = (snapshot.phase, Status::Ok);
        (self.life.time, self.life.stop) = (snapshot.time, snapshot.stop);
        Ok(())
    }
}

impl<S: ScalarAccess> Instance<S> {
    /// Values of variables of one type, in the order of the references.
    pub fn get(&mut self, references: &[Reference], wanted: Type) -> Outcome<Vec<S::Value>> {
        self.life.allow(Call::Get)?;
        self.slave.get(references, wanted, &self.life)
    }

    /// Sets variables, all or none.
    pub fn set(&mut self, references: &[Reference], values: Vec<S::Value>) -> Outcome {
        self.life.allow(Call::Set)?;
        self.slave.set(references, values, &self.life)
    }

    /// Derivatives of outputs along a direction of inputs.
    pub fn directional_derivative(
        &mut self,
        unknown: &[Reference],
        known: &[Reference],
        seed: &[f64],
    ) -> Outcome<Vec<f64>> {
        self.life.allow(Call::GetDirectionalDerivative)?;
        self.slave.directional_derivative(unknown, known, seed, &self.life)
    }

    /// Sets time derivatives of real inputs during the next step, all or none.
    pub fn set_input_derivatives(&mut self, references: &[Reference], orders: &[i32], values: &[f64]) -> Outcome {
        self.life.allow(Call::SetRealInputDerivatives)?;
        self.slave.set_input_derivatives(references, orders, values)
    }

    /// Time derivatives of real outputs.
    pub fn output_derivatives(&mut self, references: &[Reference], orders: &[i32]) -> Outcome<Vec<f64>> {
        self.life.allow(Call::GetRealOutputDerivatives)?;
        self.slave.output_derivatives(references, orders, &self.life)
    }
}
