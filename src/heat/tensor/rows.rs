//! Loops over the rows of fields, where a row holds the modes at one node along the surface.
//!
//! They take most of the time of a step of heat, and are written for the vector registers of the machine that runs them. Results
//! are the same on every machine but for the order of sums: products and sums are rounded one by one.

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
                *x = simd.sub_f64s(*x, simd.mul_f64s(link, before));
            }
        }
    }
}

vectorised! {
    /// `xᵢ ← dᵢ xᵢ − lᵢ xᵢ₊₁` from the last row to the first.
    fn substitute<'a, S>(simd, d: &'a [f64], links: &'a [f64], x: &'a mut [f64], width: usize) {
        let (d, links) = (S::as_simd_f64s(d).0, S::as_simd_f64s(links).0);
        let (x, k) = (S::as_mut_simd_f64s(x).0, width / S::F64_LANES);
        let last = x.len() - k;
        for (x, &d) in x[last..].iter_mut().zip(&d[last..]) {
            *x = simd.mul_f64s(*x, d);
        }
        let rows = d[..last].chunks_exact(k).zip(links[..last].chunks_exact(k));
        for (i, (d, link)) in rows.enumerate().rev() {
            let (done, rest) = x.split_at_mut((i + 1) * k);
            for (((x, &d), &link), &next) in done[i * k..].iter_mut().zip(d).zip(link).zip(&*rest) {
                *x = simd.sub_f64s(simd.mul_f64s(*x, d), simd.mul_f64s(link, next));
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
                *x = simd.sub_f64s(*x, simd.mul_f64s(y, factor));
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
            *x = simd.add_f64s(*x, simd.mul_f64s(many, y));
        }
        x_rest.iter_mut().zip(y_rest).for_each(|(x, y)| *x += factor * y);
    }
}

vectorised! {
    /// Rows of `shape`, each times its factor.
    fn multiples<'a, S>(simd, factors: &'a [f64], shape: &'a [f64], out: &'a mut [f64]) {
        let (shape, out) = (S::as_simd_f64s(shape).0, S::as_mut_simd_f64s(out).0);
        for (out, &factor) in out.chunks_exact_mut(shape.len()).zip(factors) {
            let factor = simd.splat_f64s(factor);
            out.iter_mut().zip(shape).for_each(|(out, &shape)| *out = simd.mul_f64s(factor, shape));
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
                *sum = simd.add_f64s(*sum, simd.mul_f64s(weight, x));
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
                sums = simd.add_f64s(sums, simd.mul_f64s(x, shape));
            }
            *out = simd.reduce_sum_f64s(sums);
        }
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
                let alpha = simd.add_f64s(storage, simd.mul_f64s(conduction, value));
                let held = simd.add_f64s(simd.mul_f64s(mass[0], a), simd.mul_f64s(mass[1], b));
                let held = simd.mul_f64s(alpha, simd.add_f64s(held, simd.mul_f64s(mass[2], c)));
                let from = simd.mul_f64s(carried[0], simd.sub_f64s(a, b));
                let to = simd.mul_f64s(carried[1], simd.sub_f64s(c, b));
                let moved = simd.add_f64s(simd.add_f64s(from, to), simd.mul_f64s(carried[2], b));
                let product = simd.add_f64s(held, moved);
                *out = if update == Update::Add { simd.add_f64s(*out, product) } else { product };
            }
        }
    }
}

vectorised! {
    /// Factors `wᵢ`, `rᵢ` and `1/dᵢ` of all rows of `α M̃ + β F`, α given mode by mode; `excess` is a buffer of one row.
    ///
    /// Elimination in terms of row sums e (Grassmann, Taksar & Heyman, *Oper. Res.* 33 (1985)): nothing cancels in a fast
    /// stream, `eᵢ = sᵢ − Lᵢ eᵢ₋₁/dᵢ₋₁`, `dᵢ = eᵢ − Uᵢ` with the row sums s, of the mass alone.
    fn factorise<'a, S>(
        simd,
        line: &'a Transport,
        alpha: &'a [f64],
        flow: f64,
        factors: [&'a mut [f64]; 3],
        excess: &'a mut [f64],
    ) {
        let (alpha, excess, k) = (S::as_simd_f64s(alpha).0, S::as_mut_simd_f64s(excess).0, alpha.len() / S::F64_LANES);
        let [w, r, inverse] = factors.map(|factors| S::as_mut_simd_f64s(factors).0);
        let one = simd.splat_f64s(1.0);
        for i in 0..inverse.len() / k {
            let (lower, upper) = (line.mass_lower[i], line.mass_upper[i]);
            let sum = simd.splat_f64s(lower + line.mass[i] + upper);
            let [lower, upper] = [lower, upper].map(|m| simd.splat_f64s(m));
            let [to_lower, to_upper] = [line.flow_lower[i], line.flow_upper[i]].map(|f| simd.splat_f64s(flow * f));
            let entry = simd.splat_f64s(flow * line.entry(i));
            let (done, rest) = inverse.split_at_mut(i * k);
            let target = w[i * k..].iter_mut().zip(&mut r[i * k..]).zip(rest).zip(excess.iter_mut());
            for (q, ((((w, r), inverse), excess), &alpha)) in target.zip(alpha).enumerate() {
                let below = simd.add_f64s(simd.mul_f64s(alpha, lower), to_lower);
                let left = if i > 0 {
                    *w = simd.mul_f64s(below, done[(i - 1) * k + q]);
                    simd.mul_f64s(*w, *excess)
                } else {
                    *w = simd.splat_f64s(0.0);
                    below
                };
                *excess = simd.sub_f64s(simd.add_f64s(simd.mul_f64s(alpha, sum), entry), left);
                let above = simd.add_f64s(simd.mul_f64s(alpha, upper), to_upper);
                *inverse = simd.div_f64s(one, simd.sub_f64s(*excess, above));
                *r = simd.mul_f64s(above, *inverse);
            }
        }
    }
}

