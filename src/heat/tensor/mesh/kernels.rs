//! Loops over the rows of fields, where a row holds the modes at one node along the surface.
//!
//! They take much of the time of a step, and are written for the vector registers of the machine that runs them.
//! Results of different machines differ by round-off: by the order of sums, and where a product and a sum are rounded
//! at once.

use crate::linalg::vectorised::{BLOCK, by_blocks, load, vectorised};
use pulp::Simd;

vectorised! {
    /// `x ← x + factor · y`.
    fn add<'a, S>(simd, factor: f64, y: &'a [f64], x: &'a mut [f64]) {
        let ((y, y_rest), (x, x_rest)) = (S::as_simd_f64s(y), S::as_mut_simd_f64s(x));
        let many = simd.splat_f64s(factor);
        let ((x, x_few), (y, y_few)) = (x.as_chunks_mut::<BLOCK>(), y.as_chunks::<BLOCK>());
        for (x, y) in x.iter_mut().zip(y) {
            for q in 0..BLOCK {
                x[q] = simd.mul_add_e_f64s(many, y[q], x[q]);
            }
        }
        x_few.iter_mut().zip(y_few).for_each(|(x, &y)| *x = simd.mul_add_e_f64s(many, y, *x));
        x_rest.iter_mut().zip(y_rest).for_each(|(x, y)| *x += factor * y);
    }
}

vectorised! {
    /// `out ← x + factor · y`.
    fn sum<'a, S>(simd, x: &'a [f64], factor: f64, y: &'a [f64], out: &'a mut [f64]) {
        let (x, x_rest) = S::as_simd_f64s(x);
        let ((y, y_rest), (out, out_rest)) = (S::as_simd_f64s(y), S::as_mut_simd_f64s(out));
        let many = simd.splat_f64s(factor);
        let ((x, x_few), (y, y_few)) = (x.as_chunks::<BLOCK>(), y.as_chunks::<BLOCK>());
        let (out, out_few) = out.as_chunks_mut::<BLOCK>();
        for ((out, x), y) in out.iter_mut().zip(x).zip(y) {
            for q in 0..BLOCK {
                out[q] = simd.mul_add_e_f64s(many, y[q], x[q]);
            }
        }
        for ((out, &x), &y) in out_few.iter_mut().zip(x_few).zip(y_few) {
            *out = simd.mul_add_e_f64s(many, y, x);
        }
        out_rest.iter_mut().zip(x_rest.iter().zip(y_rest)).for_each(|(out, (x, y))| *out = x + factor * y);
    }
}

vectorised! {
    /// Adds all rows of `x`, each times its weight, to `sums`.
    fn add_weighted<'a, S>(simd, weights: &'a [f64], x: &'a [f64], sums: &'a mut [f64]) {
        let (x, sums) = (S::as_simd_f64s(x).0, S::as_mut_simd_f64s(sums).0);
        by_blocks!(sums.len(), add_weighted_block::<S>(simd, weights, x, sums));
    }
}

/// The registers from `at` on of [`add_weighted`].
#[inline(always)]
fn add_weighted_block<S: Simd, const B: usize>(
    simd: S,
    weights: &[f64],
    x: &[S::f64s],
    sums: &mut [S::f64s],
    at: usize,
) {
    let mut parts: [_; B] = load(sums, at);
    for (x, &weight) in x.chunks_exact(sums.len()).zip(weights) {
        let (x, weight) = (&x[at..at + B], simd.splat_f64s(weight));
        for q in 0..B {
            parts[q] = simd.mul_add_e_f64s(weight, x[q], parts[q]);
        }
    }
    sums[at..at + B].copy_from_slice(&parts);
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
    /// Scalar products of all rows of `x` with `shape`.
    fn products<'a, S>(simd, x: &'a [f64], shape: &'a [f64], out: &'a mut [f64]) {
        let (x, shape) = (S::as_simd_f64s(x).0, S::as_simd_f64s(shape).0);
        for (x, out) in x.chunks_exact(shape.len()).zip(out) {
            let mut sums = simd.splat_f64s(0.0);
            for (&x, &shape) in x.iter().zip(shape) {
                sums = simd.mul_add_e_f64s(x, shape, sums);
            }
            *out = simd.reduce_sum_f64s(sums);
        }
    }
}

