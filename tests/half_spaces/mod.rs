//! Two half-spaces that touch in an ellipse, on contact lines side by side, and references for them by CONTACT.
#![allow(dead_code)]

use nalgebra::{DMatrix, DVector};
use serde_json::Value as Json;
use std::f64::consts::PI;
use wheelrail::analytic::{HalfPlane, contact_modulus};
use wheelrail::contact::active_set::ActiveSetSolver;
use wheelrail::contact::line::ContactGrid;
use wheelrail::contact::line::kernel::line_compliance;
use wheelrail::contact::series::{Fallback, SeriesSolver};
use wheelrail::contact::{
    AxisDrive, ContactError, ContactProblem, ContactScratch, ContactSolver, ContactState, Friction, Influence,
    LineLayout, LineProblem, PatchLayout, PatchMaterial, Ports, RigidMotion, SteelLimits, SurfaceResponse,
};
use wheelrail::multistep::TimeDerivative;
use wheelrail::patch::Hertz;
use wheelrail::piecewise::Piecewise;
use wheelrail::surface::{Flattening, Placement, Surfaces};

pub const FRICTION: f64 = 0.3;
pub const LOAD: f64 = 1e5;
/// Speed of rolling [m/s].
pub const SPEED: f64 = 20.0;
const NU: f64 = 0.3;
const YOUNG: f64 = 2.1e11;
/// Geometric mean of the half axes of all patches of the reference [m].
const MEAN_AXIS: f64 = 6e-3;
/// Width of the bodies, which are rigid here but for their half-spaces [m].
const WIDTH: f64 = 0.05;
/// Displacement components at the points of the smooth bodies, which do nothing here.
const SMOOTH: usize = 10;
/// Nodes of the grid on each side of the patch, over those per half axis [1].
const ROOM: f64 = 1.2;

fn modulus() -> f64 {
    contact_modulus(YOUNG, NU)
}

pub fn reference() -> Json {
    serde_json::from_str(include_str!("../contact_reference/ellipse.json")).unwrap()
}

pub fn number(value: &Json) -> f64 {
    value.as_f64().unwrap()
}

pub fn numbers(value: &Json) -> Vec<f64> {
    value.as_array().unwrap().iter().map(number).collect()
}

/// Run of the reference with this name.
pub fn run_of_reference(name: &str) -> Json {
    let reference = reference();
    let runs = reference["transient"].as_array().unwrap();
    runs.iter().find(|run| run["name"] == name).unwrap().clone()
}

/// Formula of second order for `d_t` in steps of `dt` seconds, of first order in the first one.
pub fn formula(dt: f64, first: bool) -> TimeDerivative {
    let weights = if first { [1.0, -1.0, 0.0] } else { [1.5, -2.0, 0.5] };
    TimeDerivative { a0: weights[0] / dt, a1: weights[1] / dt, a2: weights[2] / dt, b1: 0.0 }
}

/// Answer of bodies that do not move, at a number of displacement components.
struct RigidBodies {
    none: [DMatrix<f64>; 4],
    still: DVector<f64>,
}

impl RigidBodies {
    fn new(ports: usize) -> Self {
        let of = |rows, columns| DMatrix::zeros(rows, columns);
        Self { none: [of(ports, ports), of(ports, 3), of(3, ports), of(3, 3)], still: DVector::zeros(ports) }
    }

    /// With displacements by forces of a line that are its own.
    fn response<'a>(&'a self, own: Option<&'a [DMatrix<f64>; 2]>) -> SurfaceResponse<'a> {
        let nothing = Influence { compliance: [&self.none[0], &self.none[0]], relative: &self.none[0] };
        let of_line = |[body, both]: &'a [DMatrix<f64>; 2]| Influence { compliance: [body, body], relative: both };
        SurfaceResponse {
            own: own.map_or(nothing, of_line),
            others: own.map(|_| nothing),
            alone: None,
            lift: 0.0,
            free: [&self.still, &self.still],
            inertial: &self.none[1],
            momentum: &self.none[2],
            deformation_inertia: &self.none[3],
            retarded: [None; 2],
        }
    }
}

