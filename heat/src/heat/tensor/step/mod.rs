//! A step in time: loads, time formula, flows, bounds; and the stationary state.

pub mod arrival;
pub mod bounds;
pub mod flows;
pub mod formula;
pub mod limiter;
pub mod load_vector;
pub mod loads;
pub mod memory;
mod plan;
pub mod sources;
pub mod stationary;
