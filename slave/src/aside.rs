//! Long computations on a thread that is gone when they are done.
//!
//! Products of matrices and threads of the standard library leave memory with a destructor behind, in the thread in
//! which they run. An operating system keeps a shared library loaded until every such thread has ended: a master that
//! unloads the library would wait for its own main thread. So preparations, and steps that factorise matrices, run
//! beside the thread of the master, and so does what needs more stack than a master may have left.

use crate::log::CallError;

/// Receiver of progress: the name of the computation, and its share done.
pub type Report<'a> = dyn FnMut(&str, f64) + 'a;

/// A way to run a computation to its end, on whatever thread. Its progress is told to the listener on the thread of the
/// caller; a panic goes on in the caller.
pub type Aside = fn(&mut (dyn FnMut(&mut Report) + Send), &mut Report);

/// Runs the computation on the thread of the caller.
pub fn here(work: &mut (dyn FnMut(&mut Report) + Send), listener: &mut Report) {
    work(listener);
}

/// Result of a computation that is run by `aside`.
pub fn run<R: Send>(
    aside: Aside,
    listener: &mut Report,
    work: impl FnOnce(&mut Report) -> R + Send,
) -> Result<R, CallError> {
    let (mut work, mut result) = (Some(work), None);
    aside(&mut |report| result = work.take().map(|work| work(report)), listener);
    result.ok_or_else(|| CallError::error("the computation was not carried out"))
}
