//! Loops over the rows of fields, where a row holds the modes at one node along the surface.
//!
//! They take much of the time of a step, and are written for the vector registers of the machine that runs them.
//! Results of different machines differ by round-off: by the order of sums, and where a product and a sum are rounded
//! at once.

use crate::linalg::vectorised::vectorised;
use pulp::Simd;

/// Runs `$work::<S, B>($args, stride, at)` for rows of `$k` registers: one row is `stride` blocks of `B` registers, and the
/// work is that of the block `at` of every row. Rows of the usual lengths are one block, as the compiler knows.
macro_rules! by_rows {
    ($k:expr, $work:ident::<$S:ident $(, $C:literal)?>($($arg:expr),* $(,)?)) => {
        match $k {
            6 => $work::<$S, 6 $(, $C)?>($($arg),*, 1, 0),
            7 => $work::<$S, 7 $(, $C)?>($($arg),*, 1, 0),
            8 => $work::<$S, 8 $(, $C)?>($($arg),*, 1, 0),
            9 => $work::<$S, 9 $(, $C)?>($($arg),*, 1, 0),
            10 => $work::<$S, 10 $(, $C)?>($($arg),*, 1, 0),
            11 => $work::<$S, 11 $(, $C)?>($($arg),*, 1, 0),
            k if k % 4 == 0 => {
                for at in 0..k / 4 {
                    $work::<$S, 4 $(, $C)?>($($arg),*, k / 4, at);
                }
            }
            k if k % 3 == 0 => {
                for at in 0..k / 3 {
                    $work::<$S, 3 $(, $C)?>($($arg),*, k / 3, at);
                }
            }
            k => {
                for at in 0..k {
                    $work::<$S, 1 $(, $C)?>($($arg),*, k, at);
                }
            }
        }
    };
}
pub(crate) use by_rows;

/// An array in blocks of `B` registers.
#[inline(always)]
pub fn blocks<V, const B: usize>(x: &[V]) -> &[[V; B]] {
    x.as_chunks().0
}

/// An array in blocks of `B` registers, to be changed.
#[inline(always)]
pub fn blocks_mut<V, const B: usize>(x: &mut [V]) -> &mut [[V; B]] {
    x.as_chunks_mut().0
}

vectorised! {
    /// `x ← x + factor · y`.
    fn add<'a, S>(simd, factor: f64, y: &'a [f64], x: &'a mut [f64]) {
        let ((y, y_rest), (x, x_rest)) = (S::as_simd_f64s(y), S::as_mut_simd_f64s(x));
        let many = simd.splat_f64s(factor);
        let ((x, x_few), (y, y_few)) = (x.as_chunks_mut::<4>(), y.as_chunks::<4>());
        for (x, y) in x.iter_mut().zip(y) {
            for q in 0..4 {
                x[q] = simd.mul_add_e_f64s(many, y[q], x[q]);
            }
        }
        x_few.iter_mut().zip(y_few).for_each(|(x, &y)| *x = simd.mul_add_e_f64s(many, y, *x));
        x_rest.iter_mut().zip(y_rest).for_each(|(x, y)| *x += factor * y);
    }
}

vectorised! {
    /// Adds all rows of `x`, each times its weight, to `sums`.
    fn add_weighted<'a, S>(simd, weights: &'a [f64], x: &'a [f64], sums: &'a mut [f64]) {
        let (x, sums) = (S::as_simd_f64s(x).0, S::as_mut_simd_f64s(sums).0);
        by_rows!(sums.len(), add_weighted_block::<S>(simd, weights, x, sums));
    }
}

/// The block `at` of every row of [`add_weighted`].
#[inline(always)]
fn add_weighted_block<S: Simd, const B: usize>(
    simd: S,
    weights: &[f64],
    x: &[S::f64s],
    sums: &mut [S::f64s],
    stride: usize,
    at: usize,
) {
    let (x, sums) = (&blocks::<_, B>(x)[..weights.len() * stride], &mut blocks_mut::<_, B>(sums)[at]);
    let mut parts = *sums;
    for i in 0..weights.len() {
        let (x, weight) = (&x[i * stride + at], simd.splat_f64s(weights[i]));
        for q in 0..B {
            parts[q] = simd.mul_add_e_f64s(weight, x[q], parts[q]);
        }
    }
    *sums = parts;
}

/// A field that a stage takes on.
pub struct Advance<'a> {
    /// Rate of the field [K/s], and the time by which it is taken on \[s].
    pub rate: &'a [f64],
    pub ahead: f64,
    /// Field before the stage, and at the beginning of the step.
    pub from: &'a [f64],
    pub begin: &'a [f64],
    /// `∫ N ds` of the nodes \[m], and the largest value of every mode.
    pub weights: &'a [f64],
    pub peaks: &'a [f64],
}

vectorised! {
    /// Fills the field `next` after the stage, `∫ rate ds` of every mode and, unless `moved` is empty, bounds of the
    /// distances by which the values below every surface node have moved in the step.
    fn advance<'a, S>(
        simd,
        stage: &'a Advance<'a>,
        next: &'a mut [f64],
        sums: &'a mut [f64],
        moved: &'a mut [f64],
    ) {
        let (next, sums) = (S::as_mut_simd_f64s(next).0, S::as_mut_simd_f64s(sums).0);
        moved.fill(0.0);
        if moved.is_empty() {
            by_rows!(sums.len(), advance_block::<S, false>(simd, stage, next, sums, moved));
        } else {
            by_rows!(sums.len(), advance_block::<S, true>(simd, stage, next, sums, moved));
        }
    }
}

