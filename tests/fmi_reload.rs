//! Loading, using and unloading the shared library again and again. Alone in its executable, so that no other test
//! holds the library or allocates.
#![cfg(target_os = "linux")]

mod common;
mod memory;
mod slave;
use slave::*;

/// Whether the library is mapped into this process.
fn mapped() -> bool {
    let maps = std::fs::read_to_string("/proc/self/maps").unwrap();
    maps.contains(library().to_str().unwrap())
}

/// Bits of a short run in a library that is loaded for it; `used_here` by this thread or by one of its own.
fn load_run_unload(resources: &str, used_here: bool) -> Vec<Vec<u64>> {
    let dll = load();
    assert!(mapped());
    let run = || {
        let arguments = Arguments { resources: Some(resources), ..Default::default() };
        let slave = Slave::try_new(&dll, &arguments).unwrap_or_else(|messages| panic!("{messages:?}"));
        slave.coarsen();
        slave.initialize();
        slave.brake(0)
    };
    if used_here { run() } else { std::thread::scope(|scope| scope.spawn(run).join().unwrap()) }
}

/// Memory that stays when the library goes [kB]: the table of variables and its texts, once per real unload.
const LEFT_BEHIND: i64 = 200;

#[test]
fn the_library_comes_and_goes_a_hundred_times() {
    let mut config = common::preset("railway", 4);
    (config.solver.modes_wheel, config.solver.modes_rail) = (6, 4);
    common::model(config);
    let resources = concat!("file://", env!("CARGO_MANIFEST_DIR"), "/target");
    let expected = load_run_unload(resources, false);
    let growth = |used_here: bool| {
        let mut memory = Vec::new();
        for round in 0..=100 {
            assert_eq!(load_run_unload(resources, used_here), expected, "round {round}");
            // Thread-local data of the Rust runtime keep a library loaded as long as a thread lives that has used it.
            assert_eq!(mapped(), used_here, "round {round}");
            memory.extend(memory::resident().filter(|_| round % 10 == 0));
        }
        println!("resident memory every ten rounds: {memory:?} kB");
        memory[10] - memory[1]
    };
    let [unloaded, kept] = [false, true].map(growth);
    assert!(unloaded < 90 * LEFT_BEHIND, "{unloaded} kB");
    assert!(kept < 1024, "{kept} kB");
}
