//! Loops over the rows of fields, where a row holds the modes at one node along the surface.
//!
//! They take most of the time of a step of heat, and are written for the vector registers of the machine that runs them. Results
//! of different machines differ by round-off: by the order of sums, and where a product and a sum are rounded at once.

use super::streamline::Transport;
use crate::linalg::Update;
use crate::linalg::vectorised::vectorised;
use pulp::Simd;

vectorised! {
    /// `xᵢ ← xᵢ − lᵢ xᵢ₋₁` from the second row of `x` on, to which the first row of `links` belongs; rows have `width` numbers.
    fn eliminate<'a, S>(simd, links: &'a [f64], x: &'a mut [f64], width: usize) {
        let (links, x, k) = (S::as_simd_f64s(links).0, S::as_mut_simd_f64s(x).0, width / S::F64_LANES);
        for (i, link) in links.chunks_exact(k).enumerate() {
            let (done, rest) = x.split_at_mut((i + 1) * k);
            for ((x, &before), &link) in rest.iter_mut().zip(&done[i * k..]).zip(link) {
                *x = less(simd, *x, link, before);
            }
        }
    }
}

vectorised! {
    /// `xᵢ ← dᵢ xᵢ − lᵢ xᵢ₊₁` from the last row, which the row `next` follows, to the first.
    fn substitute<'a, S>(simd, d: &'a [f64], links: &'a [f64], x: &'a mut [f64], next: &'a [f64]) {
        let (d, links) = (S::as_simd_f64s(d).0, S::as_simd_f64s(links).0);
        let (x, next) = (S::as_mut_simd_f64s(x).0, S::as_simd_f64s(next).0);
        let k = next.len();
        let rows = d.chunks_exact(k).zip(links.chunks_exact(k)).take(x.len() / k);
        for (i, (d, link)) in rows.enumerate().rev() {
            let (done, rest) = x.split_at_mut((i + 1) * k);
            let next = if rest.is_empty() { next } else { &rest[..k] };
            for (((x, &d), &link), &next) in done[i * k..].iter_mut().zip(d).zip(link).zip(next) {
                *x = less(simd, simd.mul_f64s(*x, d), link, next);
            }
        }
    }
}

vectorised! {
    /// Surface values of `xᵢ ← dᵢ (xᵢ − cᵢ xₙ) − lᵢ xᵢ₊₁` from the last row `n`, which is `dₙ xₙ`, to the first; the column c may be
    /// empty, or end two rows before the last. `moving` is a buffer of two rows.
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
    /// Adds the rows `shape · load` to `x`, after their elimination by the links and the row of the last node, which may be empty
    /// or end two rows before it. `moving` is a buffer of two rows.
    fn add_eliminated<'a, S>(
        simd,
        factors: [&'a [f64]; 2],
        load: &'a [f64],
        shape: &'a [f64],
        x: &'a mut [f64],
        moving: &'a mut [f64],
    ) {
        let ([links, fill], shape) = (factors.map(|factors| S::as_simd_f64s(factors).0), S::as_simd_f64s(shape).0);
        let (x, k) = (S::as_mut_simd_f64s(x).0, shape.len());
        let (now, last) = S::as_mut_simd_f64s(moving).0.split_at_mut(k);
        now.fill(simd.splat_f64s(0.0));
        last.fill(simd.splat_f64s(0.0));
        for (i, &load) in load.iter().enumerate() {
            let (row, load) = (i * k..(i + 1) * k, simd.splat_f64s(load));
            for (((now, x), &shape), &link) in
                now.iter_mut().zip(&mut x[row.clone()]).zip(shape).zip(&links[row.clone()])
            {
                *now = less(simd, simd.mul_f64s(load, shape), link, *now);
                *x = simd.add_f64s(*x, *now);
            }
            if row.end <= fill.len() {
                for ((last, &now), &fill) in last.iter_mut().zip(&*now).zip(&fill[row]) {
                    *last = less(simd, *last, fill, now);
                }
            }
        }
        let end = x.len() - k;
        x[end..].iter_mut().zip(last).for_each(|(x, &mut last)| *x = simd.add_f64s(*x, last));
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
    /// `x ← x + factor · y`.
    fn add<'a, S>(simd, factor: f64, y: &'a [f64], x: &'a mut [f64]) {
        let ((y, y_rest), (x, x_rest)) = (S::as_simd_f64s(y), S::as_mut_simd_f64s(x));
        let many = simd.splat_f64s(factor);
        for (x, &y) in x.iter_mut().zip(y) {
            *x = simd.mul_add_e_f64s(many, y, *x);
        }
        x_rest.iter_mut().zip(y_rest).for_each(|(x, y)| *x += factor * y);
    }
}

