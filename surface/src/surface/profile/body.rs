//! Bodies that carry a profile.

use std::f64::consts::TAU;

/// Body that carries a profile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Body {
    /// The rail: positions are distances along it, without end.
    Rail,
    /// The tread of the wheel: positions are angle times radius and repeat after the circumference.
    Wheel {
        /// Radius of the wheel \[m].
        radius: f64,
    },
}

impl Body {
    /// Position after which the surface repeats \[m], if it does.
    pub fn circumference(self) -> Option<f64> {
        match self {
            Self::Rail => None,
            Self::Wheel { radius } => Some(TAU * radius),
        }
    }
}
