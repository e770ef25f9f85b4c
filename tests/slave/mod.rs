//! A small master: the compiled shared library through its C interface, with names instead of value references.
#![allow(dead_code, unsafe_code)]

pub use libfmi::fmi2Status::{self, *};
use libfmi::*;
use std::cell::RefCell;
use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::path::{Path, PathBuf};
use std::ptr;
use std::sync::OnceLock;
use wheelrail::fmi::v2::variables::variables;
use wheelrail::fmi::variable::{Causality, Kind, Value, Variable};

/// The shared library that was built with the test executable.
pub fn library() -> PathBuf {
    let executable = std::env::current_exe().unwrap();
    let directory = executable.parent().unwrap();
    let name = format!("{}wheelrail{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
    directory.join(name)
}

pub fn load() -> Fmi2Dll {
    let path = library();
    let load = || load_from(&path).unwrap_or_else(|problem| panic!("{problem}"));
    if std::env::var_os("WHEELRAIL_KEEP_LOADED").is_some() {
        // A library that stays: what its tables hold counts as lost when it is unloaded.
        static KEPT: OnceLock<Fmi2Dll> = OnceLock::new();
        KEPT.get_or_init(load);
    }
    load()
}

/// Any version of our own library, or why it cannot be loaded.
pub fn load_from(path: &Path) -> Result<Fmi2Dll, String> {
    // SAFETY: our own library, whose loading runs no code.
    unsafe { Fmi2Dll::new(path) }.map_err(|error| format!("{}: {error}", path.display()))
}

pub const RESOURCES: &str = concat!("file://", env!("CARGO_MANIFEST_DIR"), "/resources");
/// Where the physics tests keep reduced bases; beside them only the compiled-in preset is known.
pub const STORED_BASES: &str = concat!("file://", env!("CARGO_MANIFEST_DIR"), "/target");

pub fn guid() -> &'static str {
    static GUID: OnceLock<String> = OnceLock::new();
    GUID.get_or_init(wheelrail::fmi::v2::description::guid)
}

pub fn variable(name: &str) -> &'static Variable {
    variables().iter().find(|v| v.name == name).unwrap_or_else(|| panic!("no variable {name}"))
}

#[derive(Clone, Debug, PartialEq)]
pub struct Message {
    pub instance: String,
    pub status: fmi2Status,
    pub category: String,
    pub format: String,
    pub text: String,
}

type Messages = RefCell<Vec<Message>>;

/// The logger of the standard is variadic, which stable Rust cannot define. This one reads no variable argument, as the
/// loggers of many masters do; callers clean up after variadic functions, so that none is missed.
unsafe extern "C" fn record(
    environment: fmi2ComponentEnvironment,
    instance: fmi2String,
    status: fmi2Status,
    category: fmi2String,
    format: fmi2String,
) {
    // SAFETY: the environment is the message list of the slave; the library passes strings that end with NUL.
    unsafe {
        let string = |s: fmi2String| CStr::from_ptr(s).to_str().unwrap().to_owned();
        let message = Message {
            instance: string(instance),
            status,
            category: string(category),
            format: string(format),
            text: printed(CStr::from_ptr(format)),
        };
        (*environment.cast::<Messages>()).borrow_mut().push(message);
    }
}

unsafe extern "C" {
    fn snprintf(buffer: *mut c_char, size: usize, format: *const c_char, ...) -> c_int;
}

/// Text that `printf` of the C library makes of a format without arguments.
fn printed(format: &CStr) -> String {
    let mut buffer = vec![0u8; format.count_bytes() + 1];
    // SAFETY: no text is longer than a format that asks for no arguments.
    let length = unsafe { snprintf(buffer.as_mut_ptr().cast(), buffer.len(), format.as_ptr()) };
    assert!((0..buffer.len() as c_int).contains(&length), "{format:?} asks for arguments");
    CStr::from_bytes_until_nul(&buffer).unwrap().to_str().unwrap().to_owned()
}

/// A function of the library that takes C integers where the header has enumerations, as a C master calls it.
macro_rules! plain {
    ($dll:ident.$name:ident, ($($argument:ty),*) -> $result:ty) => {
        {
            #[allow(clippy::missing_transmute_annotations)]
            let function: unsafe extern "C" fn($($argument),*) -> $result =
                std::mem::transmute(*$dll.$name.as_ref().unwrap());
            function
        }
    };
}

/// Arguments of `fmi2Instantiate`.
pub struct Arguments<'a> {
    pub name: Option<&'a str>,
    pub kind: c_int,
    pub guid: Option<&'a str>,
    pub resources: Option<&'a str>,
    pub callbacks: bool,
    pub visible: c_int,
    pub logging: c_int,
}

