//! Types of the exported functions against those of the header of the standard, as bindings made from it declare them.
#![allow(unsafe_code, non_snake_case)]

mod exported {
    pub mod model {
        use std::cell::Cell;
        use std::path::PathBuf;
        use wheelrail_slave::{Life, Outcome, Reference, Scalar, ScalarAccess, Slave, Type};

        /// A slave with one real variable, of which the last value that was set comes back.
        pub struct Echo(f64);

        thread_local! {
            /// Number of slaves that this thread has freed.
            pub static FREED: Cell<usize> = const { Cell::new(0) };
        }

        impl Drop for Echo {
            fn drop(&mut self) {
                FREED.set(FREED.get() + 1);
            }
        }

        impl Slave for Echo {
            type State = f64;
            const LONGEST_STEP: f64 = 1.0;

            fn new(_: Option<PathBuf>) -> Outcome<Self> {
                Ok(Echo(0.0))
            }
            fn initialize(&mut self, _: &Life) -> Outcome<String> {
                Ok("ready".to_owned())
            }
            fn reset(&mut self) -> Outcome {
                self.0 = 0.0;
                Ok(())
            }
            fn step(&mut self, _: f64, _: f64, _: &Life) -> Outcome {
                if self.0 < 0.0 { panic!("wheel {} lost", 7) } else { Ok(()) }
            }
            fn save(&self) -> f64 {
                self.0
            }
            fn restore(&mut self, state: &f64, _: &Life) -> Outcome {
                self.0 = *state;
                Ok(())
            }
        }

        impl ScalarAccess for Echo {
            type Value = Scalar;

            fn guid() -> String {
                "echo".to_owned()
            }
            fn name_of(_: Reference) -> Option<String> {
                None
            }
            fn get(&mut self, references: &[Reference], _: Type, _: &Life) -> Outcome<Vec<Scalar>> {
                Ok(references.iter().map(|_| Scalar::Real(self.0)).collect())
            }
            fn set(&mut self, _: &[Reference], values: Vec<Scalar>, _: &Life) -> Outcome {
                for value in values {
                    if let Scalar::Real(value) = value {
                        self.0 = value;
                    }
                }
                Ok(())
            }
        }
    }

    wheelrail_slave::export_fmi2!(model::Echo);
}

use exported::*;
use std::cell::RefCell;
use std::ffi::{CStr, c_int};
use std::mem::{offset_of, transmute};
use std::ptr;
use wheelrail_slave::Status;
use wheelrail_slave::c_abi::v2::types::{self as ours, CallbackFunctions, Question, fmi2Component, fmi2String};

/// The type that the header gives an argument: another than ours only for enumerations and for structs with them.
macro_rules! declared {
    ($ours:ty) => {
        $ours
    };
    ($ours:ty as $theirs:ty) => {
        $theirs
    };
}

/// Compares functions with their types in the header. An argument `A as B` is `B` there; both have one size and
/// alignment.
macro_rules! compare {
    ($($name:ident: $type:ident = ($($ours:ty $(as $theirs:ty)?),*) -> $result:ty $(as $their_result:ty)?;)*) => {$(
        // SAFETY: never called; the arguments that differ are passed alike, as the assertions below say.
        #[allow(clippy::useless_transmute)]
        const _: libfmi::$type = Some(unsafe {
            transmute::<
                unsafe extern "C" fn($($ours),*) -> $result,
                unsafe extern "C" fn($(declared!($ours $(as $theirs)?)),*) -> declared!($result $(as $their_result)?),
            >($name)
        });
        $($( const _: () = assert!(size_of::<$ours>() == size_of::<$theirs>() && align_of::<$ours>() == align_of::<$theirs>()); )?)*
    )*};
}

