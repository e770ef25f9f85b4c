//! Constants of all problems on a patch.

use super::chebyshev::TERMS;
use super::points::PointTables;
use super::tables::{SLOPE, Tables};
use crate::linalg::Lagrange;
use std::f64::consts::PI;

/// Parts into which θ is divided; there are three quarters as many sines.
pub const PARTS: usize = 16;
/// Values of a layer at the ends of the parts.
pub type LayerSamples = [f64; PARTS + 1];

/// Places and weights of the series of hot layers.
#[derive(Clone, Debug)]
pub struct LayerTables {
    /// `cos θ` at the ends of the parts.
    pub places: LayerSamples,
    /// Weights of the inner samples in the sines, by sine.
    pub sines: [[f64; PARTS - 1]; TERMS],
    /// Zeros of `T_16`.
    pub zeros: [f64; PARTS],
    /// Weights of the values there in the coefficients of `T_n`, by n.
    pub zeros_terms: [[f64; PARTS]; SLOPE],
}

impl LayerTables {
    /// All constants.
    pub fn new() -> Self {
        let angle = |m: usize| m as f64 * PI / PARTS as f64;
        let zero = |m: usize| angle(m) + 0.5 * angle(1);
        let mean = |n: usize| if n == 0 { 1.0 } else { 2.0 } / PARTS as f64;
        let weight = |k: usize, m: usize| 2.0 / PARTS as f64 * libm::sin((k + 1) as f64 * angle(m + 1));
        Self {
            places: std::array::from_fn(|m| libm::cos(angle(m))),
            sines: std::array::from_fn(|k| std::array::from_fn(|m| weight(k, m))),
            zeros: std::array::from_fn(|m| libm::cos(zero(m))),
            zeros_terms: std::array::from_fn(|n| std::array::from_fn(|m| mean(n) * libm::cos(n as f64 * zero(m)))),
        }
    }
}

impl Default for LayerTables {
    fn default() -> Self {
        Self::new()
    }
}

/// Constants of all problems on a patch.
#[derive(Clone, Debug)]
pub struct Constants {
    /// Points between which their smooth displacements are polynomials.
    pub points: Lagrange,
    /// Distance from the contact point within which patches lie \[m].
    pub zone: f64,
    /// Constants of the series.
    pub tables: Tables,
    /// Constants of points, and of points that slip where their tractions stand.
    pub of_points: PointTables,
    pub in_place: PointTables,
    /// Constants of hot layers.
    pub layers: LayerTables,
}

impl Constants {
    /// Those of smooth displacements that are polynomials through `points`.
    pub fn new(points: Lagrange) -> Self {
        Self {
            zone: points.reach,
            points,
            tables: Tables::new(),
            of_points: PointTables::new(),
            in_place: PointTables::upstream_by(0.0),
            layers: LayerTables::new(),
        }
    }
}
