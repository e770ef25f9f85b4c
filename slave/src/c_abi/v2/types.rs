//! Types of the C interface, as `fmi2TypesPlatform.h` and `fmi2FunctionTypes.h` of the standard declare them.
//!
//! Enumerations among the arguments are C integers here: a number that is none of them is refused, not trusted.
//! `tests/header.rs` compares these types, and those of all functions, with bindings made from the headers.

#![allow(non_camel_case_types)]

use crate::c_abi::component::Address;
use crate::c_abi::states::Handle;
use crate::log::Status;
use std::ffi::{c_char, c_int, c_uint, c_void};

/// Address of a component.
pub type fmi2Component = Address;
/// Address that belongs to the master and is handed back to its functions.
pub type fmi2ComponentEnvironment = *mut c_void;
/// Handle of a saved state.
pub type fmi2FMUstate = Handle;
/// Value reference.
pub type fmi2ValueReference = c_uint;
/// Real number.
pub type fmi2Real = f64;
/// Whole number.
pub type fmi2Integer = c_int;
/// 0 for false, 1 for true.
pub type fmi2Boolean = c_int;
/// Text that ends with NUL.
pub type fmi2String = *const c_char;
/// Byte of a serialized state.
pub type fmi2Byte = c_char;
/// Return value of most functions.
pub type fmi2Status = Status;

/// Logger of the master: environment, name of the instance, status, category, format of `printf` and its arguments.
pub type Logger = unsafe extern "C" fn(fmi2ComponentEnvironment, fmi2String, fmi2Status, fmi2String, fmi2String, ...);

/// Functions of the master.
#[repr(C)]
pub struct CallbackFunctions {
    /// Receiver of messages.
    pub logger: Option<Logger>,
    /// Memory from the master, which is not used.
    pub allocate_memory: Option<unsafe extern "C" fn(usize, usize) -> *mut c_void>,
    /// Its release.
    pub free_memory: Option<unsafe extern "C" fn(*mut c_void)>,
    /// Announcement of the end of an asynchronous step, which there is none of.
    pub step_finished: Option<unsafe extern "C" fn(fmi2ComponentEnvironment, fmi2Status)>,
    /// First argument of the logger.
    pub environment: fmi2ComponentEnvironment,
}

/// Number of co-simulation among the types of FMU, `fmi2Type`.
pub const CO_SIMULATION: c_int = 1;

/// Questions about the last step, with the numbers and names of `fmi2StatusKind`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub enum Question {
    /// `fmi2DoStepStatus`: the status of a pending step.
    DoStepStatus = 0,
    /// `fmi2PendingStatus`: what a pending step is waiting for.
    PendingStatus = 1,
    /// `fmi2LastSuccessfulTime`: the communication point up to which the slave has simulated.
    LastSuccessfulTime = 2,
    /// `fmi2Terminated`: the wish of the slave to end the run.
    Terminated = 3,
}

impl Question {
    /// All questions.
    pub const ALL: [Question; 4] =
        [Question::DoStepStatus, Question::PendingStatus, Question::LastSuccessfulTime, Question::Terminated];

    /// Name in the standard.
    pub fn name(self) -> &'static str {
        match self {
            Question::DoStepStatus => "fmi2DoStepStatus",
            Question::PendingStatus => "fmi2PendingStatus",
            Question::LastSuccessfulTime => "fmi2LastSuccessfulTime",
            Question::Terminated => "fmi2Terminated",
        }
    }
}
