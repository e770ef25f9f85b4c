//! Two like elastic half-planes whose compliance is known in closed form: the discrete kernel
//! `G_j − G_{j+1} = 2/(πE*)/(j + ½)` to which the slip rows belong. The one place of these tests that builds a contact
//! problem.
#![allow(dead_code)]

use nalgebra::{DMatrix, DVector};
use wheelrail::analytic::{HalfPlane, carter_force, carter_full_slip, contact_modulus, hertz_half_width};
use wheelrail::axes::{Axis, PerAxis};
use wheelrail::contact::active_set::ActiveSetSolver;
use wheelrail::contact::line::ContactGrid;
use wheelrail::contact::{
    ActiveSetScratch, AxisDrive, Begin, ContactError, ContactProblem, ContactState, Drift, Friction, Influence, Layer,
    LineKernel, LineProblem, RigidMotion, SteelLimits, SurfaceResponse, Undeformed,
};
use wheelrail::multistep::TimeDerivative;
use wheelrail::piecewise::Piecewise;
use wheelrail::surface::{Flattening, Placement, Profile, Surfaces};

/// Radius of the cylinder [m].
pub const RADIUS: f64 = 0.5;
/// Displacement components at the points of the bodies.
const PORTS: usize = 10;
/// Rigid motions of the wheel.
const AXES: usize = Axis::COUNT;
/// Friction coefficient [1].
pub const FRICTION: f64 = 0.4;
/// Nominal line load [N/m].
pub const NOMINAL: f64 = 1e5;

pub struct HalfPlanes {
    pub grid: ContactGrid,
    pub surfaces: Surfaces,
    solver: ActiveSetSolver,
    /// Displacement of the ports of wheel and rail without forces [m].
    pub free: [DVector<f64>; 2],
    none: [DMatrix<f64>; 4],
    /// Layer between the surfaces.
    pub layer: Layer,
}

pub fn modulus() -> f64 {
    contact_modulus(200e9, 0.3)
}

/// Flexibility of half-planes whose displacement ends at a distance [m].
fn kernel(length: f64) -> LineKernel {
    LineKernel::of_half_plane(HalfPlane { kernel: 1.0 / (std::f64::consts::PI * modulus()), coupling: 0.0 }, length)
}

/// A line beside others.
#[derive(Clone, Copy)]
pub struct SideLine {
    /// Share of the width [1].
    pub share: f64,
    /// Height by which its wheel is lower than round [m].
    pub lower: f64,
    /// Friction coefficient [1].
    pub friction: f64,
}

impl HalfPlanes {
    pub fn new(per_half_width: usize) -> Self {
        let spacing = hertz_half_width(NOMINAL, RADIUS, modulus()) / per_half_width as f64;
        let half = (3 * per_half_width).div_ceil(2) as i64;
        let x = (-half..=half).map(|i| i as f64 * spacing).collect();
        let grid = ContactGrid::uniform(x, spacing, 3);
        let solver = ActiveSetSolver::new(grid.clone());
        let of = |rows, columns| DMatrix::zeros(rows, columns);
        let none = [of(PORTS, PORTS), of(PORTS, AXES), of(AXES, PORTS), of(AXES, AXES)];
        let free = [DVector::zeros(PORTS), DVector::zeros(PORTS)];
        Self { grid, surfaces: Surfaces::smooth(RADIUS), solver, free, none, layer: Layer::default() }
    }

    /// Turns the rim by an angle about the wheel centre [rad], positive where the tread moves towards `+x`.
    pub fn turned(mut self, angle: f64) -> Self {
        for (k, x) in self.grid.points.nodes().into_iter().enumerate() {
            let depth = (RADIUS * RADIUS - x * x).sqrt();
            (self.free[0][2 * k], self.free[0][2 * k + 1]) = (angle * depth, angle * x);
        }
        self
    }

    /// Shapes the rail so that the gap at the candidates is `gap` [m].
    pub fn with_gap(mut self, gap: impl Fn(f64) -> f64) -> Self {
        let circle = |x: f64| x * x / (RADIUS + (RADIUS * RADIUS - x * x).sqrt());
        let value = self.grid.x.iter().map(|&x| circle(x) - gap(x)).collect();
        self.surfaces.rail = Profile::from_samples(Piecewise { x: self.grid.x.clone(), value });
        self
    }

    /// Stationary rolling at mean speed 10 m/s.
    pub fn roll(&self, load: f64, creepage: f64, start: &ContactState) -> Result<ContactState, ContactError> {
        let rigid = Influence { compliance: [&self.none[0], &self.none[0]], relative: &self.none[0] };
        let line = SideLine { share: 1.0, lower: 0.0, friction: FRICTION };
        let found = self.roll_on(&[line], (rigid, 1.0), (load, creepage), &[start])?;
        Ok(found.into_iter().next().unwrap())
    }

