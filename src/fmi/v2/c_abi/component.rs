//! What stands behind a pointer that a master holds.

use super::states::States;
use crate::fmi::instance::Instance;
use libfmi::fmi2Component;
use std::any::Any;
use std::ffi::CString;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// What a master holds as `fmi2Component`.
pub(super) struct Component {
    pub instance: Instance,
    /// Strings that the master may read until its next call of a function that returns strings.
    pub strings: Vec<CString>,
    pub states: States,
}

/// Addresses of the components that live: a pointer that is none of them is never followed.
static LIVING: Mutex<Vec<usize>> = Mutex::new(Vec::new());

fn living() -> MutexGuard<'static, Vec<usize>> {
    LIVING.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Component {
    /// What a master holds of it from now on.
    pub fn hand_out(self) -> fmi2Component {
        let component = Box::into_raw(Box::new(self));
        living().push(component.addr());
        component.cast()
    }

    /// The component behind a pointer, if it is one that lives.
    pub fn find(c: fmi2Component) -> Option<*mut Component> {
        living().contains(&c.addr()).then(|| c.cast())
    }

    /// The same for the last time.
    pub fn take_back(c: fmi2Component) -> Option<*mut Component> {
        let mut living = living();
        let place = living.iter().position(|known| *known == c.addr())?;
        living.swap_remove(place);
        // Nothing is left when the library is unloaded.
        living.shrink_to_fit();
        Some(c.cast())
    }
}

/// What a panic says.
pub(super) fn panic_text(panic: Box<dyn Any + Send>) -> String {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_else(|| "no message".to_owned())
}
