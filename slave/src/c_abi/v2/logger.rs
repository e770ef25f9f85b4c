//! Messages to the logger of the master.

use super::types::CallbackFunctions;
use crate::c_abi::environment::Host;
use crate::c_abi::marshal::c_string;
use crate::log::Sink;
use std::rc::Rc;

/// Passes messages to the master's logger, during calls of the master.
///
/// The logger is declared like `printf`, but many masters (ctypes, JNA, P/Invoke) cannot read variable arguments and
/// show the format. So the message itself is the format, there are no arguments, and each `%` is doubled: a master that
/// uses `printf` shows the message, any other one the message with `%%` for `%`.
pub fn sink(name: &str, functions: &CallbackFunctions, host: Rc<Host>) -> Sink {
    let (name, logger, environment) = (c_string(name), functions.logger, functions.environment);
    Box::new(move |status, category, message| {
        let Some(logger) = logger else { return };
        let (category, format) = (c_string(category), c_string(&message.replace('%', "%%")));
        // SAFETY: the master's own function with the master's own environment; all strings end with NUL, and the format
        // asks for no argument.
        host.as_it_was(|| unsafe { logger(environment, name.as_ptr(), status, category.as_ptr(), format.as_ptr()) });
    })
}
