//! Passes along the streamlines: all that a stage does to the field of one body under one line.
//!
//! A field is an array of rows, one for each node along the surface, in which the coefficients \[K] of all modes over the
//! depth lie side by side; so do the factors of [`TridiagonalFactor`](super::tridiagonal::TridiagonalFactor). A pass goes
//! from row to row once. What a row hands on to the next one stays in registers, a register holds several modes, and
//! the recurrences of all modes of a row run side by side.
//!
//! | pass | rows | direction | what it does |
//! |---|---|---|---|
//! | [`load`] | all | onwards | `y = b − A x`, `y ← y − w y₋` |
//! | [`surface`] | contact | back | surface values `Σₘ φₘ(0) k` of `k = d y − r k₊` |
//! | [`add_load`] | contact | onwards | `y ← y + u` with `u = q φ(0) − w u₋` |
//! | [`substitute`] | all | back | `k = d y − r k₊` |
//! | [`advance`](crate::heat::tensor::mesh::kernels::advance) | all | any | `x + a k`, `Σ k ∫N ds`, and by how much values may have moved |
//!
//! Onwards is the order of elimination: from the node after the contact around the ring to the last one of the contact;
//! an index − or + is the row before or after in it. `w`, `r` and `d` are the factors and inverse pivots. The last node
//! also has entries with the first ones of that order, which [`take`] and [`leave`] apply. Rows and loads are
//! `ρc` times a length times \[K] or, as here, that over the step: [W/(m K)] times \[K].

use super::decay::less;
use super::transport::Transport;
use crate::heat::tensor::mesh::body::HeatBody;
use crate::heat::tensor::mesh::kernels::{blocks, blocks_mut, rows};
use crate::linalg::vectorised::vectorised;
use pulp::Simd;
use std::ops::Range;

/// Matrix `α M̃ + β F` of every mode, `α = a + b λ` with its eigenvalue λ.
pub struct Operator<'a> {
    pub body: &'a HeatBody,
    pub transport: &'a Transport,
    /// a, b and β.
    pub weights: [f64; 3],
}

impl Operator<'_> {
    /// Weights α of a block of modes.
    #[inline(always)]
    fn alpha<S: Simd, const B: usize>(&self, simd: S, at: usize) -> [S::f64s; B] {
        let mut alpha = blocks::<S, B>(&self.body.modes.values)[at];
        let (a, b) = (simd.splat_f64s(self.weights[0]), simd.splat_f64s(self.weights[1]));
        for alpha in &mut alpha {
            *alpha = simd.mul_add_e_f64s(b, *alpha, a);
        }
        alpha
    }

    /// Rows before, of and after the `nodes`, all in the field x; beyond the ends of an open streamline there is nothing.
    #[inline(always)]
    fn neighbours<'a, V, const B: usize>(
        &self,
        [x, nothing]: [&'a [[V; B]]; 2],
        nodes: Range<usize>,
        stride: usize,
    ) -> [&'a [[V; B]]; 3] {
        let (n, size) = (self.transport.rows.len(), nodes.len() * stride);
        let [first, last] = if self.transport.closed { [x, &x[(n - 1) * stride..]] } else { [nothing; 2] };
        let before = if nodes.start > 0 { &x[(nodes.start - 1) * stride..] } else { last };
        let after = if nodes.end < n { &x[(nodes.start + 1) * stride..] } else { first };
        [&before[..size], &x[nodes.start * stride..][..size], &after[..size]]
    }
}

/// Nodes in the order of elimination that ends with `last`, in pieces: each end of the array is a piece of its own.
fn onwards(n: usize, last: usize) -> [Range<usize>; 4] {
    if last + 1 < n { [last + 1..n - 1, n - 1..n, 0..1, 1..last + 1] } else { [0..1, 1..n - 1, n - 1..n, n..n] }
}

