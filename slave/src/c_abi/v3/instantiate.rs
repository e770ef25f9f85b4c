//! Birth and death of a component.

use super::logger::log_to;
use super::step::ask;
use super::types::*;
use crate::c_abi::birth::{Newcomer, free, instantiate};
use crate::c_abi::environment::Host;
use crate::c_abi::marshal::{slice, text};
use crate::instance::Instance;
use crate::log::{CallError, Log, Outcome};
use crate::{ArrayAccess, Slave};
use std::ptr;

/// Arguments of `fmi3InstantiateCoSimulation` but for the functions of the master.
struct CoSimulationRequest {
    name: fmi3String,
    token: fmi3String,
    resources: fmi3String,
    visible: fmi3Boolean,
    event_mode: fmi3Boolean,
    early_return: fmi3Boolean,
    intermediate: (*const fmi3ValueReference, usize),
}

impl CoSimulationRequest {
    /// The instance, or the reason why there is none.
    unsafe fn instance<S: ArrayAccess>(&self, log: Log) -> Outcome<Instance<S>> {
        // SAFETY: see the module: NULL or strings and an array.
        let (name, token, intermediate) = unsafe {
            let (first, count) = self.intermediate;
            let intermediate = slice(first, count, "requiredIntermediateVariables")?;
            (text(self.name, "instanceName")?, text(self.token, "instantiationToken")?, intermediate)
        };
        boolean(self.visible, "visible")?;
        let early_return = boolean(self.early_return, "earlyReturnAllowed")?;
        if boolean(self.event_mode, "eventModeUsed")? {
            let why = "eventModeUsed = fmi3True, but this FMU has no Event Mode (hasEventMode = false): pass fmi3False";
            return Err(CallError::error(why));
        }
        // SAFETY: see the module: a string, unless it is NULL.
        let resources = (!self.resources.is_null()).then(|| unsafe { text(self.resources, "resourcePath") });
        let resources = resources.transpose()?.map(Into::into);
        let newcomer = Newcomer { name, identity: ("instantiationToken", token), resources };
        let mut instance = newcomer.instance(S::token, log)?;
        instance.allow_early_return(early_return);
        instance.require_intermediate(intermediate)?;
        Ok(instance)
    }
}

/// A new instance; NULL if it cannot be made, after a message.
#[allow(clippy::too_many_arguments)]
pub unsafe fn fmi3InstantiateCoSimulation<S: ArrayAccess>(
    instanceName: fmi3String,
    instantiationToken: fmi3String,
    resourcePath: fmi3String,
    visible: fmi3Boolean,
    loggingOn: fmi3Boolean,
    eventModeUsed: fmi3Boolean,
    earlyReturnAllowed: fmi3Boolean,
    requiredIntermediateVariables: *const fmi3ValueReference,
    nRequiredIntermediateVariables: usize,
    instanceEnvironment: fmi3InstanceEnvironment,
    logMessage: fmi3LogMessageCallback,
    intermediateUpdate: fmi3IntermediateUpdateCallback,
) -> fmi3Instance {
    let request = CoSimulationRequest {
        name: instanceName,
        token: instantiationToken,
        resources: resourcePath,
        visible,
        event_mode: eventModeUsed,
        early_return: earlyReturnAllowed,
        intermediate: (requiredIntermediateVariables, nRequiredIntermediateVariables),
    };
    let host = Host::new();
    let log = |on| log_to(logMessage, instanceEnvironment, host.clone(), on);
    // SAFETY: see the module.
    let make = || unsafe { request.instance::<S>(log(boolean(loggingOn, "loggingOn")?)) };
    let ask = if S::INTERMEDIATE_UPDATE { ask(intermediateUpdate, instanceEnvironment) } else { None };
    instantiate("fmi3InstantiateCoSimulation", host.clone(), make, ask, || log(false))
}

/// Refuses to make an instance of another kind than co-simulation.
pub fn no_instance(
    function: &str,
    instanceEnvironment: fmi3InstanceEnvironment,
    logMessage: fmi3LogMessageCallback,
) -> fmi3Instance {
    let host = Host::new();
    host.put_aside(|| {
        let why = format!("{function}: this FMU is one of co-simulation only: call fmi3InstantiateCoSimulation");
        log_to(logMessage, instanceEnvironment, host.clone(), false).report(crate::log::Status::Error, &why);
    });
    ptr::null_mut()
}

/// Frees an instance with all its states; a pointer that is no instance, or no longer, is left alone.
pub unsafe fn fmi3FreeInstance<S: Slave>(instance: fmi3Instance) {
    // SAFETY: see the module.
    unsafe { free::<S>(instance) }
}
