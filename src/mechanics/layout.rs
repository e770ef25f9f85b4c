//! Patch, fine zone, cells and masses, as they follow from the parameters without a mesh.

use crate::config::{Config, MeshParameters, Response};
use crate::fem::ContactZone;
use crate::surface;
use std::f64::consts::PI;

/// Half of the length of the contact under the nominal load along the direction of rolling \[m].
pub fn nominal_half_width(config: &Config) -> f64 {
    config.nominal_patch().half_length
}

/// Finite elements per half-width of the nominal contact: full bodies take the forces of contact nodes as nodal loads,
/// and thus have one for each.
fn elements(config: &Config) -> usize {
    let MeshParameters { elements_per_half_width, grid_elements_per_half_width, .. } = config.mesh;
    match config.solver.response {
        Response::Reduced => elements_per_half_width,
        Response::Full => elements_per_half_width.max(grid_elements_per_half_width),
    }
}

/// Cells of the contact grid in every element of the surface.
pub fn grid_cells_per_element(config: &Config) -> usize {
    config.mesh.grid_elements_per_half_width.div_ceil(elements(config)).max(1)
}

/// Distance of the nodes of the contact grid under the nominal load \[m].
pub fn grid_spacing(config: &Config) -> f64 {
    nominal_half_width(config) / (elements(config) * grid_cells_per_element(config)) as f64
}

/// Distance from the contact point up to which surface nodes are paired, in nominal half-widths: patches of softened
/// steel grow to about 3.5 of them within two seconds of sliding, and thermal expansion may move them.
const REACH: f64 = 6.0;
/// Largest such distance, in radii of the wheel, thicknesses of its rim, lengths and heights of the rail: the heat
/// model has room for it.
const SHARES: [f64; 4] = [0.19, 1.5, 0.22, 1.5];

/// Half-widths beyond the edges of flats, on which a patch may lie.
const BEYOND_FLAT: f64 = 1.0;

/// Fine zone of the meshes for the nominal load, with wings for wider patches where the bodies have room for them.
pub(super) fn winged_zone(config: &Config) -> ContactZone {
    let half_width = nominal_half_width(config);
    let (radius, rail) = (config.wheel.radius, &config.rail);
    let lengths = [radius, radius - config.wheel.hub_radius, rail.length, rail.height];
    let most = SHARES.iter().zip(lengths).map(|(share, length)| share * length).fold(f64::INFINITY, f64::min);
    let reach = most.min(REACH * half_width);
    let mut zone = ContactZone { half_width, elements: elements(config), reach };
    while zone.reach < most && zone.end_of_candidates() < wanted_reach(config) {
        zone.reach = most.min(zone.reach + half_width);
    }
    zone
}

/// Distance from the contact point up to which contact is to be looked for at least \[m]: what the parameters ask for,
/// and the edges of the longest flat of the wheel.
fn wanted_reach(config: &Config) -> f64 {
    let flat = surface::longest_flat(&config.wheel.profile);
    let of_flat = if flat > 0.0 { 0.5 * flat + BEYOND_FLAT * nominal_half_width(config) } else { 0.0 };
    config.mesh.reach.max(of_flat)
}

/// Mass of the wheel `ρ π (r_o² − r_i²)` [kg/m], exact for the circle.
pub fn wheel_mass(config: &Config) -> f64 {
    let (outer, inner) = (config.wheel.radius, config.wheel.hub_radius);
    config.material.density * PI * (outer * outer - inner * inner)
}

/// Polar moment of inertia of the wheel `½ ρ π (r_o⁴ − r_i⁴)` [kg m²/m], exact for the circle.
pub fn wheel_inertia(config: &Config) -> f64 {
    0.5 * config.material.density * PI * (config.wheel.radius.powi(4) - config.wheel.hub_radius.powi(4))
}

/// Largest cells of the rail [m]: as large as those of the wheel, or 1/150 of a very long rail.
pub(super) fn largest_rail_cell(config: &Config) -> f64 {
    (0.05 * config.wheel.radius).max(config.rail.length / 150.0)
}
