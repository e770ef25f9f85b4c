//! The C interface: the 34 functions of FMI 2.0 co-simulation for any slave with [`ScalarAccess`](crate::ScalarAccess),
//! and the only `unsafe` code.
//!
//! Each function checks its pointers, copies what it is given, calls the [`Instance`](crate::Instance) behind a
//! barrier that turns panics into `fmi2Fatal`, and reports errors in one place. Enumerations and booleans arrive as C
//! integers, whatever their value. A component that `fmi2Instantiate` has not returned, or `fmi2FreeInstance` has
//! freed, is refused and never followed. The floating-point environment of the master is put aside meanwhile, and the
//! first computations of an instance, which need much stack, run beside its thread.
//! [`export_fmi2!`](crate::export_fmi2) gives the functions their symbols for one type of slave.
//!
//! # Safety
//!
//! Every `SAFETY` comment relies on what the standard demands of masters: a component is used by one thread at a time;
//! arrays have the stated lengths; strings end with NUL.

#![allow(unsafe_code, non_snake_case, clippy::missing_safety_doc)]

mod component;
mod environment;
mod export;
mod functions;
mod instantiate;
mod logger;
mod marshal;
mod states;
mod thread;
pub mod types;
mod values;

pub use functions::*;
pub use instantiate::{fmi2FreeInstance, fmi2Instantiate};
pub use values::*;

use crate::instance::Slave;
use crate::log::{CallError, Outcome, Status};
use component::{Component, panic_text};
use std::panic::{AssertUnwindSafe, catch_unwind};
use types::{fmi2Component, fmi2Status};

/// Runs the body on the component: errors are logged and become a status, panics become `fmi2Fatal`.
unsafe fn call<S: Slave>(c: fmi2Component, name: &str, body: impl FnOnce(&mut Component<S>) -> Outcome) -> fmi2Status {
    let Some(component) = Component::find(c) else {
        return Status::Error;
    };
    // SAFETY: it lives, and nobody else uses it now: see the module.
    let component = unsafe { &mut *component };
    component.host.clone().put_aside(|| {
        let error = match catch_unwind(AssertUnwindSafe(|| body(component))) {
            Ok(Ok(())) => return Status::Ok,
            Ok(Err(error)) => error,
            Err(panic) => {
                component.instance.give_up();
                CallError { status: Status::Fatal, message: format!("internal error: {}", panic_text(panic)) }
            }
        };
        component.instance.log().report(error.status, &format!("{name}: {}", error.message));
        error.status
    })
}
