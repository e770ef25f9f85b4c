//! Loading, using and unloading the shared library again and again. Alone in its executable, so that no other test
//! holds the library or allocates.
#![cfg(target_os = "linux")]

mod common;
mod slave;
use slave::*;

/// Largest memory that a load, run and unload may leave behind on average [kB]. Statics own no heap, so that nothing is lost
/// with them (measured 0.6 kB, in the first rounds only).
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

/// Whether the library is mapped into this process.
fn mapped() -> bool {
    let maps = std::fs::read_to_string("/proc/self/maps").unwrap();
    maps.contains(library().to_str().unwrap())
}

/// Bits of a short run in a library that is loaded for it.
fn load_run_unload() -> Vec<Vec<u64>> {
    let dll = load();
    assert!(mapped());
    let arguments = Arguments { resources: Some(STORED_BASES), ..Default::default() };
    let slave = Slave::try_new(&dll, &arguments).unwrap_or_else(|messages| panic!("{messages:?}"));
    slave.coarsen();
    slave.initialize();
    slave.brake(0)
}

#[test]
fn the_library_comes_and_goes_a_hundred_times() {
    let mut config = common::preset("railway", 4);
    (config.solver.modes_wheel, config.solver.modes_rail) = (6, 4);
    common::model(config);
    let expected = load_run_unload();
    // A region that the operating system turns into one page of two megabytes would look like memory lost.
    const PR_SET_THP_DISABLE: i32 = 41;
    // SAFETY: this option reads its first argument only and changes no memory.
    assert_eq!(unsafe { prctl(PR_SET_THP_DISABLE, 1, 0, 0, 0) }, 0);
    let mut memory = Vec::new();
    for round in 0..=100 {
        assert_eq!(load_run_unload(), expected, "round {round}");
        assert!(!mapped(), "round {round}");
        if round % 10 == 0 {
            memory.push(resident());
        }
    }
    println!("resident memory every ten rounds: {memory:?} kB");
    assert!(memory[10] - memory[1] < 90 * LEFT_BEHIND, "{memory:?} kB");
}
