//! The C interface: the 34 functions of FMI 2.0 co-simulation, and the only `unsafe` of the crate.
//!
//! Each function checks its pointers, copies what it is given, calls [`Instance`](crate::fmi::instance::Instance) behind a barrier that turns panics
//! into `fmi2Fatal`, and reports errors in one place. Enumerations and booleans arrive as C integers, whatever their
//! value. A component that `fmi2Instantiate` has not returned, or `fmi2FreeInstance` has freed, is refused and never followed.
//! What the standard demands of masters, and what every `SAFETY` comment below relies on: a component is used by one thread at a
//! time; arrays have the stated lengths; strings end with NUL.

#![allow(unsafe_code, non_snake_case, clippy::missing_safety_doc)]

#[cfg(unix)]
mod aside;
mod component;
mod instantiate;
mod logger;
mod marshal;
mod states;

pub use instantiate::{fmi2FreeInstance, fmi2Instantiate};

use crate::fmi::lifecycle::Call;
use crate::fmi::log::{CallError, Status};
use crate::fmi::snapshot::Snapshot;
use crate::fmi::variable::Value;
use component::{Component, panic_text};
use libfmi::*;
use logger::status_code;
use marshal::{Outcome, boolean, booleans, c_string, question, slice, store, text};
use std::ffi::{c_char, c_int};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::ptr;

/// Runs the body on the component: errors are logged and become a status, panics become `fmi2Fatal`.
unsafe fn call(c: fmi2Component, name: &str, body: impl FnOnce(&mut Component) -> Outcome) -> fmi2Status {
    let Some(component) = Component::find(c) else {
        return fmi2Status::fmi2Error;
    };
    // SAFETY: it lives, and nobody else uses it now: see the module.
    let component = unsafe { &mut *component };
    let error = match catch_unwind(AssertUnwindSafe(|| body(component))) {
        Ok(Ok(())) => return fmi2Status::fmi2OK,
        Ok(Err(error)) => error,
        Err(panic) => {
            component.instance.give_up();
            CallError { status: Status::Fatal, message: format!("internal error: {}", panic_text(panic)) }
        }
    };
    component.instance.log().report(error.status, &format!("{name}: {}", error.message));
    status_code(error.status)
}

/// The handle that stands at the place a master passed.
unsafe fn handle_at(place: *const fmi2FMUstate) -> Outcome<fmi2FMUstate> {
    if place.is_null() {
        return Err(CallError::error("FMUstate is NULL"));
    }
    // SAFETY: see the module: the address of a handle; or, by mistake, a handle of ours, which is readable as well.
    Ok(unsafe { place.read() })
}

impl Component {
    /// Keeps a snapshot under the handle at `place`, a new one unless the place already holds one.
    unsafe fn keep(&mut self, place: *mut fmi2FMUstate, snapshot: Snapshot) -> Outcome {
        // SAFETY: see the module.
        let handle = self.states.keep(unsafe { handle_at(place) }?, snapshot)?;
        // SAFETY: see the module; nothing is written where `place` holds something else than a handle.
        unsafe { store(place, vec![handle], "FMUstate") }
    }

    fn state_bytes(&self, handle: fmi2FMUstate) -> Outcome<Vec<u8>> {
        self.instance.allow(Call::FmuState)?;
        self.states.find(handle)?.to_bytes().map_err(CallError::error)
    }

    /// Refuses questions about the last step other than the one that a function answers.
    fn answers(&self, kind: c_int, answered: Option<fmi2StatusKind>) -> Outcome {
        self.instance.allow(Call::GetStatus)?;
        let question = question(kind)?;
        if answered == Some(question) {
            return Ok(());
        }
        Err(CallError::discard(format!("{question:?} is not available through this function")))
    }
}

/// Sizes of the types of the interface.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetTypesPlatform() -> *const c_char {
    c"default".as_ptr()
}

/// Version of the standard.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetVersion() -> *const c_char {
    c"2.0".as_ptr()
}

/// The type that the header of the standard gives an argument: another than ours only for enumerations.
macro_rules! declared {
    ($ours:ty) => {
        $ours
    };
    ($ours:ty as $theirs:ty) => {
        $theirs
    };
}

/// Exports functions that take a component and return a status, and compares each with the type that the header of the
/// standard gives it; an argument `c_int as E` is an enumeration `E` there. The body runs behind [`call`].
macro_rules! export {
    ($($type:ident = $name:ident(|$component:ident| $(, $argument:ident: $ours:ty $(as $theirs:ty)?)*) $body:block)*) => {$(
        #[doc = concat!("`", stringify!($name), "` of the standard.")]
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $name(c: fmi2Component $(, $argument: $ours)*) -> fmi2Status {
            // SAFETY: see the module.
            unsafe { call(c, stringify!($name), |$component| $body) }
        }
        // SAFETY: never called; both types of function differ in integers that are passed alike (see `marshal`).
        #[allow(clippy::useless_transmute)]
        const _: $type = Some(unsafe {
            std::mem::transmute::<
                unsafe extern "C" fn(fmi2Component $(, $ours)*) -> fmi2Status,
                unsafe extern "C" fn(fmi2Component $(, declared!($ours $(as $theirs)?))*) -> fmi2Status,
            >($name)
        });
    )*};
}

