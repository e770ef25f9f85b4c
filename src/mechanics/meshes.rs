//! Meshes and finite-element matrices of both bodies for a configuration.

use super::ale::Stream;
use super::error::MechanicsError;
use super::layout::largest_rail_cell;
use super::size::{check_size, contact_zone, unmeshable};
use super::system::BodySystem;
use crate::config::{Config, RailEnds};
use crate::fem::{Mesh, graded};

/// Mesh of the wheel; an error that names parameters if it were too large, see [`check_size`].
pub fn wheel_mesh(config: &Config) -> Result<Mesh, MechanicsError> {
    check_size(config)?;
    let mesh = graded::wheel(config.wheel.radius, config.wheel.hub_radius, contact_zone(config));
    mesh.map_err(|source| unmeshable("wheel", source))
}

/// Mesh of the rail; an error that names parameters if it were too large, see [`check_size`].
pub fn rail_mesh(config: &Config) -> Result<Mesh, MechanicsError> {
    check_size(config)?;
    let rail = &config.rail;
    let mesh = graded::rail(rail.length, rail.height, largest_rail_cell(config), contact_zone(config));
    let mut mesh = mesh.map_err(|source| unmeshable("rail", source))?;
    match rail.ends {
        RailEnds::Fixed => mesh.fix_ends(),
        RailEnds::Free | RailEnds::Nonreflecting => {}
    }
    Ok(mesh)
}

/// Finite-element matrices of the wheel.
pub fn wheel_system(config: &Config) -> Result<BodySystem, MechanicsError> {
    Ok(BodySystem::assemble(&wheel_mesh(config)?, &config.material, Stream::Rotation)?)
}

/// Finite-element matrices of the rail.
pub fn rail_system(config: &Config) -> Result<BodySystem, MechanicsError> {
    let (mesh, material, stream) = (rail_mesh(config)?, &config.material, Stream::Translation);
    let system = BodySystem::assemble(&mesh, material, stream)?;
    Ok(match config.rail.ends {
        RailEnds::Fixed => system,
        RailEnds::Free => system.with_free_ends(&mesh, material, stream)?,
        RailEnds::Nonreflecting => system.with_quiet_ends(&mesh, material, stream)?,
    })
}
