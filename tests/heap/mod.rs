//! A heap that counts: calls and bytes of each thread, and what the whole process holds.
//!
//! Resident memory is no measure of growth of a few hundred kilobytes: the operating system may turn a region into one
//! page of two megabytes whenever it likes.
#![allow(dead_code)]

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::sync::atomic::{AtomicI64, Ordering};

/// The system's allocator, counting.
struct Counting;

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Bytes that the process holds.
static HELD: AtomicI64 = AtomicI64::new(0);

thread_local! {
    static REQUESTS: Cell<u64> = const { Cell::new(0) };
    static BYTES: Cell<u64> = const { Cell::new(0) };
}

/// Requests for memory made by this thread until now.
pub fn requests() -> u64 {
    REQUESTS.get()
}

/// Bytes that this thread has requested until now, given back or not.
pub fn requested_bytes() -> u64 {
    BYTES.get()
}

/// Bytes that the process holds now.
pub fn held() -> i64 {
    HELD.load(Ordering::Relaxed)
}

fn count(requested: usize, given_back: usize) {
    HELD.fetch_add(requested as i64 - given_back as i64, Ordering::Relaxed);
    if requested > 0 {
        // Threads that are ending have no counters any more; nobody asks for theirs.
        let _ = REQUESTS.try_with(|requests| requests.set(requests.get() + 1));
        let _ = BYTES.try_with(|bytes| bytes.set(bytes.get() + requested as u64));
    }
}

// SAFETY: every call is passed on to the system's allocator unchanged; the counters are plain cells without
// destructors, so counting neither allocates nor panics.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count(layout.size(), 0);
        // SAFETY: as the caller promises.
        unsafe { System.alloc(layout) }
    }
    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        count(layout.size(), 0);
        // SAFETY: as the caller promises.
        unsafe { System.alloc_zeroed(layout) }
    }
    unsafe fn realloc(&self, memory: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count(size, layout.size());
        // SAFETY: as the caller promises.
        unsafe { System.realloc(memory, layout, size) }
    }
    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        count(0, layout.size());
        // SAFETY: as the caller promises.
        unsafe { System.dealloc(memory, layout) }
    }
}
