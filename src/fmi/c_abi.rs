//! The C interface: the 34 functions of FMI 2.0 co-simulation, and the only `unsafe` of the crate.
//!
//! Each function checks its pointers, copies what it is given, calls [`Instance`] behind a barrier that turns panics
//! into `fmi2Fatal`, and reports refusals in one place. What the standard demands of masters, and what every `SAFETY`
//! comment below relies on: a component is one that `fmi2Instantiate` returned and `fmi2FreeInstance` has not freed,
//! used by one thread at a time; arrays have the stated lengths; strings end with NUL; enumerations are in range.

#![allow(unsafe_code, non_snake_case, clippy::missing_safety_doc)]

use super::description::guid;
use super::instance::Instance;
use super::lifecycle::Call;
use super::log::{Log, Refusal, Sink, Status};
use super::snapshot::Snapshot;
use super::uri::path_of;
use super::variable::Value;
use libfmi::*;
use std::any::Any;
use std::collections::BTreeMap;
use std::ffi::{CStr, CString, c_char};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::ptr;
use std::sync::atomic::{AtomicUsize, Ordering};

/// What a master holds as `fmi2Component`.
struct Component {
    instance: Instance,
    /// Strings that the master may read until its next call of a function that returns strings.
    strings: Vec<CString>,
    /// Saved states by the handle that the master holds as `fmi2FMUstate`; handles are never dereferenced.
    states: BTreeMap<usize, Snapshot>,
}

type Outcome<T = ()> = Result<T, Refusal>;

fn status_code(status: Status) -> fmi2Status {
    match status {
        Status::Ok => fmi2Status::fmi2OK,
        Status::Warning => fmi2Status::fmi2Warning,
        Status::Discard => fmi2Status::fmi2Discard,
        Status::Error => fmi2Status::fmi2Error,
        Status::Fatal => fmi2Status::fmi2Fatal,
    }
}

fn panic_text(panic: Box<dyn Any + Send>) -> String {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_else(|| "no message".to_owned())
}

/// Runs the body on the component: refusals are logged and become a status, panics become `fmi2Fatal`.
unsafe fn call(c: fmi2Component, name: &str, body: impl FnOnce(&mut Component) -> Outcome) -> fmi2Status {
    // SAFETY: see the module: `c` is null or ours, and nobody else uses it now.
    let Some(component) = (unsafe { c.cast::<Component>().as_mut() }) else {
        return fmi2Status::fmi2Error;
    };
    let refusal = match catch_unwind(AssertUnwindSafe(|| body(component))) {
        Ok(Ok(())) => return fmi2Status::fmi2OK,
        Ok(Err(refusal)) => refusal,
        Err(panic) => {
            component.instance.give_up();
            Refusal { status: Status::Fatal, message: format!("internal error: {}", panic_text(panic)) }
        }
    };
    component.instance.log().report(refusal.status, &format!("{name}: {}", refusal.message));
    status_code(refusal.status)
}

/// The array a master passed; an empty one may be NULL.
unsafe fn slice<'a, T>(first: *const T, count: usize, name: &str) -> Outcome<&'a [T]> {
    match (count, first.is_null()) {
        (0, _) => Ok(&[]),
        (_, true) => Err(Refusal::error(format!("{name} is NULL"))),
        // SAFETY: see the module: the array has this length, and it outlives the call.
        _ => Ok(unsafe { std::slice::from_raw_parts(first, count) }),
    }
}

/// Writes `values` to the array at `first`, which has the same length.
unsafe fn store<T>(first: *mut T, values: Vec<T>, name: &str) -> Outcome {
    if first.is_null() && !values.is_empty() {
        return Err(Refusal::error(format!("{name} is NULL")));
    }
    for (i, value) in values.into_iter().enumerate() {
        // SAFETY: see the module: the array has the length of `values`.
        unsafe { first.add(i).write(value) };
    }
    Ok(())
}

unsafe fn text(string: fmi2String, name: &str) -> Outcome<String> {
    if string.is_null() {
        return Err(Refusal::error(format!("{name} is NULL")));
    }
    // SAFETY: see the module: the string ends with NUL and outlives the call.
    let bytes = unsafe { CStr::from_ptr(string) };
    let text = bytes.to_str().map_err(|_| Refusal::error(format!("{name} is not UTF-8: {bytes:?}")))?;
    Ok(text.to_owned())
}

