//! Smooth part of the surface displacements: by forces, accelerations and the past, half-planes apart.

use crate::contact::problem::SingleLine;
use crate::linalg::POINTS;
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

impl SmoothSurfaces {
    /// Displacements under forces on the wheel and the rail's opposite ones, and under the `pulls` of hot layers on
    /// wheel and rail; `accelerations` are the rigid ones.
    pub fn new(problem: &SingleLine, moments: &Moments, pulls: &[AtPoints; 2], accelerations: [f64; 3]) -> Self {
        let bodies = &problem.line.bodies;
        let body = |index: usize, sign: f64| {
            let (free, compliance) = (bodies.free[index], bodies.own.compliance[index]);
            let mut own = PolynomialValues::default();
            for k in 0..POINTS {
                let (mut t, mut n) = (free[2 * k], free[2 * k + 1]);
                for l in 0..POINTS {
                    let (force_t, force_n) = (sign * moments.tangential[l] + pulls[index][l], sign * moments.normal[l]);
                    t += compliance[(2 * k, 2 * l)] * force_t + compliance[(2 * k, 2 * l + 1)] * force_n;
                    n += compliance[(2 * k + 1, 2 * l)] * force_t + compliance[(2 * k + 1, 2 * l + 1)] * force_n;
                }
                (own.tangential[k], own.normal[k]) = (t, n);
            }
            own
        };
        let (mut wheel, rail) = (body(0, 1.0), body(1, -1.0));
        for (axis, acceleration) in accelerations.into_iter().enumerate() {
            for k in 0..POINTS {
                wheel.tangential[k] += acceleration * bodies.inertial[(2 * k, axis)];
                wheel.normal[k] += acceleration * bodies.inertial[(2 * k + 1, axis)];
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
