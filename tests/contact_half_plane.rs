//! Contact algorithm alone, on elastic half-planes whose compliance is known in closed form: the discrete kernel
//! `G_j − G_{j+1} = 2/(πE*)/(j + ½)` to which the slip rows belong. Hertz and Carter are exact for the continuum.

mod common;
use common::Random;
use nalgebra::{DMatrix, DVector};
use wheelrail::analytic::{carter_force, carter_full_slip, contact_modulus, hertz_half_width};
use wheelrail::contact::grid::{ContactGrid, GridSolver, Status};
use wheelrail::contact::{
    AxisDrive, ContactError, ContactProblem, ContactSolver, ContactState, Placement, RigidMotion, Scratch, SolverState,
    SurfaceResponse, Surfaces, Traction,
};
use wheelrail::multistep::TimeDerivative;
use wheelrail::piecewise::Piecewise;

const RADIUS: f64 = 0.5;
const FRICTION: f64 = 0.4;
const NOMINAL: f64 = 1e5;
const GUARD: usize = 3;

struct HalfPlanes {
    solver: GridSolver,
    candidates: usize,
    half: DMatrix<f64>,
    relative: DMatrix<f64>,
    free: DVector<f64>,
    none: [DMatrix<f64>; 3],
}

fn modulus() -> f64 {
    contact_modulus(200e9, 0.3)
}

impl HalfPlanes {
    fn new(per_half_width: usize) -> Self {
        let spacing = hertz_half_width(NOMINAL, RADIUS, modulus()) / per_half_width as f64;
        let half = (3 * per_half_width).div_ceil(2) as i64;
        let x = (-half..=half).map(|i| i as f64 * spacing).collect();
        let grid = ContactGrid { x, spacing, guard: GUARD };
        let (n, candidates) = (grid.ports(), grid.len());
        // Relative compliance, shared equally; the constant (depth of the half-plane) is arbitrary.
        let mut kernel = vec![10.0 / modulus()];
        for j in 0..n {
            kernel.push(kernel[j] - 2.0 / (std::f64::consts::PI * modulus()) / (j as f64 + 0.5));
        }
        let half =
            DMatrix::from_fn(n, n, |i, j| if i % 2 == j % 2 { 0.5 * kernel[(i / 2).abs_diff(j / 2)] } else { 0.0 });
        // The compliance is that of the half-plane already: the correction vanishes.
        let solver = GridSolver::new(grid, &half, &half, modulus());
        let none = [DMatrix::zeros(n, 3), DMatrix::zeros(3, n), DMatrix::zeros(3, 3)];
        Self { solver, candidates, relative: 2.0 * &half, half, free: DVector::zeros(n), none }
    }

    /// Stationary rolling at mean speed 10 m/s.
    fn roll(&self, load: f64, creepage: f64, start: &ContactState) -> Result<ContactState, ContactError> {
        let hub = RigidMotion { drive: AxisDrive::Free { load: -load }, ..RigidMotion::held(0.0, 0.0) };
        let v = 10.0 * (1.0 + 0.5 * creepage);
        let omega = 10.0 * (1.0 - 0.5 * creepage) / RADIUS;
        let (flat, surfaces) = (Piecewise::default(), Surfaces::smooth(RADIUS));
        let problem = ContactProblem {
            bodies: SurfaceResponse {
                compliance: [&self.half, &self.half],
                relative: &self.relative,
                free: [&self.free, &self.free],
                inertial: &self.none[0],
                momentum: &self.none[1],
                deformation_inertia: &self.none[2],
            },
            membrane: [&flat, &flat],
            rigid: [RigidMotion::held(v, 0.0), hub, RigidMotion::held(omega, 0.0)],
            time: TimeDerivative::default(),
            surfaces: &surfaces,
            placement: Placement { distance: 0.0, angle: 0.0, growth: 0.0, swelling: &flat },
            friction: FRICTION,
            nominal_load: NOMINAL,
            edge_tolerance: 1e-5,
        };
        let mut found = ContactState::default();
        self.solver.solve(&problem, start, &mut found, &mut Scratch::default()).map(|()| found)
    }

    /// Traction of stationary rolling, from the middle node in contact.
    fn traction(&self, load: f64, creepage: f64) -> Result<Traction, ContactError> {
        self.roll(load, creepage, &self.start()).map(|state| state.traction)
    }

    fn start(&self) -> ContactState {
        self.solver.touching(0.0)
    }

    fn full_slip(&self, load: f64) -> f64 {
        carter_full_slip(FRICTION, hertz_half_width(load, RADIUS, modulus()), RADIUS)
    }

