//! Contact lines on bodies that are rigid but for the flexibility that the lines have for themselves.
#![allow(dead_code)]

use nalgebra::{DMatrix, DVector};
use wheelrail::axes::{Axis, PerAxis};
use wheelrail::contact::{
    ActiveSetScratch, ActiveSetSolver, AxisDrive, Begin, ContactError, ContactProblem, ContactState, Drift, Friction,
    Influence, Layer, LineLayout, LineProblem, PatchFlexibility, RigidMotion, SteelLimits, SurfaceResponse, Undeformed,
};
use wheelrail::multistep::TimeDerivative;
use wheelrail::piecewise::Piecewise;

/// Displacement components at the points of the bodies.
const PORTS: usize = 10;
/// Height of a hub without load [m].
const IN_THE_AIR: f64 = 1e-3;
/// Rigid motions of the wheel.
const AXES: usize = Axis::COUNT;

/// Bodies that do not yield.
pub struct RigidBodies {
    none: [DMatrix<f64>; 4],
    still: DVector<f64>,
}

/// Lines under a wheel in one step, or in a stationary state.
pub struct Step<'a> {
    /// Radius of the wheel [m].
    pub radius: f64,
    /// The lines.
    pub lines: &'a [LineLayout],
    /// Flexibility of the lines under each other's tangential forces.
    pub flexibility: Option<&'a PatchFlexibility>,
    /// Load per metre of the bodies' width, and that which scales tolerances [N/m].
    pub load: [f64; 2],
    /// Translation, rotation and lateral translation.
    pub motion: [RigidMotion; 3],
    /// Drift.
    pub drift: Drift,
    /// Time formula, and friction of all lines.
    pub laws: (TimeDerivative, Friction),
}

impl RigidBodies {
    /// Bodies without any flexibility.
    pub fn new() -> Self {
        let of = |rows, columns| DMatrix::zeros(rows, columns);
        Self {
            none: [of(PORTS, PORTS), of(PORTS, AXES), of(AXES, PORTS), of(AXES, AXES)],
            still: DVector::zeros(PORTS),
        }
    }

    fn response(&self) -> SurfaceResponse<'_> {
        SurfaceResponse {
            shared: Influence { compliance: [&self.none[0], &self.none[0]], relative: &self.none[0] },
            lift: 0.0,
            free: [&self.still, &self.still],
            inertial: &self.none[1],
            momentum: &self.none[2],
            deformation_inertia: &self.none[3],
        }
    }

    /// Contact of all lines after a step from `start`.
    pub fn solve(
        &self,
        solver: &ActiveSetSolver,
        step: &Step,
        start: &[ContactState],
    ) -> Result<Vec<ContactState>, ContactError> {
        self.solve_with(solver, step, start, &mut ActiveSetScratch::default())
    }

    /// [`Self::solve`] with the memory of a solver. Without a load the hub is held so high that nothing touches.
    pub fn solve_with(
        &self,
        solver: &ActiveSetSolver,
        step: &Step,
        start: &[ContactState],
        scratch: &mut ActiveSetScratch,
    ) -> Result<Vec<ContactState>, ContactError> {
        let Step {
            radius,
            lines: layout,
            load: [load, nominal_load],
            motion,
            drift,
            laws: (time, friction),
            flexibility,
        } = *step;
        let hub = match load > 0.0 {
            true => RigidMotion { drive: AxisDrive::Free { load: -load }, ..RigidMotion::held(0.0, 0.0) },
            false => RigidMotion::held(IN_THE_AIR, 0.0),
        };
        let flat = Piecewise::default();
        let line = |(line, layout): (usize, &LineLayout)| LineProblem {
            size: layout.size,
            share: layout.share,
            position: layout.position,
            kernel: layout.kernel,
            layer: Layer::default(),
            patch: flexibility.map(|flexibility| layout.in_patch(flexibility, line)),
            bodies: self.response(),
            membrane: [&flat, &flat],
            time,
            duration: if time.is_stationary() { 0.0 } else { 1.0 / time.a0 },
            surfaces: Undeformed { elevation: -layout.gap, ..Undeformed::smooth(radius) },
            limits: SteelLimits::none(&flat),
            friction,
        };
        let problem = ContactProblem {
            lines: layout.iter().enumerate().map(line).collect(),
            rigid: PerAxis { travel: motion[0], height: hub, rotation: motion[1], lateral: motion[2] },
            drift,
            nominal_load,
            edge_tolerance: 1e-5,
            begin: Begin::Before(1.0),
        };
        let mut found = start.to_vec();
        let before: Vec<_> = start.iter().collect();
        let mut after: Vec<_> = found.iter_mut().collect();
        solver.solve(&problem, &before, &mut after, scratch)?;
        Ok(found)
    }
}
