//! The functions of the standard, each for any type of slave.

use super::marshal::{boolean, question};
use super::types::*;
use crate::c_abi::call;
use crate::c_abi::component::Component;
use crate::c_abi::marshal::{slice, store, text};
use crate::instance::ScalarAccess;
use crate::lifecycle::Call;
use crate::log::{CallError, Outcome};
use std::ffi::{c_char, c_int};

/// Sizes of the types of the interface.
pub fn fmi2GetTypesPlatform() -> *const c_char {
    c"default".as_ptr()
}

/// Version of the standard.
pub fn fmi2GetVersion() -> *const c_char {
    c"2.0".as_ptr()
}

impl<S: ScalarAccess> Component<S> {
    /// Refuses questions about the last step other than the one that a function answers.
    fn answers(&self, kind: c_int, answered: Option<Question>) -> Outcome {
        self.instance.life().allow(Call::GetStatus)?;
        let question = question(kind)?;
        if answered == Some(question) {
            return Ok(());
        }
        Err(CallError::discard(format!("{} is not available through this function", question.name())))
    }
}

/// Switches log messages on or off, all or those of some categories.
pub unsafe fn fmi2SetDebugLogging<S: ScalarAccess>(
    c: fmi2Component,
    loggingOn: fmi2Boolean,
    nCategories: usize,
    categories: *const fmi2String,
) -> fmi2Status {
    // SAFETY: see the module.
    unsafe {
        call::<S>(c, "fmi2SetDebugLogging", |component| {
            let names = slice(categories, nCategories, "categories")?;
            let names = names.iter().map(|name| text(*name, "category")).collect::<Outcome<Vec<_>>>()?;
            component.instance.set_debug_logging(boolean(loggingOn, "loggingOn")?, &names)
        })
    }
}

/// Takes times and tolerance of the experiment.
pub unsafe fn fmi2SetupExperiment<S: ScalarAccess>(
    c: fmi2Component,
    toleranceDefined: fmi2Boolean,
    tolerance: fmi2Real,
    startTime: fmi2Real,
    stopTimeDefined: fmi2Boolean,
    stopTime: fmi2Real,
) -> fmi2Status {
    // SAFETY: see the module.
    unsafe {
        call::<S>(c, "fmi2SetupExperiment", |component| {
            let tolerance = boolean(toleranceDefined, "toleranceDefined")?.then_some(tolerance);
            let stop = boolean(stopTimeDefined, "stopTimeDefined")?.then_some(stopTime);
            component.instance.setup_experiment(tolerance, startTime, stop)
        })
    }
}

/// Begins Initialization Mode.
pub unsafe fn fmi2EnterInitializationMode<S: ScalarAccess>(c: fmi2Component) -> fmi2Status {
    // SAFETY: see the module.
    unsafe { call::<S>(c, "fmi2EnterInitializationMode", |component| component.instance.enter_initialization()) }
}

/// Ends Initialization Mode.
pub unsafe fn fmi2ExitInitializationMode<S: ScalarAccess>(c: fmi2Component) -> fmi2Status {
    // SAFETY: see the module.
    unsafe { call::<S>(c, "fmi2ExitInitializationMode", |component| component.instance.exit_initialization()) }
}

/// Ends the run; outputs can still be read.
pub unsafe fn fmi2Terminate<S: ScalarAccess>(c: fmi2Component) -> fmi2Status {
    // SAFETY: see the module.
    unsafe { call::<S>(c, "fmi2Terminate", |component| component.instance.terminate()) }
}

/// Returns to the state after instantiation.
pub unsafe fn fmi2Reset<S: ScalarAccess>(c: fmi2Component) -> fmi2Status {
    // SAFETY: see the module.
    unsafe { call::<S>(c, "fmi2Reset", |component| component.instance.reset()) }
}

