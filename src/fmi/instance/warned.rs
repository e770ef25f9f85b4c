//! Memory of what has been said in a run.

use crate::fmi::variable::Reference;
use crate::simulation::validity::Limit;

/// What the user has been warned of.
#[derive(Default)]
pub(super) struct Warned {
    limits: Vec<Limit>,
    /// Subjects, with the variable that each is about.
    subjects: Vec<(Subject, Reference)>,
}

/// What a warning is about.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Subject {
    /// A value of another unit.
    Unit,
    /// An input without effect.
    Idle,
    /// A moment that drives a wheel backwards.
    Reversal,
}

impl Warned {
    /// Whether a limit has been told.
    pub fn of_limit(&self, limit: Limit) -> bool {
        self.limits.contains(&limit)
    }

    /// Remembers a limit.
    pub fn add_limit(&mut self, limit: Limit) {
        self.limits.push(limit);
    }

    /// Whether a subject has not been told of a variable; from now on it has.
    pub fn is_new(&mut self, subject: Subject, reference: Reference) -> bool {
        let new = !self.subjects.contains(&(subject, reference));
        if new {
            self.subjects.push((subject, reference));
        }
        new
    }
}
