//! FMI 2.0 and 3.0 co-simulation around [`crate::simulation`]: one table of variables, everything else follows from it.
//!
//! `table` (every variable once) → `settings` (values that a master has set) → `instance` (the wheel as a slave),
//! `snapshot` (its states as bytes) → `description` (what both descriptions say alike) → `v2` and `v3` (variables,
//! description and the exported C functions of each version) → `interface` (which of them a packed FMU has); `reference`
//! (Markdown). The crate `wheelrail-pack` makes the archive of it. Life cycle, log, states and C functions are those of the crate [`wheelrail_slave`].
//!
//! Sources of all rules: *Functional Mock-up Interface for Model Exchange and Co-Simulation*, version 2.0.4; *Functional
//! Mock-up Interface Specification*, version 3.0.2.

pub mod description;
pub mod instance;
pub mod interface;
pub mod presets;
pub mod reference;
pub mod settings;
pub mod snapshot;
pub mod table;
pub mod v2;
pub mod v3;
pub mod variable;

pub use crate::config::units;
pub use wheelrail_slave::{lifecycle, log};

/// Name of the shared library and prefix of everything that belongs to this FMU.
pub const MODEL_IDENTIFIER: &str = "wheelrail";
