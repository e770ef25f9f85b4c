//! Two half-spaces that touch in an ellipse, on contact lines side by side, and references for them by CONTACT.
#![allow(dead_code)]

#[path = "../rigid_bodies/mod.rs"]
mod rigid_bodies;

use rigid_bodies::{RigidBodies, Step};
use serde_json::Value as Json;
use std::f64::consts::PI;
use wheelrail::analytic::{HalfPlane, contact_modulus};
use wheelrail::contact::line::ContactGrid;
use wheelrail::contact::{
    ActiveSetScratch, ActiveSetSolver, AxisDrive, BySpeed, ContactError, ContactState, Drift, Friction, HalfSpace,
    LineLayout, PatchLayout, PatchMaterial, RigidMotion,
};
use wheelrail::multistep::TimeDerivative;
use wheelrail::patch::Hertz;
use wheelrail::patch::rows::{PatchRow, equivalent_ellipse};

/// A wheel that turns about the normal by an angle per distance [1/m].
pub fn turning(per_travel: f64) -> Drift {
    Drift { spin: BySpeed { per_travel, ..BySpeed::default() }, ..Drift::default() }
}

/// Friction coefficient [1].
pub const FRICTION: f64 = 0.3;
/// Load [N].
pub const LOAD: f64 = 1e5;
/// Speed of rolling [m/s].
pub const SPEED: f64 = 20.0;
pub const NU: f64 = 0.3;
const YOUNG: f64 = 2.1e11;
/// Shear modulus \[Pa].
pub const SHEAR_MODULUS: f64 = 0.5 * YOUNG / (1.0 + NU);
/// Geometric mean of the half axes of all patches of the reference [m].
const MEAN_AXIS: f64 = 6e-3;
/// Width of the bodies, which are rigid here but for their half-spaces [m].
const WIDTH: f64 = 0.05;
/// Nodes per half axis along the direction of rolling, twice those of the product: errors are those of lines.
pub const NODES: u32 = 20;
/// Half of the length of the grid over that of the patch [1].
const ROOM: f64 = 2.0;

fn modulus() -> f64 {
    contact_modulus(YOUNG, NU)
}

