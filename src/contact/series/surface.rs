//! Smooth part of the surface displacements: by forces, accelerations and the past, half-planes apart.

use crate::axes::PerAxis;
use crate::contact::flexibility::ByMoments;
use crate::contact::problem::SurfaceResponse;
use crate::linalg::vectorised::vectorised;
use crate::linalg::{Lagrange, POINTS};
use nalgebra::DMatrix;

/// Values at the points of the polynomial.
pub type AtPoints = [f64; POINTS];

/// A force on both components: moments with the polynomials of all points [N/m].
#[derive(Clone, Copy, Debug, Default)]
pub struct Moments {
    pub tangential: AtPoints,
    pub normal: AtPoints,
}

/// Smooth displacements \[m] of one body at the points of the polynomials.
#[derive(Clone, Copy, Debug, Default)]
pub struct PolynomialValues {
    pub tangential: AtPoints,
    pub normal: AtPoints,
}

/// Of wheel and rail.
#[derive(Clone, Copy, Debug, Default)]
pub struct SmoothSurfaces {
    pub wheel: PolynomialValues,
    pub rail: PolynomialValues,
}

pub fn dot(a: &AtPoints, b: &AtPoints) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// `a − b`.
pub fn less<const N: usize>(a: &[f64; N], b: &[f64; N]) -> [f64; N] {
    std::array::from_fn(|k| a[k] - b[k])
}

/// `a + b`.
pub fn plus<const N: usize>(a: &[f64; N], b: &[f64; N]) -> [f64; N] {
    std::array::from_fn(|k| a[k] + b[k])
}

impl Moments {
    /// Adds a multiple of others.
    pub fn add(&mut self, factor: f64, other: &Self) {
        for k in 0..POINTS {
            self.tangential[k] += factor * other.tangential[k];
            self.normal[k] += factor * other.normal[k];
        }
    }
}

impl PolynomialValues {
    /// The `free` displacements of all ports and those under forces on them; `compliance` by columns.
    fn under(free: &[f64], compliance: &[f64], forces: &[f64; 2 * POINTS]) -> Self {
        let all = under(free, compliance, forces);
        let component = |component: usize| std::array::from_fn(|k| all[2 * k + component]);
        Self { tangential: component(0), normal: component(1) }
    }
}

vectorised! {
    /// `free + C f` with the columns of `C`.
    fn under<'a, S>(_simd, free: &'a [f64], columns: &'a [f64], forces: &'a [f64; PORTS]) -> [f64; PORTS] {
        let (mut all, (columns, _)) = ([0.0; PORTS], columns.as_chunks::<PORTS>());
        all.copy_from_slice(free);
        for (column, force) in columns.iter().zip(forces) {
            for i in 0..PORTS {
                all[i] += column[i] * force;
            }
        }
        all
    }
}

/// Components of the forces on all points.
const PORTS: usize = 2 * POINTS;

impl SmoothSurfaces {
    /// Displacements under forces on the wheel and the rail's opposite ones, and under the `pulls` of hot layers on
    /// wheel and rail; `accelerations` are the rigid ones.
    pub fn new(
        bodies: &SurfaceResponse,
        moments: &Moments,
        pulls: &[AtPoints; 2],
        accelerations: PerAxis<f64>,
    ) -> Self {
        let shared = bodies.shared;
        let body = |index: usize, sign: f64| {
            let mut forces = [0.0; 2 * POINTS];
            for k in 0..POINTS {
                forces[2 * k] = sign * moments.tangential[k] + pulls[index][k];
                forces[2 * k + 1] = sign * moments.normal[k];
            }
            let free = bodies.free[index].as_slice();
            PolynomialValues::under(free, shared.compliance[index].as_slice(), &forces)
        };
        let (mut wheel, rail) = (body(0, 1.0), body(1, -1.0));
        let answers = bodies.inertial.as_slice().chunks(2 * POINTS);
        for (acceleration, answer) in accelerations.values().into_iter().zip(answers) {
            for k in 0..POINTS {
                wheel.tangential[k] += acceleration * answer[2 * k];
                wheel.normal[k] += acceleration * answer[2 * k + 1];
            }
        }
        Self { wheel, rail }
    }

    /// Tangential displacement of the wheel less that of the rail.
    pub fn relative(&self) -> AtPoints {
        less(&self.wheel.tangential, &self.rail.tangential)
    }

    /// Rise of the gap.
    pub fn gap(&self) -> AtPoints {
        less(&self.wheel.normal, &self.rail.normal)
    }
}

/// Row `at · compliance` of one pair of components, by point of the force.
pub fn answer(compliance: &DMatrix<f64>, component: usize, force: usize, at: &AtPoints) -> AtPoints {
    std::array::from_fn(|l| (0..POINTS).map(|k| at[k] * compliance[(2 * k + component, 2 * l + force)]).sum())
}

/// Tangential displacements of wheel and rail by unit moments of a shear on the wheel, and the rail's opposite one,
/// with the powers of `x/reach`, as polynomials of it.
pub fn displaced_by_powers(bodies: &SurfaceResponse, points: &Lagrange) -> [ByMoments; 2] {
    [(0, 1.0), (1, -1.0)].map(|(body, sign)| {
        let compliance = bodies.shared.compliance[body];
        std::array::from_fn(|n| {
            let forces = points.moments(&std::array::from_fn(|k| if k == n { sign } else { 0.0 }));
            let moved = |k: usize| (0..POINTS).map(|l| compliance[(2 * k, 2 * l)] * forces[l]).sum();
            points.polynomial(&std::array::from_fn(moved)).by_powers(points.reach)
        })
    })
}
