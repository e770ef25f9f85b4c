//! Temperature of a wheel and a rail that roll and slide on each other, and what it does to the steel.
//!
//! | room | content |
//! |---|---|
//! | [`heat`] | temperature of both bodies behind [`heat::HeatModel`]: boundary layers, conductance, brakes, air, melting |
//! | [`damage`] | history of hot places of the tread, structure of the steel |
//!
//! `wheelrail` has these rooms under the same names. SI units everywhere. Theory: `docs/theory/heat.md` and
//! `docs/theory/material-history.md`.
#![deny(unsafe_code)]
#![warn(missing_docs)]

pub mod damage;
pub mod heat;

use wheelrail_numerics::{display, fem, linalg, lru, piecewise};
