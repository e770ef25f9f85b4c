//! One slave: parameters, inputs, communication points and the running coach, without a word of C.

#[path = "../../../src/fmi/instance/aside.rs"]
#[allow(dead_code)]
pub mod aside;

use self::aside::Aside;
use super::lifecycle::{Call, Phase};
use super::log::{CallError, Log, Status};
use super::snapshot::Snapshot;
use super::variable::{Access, Reference, Value, Variable};
use super::variables::variables;
use crate::AXLES;
use crate::coupling::{Running, Seen};
use crate::parameters::Parameters;
use std::path::PathBuf;

/// Largest mismatch of a communication point, relative to the step.
const POINT_TOLERANCE: f64 = 1e-3;
/// Longest step that resolves the primary suspension \[s].
const LONGEST_STEP: f64 = 0.01;

/// A slave between `fmi2Instantiate` and `fmi2FreeInstance`.
pub struct Instance {
    log: Log,
    table: Vec<Variable>,
    phase: Phase,
    parameters: Parameters,
    seen: [Seen; AXLES],
    demand: f64,
    /// `None` until outputs are wanted, and again when a parameter changes before the first step.
    running: Option<Running>,
    time: f64,
    last_step: Status,
}

type Outcome<T = ()> = Result<T, CallError>;

impl Instance {
    /// A coach has no resources.
    pub fn new(_resources: Option<PathBuf>, log: Log) -> Outcome<Instance> {
        Ok(Instance {
            log,
            table: variables(),
            phase: Phase::Instantiated,
            parameters: Parameters::default(),
            seen: [Seen::default(); AXLES],
            demand: 1.0,
            running: None,
            time: 0.0,
            last_step: Status::Ok,
        })
    }

    /// A coach computes nothing long: it stays on the thread of the caller.
    pub fn compute_on(&mut self, _: Aside) {}

    /// Where messages go.
    pub fn log(&self) -> &Log {
        &self.log
    }

    /// Status of the last step.
    pub fn last_step(&self) -> Status {
        self.last_step
    }

    /// Communication point up to which the instance has simulated \[s].
    pub fn last_successful_time(&self) -> f64 {
        self.time
    }

