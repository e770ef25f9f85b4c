//! FMI 2.0 co-simulation around [`crate::coupling`]. The C functions, the rules of the life cycle, messages and URIs are the
//! files of `wheelrail`, compiled against the slave of this crate: what they ask for stands here under the same names.

pub mod instance;
#[path = "../../../src/fmi/lifecycle.rs"]
pub mod lifecycle;
#[path = "../../../src/fmi/log.rs"]
pub mod log;
pub mod snapshot;
#[path = "../../../src/fmi/uri.rs"]
pub mod uri;
pub mod v2;
pub mod variable;
pub mod variables;

/// Name of the shared library.
pub const MODEL_IDENTIFIER: &str = "coach";
