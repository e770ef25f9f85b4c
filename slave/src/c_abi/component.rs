//! Components: the owners of instances, behind the pointers that a master holds.

use super::environment::Host;
use super::states::States;
use crate::instance::{Instance, Slave};
use std::any::{Any, TypeId};
use std::ffi::{CString, c_void};
use std::rc::Rc;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Address of a component, or NULL: what a master holds.
pub type Address = *mut c_void;

/// An instance with everything that its master may hold of it.
pub struct Component<S: Slave> {
    /// The instance.
    pub instance: Instance<S>,
    /// Strings that the master may read until its next call of a function that returns strings.
    pub strings: Vec<CString>,
    /// Floating-point environment of the master.
    pub host: Rc<Host>,
    /// Saved states.
    pub states: States<S::State>,
    /// Question to the master about its inputs at a time within a step \[s].
    pub ask: Option<Ask>,
}

/// Function of a master that is called, outside of any call of an instance, with a time \[s].
pub type Ask = Rc<dyn Fn(f64)>;

/// Addresses and types of the components that live: a pointer that is none of them is never followed.
static LIVING: Mutex<Vec<(usize, TypeId)>> = Mutex::new(Vec::new());

fn living() -> MutexGuard<'static, Vec<(usize, TypeId)>> {
    LIVING.lock().unwrap_or_else(PoisonError::into_inner)
}

impl<S: Slave> Component<S> {
    /// A component with a new instance.
    pub fn new(instance: Instance<S>, host: Rc<Host>, ask: Option<Ask>) -> Self {
        Self { instance, host, strings: Vec::new(), states: States::default(), ask }
    }

    /// Address by which the master knows the component from now on.
    pub fn hand_out(self) -> Address {
        let component = Box::into_raw(Box::new(self));
        living().push((component.addr(), TypeId::of::<S>()));
        component.cast()
    }

    /// The component behind a pointer, if it is one that lives.
    pub fn find(c: Address) -> Option<*mut Self> {
        living().contains(&(c.addr(), TypeId::of::<S>())).then(|| c.cast())
    }

    /// The component behind a pointer, if it is one that lives, for the last time.
    pub fn take_back(c: Address) -> Option<*mut Self> {
        let mut living = living();
        let place = living.iter().position(|known| *known == (c.addr(), TypeId::of::<S>()))?;
        living.swap_remove(place);
        // Nothing is left when the library is unloaded.
        living.shrink_to_fit();
        Some(c.cast())
    }
}

/// Message of a panic.
pub fn panic_text(panic: Box<dyn Any + Send>) -> String {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_else(|| "no message".to_owned())
}