fn c_string(text: &str) -> CString {
    CString::new(text.replace('\0', " ")).unwrap_or_default()
}

/// Passes messages to the master's logger, each as an argument of the format `%s`, never as a format.
fn sink(name: &str, functions: &fmi2CallbackFunctions) -> Sink {
    let (name, logger, environment) = (c_string(name), functions.logger, functions.componentEnvironment);
    Box::new(move |status, category, message| {
        let Some(logger) = logger else { return };
        let (status, category, message) = (status_code(status), c_string(category), c_string(message));
        // SAFETY: the master's own function with the master's own environment; all strings end with NUL.
        unsafe {
            logger(environment, name.as_ptr(), status, category.as_ptr(), c"%s".as_ptr(), message.as_ptr());
        }
    })
}

/// Place of the master's `fmi2FMUstate`.
unsafe fn place<'a>(state: *mut fmi2FMUstate) -> Outcome<&'a mut fmi2FMUstate> {
    // SAFETY: see the module: NULL or the address of a handle.
    unsafe { state.as_mut() }.ok_or_else(|| Refusal::error("FMUstate is NULL"))
}

fn find_state(states: &BTreeMap<usize, Snapshot>, handle: fmi2FMUstate) -> Outcome<&Snapshot> {
    let unknown = || Refusal::error("FMUstate is not a state of this instance, or has been freed");
    states.get(&handle.addr()).ok_or_else(unknown)
}

impl Component {
    /// Keeps a snapshot under the handle at `place`, a new one unless the place already holds one.
    fn keep(&mut self, place: &mut fmi2FMUstate, snapshot: Snapshot) -> Outcome {
        // Handles differ between instances, so that those of another one are refused.
        static NEXT: AtomicUsize = AtomicUsize::new(1);
        if place.is_null() {
            *place = ptr::without_provenance_mut(NEXT.fetch_add(1, Ordering::Relaxed));
        } else {
            find_state(&self.states, *place)?;
        }
        self.states.insert(place.addr(), snapshot);
        Ok(())
    }

    fn state_bytes(&self, handle: fmi2FMUstate) -> Outcome<Vec<u8>> {
        self.instance.allow(Call::FmuState)?;
        find_state(&self.states, handle)?.to_bytes().map_err(Refusal::error)
    }

