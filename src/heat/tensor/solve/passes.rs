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
use crate::heat::tensor::mesh::depth_modes::DepthModes;
use crate::heat::tensor::mesh::kernels::{blocks, blocks_mut, by_rows};
use crate::linalg::Update;
use crate::linalg::vectorised::vectorised;
use pulp::Simd;
use std::ops::Range;

/// Matrix `α M̃ + β F` of every mode, `α = a + b λ` with its eigenvalue λ.
pub struct Operator<'a> {
    pub transport: &'a Transport,
    pub modes: &'a DepthModes,
    /// a, b and β.
    pub weights: [f64; 3],
}

impl Operator<'_> {
    /// Weights α of a block of modes.
    #[inline(always)]
    fn alpha<S: Simd, const B: usize>(&self, simd: S, at: usize) -> [S::f64s; B] {
        let mut alpha = blocks::<_, B>(S::as_simd_f64s(&self.modes.values).0)[at];
        let (a, b) = (simd.splat_f64s(self.weights[0]), simd.splat_f64s(self.weights[1]));
        for q in 0..B {
            alpha[q] = simd.mul_add_e_f64s(b, alpha[q], a);
        }
        alpha
    }

    /// Rows before, of and after the `nodes`, all in the blocks x; beyond the ends of an open streamline there is nothing.
    #[inline(always)]
    fn neighbours<'a, S: Simd, const B: usize>(
        &'a self,
        x: &'a [[S::f64s; B]],
        nodes: Range<usize>,
        stride: usize,
    ) -> [&'a [[S::f64s; B]]; 3] {
        let (n, size) = (self.transport.rows.len(), nodes.len() * stride);
        let nothing = blocks(S::as_simd_f64s(&self.modes.nothing).0);
        let [first, last] = if self.transport.closed { [x, &x[(n - 1) * stride..]] } else { [nothing; 2] };
        let before = if nodes.start > 0 { &x[(nodes.start - 1) * stride..] } else { last };
        let after = if nodes.end < n { &x[(nodes.start + 1) * stride..] } else { first };
        [&before[..size], &x[nodes.start * stride..][..size], &after[..size]]
    }

    /// Entries of a row in all lanes: of `M̃` the lower one, the sum and the upper one, of `−β F` the lower and the upper
    /// one.
    #[inline(always)]
    fn entries<S: Simd>(&self, simd: S, &[below, sum, above, from, to]: &[f64; 5]) -> [S::f64s; 5] {
        let flow = -self.weights[2];
        [
            simd.splat_f64s(below),
            simd.splat_f64s(sum),
            simd.splat_f64s(above),
            simd.splat_f64s(flow * from),
            simd.splat_f64s(flow * to),
        ]
    }
}

/// Nodes in the order of elimination that ends with `last`, in pieces: each end of the array is a piece of its own.
fn onwards(n: usize, last: usize) -> [Range<usize>; 4] {
    if last + 1 < n { [last + 1..n - 1, n - 1..n, 0..1, 1..last + 1] } else { [0..1, 1..n - 1, n - 1..n, n..n] }
}

/// `known` and the product of a row with its neighbours. They enter by their differences from the row, so that an even
/// field is not moved by round-off.
#[inline(always)]
fn product_of<S: Simd>(
    simd: S,
    [below, sum, above, from, to]: [S::f64s; 5],
    alpha: S::f64s,
    [before, here, after]: [S::f64s; 3],
    known: S::f64s,
) -> S::f64s {
    let (back, ahead) = (simd.sub_f64s(here, before), simd.sub_f64s(here, after));
    let mass = less(simd, less(simd, simd.mul_f64s(sum, here), below, back), above, ahead);
    let product = simd.mul_add_e_f64s(alpha, mass, known);
    simd.mul_add_e_f64s(to, ahead, simd.mul_add_e_f64s(from, back, product))
}

