//! Polynomials through a few points of an interval: smooth functions as their values there.

use super::LinalgError;
use nalgebra::DMatrix;
use std::f64::consts::PI;

/// Number of points: polynomials of the fourth degree.
pub const POINTS: usize = 5;

/// Lagrange's polynomials of the Chebyshev points of the interval `[−reach, reach]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Lagrange {
    /// Half of the length of the interval.
    pub reach: f64,
    /// Coefficients by powers of `x/reach`: row k belongs to the polynomial that is 1 at point k.
    coefficients: [[f64; POINTS]; POINTS],
}

impl Lagrange {
    /// Polynomials on the interval `[−reach, reach]`.
    pub fn new(reach: f64) -> Self {
        let nodes = Self::places();
        let coefficients = std::array::from_fn(|k| {
            let mut product = [0.0; POINTS];
            product[0] = 1.0;
            for (_, other) in nodes.iter().enumerate().filter(|(l, _)| *l != k) {
                let scale = 1.0 / (nodes[k] - other);
                for power in (0..POINTS).rev() {
                    let lower = if power > 0 { product[power - 1] } else { 0.0 };
                    product[power] = scale * (lower - other * product[power]);
                }
            }
            product
        });
        Self { reach, coefficients }
    }

    /// Chebyshev points of the interval [−1, 1].
    fn places() -> [f64; POINTS] {
        std::array::from_fn(|k| -libm::cos((k as f64 + 0.5) * PI / POINTS as f64))
    }

    /// The points.
    pub fn nodes(&self) -> [f64; POINTS] {
        Self::places().map(|place| place * self.reach)
    }

    /// Values of all polynomials at x.
    pub fn values(&self, x: f64) -> [f64; POINTS] {
        let s = x / self.reach;
        self.coefficients.each_ref().map(|c| c.iter().rev().fold(0.0, |sum, c| sum * s + c))
    }

    /// The polynomial with these values at the points.
    pub fn polynomial(&self, values: &[f64; POINTS]) -> Polynomial {
        let power = |power: usize| values.iter().zip(&self.coefficients).map(|(v, c)| v * c[power]).sum();
        Polynomial { reach: self.reach, coefficients: std::array::from_fn(power) }
    }

    /// Matrix that turns values at the positions `x` into those at the points: least squares.
    pub fn projection(&self, x: &[f64]) -> Result<DMatrix<f64>, LinalgError> {
        let design = DMatrix::from_fn(x.len(), POINTS, |i, k| self.values(x[i])[k]);
        let factor = (design.transpose() * &design).cholesky().ok_or_else(|| {
            let reason = format!("{} places for polynomials through {POINTS} points", x.len());
            LinalgError::NotPositiveDefinite { size: POINTS, reason }
        })?;
        Ok(factor.solve(&design.transpose()))
    }
}

/// One polynomial on the interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Polynomial {
    reach: f64,
    /// By powers of `x/reach`.
    coefficients: [f64; POINTS],
}

impl Polynomial {
    /// Its derivative at x.
    pub fn slope(&self, x: f64) -> f64 {
        let s = x / self.reach;
        (1..POINTS).rev().fold(0.0, |sum, k| sum * s + k as f64 * self.coefficients[k]) / self.reach
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quartic_is_found_from_its_values_and_has_its_slope() {
        let basis = Lagrange::new(3.0);
        let quartic = |x: f64| 2.0 - x + 0.5 * x * x - 0.1 * x.powi(3) + 0.03 * x.powi(4);
        let x: Vec<f64> = (0..21).map(|i| -3.3 + 0.33 * f64::from(i)).collect();
        let values = nalgebra::DVector::from_iterator(21, x.iter().map(|&x| quartic(x)));
        let nodes = basis.projection(&x).unwrap() * values;
        let polynomial = basis.polynomial(&std::array::from_fn(|k| nodes[k]));
        for x in [-3.0_f64, -1.2, 0.0, 0.7, 2.9] {
            let dot = |weights: [f64; POINTS]| weights.iter().zip(&nodes).map(|(w, v)| w * v).sum::<f64>();
            let slope = -1.0 + x - 0.3 * x * x + 0.12 * x.powi(3);
            assert!((dot(basis.values(x)) - quartic(x)).abs() < 1e-12);
            assert!((polynomial.slope(x) - slope).abs() < 1e-12);
            assert!((basis.values(x).iter().sum::<f64>() - 1.0).abs() < 1e-13);
        }
    }
}