export! {
    fmi2SetDebugLoggingTYPE = fmi2SetDebugLogging(
        |component|, loggingOn: fmi2Boolean, nCategories: usize, categories: *const fmi2String
    ) {
        let names = slice(categories, nCategories, "categories")?;
        let names = names.iter().map(|name| text(*name, "category")).collect::<Outcome<Vec<_>>>()?;
        component.instance.set_debug_logging(boolean(loggingOn, "loggingOn")?, &names)
    }

    fmi2SetupExperimentTYPE = fmi2SetupExperiment(
        |component|, toleranceDefined: fmi2Boolean, tolerance: fmi2Real, startTime: fmi2Real,
        stopTimeDefined: fmi2Boolean, stopTime: fmi2Real
    ) {
        let tolerance = boolean(toleranceDefined, "toleranceDefined")?.then_some(tolerance);
        let stop = boolean(stopTimeDefined, "stopTimeDefined")?.then_some(stopTime);
        component.instance.setup_experiment(tolerance, startTime, stop)
    }

    fmi2EnterInitializationModeTYPE = fmi2EnterInitializationMode(|component|) {
        component.instance.enter_initialization()
    }
    fmi2ExitInitializationModeTYPE = fmi2ExitInitializationMode(|component|) {
        component.instance.exit_initialization()
    }
    fmi2TerminateTYPE = fmi2Terminate(|component|) { component.instance.terminate() }
    fmi2ResetTYPE = fmi2Reset(|component|) { component.instance.reset() }

    fmi2GetRealTYPE = fmi2GetReal(
        |component|, vr: *const fmi2ValueReference, nvr: usize, value: *mut fmi2Real
    ) {
        let plain = |v| if let Value::Real(v) = v { Some(v) } else { None };
        let values = component.instance.get(slice(vr, nvr, "vr")?, "Real")?;
        store(value, values.into_iter().filter_map(plain).collect(), "value")
    }
    fmi2GetIntegerTYPE = fmi2GetInteger(
        |component|, vr: *const fmi2ValueReference, nvr: usize, value: *mut fmi2Integer
    ) {
        let plain = |v| if let Value::Integer(v) = v { Some(v) } else { None };
        let values = component.instance.get(slice(vr, nvr, "vr")?, "Integer")?;
        store(value, values.into_iter().filter_map(plain).collect(), "value")
    }
    fmi2GetBooleanTYPE = fmi2GetBoolean(
        |component|, vr: *const fmi2ValueReference, nvr: usize, value: *mut fmi2Boolean
    ) {
        let plain = |v| if let Value::Boolean(v) = v { Some(v.into()) } else { None };
        let values = component.instance.get(slice(vr, nvr, "vr")?, "Boolean")?;
        store(value, values.into_iter().filter_map(plain).collect(), "value")
    }
    fmi2GetStringTYPE = fmi2GetString(
        |component|, vr: *const fmi2ValueReference, nvr: usize, value: *mut fmi2String
    ) {
        let plain = |v| if let Value::String(v) = v { Some(c_string(&v)) } else { None };
        let values = component.instance.get(slice(vr, nvr, "vr")?, "String")?;
        component.strings = values.into_iter().filter_map(plain).collect();
        store(value, component.strings.iter().map(|string| string.as_ptr()).collect(), "value")
    }

    fmi2SetRealTYPE = fmi2SetReal(
        |component|, vr: *const fmi2ValueReference, nvr: usize, value: *const fmi2Real
    ) {
        let values = slice(value, nvr, "value")?.iter().map(|v| Value::Real(*v)).collect();
        component.instance.set(slice(vr, nvr, "vr")?, values)
    }
    fmi2SetIntegerTYPE = fmi2SetInteger(
        |component|, vr: *const fmi2ValueReference, nvr: usize, value: *const fmi2Integer
    ) {
        let values = slice(value, nvr, "value")?.iter().map(|v| Value::Integer(*v)).collect();
        component.instance.set(slice(vr, nvr, "vr")?, values)
    }
    fmi2SetBooleanTYPE = fmi2SetBoolean(
        |component|, vr: *const fmi2ValueReference, nvr: usize, value: *const fmi2Boolean
    ) {
        let references = slice(vr, nvr, "vr")?;
        let values = booleans(references, slice(value, nvr, "value")?)?;
        component.instance.set(references, values.into_iter().map(Value::Boolean).collect())
    }
    fmi2SetStringTYPE = fmi2SetString(
        |component|, vr: *const fmi2ValueReference, nvr: usize, value: *const fmi2String
    ) {
        let values = slice(value, nvr, "value")?.iter().map(|v| Ok(Value::String(text(*v, "value")?)));
        component.instance.set(slice(vr, nvr, "vr")?, values.collect::<Outcome<_>>()?)
    }

    fmi2GetFMUstateTYPE = fmi2GetFMUstate(|component|, FMUstate: *mut fmi2FMUstate) {
        let snapshot = component.instance.snapshot()?;
        component.keep(FMUstate, snapshot)
    }
    fmi2SetFMUstateTYPE = fmi2SetFMUstate(|component|, FMUstate: fmi2FMUstate) {
        let Component { instance, states, .. } = component;
        instance.restore(states.find(FMUstate)?)
    }
    fmi2FreeFMUstateTYPE = fmi2FreeFMUstate(|component|, FMUstate: *mut fmi2FMUstate) {
        component.instance.allow(Call::FmuState)?;
        // The standard ignores calls without a state.
        if FMUstate.is_null() || handle_at(FMUstate)?.is_null() {
            return Ok(());
        }
        component.states.free(handle_at(FMUstate)?)?;
        store(FMUstate, vec![ptr::null_mut()], "FMUstate")
    }
    fmi2SerializedFMUstateSizeTYPE = fmi2SerializedFMUstateSize(
        |component|, FMUstate: fmi2FMUstate, size: *mut usize
    ) {
        store(size, vec![component.state_bytes(FMUstate)?.len()], "size")
    }
    fmi2SerializeFMUstateTYPE = fmi2SerializeFMUstate(
        |component|, FMUstate: fmi2FMUstate, serializedState: *mut fmi2Byte, size: usize
    ) {
        let bytes = component.state_bytes(FMUstate)?;
        if size < bytes.len() {
            let needed = bytes.len();
            return Err(CallError::error(format!("size = {size} is outside its range: at least {needed}")));
        }
        store(serializedState, bytes.into_iter().map(|byte| byte as fmi2Byte).collect(), "serializedState")
    }
    fmi2DeSerializeFMUstateTYPE = fmi2DeSerializeFMUstate(
        |component|, serializedState: *const fmi2Byte, size: usize, FMUstate: *mut fmi2FMUstate
    ) {
        component.instance.allow(Call::FmuState)?;
        let bytes = slice(serializedState.cast::<u8>(), size, "serializedState")?;
        let snapshot = Snapshot::from_bytes(bytes).map_err(CallError::error)?;
        component.keep(FMUstate, snapshot)
    }

    fmi2GetDirectionalDerivativeTYPE = fmi2GetDirectionalDerivative(
        |component|, vUnknown_ref: *const fmi2ValueReference, nUnknown: usize,
        vKnown_ref: *const fmi2ValueReference, nKnown: usize, dvKnown: *const fmi2Real, dvUnknown: *mut fmi2Real
    ) {
        let unknown = slice(vUnknown_ref, nUnknown, "vUnknown_ref")?;
        let (known, seed) = (slice(vKnown_ref, nKnown, "vKnown_ref")?, slice(dvKnown, nKnown, "dvKnown")?);
        store(dvUnknown, component.instance.directional_derivative(unknown, known, seed)?, "dvUnknown")
    }
    fmi2SetRealInputDerivativesTYPE = fmi2SetRealInputDerivatives(
        |component|, vr: *const fmi2ValueReference, nvr: usize, order: *const fmi2Integer, value: *const fmi2Real
    ) {
        let (orders, values) = (slice(order, nvr, "order")?, slice(value, nvr, "value")?);
        component.instance.set_input_derivatives(slice(vr, nvr, "vr")?, orders, values)
    }
    fmi2GetRealOutputDerivativesTYPE = fmi2GetRealOutputDerivatives(
        |component|, vr: *const fmi2ValueReference, nvr: usize, order: *const fmi2Integer, value: *mut fmi2Real
    ) {
        let (references, orders) = (slice(vr, nvr, "vr")?, slice(order, nvr, "order")?);
        store(value, component.instance.output_derivatives(references, orders)?, "value")
    }

    // States stay until the master frees them, whatever it promises about using them.
    fmi2DoStepTYPE = fmi2DoStep(
        |component|, currentCommunicationPoint: fmi2Real, communicationStepSize: fmi2Real,
        noSetFMUStatePriorToCurrentPoint: fmi2Boolean
    ) {
        boolean(noSetFMUStatePriorToCurrentPoint, "noSetFMUStatePriorToCurrentPoint")?;
        component.instance.do_step(currentCommunicationPoint, communicationStepSize)
    }
    fmi2CancelStepTYPE = fmi2CancelStep(|component|) { component.instance.allow(Call::CancelStep) }

    // One answer per type; there is nothing to say about pending steps because steps are never pending.
    fmi2GetStatusTYPE = fmi2GetStatus(|component|, s: c_int as fmi2StatusKind, value: *mut fmi2Status) {
        component.answers(s, Some(fmi2StatusKind::fmi2DoStepStatus))?;
        store(value, vec![status_code(component.instance.last_step())], "value")
    }
    fmi2GetRealStatusTYPE = fmi2GetRealStatus(|component|, s: c_int as fmi2StatusKind, value: *mut fmi2Real) {
        component.answers(s, Some(fmi2StatusKind::fmi2LastSuccessfulTime))?;
        store(value, vec![component.instance.last_successful_time()], "value")
    }
    fmi2GetBooleanStatusTYPE = fmi2GetBooleanStatus(|component|, s: c_int as fmi2StatusKind, value: *mut fmi2Boolean) {
        component.answers(s, Some(fmi2StatusKind::fmi2Terminated))?;
        store(value, vec![component.instance.terminated().into()], "value")
    }
    fmi2GetIntegerStatusTYPE = fmi2GetIntegerStatus(|component|, s: c_int as fmi2StatusKind, _value: *mut fmi2Integer) {
        component.answers(s, None)
    }
    fmi2GetStringStatusTYPE = fmi2GetStringStatus(|component|, s: c_int as fmi2StatusKind, _value: *mut fmi2String) {
        component.answers(s, None)
    }
}

