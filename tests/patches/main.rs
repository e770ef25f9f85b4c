//! Contact lines side by side: ellipses, other patches, lateral creepage and spin, wheelsets.

#[path = "../common/mod.rs"]
mod common;
#[path = "../half_spaces/mod.rs"]
mod half_spaces;

mod elliptical_convergence;
mod elliptical_drop;
mod elliptical_patch;
mod elliptical_states;
mod elliptical_transients;
mod elliptical_waves;
mod elliptical_wheel;
mod patch_flats;
mod patch_heat;
mod patch_loads;
mod patch_rows;
mod patch_slides;
mod sideways;
mod sideways_friction;
mod sideways_hot;
mod sideways_transients;
mod sideways_wheel;
mod wheelset;