impl Default for Arguments<'static> {
    fn default() -> Self {
        Arguments {
            name: Some("wheel"),
            kind: fmi2Type::fmi2CoSimulation as c_int,
            guid: Some(guid()),
            resources: Some(RESOURCES),
            callbacks: true,
            visible: 0,
            logging: 0,
        }
    }
}

/// One instance. Methods return the status of the call unless a refusal would make the test meaningless.
pub struct Slave<'a> {
    pub dll: &'a Fmi2Dll,
    pub component: fmi2Component,
    messages: Box<Messages>,
    _callbacks: Box<fmi2CallbackFunctions>,
}

impl Drop for Slave<'_> {
    fn drop(&mut self) {
        // SAFETY: the component came from this library and is freed once.
        unsafe { self.dll.fmi2FreeInstance(self.component) }
    }
}

fn c(text: &str) -> CString {
    CString::new(text).unwrap()
}

impl<'a> Slave<'a> {
    /// The instance, or the messages of a refused instantiation.
    pub fn try_new(dll: &'a Fmi2Dll, arguments: &Arguments) -> Result<Slave<'a>, Vec<Message>> {
        let messages: Box<Messages> = Box::default();
        // SAFETY: same size and, for these arguments, same calling convention; see `record`.
        let logger: fmi2CallbackLogger = unsafe { std::mem::transmute(record as *const c_void) };
        let callbacks = Box::new(fmi2CallbackFunctions {
            logger,
            allocateMemory: None,
            freeMemory: None,
            stepFinished: None,
            componentEnvironment: ptr::from_ref(&*messages).cast_mut().cast(),
        });
        let [name, guid, resources] = [arguments.name, arguments.guid, arguments.resources].map(|s| s.map(c));
        let pointer = |s: &Option<CString>| s.as_ref().map_or(ptr::null(), |s| s.as_ptr());
        // SAFETY: strings end with NUL; the callbacks live as long as the slave.
        let component = unsafe {
            let instantiate = plain!(dll.fmi2Instantiate,
                (fmi2String, c_int, fmi2String, fmi2String, *const fmi2CallbackFunctions, c_int, c_int)
                -> fmi2Component);
            instantiate(
                pointer(&name),
                arguments.kind,
                pointer(&guid),
                pointer(&resources),
                if arguments.callbacks { &*callbacks } else { ptr::null() },
                arguments.visible,
                arguments.logging,
            )
        };
        if component.is_null() {
            return Err(messages.take());
        }
        Ok(Slave { dll, component, messages, _callbacks: callbacks })
    }

    pub fn new(dll: &'a Fmi2Dll) -> Slave<'a> {
        Slave::try_new(dll, &Arguments::default()).unwrap_or_else(|messages| panic!("{messages:?}"))
    }

    /// Instantiated, with a mesh and a basis that are quick to prepare.
    pub fn coarse(dll: &'a Fmi2Dll) -> Slave<'a> {
        let slave = Slave::new(dll);
        slave.coarsen();
        slave
    }

    pub fn coarsen(&self) {
        assert_eq!(self.set_integer("mesh.elements_per_half_width", 4), fmi2OK);
        assert_eq!(self.set_integer("mesh.grid_elements_per_half_width", 4), fmi2OK);
    }

    /// Ready for the first step at time 0.
    pub fn ready(dll: &'a Fmi2Dll) -> Slave<'a> {
        let slave = Slave::coarse(dll);
        slave.initialize();
        slave
    }

    pub fn initialize(&self) {
        assert_eq!(self.setup(0.0, None), fmi2OK);
        assert_eq!(self.enter(), fmi2OK);
        assert_eq!(self.exit(), fmi2OK, "{:?}", self.messages.borrow());
    }

    /// Messages since the last call of this method.
    pub fn messages(&self) -> Vec<Message> {
        self.messages.take()
    }

    /// The call was refused with an error whose message contains all the words.
    #[track_caller]
    pub fn refused(&self, status: fmi2Status, words: &[&str]) {
        assert_eq!(status, fmi2Error);
        self.explained(words);
    }

    /// The last message contains all the words.
    #[track_caller]
    pub fn explained(&self, words: &[&str]) {
        let messages = self.messages();
        let last = &messages.last().expect("a message").text;
        for word in words {
            assert!(last.contains(word), "\"{word}\" is missing in \"{last}\"");
        }
    }

    pub fn setup(&self, start: f64, stop: Option<f64>) -> fmi2Status {
        let defined = stop.is_some().into();
        // SAFETY: as for all calls below: a component of this library, arrays of the stated length.
        unsafe { self.dll.fmi2SetupExperiment(self.component, 0, 0.0, start, defined, stop.unwrap_or(0.0)) }
    }
    pub fn enter(&self) -> fmi2Status {
        unsafe { self.dll.fmi2EnterInitializationMode(self.component) }
    }
    pub fn exit(&self) -> fmi2Status {
        unsafe { self.dll.fmi2ExitInitializationMode(self.component) }
    }
    pub fn terminate(&self) -> fmi2Status {
        unsafe { self.dll.fmi2Terminate(self.component) }
    }
    pub fn reset(&self) -> fmi2Status {
        unsafe { self.dll.fmi2Reset(self.component) }
    }
    pub fn step(&self, t: f64, h: f64) -> fmi2Status {
        unsafe { self.dll.fmi2DoStep(self.component, t, h, 1) }
    }

    pub fn get_reals(&self, references: &[u32]) -> Result<Vec<f64>, fmi2Status> {
        let mut values = vec![f64::NAN; references.len()];
        let count = references.len();
        let status = unsafe { self.dll.fmi2GetReal(self.component, references.as_ptr(), count, values.as_mut_ptr()) };
        if status == fmi2OK { Ok(values) } else { Err(status) }
    }
    #[track_caller]
    pub fn real(&self, name: &str) -> f64 {
        self.get_reals(&[variable(name).reference]).unwrap_or_else(|s| panic!("{s:?} {:?}", self.messages()))[0]
    }
    pub fn integer(&self, name: &str) -> i32 {
        self.integer_at(variable(name).reference)
    }
    pub fn integer_at(&self, reference: u32) -> i32 {
        let mut value = i32::MIN;
        assert_eq!(unsafe { self.dll.fmi2GetInteger(self.component, &reference, 1, &mut value) }, fmi2OK);
        value
    }
    pub fn boolean(&self, name: &str) -> bool {
        let (reference, mut value) = (variable(name).reference, -1);
        assert_eq!(unsafe { self.dll.fmi2GetBoolean(self.component, &reference, 1, &mut value) }, fmi2OK);
        value == 1
    }
    pub fn string(&self, name: &str) -> String {
        let (reference, mut value) = (variable(name).reference, ptr::null());
        assert_eq!(unsafe { self.dll.fmi2GetString(self.component, &reference, 1, &mut value) }, fmi2OK);
        unsafe { CStr::from_ptr(value) }.to_str().unwrap().to_owned()
    }
    pub fn set_reals(&self, references: &[u32], values: &[f64]) -> fmi2Status {
        assert_eq!(references.len(), values.len());
        let count = values.len();
        unsafe { self.dll.fmi2SetReal(self.component, references.as_ptr(), count, values.as_ptr()) }
    }
    pub fn set_real(&self, name: &str, value: f64) -> fmi2Status {
        self.set_reals(&[variable(name).reference], &[value])
    }
    pub fn set_integer(&self, name: &str, value: i32) -> fmi2Status {
        self.set_integer_at(variable(name).reference, value)
    }
    pub fn set_integer_at(&self, reference: u32, value: i32) -> fmi2Status {
        unsafe { self.dll.fmi2SetInteger(self.component, &reference, 1, &value) }
    }
    pub fn set_boolean(&self, name: &str, value: bool) -> fmi2Status {
        self.set_boolean_at(variable(name).reference, value)
    }
    pub fn set_boolean_at(&self, reference: u32, value: bool) -> fmi2Status {
        unsafe { self.dll.fmi2SetBoolean(self.component, &reference, 1, &value.into()) }
    }
    /// Any C integer for a boolean variable.
    pub fn set_c_boolean(&self, name: &str, value: c_int) -> fmi2Status {
        unsafe { self.dll.fmi2SetBoolean(self.component, &variable(name).reference, 1, &value) }
    }
    pub fn set_string(&self, name: &str, value: &str) -> fmi2Status {
        self.set_string_at(variable(name).reference, value)
    }
    pub fn set_string_at(&self, reference: u32, value: &str) -> fmi2Status {
        let value = c(value);
        unsafe { self.dll.fmi2SetString(self.component, &reference, 1, &value.as_ptr()) }
    }
    pub fn set_rate(&self, name: &str, order: i32, value: f64) -> fmi2Status {
        let reference = variable(name).reference;
        unsafe { self.dll.fmi2SetRealInputDerivatives(self.component, &reference, 1, &order, &value) }
    }
    pub fn set_logging(&self, on: bool, categories: &[&str]) -> fmi2Status {
        let names: Vec<CString> = categories.iter().map(|name| c(name)).collect();
        let pointers: Vec<fmi2String> = names.iter().map(|name| name.as_ptr()).collect();
        unsafe { self.dll.fmi2SetDebugLogging(self.component, on.into(), pointers.len(), pointers.as_ptr()) }
    }

    /// Saves into the place, which may hold an older state.
    pub fn save(&self, state: &mut fmi2FMUstate) -> fmi2Status {
        unsafe { self.dll.fmi2GetFMUstate(self.component, state) }
    }
    pub fn restore(&self, state: fmi2FMUstate) -> fmi2Status {
        unsafe { self.dll.fmi2SetFMUstate(self.component, state) }
    }
    pub fn free_state(&self, state: &mut fmi2FMUstate) -> fmi2Status {
        unsafe { self.dll.fmi2FreeFMUstate(self.component, state) }
    }
    pub fn serialize(&self, state: fmi2FMUstate) -> Vec<u8> {
        let mut size = 0;
        let status = unsafe { self.dll.fmi2SerializedFMUstateSize(self.component, state, &mut size) };
        assert_eq!(status, fmi2OK);
        let mut bytes = vec![0u8; size];
        let first = bytes.as_mut_ptr().cast();
        assert_eq!(unsafe { self.dll.fmi2SerializeFMUstate(self.component, state, first, size) }, fmi2OK);
        bytes
    }
    pub fn deserialize(&self, bytes: &[u8], state: &mut fmi2FMUstate) -> fmi2Status {
        unsafe { self.dll.fmi2DeSerializeFMUstate(self.component, bytes.as_ptr().cast(), bytes.len(), state) }
    }

    pub fn last_step(&self) -> fmi2Status {
        let mut value = fmi2Fatal;
        let kind = fmi2StatusKind::fmi2DoStepStatus;
        assert_eq!(unsafe { self.dll.fmi2GetStatus(self.component, kind, &mut value) }, fmi2OK);
        value
    }
    pub fn last_successful_time(&self) -> f64 {
        let mut value = f64::NAN;
        let kind = fmi2StatusKind::fmi2LastSuccessfulTime;
        assert_eq!(unsafe { self.dll.fmi2GetRealStatus(self.component, kind, &mut value) }, fmi2OK);
        value
    }
    pub fn terminated(&self) -> bool {
        let mut value = -1;
        let kind = fmi2StatusKind::fmi2Terminated;
        assert_eq!(unsafe { self.dll.fmi2GetBooleanStatus(self.component, kind, &mut value) }, fmi2OK);
        value == 1
    }

    /// Asks each of the five status functions, in the order of the standard, the question `kind`.
    pub fn ask(&self, kind: c_int) -> [fmi2Status; 5] {
        let (dll, c) = (self.dll, self.component);
        // SAFETY: as above; every value has room for the largest answer.
        unsafe {
            let mut status = fmi2Fatal;
            let (mut real, mut integer, mut boolean, mut string) = (0.0, 0, 0, ptr::null());
            [
                plain!(dll.fmi2GetStatus, (fmi2Component, c_int, *mut fmi2Status) -> fmi2Status)(c, kind, &mut status),
                plain!(dll.fmi2GetRealStatus, (fmi2Component, c_int, *mut f64) -> fmi2Status)(c, kind, &mut real),
                plain!(dll.fmi2GetIntegerStatus, (fmi2Component, c_int, *mut c_int) -> fmi2Status)(
                    c,
                    kind,
                    &mut integer,
                ),
                plain!(dll.fmi2GetBooleanStatus, (fmi2Component, c_int, *mut c_int) -> fmi2Status)(
                    c,
                    kind,
                    &mut boolean,
                ),
                plain!(dll.fmi2GetStringStatus, (fmi2Component, c_int, *mut fmi2String) -> fmi2Status)(
                    c,
                    kind,
                    &mut string,
                ),
            ]
        }
    }

    /// All real outputs, bit by bit.
    #[track_caller]
    pub fn outputs(&self) -> Vec<u64> {
        let real = |v: &&Variable| v.causality() == Causality::Output && matches!(v.kind, Kind::Real { .. });
        let references: Vec<u32> = variables().iter().filter(real).map(|v| v.reference).collect();
        let values = self.get_reals(&references).unwrap_or_else(|s| panic!("{s:?} {:?}", self.messages()));
        values.into_iter().map(f64::to_bits).collect()
    }

    /// Ten steps of 1 ms under a braking moment that depends on the step, from step `first`.
    #[track_caller]
    pub fn brake(&self, first: usize) -> Vec<Vec<u64>> {
        let step = |i: usize| {
            assert_eq!(self.set_real("drive.moment", -200.0 * (1 + i % 7) as f64), fmi2OK);
            assert_eq!(self.step(1e-3 * i as f64, 1e-3), fmi2OK, "{:?}", self.messages.borrow());
            self.outputs()
        };
        (first..first + 10).map(step).collect()
    }
}

/// Start value of a real variable in the model description.
pub fn real_start(name: &str) -> f64 {
    match wheelrail::fmi::settings::start_value(variable(name)) {
        Some(Value::Real(value)) => value,
        other => panic!("{name} starts with {other:?}"),
    }
}
