//! Direct solver of one implicit step in one body.
//!
//! With the fields written in the modes across the streamlines, an implicit step is one tridiagonal system per mode,
//!
//! ```text
//! [μ ρc M̃ + β (k λₘ M̃ + F)] xₘ = bₘ ,
//! ```
//!
//! cyclic in the wheel. No result depends on the steps before, so that step size and speeds may change every time.
//! Fields are stored as `field[node · modes + mode]`; all recurrences run over the nodes and are vectors in the modes.

use super::depth_modes::DepthModes;
use super::rows;
use super::streamline::{Streamline, Transport};
use crate::linalg::Update;
use std::ops::Range;

/// A tensor mesh with its material.
#[derive(Clone, Debug)]
pub(super) struct HeatBody {
    /// Along the surface.
    pub line: Streamline,
    /// Across the streamlines.
    pub modes: DepthModes,
    /// Heat capacity `ρc` [J/(m³ K)].
    pub heat_capacity: f64,
    /// Conductivity [W/(m K)].
    pub conductivity: f64,
    /// Coefficient of convection from the surface to the air [W/(m² K)].
    pub film: f64,
}

/// Weights of storage and flow in the matrix of a step: `S = μ ρc M̃ + β A`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct StageCoefficients {
    /// `μ` [1].
    pub storage: f64,
    /// `β` [s]; 1 in the stationary state.
    pub flow: f64,
}

impl HeatBody {
    /// Number of values of a field.
    pub fn size(&self) -> usize {
        self.line.len() * self.modes.len()
    }

    /// `S x` with the operator of the modal solver.
    pub fn multiply(
        &self,
        transport: &Transport,
        coefficients: StageCoefficients,
        x: &[f64],
        out: &mut [f64],
        update: Update,
    ) {
        let (storage, flow) = self.alpha(coefficients);
        let weights = [storage, flow, coefficients.flow];
        rows::tridiagonal_product(transport, &self.modes.values, weights, x, out, update);
    }

    /// `out ← out + β k K ⊗ ∫(1/g − g)NN x`: the part of the conduction along the streamlines that the modal solver
    /// leaves out. `work` has the length of a field.
    pub fn add_curvature(&self, coefficients: StageCoefficients, x: &[f64], out: &mut [f64], work: &mut Vec<f64>) {
        if self.modes.curvature.is_empty() {
            return;
        }
        let nm = self.modes.len();
        work.clear();
        work.resize(self.size(), 0.0);
        for (e, h) in self.line.lengths.iter().enumerate() {
            let (a, b) = (e * nm, self.line.after(e) * nm);
            for m in 0..nm {
                let flux = coefficients.flow * self.conductivity / h * (x[a + m] - x[b + m]);
                work[a + m] += flux;
                work[b + m] -= flux;
            }
        }
        let columns = self.modes.curvature.as_slice();
        for (source, target) in work.chunks_exact(nm).zip(out.chunks_exact_mut(nm)) {
            for (value, column) in source.iter().zip(columns.chunks_exact(nm)) {
                target.iter_mut().zip(column).for_each(|(t, c)| *t += value * c);
            }
        }
    }

    /// Adds a surface load given at the nodes `first..` to a right-hand side.
    pub fn add_surface_load(&self, first: usize, load: &[f64], out: &mut [f64]) {
        self.add_load(first, load, &self.modes.surface, out);
    }

    /// Adds a load given at the nodes `first..` to a right-hand side; `across` are the values of the modes where it enters.
    pub fn add_load(&self, first: usize, load: &[f64], across: &[f64], out: &mut [f64]) {
        let nm = self.modes.len();
        // Most of a surface bears no load.
        let loaded = load.iter().zip(out[first * nm..].chunks_exact_mut(nm)).filter(|(value, _)| **value != 0.0);
        for (value, target) in loaded {
            target.iter_mut().zip(across).for_each(|(t, s)| *t += value * s);
        }
    }

    /// Surface values at a range of nodes.
    pub fn trace(&self, nodes: Range<usize>, x: &[f64], out: &mut Vec<f64>) {
        let nm = self.modes.len();
        out.resize(nodes.len(), 0.0);
        rows::products(&x[nodes.start * nm..nodes.end * nm], &self.modes.surface, out);
    }

    /// `∫ x ds` of every mode.
    pub fn integrate(&self, x: &[f64], sums: &mut Vec<f64>) {
        let nm = self.modes.len();
        sums.clear();
        sums.resize(nm, 0.0);
        rows::add_weighted(&self.line.weights, x, sums);
    }

    /// `a` and `b` in the weight `a + b λ` of the mass of a mode with the eigenvalue λ.
    pub fn alpha(&self, coefficients: StageCoefficients) -> (f64, f64) {
        (coefficients.storage * self.heat_capacity, coefficients.flow * self.conductivity)
    }
}

/// Scalar product of vectors whose length is a multiple of four.
#[inline(always)]
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 4];
    for (a, b) in a.chunks_exact(4).zip(b.chunks_exact(4)) {
        for l in 0..4 {
            sums[l] += a[l] * b[l];
        }
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3])
}
