//! Masters with little stack, and with a floating-point environment of their own.
#![cfg(all(target_os = "linux", target_env = "gnu", target_arch = "x86_64"))]
#![allow(unsafe_code)]

use crate::slave;
use crate::slave::*;
use crate::slave3;
use std::collections::BTreeMap;
use std::ffi::{c_int, c_void};
use std::mem::ManuallyDrop;
use std::path::Path;
use std::ptr;
use std::sync::atomic::{AtomicI32, Ordering};
use wheelrail::fmi::v2::variables::variables;
use wheelrail_slave::Status;

/// Largest stack of any call [bytes]: a quarter of what the smallest usual thread has.
const LIMIT: usize = 64 << 10;
/// Depth to which the stack is painted [bytes], and distance from the painter's own frame.
const DEPTH: usize = 1 << 20;
const GAP: usize = 2 << 10;
const PAINT: u8 = 0xa5;

/// Stack that a call uses [bytes], on a thread whose stack is some megabytes larger.
#[inline(never)]
fn stack_of(call: &mut dyn FnMut()) -> usize {
    let here = 0_u8;
    let top = (&raw const here).expose_provenance();
    let lowest = ptr::with_exposed_provenance_mut::<u8>(top - DEPTH);
    // SAFETY: below its own frame the stack of a thread belongs to nobody; no signal handler runs here.
    unsafe { lowest.write_bytes(PAINT, DEPTH - GAP) };
    call();
    // SAFETY: as above.
    let untouched = (0..DEPTH - GAP).take_while(|&i| unsafe { lowest.add(i).read_volatile() } == PAINT).count();
    DEPTH - untouched
}

