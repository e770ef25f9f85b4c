//! What belongs to FMI 2.0 alone: the model description and the exported C functions.

#[path = "../../../../src/fmi/v2/c_abi/mod.rs"]
pub mod c_abi;
pub mod description;
