//! Temperature of a wheel and a rail that roll and slide on each other: boundary layers, conductance, brakes, air, melting.
//!
//! Its only room is [`heat`], which `wheelrail` has under the same name; it begins with [`heat::HeatModel`] and
//! [`heat::HeatParameters`]. SI units everywhere. Theory: `docs/theory/heat.md`.
#![deny(unsafe_code)]
#![warn(missing_docs)]

pub mod heat;

use wheelrail_numerics::{display, fem, linalg, lru, piecewise};