compare! {
    fmi2SetDebugLogging: fmi2SetDebugLoggingTYPE = (
        fmi2Component, ours::fmi2Boolean, usize, *const ours::fmi2String
    ) -> Status as libfmi::fmi2Status;
    fmi2SetupExperiment: fmi2SetupExperimentTYPE = (
        fmi2Component, ours::fmi2Boolean, ours::fmi2Real, ours::fmi2Real, ours::fmi2Boolean, ours::fmi2Real
    ) -> Status as libfmi::fmi2Status;
    fmi2EnterInitializationMode: fmi2EnterInitializationModeTYPE = (fmi2Component) -> Status as libfmi::fmi2Status;
    fmi2ExitInitializationMode: fmi2ExitInitializationModeTYPE = (fmi2Component) -> Status as libfmi::fmi2Status;
    fmi2Terminate: fmi2TerminateTYPE = (fmi2Component) -> Status as libfmi::fmi2Status;
    fmi2Reset: fmi2ResetTYPE = (fmi2Component) -> Status as libfmi::fmi2Status;
    fmi2GetReal: fmi2GetRealTYPE = (
        fmi2Component, *const ours::fmi2ValueReference, usize, *mut ours::fmi2Real
    ) -> Status as libfmi::fmi2Status;
    fmi2GetInteger: fmi2GetIntegerTYPE = (
        fmi2Component, *const ours::fmi2ValueReference, usize, *mut ours::fmi2Integer
    ) -> Status as libfmi::fmi2Status;
    fmi2GetBoolean: fmi2GetBooleanTYPE = (
        fmi2Component, *const ours::fmi2ValueReference, usize, *mut ours::fmi2Boolean
    ) -> Status as libfmi::fmi2Status;
    fmi2GetString: fmi2GetStringTYPE = (
        fmi2Component, *const ours::fmi2ValueReference, usize, *mut ours::fmi2String
    ) -> Status as libfmi::fmi2Status;
    fmi2SetReal: fmi2SetRealTYPE = (
        fmi2Component, *const ours::fmi2ValueReference, usize, *const ours::fmi2Real
    ) -> Status as libfmi::fmi2Status;
    fmi2SetInteger: fmi2SetIntegerTYPE = (
        fmi2Component, *const ours::fmi2ValueReference, usize, *const ours::fmi2Integer
    ) -> Status as libfmi::fmi2Status;
    fmi2SetBoolean: fmi2SetBooleanTYPE = (
        fmi2Component, *const ours::fmi2ValueReference, usize, *const ours::fmi2Boolean
    ) -> Status as libfmi::fmi2Status;
    fmi2SetString: fmi2SetStringTYPE = (
        fmi2Component, *const ours::fmi2ValueReference, usize, *const ours::fmi2String
    ) -> Status as libfmi::fmi2Status;
    fmi2GetFMUstate: fmi2GetFMUstateTYPE = (fmi2Component, *mut ours::fmi2FMUstate) -> Status as libfmi::fmi2Status;
    fmi2SetFMUstate: fmi2SetFMUstateTYPE = (fmi2Component, ours::fmi2FMUstate) -> Status as libfmi::fmi2Status;
    fmi2FreeFMUstate: fmi2FreeFMUstateTYPE = (fmi2Component, *mut ours::fmi2FMUstate) -> Status as libfmi::fmi2Status;
    fmi2SerializedFMUstateSize: fmi2SerializedFMUstateSizeTYPE = (
        fmi2Component, ours::fmi2FMUstate, *mut usize
    ) -> Status as libfmi::fmi2Status;
    fmi2SerializeFMUstate: fmi2SerializeFMUstateTYPE = (
        fmi2Component, ours::fmi2FMUstate, *mut ours::fmi2Byte, usize
    ) -> Status as libfmi::fmi2Status;
    fmi2DeSerializeFMUstate: fmi2DeSerializeFMUstateTYPE = (
        fmi2Component, *const ours::fmi2Byte, usize, *mut ours::fmi2FMUstate
    ) -> Status as libfmi::fmi2Status;
    fmi2GetDirectionalDerivative: fmi2GetDirectionalDerivativeTYPE = (
        fmi2Component, *const ours::fmi2ValueReference, usize, *const ours::fmi2ValueReference, usize, *const
        ours::fmi2Real, *mut ours::fmi2Real
    ) -> Status as libfmi::fmi2Status;
    fmi2SetRealInputDerivatives: fmi2SetRealInputDerivativesTYPE = (
        fmi2Component, *const ours::fmi2ValueReference, usize, *const ours::fmi2Integer, *const ours::fmi2Real
    ) -> Status as libfmi::fmi2Status;
    fmi2GetRealOutputDerivatives: fmi2GetRealOutputDerivativesTYPE = (
        fmi2Component, *const ours::fmi2ValueReference, usize, *const ours::fmi2Integer, *mut ours::fmi2Real
    ) -> Status as libfmi::fmi2Status;
    fmi2DoStep: fmi2DoStepTYPE = (
        fmi2Component, ours::fmi2Real, ours::fmi2Real, ours::fmi2Boolean
    ) -> Status as libfmi::fmi2Status;
    fmi2CancelStep: fmi2CancelStepTYPE = (fmi2Component) -> Status as libfmi::fmi2Status;
    fmi2GetStatus: fmi2GetStatusTYPE = (
        fmi2Component, c_int as libfmi::fmi2StatusKind, *mut Status as *mut libfmi::fmi2Status
    ) -> Status as libfmi::fmi2Status;
    fmi2GetRealStatus: fmi2GetRealStatusTYPE = (
        fmi2Component, c_int as libfmi::fmi2StatusKind, *mut ours::fmi2Real
    ) -> Status as libfmi::fmi2Status;
    fmi2GetBooleanStatus: fmi2GetBooleanStatusTYPE = (
        fmi2Component, c_int as libfmi::fmi2StatusKind, *mut ours::fmi2Boolean
    ) -> Status as libfmi::fmi2Status;
    fmi2GetIntegerStatus: fmi2GetIntegerStatusTYPE = (
        fmi2Component, c_int as libfmi::fmi2StatusKind, *mut ours::fmi2Integer
    ) -> Status as libfmi::fmi2Status;
    fmi2GetStringStatus: fmi2GetStringStatusTYPE = (
        fmi2Component, c_int as libfmi::fmi2StatusKind, *mut ours::fmi2String
    ) -> Status as libfmi::fmi2Status;
    fmi2Instantiate: fmi2InstantiateTYPE = (
        fmi2String, c_int as libfmi::fmi2Type, fmi2String, fmi2String,
        *const CallbackFunctions as *const libfmi::fmi2CallbackFunctions, ours::fmi2Boolean, ours::fmi2Boolean
    ) -> fmi2Component;
}

