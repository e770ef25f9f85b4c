//! FMI 2.0 co-simulation around [`crate::simulation`]: one table of variables, everything else follows from it.
//!
//! `table` (every variable once) → `settings` (values that a master has set) → `instance` (the wheel as a slave),
//! `snapshot` (its states as bytes) → `v2` (scalar variables, description, GUID and the exported C functions) →
//! `documentation` and `pages` (HTML), `reference` (Markdown) and `package`, which zips the FMU. HTML and archive are
//! there with the feature `program` only: the library inside an FMU needs neither. Life cycle, log, states and C
//! functions are those of the crate [`wheelrail_slave`].
//!
//! Source of all rules: *Functional Mock-up Interface for Model Exchange and Co-Simulation*, version 2.0.4.

#[cfg(feature = "program")]
pub mod documentation;
pub mod instance;
#[cfg(feature = "program")]
pub mod package;
#[cfg(feature = "program")]
pub mod pages;
pub mod presets;
pub mod reference;
pub mod settings;
pub mod snapshot;
pub mod table;
pub mod v2;
pub mod variable;

pub use crate::config::units;
pub use wheelrail_slave::{lifecycle, log};

/// Name of the shared library and prefix of everything that belongs to this FMU.
pub const MODEL_IDENTIFIER: &str = "wheelrail";