/// The deepest call of every function, with what it was about.
#[derive(Default)]
struct Depths(BTreeMap<&'static str, (usize, String)>);

impl Depths {
    fn of<R>(&mut self, function: &'static str, what: &str, call: impl FnOnce() -> R) -> R {
        let (mut call, mut result) = (Some(call), None);
        let depth = stack_of(&mut || result = call.take().map(|call| call()));
        let deepest = self.0.entry(function).or_default();
        if depth > deepest.0 {
            *deepest = (depth, what.to_owned());
        }
        result.unwrap()
    }
}

/// Everything that a master may do with one wheel.
fn measure(depths: &mut Depths, dll: &libfmi::Fmi2Dll, what: &str, settings: &dyn Fn(&Slave), steps: [f64; 2]) {
    let arguments = Arguments { logging: 1, ..Default::default() };
    let slave = depths.of("fmi2Instantiate", what, || Slave::try_new(dll, &arguments)).ok().unwrap();
    depths.of("fmi2SetString", what, || settings(&slave));
    depths.of("fmi2SetupExperiment", what, || slave.setup(0.0, None));
    depths.of("fmi2EnterInitializationMode", what, || slave.enter());
    depths.of("fmi2GetReal", what, || slave.outputs());
    assert_eq!(
        depths.of("fmi2ExitInitializationMode", what, || slave.exit()),
        fmi2OK,
        "{what}: {:?}",
        slave.messages()
    );
    let (mut state, mut other) = (ptr::null_mut(), ptr::null_mut());
    let [h, count] = steps;
    for k in 0..count as usize {
        if k == count as usize / 2 {
            depths.of("fmi2GetFMUstate", what, || slave.save(&mut state));
        }
        depths.of("fmi2SetReal", what, || slave.set_real("drive.moment", -200.0 * k as f64));
        assert_eq!(depths.of("fmi2DoStep", what, || slave.step(h * k as f64, h)), fmi2OK, "{what}, step {k}");
        depths.of("fmi2GetReal", what, || slave.outputs());
    }
    let bytes = depths.of("fmi2SerializeFMUstate", what, || slave.serialize(state));
    assert_eq!(depths.of("fmi2DeSerializeFMUstate", what, || slave.deserialize(&bytes, &mut other)), fmi2OK);
    depths.of("fmi2DeSerializeFMUstate", what, || slave.deserialize(&bytes[..100], &mut other));
    assert_eq!(depths.of("fmi2SetFMUstate", what, || slave.restore(other)), fmi2OK);
    let ([unknown, known], mut result) = (["contact.force_x", "drive.load"].map(|name| variable(name).reference), 0.0);
    depths.of("fmi2GetDirectionalDerivative", what, || unsafe {
        dll.fmi2GetDirectionalDerivative(slave.component, &unknown, 1, &known, 1, &1.0, &mut result)
    });
    depths.of("fmi2GetRealOutputDerivatives", what, || unsafe {
        dll.fmi2GetRealOutputDerivatives(slave.component, &unknown, 1, &1, &mut result)
    });
    depths.of("fmi2FreeFMUstate", what, || slave.free_state(&mut state));
    // Refusals.
    depths.of("fmi2DoStep", "a wrong time", || slave.step(-1.0, h));
    depths.of("fmi2SetReal", "a wrong value", || slave.set_real("drive.load", f64::NAN));
    depths.of("fmi2SetString", "a late parameter", || slave.set_string("rail.profile", "x.csv"));
    depths.of("fmi2SetDebugLogging", "a wrong category", || slave.set_logging(true, &["nonsense"]));
    depths.of("fmi2GetStatus", what, || slave.ask(0));
    depths.of("fmi2Terminate", what, || slave.terminate());
    depths.of("fmi2Reset", what, || slave.reset());
    depths.of("fmi2FreeInstance", what, || drop(slave));
}

/// Everything that a master of FMI 3.0 may do with one wheel.
fn measure3(depths: &mut Depths, preset: &str) {
    let intermediate = vec![slave3::reference("drive.moment")];
    let arguments = slave3::Arguments { logging: 1, answers: true, intermediate, ..Default::default() };
    let made = depths.of("fmi3InstantiateCoSimulation", preset, || slave3::Wheel::try_new(&arguments));
    let wheel = made.unwrap_or_else(|heard| panic!("{heard:?}"));
    depths.of("fmi3SetString", preset, || assert_eq!(wheel.set_string("preset", preset), Status::Ok));
    depths.of("fmi3EnterInitializationMode", preset, || wheel.enter(0.0, None));
    depths.of("fmi3ExitInitializationMode", preset, || assert_eq!(wheel.exit(), Status::Ok));
    let (mut state, mut other) = (ptr::null_mut(), ptr::null_mut());
    for k in 0..4 {
        depths.of("fmi3SetFloat64", preset, || wheel.set("drive.moment", -200.0 * f64::from(k)));
        depths.of("fmi3DoStep", preset, || assert_eq!(wheel.step(1e-3 * f64::from(k), 1e-3), Status::Ok));
        depths.of("fmi3GetFloat64", preset, || wheel.array("profile.temperature_wheel_below"));
    }
    // Four lines within the step.
    let bent = |wheel: &slave3::Wheel, time: f64| {
        wheel.set("drive.moment", if (4.4e-3..4.6e-3).contains(&time) { -1000.0 } else { -600.0 });
    };
    let (status, _) = depths.of("fmi3DoStep", preset, || wheel.answering(4e-3, 1e-3, Box::new(bent)));
    assert_eq!(status, Status::Ok, "{:?}", wheel.heard());
    depths.of("fmi3GetFMUState", preset, || wheel.save(&mut state));
    let bytes = depths.of("fmi3SerializeFMUState", preset, || wheel.serialize(state));
    depths.of("fmi3DeserializeFMUState", preset, || assert_eq!(wheel.deserialize(&bytes, &mut other), Status::Ok));
    depths.of("fmi3SetFMUState", preset, || wheel.restore(other));
    let [unknown, known] = ["contact.force_x", "drive.load"].map(slave3::reference);
    depths.of("fmi3GetAdjointDerivative", preset, || wheel.adjoint(&[unknown], &[known], &[1.0]).unwrap());
    depths.of("fmi3GetOutputDerivatives", preset, || wheel.output_rates(&[unknown], &[1], 1).unwrap());
    depths.of("fmi3DoStep", "a wrong time", || wheel.step(-1.0, 1e-3));
    depths.of("fmi3Terminate", preset, || wheel.terminate());
    depths.of("fmi3Reset", preset, || wheel.reset());
    depths.of("fmi3FreeInstance", preset, || drop(wheel));
}

/// Items of choices by name, files and all that is set before the start.
fn text_of(name: &str) -> String {
    std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("resources").join(name)).unwrap()
}

