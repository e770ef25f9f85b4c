//! One contact line on its way to a solution, and the memory it needs.

use super::alone::{Alone, OwnDisplacement};
use super::given::KnownPart;
use super::grid::ContactGrid;
use super::history::LineHistory;
use super::resize::Nodes;
use super::rim::{RimAngleRow, RimFrame};
use super::slopes::Slopes;
use super::state::{GridState, NodeStatus, Slide};
use super::streamline::UpwindRows;
use super::vectors::copy;
use crate::axes::PerAxis;
use crate::contact::flexibility::{ByPowers, Field};
use crate::contact::kernel::LineKernel;
use crate::contact::limits::RESISTANCE;
use crate::contact::problem::{Drift, LineProblem};
use crate::contact::traction::Traction;
use nalgebra::DVector;

/// Memory of a line; nothing in it outlives a solution.
#[derive(Default)]
pub struct LineScratch {
    /// Its nodes; `None`: it has not been solved yet.
    pub grid: Option<ContactGrid>,
    /// Displacements and pulls that the step before has left at them.
    pub before: Before,
    /// Known part of the problem.
    pub given: KnownPart,
    /// The rest.
    pub iterate: LineIterate,
}

/// Displacements and pulls at the nodes of a line at the end of the step before.
#[derive(Default)]
pub struct Before {
    /// Displacements of wheel and rail, x and y of every node \[m].
    pub surface: [DVector<f64>; 2],
    /// Pulls of hot layers at the candidates, on wheel and rail [N/m]; empty: there were none.
    pub pull: [Vec<f64>; 2],
}

/// Forces of all lines on the ports of the bodies, each line weighted with its share of the width.
#[derive(Default)]
pub struct PortForces {
    /// Contact forces on the wheel [N/m].
    pub contact: DVector<f64>,
    /// Pulls of hot layers on the wheel [N/m]; empty: there are none.
    pub pull: DVector<f64>,
}

/// Quantities of a line that follow from forces, states and motions in the present iterate.
#[derive(Default)]
pub struct LineIterate {
    /// Forces of all lines.
    pub all: PortForces,
    /// Moments of the line's own forces along and across with the powers of the place [N/m], and what the forces of all lines
    /// of the patch do to it in both directions.
    pub moments: [ByPowers; 2],
    pub fields: [Field; 2],
    /// Derivatives of these displacements by the size of the line, see [`InPatch::growths`](crate::contact::InPatch::growths).
    pub growths: [ByPowers; 2],
    /// Rim angle as an affine function of the forces.
    pub rim: RimAngleRow,
    /// Upwind differences of the slip.
    pub upwind: UpwindRows,
    /// Depth by which yielding candidates have given way in the step; zero elsewhere \[m].
    pub overlap: Vec<f64>,
    /// Height that the flexibility of the line alone would have if it were the same in both directions, less that which it
    /// has: the same everywhere \[m], and per displacement by normal forces \[1].
    pub lift: [f64; 2],
    /// Slip velocity of the candidates along and across with centred differences [m/s]: it dissipates. The upwind one counts
    /// its own numerical dissipation.
    pub centred_slip: [Vec<f64>; 2],
    /// Slipping of the candidates where it may have any direction.
    pub slides: Vec<Slide>,
    /// Slip of a node in the middle per force on it [m/s/(N/m)], by which the law of friction is judged there.
    pub own_slip: f64,
    /// Shear to which the line is drawn, if it is.
    pub drawn: Option<Drawn>,
    /// Displacement of the ports of the body at hand by forces and accelerations that are sought \[m].
    pub moved: DVector<f64>,
    /// Displacement by the own flexibility.
    pub own: OwnDisplacement,
    /// Displacement of the wheel less that of the rail by the line's own lateral forces at all nodes \[m].
    pub displaced: Vec<f64>,
}

/// Shear to which a line is drawn: what its nodes are away from it adds to their slip.
#[derive(Debug)]
pub struct Drawn {
    /// Slip per force away from it [m/s/(N/m)].
    pub strength: f64,
    /// Shear along and across at the candidates [N/m].
    pub shear: Vec<[f64; 2]>,
}

impl Drawn {
    /// Draws a line to its present shear, `strength` times as much as the slip of a node resists its own shear.
    pub fn to(line: &ContactLine, strength: f64) -> Self {
        let shear = (0..line.grid.len()).map(|i| line.shear(i)).collect();
        Self { strength: strength * line.own_slip(), shear }
    }

