//! Contact of a wheel that rolls on a rail: exact Coulomb friction on lines side by side, under creepages and spin.
//!
//! | room | content |
//! |---|---|
//! | [`half_spaces`] | half-spaces that touch in a strip or an ellipse, from a few numbers: begin here |
//! | [`contact`] | the contact problem itself, its solver, friction laws, limits of the steel; what bodies of one's own need |
//! | [`patch`] | closed forms of the elliptical patch and of the lines that stand for it |
//! | [`axes`] | axes of the rigid motion of the wheel, and what has a value for each |
//!
//! SI units; x points in travel direction, y up. Forces are those on the wheel: a positive one along drives it. A
//! positive creepage along, `ξ = 2 (V − rΩ)/(V + rΩ)`, brakes it. An example is `contact/examples/strip.rs`, a page
//! about the crate `docs/contact-crate.md`, its theory `docs/theory/contact.md` and `docs/theory/lines.md`.
#![deny(unsafe_code)]
#![warn(missing_docs)]

pub mod contact;
pub mod half_spaces;
pub mod patch;

pub use contact::{ContactError, Friction, FrictionLaw, Traction};
pub use half_spaces::{Creepages, ElasticMaterial, RollingContact, RollingStep};
pub use wheelrail_numerics::{self as numerics, axes};

use wheelrail_numerics::{analytic, linalg, multistep, piecewise};
