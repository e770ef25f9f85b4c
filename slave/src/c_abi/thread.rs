//! A thread that has ended, with all that was left in it, when its computation is done.
//!
//! On Unix threads of the standard library will not do: to start one leaves a destructor in the thread that starts it.
//! The thread has its own stack, whatever stack the master has, and the usual floating-point environment.

use super::environment::Environment;
use crate::aside::{Report, here};
use std::any::Any;
#[cfg(unix)]
use std::ffi::c_void;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::{Condvar, Mutex, PoisonError};
use std::{mem, ptr};

/// Stack of the thread [bytes]: twice that of threads of the standard library.
const STACK: usize = 4 << 20;

/// News from the thread.
#[derive(Default)]
struct News {
    progress: Vec<(String, f64)>,
    done: bool,
}

/// A computation on its way to the thread and back.
struct Job<'a> {
    work: &'a mut (dyn FnMut(&mut Report) + Send),
    panic: Option<Box<dyn Any + Send>>,
    board: &'a (Mutex<News>, Condvar),
}

impl Job<'_> {
    fn run(&mut self) {
        let (news, ring) = self.board;
        let post = |change: &dyn Fn(&mut News)| {
            change(&mut news.lock().unwrap_or_else(PoisonError::into_inner));
            ring.notify_one();
        };
        let mut report = |what: &str, share: f64| post(&|news| news.progress.push((what.to_owned(), share)));
        self.panic = catch_unwind(AssertUnwindSafe(|| (self.work)(&mut report))).err();
        post(&|news| news.done = true);
    }
}

/// Carries out the job on the thread that has been started for it.
///
/// # Safety
/// Nobody else touches the job before the thread has been joined.
unsafe fn enter(job: *mut Job) {
    Environment::USUAL.exchange();
    // SAFETY: the condition of this function.
    unsafe { &mut *job }.run();
}

/// A thread that is waited for before anything it uses can go.
#[cfg(unix)]
struct Running(libc::pthread_t);

#[cfg(unix)]
impl Drop for Running {
    fn drop(&mut self) {
        // SAFETY: a thread that `start` has started, joined here only.
        unsafe { libc::pthread_join(self.0, ptr::null_mut()) };
    }
}

/// Starts a thread on the job; `None` if the system grants none.
#[cfg(unix)]
fn start(job: *mut Job) -> Option<Running> {
    extern "C" fn run(job: *mut c_void) -> *mut c_void {
        // SAFETY: `beside` hands over its job and does not touch it until this thread has been joined.
        unsafe { enter(job.cast()) };
        ptr::null_mut()
    }
    // SAFETY: attributes are initialised before they are used and destroyed once; a thread identity is a plain number
    // or address, for which zeros are a value, and read only after the call has set it.
    unsafe {
        let (mut attributes, mut thread) = (mem::zeroed(), mem::zeroed());
        if libc::pthread_attr_init(&mut attributes) != 0 {
            return None;
        }
        libc::pthread_attr_setstacksize(&mut attributes, STACK);
        let refused = libc::pthread_create(&mut thread, &attributes, run, job.cast());
        libc::pthread_attr_destroy(&mut attributes);
        (refused == 0).then(|| Running(thread))
    }
}

/// A thread that is waited for before anything it uses can go.
#[cfg(not(unix))]
struct Running(Option<std::thread::JoinHandle<()>>);

#[cfg(not(unix))]
impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.0.take().map(std::thread::JoinHandle::join);
    }
}

/// Starts a thread on the job; `None` if the system grants none.
#[cfg(not(unix))]
fn start(job: *mut Job) -> Option<Running> {
    let address = job.expose_provenance();
    let run = move || {
        // SAFETY: `beside` hands over its job and does not touch it until this thread has been joined.
        unsafe { enter(ptr::with_exposed_provenance_mut(address)) }
    };
    std::thread::Builder::new().stack_size(STACK).spawn(run).ok().map(|thread| Running(Some(thread)))
}

/// An [`Aside`](crate::aside::Aside) on a thread of the operating system.
pub fn beside(work: &mut (dyn FnMut(&mut Report) + Send), listener: &mut Report) {
    let board = Default::default();
    let mut job = Job { work, panic: None, board: &board };
    let place = ptr::from_mut(&mut job);
    let Some(running) = start(place) else { return here(job.work, listener) };
    loop {
        let news = board.0.lock().unwrap_or_else(PoisonError::into_inner);
        let quiet = |news: &mut News| news.progress.is_empty() && !news.done;
        let mut news = board.1.wait_while(news, quiet).unwrap_or_else(PoisonError::into_inner);
        let (progress, done) = (mem::take(&mut news.progress), news.done);
        drop(news);
        progress.iter().for_each(|(what, share)| listener(what, *share));
        if done {
            break;
        }
    }
    drop(running);
    // SAFETY: the thread has ended; the job is ours alone again.
    if let Some(panic) = unsafe { (*place).panic.take() } {
        resume_unwind(panic);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::thread;

    #[test]
    fn a_computation_beside_is_heard_in_order_on_the_thread_of_the_caller() {
        let (caller, mut worker, mut heard) = (thread::current().id(), None, Vec::new());
        let mut work = |report: &mut Report| {
            worker = Some(thread::current().id());
            (0..100).for_each(|i| report("count", f64::from(i)));
        };
        beside(&mut work, &mut |what, share| {
            assert_eq!(thread::current().id(), caller);
            heard.push((what.to_owned(), share));
        });
        assert!(worker.is_some_and(|worker| worker != caller));
        assert!(
            heard.iter().map(|(what, share)| (what.as_str(), *share)).eq((0..100).map(|i| ("count", f64::from(i))))
        );
    }

    #[test]
    fn a_panic_beside_goes_on_in_the_caller_and_one_of_the_listener_waits_for_the_thread() {
        let caught = catch_unwind(|| beside(&mut |_| panic!("lost"), &mut |_, _| {}));
        assert_eq!(*caught.unwrap_err().downcast_ref::<&str>().unwrap(), "lost");
        let mut done = false;
        let mut work = |report: &mut Report| {
            report("count", 0.0);
            thread::sleep(std::time::Duration::from_millis(20));
            done = true;
        };
        let caught = catch_unwind(AssertUnwindSafe(|| beside(&mut work, &mut |_, _| panic!("deaf"))));
        assert_eq!(*caught.unwrap_err().downcast_ref::<&str>().unwrap(), "deaf");
        assert!(done);
    }
}
