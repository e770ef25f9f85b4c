//! Arguments of a feature: taken by name, checked against a range.

use super::error::ProfileError;
use super::text::{ArgumentValue, FeatureCall};
use crate::display::nearest;
use crate::display::{display_number, display_outside, display_range};
use std::fmt::Display;

/// Arguments between the brackets of a feature. Every parameter is taken once; an argument that is left at the end is
/// unknown.
pub struct FeatureArguments {
    feature: &'static str,
    given: Vec<(String, ArgumentValue)>,
    known: Vec<&'static str>,
}

impl FeatureArguments {
    /// Arguments of a call; a text without a name is the parameter `first`.
    pub fn new(feature: &'static str, call: FeatureCall, first: &str) -> Result<Self, ProfileError> {
        let mut given: Vec<(String, ArgumentValue)> = Vec::new();
        for (name, value) in call.given {
            let name = name.unwrap_or_else(|| first.to_owned());
            if given.iter().any(|(other, _)| *other == name) {
                return Err(ProfileError::new(format!("{feature} is given {name} twice; leave one out")));
            }
            given.push((name, value));
        }
        Ok(Self { feature, given, known: Vec::new() })
    }

    /// The value of a parameter, if it is given.
    fn take(&mut self, name: &'static str) -> Option<ArgumentValue> {
        self.known.push(name);
        let at = self.given.iter().position(|(given, _)| given == name)?;
        Some(self.given.swap_remove(at).1)
    }

    /// Presence of a parameter that is not yet taken.
    pub fn has(&self, name: &str) -> bool {
        self.given.iter().any(|(given, _)| given == name)
    }

    /// Error of a value that is not allowed.
    pub fn outside(&self, name: &str, value: impl Display, range: impl Display) -> ProfileError {
        ProfileError::new(format!("{name} = {value} of {} is outside its range: {range}", self.feature))
    }

    /// Error of a parameter that is needed and not given.
    pub fn missing(&self, name: &str, range: impl Display) -> ProfileError {
        let given: Vec<_> = self.given.iter().map(|(name, _)| name.as_str()).collect();
        let given = if given.is_empty() { String::new() } else { format!("; beside it stands {}", given.join(", ")) };
        ProfileError::new(format!("{} needs {name}: {range}{given}", self.feature))
    }

    /// Error of a feature on the wrong body.
    pub fn owner(&self, owner: &str, body: &str, instead: &str) -> ProfileError {
        ProfileError::new(format!("{} is a feature of the {owner} only; on the {body} use {instead}", self.feature))
    }

    /// A number from `range[0]` to `range[1]`, if it is given.
    pub fn optional(&mut self, name: &'static str, unit: &str, range: [f64; 2]) -> Result<Option<f64>, ProfileError> {
        match self.take(name) {
            None => Ok(None),
            Some(ArgumentValue::Number(value)) if value >= range[0] && value <= range[1] => Ok(Some(value)),
            Some(ArgumentValue::Number(value)) => {
                let shown = if unit == "1" { String::new() } else { format!(" {unit}") };
                let value = display_outside(value, range) + &shown;
                Err(self.outside(name, value, display_range(range, unit)))
            }
            Some(other) => Err(self.outside(name, shown(&other), display_range(range, unit))),
        }
    }

    /// A number that must be given.
    pub fn number(&mut self, name: &'static str, unit: &str, range: [f64; 2]) -> Result<f64, ProfileError> {
        self.optional(name, unit, range)?.ok_or_else(|| self.missing(name, display_range(range, unit)))
    }

    /// A whole number, if it is given.
    pub fn whole(&mut self, name: &'static str, range: [f64; 2]) -> Result<Option<f64>, ProfileError> {
        match self.optional(name, "1", range)? {
            Some(value) if value.fract() != 0.0 => {
                Err(self.outside(name, value, format!("whole, {}", display_range(range, "1"))))
            }
            other => Ok(other),
        }
    }

    /// A text, if it is given.
    pub fn text(&mut self, name: &'static str) -> Result<Option<String>, ProfileError> {
        match self.take(name) {
            None => Ok(None),
            Some(ArgumentValue::Text(text)) => Ok(Some(text)),
            Some(other) => Err(self.outside(name, shown(&other), "a text between \" and \"")),
        }
    }

    /// One of some words, by its number, if it is given.
    pub fn word(&mut self, name: &'static str, words: &[&str]) -> Result<Option<usize>, ProfileError> {
        let given = match self.take(name) {
            None => return Ok(None),
            Some(ArgumentValue::Word(word) | ArgumentValue::Text(word)) => word,
            Some(other) => shown(&other),
        };
        match words.iter().position(|word| *word == given) {
            Some(number) => Ok(Some(number)),
            None => Err(self.outside(name, given, words.join(" or "))),
        }
    }

    /// A list of numbers, each within the range, if it is given.
    pub fn list(&mut self, name: &'static str, unit: &str, range: [f64; 2]) -> Result<Option<Vec<f64>>, ProfileError> {
        let words = || format!("a list such as [3, 2, 1], each {}", display_range(range, unit));
        match self.take(name) {
            None => Ok(None),
            Some(ArgumentValue::List(list)) if list.is_empty() => Err(self.outside(name, "[]", words())),
            Some(ArgumentValue::List(list)) => {
                match list.iter().find(|value| !(range[0]..=range[1]).contains(*value)) {
                    None => Ok(Some(list)),
                    Some(value) => {
                        Err(self.outside(name, format!("[… {} …]", display_outside(*value, range)), words()))
                    }
                }
            }
            Some(other) => Err(self.outside(name, shown(&other), words())),
        }
    }

    /// Refuses arguments that nobody has taken.
    pub fn finish(self) -> Result<(), ProfileError> {
        match self.given.into_iter().next() {
            None => Ok(()),
            Some((name, _)) => {
                let nearest = nearest(&name, self.known.iter().copied());
                Err(ProfileError::new(format!("{} has no parameter {name}; nearest: {nearest}", self.feature)))
            }
        }
    }
}

/// A value as it was written.
fn shown(given: &ArgumentValue) -> String {
    match given {
        ArgumentValue::Number(number) => display_number(*number),
        ArgumentValue::Word(word) => word.clone(),
        ArgumentValue::Text(text) => format!("\"{text}\""),
        ArgumentValue::List(list) => format!("{list:?}"),
    }
}