    /// Relative utilisation error against Carter.
    fn carter_error(&self, load: f64, share: f64) -> f64 {
        let xi = share * self.full_slip(load);
        self.traction(load, xi).unwrap().resultant[0] / (FRICTION * load) - carter_force(xi, self.full_slip(load))
    }
}

#[test]
fn carter_force_is_smooth_while_the_edges_move_between_nodes() {
    let bodies = HalfPlanes::new(20);
    for share in [0.3, 0.6, 0.8, 0.9, 0.95, -0.3, -0.6, -0.8, -0.9, -0.95] {
        let errors: Vec<f64> =
            (0..41).map(|k| bodies.carter_error(NOMINAL * (0.85 + 0.0075 * k as f64), share)).collect();
        let mean = errors.iter().sum::<f64>() / errors.len() as f64;
        let spread = errors.iter().cloned().fold(f64::MIN, f64::max) - errors.iter().cloned().fold(f64::MAX, f64::min);
        println!("share {share}: mean {mean:.5}, peak to peak {spread:.5}");
        assert!(mean.abs() <= 1e-3, "share {share}: mean {mean}");
        assert!(spread <= 2e-3, "share {share}: peak to peak {spread}");
    }
}

#[test]
fn half_width_is_smooth_and_hertzian() {
    let bodies = HalfPlanes::new(20);
    let errors: Vec<f64> = (0..61)
        .map(|k| {
            let load = NOMINAL * (0.85 + 0.005 * k as f64);
            let a = hertz_half_width(load, RADIUS, modulus());
            bodies.traction(load, 0.0).unwrap().half_width() / a - 1.0
        })
        .collect();
    let mean = errors.iter().sum::<f64>() / errors.len() as f64;
    let spread = errors.iter().cloned().fold(f64::MIN, f64::max) - errors.iter().cloned().fold(f64::MAX, f64::min);
    println!("half-width: mean {mean:.5}, peak to peak {spread:.5}");
    assert!(mean.abs() <= 1e-3 && spread <= 2e-3, "mean {mean}, peak to peak {spread}");
}

#[test]
fn carter_error_falls_with_order_one_and_a_half_or_better() {
    let spread = |n: usize| {
        let bodies = HalfPlanes::new(n);
        (0..15).map(|k| bodies.carter_error(NOMINAL * (0.9 + 0.013 * k as f64), 0.8).abs()).fold(0.0, f64::max)
    };
    let (coarse, fine) = (spread(10), spread(20));
    println!("largest error: a/10 {coarse:.5}, a/20 {fine:.5}");
    assert!((coarse / fine).log2() > 1.5, "observed order {:.2}", (coarse / fine).log2());
}

#[test]
fn a_patch_wider_than_the_candidate_zone_is_an_error() {
    let bodies = HalfPlanes::new(10);
    assert!(bodies.traction(2.0 * NOMINAL, 0.0).is_ok());
    let error = bodies.traction(4.0 * NOMINAL, 0.0).unwrap_err();
    assert!(matches!(error, ContactError::ZoneExceeded { .. }), "{error}");
}

#[test]
fn every_random_start_converges_to_the_same_contact_state() {
    let bodies = HalfPlanes::new(20);
    let mut random = Random(2);
    let (mut worst, mut total) = (0, 0);
    for case in 0..1000 {
        let load = NOMINAL * random.between(0.02, 1.92);
        let xi = random.sign() * random.logarithmic(1e-6, 1.5);
        let expected = bodies.traction(load, xi).unwrap_or_else(|e| panic!("case {case}: {e}"));
        let mut start = bodies.start();
        let SolverState::Grid(grid) = &mut start.solver else { panic!("state of another solver") };
        for i in 0..bodies.candidates {
            grid.status[i] = [Status::Open, Status::Stick, Status::SlipForward, Status::SlipBackward]
                [random.between(0.0, 4.0) as usize];
            start.traction.port_forces[2 * (i + GUARD) + 1] = random.between(0.0, load / 20.0);
        }
        let found = bodies.roll(load, xi, &start).unwrap_or_else(|e| panic!("case {case}, xi = {xi}: {e}"));
        let solution = found.traction;
        let difference = (&solution.port_forces - &expected.port_forces).amax() / load;
        assert!(difference < 1e-3, "case {case}, xi = {xi}, load {load}: {difference}");
        worst = worst.max(solution.iterations);
        total += solution.iterations;
    }
    println!("iterations: mean {:.2}, worst {worst}", total as f64 / 1000.0);
    assert!(worst <= 30, "{worst}");
}
