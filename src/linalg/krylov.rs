//! Krylov spaces of `T = K⁻¹ M`, block by block with full reorthogonalisation, and the Ritz pairs in them.

use super::blocks::{Weighted, orthonormalise, product, solved};
use super::{Cholesky, CsrMatrix, LinalgError};
use faer::Mat;
use nalgebra::{DMatrix, SymmetricEigen};

/// Vectors added to the Krylov space at a time.
const BLOCK: usize = 4;
/// Accepted residual `‖T φ − θ φ‖_M / θ` before the final inverse iteration.
const TOLERANCE: f64 = 1e-9;

/// Number of vectors in the Krylov space that suffices for `count` modes of bodies as long as they are high, or ten
/// times as long.
pub fn usual_space(count: usize) -> usize {
    6 * count + 60
}

/// Largest number of vectors in the Krylov space for `count` modes.
///
/// A long body on a fixed base has a cut-off frequency, above which its modes crowd: their distance falls with the
/// square of the length, and the space has to grow with the length to tell them apart, however few of them are wanted.
/// A rail of 100 m with a height of 0.1 m took 384 vectors for one mode and 848 for 200.
pub fn largest_space(count: usize) -> usize {
    usual_space(count) + 800
}

/// A body that vibrates, or a part of it that does so by itself.
#[derive(Clone, Copy, Debug)]
pub struct Oscillator<'a> {
    /// `K` [N/m per m].
    pub stiffness: &'a CsrMatrix,
    /// `M` [kg/m].
    pub mass: &'a CsrMatrix,
    /// Cholesky factor of `K`.
    pub factor: &'a Cholesky,
}

/// A Krylov space that can be enlarged.
pub(super) struct Krylov<'a> {
    oscillator: Oscillator<'a>,
    /// `M`-orthonormal vectors, and room for more.
    basis: Weighted<Mat<f64>>,
    /// Number of vectors.
    size: usize,
    /// How many of them came last.
    last: usize,
    /// The vectors to come next: what is new in the images of the last ones.
    next: Weighted<Mat<f64>>,
    /// `Vᵀ M T V`, with the rows of the vectors to come.
    projected: DMatrix<f64>,
    restarts: usize,
}

/// The largest Ritz values of `T`, descending, and their vectors.
pub(super) struct RitzPairs {
    /// `θ = 1/Ω²` [s²/rad²].
    pub values: Vec<f64>,
    /// Coefficients in the basis, one vector per column.
    coefficients: Mat<f64>,
}

impl<'a> Krylov<'a> {
    /// A space that begins with pseudo-random vectors.
    pub fn new(oscillator: Oscillator<'a>) -> Self {
        let n = oscillator.factor.size();
        let basis = Weighted::none(n);
        let (next, _) = orthonormalise(oscillator.mass, basis.columns(0, 0), 0, start_block(oscillator, 0));
        Self { oscillator, basis, size: 0, last: 0, next, projected: DMatrix::zeros(0, 0), restarts: 0 }
    }

    /// Enlarges the space until its `count` largest Ritz pairs have residuals below [`TOLERANCE`]; `report` receives
    /// the number of vectors.
    pub fn converge(&mut self, count: usize, report: &mut dyn FnMut(usize)) -> Result<RitzPairs, LinalgError> {
        let n = self.oscillator.factor.size();
        let limit = largest_space(count).min(n);
        let mut next_check = (5 * count / 2 + 3 * BLOCK).min(limit);
        loop {
            let exhausted = self.next.count() == 0;
            if self.size >= next_check || (exhausted && self.size >= count) {
                next_check = (self.size + 2 * BLOCK).min(limit);
                let (pairs, residuals) = self.ritz_pairs(count.min(self.size))?;
                let converged = residuals.iter().take_while(|r| **r <= TOLERANCE).count();
                if converged == count {
                    return Ok(pairs);
                }
                if self.size >= limit {
                    let residual = residuals.get(converged).copied().unwrap_or(f64::NAN);
                    let space = self.size;
                    return Err(LinalgError::ModesNotConverged { wanted: count, converged, space, residual });
                }
            }
            self.enlarge(count)?;
            report(self.size);
        }
    }

