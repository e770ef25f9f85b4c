//! The elliptical patch on lines side by side between two half-spaces, where Hertz has a closed form and CONTACT
//! references of three-dimensional rolling contact.

use nalgebra::{DMatrix, DVector};
use serde_json::Value as Json;
use std::f64::consts::PI;
use wheelrail::analytic::{HalfPlane, contact_modulus};
use wheelrail::contact::active_set::ActiveSetSolver;
use wheelrail::contact::line::ContactGrid;
use wheelrail::contact::series::{Fallback, SeriesSolver};
use wheelrail::contact::{
    AxisDrive, ContactError, ContactProblem, ContactScratch, ContactSolver, ContactState, Friction, Influence,
    LineLayout, LineProblem, PatchLayout, PatchMaterial, RigidMotion, SteelLimits, SurfaceResponse,
};
use wheelrail::multistep::TimeDerivative;
use wheelrail::patch::Hertz;
use wheelrail::piecewise::Piecewise;
use wheelrail::surface::{Flattening, Placement, Surfaces};

const FRICTION: f64 = 0.3;
const LOAD: f64 = 1e5;
const NU: f64 = 0.3;
const YOUNG: f64 = 2.1e11;
/// Geometric mean of the half axes of all patches of the reference [m].
const MEAN_AXIS: f64 = 6e-3;
/// Width of the bodies, which are rigid here but for their half-spaces [m].
const WIDTH: f64 = 0.05;
/// Displacement components at the points of the smooth bodies, which do nothing here.
const PORTS: usize = 10;

fn modulus() -> f64 {
    contact_modulus(YOUNG, NU)
}

fn reference() -> Json {
    serde_json::from_str(include_str!("contact_reference/ellipse.json")).unwrap()
}

fn number(value: &Json) -> f64 {
    value.as_f64().unwrap()
}

fn numbers(value: &Json) -> Vec<f64> {
    value.as_array().unwrap().iter().map(number).collect()
}

/// Two half-spaces that touch in an ellipse.
struct HalfSpaces {
    solver: SeriesSolver,
    hertz: Hertz,
    radius: f64,
    patch: PatchLayout,
    none: [DMatrix<f64>; 4],
    still: DVector<f64>,
}

/// Contact of all lines.
type Lines = Vec<ContactState>;

impl HalfSpaces {
    /// With the ratio `aspect` of the half axes along and across the direction of rolling.
    fn new(aspect: f64, lines: usize) -> Self {
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
        let grid = ContactGrid::uniform((-9..=9).map(|i| f64::from(i) * 1e-3).collect(), 1e-3, 3);
        let none =
            [DMatrix::zeros(PORTS, PORTS), DMatrix::zeros(PORTS, 3), DMatrix::zeros(3, PORTS), DMatrix::zeros(3, 3)];
        Self {
            solver: SeriesSolver::new(ActiveSetSolver::new(grid), 0.03, Fallback::Refuse),
            patch: PatchLayout::ellipse((&hertz, radius), material, (lines, WIDTH, LOAD)),
            hertz,
            radius,
            none,
            still: DVector::zeros(PORTS),
        }
    }

    fn start(&self) -> Lines {
        (0..self.patch.len()).map(|_| self.solver.touching(self.hertz.under(LOAD).a)).collect()
    }

    fn layout(&self, load: f64) -> Vec<LineLayout> {
        self.patch.lay_out(load).collect()
    }

