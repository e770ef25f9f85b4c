//! Interfaces of the FMU: the library has both, a packed FMU one of them.

use super::v2::description::{self as description2, Extent};
use super::v3::description as description3;
use std::io;

/// Interface of a packed FMU.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interface {
    /// FMI 2.0, with the extent of its description.
    Two(Extent),
    /// FMI 3.0.
    Three,
}

impl Interface {
    /// Version of the standard.
    pub fn version(self) -> &'static str {
        match self {
            Interface::Two(_) => "2.0",
            Interface::Three => "3.0",
        }
    }

    /// Identity of the description: its GUID in FMI 2.0, the instantiation token in FMI 3.0.
    pub fn identity(self) -> String {
        match self {
            Interface::Two(_) => description2::guid(),
            Interface::Three => description3::token(),
        }
    }

    /// The file `modelDescription.xml`.
    pub fn description(self) -> io::Result<String> {
        match self {
            Interface::Two(extent) => description2::model_description(extent),
            Interface::Three => description3::model_description(),
        }
    }
}
