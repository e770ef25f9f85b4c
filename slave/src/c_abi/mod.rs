//! The C interface for any slave: FMI 2.0 with [`ScalarAccess`](crate::ScalarAccess) ([`v2`]), FMI 3.0 with
//! [`ArrayAccess`](crate::ArrayAccess) ([`v3`]), and the only `unsafe` code.
//!
//! Each function checks its pointers, copies what it is given, calls the [`Instance`](crate::Instance) behind a
//! barrier that turns panics into `fmi2Fatal` or `fmi3Fatal`, and reports errors in one place. Enumerations and booleans
//! arrive as C integers, whatever their value. A component that no function here has returned, or that has been freed,
//! is refused and never followed. The floating-point environment of the master is put aside meanwhile, and
//! computations that need much stack, the first ones of an instance and derivatives, run beside its thread.
//! [`export_fmi2!`](crate::export_fmi2) and [`export_fmi3!`](crate::export_fmi3) give the functions their symbols for one
//! type of slave; a library may have both.
//!
//! # Safety
//!
//! Every `SAFETY` comment relies on what the standard demands of masters: a component is used by one thread at a time;
//! arrays have the stated lengths; strings end with NUL.

#![allow(unsafe_code, non_snake_case, clippy::missing_safety_doc)]

mod birth;
mod component;
mod environment;
mod marshal;
mod saved;
mod states;
mod thread;
pub mod v2;
pub mod v3;

use crate::instance::Slave;
use crate::log::{CallError, Outcome, Status};
use component::{Address, Component, panic_text};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Runs the body on the component: errors are logged and become a status, panics a fatal one.
unsafe fn call<S: Slave>(c: Address, name: &str, body: impl FnOnce(&mut Component<S>) -> Outcome) -> Status {
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
