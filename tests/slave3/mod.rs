//! A small master of FMI 3.0: the exported C functions, with names instead of value references.
#![allow(dead_code, unsafe_code)]

use std::cell::{Cell, RefCell};
use std::ffi::{CStr, CString, c_void};
use std::path::Path;
use std::ptr;
use wheelrail::fmi::table::named;
use wheelrail::fmi::v3::c_abi::*;
use wheelrail::fmi::v3::description;
use wheelrail_slave::Status;
use wheelrail_slave::c_abi::v3::types::*;

/// A message: status, category, text.
pub type Heard = (Status, String, String);

/// Answer of a master that is asked for its inputs at a time within a step, with the instance.
pub type Answer = Box<dyn FnMut(&Wheel, f64)>;

/// Environment of a master: the messages it has got, and its answer to questions within steps.
#[derive(Default)]
struct Ear {
    messages: RefCell<Vec<Heard>>,
    answer: RefCell<Option<Answer>>,
    wheel: Cell<*const Wheel>,
}

unsafe extern "C" fn hear(environment: *mut c_void, status: Status, category: fmi3String, text: fmi3String) {
    // SAFETY: the environment is the ear of the wheel; the library passes strings that end with NUL.
    unsafe {
        let [category, text] = [category, text].map(|text| CStr::from_ptr(text).to_str().unwrap().to_owned());
        (*environment.cast::<Ear>()).messages.borrow_mut().push((status, category, text));
    }
}

unsafe extern "C" fn asked(
    environment: *mut c_void,
    time: f64,
    set: u8,
    get: u8,
    finished: u8,
    may_return: u8,
    early: *mut u8,
    at: *mut f64,
) {
    // SAFETY: the environment is the ear of the wheel, which lives while one of its functions is called; places for both answers.
    unsafe {
        assert!([set, get, finished, may_return] == [1, 0, 0, 0] && *early == 0 && *at == time);
        let ear = &*environment.cast::<Ear>();
        let Some(mut answer) = ear.answer.take() else { return };
        if let Some(wheel) = ear.wheel.get().as_ref() {
            answer(wheel, time);
        }
        ear.answer.replace(Some(answer));
    }
}

/// Arguments of `fmi3InstantiateCoSimulation`.
pub struct Arguments {
    pub name: Option<&'static str>,
    pub token: Option<String>,
    pub resources: Option<String>,
    pub visible: u8,
    pub logging: u8,
    pub event_mode: u8,
    pub early_return: u8,
    pub intermediate: Vec<u32>,
    /// True if the master has a function that is asked for inputs within a step.
    pub answers: bool,
}

impl Default for Arguments {
    fn default() -> Self {
        let resources = Some(format!("{}/", Path::new(env!("CARGO_MANIFEST_DIR")).join("resources").display()));
        Arguments {
            name: Some("wheel"),
            token: Some(description::token()),
            resources,
            visible: 0,
            logging: 0,
            event_mode: 0,
            early_return: 0,
            intermediate: Vec::new(),
            answers: false,
        }
    }
}

/// Value reference of a row of the table.
pub fn reference(name: &str) -> u32 {
    named(name).unwrap_or_else(|| panic!("no variable {name}")).reference
}

fn c(text: &str) -> CString {
    CString::new(text).unwrap()
}

/// News of a step: event, end of the simulation, early return, time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Told {
    pub event: u8,
    pub terminate: u8,
    pub early: u8,
    pub time: f64,
}

/// One instance.
pub struct Wheel {
    pub instance: fmi3Instance,
    ear: Box<Ear>,
}

impl Drop for Wheel {
    fn drop(&mut self) {
        // SAFETY: an instance of this library, freed once.
        unsafe { fmi3FreeInstance(self.instance) }
    }
}

// SAFETY of all calls below: an instance of this library and arrays of the stated length.
impl Wheel {
    /// The instance, or the messages of a refused instantiation.
    pub fn try_new(arguments: &Arguments) -> Result<Wheel, Vec<Heard>> {
        let ear: Box<Ear> = Box::default();
        let texts = [arguments.name.map(c), arguments.token.as_deref().map(c), arguments.resources.as_deref().map(c)];
        let [name, token, resources] =
            texts.each_ref().map(|text| text.as_ref().map_or(ptr::null(), |text| text.as_ptr()));
        let instance = unsafe {
            fmi3InstantiateCoSimulation(
                name,
                token,
                resources,
                arguments.visible,
                arguments.logging,
                arguments.event_mode,
                arguments.early_return,
                arguments.intermediate.as_ptr(),
                arguments.intermediate.len(),
                ptr::from_ref(&*ear).cast_mut().cast(),
                Some(hear),
                arguments.answers.then_some(asked),
            )
        };
        if instance.is_null() { Err(ear.messages.take()) } else { Ok(Wheel { instance, ear }) }
    }

