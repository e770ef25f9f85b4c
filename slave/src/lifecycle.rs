//! Legal calls in each phase of life: the state machine of FMI 2.0, section 4.2.4, as data. Functions of FMI 3.0 are legal
//! where those of the same purpose are.

use serde::{Deserialize, Serialize};

/// Phase in the life of an instance; one bit each.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[repr(u8)]
pub enum Phase {
    /// After `fmi2Instantiate` or `fmi2Reset`.
    Instantiated = 1,
    /// Between `fmi2EnterInitializationMode` and `fmi2ExitInitializationMode`.
    Initialization = 2,
    /// Ready for the next step.
    StepComplete = 4,
    /// The last step was discarded; the instance stands where that step began.
    StepFailed = 8,
    /// After `fmi2Terminate`.
    Terminated = 16,
    /// After a panic: nothing can be trusted, only `fmi2FreeInstance` is left.
    Fatal = 32,
    /// Within a step, while the master is asked for values: Intermediate Update Mode.
    Intermediate = 64,
}

/// Groups of functions with the same rule.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Call {
    /// `fmi2SetDebugLogging`.
    SetDebugLogging,
    /// `fmi2SetupExperiment`.
    SetupExperiment,
    /// `fmi2EnterInitializationMode`.
    EnterInitializationMode,
    /// `fmi2ExitInitializationMode`.
    ExitInitializationMode,
    /// `fmi2Terminate`.
    Terminate,
    /// `fmi2Reset`.
    Reset,
    /// `fmi2GetReal`, `…Integer`, `…Boolean`, `…String`.
    Get,
    /// `fmi3GetFloat64`, `…Int32`, `…Int64`, `…Boolean`, `…String`: start values before initialization as well.
    GetOrStart,
    /// `fmi2SetReal`, `…Integer`, `…Boolean`, `…String`; parameters only before the first step.
    Set,
    /// `fmi3SetFloat64` within a step.
    SetIntermediate,
    /// `fmi2GetFMUstate` and its family, including serialization.
    FmuState,
    /// `fmi2GetDirectionalDerivative`.
    GetDirectionalDerivative,
    /// `fmi2SetRealInputDerivatives`.
    SetRealInputDerivatives,
    /// `fmi2GetRealOutputDerivatives`.
    GetRealOutputDerivatives,
    /// `fmi2DoStep`.
    DoStep,
    /// `fmi2CancelStep`.
    CancelStep,
    /// `fmi2GetStatus`, `…RealStatus`, `…IntegerStatus`, `…BooleanStatus`, `…StringStatus`.
    GetStatus,
}

const INSTANTIATED: u8 = Phase::Instantiated as u8;
const INITIALIZATION: u8 = Phase::Initialization as u8;
const COMPLETE: u8 = Phase::StepComplete as u8;
const FAILED: u8 = Phase::StepFailed as u8;
const TERMINATED: u8 = Phase::Terminated as u8;
const INTERMEDIATE: u8 = Phase::Intermediate as u8;
const ALIVE: u8 = INSTANTIATED | INITIALIZATION | COMPLETE | FAILED | TERMINATED;

impl Call {
    /// Phases in which the call is legal.
    ///
    /// A discarded step is rolled back completely, so after it a master may change inputs and step again; this
    /// extends the standard, which asks for `fmi2SetFMUstate` first.
    const fn mask(self) -> u8 {
        match self {
            Call::SetDebugLogging | Call::Reset | Call::FmuState => ALIVE,
            Call::SetupExperiment | Call::EnterInitializationMode => INSTANTIATED,
            Call::ExitInitializationMode => INITIALIZATION,
            Call::Terminate | Call::DoStep => COMPLETE | FAILED,
            Call::Get | Call::GetDirectionalDerivative => INITIALIZATION | COMPLETE | FAILED | TERMINATED,
            Call::GetOrStart => ALIVE,
            Call::Set | Call::SetRealInputDerivatives => INSTANTIATED | INITIALIZATION | COMPLETE | FAILED,
            Call::GetRealOutputDerivatives | Call::GetStatus => COMPLETE | FAILED | TERMINATED,
            Call::SetIntermediate => INTERMEDIATE,
            // Steps are never asynchronous: there is none to cancel.
            Call::CancelStep => 0,
        }
    }

    /// True if the call is legal in the phase.
    pub const fn legal(self, phase: Phase) -> bool {
        self.mask() & phase as u8 != 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_legal_after_a_fatal_error() {
        for call in [Call::Reset, Call::Get, Call::Set, Call::DoStep, Call::FmuState, Call::Terminate] {
            assert!(!call.legal(Phase::Fatal), "{call:?}");
        }
    }

    #[test]
    fn steps_only_run_between_initialization_and_termination() {
        assert!(!Call::DoStep.legal(Phase::Instantiated) && !Call::DoStep.legal(Phase::Initialization));
        assert!(Call::DoStep.legal(Phase::StepComplete) && !Call::DoStep.legal(Phase::Terminated));
    }
}
