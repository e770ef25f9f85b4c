//! Contact algorithm alone, on elastic half-planes whose compliance is known in closed form: the discrete kernel
//! `G_j − G_{j+1} = 2/(πE*)/(j + ½)` to which the slip rows belong. Hertz and Carter are exact for the continuum.

mod common;
use common::Random;
use nalgebra::{DMatrix, DVector};
use wheelrail::analytic::{carter_force, carter_full_slip, contact_modulus, hertz_half_width};
use wheelrail::contact::{
    ContactError, ContactGrid, ContactProblem, ContactSolution, RigidMotion, Status, SurfaceResponse, patch,
};

const RADIUS: f64 = 0.5;
const FRICTION: f64 = 0.4;
const NOMINAL: f64 = 1e5;

struct HalfPlanes {
    grid: ContactGrid,
    compliance: DMatrix<f64>,
    free: DVector<f64>,
    gap: Vec<f64>,
    none: [DMatrix<f64>; 3],
    offset: Vec<f64>,
}

fn modulus() -> f64 {
    contact_modulus(200e9, 0.3)
}

impl HalfPlanes {
    fn new(per_half_width: usize) -> Self {
        let spacing = hertz_half_width(NOMINAL, RADIUS, modulus()) / per_half_width as f64;
        let half = (3 * per_half_width).div_ceil(2) as i64;
        let x = (-half..=half).map(|i| i as f64 * spacing).collect();
        let grid = ContactGrid { x, spacing, guard: 3, radius: RADIUS };
        let n = grid.surface_dofs();
        // Relative compliance, shared equally; the constant (depth of the half-plane) is arbitrary.
        let mut kernel = vec![10.0 / modulus()];
        for j in 0..n {
            kernel.push(kernel[j] - 2.0 / (std::f64::consts::PI * modulus()) / (j as f64 + 0.5));
        }
        let compliance =
            DMatrix::from_fn(n, n, |i, j| if i % 2 == j % 2 { 0.5 * kernel[(i / 2).abs_diff(j / 2)] } else { 0.0 });
        let gap = (0..grid.len()).map(|i| grid.undeformed_gap(i)).collect();
        let none = [DMatrix::zeros(n, 3), DMatrix::zeros(3, n), DMatrix::zeros(3, 3)];
        let offset = vec![0.0; grid.len()];
        Self { grid, compliance, free: DVector::zeros(n), gap, none, offset }
    }

    /// Stationary rolling at mean speed 10 m/s.
    fn roll(&self, load: f64, creepage: f64, start: &ContactSolution) -> Result<ContactSolution, ContactError> {
        let fixed = |value| RigidMotion { value, prescribed: true, ..RigidMotion::default() };
        let v = 10.0 * (1.0 + 0.5 * creepage);
        let omega = 10.0 * (1.0 - 0.5 * creepage) / RADIUS;
        let response = SurfaceResponse { compliance: &self.compliance, free: &self.free };
        ContactProblem {
            grid: &self.grid,
            radius: RADIUS,
            wheel: response,
            rail: response,
            wheel_loads: &self.none[0],
            momentum: &self.none[1],
            momentum_loads: &self.none[2],
            rigid: [fixed(v), RigidMotion { load: -load, ..RigidMotion::default() }, fixed(omega)],
            slip_gain: 0.0,
            slip_offset: &self.offset,
            gap: &self.gap,
            friction: FRICTION,
            nominal_load: NOMINAL,
            edge_tolerance: 1e-5,
        }
        .solve(start)
    }

    fn start(&self) -> ContactSolution {
        let mut start = ContactSolution::open(&self.grid);
        let middle = self.grid.len() / 2;
        start.status[middle] = Status::Stick;
        start
    }

    fn full_slip(&self, load: f64) -> f64 {
        carter_full_slip(FRICTION, hertz_half_width(load, RADIUS, modulus()), RADIUS)
    }

    /// Relative utilisation error against Carter.
    fn carter_error(&self, load: f64, share: f64) -> f64 {
        let xi = share * self.full_slip(load);
        let solution = self.roll(load, xi, &self.start()).unwrap();
        solution.resultant(&self.grid)[0] / (FRICTION * load) - carter_force(xi, self.full_slip(load))
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
            let solution = bodies.roll(load, 0.0, &bodies.start()).unwrap();
            let a = hertz_half_width(load, RADIUS, modulus());
            patch::observe(&bodies.grid, &solution, FRICTION).half_width / a - 1.0
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
    assert!(bodies.roll(2.0 * NOMINAL, 0.0, &bodies.start()).is_ok());
    let error = bodies.roll(4.0 * NOMINAL, 0.0, &bodies.start()).unwrap_err();
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
        let expected = bodies.roll(load, xi, &bodies.start()).unwrap_or_else(|e| panic!("case {case}: {e}"));
        let mut start = ContactSolution::open(&bodies.grid);
        for (i, status) in start.status.iter_mut().enumerate() {
            *status = [Status::Open, Status::Stick, Status::SlipForward, Status::SlipBackward]
                [random.between(0.0, 4.0) as usize];
            start.forces[bodies.grid.dof(i) + 1] = random.between(0.0, load / 20.0);
        }
        let solution = bodies.roll(load, xi, &start).unwrap_or_else(|e| panic!("case {case}, xi = {xi}: {e}"));
        let difference = (&solution.forces - &expected.forces).amax() / load;
        assert!(difference < 1e-3, "case {case}, xi = {xi}, load {load}: {difference}");
        worst = worst.max(solution.iterations);
        total += solution.iterations;
    }
    println!("iterations: mean {:.2}, worst {worst}", total as f64 / 1000.0);
    assert!(worst <= 30, "{worst}");
}