    /// Instantiated, with a mesh and a basis that are quick to prepare.
    pub fn coarse() -> Wheel {
        Wheel::coarse_with(&Arguments::default())
    }

    /// Instantiated with such a mesh and basis, and with arguments.
    pub fn coarse_with(arguments: &Arguments) -> Wheel {
        let wheel = Wheel::try_new(arguments).unwrap_or_else(|heard| panic!("{heard:?}"));
        for (name, value) in [("mesh.elements_per_half_width", 4), ("mesh.grid_elements_per_half_width", 4)] {
            assert_eq!(wheel.set_int32(name, value), Status::Ok);
        }
        wheel
    }

    /// Ready for the first step at time 0.
    pub fn ready() -> Wheel {
        let wheel = Wheel::coarse();
        wheel.initialize();
        wheel
    }

    /// A step with answers to the questions within it.
    pub fn answering(&self, t: f64, h: f64, answer: Answer) -> (Status, Told) {
        self.ear.answer.replace(Some(answer));
        self.ear.wheel.set(self);
        let told = self.told(t, h);
        self.ear.wheel.set(ptr::null());
        self.ear.answer.take();
        told
    }

    #[track_caller]
    pub fn initialize(&self) {
        assert_eq!(self.enter(0.0, None), Status::Ok);
        assert_eq!(self.exit(), Status::Ok, "{:?}", self.ear.messages.borrow());
    }

    /// Messages since the last call of this method.
    pub fn heard(&self) -> Vec<Heard> {
        self.ear.messages.take()
    }

    /// The call was refused with an error whose message contains all the words.
    #[track_caller]
    pub fn refused(&self, status: Status, words: &[&str]) {
        assert_eq!(status, Status::Error);
        let heard = self.heard();
        let text = &heard.last().expect("a message").2;
        words.iter().for_each(|word| assert!(text.contains(word), "\"{word}\" is missing in \"{text}\""));
    }

    pub fn enter(&self, start: f64, stop: Option<f64>) -> Status {
        let defined = stop.is_some().into();
        unsafe { fmi3EnterInitializationMode(self.instance, 0, 0.0, start, defined, stop.unwrap_or(0.0)) }
    }
    pub fn exit(&self) -> Status {
        unsafe { fmi3ExitInitializationMode(self.instance) }
    }
    pub fn terminate(&self) -> Status {
        unsafe { fmi3Terminate(self.instance) }
    }
    pub fn reset(&self) -> Status {
        unsafe { fmi3Reset(self.instance) }
    }
    pub fn step(&self, t: f64, h: f64) -> Status {
        self.told(t, h).0
    }
    pub fn told(&self, t: f64, h: f64) -> (Status, Told) {
        let mut told = Told { event: 7, terminate: 7, early: 7, time: f64::NAN };
        let Told { event, terminate, early, time } = &mut told;
        let status = unsafe { fmi3DoStep(self.instance, t, h, 1, event, terminate, early, time) };
        (status, told)
    }