    /// Refuses questions about the last step other than the one that a function answers.
    fn answers(&self, question: fmi2StatusKind, answered: Option<fmi2StatusKind>) -> Outcome {
        self.instance.allow(Call::GetStatus)?;
        if answered == Some(question) {
            return Ok(());
        }
        Err(Refusal::discard(format!("{question:?} is not available through this function")))
    }
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetTypesPlatform() -> *const c_char {
    c"default".as_ptr()
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetVersion() -> *const c_char {
    c"2.0".as_ptr()
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Instantiate(
    instanceName: fmi2String,
    fmuType: fmi2Type,
    fmuGUID: fmi2String,
    fmuResourceLocation: fmi2String,
    functions: *const fmi2CallbackFunctions,
    _visible: fmi2Boolean,
    loggingOn: fmi2Boolean,
) -> fmi2Component {
    // SAFETY: see the module: NULL or the master's functions.
    let Some(functions) = (unsafe { functions.as_ref() }) else {
        return ptr::null_mut();
    };
    let instantiate = || {
        // SAFETY: see the module: NULL or a string.
        let name = unsafe { text(instanceName, "instanceName") };
        let sink = || sink(name.as_deref().unwrap_or("unnamed"), functions);
        let create = || {
            if name.clone()?.is_empty() {
                return Err(Refusal::error("instanceName is empty"));
            }
            if fmuType != fmi2Type::fmi2CoSimulation {
                return Err(Refusal::error("fmuType is not fmi2CoSimulation, the only type of this FMU"));
            }
            // SAFETY: see the module: NULL or a string.
            let theirs = unsafe { text(fmuGUID, "fmuGUID") }?;
            if theirs != guid() {
                return Err(Refusal::error(format!("fmuGUID = \"{theirs}\" is not that of this FMU: \"{}\"", guid())));
            }
            let log = Log::new(sink(), loggingOn != fmi2False as fmi2Boolean);
            let resources = if fmuResourceLocation.is_null() {
                None
            } else {
                // SAFETY: see the module: a string.
                let location = unsafe { text(fmuResourceLocation, "fmuResourceLocation") };
                let path = location.and_then(|location| path_of(&location).map_err(Refusal::error));
                let path = path.map_err(|refusal| log.report(Status::Warning, &refusal.message)).ok();
                path.filter(|path| {
                    let exists = path.is_dir();
                    if !exists {
                        let message = format!("resources {} do not exist: only defaults are known", path.display());
                        log.report(Status::Warning, &message);
                    }
                    exists
                })
            };
            Instance::new(resources, log)
        };
        match create() {
            Ok(instance) => Some(Box::new(Component { instance, strings: Vec::new(), states: BTreeMap::new() })),
            Err(refusal) => {
                Log::new(sink(), false).report(refusal.status, &format!("fmi2Instantiate: {}", refusal.message));
                None
            }
        }
    };
    match catch_unwind(AssertUnwindSafe(instantiate)) {
        Ok(Some(component)) => Box::into_raw(component).cast(),
        Ok(None) => ptr::null_mut(),
        Err(panic) => {
            let message = format!("fmi2Instantiate: internal error: {}", panic_text(panic));
            Log::new(sink("unnamed", functions), false).report(Status::Fatal, &message);
            ptr::null_mut()
        }
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2FreeInstance(c: fmi2Component) {
    if !c.is_null() {
        // SAFETY: see the module: `c` came from `Box::into_raw` in `fmi2Instantiate` and is not used afterwards.
        let component = unsafe { Box::from_raw(c.cast::<Component>()) };
        let _ = catch_unwind(AssertUnwindSafe(|| drop(component)));
    }
}

/// Exports functions that take a component and return a status, and compares each with the type that the header of the
/// standard gives it. The body runs behind [`call`].
macro_rules! export {
    ($($type:ident = $name:ident(|$component:ident| $(, $argument:ident: $of:ty)*) $body:block)*) => {$(
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $name(c: fmi2Component $(, $argument: $of)*) -> fmi2Status {
            // SAFETY: see the module.
            unsafe { call(c, stringify!($name), |$component| $body) }
        }
        const _: $type = Some($name);
    )*};
}

export! {
    fmi2SetDebugLoggingTYPE = fmi2SetDebugLogging(
        |component|, loggingOn: fmi2Boolean, nCategories: usize, categories: *const fmi2String
    ) {
        let names = slice(categories, nCategories, "categories")?;
        let names = names.iter().map(|name| text(*name, "category")).collect::<Outcome<Vec<_>>>()?;
        component.instance.set_debug_logging(loggingOn != 0, &names)
    }

    fmi2SetupExperimentTYPE = fmi2SetupExperiment(
        |component|, toleranceDefined: fmi2Boolean, tolerance: fmi2Real, startTime: fmi2Real,
        stopTimeDefined: fmi2Boolean, stopTime: fmi2Real
    ) {
        let tolerance = (toleranceDefined != 0).then_some(tolerance);
        let stop = (stopTimeDefined != 0).then_some(stopTime);
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
        let values = slice(value, nvr, "value")?.iter().map(|v| Value::Boolean(*v != 0)).collect();
        component.instance.set(slice(vr, nvr, "vr")?, values)
    }
    fmi2SetStringTYPE = fmi2SetString(
        |component|, vr: *const fmi2ValueReference, nvr: usize, value: *const fmi2String
    ) {
        let values = slice(value, nvr, "value")?.iter().map(|v| Ok(Value::String(text(*v, "value")?)));
        component.instance.set(slice(vr, nvr, "vr")?, values.collect::<Outcome<_>>()?)
    }

    fmi2GetFMUstateTYPE = fmi2GetFMUstate(|component|, FMUstate: *mut fmi2FMUstate) {
        let snapshot = component.instance.snapshot()?;
        component.keep(place(FMUstate)?, snapshot)
    }
    fmi2SetFMUstateTYPE = fmi2SetFMUstate(|component|, FMUstate: fmi2FMUstate) {
        let Component { instance, states, .. } = component;
        instance.restore(find_state(states, FMUstate)?)
    }
    fmi2FreeFMUstateTYPE = fmi2FreeFMUstate(|component|, FMUstate: *mut fmi2FMUstate) {
        component.instance.allow(Call::FmuState)?;
        if let Some(place) = FMUstate.as_mut().filter(|place| !place.is_null()) {
            find_state(&component.states, *place)?;
            component.states.remove(&place.addr());
            *place = ptr::null_mut();
        }
        Ok(())
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
            return Err(Refusal::error(format!("size = {size} is outside its range: at least {needed}")));
        }
        store(serializedState, bytes.into_iter().map(|byte| byte as fmi2Byte).collect(), "serializedState")
    }
    fmi2DeSerializeFMUstateTYPE = fmi2DeSerializeFMUstate(
        |component|, serializedState: *const fmi2Byte, size: usize, FMUstate: *mut fmi2FMUstate
    ) {
        component.instance.allow(Call::FmuState)?;
        let bytes = slice(serializedState.cast::<u8>(), size, "serializedState")?;
        let snapshot = Snapshot::from_bytes(bytes).map_err(Refusal::error)?;
        component.keep(place(FMUstate)?, snapshot)
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
        _noSetFMUStatePriorToCurrentPoint: fmi2Boolean
    ) {
        component.instance.do_step(currentCommunicationPoint, communicationStepSize)
    }
    fmi2CancelStepTYPE = fmi2CancelStep(|component|) { component.instance.allow(Call::CancelStep) }

    // One answer per type; there is nothing to say about pending steps because steps are never pending.
    fmi2GetStatusTYPE = fmi2GetStatus(|component|, s: fmi2StatusKind, value: *mut fmi2Status) {
        component.answers(s, Some(fmi2StatusKind::fmi2DoStepStatus))?;
        store(value, vec![status_code(component.instance.last_step())], "value")
    }
    fmi2GetRealStatusTYPE = fmi2GetRealStatus(|component|, s: fmi2StatusKind, value: *mut fmi2Real) {
        component.answers(s, Some(fmi2StatusKind::fmi2LastSuccessfulTime))?;
        store(value, vec![component.instance.last_successful_time()], "value")
    }
    fmi2GetBooleanStatusTYPE = fmi2GetBooleanStatus(|component|, s: fmi2StatusKind, value: *mut fmi2Boolean) {
        component.answers(s, Some(fmi2StatusKind::fmi2Terminated))?;
        store(value, vec![component.instance.terminated().into()], "value")
    }
    fmi2GetIntegerStatusTYPE = fmi2GetIntegerStatus(|component|, s: fmi2StatusKind, _value: *mut fmi2Integer) {
        component.answers(s, None)
    }
    fmi2GetStringStatusTYPE = fmi2GetStringStatus(|component|, s: fmi2StatusKind, _value: *mut fmi2String) {
        component.answers(s, None)
    }
}

const _: fmi2GetTypesPlatformTYPE = Some(fmi2GetTypesPlatform);
const _: fmi2GetVersionTYPE = Some(fmi2GetVersion);
const _: fmi2InstantiateTYPE = Some(fmi2Instantiate);
const _: fmi2FreeInstanceTYPE = Some(fmi2FreeInstance);

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::RefCell;
    use std::rc::Rc;

    #[test]
    fn a_panic_becomes_fatal_and_leaves_only_freeing() {
        let messages = Rc::new(RefCell::new(Vec::new()));
        let heard = messages.clone();
        let sink: Sink = Box::new(move |status, _, message| heard.borrow_mut().push((status, message.to_owned())));
        let instance = Instance::new(None, Log::new(sink, false)).unwrap();
        let component = Component { instance, strings: Vec::new(), states: BTreeMap::new() };
        let c: fmi2Component = Box::into_raw(Box::new(component)).cast();
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
                fmi2GetBooleanStatus(c, fmi2StatusKind::fmi2Terminated, &mut 0),
            ] {
                assert_eq!(status, fmi2Status::fmi2Fatal);
            }
            assert!(messages.take().iter().all(|(_, message)| message.contains("Fatal")));
            fmi2FreeInstance(c);
        }
        assert_eq!(Rc::strong_count(&messages), 1, "the instance and its logger are gone");
    }
}