rows! {
    /// The product of the matrix with the field x and surface loads, eliminated: `factors` are w and the loads of all
    /// nodes. What `out` holds is replaced, or a load, too, if it is said to `add`.
    ///
    /// Neighbours enter by their differences from the row, so that an even field is not moved by round-off.
    fn load<'a, S, B, ADD = add>(
        simd, [stride, at] of operator.body.modes.len(),
        operator: &'a Operator<'a>, last: usize, factors: [&'a [f64]; 2], x: &'a [f64], out: &'a mut [f64],
    ) {
        let Operator { body, transport: Transport { rows: bands, .. }, weights } = operator;
        let (alpha, shape) = (operator.alpha::<S, B>(simd, at), blocks::<S, B>(&body.modes.surface)[at]);
        let (fields, links) = ([blocks::<S, B>(x), blocks::<S, B>(&body.nothing)], blocks::<S, B>(factors[0]));
        let mut moving = [simd.splat_f64s(0.0); B];
        for nodes in onwards(bands.len(), last) {
            let (first, size) = (nodes.start * stride, nodes.len() * stride);
            let (bands, loads) = (&bands[nodes.clone()], &factors[1][nodes.clone()]);
            let (links, out) = (&links[first..][..size], &mut blocks_mut::<S, B>(out)[first..][..size]);
            let [before, here, after] = operator.neighbours(fields, nodes, stride);
            for i in 0..bands.len() {
                let ([below, sum, above, from, to], j) = (bands[i], i * stride + at);
                let [below, sum, above] = [simd.splat_f64s(below), simd.splat_f64s(sum), simd.splat_f64s(above)];
                let [from, to] = [simd.splat_f64s(-weights[2] * from), simd.splat_f64s(-weights[2] * to)];
                let (before, here, after, link, out) = (&before[j], &here[j], &after[j], &links[j], &mut out[j]);
                let load = simd.splat_f64s(loads[i]);
                for q in 0..B {
                    let given = simd.mul_f64s(load, shape[q]);
                    let given = if ADD { simd.add_f64s(given, out[q]) } else { given };
                    let (back, ahead) = (simd.sub_f64s(here[q], before[q]), simd.sub_f64s(here[q], after[q]));
                    let mass = less(simd, simd.mul_f64s(sum, here[q]), below, back);
                    let mass = less(simd, mass, above, ahead);
                    let y = simd.mul_add_e_f64s(alpha[q], mass, given);
                    let y = simd.mul_add_e_f64s(to, ahead, simd.mul_add_e_f64s(from, back, y));
                    moving[q] = less(simd, y, link[q], moving[q]);
                    out[q] = moving[q];
                }
            }
        }
    }
}

vectorised! {
    /// Elimination of what x holds in rows of `width` numbers by the factors w, up to the node `last`.
    fn eliminate<'a, S>(simd, last: usize, w: &'a [f64], x: &'a mut [f64], width: usize) {
        let _ = simd;
        let (before, after) = x.split_at_mut((last + 1) * width);
        let (of_before, of_after) = w.split_at(before.len());
        let rows = after.chunks_exact_mut(width).chain(before.chunks_exact_mut(width));
        let mut moving = &mut [][..];
        for (row, w) in rows.zip(of_after.chunks_exact(width).chain(of_before.chunks_exact(width))) {
            row.iter_mut().zip(w.iter().zip(&*moving)).for_each(|(x, (w, moving))| *x -= w * moving);
            moving = row;
        }
    }
}

rows! {
    /// `sum ← sum − Σ f x` over rows: what the row f of the last node takes from it.
    fn take<'a, S, B>(simd, [stride, at] of sum.len(), fill: &'a [f64], x: &'a [f64], sum: &'a mut [f64]) {
        let (fill, mut parts) = (blocks::<S, B>(fill), blocks::<S, B>(sum)[at]);
        let x = &blocks::<S, B>(x)[..fill.len()];
        for j in (at..fill.len()).step_by(stride) {
            for q in 0..B {
                parts[q] = less(simd, parts[q], fill[j][q], x[j][q]);
            }
        }
        blocks_mut::<S, B>(sum)[at] = parts;
    }
}

rows! {
    /// `x ← x − c y` in rows: what the column c of the last node takes from them if its value is the row y.
    fn leave<'a, S, B>(simd, [stride, at] of y.len(), fill: &'a [f64], y: &'a [f64], x: &'a mut [f64]) {
        let (fill, y) = (blocks::<S, B>(fill), blocks::<S, B>(y)[at]);
        let x = &mut blocks_mut::<S, B>(x)[..fill.len()];
        for j in (at..fill.len()).step_by(stride) {
            for q in 0..B {
                x[j][q] = less(simd, x[j][q], fill[j][q], y[q]);
            }
        }
    }
}

