//! Loading, using and unloading the shared library again and again. Alone in its executable, so that no other test
//! holds the library or allocates.
#![cfg(target_os = "linux")]

mod common;
mod memory;
mod slave;
use slave::*;

/// Largest memory that a load, run and unload may leave behind on average [kB]. Statics own no heap, so that nothing is lost
/// with them (measured 0.6 kB, in the first rounds only).
const LEFT_BEHIND: i64 = 10;

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
    let mut memory = Vec::new();
    for round in 0..=100 {
        assert_eq!(load_run_unload(), expected, "round {round}");
        assert!(!mapped(), "round {round}");
        memory.extend(memory::resident().filter(|_| round % 10 == 0));
    }
    println!("resident memory every ten rounds: {memory:?} kB");
    assert!(memory[10] - memory[1] < 90 * LEFT_BEHIND, "{memory:?} kB");
}