vectorised! {
    /// The product of the matrix with the field x; it replaces `out` or is added to it.
    fn product<'a, S>(simd, operator: &'a Operator<'a>, x: &'a [f64], out: &'a mut [f64], update: Update) {
        let (x, out) = (S::as_simd_f64s(x).0, S::as_mut_simd_f64s(out).0);
        let k = operator.modes.len() / S::F64_LANES;
        by_rows!(k, product_block::<S>(simd, operator, x, out, update));
    }
}

/// The block `at` of every row of [`product`].
#[inline(always)]
fn product_block<S: Simd, const B: usize>(
    simd: S,
    operator: &Operator,
    x: &[S::f64s],
    out: &mut [S::f64s],
    update: Update,
    stride: usize,
    at: usize,
) {
    let (alpha, bands) = (operator.alpha::<S, B>(simd, at), &operator.transport.rows);
    let (x, out) = (blocks::<_, B>(x), blocks_mut::<_, B>(out));
    for nodes in onwards(bands.len(), bands.len() - 1) {
        let (bands, out) = (&bands[nodes.clone()], &mut out[nodes.start * stride..][..nodes.len() * stride]);
        let [before, here, after] = operator.neighbours::<S, B>(x, nodes, stride);
        for i in 0..bands.len() {
            let (entries, j) = (operator.entries(simd, &bands[i]), i * stride + at);
            let (before, here, after, out) = (&before[j], &here[j], &after[j], &mut out[j]);
            for q in 0..B {
                let known = if update == Update::Add { out[q] } else { simd.splat_f64s(0.0) };
                out[q] = product_of(simd, entries, alpha[q], [before[q], here[q], after[q]], known);
            }
        }
    }
}

/// Elimination in a body: the node that comes last, and the factors `w`.
pub struct Elimination<'a> {
    pub last: usize,
    pub links: &'a [f64],
}

vectorised! {
    /// The product of the matrix with the field x and the surface `loads` of all nodes, eliminated; what `out` holds
    /// is replaced, or a load, too.
    fn load<'a, S>(
        simd,
        operator: &'a Operator<'a>,
        elimination: &'a Elimination<'a>,
        loads: &'a [f64],
        x: &'a [f64],
        out: &'a mut [f64],
        update: Update,
    ) {
        let (x, out) = (S::as_simd_f64s(x).0, S::as_mut_simd_f64s(out).0);
        let k = operator.modes.len() / S::F64_LANES;
        match update {
            Update::Replace => by_rows!(k, load_block::<S, false>(simd, operator, elimination, loads, x, out)),
            Update::Add => by_rows!(k, load_block::<S, true>(simd, operator, elimination, loads, x, out)),
        }
    }
}

/// The block `at` of every row of [`load`].
#[inline(always)]
fn load_block<S: Simd, const B: usize, const ADD: bool>(
    simd: S,
    operator: &Operator,
    elimination: &Elimination,
    loads: &[f64],
    x: &[S::f64s],
    out: &mut [S::f64s],
    stride: usize,
    at: usize,
) {
    let (alpha, bands) = (operator.alpha::<S, B>(simd, at), &operator.transport.rows);
    let shape = blocks::<_, B>(S::as_simd_f64s(&operator.modes.surface).0)[at];
    let (links, x, out) = (S::as_simd_f64s(elimination.links).0, blocks(x), blocks_mut::<_, B>(out));
    let links = blocks::<_, B>(links);
    let mut moving = [simd.splat_f64s(0.0); B];
    for nodes in onwards(bands.len(), elimination.last) {
        let (first, size) = (nodes.start * stride, nodes.len() * stride);
        let (bands, loads) = (&bands[nodes.clone()], &loads[nodes.clone()]);
        let (links, out) = (&links[first..][..size], &mut out[first..][..size]);
        let [before, here, after] = operator.neighbours::<S, B>(x, nodes, stride);
        for i in 0..bands.len() {
            let (entries, load) = (operator.entries(simd, &bands[i]), simd.splat_f64s(loads[i]));
            let j = i * stride + at;
            let (before, here, after, link, out) = (&before[j], &here[j], &after[j], &links[j], &mut out[j]);
            for q in 0..B {
                let held = if ADD { out[q] } else { simd.splat_f64s(0.0) };
                let given = simd.mul_add_e_f64s(load, shape[q], held);
                let y = product_of(simd, entries, alpha[q], [before[q], here[q], after[q]], given);
                moving[q] = less(simd, y, link[q], moving[q]);
                out[q] = moving[q];
            }
        }
    }
}

