//! Half-spaces that roll on each other: the whole contact problem from a few numbers.
//!
//! Both bodies are of one material and rigid but for their half-spaces; their rigid motions are prescribed, but for the
//! height at which the wheel carries its load. Bodies that deform as a whole, motions that follow from forces, uneven
//! or hot surfaces and limits of the steel go into a [`ContactProblem`] of one's own.

use crate::analytic::{HalfPlane, contact_modulus, hertz_half_width};
use crate::axes::{Axis, PerAxis};
use crate::contact::line::ContactGrid;
use crate::contact::{
    ActiveSetScratch, ActiveSetSolver, AxisDrive, Begin, BySpeed, ContactError, ContactProblem, ContactState, Drift,
    Friction, HalfSpace, Influence, Layer, LineKernel, LineLayout, LineProblem, PatchLayout, PatchMaterial,
    RigidMotion, SteelLimits, SurfaceResponse, Traction, Undeformed,
};
use crate::linalg::POINTS;
use crate::multistep::{self, TimeDerivative};
use crate::patch::Hertz;
use crate::piecewise;
use nalgebra::{DMatrix, DVector};
use std::f64::consts::PI;

/// Nodes per half axis of the patch along the direction of rolling.
const NODES: usize = 20;
/// Half of the length of the grid over that of the patch under the nominal load \[1].
const ROOM: usize = 2;
/// Nodes beyond the grid on each side, at which slip is read but nothing touches.
const GUARD: usize = 3;
/// Change of the weights at the edges of the patch that counts as none \[1].
const EDGE_TOLERANCE: f64 = 1e-5;

/// Linear elastic material of both bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ElasticMaterial {
    /// Young's modulus \[Pa], positive.
    pub youngs_modulus: f64,
    /// Poisson's ratio \[1], from 0 to 0.5.
    pub poissons_ratio: f64,
}

impl ElasticMaterial {
    /// Contact modulus `E* = E/(2(1 − ν²))` of two bodies of the material \[Pa].
    pub fn contact_modulus(&self) -> f64 {
        contact_modulus(self.youngs_modulus, self.poissons_ratio)
    }

    fn patch_material(&self) -> PatchMaterial {
        let Self { youngs_modulus, poissons_ratio: nu } = *self;
        PatchMaterial {
            half_plane: HalfPlane {
                kernel: 1.0 / (PI * self.contact_modulus()),
                coupling: (1.0 - 2.0 * nu) * (1.0 + nu) / youngs_modulus,
            },
            half_space: HalfSpace { shear_modulus: 0.5 * youngs_modulus / (1.0 + nu), poissons_ratio: nu },
        }
    }
}

/// Prescribed rigid slip of the wheel over the speed of rolling.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Creepages {
    /// Along: `ξ = 2 (V − rΩ)/(V + rΩ)`, positive in braking \[1].
    pub along: f64,
    /// Across: lateral velocity over the speed of rolling, positive to the right \[1]. A strip has none.
    pub across: f64,
    /// Spin: turn about the vertical over the way [1/m]. A strip has none.
    pub spin: f64,
}

/// Conditions under which a wheel rolls on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RollingStep {
    /// Load \[N], of a strip per metre of its width [N/m]; positive, of a strip up to about four times the nominal one.
    pub load: f64,
    /// Speed of rolling `(V + rΩ)/2` [m/s], positive.
    pub speed: f64,
    /// Creepages at the end of the step.
    pub creepages: Creepages,
    /// Friction coefficient as a function of the slip at the end of the step.
    pub friction: Friction,
    /// Distance that the wheel rolls in the step \[m]; 0: it has rolled on like this for ever.
    pub distance: f64,
}

/// Contact of a wheel with a rail, both of one material, on lines side by side.
pub struct RollingContact {
    radius: f64,
    /// Width of the bodies [m], over which line loads are meant; of a strip one metre.
    width: f64,
    nominal_load: f64,
    shape: Shape,
    solver: ActiveSetSolver,
    rigid: RigidResponse,
    layout: Vec<LineLayout>,
    state: Vec<ContactState>,
    scratch: ActiveSetScratch,
    /// Length of the step before [s]; 0: none.
    before: f64,
}

/// Shape of the patch.
enum Shape {
    Strip,
    Ellipse(Box<PatchLayout>),
}

