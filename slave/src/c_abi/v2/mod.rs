//! The 34 functions of FMI 2.0 co-simulation.

mod export;
mod functions;
mod instantiate;
mod logger;
mod marshal;
pub mod types;
mod values;

pub use functions::*;
pub use instantiate::{fmi2FreeInstance, fmi2Instantiate};
pub use values::*;