/// Saves the state, in the place of an earlier one if the variable holds one.
pub unsafe fn fmi2GetFMUstate<S: ScalarAccess>(c: fmi2Component, FMUstate: *mut fmi2FMUstate) -> fmi2Status {
    // SAFETY: see the module.
    unsafe { call::<S>(c, "fmi2GetFMUstate", |component| component.save_state(FMUstate)) }
}

/// Continues from a saved state.
pub unsafe fn fmi2SetFMUstate<S: ScalarAccess>(c: fmi2Component, FMUstate: fmi2FMUstate) -> fmi2Status {
    // SAFETY: see the module.
    unsafe { call::<S>(c, "fmi2SetFMUstate", |component| component.restore_state(FMUstate)) }
}

/// Forgets a saved state; ignores calls without a state, as the standard asks.
pub unsafe fn fmi2FreeFMUstate<S: ScalarAccess>(c: fmi2Component, FMUstate: *mut fmi2FMUstate) -> fmi2Status {
    // SAFETY: see the module.
    unsafe { call::<S>(c, "fmi2FreeFMUstate", |component| component.free_state(FMUstate)) }
}

/// Number of bytes of a serialized state.
pub unsafe fn fmi2SerializedFMUstateSize<S: ScalarAccess>(
    c: fmi2Component,
    FMUstate: fmi2FMUstate,
    size: *mut usize,
) -> fmi2Status {
    // SAFETY: see the module.
    unsafe { call::<S>(c, "fmi2SerializedFMUstateSize", |component| component.state_size(FMUstate, size)) }
}

/// Writes a saved state as bytes.
pub unsafe fn fmi2SerializeFMUstate<S: ScalarAccess>(
    c: fmi2Component,
    FMUstate: fmi2FMUstate,
    serializedState: *mut fmi2Byte,
    size: usize,
) -> fmi2Status {
    // SAFETY: see the module.
    unsafe {
        call::<S>(c, "fmi2SerializeFMUstate", |component| {
            component.serialize_state(FMUstate, serializedState.cast(), size)
        })
    }
}

/// Reads a saved state from bytes.
pub unsafe fn fmi2DeSerializeFMUstate<S: ScalarAccess>(
    c: fmi2Component,
    serializedState: *const fmi2Byte,
    size: usize,
    FMUstate: *mut fmi2FMUstate,
) -> fmi2Status {
    // SAFETY: see the module.
    unsafe {
        call::<S>(c, "fmi2DeSerializeFMUstate", |component| {
            component.deserialize_state(serializedState.cast(), size, FMUstate)
        })
    }
}

/// Derivatives of outputs along a direction of inputs.
pub unsafe fn fmi2GetDirectionalDerivative<S: ScalarAccess>(
    c: fmi2Component,
    vUnknown_ref: *const fmi2ValueReference,
    nUnknown: usize,
    vKnown_ref: *const fmi2ValueReference,
    nKnown: usize,
    dvKnown: *const fmi2Real,
    dvUnknown: *mut fmi2Real,
) -> fmi2Status {
    // SAFETY: see the module.
    unsafe {
        call::<S>(c, "fmi2GetDirectionalDerivative", |component| {
            let unknown = slice(vUnknown_ref, nUnknown, "vUnknown_ref")?;
            let (known, seed) = (slice(vKnown_ref, nKnown, "vKnown_ref")?, slice(dvKnown, nKnown, "dvKnown")?);
            store(dvUnknown, component.instance.directional_derivative(unknown, known, seed)?, "dvUnknown")
        })
    }
}

/// Sets time derivatives of inputs during the next step.
pub unsafe fn fmi2SetRealInputDerivatives<S: ScalarAccess>(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    order: *const fmi2Integer,
    value: *const fmi2Real,
) -> fmi2Status {
    // SAFETY: see the module.
    unsafe {
        call::<S>(c, "fmi2SetRealInputDerivatives", |component| {
            let (orders, values) = (slice(order, nvr, "order")?, slice(value, nvr, "value")?);
            component.instance.set_input_derivatives(slice(vr, nvr, "vr")?, orders, values)
        })
    }
}