const _: libfmi::fmi2GetTypesPlatformTYPE = Some(fmi2GetTypesPlatform);
const _: libfmi::fmi2GetVersionTYPE = Some(fmi2GetVersion);
const _: libfmi::fmi2FreeInstanceTYPE = Some(fmi2FreeInstance);

#[test]
fn enumerations_have_the_numbers_of_the_header() {
    use libfmi::fmi2Status::*;
    use libfmi::fmi2StatusKind::*;
    let statuses = [Status::Ok, Status::Warning, Status::Discard, Status::Error, Status::Fatal].map(|s| s as u32);
    assert_eq!(statuses, [fmi2OK, fmi2Warning, fmi2Discard, fmi2Error, fmi2Fatal].map(|s| s as u32));
    let questions = [fmi2DoStepStatus, fmi2PendingStatus, fmi2LastSuccessfulTime, fmi2Terminated];
    assert_eq!(Question::ALL.map(|q| q as u32), questions.map(|q| q as u32));
    assert_eq!(Question::ALL.map(Question::name), questions.map(|q| format!("{q:?}")).each_ref().map(|q| q.as_str()));
    assert_eq!(ours::CO_SIMULATION as u32, libfmi::fmi2Type::fmi2CoSimulation as u32);
    assert_eq!(
        (size_of::<Status>(), align_of::<Status>()),
        (size_of::<libfmi::fmi2Status>(), align_of::<libfmi::fmi2Status>())
    );
}

#[test]
fn functions_of_the_master_stand_where_the_header_has_them() {
    use libfmi::fmi2CallbackFunctions as Theirs;
    let ours = [
        offset_of!(CallbackFunctions, logger),
        offset_of!(CallbackFunctions, allocate_memory),
        offset_of!(CallbackFunctions, free_memory),
        offset_of!(CallbackFunctions, step_finished),
        offset_of!(CallbackFunctions, environment),
    ];
    let theirs = [
        offset_of!(Theirs, logger),
        offset_of!(Theirs, allocateMemory),
        offset_of!(Theirs, freeMemory),
        offset_of!(Theirs, stepFinished),
        offset_of!(Theirs, componentEnvironment),
    ];
    assert_eq!((ours, size_of::<CallbackFunctions>()), (theirs, size_of::<Theirs>()));
}

type Heard = RefCell<Vec<(Status, String)>>;

/// A logger that reads no variable argument, as those of many masters.
unsafe extern "C" fn record(
    environment: ours::fmi2ComponentEnvironment,
    _: fmi2String,
    status: Status,
    _: fmi2String,
    format: fmi2String,
) {
    // SAFETY: the environment is the list of the test; the library passes strings that end with NUL.
    unsafe {
        let text = CStr::from_ptr(format).to_str().unwrap().to_owned();
        (*environment.cast::<Heard>()).borrow_mut().push((status, text));
    }
}

