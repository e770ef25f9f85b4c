//! Loading, using and unloading the shared library again and again. Alone in its executable, so that no other test
//! holds the library or allocates.
#![cfg(target_os = "linux")]

mod common;
mod slave;
use slave::*;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Largest memory that a load, run and unload may leave behind on average [kB]. Statics own no heap, so that nothing is
/// lost with them (measured 0.6 kB, in the first rounds only).
const LEFT_BEHIND: i64 = 10;

unsafe extern "C" {
    fn prctl(option: i32, on: usize, _: usize, _: usize, _: usize) -> i32;
}

/// Resident memory of this process [kB].
fn resident() -> i64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap();
    let line = status.lines().find(|line| line.starts_with("VmRSS:")).unwrap();
    line.split_whitespace().nth(1).unwrap().parse().unwrap()
}

/// True while the library is mapped into this process.
fn mapped() -> bool {
    let maps = std::fs::read_to_string("/proc/self/maps").unwrap();
    maps.contains(library().to_str().unwrap())
}

/// Bits of a short run in a library that is loaded for it, of a wheel that is set up as asked for.
fn load_run_unload(settings: impl Fn(&Slave)) -> Vec<Vec<u64>> {
    let dll = load();
    assert!(mapped());
    let arguments = Arguments { resources: Some(STORED_BASES), ..Default::default() };
    let slave = Slave::try_new(&dll, &arguments).unwrap_or_else(|messages| panic!("{messages:?}"));
    settings(&slave);
    slave.initialize();
    slave.brake(0)
}

/// Tests of a mapping that belongs to the whole process, one after the other.
fn alone() -> MutexGuard<'static, ()> {
    static ALONE: Mutex<()> = Mutex::new(());
    ALONE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Runs in a process of its own, whose cache is empty: see the next test.
#[test]
#[ignore = "called by the_library_goes_whatever_was_computed_in_it"]
fn compute_and_unload() {
    assert_eq!(std::env::var("WHEELRAIL_CACHE").as_deref(), Ok(""));
    type Change<'a> = (&'a str, &'a dyn Fn(&Slave));
    let cases: [Change; 3] = [
        ("bases computed, on threads", &|slave| slave.coarsen()),
        ("a patch of many nodes, whose system is solved at once", &|slave| {
            assert_eq!(slave.set_integer("mesh.elements_per_half_width", 12), fmi2OK);
        }),
        ("two patches", &|slave| {
            slave.coarsen();
            let hole = "hole(position = 0, length = 0.004, depth = 0.001)";
            assert_eq!(slave.set_string("rail.profile", hole), fmi2OK);
        }),
    ];
    for (what, settings) in cases {
        load_run_unload(settings);
        assert!(!mapped(), "{what}");
        // A thread that goes after the library it has used: nothing is called in a library that is gone.
        std::thread::scope(|scope| {
            scope.spawn(|| drop(load_run_unload(|slave| slave.coarsen())));
        });
        assert!(!mapped(), "{what}, on another thread");
    }
}

#[test]
fn the_library_goes_whatever_was_computed_in_it() {
    let _alone = alone();
    let output = std::process::Command::new(std::env::current_exe().unwrap())
        .args(["--exact", "compute_and_unload", "--ignored", "--nocapture"])
        .env("WHEELRAIL_CACHE", "")
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success() && text.contains("1 passed"), "{text}{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn the_library_comes_and_goes_a_hundred_times() {
    let _alone = alone();
    let config = common::preset("railway", 4);
    common::model(config);
    let expected = load_run_unload(|slave| slave.coarsen());
    // A region that the operating system turns into one page of two megabytes would look like memory lost.
    const PR_SET_THP_DISABLE: i32 = 41;
    // SAFETY: this option reads its first argument only and changes no memory.
    assert_eq!(unsafe { prctl(PR_SET_THP_DISABLE, 1, 0, 0, 0) }, 0);
    let mut memory = Vec::new();
    for round in 0..=100 {
        assert_eq!(load_run_unload(|slave| slave.coarsen()), expected, "round {round}");
        assert!(!mapped(), "round {round}");
        if round % 10 == 0 {
            memory.push(resident());
        }
    }
    println!("resident memory every ten rounds: {memory:?} kB");
    assert!(memory[10] - memory[1] < 90 * LEFT_BEHIND, "{memory:?} kB");
}