fn all_calls() -> Depths {
    let (dll, mut depths) = (load(), Depths::default());
    let wrong = Arguments { guid: Some("{8c4e810f}"), ..Default::default() };
    assert!(depths.of("fmi2Instantiate", "a wrong GUID, first of all", || Slave::try_new(&dll, &wrong)).is_err());
    let presets = wheelrail::fmi::presets::available(Some(&Path::new(env!("CARGO_MANIFEST_DIR")).join("resources")));
    assert!(presets.len() >= 12);
    for preset in &presets {
        let settings = |slave: &Slave| {
            assert_eq!(slave.set_string("preset", preset), fmi2OK);
        };
        measure(&mut depths, &dll, preset, &settings, [1e-3, 4.0]);
        measure3(&mut depths, preset);
    }
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let [profile, saved] = ["shell_rail.csv", "shell_saved.csv"].map(|name| folder.join(name).display().to_string());
    let samples: String =
        (0..20_000).map(|k| format!("{},{}\n", 1e-3 * f64::from(k), 1e-7 * f64::from(k % 7))).collect();
    std::fs::write(&profile, format!("position,height\n{samples}")).unwrap();
    let rows = text_of("s1002_uic60_3mm.csv").replace('\n', ";");
    type Case<'a> = (&'a str, [f64; 2], &'a dyn Fn(&Slave));
    let cases: [Case; 4] = [
        ("sideways on fixed nodes", [1e-3, 4.0], &|slave| {
            assert_eq!(slave.set_string("preset", "railway_ellipse"), fmi2OK);
            slave.coarsen();
            slave.set_boolean("contact.lateral", true);
            slave.set_string("rail.profile", &profile);
        }),
        ("locked and melting", [5e-3, 20.0], &|slave| {
            slave.set_string("preset", "railway_dry");
            slave.coarsen();
            slave.set_real("initial.creepage", 2.0 - 1e-9);
            slave.set_real("initial.velocity", 30.0);
        }),
        ("profiles from a file and a text, wear", [1e-3, 10.0], &|slave| {
            slave.coarsen();
            assert_eq!(slave.set_string("rail.profile", &profile), fmi2OK);
            assert_eq!(slave.set_string("wheel.profile", "flat(length = 0.02, position = 0.05)"), fmi2OK);
            assert_eq!(slave.set_string("wheel.profile_save", &saved), fmi2OK);
            assert_eq!(slave.set_integer("damage.wear", 2), fmi2OK);
        }),
        ("rows as text", [1e-3, 4.0], &|slave| {
            assert_eq!(slave.set_string("preset", "railway_s1002_3mm"), fmi2OK);
            assert_eq!(slave.set_string("contact.rows", &rows), fmi2OK);
        }),
    ];
    for (what, steps, settings) in cases {
        measure(&mut depths, &dll, what, settings, steps);
    }
    // A start that is refused where it is computed, and files that are not there.
    for (name, value) in [("rail.profile", "none.csv"), ("wheel.profile", "hole("), ("wheel.profile_save", "a.txt")] {
        let slave = Slave::coarse(&dll);
        slave.set_string(name, value);
        slave.enter();
        assert_eq!(depths.of("fmi2ExitInitializationMode", name, || slave.exit()), fmi2Error);
    }
    depths
}

#[test]
fn every_call_needs_at_most_64_kb_of_stack() {
    let thread = std::thread::Builder::new().stack_size(8 << 20).spawn(all_calls).unwrap();
    let depths = thread.join().unwrap().0;
    for (function, (depth, what)) in &depths {
        println!("{function:<30}{:>7.1} kB  {what}", *depth as f64 / 1024.0);
    }
    let deep: Vec<_> = depths.iter().filter(|(_, (depth, _))| *depth > LIMIT).collect();
    assert!(depths.len() >= 33 && deep.is_empty(), "{deep:?}");
}

