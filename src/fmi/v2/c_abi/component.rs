//! What stands behind a pointer that a master holds.

use super::states::States;
use crate::fmi::instance::Instance;
use std::any::Any;
use std::ffi::CString;

/// What a master holds as `fmi2Component`.
pub(super) struct Component {
    pub instance: Instance,
    /// Strings that the master may read until its next call of a function that returns strings.
    pub strings: Vec<CString>,
    pub states: States,
}

/// What a panic says.
pub(super) fn panic_text(panic: Box<dyn Any + Send>) -> String {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_else(|| "no message".to_owned())
}
