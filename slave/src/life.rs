//! The state that all slaves share, and the rules that follow from it.

use crate::aside::{Aside, here};
use crate::lifecycle::{Call, Phase};
use crate::log::{CallError, Log, Outcome, Status};

/// Largest mismatch of a communication point, relative to the step, besides rounding.
const POINT_TOLERANCE: f64 = 1e-3;
/// Largest distance from the end of a step to the stop time, relative to the step, besides rounding: sums of many steps
/// are off.
const STOP_TOLERANCE: f64 = 0.1;

/// Phase, communication point and log of an instance.
pub struct Life {
    pub(crate) log: Log,
    pub(crate) name: String,
    pub(crate) aside: Aside,
    pub(crate) early_return: bool,
    pub(crate) phase: Phase,
    pub(crate) time: f64,
    pub(crate) stop: Option<f64>,
    pub(crate) last_step: Status,
}

impl Life {
    /// Life of an instance that has just been made.
    pub(crate) fn new(log: Log) -> Life {
        let name = String::new();
        Life {
            log,
            name,
            aside: here,
            early_return: false,
            phase: Phase::Instantiated,
            time: 0.0,
            stop: None,
            last_step: Status::Ok,
        }
    }

    /// Returns to the state after instantiation; log, name, thread and early return stay.
    pub(crate) fn reset(&mut self) {
        (self.phase, self.time, self.stop, self.last_step) = (Phase::Instantiated, 0.0, None, Status::Ok);
    }

    /// Receiver of messages.
    pub fn log(&self) -> &Log {
        &self.log
    }

    /// Name by which the master knows the instance; empty if it has none.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Thread of long computations.
    pub fn aside(&self) -> Aside {
        self.aside
    }

    /// True if a master allows steps to end early.
    pub fn may_return_early(&self) -> bool {
        self.early_return
    }

    /// Present phase.
    pub fn phase(&self) -> Phase {
        self.phase
    }

    /// Communication point up to which the instance has simulated \[s].
    pub fn time(&self) -> f64 {
        self.time
    }

    /// True before the end of initialization, while start values and fixed parameters may be set.
    pub fn is_early(&self) -> bool {
        matches!(self.phase, Phase::Instantiated | Phase::Initialization)
    }

    /// Refuses calls that are illegal in the present phase.
    pub fn allow(&self, call: Call) -> Outcome {
        if call.legal(self.phase) {
            return Ok(());
        }
        let status = if self.phase == Phase::Fatal { Status::Fatal } else { Status::Error };
        Err(CallError { status, message: format!("{call:?} is not allowed in phase {:?}", self.phase) })
    }

    /// Takes start and stop time \[s] of the experiment.
    pub(crate) fn set_times(&mut self, start: f64, stop: Option<f64>) -> Outcome {
        if !start.is_finite() {
            return Err(CallError::error(format!("startTime = {start:?} s is outside its range: finite numbers")));
        }
        if let Some(stop) = stop
            && !(stop.is_finite() && stop >= start)
        {
            return Err(CallError::error(format!("stopTime = {stop:?} s is outside its range: at least {start:?} s")));
        }
        (self.time, self.stop) = (start, stop);
        Ok(())
    }

    /// Refuses a step from `start` over `h` \[s] that is longer than `longest`, does not begin at the communication
    /// point or ends after the stop time.
    pub(crate) fn check_step(&self, start: f64, h: f64, longest: f64) -> Outcome {
        if !(h > 0.0 && h <= longest) {
            let range = format!("more than 0, at most {longest} s");
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
        Ok(())
    }
}
