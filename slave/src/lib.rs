//! The part of a slave of co-simulation, FMI 2.0 and 3.0, that does not depend on its model.
//!
//! A crate implements [`Slave`] for its model, with [`ScalarAccess`] for FMI 2.0 and [`ArrayAccess`] for FMI 3.0, and exports
//! the C functions of either standard with [`export_fmi2!`] and [`export_fmi3!`]. Around the model stands an [`Instance`]: it knows the phase of life, the communication point and
//! the log, refuses calls that are illegal or out of range, and leaves everything as it was when a call is refused.
//!
//! | module | content |
//! |---|---|
//! | [`lifecycle`] | phases of life, and the calls that are legal in each |
//! | [`log`] | status, categories, messages to the master, errors of calls |
//! | [`value`] | value references and the types of values |
//! | [`aside`] | long computations on a thread of their own |
//! | [`life`], [`instance`] | the state that all slaves share; the trait of a model and the instance around it |
//! | [`array_access`] | access through arrays, as FMI 3.0 has it |
//! | [`course`], [`intermediate`] | courses of inputs within a step; how a master is asked for their values |
//! | [`snapshot`] | saved states, their layout as text and their container of bytes |
//! | [`uri`] | the path that a resource location means |
//! | [`c_abi`] | the C functions of both versions, the only `unsafe` code |
//!
//! Sources of all rules: *Functional Mock-up Interface for Model Exchange and Co-Simulation*, version 2.0.4; *Functional
//! Mock-up Interface Specification*, version 3.0.2.

#![deny(unsafe_code, missing_docs)]

pub mod array_access;
pub mod aside;
pub mod c_abi;
pub mod course;
pub mod instance;
pub mod intermediate;
pub mod life;
pub mod lifecycle;
pub mod log;
pub mod snapshot;
pub mod uri;
pub mod value;

pub use array_access::ArrayAccess;
pub use instance::{Instance, ScalarAccess, Slave};
pub use life::Life;
pub use log::{CallError, Log, Outcome, Status};
pub use snapshot::Snapshot;
pub use value::{ElementType, Reference, Scalar, Type};
