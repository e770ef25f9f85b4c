//! The contact: closed forms of half-planes, stationary and transient rolling, several patches of a line.

#[path = "../common/mod.rs"]
mod common;
#[path = "../half_planes/mod.rs"]
mod half_planes;

mod cattaneo_carter;
mod contact_filter;
mod contact_half_plane;
mod contact_lines;
mod contact_patch;
mod contact_two_patches;
mod elastic_layer;
mod equivalent_width;
mod falling_friction;
mod light_braking;
mod locked_half_plane;
mod opposed_rolling;
mod sharp_edges;
mod stationary_rolling;
mod time_order;
mod transient_rolling;
mod wide_patches;
