//! Shortcuts of the active set: code without which every result is the same and only takes longer.

mod alternating;
mod initial_guess;
pub(super) mod patch_inverse;
pub(super) mod pressure_shear;
