//! Birth and death of a component.

use super::component::{Component, panic_text};
use super::environment::Host;
use super::logger::sink;
use super::marshal::{boolean, co_simulation, text};
use super::thread::beside;
use super::types::{CallbackFunctions, fmi2Boolean, fmi2Component, fmi2String};
use crate::aside;
use crate::instance::{Instance, ScalarAccess};
use crate::log::{CallError, Log, Outcome, Status};
use crate::uri::path_of;
use std::ffi::c_int;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::ptr;
use std::rc::Rc;

/// Arguments of `fmi2Instantiate` but for the functions.
struct Request {
    name: fmi2String,
    kind: c_int,
    guid: fmi2String,
    resources: fmi2String,
    visible: fmi2Boolean,
    logging: fmi2Boolean,
}

/// The directory `resources` of the unpacked FMU. A location that is unknown or does not exist only means that there
/// are no presets but the default.
fn resources(location: Option<String>, log: &Log) -> Option<PathBuf> {
    let path = path_of(&location?).map_err(|error| log.report(Status::Warning, &error)).ok()?;
    if path.is_dir() {
        return Some(path);
    }
    let message = format!("resources {} do not exist: only defaults are known", path.display());
    log.report(Status::Warning, &message);
    None
}

impl Request {
    /// The instance, or the reason why there is none.
    unsafe fn instance<S: ScalarAccess>(&self, functions: &CallbackFunctions, host: &Rc<Host>) -> Outcome<Instance<S>> {
        // SAFETY: see the module: NULL or strings.
        let (name, theirs) = unsafe { (text(self.name, "instanceName"), text(self.guid, "fmuGUID")) };
        let name = name?;
        if name.is_empty() {
            return Err(CallError::error("instanceName is empty"));
        }
        co_simulation(self.kind)?;
        boolean(self.visible, "visible")?;
        let log = Log::new(sink(&name, functions, host.clone()), boolean(self.logging, "loggingOn")?);
        let theirs = theirs?;
        // The tables behind it are made at the first time, on more stack than a master may have.
        let ours = aside::run(beside, &mut |_, _| {}, |_| S::guid())?;
        if theirs != ours {
            return Err(CallError::error(format!("fmuGUID = \"{theirs}\" is not that of this FMU: \"{ours}\"")));
        }
        // SAFETY: see the module: a string, unless it is NULL.
        let location = (!self.resources.is_null()).then(|| unsafe { text(self.resources, "fmuResourceLocation") });
        let location = location.transpose().unwrap_or_else(|error| {
            log.report(Status::Warning, &error.message);
            None
        });
        let resources = resources(location, &log);
        let mut instance = Instance::new(resources, log)?;
        instance.compute_on(beside);
        instance.take_name(name);
        Ok(instance)
    }
}

/// A new instance; NULL if it cannot be made, after a message.
#[allow(clippy::too_many_arguments)]
pub unsafe fn fmi2Instantiate<S: ScalarAccess>(
    instanceName: fmi2String,
    fmuType: c_int,
    fmuGUID: fmi2String,
    fmuResourceLocation: fmi2String,
    functions: *const CallbackFunctions,
    visible: fmi2Boolean,
    loggingOn: fmi2Boolean,
) -> fmi2Component {
    // SAFETY: see the module: NULL or the master's functions.
    let Some(functions) = (unsafe { functions.as_ref() }) else {
        return ptr::null_mut();
    };
    let request = Request {
        name: instanceName,
        kind: fmuType,
        guid: fmuGUID,
        resources: fmuResourceLocation,
        visible,
        logging: loggingOn,
    };
    let host = Host::new();
    host.put_aside(|| {
        // SAFETY: see the module.
        let error = match catch_unwind(AssertUnwindSafe(|| unsafe { request.instance::<S>(functions, &host) })) {
            Ok(Ok(instance)) => return Component::new(instance, host.clone()).hand_out(),
            Ok(Err(error)) => error,
            Err(panic) => {
                CallError { status: Status::Fatal, message: format!("internal error: {}", panic_text(panic)) }
            }
        };
        // SAFETY: see the module: NULL or a string.
        let name = unsafe { text(instanceName, "instanceName") }.unwrap_or_else(|_| "unnamed".to_owned());
        let log = Log::new(sink(&name, functions, host.clone()), false);
        log.report(error.status, &format!("fmi2Instantiate: {}", error.message));
        ptr::null_mut()
    })
}

/// Frees an instance with all its states; a pointer that is no instance, or no longer, is left alone.
pub unsafe fn fmi2FreeInstance<S: ScalarAccess>(c: fmi2Component) {
    if let Some(component) = Component::<S>::take_back(c) {
        // SAFETY: `component` came from `Box::into_raw` in `hand_out` and is known no more.
        let component = unsafe { Box::from_raw(component) };
        component.host.clone().put_aside(|| {
            let _ = catch_unwind(AssertUnwindSafe(|| drop(component)));
        });
    }
}