#[link(name = "m")]
unsafe extern "C" {
    fn feenableexcept(which: c_int) -> c_int;
    fn feraiseexcept(which: c_int) -> c_int;
    fn fesetround(mode: c_int) -> c_int;
    fn fegetround() -> c_int;
    fn fegetexcept() -> c_int;
    fn fegetenv(environment: *mut Environment) -> c_int;
    fn fesetenv(environment: *const Environment) -> c_int;
}

/// `fenv_t` of the C library: what `fnstenv` stores, and MXCSR.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
struct Environment {
    x87: [u32; 7],
    mxcsr: u32,
}

impl Environment {
    /// That of the thread.
    fn present() -> Self {
        let mut present = Self::default();
        // SAFETY: has the layout of `fenv_t`.
        unsafe { fegetenv(&mut present) };
        present
    }

    /// Control, status and tags of both units; the rest are addresses of instructions.
    fn meaning(self) -> [u32; 4] {
        [self.x87[0] & 0xffff, self.x87[1] & 0xffff, self.x87[2] & 0xffff, self.mxcsr]
    }
}

/// Invalid, division by zero, overflow, underflow, inexact; bits of MXCSR that flush tiny numbers to zero.
const ALL: c_int = 0x3d;
const FLUSH: u32 = 0x8040;
/// `FE_DFL_ENV`.
const USUAL: *const Environment = ptr::without_provenance(usize::MAX);

/// A master that traps what is in `traps` and rounds, flushes and has raised flags as it likes.
#[derive(Clone, Copy, Debug)]
struct Host {
    traps: c_int,
    rounding: c_int,
    flags: c_int,
    flush: bool,
}

impl Host {
    /// Calls the library under the environment of the master, which must be the same afterwards.
    #[inline(never)]
    fn call<R>(&self, what: &str, mut call: impl FnMut() -> R) -> R {
        // SAFETY: functions of the C library that change nothing but the environment of this thread, which is the usual
        // one again before anything is computed.
        let (before, result, after) = unsafe {
            feraiseexcept(self.flags);
            fesetround(self.rounding);
            let mut before = Environment::present();
            before.mxcsr |= if self.flush { FLUSH } else { 0 };
            fesetenv(&before);
            feenableexcept(self.traps);
            before = Environment::present();
            let result = call();
            let after = Environment::present();
            fesetenv(USUAL);
            (before, result, after)
        };
        assert_eq!(before.meaning(), after.meaning(), "{what} under {self:?}");
        result
    }
}

/// Traps and rounding as the logger has seen them.
static SEEN: [AtomicI32; 2] = [AtomicI32::new(-1), AtomicI32::new(-1)];

unsafe extern "C" fn look(_: *mut c_void, _: *const i8, _: c_int, _: *const i8, _: *const i8) {
    // SAFETY: reads only.
    let seen = unsafe { [fegetexcept(), fegetround()] };
    SEEN.iter().zip(seen).for_each(|(place, seen)| place.store(seen, Ordering::Relaxed));
}