/// Two half-spaces that touch in an ellipse.
pub struct HalfSpaces {
    pub solver: SeriesSolver,
    pub hertz: Hertz,
    pub radius: f64,
    patch: PatchLayout,
    grid: ContactGrid,
    smooth: RigidBodies,
    nodes: RigidBodies,
}

/// Contact of all lines.
pub type Lines = Vec<ContactState>;

impl HalfSpaces {
    /// With the ratio `aspect` of the half axes along and across the direction of rolling.
    pub fn new(aspect: f64, lines: usize) -> Self {
        Self::with_grid(aspect, lines, 6)
    }

    /// With a grid of a number of nodes per half axis along the direction of rolling.
    pub fn with_grid(aspect: f64, lines: usize, nodes: usize) -> Self {
        // The radii of curvature of a unit contact of this aspect, scaled to the mean axis.
        let lateral = |ratio: f64| Hertz::new(1.0, ratio, modulus());
        let (mut low, mut high) = (1e-4_f64, 1e4_f64);
        for _ in 0..200 {
            let middle = (low * high).sqrt();
            if lateral(middle).aspect() > aspect { low = middle } else { high = middle }
        }
        let ratio = (low * high).sqrt();
        let unit = lateral(ratio).under(LOAD);
        let radius = (MEAN_AXIS * MEAN_AXIS / (unit.a * unit.b)).powf(1.5);
        let hertz = Hertz::new(radius, radius * ratio, modulus());
        let shear_modulus = 0.5 * YOUNG / (1.0 + NU);
        let half_plane = HalfPlane { kernel: 1.0 / (PI * modulus()), coupling: (1.0 - 2.0 * NU) * (1.0 + NU) / YOUNG };
        let material = PatchMaterial { half_plane, shear_modulus, poissons_ratio: NU };
        let (spacing, side) = (hertz.under(LOAD).a / nodes as f64, (ROOM * nodes as f64).ceil() as i32);
        let grid = ContactGrid::uniform((-side..=side).map(|i| f64::from(i) * spacing).collect(), spacing, 3);
        let fallback = if nodes > 6 { Fallback::ActiveSet } else { Fallback::Refuse };
        Self {
            solver: SeriesSolver::new(ActiveSetSolver::new(grid.clone()), 0.03, fallback),
            patch: PatchLayout::ellipse((&hertz, radius), material, (lines, WIDTH, LOAD)),
            hertz,
            radius,
            smooth: RigidBodies::new(SMOOTH),
            nodes: RigidBodies::new(grid.ports()),
            grid,
        }
    }

    /// Lines that touch, for the series.
    pub fn start(&self) -> Lines {
        (0..self.patch.len()).map(|_| self.solver.touching(self.hertz.under(LOAD).a)).collect()
    }

    /// Lines that touch and rest, on the grid.
    pub fn start_at_rest(&self) -> Lines {
        (0..self.patch.len()).map(|_| self.solver.touching_at_rest(0.0)).collect()
    }

    /// The state of the grid as that of the series, where all lines have one.
    pub fn as_series(&self, lines: &Lines) -> Option<Lines> {
        lines.iter().map(|line| self.solver.narrowed(line, LOAD / WIDTH)).collect()
    }

    pub fn layout(&self, load: f64) -> Vec<LineLayout> {
        self.patch.lay_out(load).collect()
    }

    /// Displacements of every line by its own forces on the nodes of the grid: of each body, and of both.
    fn own(&self, layout: &[LineLayout]) -> Vec<[DMatrix<f64>; 2]> {
        let of = |line: &LineLayout| {
            let body = line_compliance(&line.kernel, self.grid.nodes(), self.grid.spacing);
            let both = 2.0 * &body;
            [body, both]
        };
        layout.iter().map(of).collect()
    }