    /// Stationary rolling of lines side by side at mean speed 10 m/s. Each has the displacements of [`LineKernel`] with
    /// the reach `length` [m] for itself; `shared` are those by the forces of all, of each half-plane, at the distance
    /// x.
    pub fn roll_lines(
        &self,
        lines: &[SideLine],
        (length, shared): (f64, &dyn Fn(f64) -> f64),
        (load, creepage): (f64, f64),
    ) -> Result<Vec<ContactState>, ContactError> {
        let points = self.grid.points.nodes();
        let between = |i: usize, j: usize| if i % 2 == j % 2 { shared(points[i / 2] - points[j / 2]) } else { 0.0 };
        let shared = DMatrix::from_fn(PORTS, PORTS, between);
        let both = 2.0 * &shared;
        let shared = Influence { compliance: [&shared, &shared], relative: &both };
        let start = self.start();
        self.roll_on(lines, (shared, length), (load, creepage), &vec![&start; lines.len()])
    }

    /// Rolling of lines between bodies that are displaced by the forces of all; `length`: reach of the flexibility that each
    /// line has for itself [m].
    fn roll_on(
        &self,
        lines: &[SideLine],
        (shared, length): (Influence, f64),
        (load, creepage): (f64, f64),
        start: &[&ContactState],
    ) -> Result<Vec<ContactState>, ContactError> {
        let hub = RigidMotion { drive: AxisDrive::Free { load: -load }, ..RigidMotion::held(0.0, 0.0) };
        let v = 10.0 * (1.0 + 0.5 * creepage);
        let omega = 10.0 * (1.0 - 0.5 * creepage) / RADIUS;
        let (flat, sound) = (Piecewise::default(), Flattening::none(0.0));
        let placement = Placement { surfaces: &self.surfaces, distance: 0.0, angle: 0.0, flattening: [&sound, &sound] };
        let ends = [self.grid.nodes()[0], -self.grid.nodes()[0]];
        let lower = |line: &SideLine| Piecewise { x: ends.to_vec(), value: vec![line.lower; 2] };
        let swollen: Vec<_> = lines.iter().map(lower).collect();
        let mut problems = Vec::new();
        for (line, swelling) in lines.iter().zip(&swollen) {
            problems.push(LineProblem {
                size: None,
                patch: None,
                share: line.share,
                position: 0.0,
                kernel: kernel(length),
                layer: self.layer,
                bodies: SurfaceResponse {
                    shared,
                    lift: 0.0,
                    free: [&self.free[0], &self.free[1]],
                    inertial: &self.none[1],
                    momentum: &self.none[2],
                    deformation_inertia: &self.none[3],
                },
                membrane: [&flat, &flat],
                time: TimeDerivative::default(),
                duration: 0.0,
                surfaces: Undeformed {
                    swelling: [swelling, &flat],
                    uneven: placement.unevenness(),
                    ..Undeformed::smooth(RADIUS)
                },
                limits: SteelLimits::none(&flat),
                friction: Friction::constant(line.friction),
            });
        }
        let problem = ContactProblem {
            lines: problems,
            rigid: PerAxis {
                travel: RigidMotion::held(v, 0.0),
                height: hub,
                rotation: RigidMotion::held(omega, 0.0),
                lateral: RigidMotion::held(0.0, 0.0),
            },
            drift: Drift::default(),
            nominal_load: NOMINAL,
            edge_tolerance: 1e-5,
            begin: Begin::Before(1.0),
        };
        let mut found = vec![ContactState::default(); lines.len()];
        let mut places: Vec<_> = found.iter_mut().collect();
        self.solver.solve(&problem, start, &mut places, &mut ActiveSetScratch::default())?;
        Ok(found)
    }

    /// The node in the middle touches.
    pub fn start(&self) -> ContactState {
        self.solver.touching(0.0)
    }

    pub fn full_slip(&self, load: f64) -> f64 {
        carter_full_slip(FRICTION, hertz_half_width(load, RADIUS, modulus()), RADIUS)
    }

    /// Relative utilisation error against Carter.
    pub fn carter_error(&self, load: f64, share: f64) -> f64 {
        let xi = share * self.full_slip(load);
        let solution = self.roll(load, xi, &self.start()).unwrap();
        solution.traction.resultant.travel / (FRICTION * load) - carter_force(xi, self.full_slip(load))
    }

    /// Nodal normal force at a candidate [N/m].
    pub fn normal(&self, state: &ContactState, i: usize) -> f64 {
        state.grid.forces[self.grid.component(i) + 1]
    }

    /// Nodal tangential force at a candidate [N/m].
    pub fn tangential(&self, state: &ContactState, i: usize) -> f64 {
        state.grid.forces[self.grid.component(i)]
    }
}
