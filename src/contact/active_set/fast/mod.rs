//! Shortcuts of the active set: without them every result is the same but for round-off, and takes longer.
//!
//! [`initial_guess`] can go alone; [`alternating`] with its equations [`pressure_shear`]; [`patch_inverse`], which both
//! use, last.

pub mod alternating;
pub mod initial_guess;
pub mod patch_inverse;
pub mod pressure_shear;
