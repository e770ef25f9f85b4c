//! States that a master holds by handles, `fmi2FMUstate` or `fmi3FMUState`.
//!
//! A handle is the address of a word of memory that belongs to the instance, and the key under which the state is
//! found. The library never follows a handle. Some masters, however, pass the handle itself where the address of the
//! handle is asked for (fmusim up to 0.0.39 in `fmi2FreeFMUstate`): the library then reads that word as if it were a
//! handle. It is none, so the call is refused. Words of freed states are kept for new ones, so that this holds for
//! stale handles, too.

use crate::log::{CallError, Outcome};
use crate::snapshot::Snapshot;
use std::collections::BTreeMap;
use std::ffi::c_void;
use std::ptr;

/// Handle of a saved state.
pub type Handle = *mut c_void;

/// Content of the word behind every handle: odd, so never the address of a word.
const NO_HANDLE: usize = 1;

/// All states of one instance.
pub struct States<T> {
    held: BTreeMap<usize, (Box<usize>, Snapshot<T>)>,
    /// Words without a state, which keep their addresses.
    #[allow(clippy::vec_box)]
    spare: Vec<Box<usize>>,
}

impl<T> Default for States<T> {
    fn default() -> Self {
        Self { held: BTreeMap::new(), spare: Vec::new() }
    }
}

impl<T> States<T> {
    /// The state behind a handle; refuses what is no handle of this instance.
    pub fn find(&self, handle: Handle) -> Outcome<&Snapshot<T>> {
        match self.held.get(&handle.addr()) {
            Some((_, snapshot)) => Ok(snapshot),
            None => Err(unknown(handle)),
        }
    }

    /// Keeps a snapshot under `handle`, or under a new handle if that is NULL; returns the handle.
    pub fn keep(&mut self, handle: Handle, snapshot: Snapshot<T>) -> Outcome<Handle> {
        if !handle.is_null() {
            let (_, held) = self.held.get_mut(&handle.addr()).ok_or_else(|| unknown(handle))?;
            *held = snapshot;
            return Ok(handle);
        }
        let mut word = self.spare.pop().unwrap_or_else(|| Box::new(NO_HANDLE));
        let handle = ptr::from_mut(&mut *word);
        self.held.insert(handle.addr(), (word, snapshot));
        Ok(handle.cast())
    }

    /// Forgets the state behind a handle.
    pub fn free(&mut self, handle: Handle) -> Outcome {
        let (word, _) = self.held.remove(&handle.addr()).ok_or_else(|| unknown(handle))?;
        self.spare.push(word);
        Ok(())
    }
}

fn unknown(handle: Handle) -> CallError {
    CallError::error(match handle.addr() {
        NO_HANDLE => "FMUstate is a state where the address of a variable that holds a state is asked for",
        _ => "FMUstate is not a state of this instance, or has been freed",
    })
}
