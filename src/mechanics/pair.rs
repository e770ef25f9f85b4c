//! Wheel and rail together, as the configuration wants them.

use super::basis::Basis;
use super::damping::BodyDamping;
use super::error::MechanicsError;
use super::full::FullBody;
use super::layout::{grid_cells_per_element, grid_spacing};
use super::meshes::{rail_system, wheel_system};
use super::motion::BodyResponse;
use super::reduced::ReducedBody;
use super::reduction::ReducedBasis;
use super::refined::divided;
use super::size::contact_zone;
use crate::config::Config;
use crate::fem::graded::GUARDS;
use crate::linalg::Lagrange;
use crate::material::Isotropic;
use std::ops::Range;

/// Both bodies, less half-planes, behind their common interface, and the contact grid they share. Their ports are the
/// displacements at the points of a polynomial.
pub struct Pair {
    /// The wheel.
    pub wheel: Box<dyn BodyResponse>,
    /// The rail.
    pub rail: Box<dyn BodyResponse>,
    /// Half of the length over which the polynomials are fitted \[m].
    pub reach: f64,
    /// x of the nodes on which contact is looked for, ascending \[m].
    pub surface_x: Vec<f64>,
    /// Their distance in the middle \[m].
    pub spacing: f64,
    /// Nodes that can carry contact; the others are guards.
    pub candidates: Range<usize>,
    /// Half of the length of the middle, in which nodes have one distance \[m].
    pub zone: f64,
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
    let half_plane = Isotropic::from(&config.material).half_plane();
    let centrifugal = config.physics.centrifugal;
    let damping = [BodyDamping::wheel(config), BodyDamping::rail(config)];
    let (surface_x, wing) = (zone.surface_x(), zone.wing_nodes());
    let core = wing..surface_x.len() - wing;
    let ports = 2 * core.start..2 * core.end;
    type TwoBodies = [Box<dyn BodyResponse>; 2];
    let retarded = damping.iter().any(|damping| damping.stiffness > 0.0);
    let x = &surface_x[core.clone()];
    let reach = x[x.len() - 1 - GUARDS];
    let points = Lagrange::new(reach);
    let basis = basis.unwrap();
    let part = |body: &ReducedBasis, side| body.cut(ports.clone()).smooth(x, &points, half_plane, side).unwrap();
    let wheel = ReducedBody::new(part(&basis.wheel, 1.0), centrifugal, &damping[0]);
    let rail = ReducedBody::new(part(&basis.rail, -1.0), false, &damping[1]);
    let parts = grid_cells_per_element(config);
    let zone = divided(x, parts);
    let zone = zone[zone.len() - 1 - GUARDS];
    let surface_x = divided(&surface_x, parts);
    let candidates = GUARDS..surface_x.len() - GUARDS;
    Ok(Pair { wheel: Box::new(wheel), rail: Box::new(rail), reach, surface_x, spacing: grid_spacing(config), candidates, zone })
}
