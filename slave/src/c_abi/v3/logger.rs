//! Messages to the logger of the master.

use super::types::{fmi3InstanceEnvironment, fmi3LogMessageCallback};
use crate::c_abi::environment::Host;
use crate::c_abi::marshal::c_string;
use crate::log::{Log, Status};
use std::rc::Rc;

/// Log that passes messages to the master's function, during calls of the master. Errors always pass, everything else if it
/// has been asked for: section 2.3.1 of the standard.
pub fn log_to(function: fmi3LogMessageCallback, environment: fmi3InstanceEnvironment, host: Rc<Host>, on: bool) -> Log {
    let send = move |status, category: &str, message: &str| {
        let Some(function) = function else { return };
        let (category, message) = (c_string(category), c_string(message));
        // SAFETY: the master's own function with the master's own environment; both strings end with NUL.
        host.as_it_was(|| unsafe { function(environment, status, category.as_ptr(), message.as_ptr()) });
    };
    Log::new(Box::new(send), on).quiet_below(Status::Error)
}