vectorised! {
    /// Elimination of what x holds, in rows of `width` numbers.
    fn eliminate<'a, S>(simd, elimination: &'a Elimination<'a>, x: &'a mut [f64], width: usize) {
        let _ = simd;
        let count = x.len() / width;
        let mut before = &mut [][..];
        let (first, second) = x.split_at_mut((elimination.last + 1) * width);
        let pieces = second.chunks_exact_mut(width).chain(first.chunks_exact_mut(width));
        for (step, row) in pieces.enumerate() {
            let node = (elimination.last + 1 + step) % count;
            let links = &elimination.links[node * width..][..width];
            row.iter_mut().zip(links.iter().zip(&*before)).for_each(|(x, (w, before))| *x -= w * before);
            before = row;
        }
    }
}

vectorised! {
    /// `sum ← sum − Σ f x` over rows: what the row f of the last node takes from it.
    fn take<'a, S>(simd, fill: &'a [f64], x: &'a [f64], sum: &'a mut [f64]) {
        let (fill, x, sum) = (S::as_simd_f64s(fill).0, S::as_simd_f64s(x).0, S::as_mut_simd_f64s(sum).0);
        by_rows!(sum.len(), take_block::<S>(simd, fill, x, sum));
    }
}

/// The block `at` of every row of [`take`].
#[inline(always)]
fn take_block<S: Simd, const B: usize>(
    simd: S,
    fill: &[S::f64s],
    x: &[S::f64s],
    sum: &mut [S::f64s],
    stride: usize,
    at: usize,
) {
    let (fill, mut parts) = (blocks::<_, B>(fill), blocks_mut::<_, B>(sum)[at]);
    let x = &blocks::<_, B>(x)[..fill.len()];
    for j in (at..fill.len()).step_by(stride) {
        let (fill, x) = (&fill[j], &x[j]);
        for q in 0..B {
            parts[q] = less(simd, parts[q], fill[q], x[q]);
        }
    }
    blocks_mut::<_, B>(sum)[at] = parts;
}

vectorised! {
    /// `x ← x − c y` in rows: what the column c of the last node takes from them if its value is the row y.
    fn leave<'a, S>(simd, fill: &'a [f64], y: &'a [f64], x: &'a mut [f64]) {
        let (fill, x, y) = (S::as_simd_f64s(fill).0, S::as_mut_simd_f64s(x).0, S::as_simd_f64s(y).0);
        by_rows!(y.len(), leave_block::<S>(simd, fill, y, x));
    }
}

/// The block `at` of every row of [`leave`].
#[inline(always)]
fn leave_block<S: Simd, const B: usize>(
    simd: S,
    fill: &[S::f64s],
    y: &[S::f64s],
    x: &mut [S::f64s],
    stride: usize,
    at: usize,
) {
    let (fill, y) = (blocks::<_, B>(fill), blocks::<_, B>(y)[at]);
    let x = &mut blocks_mut::<_, B>(x)[..fill.len()];
    for j in (at..fill.len()).step_by(stride) {
        let (fill, x) = (&fill[j], &mut x[j]);
        for q in 0..B {
            x[q] = less(simd, x[q], fill[q], y[q]);
        }
    }
}

vectorised! {
    /// Surface values of the solution in the rows that end with the last one, whose inverse pivots, factors r and column
    /// are given; the column may be empty, or end two rows before the last.
    fn surface<'a, S>(simd, factors: [&'a [f64]; 3], x: &'a [f64], shape: &'a [f64], out: &'a mut [f64]) {
        let [d, r, column] = factors.map(|factor| S::as_simd_f64s(factor).0);
        let (x, shape) = (S::as_simd_f64s(x).0, S::as_simd_f64s(shape).0);
        out.fill(0.0);
        by_rows!(shape.len(), surface_block::<S>(simd, [d, r, column], x, shape, out));
    }
}

