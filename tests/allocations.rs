//! Heap allocations of a step: time spent in the allocator is time the model does not compute.
#![allow(unsafe_code)]

mod common;

use common::{model, preset};
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use wheelrail::simulation::{Inputs, Simulation};

/// The system's allocator, counting the calls of each thread.
struct Counting;

thread_local! {
    static CALLS: Cell<u64> = const { Cell::new(0) };
    static BYTES: Cell<u64> = const { Cell::new(0) };
}

fn count(size: usize) {
    // Threads that are ending have no counters any more; nobody asks for theirs.
    let _ = CALLS.try_with(|calls| calls.set(calls.get() + 1));
    let _ = BYTES.try_with(|bytes| bytes.set(bytes.get() + size as u64));
}

// SAFETY: every call is passed on to the system's allocator unchanged; the counters are plain cells without destructors,
// so counting neither allocates nor panics.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count(layout.size());
        // SAFETY: as the caller promises.
        unsafe { System.alloc(layout) }
    }
    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        count(layout.size());
        // SAFETY: as the caller promises.
        unsafe { System.alloc_zeroed(layout) }
    }
    unsafe fn realloc(&self, memory: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count(size);
        // SAFETY: as the caller promises.
        unsafe { System.realloc(memory, layout, size) }
    }
    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        // SAFETY: as the caller promises.
        unsafe { System.dealloc(memory, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Allocations and bytes per step of 1 ms in a braking run, after the workspace has been filled.
fn per_step(thermal: bool) -> (f64, f64) {
    const STEPS: u64 = 200;
    let mut config = preset("railway", 20);
    config.thermal.enabled = thermal;
    let model = model(config);
    let mut inputs = Inputs::rolling(model.config());
    let mut simulation = Simulation::new(model, &inputs).unwrap();
    let mut run = |steps: u64| {
        for _ in 0..steps {
            inputs.drive.moment -= 20.0;
            simulation.advance(&inputs, 1e-3).unwrap();
        }
    };
    run(20);
    let (calls, bytes) = (CALLS.get(), BYTES.get());
    run(STEPS);
    let each = |now: u64, before: u64| (now - before) as f64 / STEPS as f64;
    (each(CALLS.get(), calls), each(BYTES.get(), bytes))
}

#[test]
fn a_reduced_coupled_step_allocates_less_than_sixty_times() {
    let (calls, bytes) = per_step(true);
    let (mechanical, _) = per_step(false);
    println!("with heat {calls:.1} allocations, {bytes:.0} bytes; mechanics alone {mechanical:.1} allocations");
    assert!(calls < 60.0, "{calls} allocations per step");
}
