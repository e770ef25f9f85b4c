//! Functions that the page calls: one bench in a module of WebAssembly, or in a process.
//!
//! Texts and bytes go in through a buffer whose address [`bench_input`] gives, and come out through one that
//! [`bench_output`] and [`bench_output_length`] tell. Functions return 0, or 1 where the output is a message about an
//! error. Who calls from several threads waits for the others.

use crate::bench::{Bench, Reply};
use std::panic;
use std::sync::{Mutex, MutexGuard, PoisonError};

static BENCH: Mutex<Bench> = Mutex::new(Bench::new());

fn bench() -> MutexGuard<'static, Bench> {
    BENCH.lock().unwrap_or_else(PoisonError::into_inner)
}

fn reply(of: impl FnOnce(&mut Bench) -> Result<Reply, String>) -> u32 {
    let mut bench = bench();
    let found = of(&mut bench);
    let failed = found.is_err();
    bench.output = match found {
        Ok(Reply::Text(text)) | Err(text) => text.into_bytes(),
        Ok(Reply::Numbers(numbers)) => numbers.iter().flat_map(|number| number.to_le_bytes()).collect(),
    };
    failed.into()
}

/// Makes the buffer for what goes in `length` bytes long, and gives its address, which is valid until the next call.
// SAFETY: the only function of this name in a library of this package.
#[unsafe(no_mangle)]
pub extern "C" fn bench_input(length: usize) -> *mut u8 {
    let mut bench = bench();
    bench.input.clear();
    bench.input.resize(length, 0);
    bench.input.as_mut_ptr()
}

/// Address of what came out of the last call, which is valid until the next one.
// SAFETY: the only function of this name in a library of this package.
#[unsafe(no_mangle)]
pub extern "C" fn bench_output() -> *const u8 {
    bench().output.as_ptr()
}

/// Its length \[bytes].
// SAFETY: the only function of this name in a library of this package.
#[unsafe(no_mangle)]
pub extern "C" fn bench_output_length() -> usize {
    bench().output.len()
}

/// Takes the bytes of a reduced basis for the starts to come. Its name is put out: see [`bench_basis_name`].
// SAFETY: the only function of this name in a library of this package.
#[unsafe(no_mangle)]
pub extern "C" fn bench_hold_basis() -> u32 {
    reply(|bench| bench.hold_basis())
}

/// Puts out the name of the file with the reduced basis of the run whose link is the input.
// SAFETY: the only function of this name in a library of this package.
#[unsafe(no_mangle)]
pub extern "C" fn bench_basis_name() -> u32 {
    reply(|bench| bench.basis_name())
}

/// Starts the run whose link is the input, and puts out the description of its frames as JSON.
// SAFETY: the only function of this name in a library of this package.
#[unsafe(no_mangle)]
pub extern "C" fn bench_start() -> u32 {
    reply(|bench| bench.start())
}

/// Does up to `count` steps; puts out an error where one was not found.
// SAFETY: the only function of this name in a library of this package.
#[unsafe(no_mangle)]
pub extern "C" fn bench_step(count: u32) -> u32 {
    reply(|bench| bench.step(count))
}

/// Takes the change that is the input, such as `lock` or `torque=4`.
// SAFETY: the only function of this name in a library of this package.
#[unsafe(no_mangle)]
pub extern "C" fn bench_change() -> u32 {
    reply(|bench| bench.change())
}

/// Puts out the frame as numbers of eight bytes.
// SAFETY: the only function of this name in a library of this package.
#[unsafe(no_mangle)]
pub extern "C" fn bench_frame() -> u32 {
    reply(|bench| bench.frame())
}

/// Puts out the link of the run until now.
// SAFETY: the only function of this name in a library of this package.
#[unsafe(no_mangle)]
pub extern "C" fn bench_link() -> u32 {
    reply(|bench| bench.text(|run| Ok(run.link())))
}

/// Puts out its table.
// SAFETY: the only function of this name in a library of this package.
#[unsafe(no_mangle)]
pub extern "C" fn bench_csv() -> u32 {
    reply(|bench| bench.text(|run| Ok(run.csv())))
}

/// Puts out the lines of Python that repeat it.
// SAFETY: the only function of this name in a library of this package.
#[unsafe(no_mangle)]
pub extern "C" fn bench_python() -> u32 {
    reply(|bench| bench.text(crate::python::program))
}

/// Lets [`bench_failure`] tell where the code gave up, for a module whose panics end it without a word.
// SAFETY: the only function of this name in a library of this package.
#[unsafe(no_mangle)]
pub extern "C" fn bench_explain_failures() {
    panic::set_hook(Box::new(|info| {
        // The one that fails holds the bench.
        FAILURE.lock().unwrap_or_else(PoisonError::into_inner).clone_from(&info.to_string());
    }));
}

static FAILURE: Mutex<String> = Mutex::new(String::new());

/// Address of the text that tells where the code gave up; empty while it has not.
// SAFETY: the only function of this name in a library of this package.
#[unsafe(no_mangle)]
pub extern "C" fn bench_failure() -> *const u8 {
    FAILURE.lock().unwrap_or_else(PoisonError::into_inner).as_ptr()
}

/// Its length \[bytes].
// SAFETY: the only function of this name in a library of this package.
#[unsafe(no_mangle)]
pub extern "C" fn bench_failure_length() -> usize {
    FAILURE.lock().unwrap_or_else(PoisonError::into_inner).len()
}