fn material() -> PatchMaterial {
    let half_plane = HalfPlane { kernel: 1.0 / (PI * modulus()), coupling: (1.0 - 2.0 * NU) * (1.0 + NU) / YOUNG };
    let half_space = HalfSpace { shear_modulus: SHEAR_MODULUS, poissons_ratio: NU };
    PatchMaterial { half_plane, half_space }
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

/// Contact of all lines.
pub type Lines = Vec<ContactState>;

/// Two half-spaces that touch in an ellipse.
pub struct HalfSpaces {
    solver: ActiveSetSolver,
    pub hertz: Hertz,
    pub radius: f64,
    patch: PatchLayout,
    /// Bodies that are rigid but for the lines.
    bodies: RigidBodies,
}

impl HalfSpaces {
    /// With the ratio `aspect` of the half axes along and across the direction of rolling.
    pub fn new(aspect: f64, lines: usize) -> Self {
        Self::on_nodes(aspect, lines, NODES)
    }

    /// As [`Self::new`], and every line takes lateral creepage and spin.
    pub fn sideways(aspect: f64, lines: usize) -> Self {
        Self::sideways_on_nodes(aspect, lines, NODES)
    }

    /// A circle that takes lateral creepage, of steel as stiff in contact but without Poisson's ratio: it answers along as across.
    pub fn isotropic(lines: usize) -> Self {
        let round = Self::new(1.0, 1);
        let PatchMaterial { half_plane, half_space } = material();
        let shear_modulus = half_space.shear_modulus / (1.0 - half_space.poissons_ratio);
        let half_space = HalfSpace { shear_modulus, poissons_ratio: 0.0 };
        let material = PatchMaterial { half_plane: HalfPlane { coupling: 0.0, ..half_plane }, half_space };
        let patch = PatchLayout::ellipse(&round.hertz, round.radius, material, lines, WIDTH, LOAD).sideways();
        Self { patch, ..round }
    }

    /// Rows of a real patch that takes lateral creepage and spin, as lines.
    pub fn of_rows(rows: Vec<PatchRow>, radius: f64, lines: usize) -> Self {
        let shapes = [equivalent_ellipse(&rows).unwrap()];
        let other = Self::new(1.0, 1);
        let patch = PatchLayout::rows(rows, &shapes, material(), lines, radius, WIDTH).sideways();
        Self { patch, radius, ..other }
    }

    /// As [`Self::sideways`], on a number of `nodes` per half axis along the direction of rolling.
    pub fn sideways_on_nodes(aspect: f64, lines: usize, nodes: u32) -> Self {
        let along = Self::on_nodes(aspect, lines, nodes);
        Self { patch: along.patch.sideways(), ..along }
    }

    /// As [`Self::new`], on a number of `nodes` per half axis along the direction of rolling.
    pub fn on_nodes(aspect: f64, lines: usize, nodes: u32) -> Self {
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
        let (spacing, side) = (hertz.under(LOAD).a / f64::from(nodes), (ROOM * f64::from(nodes)).ceil() as i32);
        let grid = ContactGrid::uniform((-side..=side).map(|i| f64::from(i) * spacing).collect(), spacing, 3);
        Self {
            solver: ActiveSetSolver::new(grid),
            patch: PatchLayout::ellipse(&hertz, radius, material(), lines, WIDTH, LOAD)
                .scaling(hertz.under(LOAD).a, 0.0),
            hertz,
            radius,
            bodies: RigidBodies::new(),
        }
    }

    /// Lines that touch.
    pub fn start(&self) -> Lines {
        (0..self.patch.len()).map(|_| self.solver.touching(self.hertz.under(LOAD).a)).collect()
    }

    pub fn layout(&self, load: f64) -> Vec<LineLayout> {
        self.patch.moving(load).collect()
    }

    /// Contact under a `load`; `motion` are those of translation and rotation.
    pub fn solve(
        &self,
        load: f64,
        motion: [RigidMotion; 2],
        laws: (TimeDerivative, Friction),
        start: &Lines,
    ) -> Result<Lines, ContactError> {
        self.solve_sideways(load, [motion[0], motion[1], RigidMotion::held(0.0, 0.0)], Drift::default(), laws, start)
    }

    /// Contact under a `load`; `motion` are those of translation, rotation and lateral translation.
    pub fn solve_sideways(
        &self,
        load: f64,
        motion: [RigidMotion; 3],
        drift: Drift,
        laws: (TimeDerivative, Friction),
        start: &Lines,
    ) -> Result<Lines, ContactError> {
        self.solve_with(load, motion, drift, laws, start, &mut ActiveSetScratch::default())
    }

    /// [`Self::solve_sideways`] with the memory of the solver. Without a load the wheel is in the air.
    pub fn solve_with(
        &self,
        load: f64,
        motion: [RigidMotion; 3],
        drift: Drift,
        laws: (TimeDerivative, Friction),
        start: &Lines,
        scratch: &mut ActiveSetScratch,
    ) -> Result<Lines, ContactError> {
        let layout = self.layout(if load > 0.0 { load } else { LOAD });
        let load = [load / WIDTH, LOAD / WIDTH];
        let (lines, flexibility) = (&layout[..], Some(&**self.patch.flexibility()));
        let step = Step { radius: self.radius, lines, flexibility, load, motion, drift, laws };
        self.bodies.solve_with(&self.solver, &step, start, scratch)
    }

    /// Motions with a prescribed creepage.
    pub fn held(&self, creepage: f64) -> [RigidMotion; 2] {
        let omega = SPEED * (1.0 - 0.5 * creepage) / self.radius;
        [RigidMotion::held(SPEED * (1.0 + 0.5 * creepage), 0.0), RigidMotion::held(omega, 0.0)]
    }

    /// Motions of a wheel whose tread moves with a `speed` [m/s] and drives with a `share` of the friction limit: the
    /// translation follows.
    pub fn driven(&self, share: f64, speed: f64) -> [RigidMotion; 2] {
        let drive = AxisDrive::Free { load: -share * FRICTION * LOAD / WIDTH };
        [RigidMotion { drive, ..RigidMotion::held(speed, 0.0) }, RigidMotion::held(speed / self.radius, 0.0)]
    }

    /// Creepage of a wheel that is [`Self::driven`] at the speed of rolling.
    pub fn creepage(lines: &Lines) -> f64 {
        let translation = lines[0].traction.rigid.travel;
        (translation - SPEED) / (0.5 * (translation + SPEED))
    }

    pub fn roll(&self, load: f64, creepage: f64, time: TimeDerivative, start: &Lines) -> Lines {
        self.solve(load, self.held(creepage), (time, Friction::constant(FRICTION)), start).unwrap()
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
        self.sum(load, lines, |line| line.traction.resultant.travel) / (FRICTION * LOAD)
    }

    /// Share of the area that sticks.
    pub fn stick(&self, lines: &Lines) -> f64 {
        let area = |line: &ContactState| line.traction.half_width();
        self.sum(LOAD, lines, |line| area(line) * line.traction.stick_fraction) / self.sum(LOAD, lines, area)
    }
}
