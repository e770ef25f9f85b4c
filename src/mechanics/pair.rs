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
    /// These bodies with the paired nodes of the wings on both sides of the ports; `None` without wings.
    pub wide: Option<Box<Pair>>,
    /// These bodies less half-planes, for a contact solver that knows those; only reduced bodies without
    /// stiffness-proportional damping have them.
    pub smooth: Option<SmoothBodies>,
}

/// Wheel and rail less half-planes; their ports are the displacements at the points of a polynomial.
pub struct SmoothBodies {
    /// The wheel.
    pub wheel: Box<dyn BodyResponse>,
    /// The rail.
    pub rail: Box<dyn BodyResponse>,
    /// Half of the length over which they are known \[m].
    pub reach: f64,
}

impl Pair {
    fn new(wheel: Box<dyn BodyResponse>, rail: Box<dyn BodyResponse>, surface_x: Vec<f64>, spacing: f64) -> Self {
        let candidates = GUARDS..surface_x.len() - GUARDS;
        Self { wheel, rail, surface_x, spacing, candidates, wide: None, smooth: None }
    }
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
    let smooth = basis.as_ref().filter(|_| !retarded).and_then(|basis| {
        let x = &surface_x[core.clone()];
        let reach = x[x.len() - 1 - GUARDS];
        let points = Lagrange::new(reach);
        let part = |body: &ReducedBasis, side| body.cut(ports.clone()).smooth(x, &points, half_plane, side);
        let wheel = ReducedBody::new(part(&basis.wheel, 1.0)?, centrifugal, &damping[0]);
        let rail = ReducedBody::new(part(&basis.rail, -1.0)?, false, &damping[1]);
        Some(SmoothBodies { wheel: Box::new(wheel), rail: Box::new(rail), reach })
    });
    let parts = grid_cells_per_element(config);
    let (elements, surface_x) = (surface_x.clone(), divided(&surface_x, parts));
    let ports = 2 * parts * core.start..2 * (parts * (core.end - 1) + 1);
    let [narrow, wide]: [TwoBodies; 2] = match basis {
        Some(Basis { wheel, rail, .. }) => {
            let finer = |body: ReducedBasis, side| body.refined(&elements, &surface_x, half_plane, side);
            let (wheel, rail) = (finer(wheel, 1.0), finer(rail, -1.0));
            [(wheel.cut(ports.clone()), rail.cut(ports.clone())), (wheel, rail)].map(|(w, r)| -> TwoBodies {
                [
                    Box::new(ReducedBody::new(w, centrifugal, &damping[0])),
                    Box::new(ReducedBody::new(r, false, &damping[1])),
                ]
            })
        }
        None => {
            progress("assembling the wheel", 0.0);
            let counts = [config.solver.modes_wheel, config.solver.modes_rail];
            let wheel = FullBody::damped(wheel_system(config)?, centrifugal, &damping[0], counts[0])?;
            progress("assembling the rail", 0.5);
            let rail = FullBody::damped(rail_system(config)?, false, &damping[1], counts[1])?;
            progress("assembling the rail", 1.0);
            let (wheel, rail) =
                (wheel.corrected(&surface_x, half_plane, 1.0)?, rail.corrected(&surface_x, half_plane, -1.0)?);
            [[Box::new(wheel.cut(ports.clone())), Box::new(rail.cut(ports.clone()))], [Box::new(wheel), Box::new(rail)]]
        }
    };
    let pair = |[wheel, rail]: TwoBodies, x: Vec<f64>| Pair::new(wheel, rail, x, grid_spacing(config));
    let middle = pair(narrow, surface_x[ports.start / 2..ports.end / 2].to_vec());
    Ok(Pair { wide: (wing > 0).then(|| Box::new(pair(wide, surface_x))), smooth, ..middle })
}
