//! Deformable wheel and rail: elasticity, inertia and convection in the streaming frame, per metre of width.
//!
//! | room | content |
//! |---|---|
//! | [`material`] | moduli, wave speeds, diffusivity: constants that follow from the parameters |
//! | [`mechanics`] | bodies: [`mechanics::BodyResponse`], of [`mechanics::BodyParameters`] |
//!
//! `wheelrail` has these rooms under the same names. SI units everywhere. Theory: `docs/theory/ale-balance.md`,
//! `docs/theory/condensation.md`, `docs/theory/damping.md`, `docs/theory/rail-ends.md`.
#![deny(unsafe_code)]
#![warn(missing_docs)]

pub mod material;
pub mod mechanics;

use wheelrail_numerics::{analytic, axes, display, fem, linalg, multistep, piecewise};
