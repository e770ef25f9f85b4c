//! One contact problem on its way to the solution, and the memory it needs.

use super::fast::patch_inverse::KeptInverses;
use super::fast::pressure_shear::PressureShear;
use crate::contact::limits::RESISTANCE;
use crate::contact::line::ContactGrid;
use crate::contact::line::rim::RimFrame;
use crate::contact::line::state::{LineState, Status};
use crate::contact::line::streamline::Upwind;
use crate::contact::problem::ContactProblem;
use crate::contact::traction::Traction;
use crate::linalg::{DenseSystem, InverseFactor};
use nalgebra::DVector;

/// Buffers of the solver on a grid; of what they hold, only functions of the operators outlive a solution.
#[derive(Default)]
pub struct ActiveSetScratch {
    pub(super) system: DenseSystem,
    /// Equations of a single patch.
    pub(super) pressure_shear: PressureShear,
    /// Inverses of the last patches.
    pub(super) kept: KeptInverses,
    /// Guess of the closed nodes.
    pub(super) initial_guess: InitialGuess,
    /// Linear problems solved so far by turns, and all equations together: ordinary steps need no others than the first.
    pub solved: [u64; 2],
    /// Nodes and axes whose forces and motions are unknown.
    pub(super) closed: Vec<usize>,
    /// Tangential force over normal force at each of the closed nodes if it slips, with its sign; zero if it sticks [1].
    pub(super) friction: Vec<f64>,
    /// Yield strength in shear at the candidates [N/m]; empty: steel does not yield.
    pub(super) strength: Vec<f64>,
    /// Normal force at the candidates above which steel yields [N/m]; empty: it does not.
    pub(super) limit: Vec<f64>,
    /// Normal forces at the start [N/m]; empty: nothing yields.
    pub(super) pressed: Vec<f64>,
    /// Share of the friction coefficient at the candidates where the surface melts [1]; empty: all of it everywhere.
    pub(super) film: Vec<f64>,
    /// Depth by which yielding nodes have given way in the step; zero elsewhere [m].
    pub(super) overlap: Vec<f64>,
    /// Slope of the depth by which the rail lies below its plane, at the candidates [1]; empty without any.
    pub(super) dents: Vec<f64>,
    /// Depths by which the surfaces of wheel and rail lie below circle and plane, at the candidates and one node beyond on
    /// each side [m].
    pub(super) depth: Vec<[f64; 2]>,
    pub(super) stuck: Vec<usize>,
    pub(super) axes: Vec<usize>,
    /// Undeformed gap at the candidates [m].
    pub(super) gap: Vec<f64>,
    /// See [`RimFrame::sagitta`].
    pub(super) sagitta: Vec<f64>,
    /// Known part of `d_t` of the tangential gap [m/s].
    pub(super) slip_offset: Vec<f64>,
    /// Displacement of wheel and rail without contact forces and unknown motions [m].
    pub(super) known: [DVector<f64>; 2],
    /// Swelling of the hot layers of wheel and rail at the candidates [m]; empty without any.
    pub(super) swelling: [Vec<f64>; 2],
    /// Pull of the hot layers of wheel and rail at the candidates [N/m]; empty without any.
    pub(super) pull: [Vec<f64>; 2],
    /// Membrane force of a body at the candidates [N].
    pub(super) along: Vec<f64>,
    /// Displacement of wheel and rail by the membrane forces of their hot layers [m]; empty without any.
    pub(super) membrane: [DVector<f64>; 2],
    pub(super) upwind: Vec<Upwind>,
    pub(super) upwind_before: Vec<Upwind>,
    pub(super) status_before: Vec<Status>,
    pub(super) rim_angle: RimAngleRow,
    /// See [`Iterate::update_retarded`].
    pub(super) retarded: Retarded,
    /// Coefficients of all port forces in the row at hand.
    pub(super) row: Vec<f64>,
    /// Slip velocity with centred differences: what dissipates. The upwind one counts its own numerical dissipation.
    pub(super) centred_slip: Vec<f64>,
}

