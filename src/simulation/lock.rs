//! Locks that no panic of another thread breaks.

use std::sync::{Mutex, MutexGuard, PoisonError};

/// The lock of data that are whole at any time, whatever happened to those who held it before.
pub(super) fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
