//! Values, the kinds of values a row of a table can have, and how they read as text.

use super::units::Measure;
use crate::display::{display_outside, display_range};
use serde::{Deserialize, Serialize};

/// A value of a parameter, an input or an output.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Value {
    /// A number in the SI unit of its row.
    Real(f64),
    /// Whole numbers, and items of an enumeration counted from 1.
    Integer(i32),
    /// A switch.
    Boolean(bool),
    /// A text.
    String(String),
    /// An array of numbers.
    Reals(Vec<f64>),
}

impl Value {
    /// Sort of the value in words.
    pub fn sort(&self) -> &'static str {
        match self {
            Value::Real(_) => "a number",
            Value::Integer(_) => "a whole number",
            Value::Boolean(_) => "true or false",
            Value::String(_) => "a text",
            Value::Reals(_) => "an array of numbers",
        }
    }
}

/// The shortest text that reads back to the same value; elements of an array stand between blanks.
impl std::fmt::Display for Value {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Value::Real(value) => write!(f, "{value:?}"),
            Value::Integer(value) => write!(f, "{value}"),
            Value::Boolean(value) => write!(f, "{value}"),
            Value::String(value) => write!(f, "{value}"),
            Value::Reals(values) => {
                let elements: Vec<_> = values.iter().map(|value| format!("{value:?}")).collect();
                write!(f, "{}", elements.join(" "))
            }
        }
    }
}

/// A list of named choices; item `i` of the list has the value `i + 1`.
#[derive(Debug, PartialEq, Eq)]
pub struct Enumeration {
    /// Name of the list.
    pub name: &'static str,
    /// Meaning of the choice.
    pub description: &'static str,
    /// Name and meaning of every item.
    pub items: &'static [(&'static str, &'static str)],
}

impl Enumeration {
    /// Number of the item with that name.
    pub fn number(&self, name: &str) -> Option<i32> {
        (1..).zip(self.items).find(|(_, item)| item.0 == name).map(|(number, _)| number)
    }

    /// Name of the item with that number.
    pub fn item(&self, number: i32) -> Option<&'static str> {
        let index = usize::try_from(number).ok()?.checked_sub(1)?;
        self.items.get(index).map(|item| item.0)
    }
}

/// Kind of the values that a row admits. Infinite bounds are open.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// Numbers with a unit; `nominal` is their usual size.
    Real {
        /// Unit.
        measure: Measure,
        /// Smallest value.
        min: f64,
        /// Largest value.
        max: f64,
        /// Usual size.
        nominal: f64,
    },
    /// Whole numbers.
    Integer {
        /// Smallest value.
        min: i32,
        /// Largest value.
        max: i32,
    },
    /// Switches.
    Boolean,
    /// Texts.
    String,
    /// Named choices.
    Enumeration(&'static Enumeration),
}

impl Kind {
    /// Sort of the values in words.
    pub fn sort(self) -> &'static str {
        match self {
            Kind::Real { .. } => "a number",
            Kind::Integer { .. } | Kind::Enumeration(_) => "a whole number",
            Kind::Boolean => "true or false",
            Kind::String => "a text",
        }
    }

    /// Usual size of numbers.
    pub fn nominal(self) -> Option<f64> {
        if let Kind::Real { nominal, .. } = self { Some(nominal) } else { None }
    }

    /// A value as text: items of an enumeration by name, everything else as it reads back exactly.
    pub fn print(self, value: &Value) -> String {
        let item = match (self, value) {
            (Kind::Enumeration(list), Value::Integer(number)) => list.item(*number),
            _ => None,
        };
        item.map_or_else(|| value.to_string(), str::to_owned)
    }

    /// The admitted values in words.
    pub fn range(self) -> String {
        match self {
            Kind::Real { measure, min, max, .. } => display_range([min, max], measure.unit),
            Kind::Integer { min, max: i32::MAX } => format!("whole numbers from {min}"),
            Kind::Integer { min, max } => format!("{min} to {max}"),
            Kind::Boolean => "true or false".to_owned(),
            Kind::String => "text".to_owned(),
            Kind::Enumeration(list) => {
                let items: Vec<_> = (1..).zip(list.items).map(|(i, item)| format!("{i} ({})", item.0)).collect();
                items.join(", ")
            }
        }
    }

    /// Refuses a value of the wrong type, not finite or outside the range; the text gives `name`, value and range.
    pub fn check(self, name: &str, value: &Value) -> Result<(), String> {
        let outside = |value: String| Err(format!("{name} = {value} is outside its range: {}", self.range()));
        match (self, value) {
            (Kind::Real { min, max, .. }, Value::Real(v)) if !(*v >= min && *v <= max && v.is_finite()) => {
                outside(display_outside(*v, [min, max]))
            }
            (Kind::Integer { min, max }, Value::Integer(v)) if !(min..=max).contains(v) => outside(v.to_string()),
            (Kind::Enumeration(list), Value::Integer(v)) if list.item(*v).is_none() => outside(v.to_string()),
            (Kind::Real { .. }, Value::Real(_))
            | (Kind::Integer { .. } | Kind::Enumeration(_), Value::Integer(_))
            | (Kind::Boolean, Value::Boolean(_))
            | (Kind::String, Value::String(_)) => Ok(()),
            (kind, value) => Err(format!("{name} is {}, not {}", kind.sort(), value.sort())),
        }
    }
}

