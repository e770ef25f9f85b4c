//! Functions that the page calls: benches in a module of WebAssembly, or in a process.
//!
//! Every function takes the bench that [`bench_new`] made; nothing is shared between two of them. Texts and bytes go in
//! through a buffer whose address [`bench_input`] gives, and come out through one that [`bench_output`] and
//! [`bench_output_length`] tell. Functions that return a number give 0, or 1 where the output is a message about an error.
//!
//! # Safety
//! The address is one that [`bench_new`] gave and [`bench_free`] has not taken, and one thread at a time calls with it.

use crate::bench::{Bench, Reply};
use std::panic;
use std::sync::{Arc, Mutex, PoisonError};

/// A bench with what went in, what came out, and where its code gave up.
#[derive(Default)]
pub struct Handle {
    bench: Bench,
    output: Vec<u8>,
    failure: Arc<Mutex<String>>,
}

impl Handle {
    fn reply(&mut self, of: impl FnOnce(&mut Bench) -> Result<Reply, String>) -> u32 {
        let found = of(&mut self.bench);
        let failed = found.is_err();
        self.output = match found {
            Ok(Reply::Text(text)) | Err(text) => text.into_bytes(),
            Ok(Reply::Numbers(numbers)) => numbers.iter().flat_map(|number| number.to_le_bytes()).collect(),
        };
        failed.into()
    }
}

/// Makes a bench without a run.
// SAFETY: the only function of this name in a library of this package.
#[unsafe(no_mangle)]
pub extern "C" fn bench_new() -> *mut Handle {
    Box::into_raw(Box::default())
}

/// Frees a bench.
///
/// # Safety
/// As the module says.
// SAFETY: the only function of this name in a library of this package.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn bench_free(handle: *mut Handle) {
    // SAFETY: `bench_new` made it from a box.
    drop(unsafe { Box::from_raw(handle) });
}

/// Makes the buffer for what goes in `length` bytes long, and gives its address, which is valid until the next call.
///
/// # Safety
/// As the module says.
// SAFETY: the only function of this name in a library of this package.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn bench_input(handle: *mut Handle, length: usize) -> *mut u8 {
    // SAFETY: the caller's, as the module says.
    let input = unsafe { &mut (*handle).bench.input };
    input.clear();
    input.resize(length, 0);
    input.as_mut_ptr()
}

/// Address of what came out of the last call, which is valid until the next one.
///
/// # Safety
/// As the module says.
// SAFETY: the only function of this name in a library of this package.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn bench_output(handle: *const Handle) -> *const u8 {
    // SAFETY: the caller's, as the module says.
    unsafe { (*handle).output.as_ptr() }
}

/// Its length \[bytes].
///
/// # Safety
/// As the module says.
// SAFETY: the only function of this name in a library of this package.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn bench_output_length(handle: *const Handle) -> usize {
    // SAFETY: the caller's, as the module says.
    unsafe { (*handle).output.len() }
}

/// Declares a function that takes a bench and more, and puts out the reply of an expression.
macro_rules! replies {
    ($($(#[$about:meta])* $name:ident($($given:ident: $type:ty)?) = $of:expr;)*) => {$(
        $(#[$about])*
        ///
        /// # Safety
        /// As the module says.
        // SAFETY: the only function of this name in a library of this package.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $name(handle: *mut Handle $(, $given: $type)?) -> u32 {
            // SAFETY: the caller's, as the module says.
            unsafe { &mut *handle }.reply($of)
        }
    )*};
}

replies! {
    /// Takes the bytes of a reduced basis for the starts to come. Its name is put out: see [`bench_basis_name`].
    bench_hold_basis() = Bench::hold_basis;
    /// Puts out the name of the file with the reduced basis of the run whose link is the input.
    bench_basis_name() = |bench| bench.basis_name();
    /// Starts the run whose link is the input, and puts out the description of its frames as JSON.
    bench_start() = Bench::start;
    /// Does up to `count` steps; puts out an error where one was not found.
    bench_step(count: u32) = |bench| bench.step(count);
    /// Takes the change that is the input, such as `lock` or `torque=4`.
    bench_change() = Bench::change;
    /// Puts out the frame as numbers of eight bytes.
    bench_frame() = Bench::frame;
    /// Puts out the link of the run until now.
    bench_link() = |bench| bench.text(|run| Ok(run.link()));
    /// Puts out its table.
    bench_csv() = |bench| bench.text(|run| Ok(run.csv()));
    /// Puts out the lines of Python that repeat it.
    bench_python() = |bench| bench.text(crate::python::program);
}

/// Lets [`bench_failure`] tell where the code gave up, for a module whose panics end it without a word.
///
/// # Safety
/// As the module says.
// SAFETY: the only function of this name in a library of this package.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn bench_explain_failures(handle: *const Handle) {
    // SAFETY: the caller's, as the module says.
    let failure = unsafe { Arc::clone(&(*handle).failure) };
    panic::set_hook(Box::new(move |info| {
        failure.lock().unwrap_or_else(PoisonError::into_inner).clone_from(&info.to_string());
    }));
}

/// Puts out the text that tells where the code gave up; empty while it has not.
///
/// # Safety
/// As the module says.
// SAFETY: the only function of this name in a library of this package.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn bench_failure(handle: *mut Handle) {
    // SAFETY: the caller's, as the module says. What gave up has not come back, and holds nothing of these two.
    let Handle { failure, output, .. } = unsafe { &mut *handle };
    *output = failure.lock().unwrap_or_else(PoisonError::into_inner).clone().into_bytes();
}
