//! Linear solution of one implicit stage: a tridiagonal system per mode and body, coupled through the contact.

pub mod coefficients;
pub mod conductance;
pub mod coupling;
mod decay;
pub mod inverse;
pub mod line_conduction;
pub mod operators;
mod passes;
pub mod response;
mod ring;
pub mod stage;
pub mod transport;
pub mod tridiagonal;
