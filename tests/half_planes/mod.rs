//! Two like elastic half-planes whose compliance is known in closed form: the discrete kernel
//! `G_j − G_{j+1} = 2/(πE*)/(j + ½)` to which the slip rows belong. The one place of these tests that builds a contact
//! problem.
#![allow(dead_code)]

use nalgebra::{DMatrix, DVector};
use wheelrail::analytic::{carter_force, carter_full_slip, contact_modulus, hertz_half_width};
use wheelrail::contact::{
    ContactError, ContactGrid, ContactProblem, ContactSolution, RigidMotion, Status, SurfaceResponse,
};

/// Radius of the cylinder [m].
pub const RADIUS: f64 = 0.5;
/// Friction coefficient [1].
pub const FRICTION: f64 = 0.4;
/// Nominal line load [N/m].
pub const NOMINAL: f64 = 1e5;

pub struct HalfPlanes {
    pub grid: ContactGrid,
    compliance: DMatrix<f64>,
    free: DVector<f64>,
    /// Gap of the undeformed bodies at the candidates [m].
    pub gap: Vec<f64>,
    none: [DMatrix<f64>; 3],
    offset: Vec<f64>,
}

pub fn modulus() -> f64 {
    contact_modulus(200e9, 0.3)
}

impl HalfPlanes {
    pub fn new(per_half_width: usize) -> Self {
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
    pub fn roll(&self, load: f64, creepage: f64, start: &ContactSolution) -> Result<ContactSolution, ContactError> {
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

    pub fn start(&self) -> ContactSolution {
        let mut start = ContactSolution::open(&self.grid);
        let middle = self.grid.len() / 2;
        start.status[middle] = Status::Stick;
        start
    }

    pub fn full_slip(&self, load: f64) -> f64 {
        carter_full_slip(FRICTION, hertz_half_width(load, RADIUS, modulus()), RADIUS)
    }

    /// Relative utilisation error against Carter.
    pub fn carter_error(&self, load: f64, share: f64) -> f64 {
        let xi = share * self.full_slip(load);
        let solution = self.roll(load, xi, &self.start()).unwrap();
        solution.resultant(&self.grid)[0] / (FRICTION * load) - carter_force(xi, self.full_slip(load))
    }
}