/// Time derivatives of outputs.
pub unsafe fn fmi2GetRealOutputDerivatives<S: ScalarAccess>(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    order: *const fmi2Integer,
    value: *mut fmi2Real,
) -> fmi2Status {
    // SAFETY: see the module.
    unsafe {
        call::<S>(c, "fmi2GetRealOutputDerivatives", |component| {
            let (references, orders) = (slice(vr, nvr, "vr")?, slice(order, nvr, "order")?);
            store(value, component.instance.output_derivatives(references, orders)?, "value")
        })
    }
}

/// Simulates one step. Saved states stay until the master frees them, whatever it promises about using them.
pub unsafe fn fmi2DoStep<S: ScalarAccess>(
    c: fmi2Component,
    currentCommunicationPoint: fmi2Real,
    communicationStepSize: fmi2Real,
    noSetFMUStatePriorToCurrentPoint: fmi2Boolean,
) -> fmi2Status {
    // SAFETY: see the module.
    unsafe {
        call::<S>(c, "fmi2DoStep", |component| {
            boolean(noSetFMUStatePriorToCurrentPoint, "noSetFMUStatePriorToCurrentPoint")?;
            component.instance.do_step(currentCommunicationPoint, communicationStepSize)
        })
    }
}

/// Refused in every phase: steps are never asynchronous.
pub unsafe fn fmi2CancelStep<S: ScalarAccess>(c: fmi2Component) -> fmi2Status {
    // SAFETY: see the module.
    unsafe { call::<S>(c, "fmi2CancelStep", |component| component.instance.life().allow(Call::CancelStep)) }
}

/// Status of the last step.
pub unsafe fn fmi2GetStatus<S: ScalarAccess>(c: fmi2Component, s: c_int, value: *mut fmi2Status) -> fmi2Status {
    // SAFETY: see the module.
    unsafe {
        call::<S>(c, "fmi2GetStatus", |component| {
            component.answers(s, Some(Question::DoStepStatus))?;
            store(value, vec![component.instance.last_step()], "value")
        })
    }
}

/// Communication point up to which the instance has simulated.
pub unsafe fn fmi2GetRealStatus<S: ScalarAccess>(c: fmi2Component, s: c_int, value: *mut fmi2Real) -> fmi2Status {
    // SAFETY: see the module.
    unsafe {
        call::<S>(c, "fmi2GetRealStatus", |component| {
            component.answers(s, Some(Question::LastSuccessfulTime))?;
            store(value, vec![component.instance.last_successful_time()], "value")
        })
    }
}

/// Answer to the question whether repeating the last step is pointless.
pub unsafe fn fmi2GetBooleanStatus<S: ScalarAccess>(c: fmi2Component, s: c_int, value: *mut fmi2Boolean) -> fmi2Status {
    // SAFETY: see the module.
    unsafe {
        call::<S>(c, "fmi2GetBooleanStatus", |component| {
            component.answers(s, Some(Question::Terminated))?;
            store(value, vec![component.instance.terminated().into()], "value")
        })
    }
}

/// Refused: no question has an integer for its answer.
pub unsafe fn fmi2GetIntegerStatus<S: ScalarAccess>(
    c: fmi2Component,
    s: c_int,
    _value: *mut fmi2Integer,
) -> fmi2Status {
    // SAFETY: see the module.
    unsafe { call::<S>(c, "fmi2GetIntegerStatus", |component| component.answers(s, None)) }
}

/// Refused: steps are never pending, so there is nothing to tell about them.
pub unsafe fn fmi2GetStringStatus<S: ScalarAccess>(c: fmi2Component, s: c_int, _value: *mut fmi2String) -> fmi2Status {
    // SAFETY: see the module.
    unsafe { call::<S>(c, "fmi2GetStringStatus", |component| component.answers(s, None)) }
}
