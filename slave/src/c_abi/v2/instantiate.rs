//! Birth and death of a component.

use super::logger::sink;
use super::marshal::{boolean, co_simulation};
use super::types::{CallbackFunctions, fmi2Boolean, fmi2Component, fmi2String};
use crate::c_abi::birth::{Newcomer, free, instantiate};
use crate::c_abi::environment::Host;
use crate::c_abi::marshal::text;
use crate::instance::{Instance, ScalarAccess};
use crate::log::{Log, Outcome, Status};
use crate::uri::path_of;
use std::ffi::c_int;
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

impl Request {
    /// The instance, or the reason why there is none.
    unsafe fn instance<S: ScalarAccess>(&self, functions: &CallbackFunctions, host: &Rc<Host>) -> Outcome<Instance<S>> {
        // SAFETY: see the module: NULL or strings.
        let (name, guid) = unsafe { (text(self.name, "instanceName")?, text(self.guid, "fmuGUID")) };
        co_simulation(self.kind)?;
        boolean(self.visible, "visible")?;
        let log = Log::new(sink(&name, functions, host.clone()), boolean(self.logging, "loggingOn")?);
        // SAFETY: see the module.
        let resources = unsafe { self.resources(&log) };
        Newcomer { name, identity: ("fmuGUID", guid?), resources }.instance(S::guid, log)
    }

    /// The path that the location of the resources means; one that means none is told.
    unsafe fn resources(&self, log: &Log) -> Option<PathBuf> {
        if self.resources.is_null() {
            return None;
        }
        // SAFETY: see the module: a string.
        let location = unsafe { text(self.resources, "fmuResourceLocation") }.map_err(|error| error.message);
        location.and_then(|location| path_of(&location)).map_err(|why| log.report(Status::Warning, &why)).ok()
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
    // SAFETY: see the module.
    let make = || unsafe { request.instance::<S>(functions, &host) };
    let log = || {
        // SAFETY: see the module: NULL or a string.
        let name = unsafe { text(instanceName, "instanceName") }.unwrap_or_else(|_| "unnamed".to_owned());
        Log::new(sink(&name, functions, host.clone()), false)
    };
    instantiate("fmi2Instantiate", host.clone(), make, None, log)
}

/// Frees an instance with all its states; a pointer that is no instance, or no longer, is left alone.
pub unsafe fn fmi2FreeInstance<S: ScalarAccess>(c: fmi2Component) {
    // SAFETY: see the module.
    unsafe { free::<S>(c) }
}