    /// Rolling under a `load`, with lines that are laid out for `laid_out`; `motion` are those of translation and
    /// rotation.
    pub fn solve(
        &self,
        (load, laid_out): (f64, f64),
        motion: [RigidMotion; 2],
        (time, friction): (TimeDerivative, Friction),
        start: &Lines,
    ) -> Result<Lines, ContactError> {
        let hub = RigidMotion { drive: AxisDrive::Free { load: -load / WIDTH }, ..RigidMotion::held(0.0, 0.0) };
        let (flat, sound, surfaces) = (Piecewise::default(), Flattening::none(0.0), Surfaces::smooth(self.radius));
        let layout = self.layout(laid_out);
        let series = start.iter().all(|line| line.ports == Ports::Smooth);
        let own = if series { Vec::new() } else { self.own(&layout) };
        let bodies = if series { &self.smooth } else { &self.nodes };
        let line = |(k, layout): (usize, &LineLayout)| LineProblem {
            share: layout.share,
            kernel: layout.kernel,
            bodies: bodies.response(own.get(k)),
            membrane: [&flat, &flat],
            time,
            duration: if time.is_stationary() { 0.0 } else { 1.0 / time.a0 },
            surfaces: &surfaces,
            placement: Placement {
                elevation: -layout.gap,
                distance: 0.0,
                angle: 0.0,
                growth: 0.0,
                swelling: [&flat, &flat],
                flattening: [&sound, &sound],
            },
            limits: SteelLimits::none(&flat),
            friction,
        };
        let problem = ContactProblem {
            lines: layout.iter().enumerate().map(line).collect(),
            rigid: [motion[0], hub, motion[1]],
            nominal_load: LOAD / WIDTH,
            edge_tolerance: 1e-5,
        };
        let mut found = start.clone();
        let before: Vec<_> = start.iter().collect();
        let mut after: Vec<_> = found.iter_mut().collect();
        self.solver.solve(&problem, &before, &mut after, &mut ContactScratch::default())?;
        Ok(found)
    }

    /// Prescribed creepage at a mean speed.
    pub fn held(&self, creepage: f64) -> [RigidMotion; 2] {
        let omega = SPEED * (1.0 - 0.5 * creepage) / self.radius;
        [RigidMotion::held(SPEED * (1.0 + 0.5 * creepage), 0.0), RigidMotion::held(omega, 0.0)]
    }

    /// A wheel that turns with the tread at the `speed` [m/s] and drives with a share of the friction limit: its
    /// translation follows.
    pub fn driven(&self, share: f64, speed: f64) -> [RigidMotion; 2] {
        let drive = AxisDrive::Free { load: -share * FRICTION * LOAD / WIDTH };
        [RigidMotion { drive, ..RigidMotion::held(speed, 0.0) }, RigidMotion::held(speed / self.radius, 0.0)]
    }

    pub fn roll(&self, load: f64, creepage: f64, time: TimeDerivative, start: &Lines) -> Lines {
        self.solve((load, load), self.held(creepage), (time, Friction::constant(FRICTION)), start).unwrap()
    }

    pub fn steady(&self, creepage: f64) -> Lines {
        self.roll(LOAD, creepage, TimeDerivative::default(), &self.start())
    }

    /// Sum over the lines, times their widths under a load.
    pub fn sum(&self, load: f64, lines: &Lines, of: impl Fn(&ContactState) -> f64) -> f64 {
        self.layout(load).iter().zip(lines).map(|(layout, line)| WIDTH * layout.share * of(line)).sum()
    }

    /// Driving force over friction times the nominal load.
    pub fn utilisation(&self, load: f64, lines: &Lines) -> f64 {
        self.sum(load, lines, |line| line.traction.resultant[0]) / (FRICTION * LOAD)
    }

    /// Share of the area that sticks.
    pub fn stick(&self, lines: &Lines) -> f64 {
        let area = |line: &ContactState| line.traction.half_width();
        self.sum(LOAD, lines, |line| area(line) * line.traction.stick_fraction) / self.sum(LOAD, lines, area)
    }
}