    pub fn get(&self, references: &[u32], size: usize) -> Result<Vec<f64>, Status> {
        let mut values = vec![f64::NAN; size];
        let (first, count) = (references.as_ptr(), references.len());
        match unsafe { fmi3GetFloat64(self.instance, first, count, values.as_mut_ptr(), size) } {
            Status::Ok => Ok(values),
            status => Err(status),
        }
    }
    #[track_caller]
    pub fn float64(&self, name: &str) -> f64 {
        self.get(&[reference(name)], 1).unwrap_or_else(|_| panic!("{:?}", self.heard()))[0]
    }
    #[track_caller]
    pub fn array(&self, name: &str) -> Vec<f64> {
        let size = named(name).unwrap().dimension.unwrap();
        self.get(&[reference(name)], size).unwrap_or_else(|_| panic!("{:?}", self.heard()))
    }
    pub fn set(&self, name: &str, value: f64) -> Status {
        unsafe { fmi3SetFloat64(self.instance, &reference(name), 1, &value, 1) }
    }
    pub fn set_int32(&self, name: &str, value: i32) -> Status {
        unsafe { fmi3SetInt32(self.instance, &reference(name), 1, &value, 1) }
    }
    pub fn int32(&self, name: &str) -> i32 {
        let mut value = -1;
        assert_eq!(unsafe { fmi3GetInt32(self.instance, &reference(name), 1, &mut value, 1) }, Status::Ok);
        value
    }
    pub fn set_item(&self, name: &str, value: i64) -> Status {
        unsafe { fmi3SetInt64(self.instance, &reference(name), 1, &value, 1) }
    }
    pub fn item(&self, name: &str) -> i64 {
        let mut value = -1;
        assert_eq!(unsafe { fmi3GetInt64(self.instance, &reference(name), 1, &mut value, 1) }, Status::Ok);
        value
    }
    pub fn set_boolean(&self, name: &str, value: u8) -> Status {
        unsafe { fmi3SetBoolean(self.instance, &reference(name), 1, &value, 1) }
    }
    pub fn boolean(&self, name: &str) -> u8 {
        let mut value = 7;
        assert_eq!(unsafe { fmi3GetBoolean(self.instance, &reference(name), 1, &mut value, 1) }, Status::Ok);
        value
    }
    pub fn set_string(&self, name: &str, value: &str) -> Status {
        let value = c(value);
        unsafe { fmi3SetString(self.instance, &reference(name), 1, &value.as_ptr(), 1) }
    }
    pub fn string(&self, name: &str) -> String {
        let mut value = ptr::null();
        assert_eq!(unsafe { fmi3GetString(self.instance, &reference(name), 1, &mut value, 1) }, Status::Ok);
        unsafe { CStr::from_ptr(value) }.to_str().unwrap().to_owned()
    }
    pub fn set_logging(&self, on: bool, categories: &[&str]) -> Status {
        let names: Vec<CString> = categories.iter().map(|name| c(name)).collect();
        let pointers: Vec<fmi3String> = names.iter().map(|name| name.as_ptr()).collect();
        unsafe { fmi3SetDebugLogging(self.instance, on.into(), pointers.len(), pointers.as_ptr()) }
    }

    pub fn save(&self, state: &mut fmi3FMUState) -> Status {
        unsafe { fmi3GetFMUState(self.instance, state) }
    }
    pub fn restore(&self, state: fmi3FMUState) -> Status {
        unsafe { fmi3SetFMUState(self.instance, state) }
    }
    pub fn forget(&self, state: &mut fmi3FMUState) -> Status {
        unsafe { fmi3FreeFMUState(self.instance, state) }
    }
    pub fn serialize(&self, state: fmi3FMUState) -> Vec<u8> {
        let mut size = 0;
        assert_eq!(unsafe { fmi3SerializedFMUStateSize(self.instance, state, &mut size) }, Status::Ok);
        let mut bytes = vec![0; size];
        let status = unsafe { fmi3SerializeFMUState(self.instance, state, bytes.as_mut_ptr(), size) };
        assert_eq!(status, Status::Ok);
        bytes
    }
    pub fn deserialize(&self, bytes: &[u8], state: &mut fmi3FMUState) -> Status {
        unsafe { fmi3DeserializeFMUState(self.instance, bytes.as_ptr(), bytes.len(), state) }
    }

    pub fn directional(&self, unknowns: &[u32], knowns: &[u32], seed: &[f64], size: usize) -> Result<Vec<f64>, Status> {
        let mut found = vec![f64::NAN; size];
        let status = unsafe {
            fmi3GetDirectionalDerivative(
                self.instance,
                unknowns.as_ptr(),
                unknowns.len(),
                knowns.as_ptr(),
                knowns.len(),
                seed.as_ptr(),
                seed.len(),
                found.as_mut_ptr(),
                size,
            )
        };
        if status == Status::Ok { Ok(found) } else { Err(status) }
    }
    pub fn adjoint(&self, unknowns: &[u32], knowns: &[u32], seed: &[f64]) -> Result<Vec<f64>, Status> {
        let mut found = vec![f64::NAN; knowns.len()];
        let status = unsafe {
            fmi3GetAdjointDerivative(
                self.instance,
                unknowns.as_ptr(),
                unknowns.len(),
                knowns.as_ptr(),
                knowns.len(),
                seed.as_ptr(),
                seed.len(),
                found.as_mut_ptr(),
                found.len(),
            )
        };
        if status == Status::Ok { Ok(found) } else { Err(status) }
    }
    pub fn output_rates(&self, references: &[u32], orders: &[i32], size: usize) -> Result<Vec<f64>, Status> {
        let mut found = vec![f64::NAN; size];
        let (first, count, orders) = (references.as_ptr(), references.len(), orders.as_ptr());
        let status = unsafe { fmi3GetOutputDerivatives(self.instance, first, count, orders, found.as_mut_ptr(), size) };
        if status == Status::Ok { Ok(found) } else { Err(status) }
    }
}
