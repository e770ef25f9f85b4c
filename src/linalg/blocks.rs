//! Blocks of vectors that are orthonormal in the inner product of a mass matrix.

use super::{Cholesky, CsrMatrix};
use faer::{Mat, MatRef};

/// Block Gram–Schmidt against the first `size` columns of `basis`, then within the block, all of it twice.
///
/// Returns the new `M`-orthonormal vectors (fewer if dependent) and the coefficients of `w` in old and new vectors.
pub(super) fn orthonormalise(mass: &CsrMatrix, basis: &Mat<f64>, size: usize, mut w: Mat<f64>) -> (Mat<f64>, Mat<f64>) {
    let old = basis.subcols(0, size);
    let smallest: Vec<f64> = column_norms(mass, &w).iter().map(|norm| 1e-12 * norm).collect();
    let mut along_old = remove(mass, old, &mut w);
    let (mut next, mut within) = orthonormalise_block(mass, &w, &smallest);
    // Normalising small remainders has magnified their round-off along the old vectors.
    let again = remove(mass, old, &mut next);
    along_old += again * &within;
    let (next, correction) = orthonormalise_block(mass, &next, &vec![0.0; next.ncols()]);
    within = correction * within;
    let coefficients =
        Mat::from_fn(
            size + next.ncols(),
            w.ncols(),
            |i, j| {
                if i < size { along_old[(i, j)] } else { within[(i - size, j)] }
            },
        );
    (next, coefficients)
}

/// Subtracts the `M`-orthogonal projection of `w` on the orthonormal columns of `old`; returns its coefficients.
fn remove(mass: &CsrMatrix, old: MatRef<'_, f64>, w: &mut Mat<f64>) -> Mat<f64> {
    if old.ncols() == 0 || w.ncols() == 0 {
        return Mat::zeros(old.ncols(), w.ncols());
    }
    let mut mw = w.clone();
    apply(mass, &mut mw);
    let coefficients = old.transpose() * &mw;
    *w -= old * &coefficients;
    coefficients
}

/// Modified Gram–Schmidt within a block, `w = q r`; vectors shorter than `smallest` after projection are dropped.
fn orthonormalise_block(mass: &CsrMatrix, w: &Mat<f64>, smallest: &[f64]) -> (Mat<f64>, Mat<f64>) {
    let (n, width) = (w.nrows(), w.ncols());
    let mut r = Mat::<f64>::zeros(width, width);
    let mut kept: Vec<(Vec<f64>, Vec<f64>)> = Vec::with_capacity(width);
    let mut mv = vec![0.0; n];
    for j in 0..width {
        let mut v: Vec<f64> = w.col(j).iter().copied().collect();
        for (i, (u, mu)) in kept.iter().enumerate() {
            let h = dot(mu, &v);
            v.iter_mut().zip(u).for_each(|(a, b)| *a -= h * b);
            r[(i, j)] += h;
        }
        mass.multiply(&v, &mut mv);
        let norm = dot(&v, &mv).max(0.0).sqrt();
        if norm > smallest[j] {
            r[(kept.len(), j)] = norm;
            v.iter_mut().for_each(|a| *a /= norm);
            kept.push((v, mv.iter().map(|a| a / norm).collect()));
        }
    }
    let q = Mat::from_fn(n, kept.len(), |i, j| kept[j].0[i]);
    (q, r.subrows(0, kept.len()).to_owned())
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// Lengths of the columns of `w`.
fn column_norms(mass: &CsrMatrix, w: &Mat<f64>) -> Vec<f64> {
    let mut mw = w.clone();
    apply(mass, &mut mw);
    (0..w.ncols()).map(|j| (w.col(j).transpose() * mw.col(j)).max(0.0).sqrt()).collect()
}

/// `X ← A X`.
pub(super) fn apply(a: &CsrMatrix, x: &mut Mat<f64>) {
    let mut y = vec![0.0; a.rows()];
    for j in 0..x.ncols() {
        let column: Vec<f64> = x.col(j).iter().copied().collect();
        a.multiply(&column, &mut y);
        x.col_mut(j).iter_mut().zip(&y).for_each(|(target, value)| *target = *value);
    }
}

/// `X ← A⁻¹ X`.
pub(super) fn solve(factor: &Cholesky, x: &mut Mat<f64>) {
    let (n, width) = (x.nrows(), x.ncols());
    let mut columns: Vec<f64> = Vec::with_capacity(n * width);
    for j in 0..width {
        columns.extend(x.col(j).iter());
    }
    factor.solve_in_place(&mut columns);
    x.copy_from(MatRef::from_column_major_slice(&columns, n, width));
}
