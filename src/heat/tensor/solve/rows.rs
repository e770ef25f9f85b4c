//! Elimination, substitution and matrix products over the rows of fields, where a row holds the modes at one node along
//! the surface; see [`kernels`](crate::heat::tensor::mesh::kernels).

use super::decay::less;
use super::transport::Transport;
use crate::linalg::Update;
use crate::linalg::vectorised::{BLOCK, by_blocks, load, vectorised};
use pulp::Simd;

/// A field and the sum of [`eliminate`].
type Summed<'a, V> = (&'a mut [V], &'a mut [V]);
/// A field and the known rows of [`substitute`].
type Followed<'a, V> = (&'a mut [V], [&'a [V]; 2]);

vectorised! {
    /// `xᵢ ← xᵢ − lᵢ xᵢ₋₁` in all `fields`, from the second row on, to which the first row of `links` belongs, and
    /// `sum ← sum − Σ fᵢ xᵢ` over the rows of `fill`, which begin with the first one; with every field comes its sum.
    /// Rows have `width` numbers.
    fn eliminate<'a, S, const L: usize>(
        simd,
        links: &'a [f64],
        fill: &'a [f64],
        fields: [(&'a mut [f64], &'a mut [f64]); L],
        width: usize,
    ) {
        let ([links, fill], k) = ([links, fill].map(|factor| S::as_simd_f64s(factor).0), width / S::F64_LANES);
        let mut fields = fields.map(|(x, sum)| (S::as_mut_simd_f64s(x).0, S::as_mut_simd_f64s(sum).0));
        if fields[0].0.is_empty() {
            return;
        }
        by_blocks!(k, eliminate_block::<S, L>(simd, [links, fill], &mut fields, k));
    }
}

/// The registers from `at` on of [`eliminate`].
#[inline(always)]
fn eliminate_block<S: Simd, const B: usize, const L: usize>(
    simd: S,
    [links, fill]: [&[S::f64s]; 2],
    fields: &mut [Summed<S::f64s>; L],
    k: usize,
    at: usize,
) {
    let [mut moving, mut sums] = [[[simd.splat_f64s(0.0); B]; L]; 2];
    for l in 0..L {
        moving[l] = load(fields[l].0, at);
    }
    let (top, fill) = fill.split_at(k.min(fill.len()));
    let mut first = at + k;
    let (filled, rest) = links.split_at(fill.len());
    if !top.is_empty() {
        let top: [_; B] = load(top, at);
        for l in 0..L {
            sums[l] = load(fields[l].1, at);
            for q in 0..B {
                sums[l][q] = less(simd, sums[l][q], top[q], moving[l][q]);
            }
        }
        for (link, fill) in filled.chunks_exact(k).zip(fill.chunks_exact(k)) {
            let (link, fill) = (&link[at..at + B], &fill[at..at + B]);
            for l in 0..L {
                let x = &mut fields[l].0[first..first + B];
                for q in 0..B {
                    moving[l][q] = less(simd, x[q], link[q], moving[l][q]);
                    sums[l][q] = less(simd, sums[l][q], fill[q], moving[l][q]);
                    x[q] = moving[l][q];
                }
            }
            first += k;
        }
        for l in 0..L {
            fields[l].1[at..at + B].copy_from_slice(&sums[l]);
        }
    }
    for link in rest.chunks_exact(k) {
        let link = &link[at..at + B];
        for l in 0..L {
            let x = &mut fields[l].0[first..first + B];
            for q in 0..B {
                moving[l][q] = less(simd, x[q], link[q], moving[l][q]);
                x[q] = moving[l][q];
            }
        }
        first += k;
    }
}

vectorised! {
    /// `xᵢ ← dᵢ (xᵢ − cᵢ y) − lᵢ xᵢ₊₁` in all `fields` from the last row to the first, with the rows c of `column` for
    /// the first rows, as many as it has. With every field come the row that follows the last one, and y. Rows have
    /// `width` numbers.
    fn substitute<'a, S, const L: usize>(
        simd,
        factors: [&'a [f64]; 3],
        fields: [(&'a mut [f64], [&'a [f64]; 2]); L],
        width: usize,
    ) {
        let (factors, k) = (factors.map(|factor| S::as_simd_f64s(factor).0), width / S::F64_LANES);
        let mut fields =
            fields.map(|(x, known)| (S::as_mut_simd_f64s(x).0, known.map(|row| S::as_simd_f64s(row).0)));
        by_blocks!(k, substitute_block::<S, L>(simd, factors, &mut fields, k));
    }
}

