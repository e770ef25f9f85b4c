//! Words and numbers of links, and what is wrong with them.

use crate::rail::Condition;

/// Most changes of a run.
pub(crate) const MOST_CHANGES: usize = 1000;
/// Inputs that are numbers: name in links, unit, smallest and largest value.
pub const NUMBERS: [(&str, &str, f64, f64); 4] = [
    ("speed", "km/h", 1.0, 250.0),
    ("load", "kN", 20.0, 200.0),
    ("torque", "kN m", 0.0, 60.0),
    ("angle", "mrad", -20.0, 20.0),
];

/// A link that is none of a run.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LinkError {
    /// A part that is no pair of a known name and a value.
    #[error("the link says \"{part}\", which is none of patch=, rail=, speed=, load=, torque=, angle= and at=")]
    Part {
        /// The part.
        part: String,
    },
    /// A value that its name does not have.
    #[error("the link says {name} = \"{value}\"; possible: {possible}")]
    Value {
        /// Name of the input.
        name: String,
        /// The value.
        value: String,
        /// Possible values in words.
        possible: String,
    },
    /// A change before the one that stands before it.
    #[error("the link says at={late} before at={early}; changes stand in the order of their time")]
    Order {
        /// Time of the former \[ms].
        late: u32,
        /// Time of the latter \[ms].
        early: u32,
    },
    /// Too many changes.
    #[error("the link has more than {MOST_CHANGES} changes")]
    Long,
}

impl LinkError {
    /// Refusal of a value.
    pub(crate) fn value(name: &str, value: &str, possible: impl Into<String>) -> Self {
        Self::Value { name: name.to_owned(), value: value.to_owned(), possible: possible.into() }
    }
}

/// A number of an input, within its range.
pub(crate) fn number(name: &str, text: &str) -> Result<f64, LinkError> {
    let range = NUMBERS.iter().find(|(known, ..)| *known == name);
    let Some((_, unit, low, high)) = range else { return Err(LinkError::Part { part: format!("{name}={text}") }) };
    let refused = || LinkError::value(name, text, format!("{low} to {high} {unit}"));
    text.parse().ok().filter(|value: &f64| (*low..=*high).contains(value)).ok_or_else(refused)
}

/// Rail of a name.
pub(crate) fn condition(name: &str) -> Result<Condition, LinkError> {
    Condition::named(name).ok_or_else(|| LinkError::value("rail", name, Condition::ALL.map(Condition::name).join(", ")))
}
