//! Recurrences along the streamlines in which an influence decays from node to node.

use crate::linalg::vectorised::vectorised;
use pulp::Simd;

vectorised! {
    /// Decay of an influence on the way to the node after the last row, `xᵢ = −lᵢ xᵢ₊₁` with 1 there. Returns the first
    /// row in which something is left; rows before that are not touched.
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
    /// Decay of an influence on the way from the node of the first row, `mᵢ = −lᵢ₋₁ mᵢ₋₁` with 1 there, times the row
    /// of `scales`. Returns the number of rows in which something is left; those after that are not touched. `moving`
    /// is a buffer of one row.
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
    /// Sums of the rows of `scales`, and of these times the decay on the way back to every row before them: those of
    /// row `k` at `j ≤ k` go to `k · strides[0] + j · strides[1]` in `out`, where nothing is left of them it stays as
    /// it is. `moving` is a buffer of one row.
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
pub fn less<S: Simd>(simd: S, x: S::f64s, link: S::f64s, y: S::f64s) -> S::f64s {
    simd.mul_add_e_f64s(simd.neg_f64s(link), y, x)
}

/// `−link · x`, or zero where hardly anything is left: the smallest numbers are slow, and zeros are left out.
#[inline(always)]
fn decayed<S: Simd>(simd: S, link: S::f64s, x: S::f64s) -> S::f64s {
    faded(simd, simd.neg_f64s(simd.mul_f64s(link, x)))
}

/// `x`, or zero where hardly anything is left.
#[inline(always)]
pub fn faded<S: Simd>(simd: S, x: S::f64s) -> S::f64s {
    let small = simd.less_than_f64s(simd.abs_f64s(x), simd.splat_f64s(NEGLIGIBLE_INFLUENCE));
    simd.select_f64s(small, simd.splat_f64s(0.0), x)
}

/// Influence of one node on another below which nothing is left.
const NEGLIGIBLE_INFLUENCE: f64 = 1e-20;
