//! What belongs to FMI 2.0 alone: the model description and the exported C functions.
//!
//! Everything else of [`crate::fmi`] knows variables, values and phases of life, which other versions share.

pub mod c_abi;
pub mod description;