impl RollingContact {
    /// A cylinder of a `radius` \[m] on a plane, in plane strain; `nominal_load` [N/m] is that for which its nodes are laid
    /// out. Displacements of half-planes end nowhere: these end at the distance `reach` \[m], about the thickness of the
    /// bodies. The height of the wheel depends on it, and how fast forces follow a new creepage, but nothing stationary.
    /// All numbers are positive and finite. A fresh contact has no forces yet.
    pub fn cylinder(material: ElasticMaterial, radius: f64, nominal_load: f64, reach: f64) -> Self {
        let half_width = hertz_half_width(nominal_load, radius, material.contact_modulus());
        let kernel = LineKernel::of_half_plane(material.patch_material().half_plane, reach);
        let line = LineLayout { share: 1.0, half_length: half_width, kernel, ..LineLayout::default() };
        Self::new(Shape::Strip, [radius, 1.0, nominal_load], half_width, vec![line])
    }

    /// Smooth bodies with the relative radii of curvature along and across the direction of rolling \[m], Hertz's ellipse
    /// under a `nominal_load` \[N] on a number of `lines`, of which seven err by about 1 % of friction. All numbers are
    /// positive and finite. A fresh contact has no forces yet.
    pub fn ellipse(material: ElasticMaterial, radii: [f64; 2], nominal_load: f64, lines: usize) -> Self {
        let hertz = Hertz::new(radii[0], radii[1], material.contact_modulus());
        let ellipse = hertz.under(nominal_load);
        let width = 2.0 * ellipse.b;
        let patch = PatchLayout::ellipse(&hertz, radii[0], material.patch_material(), lines, width, nominal_load)
            .scaling(ellipse.a, 0.0)
            .sideways();
        let layout = patch.moving(nominal_load).collect();
        Self::new(Shape::Ellipse(Box::new(patch)), [radii[0], width, nominal_load], ellipse.a, layout)
    }

    fn new(shape: Shape, [radius, width, nominal_load]: [f64; 3], half_length: f64, layout: Vec<LineLayout>) -> Self {
        let (spacing, side) = (half_length / NODES as f64, (ROOM * NODES) as i32);
        let nodes = (-side..=side).map(|i| f64::from(i) * spacing).collect();
        let solver = ActiveSetSolver::new(ContactGrid::uniform(nodes, spacing, GUARD));
        let state = layout.iter().map(|_| solver.touching(half_length)).collect();
        let (rigid, scratch) = (RigidResponse::new(), ActiveSetScratch::default());
        Self { radius, width, nominal_load, shape, solver, rigid, layout, state, scratch, before: 0.0 }
    }

    /// Rolls on by a step, from what the one before has left.
    ///
    /// # Errors
    /// A patch that reaches the end of the grid, or states that do not settle; the contact is that of before then.
    pub fn roll(&mut self, step: &RollingStep) -> Result<(), ContactError> {
        let mut scratch = std::mem::take(&mut self.scratch);
        let rolled = self.solve(step, &mut scratch);
        self.scratch = scratch;
        let (layout, state, duration) = rolled?;
        (self.layout, self.state, self.before) = (layout, state, duration);
        Ok(())
    }

    /// Layout and states of the lines after a step, and its length \[s].
    fn solve(
        &self,
        step: &RollingStep,
        scratch: &mut ActiveSetScratch,
    ) -> Result<(Vec<LineLayout>, Vec<ContactState>, f64), ContactError> {
        let duration = step.distance / step.speed;
        let time = match duration > 0.0 {
            true => multistep::formula(duration, self.before),
            false => TimeDerivative::default(),
        };
        let layout = match &self.shape {
            Shape::Strip => self.layout.clone(),
            Shape::Ellipse(patch) => patch.moving(step.load).collect(),
        };
        let lines = layout.iter().enumerate().map(|(k, line)| self.line(step, (time, duration), (k, line)));
        let problem = ContactProblem {
            lines: lines.collect(),
            rigid: self.motions(step),
            drift: Drift {
                spin: BySpeed { per_travel: step.creepages.spin, ..BySpeed::default() },
                ..Drift::default()
            },
            nominal_load: self.nominal_load / self.width,
            edge_tolerance: EDGE_TOLERANCE,
            begin: Begin::Before(1.0),
        };
        let mut found = self.state.clone();
        let mut places: Vec<_> = found.iter_mut().collect();
        let start: Vec<_> = self.state.iter().collect();
        self.solver.solve(&problem, &start, &mut places, scratch)?;
        Ok((layout, found, duration))
    }