/// The registers from `at` on of [`substitute`].
#[inline(always)]
fn substitute_block<S: Simd, const B: usize, const L: usize>(
    simd: S,
    [d, links, column]: [&[S::f64s]; 3],
    fields: &mut [Followed<S::f64s>; L],
    k: usize,
    at: usize,
) {
    let [mut moving, mut last] = [[[simd.splat_f64s(0.0); B]; L]; 2];
    for l in 0..L {
        (moving[l], last[l]) = (load(fields[l].1[0], at), load(fields[l].1[1], at));
    }
    let (filled, size) = (column.len(), fields[0].0.len());
    let [(d_filled, d), (links_filled, links)] = [d, links].map(|factor| (&factor[..filled], &factor[filled..size]));
    let mut end = size + at;
    for (d, link) in d.chunks_exact(k).zip(links.chunks_exact(k)).rev() {
        end -= k;
        let (d, link) = (&d[at..at + B], &link[at..at + B]);
        for l in 0..L {
            let x = &mut fields[l].0[end..end + B];
            for q in 0..B {
                moving[l][q] = less(simd, simd.mul_f64s(x[q], d[q]), link[q], moving[l][q]);
                x[q] = moving[l][q];
            }
        }
    }
    let rows = d_filled.chunks_exact(k).zip(links_filled.chunks_exact(k)).zip(column.chunks_exact(k));
    for ((d, link), c) in rows.rev() {
        end -= k;
        let (d, link, c) = (&d[at..at + B], &link[at..at + B], &c[at..at + B]);
        for l in 0..L {
            let x = &mut fields[l].0[end..end + B];
            for q in 0..B {
                let rest = simd.mul_f64s(less(simd, x[q], c[q], last[l][q]), d[q]);
                moving[l][q] = less(simd, rest, link[q], moving[l][q]);
                x[q] = moving[l][q];
            }
        }
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
    /// `(α M̃ + β F) x` for the rows of all `fields` x of a body, with `α = a + b λ` of the modes' `values` λ, but for
    /// the entry of the stream; it replaces that of `out` or is added to it. Neighbours enter by their differences from
    /// the row, so that an even field is not moved by round-off. Ends of an open streamline have no outer neighbour;
    /// the entries there are zero.
    fn tridiagonal_product<'a, S, const L: usize>(
        simd,
        transport: &'a Transport,
        values: &'a [f64],
        weights: [f64; 3],
        fields: [&'a [f64]; L],
        out: [&'a mut [f64]; L],
        update: Update,
    ) {
        let fields = fields.map(|x| S::as_simd_f64s(x).0);
        let mut out = out.map(|out| S::as_mut_simd_f64s(out).0);
        let values = S::as_simd_f64s(values).0;
        let ([storage, conduction, flow], k) = (weights, values.len());
        let (storage, conduction) = (simd.splat_f64s(storage), simd.splat_f64s(conduction));
        // Rows before, here and after.
        let mut rows = [[values; 3]; L];
        for l in 0..L {
            let (first, last) = (&fields[l][..k], &fields[l][fields[l].len() - k..]);
            rows[l] = [last, last, first];
        }
        let n = transport.rows.len();
        for (i, &[below, sum, above, from, to]) in transport.rows.iter().enumerate() {
            let (below, sum, above) = (simd.splat_f64s(below), simd.splat_f64s(sum), simd.splat_f64s(above));
            let (from, to) = (simd.splat_f64s(-flow * from), simd.splat_f64s(-flow * to));
            let next = if i + 1 == n { 0 } else { (i + 1) * k };
            let mut targets: [&mut [S::f64s]; L] = std::array::from_fn(|_| Default::default());
            for (target, out) in targets.iter_mut().zip(out.iter_mut()) {
                *target = &mut out[i * k..][..k];
            }
            for l in 0..L {
                rows[l] = [rows[l][1], rows[l][2], &fields[l][next..][..k]];
            }
            for (q, &value) in values.iter().enumerate() {
                let alpha = simd.mul_add_e_f64s(conduction, value, storage);
                let whole = simd.mul_f64s(alpha, sum);
                let (below, above) = (less(simd, from, alpha, below), less(simd, to, alpha, above));
                for l in 0..L {
                    let [before, here, after] = [rows[l][0][q], rows[l][1][q], rows[l][2][q]];
                    let held = simd.mul_add_e_f64s(below, simd.sub_f64s(here, before), simd.mul_f64s(whole, here));
                    let product = simd.mul_add_e_f64s(above, simd.sub_f64s(here, after), held);
                    targets[l][q] = match update {
                        Update::Add => simd.add_f64s(targets[l][q], product),
                        Update::Replace => product,
                    };
                }
            }
        }
    }
}
