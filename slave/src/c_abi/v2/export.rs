//! Symbols of the functions.

/// Exports the C functions of FMI 2.0 for a type that implements [`ScalarAccess`](crate::ScalarAccess).
///
/// A library calls it once, in a module of its own; `tests/header.rs` compares every function with its type in the
/// header of the standard.
#[macro_export]
macro_rules! export_fmi2 {
    (@with $Slave:ty: $($name:ident($($argument:ident: $kind:ty),*) -> $result:ty;)*) => {$(
        #[doc = concat!("`", stringify!($name), "` of the standard.")]
        #[allow(clippy::missing_safety_doc, clippy::too_many_arguments)]
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $name($($argument: $kind),*) -> $result {
            // SAFETY: that of this function.
            unsafe { $crate::c_abi::v2::$name::<$Slave>($($argument),*) }
        }
    )*};
    ($Slave:ty) => {
        use $crate::c_abi::v2::types::*;
        use std::ffi::{c_char, c_int};

        /// Sizes of the types of the interface.
        #[unsafe(no_mangle)]
        pub extern "C" fn fmi2GetTypesPlatform() -> *const c_char {
            $crate::c_abi::v2::fmi2GetTypesPlatform()
        }

        /// Version of the standard.
        #[unsafe(no_mangle)]
        pub extern "C" fn fmi2GetVersion() -> *const c_char {
            $crate::c_abi::v2::fmi2GetVersion()
        }

        /// Frees an instance.
        #[allow(clippy::missing_safety_doc)]
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn fmi2FreeInstance(c: fmi2Component) {
            // SAFETY: that of this function.
            unsafe { $crate::c_abi::v2::fmi2FreeInstance::<$Slave>(c) }
        }

        $crate::export_fmi2! { @with $Slave:
            fmi2Instantiate(
                name: fmi2String, kind: c_int, guid: fmi2String, resources: fmi2String,
                functions: *const CallbackFunctions, visible: fmi2Boolean, logging: fmi2Boolean
            ) -> fmi2Component;
            fmi2SetDebugLogging(
                c: fmi2Component, loggingOn: fmi2Boolean, nCategories: usize, categories: *const fmi2String
            ) -> fmi2Status;
            fmi2SetupExperiment(
                c: fmi2Component, toleranceDefined: fmi2Boolean, tolerance: fmi2Real, startTime: fmi2Real,
                stopTimeDefined: fmi2Boolean, stopTime: fmi2Real
            ) -> fmi2Status;
            fmi2EnterInitializationMode(c: fmi2Component) -> fmi2Status;
            fmi2ExitInitializationMode(c: fmi2Component) -> fmi2Status;
            fmi2Terminate(c: fmi2Component) -> fmi2Status;
            fmi2Reset(c: fmi2Component) -> fmi2Status;
            fmi2GetReal(
                c: fmi2Component, vr: *const fmi2ValueReference, nvr: usize, value: *mut fmi2Real
            ) -> fmi2Status;
            fmi2GetInteger(
                c: fmi2Component, vr: *const fmi2ValueReference, nvr: usize, value: *mut fmi2Integer
            ) -> fmi2Status;
            fmi2GetBoolean(
                c: fmi2Component, vr: *const fmi2ValueReference, nvr: usize, value: *mut fmi2Boolean
            ) -> fmi2Status;
            fmi2GetString(
                c: fmi2Component, vr: *const fmi2ValueReference, nvr: usize, value: *mut fmi2String
            ) -> fmi2Status;
            fmi2SetReal(
                c: fmi2Component, vr: *const fmi2ValueReference, nvr: usize, value: *const fmi2Real
            ) -> fmi2Status;
            fmi2SetInteger(
                c: fmi2Component, vr: *const fmi2ValueReference, nvr: usize, value: *const fmi2Integer
            ) -> fmi2Status;
            fmi2SetBoolean(
                c: fmi2Component, vr: *const fmi2ValueReference, nvr: usize, value: *const fmi2Boolean
            ) -> fmi2Status;
            fmi2SetString(
                c: fmi2Component, vr: *const fmi2ValueReference, nvr: usize, value: *const fmi2String
            ) -> fmi2Status;
            fmi2GetFMUstate(c: fmi2Component, FMUstate: *mut fmi2FMUstate) -> fmi2Status;
            fmi2SetFMUstate(c: fmi2Component, FMUstate: fmi2FMUstate) -> fmi2Status;
            fmi2FreeFMUstate(c: fmi2Component, FMUstate: *mut fmi2FMUstate) -> fmi2Status;
            fmi2SerializedFMUstateSize(c: fmi2Component, FMUstate: fmi2FMUstate, size: *mut usize) -> fmi2Status;
            fmi2SerializeFMUstate(
                c: fmi2Component, FMUstate: fmi2FMUstate, serializedState: *mut fmi2Byte, size: usize
            ) -> fmi2Status;
            fmi2DeSerializeFMUstate(
                c: fmi2Component, serializedState: *const fmi2Byte, size: usize, FMUstate: *mut fmi2FMUstate
            ) -> fmi2Status;
            fmi2GetDirectionalDerivative(
                c: fmi2Component, vUnknown_ref: *const fmi2ValueReference, nUnknown: usize, vKnown_ref: *const
                fmi2ValueReference, nKnown: usize, dvKnown: *const fmi2Real, dvUnknown: *mut fmi2Real
            ) -> fmi2Status;
            fmi2SetRealInputDerivatives(
                c: fmi2Component, vr: *const fmi2ValueReference, nvr: usize, order: *const fmi2Integer, value: *const
                fmi2Real
            ) -> fmi2Status;
            fmi2GetRealOutputDerivatives(
                c: fmi2Component, vr: *const fmi2ValueReference, nvr: usize, order: *const fmi2Integer, value: *mut
                fmi2Real
            ) -> fmi2Status;
            fmi2DoStep(
                c: fmi2Component, currentCommunicationPoint: fmi2Real, communicationStepSize: fmi2Real,
                noSetFMUStatePriorToCurrentPoint: fmi2Boolean
            ) -> fmi2Status;
            fmi2CancelStep(c: fmi2Component) -> fmi2Status;
            fmi2GetStatus(c: fmi2Component, s: c_int, value: *mut fmi2Status) -> fmi2Status;
            fmi2GetRealStatus(c: fmi2Component, s: c_int, value: *mut fmi2Real) -> fmi2Status;
            fmi2GetBooleanStatus(c: fmi2Component, s: c_int, value: *mut fmi2Boolean) -> fmi2Status;
            fmi2GetIntegerStatus(c: fmi2Component, s: c_int, _value: *mut fmi2Integer) -> fmi2Status;
            fmi2GetStringStatus(c: fmi2Component, s: c_int, _value: *mut fmi2String) -> fmi2Status;
        }
    };
}
