//! FMI 2.0 co-simulation around [`crate::simulation`]: one table of variables, everything else follows from it.
//!
//! `table` (every variable once) → `variables` (scalars) → `instance` (the safe slave with the rules of `lifecycle`),
//! `snapshot` (its states as bytes) → `v2` (description, GUID and the exported C functions, the only `unsafe`) →
//! `documentation` and `pages` (HTML), `reference` (Markdown) and `package`, which zips the FMU.
//!
//! Source of all rules: *Functional Mock-up Interface for Model Exchange and Co-Simulation*, version 2.0.4.

pub mod documentation;
pub mod instance;
pub mod lifecycle;
pub mod log;
pub mod package;
pub mod pages;
pub mod presets;
pub mod reference;
pub mod settings;
pub mod snapshot;
pub mod table;
pub mod uri;
pub mod v2;
pub mod variable;
pub mod variables;

pub use crate::config::units;

/// Name of the shared library and prefix of everything that belongs to this FMU.
pub const MODEL_IDENTIFIER: &str = "wheelrail";