    /// Slip that it adds at candidate `i` under a shear [m/s].
    pub fn slip(&self, i: usize, shear: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|d| self.strength * (shear[d] - self.shear[i][d]))
    }
}

impl LineScratch {
    /// Takes the nodes of a line that starts from `state`, those of the `grid` in another size, and finds the known part of its
    /// problem: `course` are V [m/s] and Ω [rad/s] with which the search begins and the choice of nodes, `accelerations` the
    /// rigid ones that are known.
    #[inline(never)]
    pub fn begin(
        &mut self,
        grid: &ContactGrid,
        problem: &LineProblem,
        state: &mut GridState,
        (course, accelerations): (([f64; 2], Nodes), PerAxis<f64>),
    ) {
        state.resize(grid, problem, course);
        let fits = |own: &ContactGrid| own.size == state.size && own.is_scaled(grid);
        let own = self.grid.take().filter(fits).unwrap_or_else(|| grid.scaled(state.size));
        for (ours, theirs) in self.before.surface.iter_mut().zip(&state.surface) {
            copy(ours, theirs);
        }
        self.before.pull.clone_from(&state.pull);
        self.given.find(&own, problem, state, accelerations);
        self.grid = Some(own);
    }
}

/// A line in the present iterate: `state`, and of `traction` the ports, rigid motions and friction coefficient.
pub struct ContactLine<'a> {
    pub grid: &'a ContactGrid,
    pub problem: &'a LineProblem<'a>,
    /// Flexibility that it has for itself.
    pub kernel: LineKernel,
    /// Known part of the problem.
    pub given: &'a KnownPart,
    pub iterate: &'a mut LineIterate,
    pub state: &'a mut GridState,
    pub history: &'a mut LineHistory,
    pub traction: &'a mut Traction,
    /// Elastic energy of the line's flexibility [J/m].
    pub energy: &'a mut f64,
    /// Displacements and pulls at the end of the step before.
    pub before: &'a Before,
    /// Frame that turns with the rim, at the angle of the present iterate.
    pub frame: RimFrame<'a>,
    /// Rim angle that belongs to the surface displacements at hand \[rad]: in the first iteration those of the start,
    /// while that of [`Self::frame`] is predicted.
    pub surface_angle: f64,
    /// Drift of the wheel besides its rigid motions, if the line has a lateral direction.
    pub drift: Drift,
    resumed: Option<Resumed>,
    /// Size of the nodes over that in the step before \[1].
    pub resized: f64,
}

/// State, history, traction and elastic energy from which a line starts, and which it changes.
pub struct LineStart<'a> {
    pub state: &'a mut GridState,
    pub history: &'a mut LineHistory,
    pub traction: &'a mut Traction,
    pub energy: &'a mut f64,
    /// States and forces with which the search begins, if they are others.
    pub resumed: Option<Resumed>,
    /// Size of the nodes in the step before over that of the grid \[1].
    pub size_before: f64,
}

/// States of the candidates and forces of a solution, from which another one is looked for.
pub struct Resumed {
    status: Vec<NodeStatus>,
    yielded: Vec<bool>,
    forces: DVector<f64>,
}

impl Resumed {
    /// Takes them from a solution.
    pub fn take(state: &mut GridState) -> Self {
        Self {
            status: std::mem::take(&mut state.status),
            yielded: std::mem::take(&mut state.yielded),
            forces: std::mem::take(&mut state.forces),
        }
    }
}

impl<'a> ContactLine<'a> {
    /// A line that starts from the given states; nodes and the known part of its problem are those of the `scratch`.
    pub fn new(
        grid: &'a ContactGrid,
        problem: &'a LineProblem<'a>,
        start: LineStart<'a>,
        scratch: &'a mut LineScratch,
    ) -> Self {
        let LineStart { state, history, traction, energy, resumed, size_before } = start;
        let LineScratch { grid: own, before, given, iterate } = scratch;
        let grid = own.as_ref().unwrap_or(grid);
        if !problem.limits.is_limited() {
            state.yielded.fill(false);
        }
        iterate.drawn = None;
        iterate.lift = [0.0; 2];
        iterate.overlap.clear();
        iterate.overlap.resize(grid.len(), 0.0);
        iterate.centred_slip.iter_mut().for_each(|slip| slip.resize(grid.len(), 0.0));
        let given = &*given;
        let frame = RimFrame { grid, radius: problem.surfaces.radius, sagitta: &given.sagitta, rim_angle: 0.0 };
        Self {
            grid,
            problem,
            kernel: problem.kernel,
            given,
            iterate,
            state,
            history,
            traction,
            energy,
            before: &*before,
            frame,
            surface_angle: 0.0,
            drift: Drift::default(),
            resumed,
            resized: grid.size / size_before,
        }
    }

