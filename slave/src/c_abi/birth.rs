//! Making and freeing of components, in both versions of the standard.

use super::component::{Address, Ask, Component, panic_text};
use super::environment::Host;
use super::thread::beside;
use crate::aside;
use crate::instance::{Instance, Slave};
use crate::log::{CallError, Log, Outcome, Status};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::ptr;
use std::rc::Rc;

/// Everything that a master says about a new instance.
pub struct Newcomer {
    /// Name by which the master knows the instance.
    pub name: String,
    /// Name of the argument that holds the identity of the model description, and the identity that the master has.
    pub identity: (&'static str, String),
    /// The directory `resources` of the unpacked FMU, if the master names one.
    pub resources: Option<PathBuf>,
}

impl Newcomer {
    /// A new instance; `ours` is the identity that the master must know.
    pub fn instance<S: Slave>(self, ours: fn() -> String, log: Log) -> Outcome<Instance<S>> {
        if self.name.is_empty() {
            return Err(CallError::error("instanceName is empty"));
        }
        // The tables behind it are made at the first time, on more stack than a master may have.
        let ours = aside::run(beside, &mut |_, _| {}, |_| ours())?;
        let (argument, theirs) = self.identity;
        if theirs != ours {
            return Err(CallError::error(format!("{argument} = \"{theirs}\" is not that of this FMU: \"{ours}\"")));
        }
        // A location that does not exist only means that there are no presets but the default.
        let (there, missing) = self.resources.map_or((None, None), |path| match path.is_dir() {
            true => (Some(path), None),
            false => (None, Some(path)),
        });
        if let Some(path) = missing {
            let message = format!("resources {} do not exist: only defaults are known", path.display());
            log.report(Status::Warning, &message);
        }
        let mut instance = Instance::new(there, log)?;
        instance.compute_on(beside);
        instance.take_name(self.name);
        Ok(instance)
    }
}

/// Address of a component with the instance that `make` makes and its question to the master; NULL if it makes none, after a
/// message to `log`.
pub fn instantiate<S: Slave>(
    function: &str,
    host: Rc<Host>,
    make: impl FnOnce() -> Outcome<Instance<S>>,
    ask: Option<Ask>,
    log: impl FnOnce() -> Log,
) -> Address {
    host.clone().put_aside(|| {
        let error = match catch_unwind(AssertUnwindSafe(make)) {
            Ok(Ok(instance)) => return Component::new(instance, host, ask).hand_out(),
            Ok(Err(error)) => error,
            Err(panic) => {
                CallError { status: Status::Fatal, message: format!("internal error: {}", panic_text(panic)) }
            }
        };
        log().report(error.status, &format!("{function}: {}", error.message));
        ptr::null_mut()
    })
}

/// Frees an instance with all its states; a pointer that is no instance, or no longer, is left alone.
pub unsafe fn free<S: Slave>(address: Address) {
    if let Some(component) = Component::<S>::take_back(address) {
        // SAFETY: `component` came from `Box::into_raw` in `hand_out` and is known no more.
        let component = unsafe { Box::from_raw(component) };
        component.host.clone().put_aside(|| {
            let _ = catch_unwind(AssertUnwindSafe(|| drop(component)));
        });
    }
}
