//! What a feature is given: taken by name, checked against a range.

use super::error::ProfileError;
use super::text::{Call, Given};
use crate::config::{display_number, display_outside, display_range, nearest};

/// What stands between the brackets of a feature. Every parameter is taken once; whatever is left at the end is unknown.
pub struct Arguments {
    feature: &'static str,
    given: Vec<(String, Given)>,
    known: Vec<&'static str>,
}

impl Arguments {
    /// Of a feature; a text without a name is the parameter `first`.
    pub fn new(feature: &'static str, call: Call, first: &str) -> Result<Self, ProfileError> {
        let mut given: Vec<(String, Given)> = Vec::new();
        for (name, value) in call.given {
            let name = name.unwrap_or_else(|| first.to_owned());
            if given.iter().any(|(other, _)| *other == name) {
                return Err(ProfileError::Twice { feature, name });
            }
            given.push((name, value));
        }
        Ok(Self { feature, given, known: Vec::new() })
    }

    /// The value of a parameter, if it is given.
    fn take(&mut self, name: &'static str) -> Option<Given> {
        self.known.push(name);
        let at = self.given.iter().position(|(given, _)| given == name)?;
        Some(self.given.swap_remove(at).1)
    }

    /// Whether a parameter is given and not yet taken.
    pub fn has(&self, name: &str) -> bool {
        self.given.iter().any(|(given, _)| given == name)
    }

    /// A value that is not allowed.
    pub fn outside(&self, name: &'static str, value: impl ToString, range: impl ToString) -> ProfileError {
        ProfileError::Range { feature: self.feature, name, value: value.to_string(), range: range.to_string() }
    }

    /// A parameter that is needed.
    pub fn missing(&self, name: &'static str, range: impl ToString) -> ProfileError {
        let given: Vec<_> = self.given.iter().map(|(name, _)| name.as_str()).collect();
        let given = if given.is_empty() { String::new() } else { format!("; beside it stands {}", given.join(", ")) };
        ProfileError::Missing { feature: self.feature, name, range: range.to_string() + &given }
    }

    /// A feature on the wrong body.
    pub fn owner(&self, owner: &'static str, body: &'static str, instead: &'static str) -> ProfileError {
        ProfileError::Owner { feature: self.feature, owner, body, instead }
    }

    /// A number from `range[0]` to `range[1]`, if it is given.
    pub fn optional(&mut self, name: &'static str, unit: &str, range: [f64; 2]) -> Result<Option<f64>, ProfileError> {
        match self.take(name) {
            None => Ok(None),
            Some(Given::Number(value)) if value >= range[0] && value <= range[1] => Ok(Some(value)),
            Some(Given::Number(value)) => {
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
            Some(Given::Text(text)) => Ok(Some(text)),
            Some(other) => Err(self.outside(name, shown(&other), "a text between \" and \"")),
        }
    }

    /// One of some words, by its number, if it is given.
    pub fn word(&mut self, name: &'static str, words: &[&str]) -> Result<Option<usize>, ProfileError> {
        let given = match self.take(name) {
            None => return Ok(None),
            Some(Given::Word(word) | Given::Text(word)) => word,
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
            Some(Given::List(list)) if list.is_empty() => Err(self.outside(name, "[]", words())),
            Some(Given::List(list)) => match list.iter().find(|value| !(range[0]..=range[1]).contains(*value)) {
                None => Ok(Some(list)),
                Some(value) => Err(self.outside(name, format!("[… {} …]", display_outside(*value, range)), words())),
            },
            Some(other) => Err(self.outside(name, shown(&other), words())),
        }
    }

    /// Refuses what was given and not taken.
    pub fn finish(self) -> Result<(), ProfileError> {
        match self.given.into_iter().next() {
            None => Ok(()),
            Some((name, _)) => {
                let nearest = nearest(&name, self.known.iter().copied());
                Err(ProfileError::Parameter { feature: self.feature, name, nearest })
            }
        }
    }
}

/// A value as it was written.
fn shown(given: &Given) -> String {
    match given {
        Given::Number(number) => display_number(*number),
        Given::Word(word) => word.clone(),
        Given::Text(text) => format!("\"{text}\""),
        Given::List(list) => format!("{list:?}"),
    }
}
