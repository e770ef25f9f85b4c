//! Types of the C interface, as `fmi3PlatformTypes.h` and `fmi3FunctionTypes.h` of the standard declare them.
//!
//! Booleans and enumerations among the arguments are integers here: a number that is none of them is refused, not trusted.
//! `fmpy_tests/test_fmi3.py` compares the functions with the header.

#![allow(non_camel_case_types)]

use crate::c_abi::component::Address;
use crate::c_abi::marshal::flag;
use crate::c_abi::states::Handle;
use crate::log::{Outcome, Status};
use std::ffi::{c_char, c_int, c_void};

/// Address of a component.
pub type fmi3Instance = Address;
/// Address that belongs to the master and is handed back to its functions.
pub type fmi3InstanceEnvironment = *mut c_void;
/// Handle of a saved state.
pub type fmi3FMUState = Handle;
/// Value reference.
pub type fmi3ValueReference = u32;
/// Real number of single precision.
pub type fmi3Float32 = f32;
/// Real number.
pub type fmi3Float64 = f64;
/// Whole number of 8 bits.
pub type fmi3Int8 = i8;
/// Whole number of 8 bits without sign.
pub type fmi3UInt8 = u8;
/// Whole number of 16 bits.
pub type fmi3Int16 = i16;
/// Whole number of 16 bits without sign.
pub type fmi3UInt16 = u16;
/// Whole number of 32 bits.
pub type fmi3Int32 = i32;
/// Whole number of 32 bits without sign.
pub type fmi3UInt32 = u32;
/// Whole number of 64 bits.
pub type fmi3Int64 = i64;
/// Whole number of 64 bits without sign.
pub type fmi3UInt64 = u64;
/// Byte that holds 0 for false or 1 for true: `bool` of C.
pub type fmi3Boolean = u8;
/// Text that ends with NUL.
pub type fmi3String = *const c_char;
/// Byte of a serialized state.
pub type fmi3Byte = u8;
/// Bytes of a binary variable, of which there is none.
pub type fmi3Binary = *const fmi3Byte;
/// State of a clock, of which there is none.
pub type fmi3Clock = u8;
/// Number of `fmi3DependencyKind`.
pub type fmi3DependencyKind = c_int;
/// Number of `fmi3IntervalQualifier`.
pub type fmi3IntervalQualifier = c_int;
/// Return value of most functions.
pub type fmi3Status = Status;

/// Receiver of messages: environment, status, category, text.
pub type fmi3LogMessageCallback =
    Option<unsafe extern "C" fn(fmi3InstanceEnvironment, fmi3Status, fmi3String, fmi3String)>;
/// Receiver of control within a step: environment, time, whether variables may be set and read, whether the internal step is
/// finished and may be the last; whether and when it shall be the last.
pub type fmi3IntermediateUpdateCallback = Option<
    unsafe extern "C" fn(
        fmi3InstanceEnvironment,
        fmi3Float64,
        fmi3Boolean,
        fmi3Boolean,
        fmi3Boolean,
        fmi3Boolean,
        *mut fmi3Boolean,
        *mut fmi3Float64,
    ),
>;
/// Announcement of a clock, of which there is none.
pub type fmi3ClockUpdateCallback = Option<unsafe extern "C" fn(fmi3InstanceEnvironment)>;
/// Begin of what must not be interrupted, in scheduled execution.
pub type fmi3LockPreemptionCallback = Option<unsafe extern "C" fn()>;
/// End of what must not be interrupted, in scheduled execution.
pub type fmi3UnlockPreemptionCallback = Option<unsafe extern "C" fn()>;

/// The value of a C boolean.
pub fn boolean(value: fmi3Boolean, name: &str) -> Outcome<bool> {
    flag(value.into(), 3, name)
}
