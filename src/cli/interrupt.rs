//! Signals that ask a command to end. It ends between two steps, and what it has computed is written.

use super::Failure;
use signal_hook::flag;
use std::io;
use std::os::raw::c_int;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// A signal with its number and name.
type Signal = (c_int, &'static str);

/// Signals that end a program: Ctrl-C, a scheduler or `kill`, a terminal that has been closed.
const SIGNALS: &[Signal] = &[
    (signal_hook::consts::SIGINT, "SIGINT (Ctrl-C)"),
    (signal_hook::consts::SIGTERM, "SIGTERM"),
    #[cfg(unix)]
    (signal_hook::consts::SIGHUP, "SIGHUP (the terminal was closed)"),
];

/// The signal that has come, if any. A second one ends the process at once.
pub struct Interrupt(Arc<AtomicUsize>);

impl Interrupt {
    /// Listens from now on to all signals but those that the process was started to ignore, as `nohup` does.
    pub fn listen() -> io::Result<Interrupt> {
        let (once, place) = (Arc::new(AtomicBool::new(false)), Arc::new(AtomicUsize::new(0)));
        let ignored = ignored();
        for &(signal, _) in SIGNALS.iter().filter(|(signal, _)| ignored >> (signal - 1) & 1 == 0) {
            flag::register_conditional_default(signal, once.clone())?;
            flag::register(signal, once.clone())?;
            flag::register_usize(signal, place.clone(), usize::try_from(signal).map_err(io::Error::other)?)?;
        }
        Ok(Interrupt(place))
    }

    /// Refuses to go on once a signal has come.
    pub fn check(&self) -> Result<(), Failure> {
        let number = self.0.load(Ordering::Relaxed);
        let came = SIGNALS.iter().find(|(signal, _)| usize::try_from(*signal) == Ok(number));
        came.map_or(Ok(()), |&(signal, name)| Err(Failure::Interrupted { signal, name }))
    }
}

/// Signals that the process ignores since its start, a bit each; none where the system does not tell.
fn ignored() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0)
}