/// An instance whose messages arrive in `heard`.
unsafe fn instantiate(heard: &Heard) -> fmi2Component {
    type Plain = unsafe extern "C" fn(ours::fmi2ComponentEnvironment, fmi2String, Status, fmi2String, fmi2String);
    let functions = CallbackFunctions {
        // SAFETY: callers clean up after variadic functions, so that no argument is missed.
        logger: Some(unsafe { transmute::<Plain, ours::Logger>(record) }),
        allocate_memory: None,
        free_memory: None,
        step_finished: None,
        environment: ptr::from_ref(heard).cast_mut().cast(),
    };
    let (name, guid) = (c"echo".as_ptr(), c"echo".as_ptr());
    // SAFETY: strings that end with NUL, and functions of this test.
    unsafe { fmi2Instantiate(name, ours::CO_SIMULATION, guid, ptr::null(), &functions, 0, 0) }
}

#[test]
fn a_run_goes_from_instantiation_to_its_end_and_every_illegal_call_is_refused() {
    let heard = Heard::default();
    // SAFETY: a component as `fmi2Instantiate` makes it, freed once; arrays of one element.
    unsafe {
        let c = instantiate(&heard);
        let (reference, mut value) = (1, 0.0);
        assert_eq!(fmi2DoStep(c, 0.0, 0.1, 1), Status::Error);
        assert_eq!(fmi2SetReal(c, &reference, 1, &3.5), Status::Ok);
        assert_eq!(fmi2SetupExperiment(c, 0, 0.0, 1.0, 1, 2.0), Status::Ok);
        assert_eq!(fmi2EnterInitializationMode(c), Status::Ok);
        assert_eq!(fmi2ExitInitializationMode(c), Status::Ok);
        let mut state = ptr::null_mut();
        assert_eq!(fmi2GetFMUstate(c, &mut state), Status::Ok);
        for (start, h) in [(0.0, 0.1), (1.0, 1.1), (1.0, 0.0), (1.9, 0.2)] {
            assert_eq!(fmi2DoStep(c, start, h, 1), Status::Error, "{start} {h}");
        }
        assert_eq!(fmi2DoStep(c, 1.0, 1.0, 1), Status::Ok);
        assert_eq!(fmi2DoStep(c, 2.0, 1.0, 1), Status::Error);
        assert_eq!(fmi2SetReal(c, &reference, 1, &4.5), Status::Ok);
        assert_eq!(fmi2SetFMUstate(c, state), Status::Ok);
        assert_eq!(fmi2GetReal(c, &reference, 1, &mut value), Status::Ok);
        assert_eq!(value, 3.5);
        assert_eq!(fmi2GetRealStatus(c, Question::LastSuccessfulTime as c_int, &mut value), Status::Ok);
        assert_eq!(value, 1.0);
        assert_eq!(fmi2Terminate(c), Status::Ok);
        assert_eq!(fmi2DoStep(c, 1.0, 0.1, 1), Status::Error);
        fmi2FreeInstance(c);
        // Freed, and never followed.
        assert_eq!(fmi2Reset(c), Status::Error);
        fmi2FreeInstance(c);
    }
    let heard = heard.take();
    assert!(heard.iter().all(|(status, _)| *status == Status::Error));
    let outside = "communicationStepSize = 1.1 s is outside its range: more than 0, at most 1 s";
    assert!(heard.iter().any(|(_, text)| text.contains(outside)), "{heard:?}");
}

#[test]
fn a_panic_becomes_fatal_and_leaves_only_freeing() {
    let heard = Heard::default();
    // SAFETY: a component as `fmi2Instantiate` makes it, freed once; arrays of one element.
    unsafe {
        let c = instantiate(&heard);
        assert_eq!(fmi2EnterInitializationMode(c), Status::Ok);
        assert_eq!(fmi2ExitInitializationMode(c), Status::Ok);
        let (reference, mut state) = (1, ptr::null_mut());
        assert_eq!(fmi2SetReal(c, &reference, 1, &-1.0), Status::Ok);
        assert_eq!(fmi2DoStep(c, 0.0, 0.1, 1), Status::Fatal);
        assert_eq!(heard.take(), [(Status::Fatal, "fmi2DoStep: internal error: wheel 7 lost".to_owned())]);
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
            assert_eq!(status, Status::Fatal);
        }
        assert!(heard.take().iter().all(|(_, message)| message.contains("Fatal")));
        fmi2FreeInstance(c);
    }
    assert_eq!(model::FREED.get(), 1);
}
