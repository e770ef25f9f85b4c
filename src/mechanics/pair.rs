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
use super::smooth::SmoothPorts;
use crate::analytic::HalfPlane;
use crate::config::Config;
use crate::fem::graded::GUARDS;
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
    pub wide: Option<WideBodies>,
    /// These bodies less half-planes, for a contact solver that knows those.
    pub smooth: SmoothBodies,
}

/// Wheel and rail with the paired nodes of the wings as well; as many of them are guards.
pub struct WideBodies {
    /// The wheel.
    pub wheel: Box<dyn BodyResponse>,
    /// The rail.
    pub rail: Box<dyn BodyResponse>,
    /// x of the paired surface nodes, ascending \[m].
    pub surface_x: Vec<f64>,
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

/// Both bodies behind their common interface.
type TwoBodies = [Box<dyn BodyResponse>; 2];

/// Which side of their surfaces wheel and rail lie on: the wheel above, the rail below.
const SIDES: [f64; 2] = [1.0, -1.0];

/// Surface nodes of both bodies, and how they are damped.
struct PairPlan<'a> {
    config: &'a Config,
    half_plane: HalfPlane,
    damping: [BodyDamping; 2],
    /// Nodes of the finite elements, and of the contact grid \[m].
    elements: Vec<f64>,
    surface_x: Vec<f64>,
    /// Components of the grid that are ports of ordinary patches.
    ports: Range<usize>,
    /// Points of the bodies less half-planes.
    points: SmoothPorts,
}

/// Both bodies with the ports of ordinary patches, with those of the wings as well, and less half-planes.
struct BothAtPorts {
    narrow: TwoBodies,
    wide: TwoBodies,
    smooth: TwoBodies,
}

impl PairPlan<'_> {
    /// Both bodies as modes.
    fn reduced(&self, basis: Basis) -> BothAtPorts {
        let bodies = |[wheel, rail]: [ReducedBasis; 2]| -> TwoBodies {
            [
                Box::new(ReducedBody::new(wheel, self.config.physics.centrifugal, &self.damping[0])),
                Box::new(ReducedBody::new(rail, false, &self.damping[1])),
            ]
        };
        let basis = [basis.wheel, basis.rail];
        let smooth = [0, 1].map(|i| basis[i].smooth(&self.points, self.half_plane, SIDES[i]));
        let finer = [0, 1].map(|i| basis[i].refined(&self.elements, &self.surface_x, self.half_plane, SIDES[i]));
        let narrow = finer.each_ref().map(|body| body.cut(self.ports.clone()));
        BothAtPorts { narrow: bodies(narrow), wide: bodies(finer), smooth: bodies(smooth) }
    }

    /// Both bodies with all their finite elements.
    fn full(&self, progress: &mut dyn FnMut(&str, f64)) -> Result<BothAtPorts, MechanicsError> {
        let (config, x) = (self.config, &self.surface_x);
        progress("assembling the wheel", 0.0);
        let counts = [config.solver.modes_wheel, config.solver.modes_rail];
        let centrifugal = config.physics.centrifugal;
        let wheel = FullBody::damped(wheel_system(config)?, centrifugal, &self.damping[0], counts[0])?;
        progress("assembling the rail", 0.5);
        let rail = FullBody::damped(rail_system(config)?, false, &self.damping[1], counts[1])?;
        progress("assembling the rail", 1.0);
        let smooth = |body: &FullBody, side| body.smooth(&self.points, self.half_plane, side);
        let smooth: TwoBodies = [Box::new(smooth(&wheel, SIDES[0])?), Box::new(smooth(&rail, SIDES[1])?)];
        let corrected = |body: FullBody, side| body.corrected(x, self.half_plane, side);
        let (wheel, rail) = (corrected(wheel, SIDES[0])?, corrected(rail, SIDES[1])?);
        let narrow = |body: &FullBody| Box::new(body.cut(self.ports.clone()));
        Ok(BothAtPorts { narrow: [narrow(&wheel), narrow(&rail)], wide: [Box::new(wheel), Box::new(rail)], smooth })
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
    let (elements, wing, parts) = (zone.surface_x(), zone.wing_nodes(), grid_cells_per_element(config));
    let core = wing..elements.len() - wing;
    let plan = PairPlan {
        config,
        half_plane: Isotropic::from(&config.material).half_plane(),
        damping: [BodyDamping::wheel(config), BodyDamping::rail(config)],
        surface_x: divided(&elements, parts),
        ports: 2 * parts * core.start..2 * (parts * (core.end - 1) + 1),
        points: SmoothPorts::new(&elements)?,
        elements,
    };
    let BothAtPorts { narrow: [wheel, rail], wide, smooth } = match basis {
        Some(basis) => plan.reduced(basis),
        None => plan.full(progress)?,
    };
    let PairPlan { surface_x: x, ports, points, .. } = plan;
    let surface_x = x[ports.start / 2..ports.end / 2].to_vec();
    let candidates = GUARDS..surface_x.len() - GUARDS;
    let [wide_wheel, wide_rail] = wide;
    let wide = (wing > 0).then_some(WideBodies { wheel: wide_wheel, rail: wide_rail, surface_x: x });
    let [smooth_wheel, smooth_rail] = smooth;
    let smooth = SmoothBodies { wheel: smooth_wheel, rail: smooth_rail, reach: points.basis.reach };
    Ok(Pair { wheel, rail, surface_x, spacing: grid_spacing(config), candidates, wide, smooth })
}
