//! FMI 2.0: its scalar variables, the model description, the wheel as a slave, and the exported C functions.
//!
//! Everything else of [`crate::fmi`] knows rows of the table, arrays among them, which other versions share.

pub mod access;
pub mod c_abi;
pub mod description;

pub mod variables;