vectorised! {
    /// `out ← x + factor · y`.
    fn sum<'a, S>(simd, x: &'a [f64], factor: f64, y: &'a [f64], out: &'a mut [f64]) {
        let (x, x_rest) = S::as_simd_f64s(x);
        let ((y, y_rest), (out, out_rest)) = (S::as_simd_f64s(y), S::as_mut_simd_f64s(out));
        let many = simd.splat_f64s(factor);
        for ((out, &x), &y) in out.iter_mut().zip(x).zip(y) {
            *out = simd.mul_add_e_f64s(many, y, x);
        }
        out_rest.iter_mut().zip(x_rest.iter().zip(y_rest)).for_each(|(out, (x, y))| *out = x + factor * y);
    }
}

vectorised! {
    /// Adds `factor` times the product of a row vector `g` with the matrix of three bands (lower, diagonal, upper) to `row`.
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
    /// Adds all rows of `x`, each times its weight, to `sums`.
    fn add_weighted<'a, S>(simd, weights: &'a [f64], x: &'a [f64], sums: &'a mut [f64]) {
        let (x, sums) = (S::as_simd_f64s(x).0, S::as_mut_simd_f64s(sums).0);
        for (x, &weight) in x.chunks_exact(sums.len()).zip(weights) {
            let weight = simd.splat_f64s(weight);
            for (sum, &x) in sums.iter_mut().zip(x) {
                *sum = simd.mul_add_e_f64s(weight, x, *sum);
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
    /// `Σ |bₘ − aₘ| weightₘ`.
    fn weighted_change<'a, S>(simd, a: &'a [f64], b: &'a [f64], weights: &'a [f64]) -> f64 {
        let (a, b, weights) = (S::as_simd_f64s(a).0, S::as_simd_f64s(b).0, S::as_simd_f64s(weights).0);
        let sum = a.iter().zip(b).zip(weights).fold(simd.splat_f64s(0.0), |sum, ((&a, &b), &weight)| {
            simd.mul_add_e_f64s(simd.abs_f64s(simd.sub_f64s(b, a)), weight, sum)
        });
        simd.reduce_sum_f64s(sum)
    }
}

vectorised! {
    /// `(α M̃ + β F) x` for the rows of a body, with `α = a + b λ` of the modes' `values` λ; it replaces `out` or is added to it.
    /// Ends of an open streamline have no outer neighbour; the entries there are zero.
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
            let carried = [line.flow_lower[i], line.flow_upper[i], line.entry(i)].map(|f| simd.splat_f64s(flow * f));
            let neighbours = row(before).iter().zip(row(i)).zip(row(after));
            for ((out, &value), ((&a, &b), &c)) in out.iter_mut().zip(values).zip(neighbours) {
                let alpha = simd.mul_add_e_f64s(conduction, value, storage);
                let held = simd.mul_add_e_f64s(mass[0], a, simd.mul_f64s(mass[1], b));
                let held = simd.mul_add_e_f64s(mass[2], c, held);
                let from = simd.mul_f64s(carried[0], simd.sub_f64s(a, b));
                let moved = simd.mul_add_e_f64s(carried[1], simd.sub_f64s(c, b), from);
                let moved = simd.mul_add_e_f64s(carried[2], b, moved);
                let product = simd.mul_add_e_f64s(alpha, held, moved);
                *out = if update == Update::Add { simd.add_f64s(*out, product) } else { product };
            }
        }
    }
}

vectorised! {
    /// How an influence decays on the way to the node after the last row, `xᵢ = −lᵢ xᵢ₊₁` with 1 there; the first row in which
    /// something is left. Rows before that are not touched.
    fn decay_towards<'a, S>(simd, links: &'a [f64], x: &'a mut [f64], width: usize) -> usize {
        let (links, x, k) = (S::as_simd_f64s(links).0, S::as_mut_simd_f64s(x).0, width / S::F64_LANES);
        for i in (0..x.len() / k).rev() {
            let (done, rest) = x.split_at_mut((i + 1) * k);
            let mut left = simd.splat_f64s(0.0);
            for (q, (x, &link)) in done[i * k..].iter_mut().zip(&links[i * k..]).enumerate() {
                let next = rest.get(q).copied().unwrap_or(simd.splat_f64s(1.0));
                *x = decayed(simd, link, next);
                left = simd.add_f64s(left, simd.abs_f64s(*x));
            }
            if simd.reduce_sum_f64s(left) == 0.0 {
                return i + 1;
            }
        }
        0
    }
}

