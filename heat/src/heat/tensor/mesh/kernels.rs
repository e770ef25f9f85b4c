//! Loops over the rows of fields, where a row holds the modes at one node along the surface.
//!
//! They take much of the time of a step, and are written for the vector registers of the machine that runs them.
//! Results of different machines differ by round-off: by the order of sums, and where a product and a sum are rounded
//! at once.

use crate::linalg::vectorised::vectorised;
use pulp::Simd;

/// Defines a [`vectorised!`] loop over rows of `$width` numbers. A row is `$stride` blocks of `$B` registers, and the body
/// goes over the block `$at` of every row. Rows of the usual lengths are one block, as the compiler knows, so that it
/// needs no checks of bounds. What is known before the loop may be a constant `$C` in it, which callers give as `$flag`.
macro_rules! rows {
    (
        $(#[$meta:meta])*
        fn $name:ident<$a:lifetime, $S:ident, $B:ident $(, $C:ident = $flag:ident)?>(
            $simd:ident, [$stride:ident, $at:ident] of $width:expr, $($arg:ident: $type:ty),* $(,)?
        ) $body:block
    ) => {
        $crate::linalg::vectorised::vectorised! {
            $(#[$meta])*
            fn $name<$a, $S>($simd, $($flag: bool,)? $($arg: $type),*) {
                #[inline(always)]
                #[allow(clippy::too_many_arguments, unused_variables)]
                fn block<$a, $S: pulp::Simd, const $B: usize $(, const $C: bool)?>(
                    $simd: $S, $($arg: $type,)* $stride: usize, $at: usize,
                ) $body
                let k = $width / $S::F64_LANES;
                $crate::heat::tensor::mesh::kernels::by_flag!($($flag)?, k, block::<$S>($simd, $($arg),*));
            }
        }
    };
}
pub(crate) use rows;

/// Calls a block of [`rows!`] with its constant.
macro_rules! by_flag {
    (, $k:ident, $work:ident::<$S:ident>($($arg:expr),*)) => {
        $crate::heat::tensor::mesh::kernels::by_rows!($k, $work::<$S>($($arg),*))
    };
    ($flag:ident, $k:ident, $work:ident::<$S:ident>($($arg:expr),*)) => {
        if $flag {
            $crate::heat::tensor::mesh::kernels::by_rows!($k, $work::<$S, true>($($arg),*))
        } else {
            $crate::heat::tensor::mesh::kernels::by_rows!($k, $work::<$S, false>($($arg),*))
        }
    };
}
pub(crate) use by_flag;

/// Calls a block of [`rows!`] for rows of `$k` registers.
macro_rules! by_rows {
    ($k:expr, $work:ident::<$S:ident $(, $C:literal)?>($($arg:expr),*)) => {
        match $k {
            6 => $work::<$S, 6 $(, $C)?>($($arg),*, 1, 0),
            7 => $work::<$S, 7 $(, $C)?>($($arg),*, 1, 0),
            8 => $work::<$S, 8 $(, $C)?>($($arg),*, 1, 0),
            9 => $work::<$S, 9 $(, $C)?>($($arg),*, 1, 0),
            10 => $work::<$S, 10 $(, $C)?>($($arg),*, 1, 0),
            11 => $work::<$S, 11 $(, $C)?>($($arg),*, 1, 0),
            k => {
                let block = if k % 4 == 0 { 4 } else if k % 3 == 0 { 3 } else { 1 };
                for at in 0..k / block {
                    match block {
                        4 => $work::<$S, 4 $(, $C)?>($($arg),*, k / 4, at),
                        3 => $work::<$S, 3 $(, $C)?>($($arg),*, k / 3, at),
                        _ => $work::<$S, 1 $(, $C)?>($($arg),*, k, at),
                    }
                }
            }
        }
    };
}
pub(crate) use by_rows;

/// An array in blocks of `B` registers.
#[inline(always)]
pub fn blocks<S: Simd, const B: usize>(x: &[f64]) -> &[[S::f64s; B]] {
    S::as_simd_f64s(x).0.as_chunks().0
}

/// An array in blocks of `B` registers, to be changed.
#[inline(always)]
pub fn blocks_mut<S: Simd, const B: usize>(x: &mut [f64]) -> &mut [[S::f64s; B]] {
    S::as_mut_simd_f64s(x).0.as_chunks_mut().0
}

vectorised! {
    /// `x ← x + factor · y`.
    fn add<'a, S>(simd, factor: f64, y: &'a [f64], x: &'a mut [f64]) {
        let _ = simd;
        x.iter_mut().zip(y).for_each(|(x, y)| *x += factor * y);
    }
}

rows! {
    /// Adds all rows of `x`, each times its weight, to `sums`.
    fn add_weighted<'a, S, B>(
        simd, [stride, at] of sums.len(), weights: &'a [f64], x: &'a [f64], sums: &'a mut [f64]
    ) {
        let (x, mut parts) = (&blocks::<S, B>(x)[..weights.len() * stride], blocks::<S, B>(sums)[at]);
        for i in 0..weights.len() {
            let (x, weight) = (&x[i * stride + at], simd.splat_f64s(weights[i]));
            for q in 0..B {
                parts[q] = simd.mul_add_e_f64s(weight, x[q], parts[q]);
            }
        }
        blocks_mut::<S, B>(sums)[at] = parts;
    }
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

rows! {
    /// Fills the field `next` after the stage and `∫ rate ds` of every mode; after the last stage of a step also bounds
    /// of the distances by which the values below every surface node have `moved` in the step.
    fn advance<'a, S, B, LAST = last>(
        simd, [stride, at] of sums.len(),
        stage: &'a Advance<'a>, next: &'a mut [f64], sums: &'a mut [f64], moved: &'a mut [f64],
    ) {
        let (n, weights) = (stage.weights.len(), stage.weights);
        let moved = if LAST { &mut moved[..n] } else { moved };
        let (rate, from) = (&blocks::<S, B>(stage.rate)[..n * stride], &blocks::<S, B>(stage.from)[..n * stride]);
        let begin = &blocks::<S, B>(stage.begin)[..n * stride];
        let next = &mut blocks_mut::<S, B>(next)[..n * stride];
        let (peaks, ahead) = (blocks::<S, B>(stage.peaks)[at], simd.splat_f64s(stage.ahead));
        let mut parts = [simd.splat_f64s(0.0); B];
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
                moved[i] = if at == 0 { 0.0 } else { moved[i] } + simd.reduce_sum_f64s(distance);
            }
        }
        blocks_mut::<S, B>(sums)[at] = parts;
    }
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