/// The block `at` of every row of [`advance`]; `LAST`: in the last stage of a step.
#[inline(always)]
fn advance_block<S: Simd, const B: usize, const LAST: bool>(
    simd: S,
    stage: &Advance,
    next: &mut [S::f64s],
    sums: &mut [S::f64s],
    moved: &mut [f64],
    stride: usize,
    at: usize,
) {
    let (n, weights) = (stage.weights.len(), stage.weights);
    let moved = if LAST { &mut moved[..n] } else { moved };
    let rate = &blocks::<_, B>(S::as_simd_f64s(stage.rate).0)[..n * stride];
    let from = &blocks::<_, B>(S::as_simd_f64s(stage.from).0)[..n * stride];
    let begin = &blocks::<_, B>(S::as_simd_f64s(stage.begin).0)[..n * stride];
    let next = &mut blocks_mut::<_, B>(next)[..n * stride];
    let peaks = blocks::<_, B>(S::as_simd_f64s(stage.peaks).0)[at];
    let (ahead, mut parts) = (simd.splat_f64s(stage.ahead), [simd.splat_f64s(0.0); B]);
    for i in 0..n {
        let (weight, mut distance) = (simd.splat_f64s(weights[i]), simd.splat_f64s(0.0));
        let j = i * stride + at;
        let (rate, from, begin, next) = (&rate[j], &from[j], &begin[j], &mut next[j]);
        for q in 0..B {
            next[q] = simd.mul_add_e_f64s(ahead, rate[q], from[q]);
            parts[q] = simd.mul_add_e_f64s(weight, rate[q], parts[q]);
            if LAST {
                let change = simd.abs_f64s(simd.sub_f64s(next[q], begin[q]));
                distance = simd.mul_add_e_f64s(change, peaks[q], distance);
            }
        }
        if LAST {
            moved[i] += simd.reduce_sum_f64s(distance);
        }
    }
    blocks_mut::<_, B>(sums)[at] = parts;
}

vectorised! {
    /// Adds `shape` times its number in `load` to every row of `x`; where the load is zero, nothing is done.
    fn add_rows<'a, S>(simd, load: &'a [f64], shape: &'a [f64], x: &'a mut [f64]) {
        let (shape, x) = (S::as_simd_f64s(shape).0, S::as_mut_simd_f64s(x).0);
        for (x, &amount) in x.chunks_exact_mut(shape.len()).zip(load) {
            if amount != 0.0 {
                let many = simd.splat_f64s(amount);
                x.iter_mut().zip(shape).for_each(|(x, &shape)| *x = simd.mul_add_e_f64s(many, shape, *x));
            }
        }
    }
}

vectorised! {
    /// Scalar products of all rows of `x` with some shapes.
    fn products<'a, S, const N: usize>(simd, x: &'a [f64], shapes: [&'a [f64]; N], out: [&'a mut [f64]; N]) {
        let k = shapes[0].len() / S::F64_LANES;
        for (out, shape) in out.into_iter().zip(shapes) {
            let (x, shape) = (S::as_simd_f64s(x).0, S::as_simd_f64s(shape).0);
            out.fill(0.0);
            by_rows!(k, products_block::<S>(simd, x, shape, out));
        }
    }
}

/// The block `at` of every row of [`products`].
#[inline(always)]
fn products_block<S: Simd, const B: usize>(
    simd: S,
    x: &[S::f64s],
    shape: &[S::f64s],
    out: &mut [f64],
    stride: usize,
    at: usize,
) {
    let (x, shape) = (&blocks::<_, B>(x)[..out.len() * stride], &blocks::<_, B>(shape)[at]);
    for i in 0..out.len() {
        let (x, mut sum) = (&x[i * stride + at], simd.splat_f64s(0.0));
        for q in 0..B {
            sum = simd.mul_add_e_f64s(x[q], shape[q], sum);
        }
        out[i] += simd.reduce_sum_f64s(sum);
    }
}

vectorised! {
    /// Lowest and highest value of all rows of `modes` numbers at the nodes with the values `shapes` of all modes, mode
    /// by mode.
    fn extremes<'a, S>(simd, x: &'a [f64], modes: usize, shapes: &'a [f64]) -> [f64; 2] {
        let shapes = S::as_simd_f64s(shapes).0;
        let mut range = [f64::INFINITY, f64::NEG_INFINITY];
        for row in x.chunks_exact(modes) {
            let range = &mut range;
            by_rows!(shapes.len() / modes, extremes_block::<S>(simd, row, shapes, range));
        }
        range
    }
}

/// The block `at` of the nodes of [`extremes`].
#[inline(always)]
fn extremes_block<S: Simd, const B: usize>(
    simd: S,
    row: &[f64],
    shapes: &[S::f64s],
    range: &mut [f64; 2],
    stride: usize,
    at: usize,
) {
    let (shapes, mut sums) = (&blocks::<_, B>(shapes)[..row.len() * stride], [simd.splat_f64s(0.0); B]);
    for i in 0..row.len() {
        let (x, shape) = (simd.splat_f64s(row[i]), &shapes[i * stride + at]);
        for q in 0..B {
            sums[q] = simd.mul_add_e_f64s(x, shape[q], sums[q]);
        }
    }
    let mut ends = [sums[0]; 2];
    for q in 1..B {
        ends = [simd.min_f64s(ends[0], sums[q]), simd.max_f64s(ends[1], sums[q])];
    }
    let [low, high] = [simd.reduce_min_f64s(ends[0]), simd.reduce_max_f64s(ends[1])];
    *range = [range[0].min(low), range[1].max(high)];
}

/// Scalar product of vectors whose length is a multiple of four.
#[inline(always)]
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 4];
    for (a, b) in a.chunks_exact(4).zip(b.chunks_exact(4)) {
        for l in 0..4 {
            sums[l] += a[l] * b[l];
        }
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3])
}
