//! Contact on a single smooth patch: tractions as series that fit the patch and the part of it that sticks.
//!
//! [`kernels`] has the series and what they do to a half-plane, [`tables`] and [`constants`] their constants, [`surface`] what
//! the bodies add, [`warmth`] what hot layers do, [`press`] solves the normal problem, [`slip`] a given stretch of stick,
//! [`stick`] finds where slip begins, [`conclude`] takes traction and power, [`transfer`] leads to the grid and back, and
//! [`solver`] decides between the two. Theory: `docs/theory/patch-contact.md`.

mod conclude;
mod constants;
mod iterate;
pub mod kernels;
mod press;
mod slip;
mod solver;
pub(super) mod state;
mod stick;
mod surface;
mod tables;
mod transfer;
mod warmth;

pub use kernels::{Arch, HalfPlane};
pub use solver::PatchSolver;
pub use state::{Past, PatchState, SlipHistory, Tractions};
