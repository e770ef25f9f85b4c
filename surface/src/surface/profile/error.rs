//! Errors in the text of a profile or in its file.

use std::fmt::Display;

/// A profile that has no meaning, in words: feature, column or line, value, allowed range and what to do.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{0}")]
pub struct ProfileError(String);

impl ProfileError {
    /// Problem and remedy.
    pub fn new(problem: impl Display) -> Self {
        Self(format!("profile: {problem}"))
    }

    /// Problem and remedy at a column of the text, from 1.
    pub fn at(column: usize, problem: impl Display) -> Self {
        Self(format!("profile, column {column}: {problem}"))
    }

    /// Text that is expected at a column, and what is found there.
    pub fn syntax(column: usize, expected: &str, found: impl Display) -> Self {
        Self::at(
            column,
            format!(
                "{expected} is expected, not {found}. Write features such as hole(position = 2, length = 0.005, depth = \
                 0.001), joined by +, or the name of a .csv file alone; within a sum that is file(\"name.csv\")"
            ),
        )
    }
}
