//! Direct solver of one implicit step in one body.
//!
//! With the fields written in the modes across the streamlines, an implicit step is one tridiagonal system per mode,
//!
//! ```text
//! [μ ρc M̃ + β (k λₘ M̃ + F)] xₘ = bₘ ,
//! ```
//!
//! cyclic in the wheel. Nothing is kept from one step to the next, so that step size and speeds may change every time.
//! Fields are stored as `field[node · modes + mode]`; all recurrences run over the nodes and are vectors in the modes.

use super::HeatError;
use super::tensor::{Modes, Streamline, Transport};
use std::ops::Range;

/// A tensor mesh with its material.
#[derive(Clone, Debug)]
pub(super) struct Body {
    pub line: Streamline,
    pub modes: Modes,
    /// Heat capacity `ρc` [J/(m³ K)].
    pub heat_capacity: f64,
    /// Conductivity [W/(m K)].
    pub conductivity: f64,
    /// Coefficient of convection from the surface to the air [W/(m² K)].
    pub film: f64,
}

/// Weights of storage and flow in the matrix of a step: `S = μ ρc M̃ + β A`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Blend {
    pub storage: f64,
    pub flow: f64,
}

impl Body {
    /// Number of values of a field.
    pub fn size(&self) -> usize {
        self.line.len() * self.modes.len()
    }

    /// `out ← out + S x` with the operator of the modal solver.
    pub fn multiply(&self, transport: &Transport, blend: Blend, x: &[f64], out: &mut [f64]) {
        let (n, nm) = (self.line.len(), self.modes.len());
        let row = |i: usize| &x[i * nm..(i + 1) * nm];
        let alpha: Vec<f64> = self.alpha(blend);
        for i in 0..n {
            // Ends of an open streamline have no outer neighbour; the entries there are zero.
            let (before, after) = ((i + n - 1) % n, (i + 1) % n);
            let (ml, md, mu) = (transport.mass_lower[i], transport.mass[i], transport.mass_upper[i]);
            let (fl, fu) = (blend.flow * transport.flow_lower[i], blend.flow * transport.flow_upper[i]);
            let entry = blend.flow * transport.entry(i);
            let target = &mut out[i * nm..(i + 1) * nm];
            let values = row(before).iter().zip(row(i)).zip(row(after));
            for ((target, ((&a, &b), &c)), alpha) in target.iter_mut().zip(values).zip(&alpha) {
                *target += alpha * (ml * a + md * b + mu * c) + fl * (a - b) + fu * (c - b) + entry * b;
            }
        }
    }

