//! Wheel and rail together, as their parameters want them.

use super::basis::Basis;
use super::error::MechanicsError;
use super::full::FullBody;
use super::meshes::{rail_system, wheel_system};
use super::motion::BodyResponse;
use super::parameters::BodyParameters;
use super::reduced::ReducedBody;
use super::size::contact_zone;
use super::smooth::SmoothPorts;
use crate::fem::graded::GUARDS;
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
    /// Half of the length of the middle in which ordinary patches lie \[m]: nodes have one distance there.
    pub zone: f64,
}

/// Builds the bodies: reduced ones from a basis that fits them, full ones without.
///
/// `progress` receives the activity and the share of it done, 0 to 1.
pub fn bodies(
    c: &BodyParameters,
    basis: Option<Basis>,
    progress: &mut dyn FnMut(&str, f64),
) -> Result<Pair, MechanicsError> {
    let zone = contact_zone(c);
    let (elements, wing, parts) = (zone.surface_x(), zone.wing_nodes(), c.grid_cells_per_element());
    let points = SmoothPorts::new(&elements)?;
    let half_plane = c.material.half_plane();
    let (damping, centrifugal) = (&c.damping, c.centrifugal);
    // The wheel lies above its surface, the rail below.
    let [above, below] = [1.0, -1.0];
    let [wheel, rail]: [Box<dyn BodyResponse>; 2] = match basis {
        Some(Basis { wheel, rail, .. }) => [
            Box::new(ReducedBody::new(wheel.smooth(&points, half_plane, above), centrifugal, &damping[0])),
            Box::new(ReducedBody::new(rail.smooth(&points, half_plane, below), false, &damping[1])),
        ],
        None => {
            progress("assembling the wheel", 0.0);
            let wheel = FullBody::damped(wheel_system(c)?, centrifugal, &damping[0], c.modes[0])?;
            progress("assembling the rail", 0.5);
            let rail = FullBody::damped(rail_system(c)?, false, &damping[1], c.modes[1])?;
            progress("assembling the rail", 1.0);
            [Box::new(wheel.smooth(&points, half_plane, above)?), Box::new(rail.smooth(&points, half_plane, below)?)]
        }
    };
    let surface_x = divided(&elements, parts);
    let zone = surface_x[surface_x.len() - 1 - parts * wing - GUARDS];
    let candidates = GUARDS..surface_x.len() - GUARDS;
    Ok(Pair { wheel, rail, reach: points.basis.reach, surface_x, spacing: c.grid_spacing(), candidates, zone })
}

/// The nodes `x` \[m], ascending, and those that divide every cell between them into `parts` equal ones: contact needs nodes
/// closer than the bodies do.
fn divided(x: &[f64], parts: usize) -> Vec<f64> {
    let between = |pair: &[f64]| -> Vec<f64> {
        (0..parts).map(|k| pair[0] + (pair[1] - pair[0]) * k as f64 / parts as f64).collect()
    };
    x.windows(2).flat_map(between).chain(x.last().copied()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_division_of_cells_keeps_all_nodes() {
        let x = [-3.0, -1.5, -0.5, 0.0, 0.5, 1.5, 3.0];
        let finer = divided(&x, 3);
        assert_eq!((finer.len(), finer[3], finer[18], finer[1]), (19, -1.5, 3.0, -2.5));
    }
}
