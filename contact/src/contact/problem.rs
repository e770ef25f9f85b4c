//! Condensed contact problem of one step: bodies, wheel and surfaces as the contact knows them.
//!
//! The contact is a list of *lines* side by side, each with a share of the width. They share the wheel's rigid motions
//! and feel each other through the bodies: a line is displaced by the forces of all ([`Influence`]), and by its own as
//! its [`LineKernel`] says. Derivation: `docs/theory/lines.md`.

use super::flexibility::InPatch;
use super::friction::Friction;
use super::kernel::{Layer, LineKernel};
use super::layout::NodeSize;
use super::limits::SteelLimits;
use super::undeformed::Undeformed;
use crate::axes::{Axis, PerAxis};
use crate::multistep::TimeDerivative;
use crate::piecewise::Piecewise;
use nalgebra::{DMatrix, DVector};

/// Displacements of the ports by forces there.
#[derive(Clone, Copy)]
pub struct Influence<'a> {
    /// Displacement of wheel and rail per unit force on this body [m/(N/m)].
    pub compliance: [&'a DMatrix<f64>; 2],
    /// Sum of both [m/(N/m)].
    pub relative: &'a DMatrix<f64>,
}

/// Linear answer of both bodies, less half-planes, at their surfaces; the ports are the displacements x, y of the points of
/// a polynomial, and forces act on them by their moments with these polynomials.
#[derive(Clone, Copy)]
pub struct SurfaceResponse<'a> {
    /// Displacements by the forces of all lines, each weighted with its share of the width.
    pub shared: Influence<'a>,
    /// Height by which the wheel would be displaced more under the normal force of all lines if what the bodies lack
    /// were the same along and normal to the surface [m/(N/m)]: lever arms do not see what has no direction of its own.
    pub lift: f64,
    /// Displacement of wheel and rail without contact forces and rigid accelerations \[m].
    pub free: [&'a DVector<f64>; 2],
    /// Displacement of the wheel's ports per unit rigid acceleration, a column for each axis.
    pub inertial: &'a DMatrix<f64>,
    /// Rate of deformation momentum per unit force, a row for each axis.
    pub momentum: &'a DMatrix<f64>,
    /// Rate of deformation momentum per unit rigid acceleration, axis by axis.
    pub deformation_inertia: &'a DMatrix<f64>,
}

impl SurfaceResponse<'_> {
    /// Displacement of the wheel at a port per unit rigid acceleration.
    pub fn inertial_at(&self, port: usize) -> PerAxis<f64> {
        PerAxis::from_fn(|axis| self.inertial[(port, axis.number())])
    }
}

/// Drive of a rigid motion of the wheel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AxisDrive {
    /// A force or moment acts, the motion follows.
    Free {
        /// External force [N/m] or moment \[N].
        load: f64,
    },
    /// The motion is prescribed, the force is a reaction.
    Prescribed {
        /// V [m/s], U \[m] or Ω [rad/s] at the end of the step.
        target: f64,
    },
    /// A force or moment acts, and dry friction besides: it opposes the motion with its `limit`, or holds the axis at
    /// rest with what that takes, up to the limit.
    Braked {
        /// External force [N/m] or moment \[N].
        load: f64,
        /// Largest force [N/m] or moment \[N] of the brake.
        limit: f64,
    },
}

impl AxisDrive {
    /// A force or moment `load` beside a brake of strength `limit`, if it is on.
    pub fn of(load: f64, limit: f64) -> Self {
        if limit > 0.0 { Self::Braked { load, limit } } else { Self::Free { load } }
    }

    /// The force or moment that acts and the strength of the brake beside it; `None` for a prescribed motion.
    pub fn loads(self) -> Option<[f64; 2]> {
        match self {
            Self::Free { load } => Some([load, 0.0]),
            Self::Braked { load, limit } => Some([load, limit]),
            Self::Prescribed { .. } => None,
        }
    }
}

