//! Factors of the tridiagonal systems of one implicit step, one system per mode across the streamlines.

use super::modal::{HeatBody, StageCoefficients};
use super::rows;
use super::streamline::Transport;
use crate::heat::error::HeatError;

/// Factors of the tridiagonal systems of all modes.
///
/// The chain of nodes (without the last one on a closed streamline, which borders it) has `T = (1 + w)(1/inverse)(1 +
/// r)` with subdiagonal `w` and superdiagonal `r`.
#[derive(Clone, Debug, Default)]
pub(super) struct TridiagonalFactor {
    pub(super) w: Vec<f64>,
    pub(super) r: Vec<f64>,
    pub(super) inverse: Vec<f64>,
    /// `T⁻¹ b`, b the column of the bordering node.
    pub(super) column: Vec<f64>,
    /// `T⁻ᵀ c`, c the row of the bordering node.
    pub(super) row: Vec<f64>,
    /// Row entries of the bordering node towards the first and the last node of the chain, and its inverse pivot.
    pub(super) border: [Vec<f64>; 3],
    alpha: Vec<f64>,
    /// Row sums of the mass of the chain.
    sums: Vec<f64>,
    /// One number per mode that a recurrence carries along.
    moving: Vec<f64>,
}

impl TridiagonalFactor {
    /// Factorises `S` for all modes.
    pub fn set(
        &mut self,
        body: &HeatBody,
        transport: &Transport,
        coefficients: StageCoefficients,
    ) -> Result<(), HeatError> {
        let nm = body.modes.len();
        let closed = body.line.closed > 0.0;
        let n = body.line.len() - usize::from(closed);
        let (storage, flow) = body.alpha(coefficients);
        self.alpha.clear();
        self.alpha.extend(body.modes.values.iter().map(|value| storage + flow * value));
        for values in [&mut self.w, &mut self.r, &mut self.inverse] {
            values.resize(n * nm, 0.0);
        }
        self.moving.clear();
        self.moving.resize(nm, 0.0);
        let factors = [&mut self.w[..], &mut self.r, &mut self.inverse];
        rows::factorise(transport, &self.alpha, coefficients.flow, factors, &mut self.moving);
        if closed {
            self.set_border(transport, coefficients, n, nm);
        }
        let bordered = if closed { self.border[2].iter().sum() } else { 0.0 };
        let check = self.inverse[(n - 1) * nm..].iter().sum::<f64>() + bordered;
        if check.is_finite() { Ok(()) } else { Err(HeatError::Singular { unknowns: body.size() }) }
    }

    fn set_border(&mut self, transport: &Transport, coefficients: StageCoefficients, n: usize, nm: usize) {
        self.row.clear();
        self.row.resize(n * nm, 0.0);
        // Rows 0 and n − 1 of the chain see the bordering node as their outer neighbour, and it sees them.
        let mut border = std::mem::take(&mut self.border);
        let [to_first, to_last, pivot] = &mut border;
        for (entries, mass, flow) in [
            (&mut *to_first, transport.mass_upper[n], transport.flow_upper[n]),
            (&mut *to_last, transport.mass_lower[n], transport.flow_lower[n]),
        ] {
            entries.clear();
            entries.extend(self.alpha.iter().map(|a| a * mass + coefficients.flow * flow));
        }
        let last = (n - 1) * nm;
        for m in 0..nm {
            self.row[m] += to_first[m];
            self.row[last + m] += to_last[m];
        }
        // Row sums again, for the pivot of the bordering node, too: 1 + T⁻¹ b = T⁻¹ s.
        let mut column = std::mem::take(&mut self.column);
        let sum = |i: usize| transport.mass_lower[i] + transport.mass[i] + transport.mass_upper[i];
        self.sums.clear();
        self.sums.extend((0..n).map(sum));
        column.resize(n * nm, 0.0);
        rows::multiples(&self.sums, &self.alpha, &mut column);
        self.solve_chain(&mut column, 0, n, nm);
        pivot.clear();
        pivot.extend(
            (0..nm).map(|m| 1.0 / (self.alpha[m] * sum(n) - to_first[m] * column[m] - to_last[m] * column[last + m])),
        );
        column.iter_mut().for_each(|y| *y -= 1.0);
        self.column = column;
        self.border = border;
        // Tᵀ = (1 + r)ᵀ (1/inverse) (1 + w)ᵀ.
        rows::eliminate(&self.r[..last], &mut self.row, nm);
        rows::substitute(&self.inverse, &self.w[nm..], &mut self.row, nm);
    }

    /// `x ← T⁻¹ x`; `x` is zero before node `first`.
    fn solve_chain(&self, x: &mut [f64], first: usize, n: usize, nm: usize) {
        rows::eliminate(&self.w[(first + 1) * nm..n * nm], &mut x[first * nm..n * nm], nm);
        rows::substitute(&self.inverse, &self.r, &mut x[..n * nm], nm);
    }

    /// `x ← S⁻¹ x`; `x` is zero before node `first`.
    pub fn solve(&self, body: &HeatBody, x: &mut [f64], first: usize) {
        let nm = body.modes.len();
        if body.line.closed == 0.0 {
            return self.solve_chain(x, first, body.line.len(), nm);
        }
        let n = body.line.len() - 1;
        let (chain, last) = x.split_at_mut(n * nm);
        self.solve_chain(chain, first.min(n - 1), n, nm);
        let [to_first, to_last, pivot] = &self.border;
        for m in 0..nm {
            let sum = to_first[m] * chain[m] + to_last[m] * chain[(n - 1) * nm + m];
            last[m] = (last[m] - sum) * pivot[m];
        }
        rows::subtract(&self.column, last, chain);
    }
}
