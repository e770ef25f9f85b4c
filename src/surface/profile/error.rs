//! Errors in the text of a profile or in its file.

/// A profile that has no meaning.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ProfileError {
    /// A text that is no sum of features.
    #[error(
        "profile, column {column}: {expected} is expected, not {found}. Write features such as \
         hole(position = 2, length = 0.005, depth = 0.001), joined by +, or the name of a .csv file alone; within a sum that is file(\"name.csv\")"
    )]
    Syntax {
        /// Column in the text, from 1.
        column: usize,
        /// Text that is expected.
        expected: &'static str,
        /// Text that is found.
        found: String,
    },
    /// A name that no feature has.
    #[error("profile, column {column}: feature {name} is unknown; nearest: {nearest}")]
    Feature {
        /// Column in the text, from 1.
        column: usize,
        /// The unknown name.
        name: String,
        /// Names most like it.
        nearest: String,
    },
    /// A name that no parameter of the feature has.
    #[error("profile: {feature} has no parameter {name}; nearest: {nearest}")]
    Parameter {
        /// The feature.
        feature: &'static str,
        /// The unknown name.
        name: String,
        /// Names most like it.
        nearest: String,
    },
    /// A parameter that is given twice.
    #[error("profile: {feature} is given {name} twice; leave one out")]
    Twice {
        /// The feature.
        feature: &'static str,
        /// The parameter.
        name: String,
    },
    /// A parameter without default that is not given.
    #[error("profile: {feature} needs {name}: {range}")]
    Missing {
        /// The feature.
        feature: &'static str,
        /// The parameter.
        name: &'static str,
        /// Its range in words.
        range: String,
    },
    /// A value outside its range, or of another kind.
    #[error("profile: {name} = {value} of {feature} is outside its range: {range}")]
    Range {
        /// The feature.
        feature: &'static str,
        /// The parameter.
        name: &'static str,
        /// Its value in words.
        value: String,
        /// Its range in words, with the values on which it depends.
        range: String,
    },
    /// A feature that the other body cannot have.
    #[error("profile: {feature} is a feature of the {owner} only; on the {body} use {instead}")]
    Owner {
        /// The feature.
        feature: &'static str,
        /// Body that can have it.
        owner: &'static str,
        /// Body of the profile.
        body: &'static str,
        /// Features for that body.
        instead: &'static str,
    },
    /// A file that cannot be read.
    #[error(
        "profile: file {path} cannot be read ({reason}); looked for {tried}; give a path that is absolute or relative to \
         the working directory"
    )]
    Unreadable {
        /// File that is there, or the name of one that is not.
        path: String,
        /// Reason.
        reason: String,
        /// Places where it was looked for.
        tried: String,
    },
    /// A file whose content is no profile.
    #[error("profile: file {path}, line {line}: {problem}")]
    File {
        /// Path after it was joined to the folder.
        path: String,
        /// Line of the file, from 1.
        line: usize,
        /// Problem and remedy.
        problem: String,
    },
}