/// One rigid motion of the wheel and its balance `m a + ṗ = f + Σ contact`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidMotion {
    /// Its drive.
    pub drive: AxisDrive,
    /// Where the search for a free motion starts: V [m/s], U \[m], Ω [rad/s].
    pub guess: f64,
    /// The acceleration is `gain · value + offset`. Without gain it is known, and a free motion has the value at which
    /// the contact forces hold its balance.
    pub gain: f64,
    /// See [`Self::gain`].
    pub offset: f64,
    /// Mass [kg/m] or moment of inertia [kg m].
    pub inertia: f64,
    /// Rate of deformation momentum without contact forces and rigid accelerations.
    pub momentum: f64,
}

impl RigidMotion {
    /// A motion that is held at `value` and whose acceleration is known.
    pub fn held(value: f64, acceleration: f64) -> Self {
        let drive = AxisDrive::Prescribed { target: value };
        Self { drive, guess: value, gain: 0.0, offset: acceleration, inertia: 0.0, momentum: 0.0 }
    }

    /// Value at which the solution starts.
    pub fn start(&self) -> f64 {
        match self.drive {
            AxisDrive::Free { .. } | AxisDrive::Braked { .. } => self.guess,
            AxisDrive::Prescribed { target } => target,
        }
    }

    /// Prescribed value, if it is.
    pub fn target(&self) -> Option<f64> {
        match self.drive {
            AxisDrive::Free { .. } | AxisDrive::Braked { .. } => None,
            AxisDrive::Prescribed { target } => Some(target),
        }
    }

    /// True if its value is zero and stays so without a contact force: it is held there, or nothing drives its mass.
    pub fn rests(&self) -> bool {
        let free = |[load, _]: [f64; 2]| self.gain == 0.0 || [load, self.offset, self.momentum] != [0.0; 3];
        self.start() == 0.0 && !self.drive.loads().is_some_and(free)
    }

    /// Acceleration that belongs to a value.
    pub fn acceleration(&self, value: f64) -> f64 {
        self.gain * value + self.offset
    }

    /// The part of the acceleration that is known before the contact is solved: all of it for a prescribed motion.
    pub fn known_acceleration(&self) -> f64 {
        self.target().map_or(self.offset, |target| self.acceleration(target))
    }
}

/// Gap and slip of one contact line as functions of contact forces and rigid motions, for one step or a stationary
/// state. Forces are per metre of its own width.
#[derive(Clone, Copy)]
pub struct LineProblem<'a> {
    /// Its width over that of the bodies \[1].
    pub share: f64,
    /// Lateral position about the centre of load \[m].
    pub position: f64,
    /// Size of its nodes; `None`: that of the grid.
    pub size: Option<NodeSize>,
    /// Flexibility that it has for itself.
    pub kernel: LineKernel,
    /// Elastic layer between the surfaces.
    pub layer: Layer,
    /// Patch whose other lines displace it, too; `None`: it is alone but for the bodies.
    pub patch: Option<InPatch<'a>>,
    /// Linear answer of the bodies.
    pub bodies: SurfaceResponse<'a>,
    /// Membrane forces `N(x)` of the hot layers of wheel and rail [N/m]; their gradients pull at the surfaces.
    pub membrane: [&'a Piecewise; 2],
    /// Formula for `d_t`; all zero: stationary.
    pub time: TimeDerivative,
    /// Length of the step \[s]; zero: stationary.
    pub duration: f64,
    /// Undeformed surfaces where the wheel stands.
    pub surfaces: Undeformed<'a>,
    /// Limits of pressure and friction.
    pub limits: SteelLimits<'a>,
    /// Friction coefficient as a function of the slip at the end of the step.
    pub friction: Friction,
}