/// Memory of the guess of the closed nodes, see [`Iterate::guess_closed`].
#[derive(Default)]
pub(super) struct InitialGuess {
    /// Gap at the candidates without normal forces and height of the hub [m].
    pub base: Vec<f64>,
    /// Its change with the height of the hub \[1]; zero if that is prescribed.
    pub by_height: Vec<f64>,
    /// Normal forces at the closed nodes without height and turn of the rim [N/m], and their change with either.
    pub normal: [Vec<f64>; 3],
    /// Displacement of all ports by forces at the candidates [m].
    pub displaced: Vec<f64>,
    /// Forces at the candidates [N/m].
    pub forces: Vec<f64>,
    /// Inverse where the closed nodes are no single patch or some of them yield.
    pub factor: InverseFactor,
    pub product: Vec<f64>,
    /// What the guess began with.
    pub status: Vec<Status>,
    pub port_forces: DVector<f64>,
}

/// What each of the layers that answer late spares the hub, and the memory to compute it.
#[derive(Default)]
pub(super) struct Retarded {
    /// Of wheel and rail, at the rim [N/m].
    pub force: [f64; 2],
    /// Elastic nodal forces of the layer at hand [N/m].
    pub elastic: DVector<f64>,
    /// Their displacement [m].
    pub displacement: DVector<f64>,
}

/// Turn of the rim as an affine function.
#[derive(Default)]
pub(super) struct RimAngleRow {
    /// Coefficients of all port forces [rad/(N/m)].
    pub forces: Vec<f64>,
    /// Of the displacements at the tangential ports from the first loaded one on [1/m].
    pub weights: Vec<f64>,
    /// Coefficients of the accelerations of the rigid motions [rad/(m/s²), rad/(rad/s²)].
    pub inertial: [f64; 3],
    /// What is known of it [rad].
    pub known: f64,
    /// Its value in the present solution, with the weights of the one before [rad].
    pub expected: f64,
}

/// How much softer than its surroundings a yielding node is in a stationary start [1]: much, but so little that the search
/// for the start does not leap from patch to patch. The first steps of the run give the steel time to yield in full.
const SOFTER: f64 = 100.0;

/// One contact problem on its way to the solution: `state` and `traction` (port forces, surface displacements and rigid
/// motions) hold the present iterate.
pub(super) struct Iterate<'a> {
    pub grid: &'a ContactGrid,
    pub problem: &'a ContactProblem<'a>,
    pub state: &'a mut LineState,
    pub traction: &'a mut Traction,
    pub scratch: &'a mut ActiveSetScratch,
    /// Turn of the rim in the present iterate.
    pub frame: RimFrame<'a>,
    /// The turn that belongs to the surface displacements at hand: in the first iteration those of the start, while
    /// [`Self::frame`] is predicted [rad].
    pub surface_angle: f64,
    /// States of the brakes of the three axes: stuck ones hold; without meaning where there is none.
    pub brakes: [Status; 3],
}

impl Iterate<'_> {
    /// Nodal normal force at candidate `i` [N/m].
    pub fn normal(&self, i: usize) -> f64 {
        self.traction.port_forces[self.grid.port(i) + 1]
    }

    /// Nodal tangential force on the wheel at candidate `i` [N/m].
    pub fn tangential(&self, i: usize) -> f64 {
        self.traction.port_forces[self.grid.port(i)]
    }

    /// Depth [m] by which yielding candidate `i` gives way per force above its limit [m/(N/m)].
    pub fn creep(&self, i: usize) -> f64 {
        let port = self.grid.port(i) + 1;
        if self.problem.duration > 0.0 {
            1.0 / (RESISTANCE * self.grid.width(i))
        } else {
            SOFTER * self.problem.bodies.relative[(port, port)]
        }
    }

    /// Velocity with which the rim passes the contact [m/s]: that of the hub less that of the turn against it.
    pub fn rim_velocity(&self) -> f64 {
        let turning = self.problem.time.a0 * self.frame.rim_angle + self.state.rim_angle.offset(&self.problem.time);
        self.problem.radius() * (self.traction.rigid[2] - turning)
    }

    /// Sum of the speeds of both surfaces [m/s].
    pub fn speed(&self) -> f64 {
        self.traction.rigid[0].abs() + self.rim_velocity().abs()
    }

    /// Whether the material arrives from `+x`.
    pub fn upstream_right(&self) -> bool {
        self.traction.rigid[0] + self.rim_velocity() >= 0.0
    }
}

/// Copies without allocating where the lengths agree.
pub(super) fn copy(target: &mut DVector<f64>, source: &DVector<f64>) {
    if target.len() == source.len() { target.copy_from(source) } else { target.clone_from(source) }
}