const _: fmi2GetTypesPlatformTYPE = Some(fmi2GetTypesPlatform);
const _: fmi2GetVersionTYPE = Some(fmi2GetVersion);
// SAFETY: never called; `c_int` and the enumeration are passed alike (see `marshal`).
const _: fmi2InstantiateTYPE = Some(unsafe {
    std::mem::transmute::<
        unsafe extern "C" fn(
            fmi2String,
            c_int,
            fmi2String,
            fmi2String,
            *const fmi2CallbackFunctions,
            fmi2Boolean,
            fmi2Boolean,
        ) -> fmi2Component,
        unsafe extern "C" fn(
            fmi2String,
            fmi2Type,
            fmi2String,
            fmi2String,
            *const fmi2CallbackFunctions,
            fmi2Boolean,
            fmi2Boolean,
        ) -> fmi2Component,
    >(fmi2Instantiate)
});
const _: fmi2FreeInstanceTYPE = Some(fmi2FreeInstance);

#[cfg(test)]
mod tests {
    use super::states::States;
    use super::*;
    use crate::fmi::instance::Instance;
    use crate::fmi::log::{Log, Sink};
    use std::cell::RefCell;
    use std::rc::Rc;

    #[test]
    fn a_panic_becomes_fatal_and_leaves_only_freeing() {
        let messages = Rc::new(RefCell::new(Vec::new()));
        let heard = messages.clone();
        let sink: Sink = Box::new(move |status, _, message| heard.borrow_mut().push((status, message.to_owned())));
        let instance = Instance::new(None, Log::new(sink, false)).unwrap();
        let component = Component { instance, strings: Vec::new(), states: States::default() };
        let c = component.hand_out();
        // SAFETY: a component as `fmi2Instantiate` makes it, freed once at the end.
        unsafe {
            assert_eq!(fmi2EnterInitializationMode(c), fmi2Status::fmi2OK);
            assert_eq!(call(c, "fmi2DoStep", |_| panic!("wheel {} lost", 7)), fmi2Status::fmi2Fatal);
            assert_eq!(messages.take(), [(Status::Fatal, "fmi2DoStep: internal error: wheel 7 lost".to_owned())]);

            let (reference, mut state) = (1000, ptr::null_mut());
            for status in [
                fmi2Reset(c),
                fmi2Terminate(c),
                fmi2ExitInitializationMode(c),
                fmi2DoStep(c, 0.0, 1e-3, 1),
                fmi2GetReal(c, &reference, 1, &mut 0.0),
                fmi2SetReal(c, &reference, 1, &0.0),
                fmi2GetFMUstate(c, &mut state),
                fmi2SetDebugLogging(c, 1, 0, ptr::null()),
                fmi2GetBooleanStatus(c, 3, &mut 0),
            ] {
                assert_eq!(status, fmi2Status::fmi2Fatal);
            }
            assert!(messages.take().iter().all(|(_, message)| message.contains("Fatal")));
            fmi2FreeInstance(c);
        }
        assert_eq!(Rc::strong_count(&messages), 1, "the instance and its logger are gone");
    }
}
