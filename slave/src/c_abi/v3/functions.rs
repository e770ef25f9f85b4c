//! The functions of the standard, each for any type of slave; values are in `values`.

use super::types::*;
use crate::c_abi::call;
use crate::c_abi::marshal::{slice, text};
use crate::instance::Slave;
use crate::lifecycle::Call;
use crate::log::{CallError, Outcome};
use std::ffi::c_char;

/// Version of the standard.
pub fn fmi3GetVersion() -> *const c_char {
    c"3.0".as_ptr()
}

/// Refuses a function that belongs to a capability which this FMU does not have.
pub unsafe fn refused<S: Slave>(instance: fmi3Instance, name: &str, why: &str) -> fmi3Status {
    // SAFETY: see the module.
    unsafe {
        call::<S>(instance, name, |component| {
            component.instance.life().allow(Call::SetDebugLogging)?;
            Err(CallError::error(format!("this FMU {why}")))
        })
    }
}

/// Switches log messages on or off, all or those of some categories.
pub unsafe fn fmi3SetDebugLogging<S: Slave>(
    instance: fmi3Instance,
    loggingOn: fmi3Boolean,
    nCategories: usize,
    categories: *const fmi3String,
) -> fmi3Status {
    // SAFETY: see the module.
    unsafe {
        call::<S>(instance, "fmi3SetDebugLogging", |component| {
            let names = slice(categories, nCategories, "categories")?;
            let names = names.iter().map(|name| text(*name, "category")).collect::<Outcome<Vec<_>>>()?;
            component.instance.set_debug_logging(boolean(loggingOn, "loggingOn")?, &names)
        })
    }
}

/// Takes times and tolerance of the experiment, and begins Initialization Mode.
pub unsafe fn fmi3EnterInitializationMode<S: Slave>(
    instance: fmi3Instance,
    toleranceDefined: fmi3Boolean,
    tolerance: fmi3Float64,
    startTime: fmi3Float64,
    stopTimeDefined: fmi3Boolean,
    stopTime: fmi3Float64,
) -> fmi3Status {
    // SAFETY: see the module.
    unsafe {
        call::<S>(instance, "fmi3EnterInitializationMode", |component| {
            let tolerance = boolean(toleranceDefined, "toleranceDefined")?.then_some(tolerance);
            let stop = boolean(stopTimeDefined, "stopTimeDefined")?.then_some(stopTime);
            component.instance.setup_experiment(tolerance, startTime, stop)?;
            component.instance.enter_initialization()
        })
    }
}

/// Ends Initialization Mode; Step Mode begins.
pub unsafe fn fmi3ExitInitializationMode<S: Slave>(instance: fmi3Instance) -> fmi3Status {
    // SAFETY: see the module.
    unsafe { call::<S>(instance, "fmi3ExitInitializationMode", |component| component.instance.exit_initialization()) }
}

/// Ends the run; outputs can still be read.
pub unsafe fn fmi3Terminate<S: Slave>(instance: fmi3Instance) -> fmi3Status {
    // SAFETY: see the module.
    unsafe { call::<S>(instance, "fmi3Terminate", |component| component.instance.terminate()) }
}

/// Returns to the state after instantiation.
pub unsafe fn fmi3Reset<S: Slave>(instance: fmi3Instance) -> fmi3Status {
    // SAFETY: see the module.
    unsafe { call::<S>(instance, "fmi3Reset", |component| component.instance.reset()) }
}

/// Saves the state, in the place of an earlier one if the variable holds one.
pub unsafe fn fmi3GetFMUState<S: Slave>(instance: fmi3Instance, FMUState: *mut fmi3FMUState) -> fmi3Status {
    // SAFETY: see the module.
    unsafe { call::<S>(instance, "fmi3GetFMUState", |component| component.save_state(FMUState)) }
}

/// Continues from a saved state.
pub unsafe fn fmi3SetFMUState<S: Slave>(instance: fmi3Instance, FMUState: fmi3FMUState) -> fmi3Status {
    // SAFETY: see the module.
    unsafe { call::<S>(instance, "fmi3SetFMUState", |component| component.restore_state(FMUState)) }
}

/// Forgets a saved state; ignores calls without a state, as the standard asks.
pub unsafe fn fmi3FreeFMUState<S: Slave>(instance: fmi3Instance, FMUState: *mut fmi3FMUState) -> fmi3Status {
    // SAFETY: see the module.
    unsafe { call::<S>(instance, "fmi3FreeFMUState", |component| component.free_state(FMUState)) }
}

/// Number of bytes of a serialized state.
pub unsafe fn fmi3SerializedFMUStateSize<S: Slave>(
    instance: fmi3Instance,
    FMUState: fmi3FMUState,
    size: *mut usize,
) -> fmi3Status {
    // SAFETY: see the module.
    unsafe { call::<S>(instance, "fmi3SerializedFMUStateSize", |component| component.state_size(FMUState, size)) }
}

/// Writes a saved state as bytes.
pub unsafe fn fmi3SerializeFMUState<S: Slave>(
    instance: fmi3Instance,
    FMUState: fmi3FMUState,
    serializedState: *mut fmi3Byte,
    size: usize,
) -> fmi3Status {
    // SAFETY: see the module.
    unsafe {
        call::<S>(instance, "fmi3SerializeFMUState", |component| {
            component.serialize_state(FMUState, serializedState, size)
        })
    }
}

/// Reads a saved state from bytes.
pub unsafe fn fmi3DeserializeFMUState<S: Slave>(
    instance: fmi3Instance,
    serializedState: *const fmi3Byte,
    size: usize,
    FMUState: *mut fmi3FMUState,
) -> fmi3Status {
    // SAFETY: see the module.
    unsafe {
        call::<S>(instance, "fmi3DeserializeFMUState", |component| {
            component.deserialize_state(serializedState, size, FMUState)
        })
    }
}
