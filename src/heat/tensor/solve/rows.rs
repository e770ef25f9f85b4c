//! Elimination, substitution and matrix products over the rows of fields, where a row holds the modes at one node along
//! the surface; see [`kernels`](crate::heat::tensor::mesh::kernels).

use super::decay::less;
use super::transport::Transport;
use crate::linalg::Update;
use crate::linalg::vectorised::{BLOCK, by_blocks, load, vectorised};
use pulp::Simd;

vectorised! {
    /// `xᵢ ← xᵢ − lᵢ xᵢ₋₁` from the second row of `x` on, to which the first row of `links` belongs; rows have `width`
    /// numbers.
    fn eliminate<'a, S>(simd, links: &'a [f64], x: &'a mut [f64], width: usize) {
        let (links, x, k) = (S::as_simd_f64s(links).0, S::as_mut_simd_f64s(x).0, width / S::F64_LANES);
        by_blocks!(k, eliminate_block::<S>(simd, links, x, k));
    }
}

/// The registers from `at` on of [`eliminate`].
#[inline(always)]
fn eliminate_block<S: Simd, const B: usize>(simd: S, links: &[S::f64s], x: &mut [S::f64s], k: usize, at: usize) {
    if links.is_empty() {
        return;
    }
    let mut moving: [_; B] = load(x, at);
    for first in (at..links.len()).step_by(k) {
        let (link, now): ([_; B], [_; B]) = (load(links, first), load(x, first + k));
        for q in 0..B {
            moving[q] = less(simd, now[q], link[q], moving[q]);
        }
        x[first + k..first + k + B].copy_from_slice(&moving);
    }
}

vectorised! {
    /// `xᵢ ← dᵢ xᵢ − lᵢ xᵢ₊₁` from the last row, which the row `next` follows, to the first.
    fn substitute<'a, S>(simd, d: &'a [f64], links: &'a [f64], x: &'a mut [f64], next: &'a [f64]) {
        let (d, links) = (S::as_simd_f64s(d).0, S::as_simd_f64s(links).0);
        let (x, next) = (S::as_mut_simd_f64s(x).0, S::as_simd_f64s(next).0);
        by_blocks!(next.len(), substitute_block::<S>(simd, [d, links], x, next));
    }
}

/// The registers from `at` on of [`substitute`].
#[inline(always)]
fn substitute_block<S: Simd, const B: usize>(
    simd: S,
    [d, links]: [&[S::f64s]; 2],
    x: &mut [S::f64s],
    next: &[S::f64s],
    at: usize,
) {
    let mut moving: [_; B] = load(next, at);
    for first in (at..x.len()).step_by(next.len()).rev() {
        let (now, d, link): ([_; B], [_; B], [_; B]) = (load(x, first), load(d, first), load(links, first));
        for q in 0..B {
            moving[q] = less(simd, simd.mul_f64s(now[q], d[q]), link[q], moving[q]);
        }
        x[first..first + B].copy_from_slice(&moving);
    }
}

vectorised! {
    /// Surface values of `xᵢ ← dᵢ (xᵢ − cᵢ xₙ) − lᵢ xᵢ₊₁` from the last row `n`, which is `dₙ xₙ`, to the first; the
    /// column c may be empty, or end two rows before the last. `moving` is a buffer of two rows.
    fn substituted_surface<'a, S>(
        simd,
        factors: [&'a [f64]; 3],
        x: &'a [f64],
        moving: &'a mut [f64],
        surface: &'a [f64],
        out: &'a mut [f64],
    ) {
        let [d, links, column] = factors.map(|factors| S::as_simd_f64s(factors).0);
        let (x, surface) = (S::as_simd_f64s(x).0, S::as_simd_f64s(surface).0);
        let k = surface.len();
        let (now, last) = S::as_mut_simd_f64s(moving).0.split_at_mut(k);
        now.fill(simd.splat_f64s(0.0));
        for (i, out) in out.iter_mut().enumerate().rev() {
            let row = i * k..(i + 1) * k;
            let given = x[row.clone()].iter().zip(&d[row.clone()]).zip(&links[row.clone()]);
            let mut sums = simd.splat_f64s(0.0);
            if row.end <= column.len() {
                for ((((now, &surface), ((&x, &d), &link)), &c), &last) in
                    now.iter_mut().zip(surface).zip(given).zip(&column[row.clone()]).zip(&*last)
                {
                    *now = less(simd, simd.mul_f64s(less(simd, x, c, last), d), link, *now);
                    sums = simd.mul_add_e_f64s(*now, surface, sums);
                }
            } else {
                for ((now, &surface), ((&x, &d), &link)) in now.iter_mut().zip(surface).zip(given) {
                    *now = less(simd, simd.mul_f64s(x, d), link, *now);
                    sums = simd.mul_add_e_f64s(*now, surface, sums);
                }
            }
            if row.end == x.len() {
                last.copy_from_slice(now);
            }
            *out = simd.reduce_sum_f64s(sums);
        }
    }
}

vectorised! {
    /// Adds the rows `shape · load` to `x`, after their elimination by the links and the row of the last node, which
    /// may be empty or end two rows before it.
    fn add_eliminated<'a, S>(
        simd,
        factors: [&'a [f64]; 2],
        loads: &'a [f64],
        shape: &'a [f64],
        x: &'a mut [f64],
    ) {
        let ([links, fill], shape) = (factors.map(|factors| S::as_simd_f64s(factors).0), S::as_simd_f64s(shape).0);
        let x = S::as_mut_simd_f64s(x).0;
        by_blocks!(shape.len(), add_eliminated_block::<S>(simd, [links, fill], loads, shape, x));
    }
}

