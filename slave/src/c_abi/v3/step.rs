//! One step, and the questions to the master before it.
//!
//! A step takes several calls of the component: the first checks the arguments and begins the questions, one each goes on to the
//! next question, the last computes. The master's function runs between them, when no reference to the component exists, so
//! that the functions it calls from there take the component as any other call does.

use super::types::*;
use crate::ArrayAccess;
use crate::c_abi::call;
use crate::c_abi::component::{Ask, Component};
use crate::c_abi::marshal::store;
use crate::log::Status;
use std::rc::Rc;

const NAME: &str = "fmi3DoStep";

/// Question to a master about its inputs within a step: at that time they are set, nothing can be read, the step is not
/// finished, and it does not end there.
pub fn ask(function: fmi3IntermediateUpdateCallback, environment: fmi3InstanceEnvironment) -> Option<Ask> {
    let function = function?;
    Some(Rc::new(move |time| {
        let (mut early, mut at) = (0, time);
        // SAFETY: the master's own function with the master's own environment; both places outlive the call.
        unsafe { function(environment, time, 1, 0, 0, 0, &mut early, &mut at) };
    }))
}

/// Asks the master for its inputs within the step, if it has a function for that.
unsafe fn inquire<S: ArrayAccess>(instance: fmi3Instance, start: f64, h: f64, ask: Option<Ask>) -> Status {
    let Some(ask) = ask else { return Status::Ok };
    // SAFETY: see the module.
    let begun = unsafe { call::<S>(instance, NAME, |component| component.instance.begin_inquiry(start, h)) };
    if begun != Status::Ok {
        return begun;
    }
    loop {
        let mut question = None;
        let next = |component: &mut Component<S>| {
            question = component.instance.next_question();
            Ok(())
        };
        // SAFETY: see the module.
        let status = unsafe { call::<S>(instance, NAME, next) };
        match question {
            Some(time) if status == Status::Ok => ask(time),
            _ => return status,
        }
    }
}

/// Simulates one step. Saved states stay until the master frees them, whatever it promises about using them. The end of the
/// simulation is asked for where a step was discarded and repeating it is pointless.
#[allow(clippy::too_many_arguments)]
pub unsafe fn fmi3DoStep<S: ArrayAccess>(
    instance: fmi3Instance,
    currentCommunicationPoint: fmi3Float64,
    communicationStepSize: fmi3Float64,
    noSetFMUStatePriorToCurrentPoint: fmi3Boolean,
    eventHandlingNeeded: *mut fmi3Boolean,
    terminateSimulation: *mut fmi3Boolean,
    earlyReturn: *mut fmi3Boolean,
    lastSuccessfulTime: *mut fmi3Float64,
) -> fmi3Status {
    let flags = [
        (eventHandlingNeeded, "eventHandlingNeeded"),
        (terminateSimulation, "terminateSimulation"),
        (earlyReturn, "earlyReturn"),
    ];
    let mut ask = None;
    // SAFETY: see the module.
    let status = unsafe {
        call::<S>(instance, NAME, |component| {
            boolean(noSetFMUStatePriorToCurrentPoint, "noSetFMUStatePriorToCurrentPoint")?;
            flags.into_iter().try_for_each(|(place, name)| store(place, vec![0], name))?;
            store(lastSuccessfulTime, vec![component.instance.last_successful_time()], "lastSuccessfulTime")?;
            ask = component.ask.clone();
            Ok(())
        })
    };
    if status != Status::Ok {
        return status;
    }
    // SAFETY: see the module.
    let status = unsafe { inquire::<S>(instance, currentCommunicationPoint, communicationStepSize, ask) };
    if status != Status::Ok {
        return status;
    }
    // SAFETY: see the module.
    unsafe {
        call::<S>(instance, NAME, |component| {
            let instance = &mut component.instance;
            let done = instance.do_step_as_asked(currentCommunicationPoint, communicationStepSize);
            store(terminateSimulation, vec![instance.terminated().into()], "terminateSimulation")?;
            let reached = instance.last_successful_time();
            let early = done.is_ok() && reached < currentCommunicationPoint + communicationStepSize;
            store(earlyReturn, vec![early.into()], "earlyReturn")?;
            store(lastSuccessfulTime, vec![reached], "lastSuccessfulTime")?;
            done
        })
    }
}