rows! {
    /// Scalar products of all rows of `x` with `shape`.
    fn products<'a, S, B>(simd, [stride, at] of shape.len(), x: &'a [f64], shape: &'a [f64], out: &'a mut [f64]) {
        let (x, shape) = (&blocks::<S, B>(x)[..out.len() * stride], blocks::<S, B>(shape)[at]);
        for i in 0..out.len() {
            let (x, mut sum) = (&x[i * stride + at], simd.splat_f64s(0.0));
            for q in 0..B {
                sum = simd.mul_add_e_f64s(x[q], shape[q], sum);
            }
            out[i] = if at == 0 { 0.0 } else { out[i] } + simd.reduce_sum_f64s(sum);
        }
    }
}

rows! {
    /// Widens `range` by the values of all rows of `x` at the nodes where the modes have the values `shapes`, mode by
    /// mode and those of a mode as many as `nodes`.
    fn extremes<'a, S, B>(
        simd, [stride, at] of nodes, x: &'a [f64], shapes: &'a [f64], nodes: usize, range: &'a mut [f64; 2]
    ) {
        let (shapes, modes) = (blocks::<S, B>(shapes), shapes.len() / nodes);
        let shapes = &shapes[..modes * stride];
        for row in x.chunks_exact(modes) {
            let mut sums = [simd.splat_f64s(0.0); B];
            for i in 0..modes {
                let (x, shape) = (simd.splat_f64s(row[i]), &shapes[i * stride + at]);
                for q in 0..B {
                    sums[q] = simd.mul_add_e_f64s(x, shape[q], sums[q]);
                }
            }
            let mut ends = [sums[0]; 2];
            for sum in sums {
                ends = [simd.min_f64s(ends[0], sum), simd.max_f64s(ends[1], sum)];
            }
            let [low, high] = [simd.reduce_min_f64s(ends[0]), simd.reduce_max_f64s(ends[1])];
            *range = [range[0].min(low), range[1].max(high)];
        }
    }
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
