//! Wheel and rail together, as the configuration wants them.

use super::basis::Basis;
use super::damping::BodyDamping;
use super::error::MechanicsError;
use super::full::FullBody;
use super::layout::contact_zone;
use super::meshes::{rail_system, wheel_system};
use super::reduced::ReducedBody;
use super::response::BodyResponse;
use crate::config::Config;
use crate::fem::graded::GUARDS;
use std::ops::Range;

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
    let damping = [BodyDamping::wheel(config), BodyDamping::rail(config)];
    let (wheel, rail): (Box<dyn BodyResponse>, Box<dyn BodyResponse>) = match basis {
        Some(Basis { wheel, rail, .. }) => (
            Box::new(ReducedBody::new(wheel, centrifugal, &damping[0])),
            Box::new(ReducedBody::new(rail, false, &damping[1])),
        ),
        None => {
            progress("assembling the wheel", 0.0);
            let counts = [config.solver.modes_wheel, config.solver.modes_rail];
            let wheel = FullBody::damped(wheel_system(config)?, centrifugal, &damping[0], counts[0])?;
            progress("assembling the rail", 0.5);
            let rail = FullBody::damped(rail_system(config)?, false, &damping[1], counts[1])?;
            progress("assembling the rail", 1.0);
            (Box::new(wheel), Box::new(rail))
        }
    };
    let surface_x = zone.surface_x();
    let candidates = GUARDS..surface_x.len() - GUARDS;
    Ok(Pair { wheel, rail, surface_x, spacing: zone.spacing(), candidates })
}
