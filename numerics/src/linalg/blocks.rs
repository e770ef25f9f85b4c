//! Blocks of vectors that are orthonormal in the inner product of a mass matrix.

use super::CsrMatrix;
use super::vectorised::dot;
use faer::linalg::matmul::matmul;
use faer::{Accum, MatMut, MatRef, Par};
use nalgebra::DMatrix;

/// Vectors and their products with the mass.
pub(super) struct Weighted {
    /// `V`.
    pub vectors: DMatrix<f64>,
    /// `M V`.
    pub weighted: DMatrix<f64>,
}

/// A matrix as faer sees it.
pub(super) fn view(a: &DMatrix<f64>) -> MatRef<'_, f64> {
    MatRef::from_column_major_slice(a.as_slice(), a.nrows(), a.ncols())
}

/// `out ← factor A B`, or `out ← out + factor A B`, for tall matrices.
pub(super) fn multiply(a: MatRef<'_, f64>, b: MatRef<'_, f64>, factor: f64, update: Accum, out: &mut DMatrix<f64>) {
    let (rows, columns) = out.shape();
    let out = MatMut::from_column_major_slice_mut(out.as_mut_slice(), rows, columns);
    matmul(out, update, a, b, factor, Par::Seq);
}

/// Block Gram–Schmidt against the orthonormal vectors `old`, then within the block, all of it twice.
///
/// The first time only the last of the old ones count, those along which `w` has more than round-off: `weighted` is the
/// mass times these. Returns the new `M`-orthonormal vectors (fewer if dependent) and the coefficients of `w` in old and
/// new vectors.
pub(super) fn orthonormalise(
    mass: &CsrMatrix,
    old: MatRef<'_, f64>,
    weighted: MatRef<'_, f64>,
    mut w: DMatrix<f64>,
) -> (Weighted, DMatrix<f64>) {
    let (size, width, recent) = (old.ncols(), w.ncols(), weighted.ncols());
    let first = size - recent;
    let mut along_old = DMatrix::zeros(size, width);
    let mut along = DMatrix::zeros(recent, width);
    multiply(weighted.transpose(), view(&w), 1.0, Accum::Replace, &mut along);
    multiply(old.subcols(first, recent), view(&along), -1.0, Accum::Add, &mut w);
    along_old.rows_mut(first, recent).copy_from(&along);
    // Vectors shorter than a share of their length before the projection have nothing new.
    let removed: Vec<f64> = along_old.column_iter().map(|column| column.norm_squared()).collect();
    let (mut next, mut within) = orthonormalise_block(mass, w, &removed, 1e-12);
    // Normalising small remainders has magnified their round-off along the old vectors.
    let count = next.vectors.ncols();
    let mut along = DMatrix::zeros(size, count);
    multiply(old.transpose(), view(&next.weighted), 1.0, Accum::Replace, &mut along);
    multiply(old, view(&along), -1.0, Accum::Add, &mut next.vectors);
    along_old += along * &within;
    let (next, correction) = orthonormalise_block(mass, next.vectors, &vec![0.0; count], 0.0);
    within = correction * within;
    let mut coefficients = DMatrix::zeros(size + within.nrows(), width);
    coefficients.rows_mut(0, size).copy_from(&along_old);
    coefficients.rows_mut(size, within.nrows()).copy_from(&within);
    (next, coefficients)
}

/// Modified Gram–Schmidt within a block, `w = q r`; vectors that are shorter after projection than the share `smallest`
/// of their length before, of which the square `removed` is gone already, are dropped.
fn orthonormalise_block(
    mass: &CsrMatrix,
    mut w: DMatrix<f64>,
    removed: &[f64],
    smallest: f64,
) -> (Weighted, DMatrix<f64>) {
    let (n, width) = w.shape();
    let mut mw = mass.multiply_columns(&w);
    let mut r = DMatrix::zeros(width, width);
    let mut kept = 0;
    let (vectors, weighted) = (w.as_mut_slice(), mw.as_mut_slice());
    for (j, removed) in removed.iter().enumerate() {
        // Those that are kept stand before this one.
        let ((before, v), (weighted_before, mv)) = (vectors.split_at_mut(j * n), weighted.split_at_mut(j * n));
        let (v, mv) = (&mut v[..n], &mut mv[..n]);
        let length = (removed + dot(v, mv).max(0.0)).sqrt();
        for (i, (u, mu)) in before.chunks_exact(n).zip(weighted_before.chunks_exact(n)).take(kept).enumerate() {
            let h = dot(mu, v);
            v.iter_mut().zip(u).for_each(|(a, b)| *a -= h * b);
            mv.iter_mut().zip(mu).for_each(|(a, b)| *a -= h * b);
            r[(i, j)] += h;
        }
        let norm = dot(v, mv).max(0.0).sqrt();
        if norm > smallest * length {
            r[(kept, j)] = norm;
            v.iter_mut().chain(mv).for_each(|a| *a /= norm);
            for all in [&mut *vectors, weighted] {
                all.copy_within(j * n..(j + 1) * n, kept * n);
            }
            kept += 1;
        }
    }
    let [vectors, weighted] = [w, mw].map(|all| all.remove_columns(kept, width - kept));
    (Weighted { vectors, weighted }, r.remove_rows(kept, width - kept))
}