vectorised! {
    /// How an influence decays on the way from the node of the first row, `mᵢ = −lᵢ₋₁ mᵢ₋₁` with 1 there, times the row of
    /// `scales`; the number of rows in which something is left. Those after that are not touched. `moving` is a buffer of one row.
    fn decay_from<'a, S>(
        simd,
        links: &'a [f64],
        scales: &'a [f64],
        x: &'a mut [f64],
        moving: &'a mut [f64],
    ) -> usize {
        let (links, scales) = (S::as_simd_f64s(links).0, S::as_simd_f64s(scales).0);
        let (x, moving) = (S::as_mut_simd_f64s(x).0, S::as_mut_simd_f64s(moving).0);
        let k = moving.len();
        moving.fill(simd.splat_f64s(1.0));
        for (i, (x, scales)) in x.chunks_exact_mut(k).zip(scales.chunks_exact(k)).enumerate() {
            if i > 0 {
                let mut left = simd.splat_f64s(0.0);
                for (moving, &link) in moving.iter_mut().zip(&links[(i - 1) * k..]) {
                    *moving = decayed(simd, link, *moving);
                    left = simd.add_f64s(left, simd.abs_f64s(*moving));
                }
                if simd.reduce_sum_f64s(left) == 0.0 {
                    return i;
                }
            }
            for ((x, &scale), &moving) in x.iter_mut().zip(scales).zip(&*moving) {
                *x = simd.mul_f64s(scale, moving);
            }
        }
        x.len() / k
    }
}

vectorised! {
    /// Sums of the rows of `scales`, and of these times the decay on the way back to every row before them: those of row `k` at
    /// `j ≤ k` go to `k · strides[0] + j · strides[1]` in `out`, where nothing is left of them it stays as it is. `moving` is a
    /// buffer of one row.
    fn decay_pairs<'a, S>(
        simd,
        links: &'a [f64],
        scales: &'a [f64],
        moving: &'a mut [f64],
        strides: [usize; 2],
        out: &'a mut [f64],
    ) {
        let (links, scales) = (S::as_simd_f64s(links).0, S::as_simd_f64s(scales).0);
        let (moving, zero) = (S::as_mut_simd_f64s(moving).0, simd.splat_f64s(0.0));
        let width = moving.len();
        for (k, scales) in scales.chunks_exact(width).enumerate() {
            moving.fill(simd.splat_f64s(1.0));
            let sum = scales.iter().fold(zero, |sum, &x| simd.add_f64s(sum, x));
            out[k * (strides[0] + strides[1])] = simd.reduce_sum_f64s(sum);
            for j in (0..k).rev() {
                let (mut sum, mut left) = (zero, zero);
                for ((moving, &link), &scale) in moving.iter_mut().zip(&links[j * width..]).zip(scales) {
                    *moving = decayed(simd, link, *moving);
                    sum = simd.mul_add_e_f64s(*moving, scale, sum);
                    left = simd.add_f64s(left, simd.abs_f64s(*moving));
                }
                if simd.reduce_sum_f64s(left) == 0.0 {
                    break;
                }
                out[k * strides[0] + j * strides[1]] = simd.reduce_sum_f64s(sum);
            }
        }
    }
}

/// `x − link · y`.
#[inline(always)]
pub(super) fn less<S: Simd>(simd: S, x: S::f64s, link: S::f64s, y: S::f64s) -> S::f64s {
    simd.mul_add_e_f64s(simd.neg_f64s(link), y, x)
}

/// `−link · x`, or zero where hardly anything is left: the smallest numbers are slow, and zeros are left out.
#[inline(always)]
fn decayed<S: Simd>(simd: S, link: S::f64s, x: S::f64s) -> S::f64s {
    faded(simd, simd.neg_f64s(simd.mul_f64s(link, x)))
}

/// `x`, or zero where hardly anything is left.
#[inline(always)]
pub(super) fn faded<S: Simd>(simd: S, x: S::f64s) -> S::f64s {
    let small = simd.less_than_f64s(simd.abs_f64s(x), simd.splat_f64s(NOTHING));
    simd.select_f64s(small, simd.splat_f64s(0.0), x)
}

/// Influence of one node on another below which nothing is left.
const NOTHING: f64 = 1e-20;
