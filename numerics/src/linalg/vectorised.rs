//! Loops for the vector registers of the machine that runs them.

/// Defines a function whose body is compiled for every kind of vector registers; in it `$simd` are those of the
/// machine. The compiler turns loops over arrays into vector instructions, but not closures such as those of
/// `array::from_fn` and `map`, which become functions of their own. A function is that of its crate unless it is said to
/// be `pub`.
#[macro_export]
macro_rules! vectorised {
    (
        $(#[$meta:meta])*
        fn $name:ident<$life:lifetime, $S:ident $(, const $N:ident: usize)*>($($rest:tt)*) $($body:tt)*
    ) => {
        $crate::vectorised!(@of [pub(crate)] [$(#[$meta])*] $name, $life, $S [$($N)*] ($($rest)*) $($body)*);
    };
    (
        $(#[$meta:meta])*
        pub fn $name:ident<$life:lifetime, $S:ident $(, const $N:ident: usize)*>($($rest:tt)*) $($body:tt)*
    ) => {
        $crate::vectorised!(@of [pub] [$(#[$meta])*] $name, $life, $S [$($N)*] ($($rest)*) $($body)*);
    };
    (
        @of [$seen:vis] [$(#[$meta:meta])*] $name:ident, $life:lifetime, $S:ident [$($N:ident)*] (
            $simd:ident, $($arg:ident: $type:ty),* $(,)?
        ) $(-> $out:ty)? $body:block
    ) => {
        $(#[$meta])*
        $seen fn $name<$life $(, const $N: usize)*>($($arg: $type),*) $(-> $out)? {
            struct Kernel<$life $(, const $N: usize)*> {
                $($arg: $type),*
            }
            impl<$life $(, const $N: usize)*> $crate::pulp::WithSimd for Kernel<$life $(, $N)*> {
                type Output = $crate::vectorised!(@output $($out)?);

                #[inline(always)]
                fn with_simd<$S: $crate::pulp::Simd>(self, $simd: $S) -> Self::Output {
                    let Kernel { $($arg),* } = self;
                    $body
                }
            }
            $crate::pulp::Arch::new().dispatch(Kernel { $($arg),* })
        }
    };
    (@output) => { () };
    (@output $out:ty) => { $out };
}
pub use vectorised;

/// Runs `$work::<S, B>($args, at)`, or `$work::<S, B, L>`, for all blocks of registers of rows of `$k` registers; a
/// block has up to [`BLOCK`](crate::linalg::vectorised::BLOCK) registers, and all have about as many.
#[macro_export]
macro_rules! by_blocks {
    ($k:expr, $work:ident::<$S:ident $(, $L:ident)?>($($arg:expr),* $(,)?)) => {
        let (k, mut at): (usize, usize) = ($k, 0);
        let block = k.div_ceil(k.div_ceil(BLOCK).max(1)).max(1);
        while at < k {
            match block.min(k - at) {
                1 => $work::<$S, 1 $(, $L)?>($($arg),*, at),
                2 => $work::<$S, 2 $(, $L)?>($($arg),*, at),
                3 => $work::<$S, 3 $(, $L)?>($($arg),*, at),
                _ => $work::<$S, BLOCK $(, $L)?>($($arg),*, at),
            }
            at += block;
        }
    };
}
pub use by_blocks;

/// Registers that go from row to row together: what a row passes on to the next one stays in them, and each waits for
/// the result of the row before.
pub const BLOCK: usize = 4;

/// `B` numbers from a place on.
#[inline(always)]
pub fn load<V: Copy, const B: usize>(values: &[V], at: usize) -> [V; B] {
    let values = &values[at..at + B];
    std::array::from_fn(|q| values[q])
}

/// `y ← y + Σ a x` in whole registers.
#[inline(always)]
pub fn add_multiples<S: pulp::Simd, const W: usize, const N: usize>(
    simd: S,
    a: [f64; N],
    x: &[[f64; W]; N],
    y: &mut [f64; W],
) {
    let (y, y_rest) = S::as_mut_simd_f64s(y);
    for (a, x) in a.iter().zip(x) {
        let ((x, x_rest), many) = (S::as_simd_f64s(x), simd.splat_f64s(*a));
        for (y, x) in y.iter_mut().zip(x) {
            *y = simd.mul_add_e_f64s(many, *x, *y);
        }
        y_rest.iter_mut().zip(x_rest).for_each(|(y, x)| *y += a * x);
    }
}

vectorised! {
    /// Scalar product.
    pub fn dot<'a, S>(simd, a: &'a [f64], b: &'a [f64]) -> f64 {
        let ((a, a_rest), (b, b_rest)) = (S::as_simd_f64s(a), S::as_simd_f64s(b));
        let mut sums = [simd.splat_f64s(0.0); 4];
        let (a_fours, a_few) = a.as_chunks::<4>();
        let (b_fours, b_few) = b.as_chunks::<4>();
        for (a, b) in a_fours.iter().zip(b_fours) {
            for l in 0..4 {
                sums[l] = simd.mul_add_e_f64s(a[l], b[l], sums[l]);
            }
        }
        for (&a, &b) in a_few.iter().zip(b_few) {
            sums[0] = simd.mul_add_e_f64s(a, b, sums[0]);
        }
        let sum = simd.add_f64s(simd.add_f64s(sums[0], sums[1]), simd.add_f64s(sums[2], sums[3]));
        simd.reduce_sum_f64s(sum) + a_rest.iter().zip(b_rest).map(|(a, b)| a * b).sum::<f64>()
    }
}

vectorised! {
    /// `out ← out + factor · A x` with the columns of `A`, as long as `out`, whose first entries are `apart` entries
    /// apart.
    pub fn add_columns<'a, S>(simd, factor: f64, columns: &'a [f64], apart: usize, x: &'a [f64], out: &'a mut [f64]) {
        let lanes = S::F64_LANES;
        let (mut at, end) = (0, out.len());
        if columns.len() < end {
            return;
        }
        // A part of the target stays in registers for all columns.
        while end - at >= 8 * lanes {
            add_columns_to::<S, 8>(simd, factor, &columns[at..], apart, x, &mut out[at..]);
            at += 8 * lanes;
        }
        while end - at >= 2 * lanes {
            add_columns_to::<S, 2>(simd, factor, &columns[at..], apart, x, &mut out[at..]);
            at += 2 * lanes;
        }
        if end - at >= lanes {
            add_columns_to::<S, 1>(simd, factor, &columns[at..], apart, x, &mut out[at..]);
            at += lanes;
        }
        if at == end {
            return;
        }
        if end < lanes {
            for (column, x) in columns.chunks(apart).zip(x) {
                out.iter_mut().zip(column).for_each(|(out, a)| *out += factor * x * a);
            }
            return;
        }
        // The last register overlaps what is done: only its end is added.
        let mut last = [0.0; WIDEST];
        add_columns_to::<S, 1>(simd, factor, &columns[end - lanes..], apart, x, &mut last[..lanes]);
        for (out, last) in out[at..].iter_mut().zip(&last[lanes - (end - at)..lanes]) {
            *out += last;
        }
    }
}

/// Numbers in the widest registers.
const WIDEST: usize = 16;

/// [`add_columns`] for the first `B` registers of `out`.
#[inline(always)]
fn add_columns_to<S: pulp::Simd, const B: usize>(
    simd: S,
    factor: f64,
    columns: &[f64],
    apart: usize,
    x: &[f64],
    out: &mut [f64],
) {
    let length = B * S::F64_LANES;
    let out = &mut S::as_mut_simd_f64s(&mut out[..length]).0[..B];
    let mut sums: [S::f64s; B] = std::array::from_fn(|b| out[b]);
    for (j, x) in x.iter().enumerate() {
        let column = &S::as_simd_f64s(&columns[j * apart..][..length]).0[..B];
        let weight = simd.splat_f64s(factor * x);
        for b in 0..B {
            sums[b] = simd.mul_add_e_f64s(weight, column[b], sums[b]);
        }
    }
    out.copy_from_slice(&sums);
}

/// Effect of a product on its target.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Update {
    /// It takes its place.
    Replace,
    /// It is added.
    Add,
}

/// Rows of the factors that are multiplied at a time.
const TILE: [usize; 2] = [2, 4];

vectorised! {
    /// The product `A Bᵀ` of two matrices with rows of `width` numbers, a multiple of four; `target` starts with its
    /// first entry and has rows that are `stride` apart.
    ///
    /// Not by a library: those at hand keep buffers of the thread, which hold a shared library in memory, or need
    /// columns.
    pub fn multiply_transposed<'a, S>(
        simd,
        a: &'a [f64],
        b: &'a [f64],
        width: usize,
        target: &'a mut [f64],
        stride: usize,
        update: Update,
    ) {
        let (a, b, k) = (S::as_simd_f64s(a).0, S::as_simd_f64s(b).0, width / S::F64_LANES);
        for (i, a) in a.chunks(TILE[0] * k).enumerate() {
            for (j, b) in b.chunks(TILE[1] * k).enumerate() {
                let (rows, columns) = (a.len() / k, b.len() / k);
                let mut sums = [[simd.splat_f64s(0.0); TILE[1]]; TILE[0]];
                if rows == TILE[0] && columns == TILE[1] {
                    let (a, b) = (parts::<_, { TILE[0] }>(a, k), parts::<_, { TILE[1] }>(b, k));
                    for q in 0..k {
                        for (sums, a) in sums.iter_mut().zip(a) {
                            for (sum, b) in sums.iter_mut().zip(b) {
                                *sum = simd.mul_add_e_f64s(a[q], b[q], *sum);
                            }
                        }
                    }
                } else {
                    for (sums, a) in sums.iter_mut().zip(a.chunks_exact(k)) {
                        for (sum, b) in sums.iter_mut().zip(b.chunks_exact(k)) {
                            for (&a, &b) in a.iter().zip(b) {
                                *sum = simd.mul_add_e_f64s(a, b, *sum);
                            }
                        }
                    }
                }
                for (row, sums) in sums[..rows].iter().enumerate() {
                    let target = &mut target[(i * TILE[0] + row) * stride + j * TILE[1]..][..columns];
                    for (target, &sum) in target.iter_mut().zip(sums) {
                        let product = simd.reduce_sum_f64s(sum);
                        *target = if update == Update::Add { *target + product } else { product };
                    }
                }
            }
        }
    }
}

/// Rows of `k` entries each.
#[inline(always)]
fn parts<T, const N: usize>(rows: &[T], k: usize) -> [&[T]; N] {
    std::array::from_fn(|i| &rows[i * k..][..k])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_land_in_their_block() {
        let number = |i: usize, j: usize| ((7 * i + 3 * j) % 11) as f64 - 4.0;
        for (rows, columns, width) in [(3, 2, 4), (5, 9, 8), (7, 4, 28)] {
            let matrix = |rows: usize, shift: usize| -> Vec<f64> {
                (0..rows).flat_map(|i| (0..width).map(move |j| number(i + shift, j))).collect()
            };
            let (a, b, stride) = (matrix(rows, 0), matrix(columns, 2), columns + 3);
            let exact = |i: usize, j: usize| (0..width).map(|q| number(i, q) * number(j + 2, q)).sum::<f64>();
            let mut target = vec![0.5; rows * stride];
            for (update, times) in [(Update::Replace, 1.0), (Update::Add, 2.0)] {
                multiply_transposed(&a, &b, width, &mut target[1..], stride, update);
                for (at, value) in target.iter().enumerate() {
                    let (i, j) = (at / stride, at % stride);
                    let inside = (1..=columns).contains(&j);
                    assert_eq!(*value, if inside { times * exact(i, j - 1) } else { 0.5 }, "{i}, {j}");
                }
            }
        }
    }

    #[test]
    fn columns_of_any_number_and_length_are_added() {
        for (length, count) in [(0, 3), (1, 1), (3, 4), (8, 6), (17, 9)] {
            let number = |i: usize, j: usize| ((5 * i + 3 * j) % 13) as f64 - 6.0;
            for every in [1, 2] {
                let matrix: Vec<f64> =
                    (0..count * every).flat_map(|j| (0..length).map(move |i| number(i, j))).collect();
                let x: Vec<f64> = (0..count).map(|j| j as f64 - 2.0).collect();
                let mut out: Vec<f64> = (0..length).map(|i| i as f64).collect();
                add_columns(-2.0, &matrix, every * length, &x, &mut out);
                for (i, out) in out.iter().enumerate() {
                    assert_eq!(*out, i as f64 - 2.0 * (0..count).map(|j| number(i, every * j) * x[j]).sum::<f64>());
                }
            }
        }
    }

    #[test]
    fn scalar_products_of_any_length_are_exact() {
        for length in [0, 1, 4, 15, 16, 33] {
            let [a, b]: [Vec<f64>; 2] = [2.0, 3.0].map(|step| (0..length).map(|i| step * f64::from(i) - 5.0).collect());
            assert_eq!(dot(&a, &b), a.iter().zip(&b).map(|(a, b)| a * b).sum::<f64>());
        }
    }
}