    /// Takes the states and forces with which the search begins, if they are others than those of the step before.
    pub fn resume(&mut self) {
        if let Some(Resumed { status, yielded, forces }) = self.resumed.take() {
            (self.state.status, self.state.yielded, self.state.forces) = (status, yielded, forces);
        }
    }

    /// Normal force of all lines per metre of the bodies' width [N/m].
    pub fn load_of_all(&self) -> f64 {
        self.iterate.all.contact.iter().skip(1).step_by(2).sum()
    }

    /// Nodal normal force at candidate `i` [N/m].
    pub fn normal(&self, i: usize) -> f64 {
        self.state.forces[self.grid.component(i) + 1]
    }

    /// Nodal tangential force on the wheel at candidate `i` [N/m].
    pub fn tangential(&self, i: usize) -> f64 {
        self.state.forces[self.grid.component(i)]
    }

    /// True if candidate `i` carries a force.
    pub fn is_loaded(&self, i: usize) -> bool {
        self.normal(i) != 0.0 || self.shear(i) != [0.0; 2]
    }

    /// Candidates that carry a force.
    pub fn loaded(&self) -> impl Iterator<Item = usize> {
        (0..self.grid.len()).filter(|&i| self.is_loaded(i))
    }

    /// Friction force that candidate `i` can bear over its normal force \[1].
    pub fn friction(&self, i: usize) -> f64 {
        self.given.strength.friction(i, self.traction.friction.coefficient)
    }

    /// Depth \[m] by which yielding candidate `i` gives way per force above its limit [m/(N/m)].
    pub fn creep(&self, i: usize) -> f64 {
        1.0 / (RESISTANCE * self.grid.width(i))
    }

    /// Velocity with which the rim passes the contact [m/s]: that of the hub less that of the rim against it.
    pub fn rim_velocity(&self) -> f64 {
        let time = &self.problem.time;
        let turning = time.a0 * self.frame.rim_angle + self.history.rim_angle.offset(time);
        self.problem.radius() * (self.traction.rigid.rotation - turning)
    }

    /// Rim angle \[rad] if the rim goes on turning as it does.
    pub fn predicted_angle(&self) -> f64 {
        let (angle, time) = (&self.history.rim_angle, &self.problem.time);
        if time.is_stationary() { angle.now } else { (angle.rate - angle.offset(time)) / time.a0 }
    }

    /// Sum of the speeds of both surfaces [m/s].
    pub fn speed(&self) -> f64 {
        self.traction.rigid.travel.abs() + self.rim_velocity().abs()
    }

    /// True if the material arrives from `+x`.
    pub fn upstream_right(&self) -> bool {
        self.traction.rigid.travel + self.rim_velocity() >= 0.0
    }

    /// Begins with the upwind differences of the present states and pressures.
    pub fn begin_upwind(&mut self) {
        let (grid, forces, to_right) = (self.grid, &self.state.forces, self.upstream_right());
        let pressure = |i: usize| forces[grid.component(i) + 1] * grid.share(i);
        self.iterate.upwind.begin(&self.state.status, pressure, to_right);
    }

    /// Takes the upwind differences of the present states and pressures where they are farther than a `tolerance` from those
    /// of the beginning; returns the largest change of their weights.
    pub fn update_upwind(&mut self, tolerance: f64) -> f64 {
        let (grid, forces, to_right) = (self.grid, &self.state.forces, self.upstream_right());
        let pressure = |i: usize| forces[grid.component(i) + 1] * grid.share(i);
        self.iterate.upwind.update(&self.state.status, pressure, to_right, tolerance)
    }

    /// Flexibility that the line has for itself, on its nodes.
    pub fn alone(&self) -> Alone<'_> {
        Alone { kernel: self.kernel, grid: self.grid }
    }

    /// Slopes of gap and surfaces in the present iterate.
    pub fn slopes(&self) -> Slopes<'_> {
        let KnownPart { rail_slope, depth, .. } = self.given;
        Slopes { grid: self.grid, gap: &self.state.gap, overlap: &self.iterate.overlap, rail_slope, depth }
    }
}
