//! The part of an FMI 2.0 co-simulation slave that does not depend on its model.
//!
//! A crate implements [`Slave`] and [`ScalarAccess`] for its model and exports the C functions of the standard with
//! [`export_fmi2!`]. Around the model stands an [`Instance`]: it knows the phase of life, the communication point and
//! the log, refuses calls that are illegal or out of range, and leaves everything as it was when a call is refused.
//!
//! | module | content |
//! |---|---|
//! | [`lifecycle`] | phases of life, and the calls that are legal in each |
//! | [`log`] | status, categories, messages to the master, errors of calls |
//! | [`value`] | value references and the four types of values |
//! | [`aside`] | long computations on a thread of their own |
//! | [`life`], [`instance`] | the state that all slaves share; the traits of a model and the instance around it |
//! | [`snapshot`] | saved states, their layout as text and their container of bytes |
//! | [`uri`] | the path that a resource location means |
//! | [`c_abi`] | the 34 C functions, the only `unsafe` code |
//!
//! Source of all rules: *Functional Mock-up Interface for Model Exchange and Co-Simulation*, version 2.0.4.

#![deny(unsafe_code, missing_docs)]

pub mod aside;
pub mod c_abi;
pub mod instance;
pub mod life;
pub mod lifecycle;
pub mod log;
pub mod snapshot;
pub mod uri;
pub mod value;

pub use instance::{Instance, ScalarAccess, Slave};
pub use life::Life;
pub use log::{CallError, Log, Outcome, Status};
pub use snapshot::Snapshot;
pub use value::{Reference, Scalar, Type};
