//! Messages to the master: categories, levels, and errors of calls.

/// Severity of a message and outcome of a call, with the numbers of `fmi2Status` and `fmi3Status`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(C)]
pub enum Status {
    /// The call succeeded.
    Ok,
    /// It succeeded, with a doubt.
    Warning,
    /// A step was not completed; the instance stands where it was before.
    Discard,
    /// A call was refused; nothing has changed.
    Error,
    /// The instance is beyond repair.
    Fatal,
}

/// Log categories with their descriptions, in the order of the model description.
pub const CATEGORIES: [(&str, &str); 7] = [
    (EVENTS, "Life of the instance: instantiation, initialization, reset, termination"),
    ("logStatusWarning", "Calls that worked but deserve a look"),
    ("logStatusDiscard", "Steps that could not be completed"),
    ("logStatusError", "Calls that were refused"),
    ("logStatusFatal", "Internal errors"),
    (PROGRESS, "Progress of long computations during initialization"),
    (ALL, "All categories"),
];
/// Category of milestones of a run.
pub const EVENTS: &str = "logEvents";
/// Category of the progress of long computations.
pub const PROGRESS: &str = "logProgress";
/// Stands for all categories in `fmi2SetDebugLogging`; no message carries it.
pub const ALL: &str = "logAll";

impl Status {
    /// Category of messages with this status.
    pub fn category(self) -> &'static str {
        match self {
            Status::Ok => EVENTS,
            Status::Warning => "logStatusWarning",
            Status::Discard => "logStatusDiscard",
            Status::Error => "logStatusError",
            Status::Fatal => "logStatusFatal",
        }
    }
}

/// Refusal of a call.
#[derive(Clone, Debug, PartialEq)]
pub struct CallError {
    /// Return value of the C function.
    pub status: Status,
    /// Reason, in the words of the user.
    pub message: String,
}

/// Result of a call.
pub type Outcome<T = ()> = Result<T, CallError>;

impl CallError {
    /// A call that is refused and changes nothing.
    pub fn error(message: impl Into<String>) -> CallError {
        CallError { status: Status::Error, message: message.into() }
    }

    /// A step that could not be computed.
    pub fn discard(message: impl Into<String>) -> CallError {
        CallError { status: Status::Discard, message: message.into() }
    }
}

/// Receiver of messages: status, category, text.
pub type Sink = Box<dyn Fn(Status, &str, &str)>;

/// Filter of messages by category. Warnings, discarded steps, errors and worse pass unasked; everything else must be asked
/// for.
pub struct Log {
    sink: Sink,
    enabled: [bool; CATEGORIES.len()],
    /// Messages of this status or a worse one pass unasked.
    loud: Status,
}

impl Log {
    /// Passes messages to `sink`; `on`: those of all categories.
    pub fn new(sink: Sink, on: bool) -> Log {
        Log { sink, enabled: [on; CATEGORIES.len()], loud: Status::Warning }
    }

    /// A log like this, in which only messages of this status or a worse one pass unasked.
    pub fn quiet_below(self, loud: Status) -> Log {
        Log { loud, ..self }
    }

    /// Switches all categories when none is named; otherwise only the named ones are on, or these off.
    pub fn switch(&mut self, on: bool, categories: &[String]) -> Outcome {
        let mut enabled = if on && !categories.is_empty() { [false; CATEGORIES.len()] } else { self.enabled };
        for name in categories {
            let known = CATEGORIES.iter().position(|(category, _)| category == name);
            let index = known.ok_or_else(|| {
                let names = CATEGORIES.map(|(category, _)| category).join(", ");
                CallError::error(format!("log category \"{name}\" is unknown; known categories: {names}"))
            })?;
            enabled[index] = on;
        }
        if categories.is_empty() || categories.iter().any(|name| name == ALL) {
            enabled = [on; CATEGORIES.len()];
        }
        self.enabled = enabled;
        Ok(())
    }

    /// Message about the outcome of a call.
    pub fn report(&self, status: Status, message: &str) {
        self.send(status, status.category(), message);
    }

    /// Tells the progress of a long computation.
    pub fn progress(&self, message: &str) {
        self.send(Status::Ok, PROGRESS, message);
    }

    fn send(&self, status: Status, category: &str, message: &str) {
        let index = CATEGORIES.iter().position(|(name, _)| *name == category);
        if status >= self.loud || index.is_some_and(|i| self.enabled[i]) {
            (self.sink)(status, category, message);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::RefCell;
    use std::rc::Rc;

    fn recorder(on: bool) -> (Log, Rc<RefCell<Vec<String>>>) {
        let seen = Rc::new(RefCell::new(Vec::new()));
        let sink = seen.clone();
        (Log::new(Box::new(move |_, category, _| sink.borrow_mut().push(category.to_owned())), on), seen)
    }

    #[test]
    fn quiet_unless_asked_except_for_warnings_and_failures() {
        let (log, seen) = recorder(false);
        log.report(Status::Ok, "");
        log.progress("");
        assert!(seen.borrow().is_empty());
        log.report(Status::Warning, "");
        log.report(Status::Error, "");
        assert_eq!(*seen.borrow(), ["logStatusWarning", "logStatusError"]);
    }

    #[test]
    fn a_quiet_log_passes_errors_and_what_has_been_asked_for() {
        let (log, seen) = recorder(false);
        let mut log = log.quiet_below(Status::Error);
        let all = [Status::Ok, Status::Warning, Status::Discard, Status::Error, Status::Fatal];
        all.iter().for_each(|status| log.report(*status, ""));
        assert_eq!(*seen.borrow(), ["logStatusError", "logStatusFatal"]);
        log.switch(true, &[]).unwrap();
        all.iter().for_each(|status| log.report(*status, ""));
        assert_eq!(seen.borrow().len(), 7);
    }

    #[test]
    fn categories_select_messages_and_unknown_ones_change_nothing() {
        let (mut log, seen) = recorder(false);
        log.switch(true, &[PROGRESS.to_owned()]).unwrap();
        log.report(Status::Ok, "");
        log.progress("");
        assert_eq!(*seen.borrow(), [PROGRESS]);
        let error = log.switch(false, &["nonsense".to_owned()]).unwrap_err();
        assert!(error.message.contains("nonsense") && error.message.contains(PROGRESS));
        log.progress("");
        assert_eq!(seen.borrow().len(), 2);
    }
}
