//! Memory that runs ask for.

#[path = "../common/mod.rs"]
mod common;
#[path = "../heap/mod.rs"]
mod heap;
#[path = "../heat_common/mod.rs"]
mod heat_common;

mod allocations;
mod body_allocations;
mod declared_ranges;
mod heat_allocations;
