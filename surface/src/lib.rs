//! Surfaces of a wheel and of the rail that it rolls on.
//!
//! | room | content |
//! |---|---|
//! | [`files`] | reading of regular files of bounded size, tables of numbers |
//! | [`surface`] | shapes of both surfaces: files, waves, roughness, holes, joints, flats; dents; wear |
//!
//! `wheelrail` has these rooms under the same names. SI units everywhere. Theory: `docs/theory/profiles.md`.
#![deny(unsafe_code)]
#![warn(missing_docs)]

pub mod files;
pub mod surface;

use wheelrail_contact::contact;
use wheelrail_numerics::{display, piecewise};