    /// Rolling at the mean speed `speed` under a `load`, with lines that are laid out for `laid_out`; `motion` are the
    /// drives of translation and rotation.
    fn solve(
        &self,
        (load, laid_out): (f64, f64),
        motion: [RigidMotion; 2],
        (time, friction): (TimeDerivative, Friction),
        start: &Lines,
    ) -> Result<Lines, ContactError> {
        let hub = RigidMotion { drive: AxisDrive::Free { load: -load / WIDTH }, ..RigidMotion::held(0.0, 0.0) };
        let (flat, sound, surfaces) = (Piecewise::default(), Flattening::none(0.0), Surfaces::smooth(self.radius));
        let nothing = Influence { compliance: [&self.none[0], &self.none[0]], relative: &self.none[0] };
        let line = |layout: LineLayout| LineProblem {
            share: layout.share,
            kernel: layout.kernel,
            bodies: SurfaceResponse {
                shared: nothing,
                alone: None,
                lift: 0.0,
                free: [&self.still, &self.still],
                inertial: &self.none[1],
                momentum: &self.none[2],
                deformation_inertia: &self.none[3],
                retarded: [None; 2],
            },
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
            lines: self.layout(laid_out).into_iter().map(line).collect(),
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

    /// Prescribed creepage at 20 m/s.
    fn held(&self, creepage: f64) -> [RigidMotion; 2] {
        let omega = 20.0 * (1.0 - 0.5 * creepage) / self.radius;
        [RigidMotion::held(20.0 * (1.0 + 0.5 * creepage), 0.0), RigidMotion::held(omega, 0.0)]
    }

    fn roll(&self, load: f64, creepage: f64, time: TimeDerivative, start: &Lines) -> Lines {
        self.solve((load, load), self.held(creepage), (time, Friction::constant(FRICTION)), start).unwrap()
    }

    fn steady(&self, creepage: f64) -> Lines {
        self.roll(LOAD, creepage, TimeDerivative::default(), &self.start())
    }

    /// Sum over the lines, times their widths under a load.
    fn sum(&self, load: f64, lines: &Lines, of: impl Fn(&ContactState) -> f64) -> f64 {
        self.layout(load).iter().zip(lines).map(|(layout, line)| WIDTH * layout.share * of(line)).sum()
    }

    /// Driving force over friction times the nominal load.
    fn utilisation(&self, load: f64, lines: &Lines) -> f64 {
        self.sum(load, lines, |line| line.traction.resultant[0]) / (FRICTION * LOAD)
    }
}

#[test]
fn half_axes_pressure_and_approach_are_those_of_hertz_from_a_tenth_to_twice_the_load() {
    for (aspect, lines) in [(0.5, 7), (1.0, 5), (1.0, 13), (2.0, 9)] {
        let spaces = HalfSpaces::new(aspect, lines);
        for share in [0.1, 0.5, 1.0, 1.9] {
            let load = share * LOAD;
            let exact = spaces.hertz.under(load);
            let found = spaces.roll(load, 0.0, TimeDerivative::default(), &spaces.start());
            let carried = spaces.sum(load, &found, |line| line.traction.resultant[1]);
            let approach = -found[0].traction.rigid[1];
            let mut worst = (approach / exact.approach - 1.0).abs();
            for (layout, line) in spaces.layout(load).iter().zip(&found) {
                let root = (1.0 - layout.ordinate.powi(2)).sqrt();
                worst = worst.max((line.traction.half_width() / (exact.a * root) - 1.0).abs());
                worst = worst.max((line.traction.pressure_max / (exact.peak * root) - 1.0).abs());
            }
            println!("{aspect} {lines} {share}: worst {worst:.1e}, load {:.1e}", carried / load - 1.0);
            assert!(worst < 1e-3 && (carried / load - 1.0).abs() < 1e-9);
        }
    }
}

#[test]
fn steady_creep_forces_and_stick_are_those_of_contact() {
    let reference = reference();
    for set in reference["steady"].as_array().unwrap() {
        let aspect = number(&set["aspect"]);
        for lines in [5, 7, 9, 13] {
            let spaces = HalfSpaces::new(aspect, lines);
            let mut worst = [0.0_f64; 2];
            for case in set["cases"].as_array().unwrap() {
                let [xi, force, stick] = [0, 1, 2].map(|k| number(&case[k]));
                let found = spaces.steady(xi);
                let area = |line: &ContactState| line.traction.half_width();
                let stuck = spaces.sum(LOAD, &found, |line| area(line) * line.traction.stick_fraction)
                    / spaces.sum(LOAD, &found, area);
                let errors = [spaces.utilisation(LOAD, &found) - force, stuck - stick];
                println!("{aspect} {lines} {xi:.5}: force {:+.4} of {force:.3}, stick {:+.4}", errors[0], errors[1]);
                worst.iter_mut().zip(errors).for_each(|(worst, error)| *worst = worst.max(error.abs()));
            }
            let stick = if aspect > 1.0 || lines < 7 { 0.05 } else { 0.03 };
            assert!(worst[0] < 0.02 && worst[1] < stick, "{aspect} {lines}: {worst:?}");
        }
    }
}

/// Formula of second order for `d_t` in steps of `dt` seconds, of first order in the first one.
fn formula(dt: f64, first: bool) -> TimeDerivative {
    let weights = if first { [1.0, -1.0, 0.0] } else { [1.5, -2.0, 0.5] };
    TimeDerivative { a0: weights[0] / dt, a1: weights[1] / dt, a2: weights[2] / dt, b1: 0.0 }
}

/// Largest errors of a run of the reference: creepage and load are given at the end of every step.
fn transient(case: &Json, lines: usize) -> f64 {
    let spaces = HalfSpaces::new(number(&case["aspect"]), lines);
    let (xi, load, force) = (numbers(&case["xi"]), numbers(&case["load"]), numbers(&case["Fx"]));
    let dt = 1e-3 * number(&case["ds_mm"]) / 20.0;
    let mut state = spaces.roll(LOAD, 0.0, TimeDerivative::default(), &spaces.start());
    let mut worst = 0.0_f64;
    for step in 0..xi.len() {
        state = spaces.roll(load[step], xi[step], formula(dt, step == 0), &state);
        let error = spaces.utilisation(load[step], &state) - force[step];
        worst = worst.max(error.abs());
    }
    println!("{} {lines}: {worst:.4}", case["name"]);
    worst
}

/// Forces of the reference are too large by .002 to .005 on the way to the steady state. Halving the steps changes ours by
/// less than 1e-4.
#[test]
fn creepage_that_jumps_or_swings_and_loads_that_vary_give_the_forces_of_contact() {
    let reference = reference();
    for case in reference["transient"].as_array().unwrap() {
        let name = case["name"].as_str().unwrap();
        if name.starts_with("cattaneo") || name.starts_with("held") {
            continue;
        }
        for lines in [5, 7, 9] {
            let tolerance = if name == "step88" && lines == 5 { 0.025 } else { 0.018 };
            assert!(transient(case, lines) < tolerance, "{name} {lines}");
        }
    }
}

/// Tractions over the middle and half of the half axis, where 13 lines have one nearby: mean difference over the mean.
#[test]
fn tractions_of_rows_are_those_of_contact() {
    let reference = reference();
    for set in reference["steady"].as_array().unwrap() {
        let spaces = HalfSpaces::new(number(&set["aspect"]), 13);
        for case in set["tractions"].as_array().unwrap() {
            let xi = number(&case["xi"]);
            let (found, layout) = (spaces.steady(xi), spaces.layout(LOAD));
            let lateral = spaces.hertz.under(LOAD).b;
            for row in case["rows"].as_object().unwrap().values() {
                let y = 1e-3 * number(&row["y_mm"]).abs();
                let distance = |layout: &LineLayout| (layout.ordinate * lateral - y).abs();
                let nearest = (0..layout.len()).min_by(|a, b| distance(&layout[*a]).total_cmp(&distance(&layout[*b])));
                let line = nearest.unwrap();
                let along = |y: f64| (1.0 - (y / lateral).powi(2)).sqrt();
                // Places of the row at the same share of its length.
                let scale = along(layout[line].ordinate * lateral) / along(y);
                let (mut apart, mut sum) = (0.0, 0.0);
                for (k, shear) in numbers(&row["px"]).into_iter().enumerate() {
                    let x = 1e-3 * (number(&row["x0_mm"]) + k as f64 * number(&row["dx_mm"]));
                    let ours = 1e-6 * found[line].traction.shear.at(x * scale) / scale;
                    apart += (ours - shear).abs();
                    sum += shear.abs();
                }
                println!("{} xi {xi:.5} y {y:.4}: {:.3}", number(&set["aspect"]), apart / sum);
                assert!(apart < 0.06 * sum);
            }
        }
    }
}