    /// No step fails.
    pub fn terminated(&self) -> bool {
        false
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

    /// Switches log messages on or off.
    pub fn set_debug_logging(&mut self, on: bool, categories: &[String]) -> Outcome {
        self.allow(Call::SetDebugLogging)?;
        self.log.switch(on, categories)
    }

    /// Takes the start time \[s]; there is no tolerance, and steps may go on past the stop time.
    pub fn setup_experiment(&mut self, _tolerance: Option<f64>, start: f64, _stop: Option<f64>) -> Outcome {
        self.allow(Call::SetupExperiment)?;
        if !start.is_finite() {
            return Err(CallError::error(format!("startTime = {start:?} s is outside its range: finite numbers")));
        }
        self.time = start;
        Ok(())
    }

    /// Begins Initialization Mode.
    pub fn enter_initialization(&mut self) -> Outcome {
        self.allow(Call::EnterInitializationMode)?;
        self.phase = Phase::Initialization;
        Ok(())
    }

    /// Ends Initialization Mode.
    pub fn exit_initialization(&mut self) -> Outcome {
        self.allow(Call::ExitInitializationMode)?;
        self.phase = Phase::StepComplete;
        self.log.report(Status::Ok, &format!("initialized at t = {} s", self.time));
        Ok(())
    }

    /// Ends the run; outputs can still be read.
    pub fn terminate(&mut self) -> Outcome {
        self.allow(Call::Terminate)?;
        self.phase = Phase::Terminated;
        Ok(())
    }

    /// Back to the state after instantiation.
    pub fn reset(&mut self) -> Outcome {
        self.allow(Call::Reset)?;
        let (seen, parameters) = ([Seen::default(); AXLES], Parameters::default());
        (self.phase, self.parameters, self.seen, self.demand) = (Phase::Instantiated, parameters, seen, 1.0);
        (self.running, self.time, self.last_step) = (None, 0.0, Status::Ok);
        Ok(())
    }

    /// The coach, started if it is not running yet.
    fn running(&mut self) -> &mut Running {
        self.running.get_or_insert_with(|| Running::start(&self.parameters))
    }

    /// Simulates from the communication point `start` over `h` \[s] with the inputs set now.
    pub fn do_step(&mut self, start: f64, h: f64) -> Outcome {
        self.allow(Call::DoStep)?;
        if !(h > 0.0 && h <= LONGEST_STEP) {
            let range = format!("more than 0, at most {LONGEST_STEP} s");
            return Err(CallError::error(format!("communicationStepSize = {h:?} s is outside its range: {range}")));
        }
        if (start - self.time).abs() > POINT_TOLERANCE * h + 16.0 * f64::EPSILON * self.time.abs() {
            let expected = self.time;
            let message = format!("currentCommunicationPoint = {start:?} s is outside its range: {expected:?} s");
            return Err(CallError::error(message));
        }
        let (demand, seen, parameters) = (self.demand, self.seen, self.parameters.clone());
        self.running().step(&parameters, h, demand, &seen);
        self.time = start + h;
        (self.phase, self.last_step) = (Phase::StepComplete, Status::Ok);
        Ok(())
    }

    /// Index of a variable of a type.
    fn lookup(&self, reference: Reference, type_name: &str) -> Outcome<usize> {
        let found = self.table.iter().position(|variable| variable.reference == reference);
        let k = found.ok_or_else(|| CallError::error(format!("value reference {reference} is unknown")))?;
        let (name, theirs) = (&self.table[k].name, self.table[k].type_name());
        if theirs == type_name {
            return Ok(k);
        }
        Err(CallError::error(format!("{name} (value reference {reference}) is {theirs}, not {type_name}")))
    }

    /// Values of variables of the FMI type `type_name`.
    pub fn get(&mut self, references: &[Reference], type_name: &str) -> Outcome<Vec<Value>> {
        self.allow(Call::Get)?;
        let mut values = Vec::with_capacity(references.len());
        for reference in references {
            let access = self.table[self.lookup(*reference, type_name)?].access;
            values.push(match access {
                Access::Parameter(row) => Value::Real(self.parameters.value(row).copied().unwrap_or_default()),
                Access::Demand => Value::Real(self.demand),
                Access::Seen(axle, field) => Value::Real(*field(&mut self.seen[axle])),
                Access::Driven(axle, field) => Value::Real(field(&self.running().driven[axle])),
                Access::Output(read) => Value::Real(read(self.running())),
                Access::Valve(axle) => Value::Integer(self.running().brakes.protection.valves[axle] as i32),
            });
        }
        Ok(values)
    }

    /// Sets variables, all or none.
    pub fn set(&mut self, references: &[Reference], values: Vec<Value>) -> Outcome {
        self.allow(Call::Set)?;
        let early = matches!(self.phase, Phase::Instantiated | Phase::Initialization);
        let (mut parameters, mut seen, mut demand) = (self.parameters.clone(), self.seen, self.demand);
        for (reference, value) in references.iter().zip(values) {
            let variable = &self.table[self.lookup(*reference, value.type_name())?];
            let Value::Real(number) = value else {
                return Err(CallError::error(format!("{} is an output and cannot be set", variable.name)));
            };
            variable.check(number).map_err(CallError::error)?;
            match variable.access {
                Access::Parameter(_) if !early => {
                    let why = "is a fixed parameter and can only be set before the end of initialization";
                    return Err(CallError::error(format!("{} {why}", variable.name)));
                }
                Access::Parameter(row) => parameters.value(row).into_iter().for_each(|place| *place = number),
                Access::Demand => demand = number,
                Access::Seen(axle, field) => *field(&mut seen[axle]) = number,
                _ => return Err(CallError::error(format!("{} is an output and cannot be set", variable.name))),
            }
        }
        if parameters != self.parameters {
            self.running = None;
        }
        (self.parameters, self.seen, self.demand) = (parameters, seen, demand);
        Ok(())
    }

    /// Copy of everything that is needed to continue from here.
    pub fn snapshot(&self) -> Outcome<Snapshot> {
        self.allow(Call::FmuState)?;
        let Instance { phase, seen, demand, time, .. } = *self;
        Ok(Snapshot { phase, parameters: self.parameters.clone(), seen, demand, running: self.running.clone(), time })
    }

    /// Continues from a snapshot.
    pub fn restore(&mut self, snapshot: &Snapshot) -> Outcome {
        self.allow(Call::FmuState)?;
        let Snapshot { phase, parameters, seen, demand, running, time } = snapshot.clone();
        (self.phase, self.parameters, self.seen, self.demand) = (phase, parameters, seen, demand);
        (self.running, self.time, self.last_step) = (running, time, Status::Ok);
        Ok(())
    }

    /// Refused: the description promises none.
    pub fn directional_derivative(&self, _: &[Reference], _: &[Reference], _: &[f64]) -> Outcome<Vec<f64>> {
        self.allow(Call::GetDirectionalDerivative)?;
        Err(CallError::error("directional derivatives are not provided"))
    }

    /// Refused: the description promises none.
    pub fn set_input_derivatives(&mut self, _: &[Reference], _: &[i32], _: &[f64]) -> Outcome {
        self.allow(Call::SetRealInputDerivatives)?;
        Err(CallError::error("inputs are held: derivatives cannot be set"))
    }

    /// Refused: the description promises none.
    pub fn output_derivatives(&self, _: &[Reference], _: &[i32]) -> Outcome<Vec<f64>> {
        self.allow(Call::GetRealOutputDerivatives)?;
        Err(CallError::error("derivatives of outputs are not provided"))
    }
}