/// A life under the environment of a master, and everything that it reads.
fn life(dll: &libfmi::Fmi2Dll, host: Host) -> Vec<Vec<u64>> {
    let times: Vec<f64> = (0..8).map(|k| 1e-3 * f64::from(k)).collect();
    let slave = host.call("fmi2Instantiate", || Slave::try_new(dll, &Arguments::default())).ok().unwrap();
    // Freed under the environment of the master, once.
    let slave = ManuallyDrop::new(slave);
    host.call("fmi2Set…", || slave.coarsen());
    assert_eq!(host.call("fmi2SetupExperiment", || slave.setup(0.0, None)), fmi2OK);
    assert_eq!(host.call("fmi2EnterInitializationMode", || slave.enter()), fmi2OK);
    assert_eq!(host.call("fmi2ExitInitializationMode", || slave.exit()), fmi2OK);
    let (mut state, mut read) = (ptr::null_mut(), Vec::new());
    assert_eq!(host.call("fmi2GetFMUstate", || slave.save(&mut state)), fmi2OK);
    for (k, time) in times.iter().enumerate() {
        let moment = -300.0 * k as f64;
        assert_eq!(host.call("fmi2SetReal", || slave.set_real("drive.moment", moment)), fmi2OK);
        assert_eq!(host.call("fmi2DoStep", || slave.step(*time, 1e-3)), fmi2OK);
        read.push(host.call("fmi2GetReal", || slave.outputs()));
        host.call("a refused step", || slave.step(f64::NAN, 1e-3));
        host.call("a refused value", || slave.set_real("drive.load", f64::INFINITY));
    }
    let [unknown, known] = ["contact.force_x", "drive.load"].map(|name| variable(name).reference);
    let mut derivative = 0.0;
    host.call("fmi2GetDirectionalDerivative", || unsafe {
        dll.fmi2GetDirectionalDerivative(slave.component, &unknown, 1, &known, 1, &1.0, &mut derivative)
    });
    let bytes = host.call("fmi2SerializeFMUstate", || slave.serialize(state));
    assert_eq!(host.call("fmi2DeSerializeFMUstate", || slave.deserialize(&bytes, &mut state)), fmi2OK);
    assert_eq!(host.call("fmi2SetFMUstate", || slave.restore(state)), fmi2OK);
    read.push([derivative.to_bits()].into_iter().chain(host.call("fmi2GetReal", || slave.outputs())).collect());
    assert_eq!(host.call("fmi2Terminate", || slave.terminate()), fmi2OK);
    assert_eq!(host.call("fmi2Reset", || slave.reset()), fmi2OK);
    host.call("fmi2FreeInstance", || unsafe { dll.fmi2FreeInstance(slave.component) });
    read
}

#[test]
fn hosts_that_trap_round_and_flush_get_the_usual_results_and_their_environment_back() {
    let dll = load();
    // What this program itself makes at the first time would raise flags within a call.
    assert!(variables().len() > 1000 && !slave::guid().is_empty());
    let usual = Host { traps: 0, rounding: 0, flags: 0, flush: false };
    let expected = life(&dll, usual);
    for rounding in [0, 0x400, 0x800, 0xc00] {
        for (traps, flags, flush) in [(ALL, 0, false), (0, ALL, true), (ALL & !0x20, 0x20, true)] {
            let host = Host { traps, rounding, flags, flush };
            assert!(life(&dll, host) == expected, "{host:?}");
        }
    }
    println!("12 lives under 12 environments: equal to the last bit");
}

#[test]
fn the_logger_of_the_host_runs_under_the_environment_of_the_host() {
    let dll = load();
    // SAFETY: as in `slave`: for these arguments the calling convention is that of the variadic function.
    let logger = unsafe { std::mem::transmute::<*const c_void, libfmi::fmi2CallbackLogger>(look as *const c_void) };
    let callbacks = libfmi::fmi2CallbackFunctions {
        logger,
        allocateMemory: None,
        freeMemory: None,
        stepFinished: None,
        componentEnvironment: ptr::null_mut(),
    };
    let guid = std::ffi::CString::new(guid()).unwrap();
    let host = Host { traps: ALL, rounding: 0x400, flags: 0, flush: false };
    let new = |guid: &std::ffi::CStr| unsafe {
        let kind = libfmi::fmi2Type::fmi2CoSimulation;
        dll.fmi2Instantiate(c"wheel".as_ptr(), kind, guid.as_ptr(), ptr::null(), &callbacks, 0, 1)
    };
    let seen = || SEEN.each_ref().map(|place| place.swap(-1, Ordering::Relaxed));
    assert!(host.call("a refused instance", || new(c"wrong")).is_null());
    assert_eq!(seen(), [ALL, 0x400]);
    let component = host.call("fmi2Instantiate", || new(&guid));
    assert!(!component.is_null());
    seen();
    let status = host.call("a refused step", || unsafe { dll.fmi2DoStep(component, 0.0, 1e-3, 1) });
    assert_eq!((status, seen()), (fmi2Error, [ALL, 0x400]));
    host.call("fmi2FreeInstance", || unsafe { dll.fmi2FreeInstance(component) });
}
