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

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetDebugLogging(
    c: fmi2Component,
    loggingOn: fmi2Boolean,
    nCategories: usize,
    categories: *const fmi2String,
) -> fmi2Status {
    // SAFETY: see the module.
    unsafe {
        call(c, "fmi2SetDebugLogging", |component| {
            let names = slice(categories, nCategories, "categories")?;
            let names = names.iter().map(|name| text(*name, "category")).collect::<Outcome<Vec<_>>>()?;
            component.instance.set_debug_logging(loggingOn != 0, &names)
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetupExperiment(
    c: fmi2Component,
    toleranceDefined: fmi2Boolean,
    tolerance: fmi2Real,
    startTime: fmi2Real,
    stopTimeDefined: fmi2Boolean,
    stopTime: fmi2Real,
) -> fmi2Status {
    let tolerance = (toleranceDefined != 0).then_some(tolerance);
    let stop = (stopTimeDefined != 0).then_some(stopTime);
    // SAFETY: see the module.
    unsafe {
        call(c, "fmi2SetupExperiment", |component| component.instance.setup_experiment(tolerance, startTime, stop))
    }
}

/// Functions of the form `fmi2Status f(fmi2Component)`.
macro_rules! plain {
    ($($name:ident => $method:ident),* $(,)?) => {$(
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $name(c: fmi2Component) -> fmi2Status {
            // SAFETY: see the module.
            unsafe { call(c, stringify!($name), |component| component.instance.$method()) }
        }
    )*};
}

plain! {
    fmi2EnterInitializationMode => enter_initialization,
    fmi2ExitInitializationMode => exit_initialization,
    fmi2Terminate => terminate,
    fmi2Reset => reset,
}

/// Getter and setter of an FMI type that is passed by value.
macro_rules! access {
    ($($get:ident, $set:ident, $type:ty, $variant:ident, $name:literal, $into:expr, $from:expr;)*) => {$(
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $get(
            c: fmi2Component,
            vr: *const fmi2ValueReference,
            nvr: usize,
            value: *mut $type,
        ) -> fmi2Status {
            // SAFETY: see the module.
            unsafe {
                call(c, stringify!($get), |component| {
                    let values = component.instance.get(slice(vr, nvr, "vr")?, $name)?;
                    let plain = |v| if let Value::$variant(v) = v { Some($into(v)) } else { None };
                    store(value, values.into_iter().filter_map(plain).collect(), "value")
                })
            }
        }

        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $set(
            c: fmi2Component,
            vr: *const fmi2ValueReference,
            nvr: usize,
            value: *const $type,
        ) -> fmi2Status {
            // SAFETY: see the module.
            unsafe {
                call(c, stringify!($set), |component| {
                    let references = slice(vr, nvr, "vr")?;
                    let values = slice(value, nvr, "value")?.iter().map(|v| Value::$variant($from(*v)));
                    component.instance.set(references, values.collect())
                })
            }
        }
    )*};
}

access! {
    fmi2GetReal, fmi2SetReal, fmi2Real, Real, "Real", std::convert::identity, std::convert::identity;
    fmi2GetInteger, fmi2SetInteger, fmi2Integer, Integer, "Integer", std::convert::identity, std::convert::identity;
    fmi2GetBoolean, fmi2SetBoolean, fmi2Boolean, Boolean, "Boolean", fmi2Boolean::from, |v: fmi2Boolean| v != 0;
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetString(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    value: *mut fmi2String,
) -> fmi2Status {
    // SAFETY: see the module; the strings live until the next call of this function.
    unsafe {
        call(c, "fmi2GetString", |component| {
            let values = component.instance.get(slice(vr, nvr, "vr")?, "String")?;
            let plain = |v| {
                if let Value::String(v) = v { Some(c_string(&v)) } else { None }
            };
            component.strings = values.into_iter().filter_map(plain).collect();
            store(value, component.strings.iter().map(|s| s.as_ptr()).collect(), "value")
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetString(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    value: *const fmi2String,
) -> fmi2Status {
    // SAFETY: see the module.
    unsafe {
        call(c, "fmi2SetString", |component| {
            let references = slice(vr, nvr, "vr")?;
            let values = slice(value, nvr, "value")?.iter().map(|v| Ok(Value::String(text(*v, "value")?)));
            component.instance.set(references, values.collect::<Outcome<_>>()?)
        })
    }
}

/// Place of the master's `fmi2FMUstate`.
unsafe fn place<'a>(state: *mut fmi2FMUstate) -> Outcome<&'a mut fmi2FMUstate> {
    // SAFETY: see the module: NULL or the address of a handle.
    unsafe { state.as_mut() }.ok_or_else(|| Refusal::error("FMUstate is NULL"))
}

impl Component {
    /// Keeps a snapshot under the handle at `place`, a new one unless the place already holds one.
    fn keep(&mut self, place: &mut fmi2FMUstate, snapshot: Snapshot) -> Outcome {
        static NEXT: AtomicUsize = AtomicUsize::new(1);
        if place.is_null() {
            *place = ptr::without_provenance_mut(NEXT.fetch_add(1, Ordering::Relaxed));
        } else {
            self.state(*place)?;
        }
        self.states.insert(place.addr(), snapshot);
        Ok(())
    }

    fn state(&self, handle: fmi2FMUstate) -> Outcome<&Snapshot> {
        let unknown = || Refusal::error("FMUstate is not a state of this instance, or has been freed");
        self.states.get(&handle.addr()).ok_or_else(unknown)
    }

    fn state_bytes(&self, handle: fmi2FMUstate) -> Outcome<Vec<u8>> {
        self.instance.allow(Call::FmuState)?;
        self.state(handle)?.to_bytes().map_err(Refusal::error)
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetFMUstate(c: fmi2Component, FMUstate: *mut fmi2FMUstate) -> fmi2Status {
    // SAFETY: see the module.
    unsafe {
        call(c, "fmi2GetFMUstate", |component| {
            let snapshot = component.instance.snapshot()?;
            component.keep(place(FMUstate)?, snapshot)
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetFMUstate(c: fmi2Component, FMUstate: fmi2FMUstate) -> fmi2Status {
    // SAFETY: see the module.
    unsafe {
        call(c, "fmi2SetFMUstate", |component| {
            let snapshot = component.state(FMUstate)?.clone();
            component.instance.restore(&snapshot)
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2FreeFMUstate(c: fmi2Component, FMUstate: *mut fmi2FMUstate) -> fmi2Status {
    // SAFETY: see the module.
    unsafe {
        call(c, "fmi2FreeFMUstate", |component| {
            component.instance.allow(Call::FmuState)?;
            if let Some(place) = FMUstate.as_mut().filter(|place| !place.is_null()) {
                component.state(*place)?;
                component.states.remove(&place.addr());
                *place = ptr::null_mut();
            }
            Ok(())
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SerializedFMUstateSize(
    c: fmi2Component,
    FMUstate: fmi2FMUstate,
    size: *mut usize,
) -> fmi2Status {
    // SAFETY: see the module.
    unsafe {
        call(c, "fmi2SerializedFMUstateSize", |component| {
            store(size, vec![component.state_bytes(FMUstate)?.len()], "size")
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SerializeFMUstate(
    c: fmi2Component,
    FMUstate: fmi2FMUstate,
    serializedState: *mut fmi2Byte,
    size: usize,
) -> fmi2Status {
    // SAFETY: see the module.
    unsafe {
        call(c, "fmi2SerializeFMUstate", |component| {
            let bytes = component.state_bytes(FMUstate)?;
            if size < bytes.len() {
                let needed = bytes.len();
                return Err(Refusal::error(format!("size = {size} is outside its range: at least {needed}")));
            }
            store(serializedState, bytes.into_iter().map(|byte| byte as fmi2Byte).collect(), "serializedState")
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2DeSerializeFMUstate(
    c: fmi2Component,
    serializedState: *const fmi2Byte,
    size: usize,
    FMUstate: *mut fmi2FMUstate,
) -> fmi2Status {
    // SAFETY: see the module.
    unsafe {
        call(c, "fmi2DeSerializeFMUstate", |component| {
            component.instance.allow(Call::FmuState)?;
            let bytes = slice(serializedState.cast::<u8>(), size, "serializedState")?;
            let snapshot = Snapshot::from_bytes(bytes).map_err(Refusal::error)?;
            component.keep(place(FMUstate)?, snapshot)
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetDirectionalDerivative(
    c: fmi2Component,
    _vUnknown_ref: *const fmi2ValueReference,
    _nUnknown: usize,
    _vKnown_ref: *const fmi2ValueReference,
    _nKnown: usize,
    _dvKnown: *const fmi2Real,
    _dvUnknown: *mut fmi2Real,
) -> fmi2Status {
    // SAFETY: see the module.
    unsafe {
        call(c, "fmi2GetDirectionalDerivative", |component| {
            component.instance.allow(Call::GetDirectionalDerivative)?;
            Err(Refusal::error("directional derivatives are not provided (providesDirectionalDerivative = false)"))
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetRealInputDerivatives(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    order: *const fmi2Integer,
    value: *const fmi2Real,
) -> fmi2Status {
    // SAFETY: see the module.
    unsafe {
        call(c, "fmi2SetRealInputDerivatives", |component| {
            let (orders, values) = (slice(order, nvr, "order")?, slice(value, nvr, "value")?);
            component.instance.set_input_derivatives(slice(vr, nvr, "vr")?, orders, values)
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetRealOutputDerivatives(
    c: fmi2Component,
    _vr: *const fmi2ValueReference,
    nvr: usize,
    _order: *const fmi2Integer,
    _value: *mut fmi2Real,
) -> fmi2Status {
    // SAFETY: see the module.
    unsafe {
        call(c, "fmi2GetRealOutputDerivatives", |component| {
            component.instance.allow(Call::GetRealOutputDerivatives)?;
            if nvr == 0 {
                return Ok(());
            }
            Err(Refusal::error("output derivatives are not provided (maxOutputDerivativeOrder = 0)"))
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2DoStep(
    c: fmi2Component,
    currentCommunicationPoint: fmi2Real,
    communicationStepSize: fmi2Real,
    _noSetFMUStatePriorToCurrentPoint: fmi2Boolean,
) -> fmi2Status {
    // SAFETY: see the module. States stay until the master frees them, whatever it promises about using them.
    unsafe {
        call(c, "fmi2DoStep", |component| component.instance.do_step(currentCommunicationPoint, communicationStepSize))
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2CancelStep(c: fmi2Component) -> fmi2Status {
    // SAFETY: see the module.
    unsafe { call(c, "fmi2CancelStep", |component| component.instance.allow(Call::CancelStep)) }
}

/// Queries of the last step: one answer per type, everything else is not available (`fmi2Discard`).
macro_rules! status {
    ($($name:ident, $type:ty, $kind:pat, $answer:expr;)*) => {$(
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $name(c: fmi2Component, s: fmi2StatusKind, value: *mut $type) -> fmi2Status {
            // SAFETY: see the module.
            unsafe {
                call(c, stringify!($name), |component| {
                    component.instance.allow(Call::GetStatus)?;
                    if matches!(s, $kind) {
                        let answer: fn(&mut Component) -> $type = $answer;
                        return store(value, vec![answer(component)], "value");
                    }
                    Err(Refusal::discard(format!("{s:?} is not available through this function")))
                })
            }
        }
    )*};
}

status! {
    fmi2GetStatus, fmi2Status, fmi2StatusKind::fmi2DoStepStatus, |c| status_code(c.instance.last_step());
    fmi2GetRealStatus, fmi2Real, fmi2StatusKind::fmi2LastSuccessfulTime, |c| c.instance.last_successful_time();
    fmi2GetBooleanStatus, fmi2Boolean, fmi2StatusKind::fmi2Terminated, |c| c.instance.terminated().into();
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetIntegerStatus(
    c: fmi2Component,
    s: fmi2StatusKind,
    _value: *mut fmi2Integer,
) -> fmi2Status {
    // SAFETY: see the module.
    unsafe { call(c, "fmi2GetIntegerStatus", |component| not_available(component, s)) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetStringStatus(
    c: fmi2Component,
    s: fmi2StatusKind,
    _value: *mut fmi2String,
) -> fmi2Status {
    // SAFETY: see the module.
    unsafe { call(c, "fmi2GetStringStatus", |component| not_available(component, s)) }
}

/// Steps are never pending, so there is no text or number about a pending one.
fn not_available(component: &mut Component, s: fmi2StatusKind) -> Outcome {
    component.instance.allow(Call::GetStatus)?;
    Err(Refusal::discard(format!("{s:?} is not available through this function")))
}

/// Every signature against the headers of the standard, at compile time.
macro_rules! signatures {
    ($($function:ident: $type:ident,)*) => {$(const _: $type = Some($function);)*};
}

signatures! {
    fmi2SetDebugLogging: fmi2SetDebugLoggingTYPE,
    fmi2Instantiate: fmi2InstantiateTYPE,
    fmi2FreeInstance: fmi2FreeInstanceTYPE,
    fmi2SetupExperiment: fmi2SetupExperimentTYPE,
    fmi2EnterInitializationMode: fmi2EnterInitializationModeTYPE,
    fmi2ExitInitializationMode: fmi2ExitInitializationModeTYPE,
    fmi2Terminate: fmi2TerminateTYPE,
    fmi2Reset: fmi2ResetTYPE,
    fmi2GetReal: fmi2GetRealTYPE,
    fmi2GetInteger: fmi2GetIntegerTYPE,
    fmi2GetBoolean: fmi2GetBooleanTYPE,
    fmi2GetString: fmi2GetStringTYPE,
    fmi2SetReal: fmi2SetRealTYPE,
    fmi2SetInteger: fmi2SetIntegerTYPE,
    fmi2SetBoolean: fmi2SetBooleanTYPE,
    fmi2SetString: fmi2SetStringTYPE,
    fmi2GetFMUstate: fmi2GetFMUstateTYPE,
    fmi2SetFMUstate: fmi2SetFMUstateTYPE,
    fmi2FreeFMUstate: fmi2FreeFMUstateTYPE,
    fmi2SerializedFMUstateSize: fmi2SerializedFMUstateSizeTYPE,
    fmi2SerializeFMUstate: fmi2SerializeFMUstateTYPE,
    fmi2DeSerializeFMUstate: fmi2DeSerializeFMUstateTYPE,
    fmi2GetDirectionalDerivative: fmi2GetDirectionalDerivativeTYPE,
    fmi2SetRealInputDerivatives: fmi2SetRealInputDerivativesTYPE,
    fmi2GetRealOutputDerivatives: fmi2GetRealOutputDerivativesTYPE,
    fmi2DoStep: fmi2DoStepTYPE,
    fmi2CancelStep: fmi2CancelStepTYPE,
    fmi2GetStatus: fmi2GetStatusTYPE,
    fmi2GetRealStatus: fmi2GetRealStatusTYPE,
    fmi2GetIntegerStatus: fmi2GetIntegerStatusTYPE,
    fmi2GetBooleanStatus: fmi2GetBooleanStatusTYPE,
    fmi2GetStringStatus: fmi2GetStringStatusTYPE,
}
const _: fmi2GetTypesPlatformTYPE = Some(fmi2GetTypesPlatform);
const _: fmi2GetVersionTYPE = Some(fmi2GetVersion);