    /// Rigid motions that have the creepages; the height follows from the load.
    fn motions(&self, step: &RollingStep) -> PerAxis<RigidMotion> {
        let Creepages { along, across, .. } = step.creepages;
        let load = AxisDrive::Free { load: -step.load / self.width };
        PerAxis {
            travel: RigidMotion::held(step.speed * (1.0 + 0.5 * along), 0.0),
            height: RigidMotion { drive: load, ..RigidMotion::held(0.0, 0.0) },
            rotation: RigidMotion::held(step.speed * (1.0 - 0.5 * along) / self.radius, 0.0),
            lateral: RigidMotion::held(step.speed * across, 0.0),
        }
    }

    fn line(
        &self,
        step: &RollingStep,
        (time, duration): (TimeDerivative, f64),
        (number, layout): (usize, &LineLayout),
    ) -> LineProblem<'_> {
        let none = &piecewise::EMPTY;
        LineProblem {
            share: layout.share,
            position: layout.position,
            size: layout.size,
            kernel: layout.kernel,
            layer: Layer::default(),
            patch: match &self.shape {
                Shape::Strip => None,
                Shape::Ellipse(patch) => Some(layout.in_patch(patch.flexibility(), number)),
            },
            bodies: self.rigid.response(),
            membrane: [none; 2],
            time,
            duration,
            surfaces: Undeformed { elevation: -layout.gap, ..Undeformed::smooth(self.radius) },
            limits: SteelLimits::none(none),
            friction: step.friction,
        }
    }

    /// Forces on the wheel along, upward and across \[N], and the forward moment about its hub \[N m]; of a strip per
    /// metre of its width.
    pub fn forces(&self) -> PerAxis<f64> {
        self.lines().fold(PerAxis::default(), |mut sum, (layout, line)| {
            sum.add(self.width * layout.share, line.resultant);
            sum
        })
    }

    /// Moment of friction on the wheel about the vertical \[N m]; of a strip 0.
    pub fn spin_moment(&self) -> f64 {
        self.lines().map(|(layout, line)| self.width * layout.share * line.spin_moment).sum()
    }

    /// Share of the area of contact that sticks \[1].
    pub fn stick_fraction(&self) -> f64 {
        let area = |layout: &LineLayout, line: &Traction| layout.share * line.half_width();
        let stick: f64 = self.lines().map(|(layout, line)| area(layout, line) * line.stick_fraction).sum();
        stick / self.lines().map(|(layout, line)| area(layout, line)).sum::<f64>()
    }

    /// Lines with their layout and what their contact is like, per metre of width: tractions, slip, edges, power.
    pub fn lines(&self) -> impl Iterator<Item = (&LineLayout, &Traction)> {
        self.layout.iter().zip(self.state.iter().map(|state| &state.traction))
    }
}

/// Answer of bodies that are rigid but for their half-spaces.
struct RigidResponse {
    compliance: DMatrix<f64>,
    inertial: DMatrix<f64>,
    momentum: DMatrix<f64>,
    deformation_inertia: DMatrix<f64>,
    still: DVector<f64>,
}

impl RigidResponse {
    fn new() -> Self {
        let ports = 2 * POINTS;
        Self {
            compliance: DMatrix::zeros(ports, ports),
            inertial: DMatrix::zeros(ports, Axis::COUNT),
            momentum: DMatrix::zeros(Axis::COUNT, ports),
            deformation_inertia: DMatrix::zeros(Axis::COUNT, Axis::COUNT),
            still: DVector::zeros(ports),
        }
    }

    fn response(&self) -> SurfaceResponse<'_> {
        SurfaceResponse {
            shared: Influence { compliance: [&self.compliance; 2], relative: &self.compliance },
            lift: 0.0,
            free: [&self.still; 2],
            inertial: &self.inertial,
            momentum: &self.momentum,
            deformation_inertia: &self.deformation_inertia,
        }
    }
}
