//! A four-axle coach with its brakes as a co-simulation FMU: the vehicle beside the wheels of `wheelrail.fmu`.
//!
//! `parameters` (the table) → `vehicle` (equations of motion) and `brake` (cylinders, wheel slide protection) → `coupling`
//! (one communication step) → [`fmi`], whose C functions, life cycle and messages are the files of `wheelrail` itself.
//! It computes what the Python package computes with `vehicle.py` and `brake.py`; `fmpy_tests/test_ssp.py` compares both.

#![deny(unsafe_code, missing_docs)]

pub mod brake;
pub mod coupling;
pub mod fmi;
pub mod parameters;
pub mod vehicle;

/// Number of axles.
pub const AXLES: usize = 4;
