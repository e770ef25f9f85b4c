//! Numerics of a wheel that rolls on a rail and of its contact; SI units everywhere.
//!
//! | room | content |
//! |---|---|
//! | [`analytic`] | Hertz, Carter and other closed forms: start guesses and tests |
//! | [`multistep`] | the time formula: derivative, history, impulse |
//! | [`piecewise`] | piecewise linear functions: profiles, nodal values, inputs over time |
//! | [`lru`] | what is expensive to compute, kept for the steps that share it |
//! | [`axes`] | axes of the rigid motion of the wheel, and what has a value for each |
//! | [`display`] | numbers, their ranges and names like a misspelt one in messages |
//! | [`linalg`] | sparse factorisation, vibration modes, GMRES, loops for vector registers |
//! | [`fem`] | streamline-aligned graded meshes, elements, assembly |
//!
//! `wheelrail` has these rooms under the same names; it and the crates of contact, heat, bodies and surfaces are their users so far.
#![deny(unsafe_code)]
#![warn(missing_docs)]

pub mod analytic;
pub mod axes;
pub mod display;
pub mod fem;
pub mod linalg;
pub mod lru;
pub mod multistep;
pub mod piecewise;

/// The crate of the vector registers, for functions that [`vectorised!`] defines elsewhere.
#[doc(hidden)]
pub use pulp;