impl LineProblem<'_> {
    /// True if its nodes may be closer than those of the grid.
    pub fn is_on_small_nodes(&self) -> bool {
        self.size.is_some_and(|size| size.under_load < 1.0)
    }

    /// True if its tractions and slips have a lateral part.
    pub fn is_sideways(&self) -> bool {
        self.patch.is_some_and(|patch| patch.flexibility.is_sideways())
    }

    /// Rolling radius of the wheel \[m], thermal growth included.
    pub fn radius(&self) -> f64 {
        self.surfaces.radius + self.surfaces.growth
    }

    /// Rolling radius over that of the cold circle \[1], by which lever arms about the hub are longer on a grown wheel: bodies
    /// and gap are those of the cold circle, and material passes them with the grown one. Derivation:
    /// `docs/theory/lever-arms.md`, section 3.
    pub fn grown(&self) -> f64 {
        self.radius() / self.surfaces.radius
    }
}

/// Velocity that is linear in the motions of the wheel: `constant + per_travel · V + per_rotation · Ω`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BySpeed {
    /// Velocity of a wheel at rest [m/s or rad/s].
    pub constant: f64,
    /// Velocity over V [1 or rad/m].
    pub per_travel: f64,
    /// Velocity over Ω [m/rad or 1].
    pub per_rotation: f64,
}

impl BySpeed {
    /// The velocity, given V [m/s] and Ω [rad/s].
    pub fn velocity(self, motions: PerAxis<f64>) -> f64 {
        self.constant + self.per_travel * motions.travel + self.per_rotation * motions.rotation
    }

    /// Its change per unit of a rigid motion.
    pub fn by(self, axis: Axis) -> f64 {
        match axis {
            Axis::Travel => self.per_travel,
            Axis::Rotation => self.per_rotation,
            Axis::Height | Axis::Lateral => 0.0,
        }
    }
}

/// Velocities of the surface of the wheel at the contact besides those of its rigid motions.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Drift {
    /// Velocity at the centre of load along, besides `V − rΩ` [m/s].
    pub along: BySpeed,
    /// Velocity there across, besides that of the lateral motion [m/s].
    pub across: BySpeed,
    /// Spin σ: the wheel turns about the normal [rad/s], which adds `−σ z` to its slip along and `σ x` to that across.
    pub spin: BySpeed,
    /// Tangent of the angle between the plane of contact and the track: a wheel whose axle stays level is lifted by that part of
    /// the lateral force of the contact \[1].
    pub rise: f64,
}

impl Drift {
    /// Velocities along and across, and the spin, given V [m/s] and Ω [rad/s].
    pub fn velocities(&self, motions: PerAxis<f64>) -> [f64; 3] {
        [self.along, self.across, self.spin].map(|part| part.velocity(motions))
    }
}

impl ContactProblem<'_> {
    /// True if tractions and slips get a lateral part from the motions of the wheel: its lines may have one, and it moves
    /// across or turns.
    pub fn moves_sideways(&self) -> bool {
        let moves = self.drift != Drift::default() || !self.rigid.lateral.rests();
        moves && self.lines.iter().any(LineProblem::is_sideways)
    }
}

/// Contact lines under a wheel whose rigid motions are sought or prescribed.
pub struct ContactProblem<'a> {
    /// The contact lines.
    pub lines: Vec<LineProblem<'a>>,
    /// Rigid motions of the wheel.
    pub rigid: PerAxis<RigidMotion>,
    /// Drift of the wheel besides its rigid motions; only lines with lateral forces feel it.
    pub drift: Drift,
    /// Line load that scales tolerances [N/m].
    pub nominal_load: f64,
    /// Largest change of the weights at the contact edges over the search that counts as none, and half of the least that
    /// counts in full \[1].
    pub edge_tolerance: f64,
    /// States of nodes with which the search begins.
    pub begin: Begin,
}

/// States of nodes with which a search begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Begin {
    /// Those of the step before, on patches that are longer by this factor \[1].
    Before(f64),
    /// Those of the results at hand, which have been found for the same step in another layout.
    Found,
}