/// Unit and range that a row gives for its values; a [`Kind`] without them ignores them.
#[derive(Clone, Copy, Debug)]
pub struct ValueLimits {
    /// Unit of numbers.
    pub measure: Measure,
    /// Smallest value.
    pub low: f64,
    /// Largest value.
    pub high: f64,
    /// Usual size.
    pub nominal: f64,
}

impl Default for ValueLimits {
    fn default() -> Self {
        let measure = Measure { unit: "1", display: None };
        Self { measure, low: f64::NEG_INFINITY, high: f64::INFINITY, nominal: 1.0 }
    }
}

/// A type that a row can have.
pub trait RowValue {
    /// Kind of its values.
    fn kind(limits: ValueLimits) -> Kind;
    /// The present value.
    fn read(&self) -> Value;
    /// Takes a value; one of another type changes nothing.
    fn write(&mut self, value: &Value);
}

impl RowValue for f64 {
    fn kind(ValueLimits { measure, low: min, high: max, nominal }: ValueLimits) -> Kind {
        Kind::Real { measure, min, max, nominal }
    }
    fn read(&self) -> Value {
        Value::Real(*self)
    }
    fn write(&mut self, value: &Value) {
        if let Value::Real(value) = value {
            *self = *value;
        }
    }
}

/// A number that may be left unset, which reads as zero.
impl RowValue for Option<f64> {
    fn kind(limits: ValueLimits) -> Kind {
        f64::kind(limits)
    }
    fn read(&self) -> Value {
        Value::Real(self.unwrap_or(0.0))
    }
    fn write(&mut self, value: &Value) {
        if let Value::Real(value) = value {
            *self = Some(*value);
        }
    }
}

impl RowValue for usize {
    fn kind(limits: ValueLimits) -> Kind {
        Kind::Integer { min: limits.low.max(0.0) as i32, max: limits.high as i32 }
    }
    fn read(&self) -> Value {
        Value::Integer(i32::try_from(*self).unwrap_or(i32::MAX))
    }
    fn write(&mut self, value: &Value) {
        if let Value::Integer(value) = value {
            // A negative count is one that no row admits.
            *self = usize::try_from(*value).unwrap_or(usize::MAX);
        }
    }
}

impl RowValue for bool {
    fn kind(_: ValueLimits) -> Kind {
        Kind::Boolean
    }
    fn read(&self) -> Value {
        Value::Boolean(*self)
    }
    fn write(&mut self, value: &Value) {
        if let Value::Boolean(value) = value {
            *self = *value;
        }
    }
}

impl RowValue for String {
    fn kind(_: ValueLimits) -> Kind {
        Kind::String
    }
    fn read(&self) -> Value {
        Value::String(self.clone())
    }
    fn write(&mut self, value: &Value) {
        if let Value::String(value) = value {
            self.clone_from(value);
        }
    }
}

/// Defines an enumeration with the names and meanings of its items, once: the type and its [`RowValue`].
macro_rules! choice {
    (
        $(#[$about:meta])*
        pub enum $Name:ident named $name:literal, $text:literal {
            $( $Item:ident = $item:literal, $meaning:literal; )*
        }
    ) => {
        $(#[$about])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
        pub enum $Name {
            $( #[doc = concat!("`", $item, "`: ", $meaning, ".")] #[serde(rename = $item)] $Item, )*
        }

        impl $crate::config::value::RowValue for $Name {
            fn kind(_: $crate::config::value::ValueLimits) -> $crate::config::value::Kind {
                const LIST: $crate::config::value::Enumeration = $crate::config::value::Enumeration {
                    name: $name,
                    description: $text,
                    items: &[$( ($item, $meaning) ),*],
                };
                $crate::config::value::Kind::Enumeration(&LIST)
            }
            fn read(&self) -> $crate::config::value::Value {
                $crate::config::value::Value::Integer(*self as i32 + 1)
            }
            fn write(&mut self, value: &$crate::config::value::Value) {
                let $crate::config::value::Value::Integer(number) = value else { return };
                if let Some((_, item)) = (1..).zip([$( $Name::$Item ),*]).find(|(i, _)| i == number) {
                    *self = item;
                }
            }
        }
    };
}
pub(crate) use choice;

/// Defines questions to choices, each with the answer for every item: a new item does not compile until it has one.
macro_rules! questions {
    ($( $(#[$about:meta])* $Name:ident: $question:ident { $( $Item:ident => $answer:literal ),* } )*) => { $(
        impl $Name {
            $(#[$about])*
            pub fn $question(self) -> bool {
                match self {
                    $( Self::$Item => $answer, )*
                }
            }
        }
    )* };
}
pub(crate) use questions;
