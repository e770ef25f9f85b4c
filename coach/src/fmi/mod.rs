//! FMI 2.0 and 3.0 co-simulation around [`crate::coupling`]: variables, the coach as a slave, model description, C functions.

pub mod c_abi;
pub mod description;
pub mod slave;
pub mod variable;
pub mod variables;

/// Name of the shared library.
pub const MODEL_IDENTIFIER: &str = "coach";
