//! Factors of the tridiagonal systems of one implicit step, one system per mode across the streamlines.

use super::modal::{HeatBody, StageCoefficients, dot};
use super::streamline::Transport;
use crate::heat::error::HeatError;
use std::ops::Range;

/// Factors of the tridiagonal systems of all modes.
///
/// The chain of nodes (without the last one on a closed streamline, which borders it) has `T = (1 + w)(1/inverse)(1 +
/// r)` with subdiagonal `w` and superdiagonal `r`.
#[derive(Clone, Debug, Default)]
pub(super) struct TridiagonalFactor {
    w: Vec<f64>,
    r: Vec<f64>,
    inverse: Vec<f64>,
    /// `T⁻¹ b`, b the column of the bordering node.
    column: Vec<f64>,
    /// `T⁻ᵀ c`, c the row of the bordering node.
    row: Vec<f64>,
    /// Row entries of the bordering node towards the first and the last node of the chain, and its inverse pivot.
    border: [Vec<f64>; 3],
    alpha: Vec<f64>,
    /// Of the inverse at the nodes whose response is wanted.
    diagonal: Vec<f64>,
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
        // Elimination in terms of row sums e (Grassmann, Taksar & Heyman, *Oper. Res.* 33 (1985)): nothing cancels in a
        // fast stream, `eᵢ = sᵢ − Lᵢ eᵢ₋₁/dᵢ₋₁`, `dᵢ = eᵢ − Uᵢ` with the row sums s, of the mass alone.
        // All slices of a row have the length of `alpha`, so that the loops over the modes need no checks.
        let alpha = &self.alpha[..nm];
        self.moving.clear();
        self.moving.resize(nm, 0.0);
        for i in 0..n {
            let (ml, mu) = (transport.mass_lower[i], transport.mass_upper[i]);
            let (fl, fu) = (coefficients.flow * transport.flow_lower[i], coefficients.flow * transport.flow_upper[i]);
            let (sum, entry) = (ml + transport.mass[i] + mu, coefficients.flow * transport.entry(i));
            let (done, rest) = self.inverse.split_at_mut(i * nm);
            let (w, r) = (&mut self.w[i * nm..][..nm], &mut self.r[i * nm..][..nm]);
            let (inverse, excess) = (&mut rest[..nm], &mut self.moving[..nm]);
            if i > 0 {
                let last = &done[(i - 1) * nm..][..nm];
                for m in 0..nm {
                    w[m] = (alpha[m] * ml + fl) * last[m];
                    excess[m] = alpha[m] * sum + entry - w[m] * excess[m];
                }
            } else {
                for m in 0..nm {
                    w[m] = 0.0;
                    excess[m] = alpha[m] * sum + entry - (alpha[m] * ml + fl);
                }
            }
            for m in 0..nm {
                let upper = alpha[m] * mu + fu;
                inverse[m] = 1.0 / (excess[m] - upper);
                r[m] = upper * inverse[m];
            }
        }
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
        column.clear();
        let sum = |i: usize| transport.mass_lower[i] + transport.mass[i] + transport.mass_upper[i];
        for i in 0..n {
            let sum = sum(i);
            column.extend(self.alpha.iter().map(|a| a * sum));
        }
        self.solve_chain(&mut column, 0, n, nm);
        pivot.clear();
        pivot.extend(
            (0..nm).map(|m| 1.0 / (self.alpha[m] * sum(n) - to_first[m] * column[m] - to_last[m] * column[last + m])),
        );
        column.iter_mut().for_each(|y| *y -= 1.0);
        self.column = column;
        self.border = border;
        // Tᵀ = (1 + r)ᵀ (1/inverse) (1 + w)ᵀ.
        for i in 1..n {
            let (done, rest) = self.row.split_at_mut(i * nm);
            let before = (i - 1) * nm..i * nm;
            let values = self.r[before.clone()].iter().zip(&done[before]);
            rest.iter_mut().zip(values).for_each(|(t, (r, last))| *t -= r * last);
        }
        self.row.iter_mut().zip(&self.inverse).for_each(|(t, d)| *t *= d);
        for i in (0..n - 1).rev() {
            let (done, rest) = self.row.split_at_mut((i + 1) * nm);
            let values = self.w[(i + 1) * nm..(i + 2) * nm].iter().zip(&*rest);
            done[i * nm..].iter_mut().zip(values).for_each(|(t, (w, next))| *t -= w * next);
        }
    }

    /// `x ← T⁻¹ x`; `x` is zero before node `first`.
    fn solve_chain(&self, x: &mut [f64], first: usize, n: usize, nm: usize) {
        for i in first + 1..n {
            let (done, rest) = x.split_at_mut(i * nm);
            let (last, w) = (&done[(i - 1) * nm..], &self.w[i * nm..(i + 1) * nm]);
            rest[..nm].iter_mut().zip(last).zip(w).for_each(|((x, before), w)| *x -= w * before);
        }
        let range = (n - 1) * nm..n * nm;
        x[range.clone()].iter_mut().zip(&self.inverse[range]).for_each(|(x, d)| *x *= d);
        for i in (0..n - 1).rev() {
            let (done, rest) = x.split_at_mut((i + 1) * nm);
            let range = i * nm..(i + 1) * nm;
            let values = self.inverse[range.clone()].iter().zip(&self.r[range]).zip(&rest[..nm]);
            done[i * nm..].iter_mut().zip(values).for_each(|(x, ((d, r), next))| *x = *x * d - r * next);
        }
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
        for (row, column) in chain.chunks_exact_mut(nm).zip(self.column.chunks_exact(nm)) {
            row.iter_mut().zip(column).zip(&*last).for_each(|((x, y), b)| *x -= y * b);
        }
    }

    /// Surface temperatures at the nodes `range` due to unit surface loads there, row-major.
    ///
    /// Entries of the inverse of a tridiagonal matrix follow from its factors, `X_jj = 1/d_j + r_j w_{j+1} X_{j+1,j+1}`,
    /// `X_ij = −w_{j+1} X_{i,j+1}` for `j < i`, `X_ij = −r_i X_{i+1,j}` for `i < j` (Takahashi, Fagan & Chin 1973).
    pub fn surface_response(&mut self, body: &HeatBody, range: Range<usize>, out: &mut Vec<f64>) {
        let nm = body.modes.len();
        let count = range.len();
        out.clear();
        out.resize(count * count, 0.0);
        self.set_diagonal(body, &range);
        self.moving.resize(nm, 0.0);
        for k in 0..count {
            let start = &self.diagonal[k * nm..(k + 1) * nm];
            out[k * count + k] = start.iter().sum();
            self.moving.copy_from_slice(start);
            // The influence dies out within a few nodes against the stream, and along it in short steps; the steep modes,
            // which come last, go first.
            let negligible = NEGLIGIBLE * largest(start);
            let (mut sign, mut alive) = (1.0, nm);
            for j in (0..k).rev() {
                let at = (range.start + j + 1) * nm;
                sign = -sign;
                out[k * count + j] = sign * decay(&mut self.moving[..alive], &self.w[at..at + alive]);
                alive = if j % 4 == 0 { still_alive(&self.moving[..alive], negligible) } else { alive };
                if alive == 0 {
                    break;
                }
            }
            self.moving.copy_from_slice(start);
            (sign, alive) = (1.0, nm);
            for i in (0..k).rev() {
                let at = (range.start + i) * nm;
                sign = -sign;
                out[i * count + k] = sign * decay(&mut self.moving[..alive], &self.r[at..at + alive]);
                alive = if i % 4 == 0 { still_alive(&self.moving[..alive], negligible) } else { alive };
                if alive == 0 {
                    break;
                }
            }
        }
        if body.line.closed > 0.0 {
            self.add_round_trip(body, &range, out);
        }
    }

    /// Diagonal of the inverse of the chain at the nodes `range`, weighted with `φₘ(0)²`.
    fn set_diagonal(&mut self, body: &HeatBody, range: &Range<usize>) {
        let nm = body.modes.len();
        let n = body.line.len() - usize::from(body.line.closed > 0.0);
        self.diagonal.clear();
        self.diagonal.resize(range.len() * nm, 0.0);
        self.moving.clear();
        self.moving.resize(nm, 0.0);
        for i in (range.start..n).rev() {
            let (inverse, moving) = (&self.inverse[i * nm..][..nm], &mut self.moving[..nm]);
            if i + 1 < n {
                let (r, w) = (&self.r[i * nm..][..nm], &self.w[(i + 1) * nm..][..nm]);
                for m in 0..nm {
                    moving[m] = inverse[m] + r[m] * w[m] * moving[m];
                }
            } else {
                moving.copy_from_slice(inverse);
            }
            if i < range.end {
                self.diagonal[(i - range.start) * nm..(i - range.start + 1) * nm].copy_from_slice(&self.moving);
            }
        }
        for row in self.diagonal.chunks_exact_mut(nm) {
            row.iter_mut().zip(&body.modes.surface).for_each(|(x, s)| *x *= s * s);
        }
    }

    /// Adds the influence that goes once around the wheel to the response at the nodes `range`.
    fn add_round_trip(&mut self, body: &HeatBody, range: &Range<usize>, out: &mut [f64]) {
        let nm = body.modes.len();
        let count = range.len();
        let row = largest(&self.row[range.start * nm..range.end * nm]);
        for i in 0..count {
            let at = (range.start + i) * nm;
            for (m, (scaled, s)) in self.moving.iter_mut().zip(&body.modes.surface).enumerate() {
                *scaled = self.column[at + m] * self.border[2][m] * s * s;
            }
            if largest(&self.moving) * row <= NEGLIGIBLE * out[i * count + i] {
                continue;
            }
            for j in 0..count {
                let at = (range.start + j) * nm;
                out[i * count + j] += dot(&self.moving, &self.row[at..at + nm]);
            }
        }
    }
}

