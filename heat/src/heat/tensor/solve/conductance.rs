//! Conductance of the contact on its nodes.

use super::transport::upwind_within;
use crate::linalg::vectorised::vectorised;
use std::ops::Range;

/// First and one past the last element of the zone that conducts, from the moments `∫ k_c (1, ξ, ξ²) ds` on all of
/// them.
pub fn conducting(moments: &[[f64; 3]]) -> Range<usize> {
    let conducts = |c: &[f64; 3]| c[0] > 0.0;
    match moments.iter().position(conducts) {
        Some(first) => first..moments.iter().rposition(conducts).map_or(first, |last| last + 1),
        None => 0..0,
    }
}

/// `∫ k_c Nⱼ w̃ᵢ ds` of one element from the moments `∫ k_c (1, ξ, ξ²) ds`; `sigma` is the upwinding of the test
/// functions [1].
pub fn of_element([whole, first, second]: [f64; 3], sigma: f64) -> [[f64; 2]; 2] {
    let (left, right) = (whole - first, first);
    [
        [left - right + second - sigma * left, right - second - sigma * right],
        [right - second + sigma * left, second + sigma * right],
    ]
}

/// Rows of `∫ k_c Nⱼ w̃ᵢ ds` on the contact nodes.
#[derive(Clone, Debug, Default)]
pub struct ContactBands {
    lower: Vec<f64>,
    diagonal: Vec<f64>,
    upper: Vec<f64>,
}

impl ContactBands {
    /// Replaces the rows by those for the moments of the conductance and the upwinding `τ v / h` on the elements
    /// between the nodes.
    pub fn set(&mut self, moments: &[[f64; 3]], upwind: &[f64]) {
        let Self { lower, diagonal, upper } = self;
        for band in [&mut *lower, diagonal, upper] {
            band.resize(moments.len() + 1, 0.0);
        }
        // What an element adds to the row of its second node.
        let mut carried = [0.0; 2];
        let rows = lower.iter_mut().zip(&mut *diagonal).zip(&mut *upper);
        for (((lower, diagonal), upper), (c, &sigma)) in rows.zip(moments.iter().zip(upwind)) {
            let [[first, up], [low, second]] = of_element(*c, upwind_within(sigma, *c));
            (*lower, *diagonal, *upper) = (carried[0], carried[1] + first, up);
            carried = [low, second];
        }
        (lower[moments.len()], diagonal[moments.len()], upper[moments.len()]) = (carried[0], carried[1], 0.0);
    }

    /// Adds `factor · ∫ k_c d w̃ ds` to `load`, both given at the contact nodes.
    pub fn add_load(&self, factor: f64, d: &[f64], load: &mut [f64]) {
        let Self { lower, diagonal, upper } = self;
        load.iter_mut().zip(diagonal.iter().zip(d)).for_each(|(load, (c, d))| *load += factor * c * d);
        load.iter_mut().zip(upper.iter().zip(&d[1..])).for_each(|(load, (c, d))| *load += factor * c * d);
        load[1..].iter_mut().zip(lower[1..].iter().zip(d)).for_each(|(load, (c, d))| *load += factor * c * d);
    }

    /// Adds `flow` times the product of a row `g` of the response of a body with this matrix to a row of `A`.
    pub fn add_coupling(&self, flow: f64, g: &[f64], row: &mut [f64]) {
        add_banded(flow, g, [&self.lower, &self.diagonal, &self.upper], row);
    }
}

vectorised! {
    /// Adds `factor` times the product of a row vector `g` with the matrix of three bands (lower, diagonal, upper) to
    /// `row`.
    fn add_banded<'a, S>(simd, factor: f64, g: &'a [f64], bands: [&'a [f64]; 3], row: &'a mut [f64]) {
        let _ = simd;
        let (n, [lower, diagonal, upper]) = (row.len(), bands.map(|band| &band[..row.len()]));
        let g = &g[..n];
        for (row, (c, g)) in row.iter_mut().zip(diagonal.iter().zip(g)) {
            *row += factor * c * g;
        }
        for (row, (c, g)) in row[1..].iter_mut().zip(upper.iter().zip(g)) {
            *row += factor * c * g;
        }
        for (row, (c, g)) in row.iter_mut().zip(lower[1..].iter().zip(&g[1..])) {
            *row += factor * c * g;
        }
    }
}