/// The block `at` of every row of [`surface`].
#[inline(always)]
fn surface_block<S: Simd, const B: usize>(
    simd: S,
    factors: [&[S::f64s]; 3],
    x: &[S::f64s],
    shape: &[S::f64s],
    out: &mut [f64],
    stride: usize,
    at: usize,
) {
    let (size, filled) = (out.len() * stride, factors[2].len() / B);
    let (d, r, x) =
        (&blocks::<_, B>(factors[0])[..size], &blocks::<_, B>(factors[1])[..size], &blocks::<_, B>(x)[..size]);
    let (shape, column) = (blocks::<_, B>(shape)[at], blocks::<_, B>(factors[2]));
    let [mut moving, mut last] = [[simd.splat_f64s(0.0); B]; 2];
    for q in 0..B {
        let end = size - stride + at;
        last[q] = simd.mul_f64s(x[end][q], d[end][q]);
    }
    for i in (0..out.len()).rev() {
        let (mut sum, j) = (simd.splat_f64s(0.0), i * stride + at);
        let (x, d, r) = (&x[j], &d[j], &r[j]);
        for q in 0..B {
            let own = if j < filled { less(simd, x[q], column[j][q], last[q]) } else { x[q] };
            moving[q] = less(simd, simd.mul_f64s(own, d[q]), r[q], moving[q]);
            sum = simd.mul_add_e_f64s(moving[q], shape[q], sum);
        }
        out[i] += simd.reduce_sum_f64s(sum);
    }
}

vectorised! {
    /// Adds surface `loads` of the rows that end with the last one to x, after their elimination by the factors w and
    /// the row of the last node, which may be empty or end two rows before it.
    fn add_load<'a, S>(simd, factors: [&'a [f64]; 2], loads: &'a [f64], shape: &'a [f64], x: &'a mut [f64]) {
        let (w, fill) = (S::as_simd_f64s(factors[0]).0, S::as_simd_f64s(factors[1]).0);
        let (shape, x) = (S::as_simd_f64s(shape).0, S::as_mut_simd_f64s(x).0);
        by_rows!(shape.len(), add_load_block::<S>(simd, [w, fill], loads, shape, x));
    }
}

/// The block `at` of every row of [`add_load`].
#[inline(always)]
fn add_load_block<S: Simd, const B: usize>(
    simd: S,
    [w, fill]: [&[S::f64s]; 2],
    loads: &[f64],
    shape: &[S::f64s],
    x: &mut [S::f64s],
    stride: usize,
    at: usize,
) {
    let (size, shape, fill) = (loads.len() * stride, blocks::<_, B>(shape)[at], blocks::<_, B>(fill));
    let (w, x) = (&blocks::<_, B>(w)[..size], &mut blocks_mut::<_, B>(x)[..size]);
    let [mut moving, mut taken] = [[simd.splat_f64s(0.0); B]; 2];
    for i in 0..loads.len() {
        let (load, j) = (simd.splat_f64s(loads[i]), i * stride + at);
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

vectorised! {
    /// The second half of a solution, from the node that was eliminated `last` back; `d` are the inverse pivots.
    fn substitute<'a, S>(simd, d: &'a [f64], r: &'a [f64], x: &'a mut [f64], width: usize, last: usize) {
        let (d, r, x) = (S::as_simd_f64s(d).0, S::as_simd_f64s(r).0, S::as_mut_simd_f64s(x).0);
        let k = width / S::F64_LANES;
        by_rows!(k, substitute_block::<S>(simd, [d, r], x, last));
    }
}

/// The block `at` of every row of [`substitute`].
#[inline(always)]
fn substitute_block<S: Simd, const B: usize>(
    simd: S,
    [d, r]: [&[S::f64s]; 2],
    x: &mut [S::f64s],
    last: usize,
    stride: usize,
    at: usize,
) {
    let (d, r, x) = (blocks::<_, B>(d), blocks::<_, B>(r), blocks_mut::<_, B>(x));
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
