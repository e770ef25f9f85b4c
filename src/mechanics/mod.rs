//! Deformation of wheel and rail: elasticity, inertia and convection in the streaming frame, per metre of width.

pub mod ale;
pub mod basis;
pub mod elasticity;
pub mod field;
pub mod full;
mod motion;
pub mod reduced;
pub mod reduction;
pub mod response;
pub mod size;
pub mod solver;
pub mod system;
#[cfg(test)]
pub mod testing;

pub use basis::{Basis, BasisError};
pub use full::FullBody;
pub use reduced::ReducedBody;
pub use reduction::ReducedBasis;
pub use response::{BodyResponse, BodyState, Convection, FreeResponse, StepOperator};
pub use size::check_size;
pub use system::BodySystem;

use crate::analytic;
use crate::config::Config;
use crate::fem::graded::GUARDS;
use crate::fem::{self, ContactZone, FemError, Mesh};
use crate::linalg::LinalgError;
use crate::material::Isotropic;
use std::f64::consts::PI;
use std::ops::Range;

/// The deformable bodies cannot be set up or factorised.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MechanicsError {
    /// A mesh with more unknowns than can be dealt with.
    #[error(
        "the mesh of the {body} would have {unknowns:.0} unknowns, more than {limit:.0}: {causes}; choose dimensions of \
         similar size, lower mesh.elements_per_half_width or raise model.nominal_load"
    )]
    TooLarge {
        /// Which body: wheel or rail.
        body: &'static str,
        /// Number of unknown displacements.
        unknowns: f64,
        /// Largest value that is accepted.
        limit: f64,
        /// Parameters on which the size depends, with their values.
        causes: String,
    },
    /// Vibration modes that need more memory than can be given.
    #[error(
        "{parameter} = {modes} modes on a mesh of {unknowns:.0} unknowns would need {memory:.1e} bytes, more than \
         {limit:.1e}: lower {parameter} or mesh.elements_per_half_width"
    )]
    TooManyModes {
        /// Name of the parameter.
        parameter: &'static str,
        /// Its value.
        modes: usize,
        /// Number of unknown displacements.
        unknowns: f64,
        /// Memory needed \[bytes].
        memory: f64,
        /// Largest value that is accepted.
        limit: f64,
    },
    /// Vibration modes that could not be computed.
    #[error("no vibration modes for {parameter} = {modes}: {source}; lower it, or change mesh.elements_per_half_width")]
    Modes {
        /// Name of the parameter.
        parameter: &'static str,
        /// Its value.
        modes: usize,
        /// Why.
        source: LinalgError,
    },
    /// Dimensions on which no mesh can be laid out.
    #[error("no mesh of the {body}: {source}; {advice}")]
    Mesh {
        /// Which body: wheel or rail.
        body: &'static str,
        /// Why.
        source: FemError,
        /// What may help.
        advice: &'static str,
    },
    /// A cell or an assembled matrix without meaning.
    #[error(transparent)]
    Fem(#[from] FemError),
    /// A system of equations without a solution.
    #[error(transparent)]
    Linalg(#[from] LinalgError),
}

/// Both bodies behind their common interface, and the contact grid they share.
pub struct Pair {
    /// The wheel.
    pub wheel: Box<dyn BodyResponse>,
    /// The rail.
    pub rail: Box<dyn BodyResponse>,
    /// x of the paired surface nodes, ascending \[m].
    pub surface_x: Vec<f64>,
    /// Their distance \[m].
    pub spacing: f64,
    /// Surface nodes that can carry contact; the others are guards.
    pub candidates: Range<usize>,
}

/// Builds the bodies: reduced ones from a basis that fits the configuration, full ones without.
///
/// `progress` receives the activity and the share of it done, 0 to 1.
pub fn bodies(
    config: &Config,
    basis: Option<Basis>,
    progress: &mut dyn FnMut(&str, f64),
) -> Result<Pair, MechanicsError> {
    let zone = contact_zone(config);
    let centrifugal = config.physics.centrifugal;
    let (wheel, rail): (Box<dyn BodyResponse>, Box<dyn BodyResponse>) = match basis {
        Some(Basis { wheel, rail, .. }) => (
            Box::new(ReducedBody { basis: wheel, centrifugal }),
            Box::new(ReducedBody { basis: rail, centrifugal: false }),
        ),
        None => {
            progress("assembling the wheel", 0.0);
            let wheel = FullBody::new(wheel_system(config)?, centrifugal)?;
            progress("assembling the rail", 0.5);
            let rail = FullBody::new(rail_system(config)?, false)?;
            progress("assembling the rail", 1.0);
            (Box::new(wheel), Box::new(rail))
        }
    };
    let surface_x = zone.surface_x();
    let candidates = GUARDS..surface_x.len() - GUARDS;
    Ok(Pair { wheel, rail, surface_x, spacing: zone.spacing(), candidates })
}

/// Half-width `a = √(4 P R / (π E*))` \[m] of the Hertzian line contact of a cylinder on a plane of the same material.
///
/// `P` nominal load per metre of width, `1/E* = 2 (1 − ν²)/E`. Source: Johnson, *Contact Mechanics* (1985), eq. 4.43.
pub fn nominal_half_width(config: &Config) -> f64 {
    let load = config.model.nominal_load / config.model.contact_width;
    analytic::hertz_half_width(load, config.wheel.radius, contact_modulus(config))
}

/// Contact modulus of wheel and rail \[Pa].
pub fn contact_modulus(config: &Config) -> f64 {
    Isotropic::from(&config.material).contact_modulus()
}

/// Fine zone of the meshes for the nominal load.
pub fn contact_zone(config: &Config) -> ContactZone {
    ContactZone { half_width: nominal_half_width(config), elements: config.mesh.elements_per_half_width }
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

/// Mesh of the wheel; an error that names parameters if it were too large, see [`check_size`].
pub fn wheel_mesh(config: &Config) -> Result<Mesh, MechanicsError> {
    check_size(config)?;
    let mesh = fem::graded::wheel(config.wheel.radius, config.wheel.hub_radius, contact_zone(config));
    mesh.map_err(|source| size::unmeshable("wheel", source))
}

/// Mesh of the rail; an error that names parameters if it were too large, see [`check_size`].
pub fn rail_mesh(config: &Config) -> Result<Mesh, MechanicsError> {
    check_size(config)?;
    let rail = &config.rail;
    let mesh = fem::graded::rail(rail.length, rail.height, largest_rail_cell(config), contact_zone(config));
    mesh.map_err(|source| size::unmeshable("rail", source))
}

/// Largest cells of the rail [m]: as large as those of the wheel, or 1/150 of a very long rail.
pub(super) fn largest_rail_cell(config: &Config) -> f64 {
    (0.05 * config.wheel.radius).max(config.rail.length / 150.0)
}

/// Finite-element matrices of the wheel.
pub fn wheel_system(config: &Config) -> Result<BodySystem, MechanicsError> {
    Ok(BodySystem::assemble(&wheel_mesh(config)?, &config.material, ale::Stream::Rotation)?)
}

/// Finite-element matrices of the rail.
pub fn rail_system(config: &Config) -> Result<BodySystem, MechanicsError> {
    Ok(BodySystem::assemble(&rail_mesh(config)?, &config.material, ale::Stream::Translation)?)
}