vectorised! {
    /// How an influence decays on the way to the node after the last row, `xᵢ = −lᵢ xᵢ₊₁` with 1 there.
    fn decay_towards<'a, S>(simd, links: &'a [f64], x: &'a mut [f64], width: usize) {
        let (links, x, k) = (S::as_simd_f64s(links).0, S::as_mut_simd_f64s(x).0, width / S::F64_LANES);
        for i in (0..x.len() / k).rev() {
            let (done, rest) = x.split_at_mut((i + 1) * k);
            for (q, (x, &link)) in done[i * k..].iter_mut().zip(&links[i * k..]).enumerate() {
                let next = rest.get(q).copied().unwrap_or(simd.splat_f64s(1.0));
                *x = decayed(simd, link, next);
            }
        }
    }
}

vectorised! {
    /// How an influence decays on the way from the node of the first row, `mᵢ = −lᵢ₋₁ mᵢ₋₁` with 1 there, times the row of
    /// `scales`. `moving` is a buffer of one row.
    fn decay_from<'a, S>(simd, links: &'a [f64], scales: &'a [f64], x: &'a mut [f64], moving: &'a mut [f64]) {
        let (links, scales) = (S::as_simd_f64s(links).0, S::as_simd_f64s(scales).0);
        let (x, moving) = (S::as_mut_simd_f64s(x).0, S::as_mut_simd_f64s(moving).0);
        let k = moving.len();
        moving.fill(simd.splat_f64s(1.0));
        for (i, (x, scales)) in x.chunks_exact_mut(k).zip(scales.chunks_exact(k)).enumerate() {
            if i > 0 {
                for (moving, &link) in moving.iter_mut().zip(&links[(i - 1) * k..]) {
                    *moving = decayed(simd, link, *moving);
                }
            }
            for ((x, &scale), &moving) in x.iter_mut().zip(scales).zip(&*moving) {
                *x = simd.mul_f64s(scale, moving);
            }
        }
    }
}

vectorised! {
    /// Sums of the rows of `scales`, and of these times the decay on the way back to every row before them: those of row `k` at
    /// `j ≤ k` go to `k · strides[0] + j · strides[1]` in `out`. `moving` is a buffer of one row.
    fn decay_pairs<'a, S>(
        simd,
        links: &'a [f64],
        scales: &'a [f64],
        moving: &'a mut [f64],
        strides: [usize; 2],
        out: &'a mut [f64],
    ) {
        let (links, scales) = (S::as_simd_f64s(links).0, S::as_simd_f64s(scales).0);
        let moving = S::as_mut_simd_f64s(moving).0;
        let width = moving.len();
        for (k, scales) in scales.chunks_exact(width).enumerate() {
            moving.copy_from_slice(scales);
            let sum = moving.iter().fold(simd.splat_f64s(0.0), |sum, &x| simd.add_f64s(sum, x));
            out[k * (strides[0] + strides[1])] = simd.reduce_sum_f64s(sum);
            for j in (0..k).rev() {
                let mut sum = simd.splat_f64s(0.0);
                for (moving, &link) in moving.iter_mut().zip(&links[j * width..]) {
                    *moving = decayed(simd, link, *moving);
                    sum = simd.add_f64s(sum, *moving);
                }
                out[k * strides[0] + j * strides[1]] = simd.reduce_sum_f64s(sum);
            }
        }
    }
}

/// `−link · x`, or zero where hardly anything is left: the smallest numbers are slow.
#[inline(always)]
fn decayed<S: Simd>(simd: S, link: S::f64s, x: S::f64s) -> S::f64s {
    let value = simd.neg_f64s(simd.mul_f64s(link, x));
    let small = simd.less_than_f64s(simd.abs_f64s(value), simd.splat_f64s(NOTHING));
    simd.select_f64s(small, simd.splat_f64s(0.0), value)
}

/// Influence below which nothing is left.
const NOTHING: f64 = 1e-60;