    /// `out ← out + β k K ⊗ ∫(1/g − g)NN x`: the part of the conduction along the streamlines that the modal solver
    /// leaves out. `work` has the length of a field.
    pub fn add_curvature(&self, blend: Blend, x: &[f64], out: &mut [f64], work: &mut Vec<f64>) {
        if self.modes.curvature.is_empty() {
            return;
        }
        let nm = self.modes.len();
        work.clear();
        work.resize(self.size(), 0.0);
        for (e, h) in self.line.lengths.iter().enumerate() {
            let (a, b) = (e * nm, self.line.after(e) * nm);
            for m in 0..nm {
                let flux = blend.flow * self.conductivity / h * (x[a + m] - x[b + m]);
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
        let nm = self.modes.len();
        for (value, target) in load.iter().zip(out[first * nm..].chunks_exact_mut(nm)) {
            target.iter_mut().zip(&self.modes.surface).for_each(|(t, s)| *t += value * s);
        }
    }

    /// Surface values at a range of nodes.
    pub fn trace(&self, nodes: Range<usize>, x: &[f64], out: &mut Vec<f64>) {
        let nm = self.modes.len();
        out.clear();
        let rows = x[nodes.start * nm..nodes.end * nm].chunks_exact(nm);
        out.extend(rows.map(|row| dot(row, &self.modes.surface)));
    }

    /// `∫ x ds` of every mode.
    pub fn integrate(&self, x: &[f64], sums: &mut Vec<f64>) {
        let nm = self.modes.len();
        sums.clear();
        sums.resize(nm, 0.0);
        for (row, w) in x.chunks_exact(nm).zip(&self.line.weights) {
            sums.iter_mut().zip(row).for_each(|(s, v)| *s += w * v);
        }
    }

    fn alpha(&self, blend: Blend) -> Vec<f64> {
        let flow = blend.flow * self.conductivity;
        self.modes.values.iter().map(|l| blend.storage * self.heat_capacity + flow * l).collect()
    }
}

/// Factors of the tridiagonal systems of all modes.
///
/// The chain of nodes (without the last one on a closed streamline, which borders it) has `T = (1 + w)(1/inverse)(1 +
/// r)` with subdiagonal `w` and superdiagonal `r`.
#[derive(Clone, Debug, Default)]
pub(super) struct Factor {
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
    moving: Vec<f64>,
}

impl Factor {
    /// Factorises `S` for all modes.
    pub fn set(&mut self, body: &Body, transport: &Transport, blend: Blend) -> Result<(), HeatError> {
        let nm = body.modes.len();
        let closed = body.line.closed > 0.0;
        let n = body.line.len() - usize::from(closed);
        self.alpha = body.alpha(blend);
        for values in [&mut self.w, &mut self.r, &mut self.inverse] {
            values.resize(n * nm, 0.0);
        }
        // Elimination in terms of row sums e (Grassmann, Taksar & Heyman, *Oper. Res.* 33 (1985)): nothing cancels in a
        // fast stream, `eᵢ = sᵢ − Lᵢ eᵢ₋₁/dᵢ₋₁`, `dᵢ = eᵢ − Uᵢ` with the row sums s, of the mass alone.
        let alpha = &self.alpha;
        self.moving.clear();
        self.moving.resize(nm, 0.0);
        for i in 0..n {
            let (ml, mu) = (transport.mass_lower[i], transport.mass_upper[i]);
            let (fl, fu) = (blend.flow * transport.flow_lower[i], blend.flow * transport.flow_upper[i]);
            let (sum, entry) = (ml + transport.mass[i] + mu, blend.flow * transport.entry(i));
            let (done, rest) = self.inverse.split_at_mut(i * nm);
            let (w, r) = (&mut self.w[i * nm..(i + 1) * nm], &mut self.r[i * nm..(i + 1) * nm]);
            let (inverse, excess) = (&mut rest[..nm], &mut self.moving);
            if i > 0 {
                let last = &done[(i - 1) * nm..];
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
            self.set_border(transport, blend, n, nm);
        }
        let bordered = if closed { self.border[2].iter().sum() } else { 0.0 };
        let check = self.inverse[(n - 1) * nm..].iter().sum::<f64>() + bordered;
        if check.is_finite() { Ok(()) } else { Err(HeatError::Singular { unknowns: body.size() }) }
    }

    fn set_border(&mut self, transport: &Transport, blend: Blend, n: usize, nm: usize) {
        self.row.clear();
        self.row.resize(n * nm, 0.0);
        // Rows 0 and n − 1 of the chain see the bordering node as their outer neighbour, and it sees them.
        let entry =
            |mass: f64, flow: f64| -> Vec<f64> { self.alpha.iter().map(|a| a * mass + blend.flow * flow).collect() };
        let to_first = entry(transport.mass_upper[n], transport.flow_upper[n]);
        let to_last = entry(transport.mass_lower[n], transport.flow_lower[n]);
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
        let pivot: Vec<f64> = (0..nm)
            .map(|m| 1.0 / (self.alpha[m] * sum(n) - to_first[m] * column[m] - to_last[m] * column[last + m]))
            .collect();
        column.iter_mut().for_each(|y| *y -= 1.0);
        self.column = column;
        // Tᵀ = (1 + r)ᵀ (1/inverse) (1 + w)ᵀ.
        for i in 1..n {
            let (done, rest) = self.row.split_at_mut(i * nm);
            for m in 0..nm {
                rest[m] -= self.r[(i - 1) * nm + m] * done[(i - 1) * nm + m];
            }
        }
        self.row.iter_mut().zip(&self.inverse).for_each(|(t, d)| *t *= d);
        for i in (0..n - 1).rev() {
            let (done, rest) = self.row.split_at_mut((i + 1) * nm);
            for m in 0..nm {
                done[i * nm + m] -= self.w[(i + 1) * nm + m] * rest[m];
            }
        }
        self.border = [to_first, to_last, pivot];
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
    pub fn solve(&self, body: &Body, x: &mut [f64], first: usize) {
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
    pub fn surface_response(&mut self, body: &Body, range: Range<usize>, out: &mut Vec<f64>) {
        let nm = body.modes.len();
        let n = body.line.len() - usize::from(body.line.closed > 0.0);
        let count = range.len();
        out.clear();
        out.resize(count * count, 0.0);
        // Diagonal of the inverse, weighted with φₘ(0)², from the end of the chain to the first node of the range.
        let mut diagonal = vec![0.0; count * nm];
        let mut below = vec![0.0; nm];
        for i in (range.start..n).rev() {
            for (m, below) in below.iter_mut().enumerate() {
                let next = if i + 1 < n { self.r[i * nm + m] * self.w[(i + 1) * nm + m] * *below } else { 0.0 };
                *below = self.inverse[i * nm + m] + next;
            }
            if i < range.end {
                diagonal[(i - range.start) * nm..(i - range.start + 1) * nm].copy_from_slice(&below);
            }
        }
        for row in diagonal.chunks_exact_mut(nm) {
            row.iter_mut().zip(&body.modes.surface).for_each(|(x, s)| *x *= s * s);
        }
        self.moving.resize(nm, 0.0);
        for k in 0..count {
            let start = &diagonal[k * nm..(k + 1) * nm];
            out[k * count + k] = start.iter().sum();
            self.moving.copy_from_slice(start);
            // The influence dies out within a few nodes against the stream, and along it in short steps.
            let negligible = NEGLIGIBLE * start.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
            let mut sign = 1.0;
            for j in (0..k).rev() {
                let at = (range.start + j + 1) * nm;
                sign = -sign;
                out[k * count + j] = sign * decay(&mut self.moving, &self.w[at..at + nm]);
                if j % 4 == 0 && largest(&self.moving) < negligible {
                    break;
                }
            }
            self.moving.copy_from_slice(start);
            sign = 1.0;
            for i in (0..k).rev() {
                let at = (range.start + i) * nm;
                sign = -sign;
                out[i * count + k] = sign * decay(&mut self.moving, &self.r[at..at + nm]);
                if i % 4 == 0 && largest(&self.moving) < negligible {
                    break;
                }
            }
        }
        if body.line.closed > 0.0 {
            // Once around the wheel.
            let mut scaled = vec![0.0; nm];
            let row = largest(&self.row[range.start * nm..range.end * nm]);
            for i in 0..count {
                let at = (range.start + i) * nm;
                for (m, (scaled, s)) in scaled.iter_mut().zip(&body.modes.surface).enumerate() {
                    *scaled = self.column[at + m] * self.border[2][m] * s * s;
                }
                if largest(&scaled) * row <= NEGLIGIBLE * out[i * count + i] {
                    continue;
                }
                for j in 0..count {
                    let at = (range.start + j) * nm;
                    out[i * count + j] += dot(&scaled, &self.row[at..at + nm]);
                }
            }
        }
    }
}

/// Influence relative to that of a node on itself which is left out.
const NEGLIGIBLE: f64 = 1e-18;

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

/// `x ← f x` entry by entry; the sum of the result.
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

/// Scalar product of vectors whose length is a multiple of four.
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 4];
    for (a, b) in a.chunks_exact(4).zip(b.chunks_exact(4)) {
        for l in 0..4 {
            sums[l] += a[l] * b[l];
        }
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3])
}
