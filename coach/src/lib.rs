//! A four-axle coach with its brakes as a co-simulation FMU: the vehicle beside the wheels of `wheelrail.fmu`.
//!
//! `parameters` (the table) → `vehicle` (equations of motion) and `brake` (cylinders, wheel slide protection) →
//! `coupling` (one communication step) → [`fmi`], the coach as a slave: life cycle, messages and C functions are those
//! of the crate [`wheelrail_slave`]. It has the equations of `vehicle.py` and `brake.py` in the Python
//! package, which needs them for more than an FMU can offer; `fmpy_tests/test_coach_fmu.py` ties both to rounding.

#![deny(unsafe_code, missing_docs)]

pub mod brake;
pub mod coupling;
pub mod fmi;
pub mod parameters;
pub mod vehicle;

/// Number of axles.
pub const AXLES: usize = 4;
