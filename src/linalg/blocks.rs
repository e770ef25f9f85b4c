//! Blocks of vectors that are orthonormal in the inner product of a mass matrix.

use super::vectorised::dot;
use super::{Cholesky, CsrMatrix};
use faer::{Mat, MatRef};

/// Vectors and their products with the mass.
pub(super) struct Weighted<V> {
    /// `V`.
    pub vectors: V,
    /// `M V`.
    pub weighted: V,
}

impl Weighted<Mat<f64>> {
    /// No vectors of `n` unknowns.
    pub fn none(n: usize) -> Self {
        Self { vectors: Mat::zeros(n, 0), weighted: Mat::zeros(n, 0) }
    }

    /// Number of vectors.
    pub fn count(&self) -> usize {
        self.vectors.ncols()
    }

    /// Some of them.
    pub fn columns(&self, first: usize, count: usize) -> Weighted<MatRef<'_, f64>> {
        Weighted { vectors: self.vectors.subcols(first, count), weighted: self.weighted.subcols(first, count) }
    }
}

impl Weighted<MatRef<'_, f64>> {
    /// Subtracts from `w` its `M`-orthogonal projection on these orthonormal vectors; returns its coefficients.
    fn remove(&self, w: &mut Mat<f64>) -> Mat<f64> {
        let coefficients = self.weighted.transpose() * &*w;
        *w -= self.vectors * &coefficients;
        coefficients
    }
}

/// Block Gram–Schmidt against the orthonormal vectors `old`, then within the block, all of it twice.
///
/// The first time only the last `recent` of the old ones count: those along which `w` has more than round-off. Returns
/// the new `M`-orthonormal vectors (fewer if dependent) and the coefficients of `w` in old and new vectors.
pub(super) fn orthonormalise(
    mass: &CsrMatrix,
    old: Weighted<MatRef<'_, f64>>,
    recent: usize,
    mut w: Mat<f64>,
) -> (Weighted<Mat<f64>>, Mat<f64>) {
    let (size, width) = (old.vectors.ncols(), w.ncols());
    let first = size - recent;
    let near = Weighted { vectors: old.vectors.subcols(first, recent), weighted: old.weighted.subcols(first, recent) };
    let mut along_old = Mat::<f64>::zeros(size, width);
    along_old.subrows_mut(first, recent).copy_from(near.remove(&mut w));
    // Vectors shorter than a share of their length before the projection have nothing new.
    let removed: Vec<f64> = (0..width).map(|j| along_old.col(j).squared_norm_l2()).collect();
    let (mut next, mut within) = orthonormalise_block(mass, &w, &removed, 1e-12);
    // Normalising small remainders has magnified their round-off along the old vectors.
    along_old += old.remove(&mut next.vectors) * &within;
    let (next, correction) = orthonormalise_block(mass, &next.vectors, &vec![0.0; next.count()], 0.0);
    within = correction * within;
    let coefficient = |i: usize, j: usize| if i < size { along_old[(i, j)] } else { within[(i - size, j)] };
    let coefficients = Mat::from_fn(size + next.count(), width, coefficient);
    (next, coefficients)
}

/// Modified Gram–Schmidt within a block, `w = q r`; vectors that are shorter after projection than the share `smallest`
/// of their length before, of which the square `removed` is gone already, are dropped.
fn orthonormalise_block(
    mass: &CsrMatrix,
    w: &Mat<f64>,
    removed: &[f64],
    smallest: f64,
) -> (Weighted<Mat<f64>>, Mat<f64>) {
    let (n, width) = (w.nrows(), w.ncols());
    let mw = product(mass, w);
    let mut r = Mat::<f64>::zeros(width, width);
    let mut kept: Vec<(Vec<f64>, Vec<f64>)> = Vec::with_capacity(width);
    let column = |a: &Mat<f64>, j: usize| -> Vec<f64> { a.col(j).iter().copied().collect() };
    for (j, removed) in removed.iter().enumerate() {
        let (mut v, mut mv) = (column(w, j), column(&mw, j));
        let length = (removed + dot(&v, &mv).max(0.0)).sqrt();
        for (i, (u, mu)) in kept.iter().enumerate() {
            let h = dot(mu, &v);
            v.iter_mut().zip(u).for_each(|(a, b)| *a -= h * b);
            mv.iter_mut().zip(mu).for_each(|(a, b)| *a -= h * b);
            r[(i, j)] += h;
        }
        let norm = dot(&v, &mv).max(0.0).sqrt();
        if norm > smallest * length {
            r[(kept.len(), j)] = norm;
            v.iter_mut().chain(&mut mv).for_each(|a| *a /= norm);
            kept.push((v, mv));
        }
    }
    let vectors = Mat::from_fn(n, kept.len(), |i, j| kept[j].0[i]);
    let weighted = Mat::from_fn(n, kept.len(), |i, j| kept[j].1[i]);
    (Weighted { vectors, weighted }, r.subrows(0, kept.len()).to_owned())
}

/// The columns of a matrix one after the other.
fn packed(x: MatRef<'_, f64>) -> Vec<f64> {
    let mut columns = Vec::with_capacity(x.nrows() * x.ncols());
    (0..x.ncols()).for_each(|j| columns.extend(x.col(j).iter()));
    columns
}

/// `A X`.
pub(super) fn product(a: &CsrMatrix, x: &Mat<f64>) -> Mat<f64> {
    let mut y = vec![0.0; a.rows() * x.ncols()];
    a.multiply_into(&packed(x.as_ref()), &mut y);
    MatRef::from_column_major_slice(&y, a.rows(), x.ncols()).to_owned()
}

/// `A⁻¹ X`.
pub(super) fn solved(factor: &Cholesky, x: MatRef<'_, f64>) -> Mat<f64> {
    let mut y = packed(x);
    factor.solve_in_place(&mut y);
    MatRef::from_column_major_slice(&y, x.nrows(), x.ncols()).to_owned()
}