rows! {
    /// Surface values of the solution in the rows that end with the last one, whose inverse pivots, factors r and column
    /// are given; the column may be empty, or end two rows before the last.
    fn surface<'a, S, B>(
        simd, [stride, at] of shape.len(),
        factors: [&'a [f64]; 3], x: &'a [f64], shape: &'a [f64], out: &'a mut [f64],
    ) {
        let (size, column) = (out.len() * stride, blocks::<S, B>(factors[2]));
        let (d, r) = (&blocks::<S, B>(factors[0])[..size], &blocks::<S, B>(factors[1])[..size]);
        let (x, shape) = (&blocks::<S, B>(x)[..size], blocks::<S, B>(shape)[at]);
        let [mut moving, mut last] = [[simd.splat_f64s(0.0); B]; 2];
        for q in 0..B {
            last[q] = simd.mul_f64s(x[size - stride + at][q], d[size - stride + at][q]);
        }
        for i in (0..out.len()).rev() {
            let (mut sum, j) = (simd.splat_f64s(0.0), i * stride + at);
            let (x, d, r) = (&x[j], &d[j], &r[j]);
            for q in 0..B {
                let own = if j < column.len() { less(simd, x[q], column[j][q], last[q]) } else { x[q] };
                moving[q] = less(simd, simd.mul_f64s(own, d[q]), r[q], moving[q]);
                sum = simd.mul_add_e_f64s(moving[q], shape[q], sum);
            }
            out[i] = if at == 0 { 0.0 } else { out[i] } + simd.reduce_sum_f64s(sum);
        }
    }
}

rows! {
    /// Adds surface `loads` of the rows that end with the last one to x, after their elimination by the factors w and
    /// the row of the last node, which may be empty or end two rows before it.
    fn add_load<'a, S, B>(
        simd, [stride, at] of shape.len(),
        factors: [&'a [f64]; 2], loads: &'a [f64], shape: &'a [f64], x: &'a mut [f64],
    ) {
        let (size, shape, fill) = (loads.len() * stride, blocks::<S, B>(shape)[at], blocks::<S, B>(factors[1]));
        let (w, x) = (&blocks::<S, B>(factors[0])[..size], &mut blocks_mut::<S, B>(x)[..size]);
        let [mut moving, mut taken] = [[simd.splat_f64s(0.0); B]; 2];
        for (i, load) in loads.iter().enumerate() {
            let (load, j) = (simd.splat_f64s(*load), i * stride + at);
            let (w, x) = (&w[j], &mut x[j]);
            for q in 0..B {
                moving[q] = less(simd, simd.mul_f64s(load, shape[q]), w[q], moving[q]);
                x[q] = simd.add_f64s(x[q], moving[q]);
            }
            if j < fill.len() {
                for q in 0..B {
                    taken[q] = less(simd, taken[q], fill[j][q], moving[q]);
                }
            }
        }
        let last = &mut x[size - stride + at];
        for q in 0..B {
            last[q] = simd.add_f64s(last[q], taken[q]);
        }
    }
}

rows! {
    /// The second half of a solution, from the node that was eliminated `last` back, by the inverse pivots and r.
    fn substitute<'a, S, B>(
        simd, [stride, at] of width, factors: [&'a [f64]; 2], x: &'a mut [f64], width: usize, last: usize
    ) {
        let (d, r, x) = (blocks::<S, B>(factors[0]), blocks::<S, B>(factors[1]), blocks_mut::<S, B>(x));
        let (mut moving, n) = ([simd.splat_f64s(0.0); B], x.len() / stride);
        for nodes in [0..last + 1, last + 1..n] {
            let (first, size) = (nodes.start * stride, nodes.len() * stride);
            let (d, r, x) = (&d[first..][..size], &r[first..][..size], &mut x[first..][..size]);
            for i in (0..nodes.len()).rev() {
                let j = i * stride + at;
                let (d, r, x) = (&d[j], &r[j], &mut x[j]);
                for q in 0..B {
                    moving[q] = less(simd, simd.mul_f64s(x[q], d[q]), r[q], moving[q]);
                    x[q] = moving[q];
                }
            }
        }
    }
}
