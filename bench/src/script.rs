//! Changes of a run, as they stand in links.

use crate::link::{LinkError, condition, number};
use crate::rail::Condition;
use std::fmt;

/// One change between two steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Change {
    /// Torque of the brake [kN m].
    Torque(f64),
    /// Load \[kN].
    Load(f64),
    /// The brake holds whatever comes.
    Lock,
    /// The brake goes back to the torque that was set last.
    Release,
    /// The speed stays what it is.
    Hold,
    /// The wheel and its share of the vehicle coast.
    Coast,
    /// Another rail begins ahead of the wheel.
    Rail(Condition),
}

impl Change {
    /// Reads a change; `None` if it is no such word.
    ///
    /// # Errors
    /// A value out of its range.
    pub fn parse(text: &str) -> Result<Option<Self>, LinkError> {
        Ok(Some(match text.split_once('=') {
            Some(("torque", value)) => Self::Torque(number("torque", value)?),
            Some(("load", value)) => Self::Load(number("load", value)?),
            Some(("rail", value)) => Self::Rail(condition(value)?),
            Some(_) => return Ok(None),
            None => match text {
                "lock" => Self::Lock,
                "release" => Self::Release,
                "hold" => Self::Hold,
                "coast" => Self::Coast,
                _ => return Ok(None),
            },
        }))
    }
}

impl fmt::Display for Change {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Torque(value) => write!(f, "torque={value}"),
            Self::Load(value) => write!(f, "load={value}"),
            Self::Lock => write!(f, "lock"),
            Self::Release => write!(f, "release"),
            Self::Hold => write!(f, "hold"),
            Self::Coast => write!(f, "coast"),
            Self::Rail(condition) => write!(f, "rail={}", condition.name()),
        }
    }
}