/// Influence relative to that of a node on itself which is left out.
const NEGLIGIBLE: f64 = 1e-18;

/// How many of the influences `x`, in groups of four, are left when those at the end that are negligible are dropped.
fn still_alive(x: &[f64], negligible: f64) -> usize {
    let mut groups = x.chunks_exact(4);
    4 * groups.rposition(|group| group.iter().any(|x| x.abs() >= negligible)).map_or(0, |last| last + 1)
}

fn largest(x: &[f64]) -> f64 {
    let mut lanes = [0.0_f64; 4];
    for x in x.chunks_exact(4) {
        for l in 0..4 {
            // A comparison, not `max`: compiles to one instruction.
            lanes[l] = if x[l].abs() > lanes[l] { x[l].abs() } else { lanes[l] };
        }
    }
    lanes.into_iter().fold(0.0, f64::max)
}

/// `x ← f x` entry by entry; the sum of the result. In a function of its own the loop is compiled for registers.
#[inline(never)]
fn decay(x: &mut [f64], f: &[f64]) -> f64 {
    let mut sums = [0.0; 8];
    let (mut x, mut f) = (x.chunks_exact_mut(8), f.chunks_exact(8));
    for (x, f) in (&mut x).zip(&mut f) {
        for l in 0..8 {
            x[l] *= f[l];
            sums[l] += x[l];
        }
    }
    for (l, (x, f)) in x.into_remainder().iter_mut().zip(f.remainder()).enumerate() {
        *x *= f;
        sums[l] += *x;
    }
    ((sums[0] + sums[1]) + (sums[2] + sums[3])) + ((sums[4] + sums[5]) + (sums[6] + sums[7]))
}