    /// Takes the next vectors into the space, or new pseudo-random ones if it is closed under `T`.
    fn enlarge(&mut self, count: usize) -> Result<(), LinalgError> {
        let n = self.oscillator.factor.size();
        while self.next.count() == 0 {
            self.restarts += 1;
            if self.restarts > n {
                let (space, residual) = (self.size, f64::NAN);
                return Err(LinalgError::ModesNotConverged { wanted: count, converged: 0, space, residual });
            }
            let block = start_block(self.oscillator, self.restarts);
            let old = self.basis.columns(0, self.size);
            self.next = orthonormalise(self.oscillator.mass, old, self.size, block).0;
        }
        let width = self.next.count().min(n - self.size);
        self.reserve(width, count);
        let new = self.next.columns(0, width);
        let n = new.vectors.nrows();
        for (basis, new) in [(&mut self.basis.vectors, new.vectors), (&mut self.basis.weighted, new.weighted)] {
            basis.resize_with(n, self.size + width, |i, j| new[(i, j - self.size)]);
        }
        let image = solved(self.oscillator.factor, new.weighted);
        // In exact arithmetic, T couples a block to itself and to the ones before and after it.
        let old = self.basis.columns(0, self.size + width);
        let (next, coefficients) = orthonormalise(self.oscillator.mass, old, self.last + width, image);
        for j in 0..width {
            for i in 0..coefficients.nrows() {
                self.projected[(i, self.size + j)] = coefficients[(i, j)];
            }
        }
        (self.size, self.last, self.next) = (self.size + width, width, next);
        Ok(())
    }

    /// Makes room for `width` more vectors.
    fn reserve(&mut self, width: usize, count: usize) {
        let (n, room) = (self.basis.vectors.nrows(), self.projected.nrows().saturating_sub(BLOCK));
        if self.size + width > room {
            let columns = (self.size + self.size / 2 + width).max(4 * count + 4 * BLOCK).min(n);
            self.basis.vectors.reserve(n, columns);
            self.basis.weighted.reserve(n, columns);
            self.projected.resize_mut(columns + BLOCK, columns + BLOCK, 0.0);
        }
    }

    /// The `count` largest Ritz pairs and their relative residuals.
    fn ritz_pairs(&self, count: usize) -> Result<(RitzPairs, Vec<f64>), LinalgError> {
        let (size, last, projected) = (self.size, self.last, &self.projected);
        let symmetric = Mat::from_fn(size, size, |i, j| projected[(i.min(j), i.max(j))]);
        let (values, vectors) = dense_eigen(&symmetric)?;
        let values: Vec<f64> = values.into_iter().rev().take(count).collect();
        let coefficients = Mat::from_fn(size, count, |i, j| vectors[(i, size - 1 - j)]);
        let residual = |k: usize| {
            let along =
                |row: usize| -> f64 { (size - last..size).map(|j| projected[(row, j)] * coefficients[(j, k)]).sum() };
            let squared: f64 = (size..size + self.next.count()).map(|row| along(row).powi(2)).sum();
            squared.sqrt() / values[k].abs().max(f64::MIN_POSITIVE)
        };
        let residuals = (0..count).map(residual).collect();
        Ok((RitzPairs { values, coefficients }, residuals))
    }

    /// The first `count` Ritz vectors.
    pub fn vectors(&self, pairs: &RitzPairs, count: usize) -> Mat<f64> {
        self.basis.vectors.subcols(0, pairs.coefficients.nrows()) * pairs.coefficients.subcols(0, count)
    }
}

