//! The 75 functions of FMI 3.0: those of co-simulation without events, clocks and structural parameters, and polite refusals
//! of all others, which every library must export (section 2.5 of the standard).

mod export;
mod functions;
mod instantiate;
mod logger;
mod step;
pub mod types;
mod values;

pub use functions::*;
pub use instantiate::{fmi3FreeInstance, fmi3InstantiateCoSimulation, no_instance};
pub use step::fmi3DoStep;
pub use values::*;
