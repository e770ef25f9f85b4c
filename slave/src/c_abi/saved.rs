//! Saving, restoring and freeing of states, in both versions of the standard.

use super::component::Component;
use super::marshal::{check_count, slice, store};
use super::states::Handle;
use crate::instance::Slave;
use crate::lifecycle::Call;
use crate::log::{CallError, Outcome};
use crate::snapshot::Snapshot;
use std::ptr;

/// The handle that stands at the place a master passed.
unsafe fn handle_at(place: *const Handle) -> Outcome<Handle> {
    if place.is_null() {
        return Err(CallError::error("FMUstate is NULL"));
    }
    // SAFETY: see the module: the address of a handle; or, by mistake, a handle of ours, which is readable as well.
    Ok(unsafe { place.read() })
}

impl<S: Slave> Component<S> {
    /// Keeps a snapshot under the handle at `place`, a new one unless the place already holds one.
    unsafe fn keep(&mut self, place: *mut Handle, snapshot: Snapshot<S::State>) -> Outcome {
        // SAFETY: see the module.
        let handle = self.states.keep(unsafe { handle_at(place) }?, snapshot)?;
        // SAFETY: see the module; nothing is written where `place` holds something else than a handle.
        unsafe { store(place, vec![handle], "FMUstate") }
    }

    fn state_bytes(&self, handle: Handle) -> Outcome<Vec<u8>> {
        self.instance.life().allow(Call::FmuState)?;
        S::to_bytes(self.states.find(handle)?).map_err(CallError::error)
    }

    /// Saves the state, in the place of an earlier one if the variable holds one.
    pub unsafe fn save_state(&mut self, place: *mut Handle) -> Outcome {
        let snapshot = self.instance.snapshot()?;
        // SAFETY: see the module.
        unsafe { self.keep(place, snapshot) }
    }

    /// Continues from a saved state.
    pub fn restore_state(&mut self, handle: Handle) -> Outcome {
        let Component { instance, states, .. } = self;
        instance.restore(states.find(handle)?)
    }

    /// Forgets a saved state; ignores calls without a state, as the standard asks.
    pub unsafe fn free_state(&mut self, place: *mut Handle) -> Outcome {
        self.instance.life().allow(Call::FmuState)?;
        // SAFETY: see the module.
        unsafe {
            if place.is_null() || handle_at(place)?.is_null() {
                return Ok(());
            }
            self.states.free(handle_at(place)?)?;
            store(place, vec![ptr::null_mut()], "FMUstate")
        }
    }

    /// Writes the number of bytes of a saved state.
    pub unsafe fn state_size(&self, handle: Handle, size: *mut usize) -> Outcome {
        // SAFETY: see the module.
        unsafe { store(size, vec![self.state_bytes(handle)?.len()], "size") }
    }

    /// Writes a saved state as bytes.
    pub unsafe fn serialize_state(&self, handle: Handle, place: *mut u8, size: usize) -> Outcome {
        check_count::<u8>(size, "serializedState")?;
        let bytes = self.state_bytes(handle)?;
        if size < bytes.len() {
            let needed = bytes.len();
            return Err(CallError::error(format!("size = {size} is outside its range: at least {needed}")));
        }
        // SAFETY: see the module.
        unsafe { store(place, bytes, "serializedState") }
    }

    /// Reads a saved state from bytes.
    pub unsafe fn deserialize_state(&mut self, bytes: *const u8, size: usize, place: *mut Handle) -> Outcome {
        self.instance.life().allow(Call::FmuState)?;
        // SAFETY: see the module.
        unsafe {
            let bytes = slice(bytes, size, "serializedState")?;
            let snapshot = S::from_bytes(bytes).map_err(CallError::error)?;
            self.keep(place, snapshot)
        }
    }
}