/// Eigenvalues (ascending) and eigenvectors of a dense symmetric matrix.
///
/// nalgebra's QR iteration: on the projected operators the divide and conquer of faer 0.24.4 leaves relative residuals
/// of 1e-6, nine digits more than round-off (see also faer-rs issue 273).
pub(super) fn dense_eigen(a: &Mat<f64>) -> Result<(Vec<f64>, Mat<f64>), LinalgError> {
    let size = a.nrows();
    let dense = DMatrix::from_fn(size, size, |i, j| a[(i, j)]);
    let eigen = SymmetricEigen::try_new(dense, f64::EPSILON, 100 * size).ok_or(LinalgError::Eigen { size })?;
    let mut order: Vec<usize> = (0..size).collect();
    order.sort_by(|&i, &j| eigen.eigenvalues[i].total_cmp(&eigen.eigenvalues[j]));
    let values = order.iter().map(|&i| eigen.eigenvalues[i]).collect();
    Ok((values, Mat::from_fn(size, size, |i, j| eigen.eigenvectors[(i, order[j])])))
}

/// Smoothed pseudo-random start vectors, the same in every run.
fn start_block(oscillator: Oscillator<'_>, seed: usize) -> Mat<f64> {
    let n = oscillator.factor.size();
    let width = BLOCK.min(n);
    let columns: Vec<Vec<f64>> = (0..width).map(|j| noise(n, seed * BLOCK + j + 1)).collect();
    let random = Mat::from_fn(n, width, |i, j| columns[j][i]);
    solved(oscillator.factor, product(oscillator.mass, &random).as_ref())
}

/// Uniform pseudo-random numbers in (−1, 1) (linear congruential generator of Knuth's MMIX).
pub(super) fn noise(n: usize, seed: usize) -> Vec<f64> {
    let mut state = 0x9E37_79B9_7F4A_7C15_u64.wrapping_mul(seed as u64 + 1);
    (0..n)
        .map(|_| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanics::rail_system;
    use crate::mechanics::testing::paper_d;
    use faer::MatRef;

    /// The operator `K⁻¹ M` in a Krylov space of `size` vectors: what [`Krylov`] hands to [`dense_eigen`].
    fn projected_operator(k: &CsrMatrix, m: &CsrMatrix, size: usize) -> Mat<f64> {
        let factor = Cholesky::new(k).unwrap();
        let mut space = Krylov::new(Oscillator { stiffness: k, mass: m, factor: &factor });
        while space.size < size {
            space.enlarge(size).unwrap();
        }
        Mat::from_fn(size, size, |i, j| space.projected[(i.min(j), i.max(j))])
    }

    /// Largest relative residual `‖A v − λ v‖/‖A‖` of the eigenpairs.
    fn residual(a: &Mat<f64>, values: &[f64], vectors: MatRef<'_, f64>) -> f64 {
        let image = a * vectors;
        let norm = values.iter().fold(0.0_f64, |norm, value| norm.max(value.abs()));
        let pairs = values.iter().enumerate();
        pairs
            .map(|(j, value)| (image.col(j) - vectors.col(j) * faer::Scale(*value)).norm_l2() / norm)
            .fold(0.0, f64::max)
    }

    /// Why [`dense_eigen`] is nalgebra's: on the projected operator of a rail faer loses digits. Once this test fails
    /// because faer is accurate, its own eigenvalue solver can take over.
    #[test]
    fn dense_eigenpairs_are_accurate_to_round_off_where_divide_and_conquer_loses_digits() {
        let system = rail_system(&paper_d(5)).unwrap();
        let a = projected_operator(&system.stiffness, &system.mass, 264);
        let (values, vectors) = dense_eigen(&a).unwrap();
        let ours = residual(&a, &values, vectors.as_ref());
        let other = a.self_adjoint_eigen(faer::Side::Lower).unwrap();
        let values: Vec<f64> = other.S().column_vector().iter().copied().collect();
        let theirs = residual(&a, &values, other.U());
        println!("relative residual: nalgebra {ours:.1e}, faer {theirs:.1e}");
        assert!(ours < 1e-13 && theirs > 1e-12);
    }
}