/// The registers from `at` on of [`add_eliminated`].
#[inline(always)]
fn add_eliminated_block<S: Simd, const B: usize>(
    simd: S,
    [links, fill]: [&[S::f64s]; 2],
    loads: &[f64],
    shape: &[S::f64s],
    x: &mut [S::f64s],
    at: usize,
) {
    let shapes: [_; B] = load(shape, at);
    let [mut moving, mut last] = [[simd.splat_f64s(0.0); B]; 2];
    for (first, &amount) in (at..x.len()).step_by(shape.len()).zip(loads) {
        let (link, amount): ([_; B], _) = (load(links, first), simd.splat_f64s(amount));
        for q in 0..B {
            moving[q] = less(simd, simd.mul_f64s(amount, shapes[q]), link[q], moving[q]);
        }
        let x = &mut x[first..first + B];
        for q in 0..B {
            x[q] = simd.add_f64s(x[q], moving[q]);
        }
        if first - at + shape.len() <= fill.len() {
            let fill: [_; B] = load(fill, first);
            for q in 0..B {
                last[q] = less(simd, last[q], fill[q], moving[q]);
            }
        }
    }
    let end = x.len() - shape.len() + at;
    let x = &mut x[end..end + B];
    for q in 0..B {
        x[q] = simd.add_f64s(x[q], last[q]);
    }
}

vectorised! {
    /// `sum ← sum − Σ yᵢ xᵢ` over all rows of `y`, entry by entry.
    fn subtract_products<'a, S>(simd, y: &'a [f64], x: &'a [f64], sum: &'a mut [f64]) {
        let (y, x, sum) = (S::as_simd_f64s(y).0, S::as_simd_f64s(x).0, S::as_mut_simd_f64s(sum).0);
        for (y, x) in y.chunks_exact(sum.len()).zip(x.chunks_exact(sum.len())) {
            for ((sum, &y), &x) in sum.iter_mut().zip(y).zip(x) {
                *sum = less(simd, *sum, y, x);
            }
        }
    }
}

vectorised! {
    /// `xᵢ ← xᵢ − yᵢ factor` in every row, entry by entry.
    fn subtract<'a, S>(simd, y: &'a [f64], factor: &'a [f64], x: &'a mut [f64]) {
        let (y, factor, x) = (S::as_simd_f64s(y).0, S::as_simd_f64s(factor).0, S::as_mut_simd_f64s(x).0);
        for (x, y) in x.chunks_exact_mut(factor.len()).zip(y.chunks_exact(factor.len())) {
            for ((x, &y), &factor) in x.iter_mut().zip(y).zip(factor) {
                *x = less(simd, *x, y, factor);
            }
        }
    }
}

vectorised! {
    /// Adds `factor` times the product of a row vector `g` with the matrix of three bands (lower, diagonal, upper) to
    /// `row`.
    fn add_banded<'a, S>(simd, factor: f64, g: &'a [f64], bands: [&'a [f64]; 3], row: &'a mut [f64]) {
        let _ = simd;
        let (n, [lower, diagonal, upper]) = (row.len(), bands.map(|band| &band[..row.len()]));
        let g = &g[..n];
        for (row, (c, g)) in row.iter_mut().zip(diagonal.iter().zip(g)) {
            *row += factor * c * g;
        }
        for (row, (c, g)) in row[1..].iter_mut().zip(upper.iter().zip(g)) {
            *row += factor * c * g;
        }
        for (row, (c, g)) in row.iter_mut().zip(lower[1..].iter().zip(&g[1..])) {
            *row += factor * c * g;
        }
    }
}

vectorised! {
    /// `(α M̃ + β F) x` for the rows of a body, with `α = a + b λ` of the modes' `values` λ, but for the entry of the
    /// stream; it replaces `out` or is added to it. Ends of an open streamline have no outer neighbour; the entries
    /// there are zero.
    fn tridiagonal_product<'a, S>(
        simd,
        line: &'a Transport,
        values: &'a [f64],
        weights: [f64; 3],
        x: &'a [f64],
        out: &'a mut [f64],
        update: Update,
    ) {
        let (values, x, out) = (S::as_simd_f64s(values).0, S::as_simd_f64s(x).0, S::as_mut_simd_f64s(out).0);
        let ([storage, conduction, flow], n, k) = (weights, line.mass.len(), values.len());
        let [storage, conduction] = [storage, conduction].map(|weight| simd.splat_f64s(weight));
        let row = |i: usize| &x[i * k..(i + 1) * k];
        for (i, out) in out.chunks_exact_mut(k).enumerate() {
            let (before, after) = (if i == 0 { n - 1 } else { i - 1 }, if i + 1 == n { 0 } else { i + 1 });
            let mass = [line.mass_lower[i], line.mass[i], line.mass_upper[i]].map(|m| simd.splat_f64s(m));
            let carried = [line.flow_lower[i], line.flow_upper[i]].map(|f| simd.splat_f64s(flow * f));
            let neighbours = row(before).iter().zip(row(i)).zip(row(after));
            for ((out, &value), ((&a, &b), &c)) in out.iter_mut().zip(values).zip(neighbours) {
                let alpha = simd.mul_add_e_f64s(conduction, value, storage);
                let held = simd.mul_add_e_f64s(mass[0], a, simd.mul_f64s(mass[1], b));
                let held = simd.mul_add_e_f64s(mass[2], c, held);
                let from = simd.mul_f64s(carried[0], simd.sub_f64s(a, b));
                let moved = simd.mul_add_e_f64s(carried[1], simd.sub_f64s(c, b), from);
                let product = simd.mul_add_e_f64s(alpha, held, moved);
                *out = match update {
                    Update::Add => simd.add_f64s(*out, product),
                    Update::Replace => product,
                };
            }
        }
    }
}