vectorised! {
    /// Scalar products of all rows of `x` with three shapes.
    fn products_of_three<'a, S>(simd, x: &'a [f64], shapes: [&'a [f64]; 3], out: [&'a mut [f64]; 3]) {
        let ([a, b, c], x) = (shapes.map(|shape| S::as_simd_f64s(shape).0), S::as_simd_f64s(x).0);
        for (i, x) in x.chunks_exact(a.len()).enumerate() {
            let mut sums = [simd.splat_f64s(0.0); 3];
            for (&x, ((&a, &b), &c)) in x.iter().zip(a.iter().zip(b).zip(c)) {
                sums[0] = simd.mul_add_e_f64s(x, a, sums[0]);
                sums[1] = simd.mul_add_e_f64s(x, b, sums[1]);
                sums[2] = simd.mul_add_e_f64s(x, c, sums[2]);
            }
            (0..3).for_each(|k| out[k][i] = simd.reduce_sum_f64s(sums[k]));
        }
    }
}

vectorised! {
    /// `Σ |bₘ − aₘ| weightₘ` of all rows of `a` and `b`.
    fn weighted_changes<'a, S>(simd, a: &'a [f64], b: &'a [f64], weights: &'a [f64], out: &'a mut [f64]) {
        let (a, b, weights) = (S::as_simd_f64s(a).0, S::as_simd_f64s(b).0, S::as_simd_f64s(weights).0);
        let k = weights.len();
        for ((a, b), out) in a.chunks_exact(k).zip(b.chunks_exact(k)).zip(out) {
            let mut sum = simd.splat_f64s(0.0);
            for ((&a, &b), &weight) in a.iter().zip(b).zip(weights) {
                sum = simd.mul_add_e_f64s(simd.abs_f64s(simd.sub_f64s(b, a)), weight, sum);
            }
            *out = simd.reduce_sum_f64s(sum);
        }
    }
}

vectorised! {
    /// Lowest and highest value of all rows of `modes` numbers at the nodes of all `blocks`: values of the first modes,
    /// as many as count there, at [`NODES`] nodes, mode by mode.
    fn extremes<'a, S>(simd, x: &'a [f64], modes: usize, blocks: &'a [Vec<f64>]) -> [f64; 2] {
        let mut range = [f64::INFINITY, f64::NEG_INFINITY].map(|end| simd.splat_f64s(end));
        for row in x.chunks_exact(modes) {
            for block in blocks {
                let shapes = S::as_simd_f64s(block).0;
                let ends = match NODES / S::F64_LANES {
                    1 => extremes_of::<S, 1>(simd, row, shapes),
                    2 => extremes_of::<S, 2>(simd, row, shapes),
                    4 => extremes_of::<S, 4>(simd, row, shapes),
                    8 => extremes_of::<S, 8>(simd, row, shapes),
                    _ => extremes_of::<S, NODES>(simd, row, shapes),
                };
                range = [simd.min_f64s(range[0], ends[0]), simd.max_f64s(range[1], ends[1])];
            }
        }
        [simd.reduce_min_f64s(range[0]), simd.reduce_max_f64s(range[1])]
    }
}

/// Nodes of a block, whose values are summed at a time.
pub const NODES: usize = 16;

vectorised! {
    /// Values of one row at the nodes of all blocks of [`extremes`].
    fn values_at<'a, S>(simd, row: &'a [f64], blocks: &'a [Vec<f64>], out: &'a mut [f64]) {
        for (block, out) in blocks.iter().zip(out.chunks_exact_mut(NODES)) {
            let (shapes, out) = (S::as_simd_f64s(block).0, S::as_mut_simd_f64s(out).0);
            match NODES / S::F64_LANES {
                1 => out.copy_from_slice(&sums_of::<S, 1>(simd, row, shapes)),
                2 => out.copy_from_slice(&sums_of::<S, 2>(simd, row, shapes)),
                4 => out.copy_from_slice(&sums_of::<S, 4>(simd, row, shapes)),
                8 => out.copy_from_slice(&sums_of::<S, 8>(simd, row, shapes)),
                _ => out.copy_from_slice(&sums_of::<S, NODES>(simd, row, shapes)),
            }
        }
    }
}

/// Sums of `B` registers of all shapes, each times its number in `row`.
#[inline(always)]
fn sums_of<S: Simd, const B: usize>(simd: S, row: &[f64], shapes: &[S::f64s]) -> [S::f64s; B] {
    let mut sums = [simd.splat_f64s(0.0); B];
    for (&x, shape) in row.iter().zip(shapes.as_chunks::<B>().0) {
        let x = simd.splat_f64s(x);
        for q in 0..B {
            sums[q] = simd.mul_add_e_f64s(x, shape[q], sums[q]);
        }
    }
    sums
}

/// Extremes of [`sums_of`].
#[inline(always)]
fn extremes_of<S: Simd, const B: usize>(simd: S, row: &[f64], shapes: &[S::f64s]) -> [S::f64s; 2] {
    let sums = sums_of::<S, B>(simd, row, shapes);
    let mut ends = [sums[0]; 2];
    for &sum in &sums[1..] {
        ends = [simd.min_f64s(ends[0], sum), simd.max_f64s(ends[1], sum)];
    }
    ends
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
