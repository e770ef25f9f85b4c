//! Krylov spaces of `T = K⁻¹ M`, block by block with full reorthogonalisation, and the Ritz pairs in them.

use super::blocks::{Weighted, multiply, orthonormalise, view};
use super::{Cholesky, CsrMatrix, LinalgError};
use faer::{Accum, MatRef};
use nalgebra::{DMatrix, SymmetricEigen};

/// Vectors added to the Krylov space at a time.
const BLOCK: usize = 4;
/// Accepted residual `‖T φ − θ φ‖_M / θ` before the final inverse iteration; frequencies are off by its square.
const TOLERANCE: f64 = 1e-6;

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
    /// `M` [kg/m].
    pub mass: &'a CsrMatrix,
    /// Cholesky factor of `K`.
    pub factor: &'a Cholesky,
}

/// A Krylov space that can be enlarged.
pub(super) struct Krylov<'a> {
    oscillator: Oscillator<'a>,
    /// `M`-orthonormal vectors, one after the other.
    basis: Vec<f64>,
    /// The mass times the last two blocks of them.
    weighted: Vec<f64>,
    /// Number of vectors.
    size: usize,
    /// How many of them came last.
    last: usize,
    /// The vectors to come next: what is new in the images of the last ones.
    next: Weighted,
    /// `Vᵀ M T V`, with the rows of the vectors to come.
    projected: DMatrix<f64>,
    restarts: usize,
}

/// The largest Ritz values of `T`, descending, and their vectors.
pub(super) struct RitzPairs {
    /// `θ = 1/Ω²` [s²/rad²].
    pub values: Vec<f64>,
    /// Coefficients in the basis, one vector per column.
    coefficients: DMatrix<f64>,
}

impl<'a> Krylov<'a> {
    /// A space that begins with pseudo-random vectors.
    pub fn new(oscillator: Oscillator<'a>) -> Self {
        let none = MatRef::from_column_major_slice(&[], oscillator.factor.size(), 0);
        let (next, _) = orthonormalise(oscillator.mass, none, none, start_block(oscillator, 0));
        let (basis, weighted, projected) = (Vec::new(), Vec::new(), DMatrix::zeros(0, 0));
        Self { oscillator, basis, weighted, size: 0, last: 0, next, projected, restarts: 0 }
    }

    /// The vectors of the space.
    fn vectors(&self) -> MatRef<'_, f64> {
        MatRef::from_column_major_slice(&self.basis, self.oscillator.factor.size(), self.size)
    }

    /// Enlarges the space until its `count` largest Ritz pairs have residuals below [`TOLERANCE`]; `report` receives
    /// the number of vectors.
    pub fn converge(&mut self, count: usize, report: &mut dyn FnMut(usize)) -> Result<RitzPairs, LinalgError> {
        let n = self.oscillator.factor.size();
        let limit = largest_space(count).min(n);
        let mut next_check = (5 * count / 2 + 6 * BLOCK).min(limit);
        loop {
            let exhausted = self.next.vectors.ncols() == 0;
            if self.size >= next_check || (exhausted && self.size >= count) {
                let (pairs, residuals) = self.ritz_pairs(count.min(self.size))?;
                // A block takes less than a decade off the residuals.
                let decades = libm::log10(residuals.iter().fold(0.0, |most: f64, r| most.max(*r)) / TOLERANCE);
                next_check = (self.size + BLOCK * (decades.ceil() as usize).clamp(1, 4)).min(limit);
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
        let Oscillator { mass, factor } = self.oscillator;
        while self.next.vectors.ncols() == 0 {
            self.restarts += 1;
            if self.restarts > n {
                let (space, residual) = (self.size, f64::NAN);
                return Err(LinalgError::ModesNotConverged { wanted: count, converged: 0, space, residual });
            }
            // What is no image has parts along all vectors.
            let all = mass.multiply_columns(&DMatrix::from_column_slice(n, self.size, &self.basis));
            let block = start_block(self.oscillator, self.restarts);
            self.next = orthonormalise(mass, self.vectors(), view(&all), block).0;
        }
        let Weighted { vectors, weighted } = &self.next;
        let width = vectors.ncols().min(n - self.size);
        let mut image = weighted.columns(0, width).into_owned();
        self.weighted.drain(..self.weighted.len() - n * self.last);
        self.weighted.extend_from_slice(image.as_slice());
        self.basis.extend_from_slice(&vectors.as_slice()[..n * width]);
        (self.size, self.last) = (self.size + width, width);
        factor.solve_columns(&mut image);
        // In exact arithmetic, T couples a block to itself and to the ones before and after it.
        let near = MatRef::from_column_major_slice(&self.weighted, n, self.weighted.len() / n);
        let (next, coefficients) = orthonormalise(mass, self.vectors(), near, image);
        self.next = next;
        self.reserve(count);
        let first = self.size - width;
        self.projected.view_mut((0, first), coefficients.shape()).copy_from(&coefficients);
        Ok(())
    }

    /// Makes room for what `T` does to the vectors, and to some more of them.
    fn reserve(&mut self, count: usize) {
        let room = self.projected.nrows().saturating_sub(BLOCK);
        if self.size > room {
            let columns = (self.size + self.size / 2).max(4 * count + 4 * BLOCK);
            self.projected.resize_mut(columns + BLOCK, columns + BLOCK, 0.0);
        }
    }

    /// The `count` largest Ritz pairs and their relative residuals.
    fn ritz_pairs(&self, count: usize) -> Result<(RitzPairs, Vec<f64>), LinalgError> {
        let (size, last, projected) = (self.size, self.last, &self.projected);
        let (values, vectors) = dense_eigen(DMatrix::from_fn(size, size, |i, j| projected[(i.min(j), i.max(j))]))?;
        let values: Vec<f64> = values.into_iter().rev().take(count).collect();
        let coefficients = DMatrix::from_fn(size, count, |i, j| vectors[(i, size - 1 - j)]);
        let residual = |k: usize| {
            let along =
                |row: usize| -> f64 { (size - last..size).map(|j| projected[(row, j)] * coefficients[(j, k)]).sum() };
            let squared: f64 = (size..size + self.next.vectors.ncols()).map(|row| along(row).powi(2)).sum();
            squared.sqrt() / values[k].abs().max(f64::MIN_POSITIVE)
        };
        let residuals = (0..count).map(residual).collect();
        Ok((RitzPairs { values, coefficients }, residuals))
    }

    /// Images `T φ` of the first `count` Ritz vectors, as coefficients of the vectors in the space and those to come, and
    /// the squares: `(T φ)ᵀ M T φ` and `(T φ)ᵀ K T φ`.
    ///
    /// `T V` is known in these vectors, and `K T V` is `M V`: neither takes a solution nor a product with `K`, which would
    /// magnify round-off.
    pub fn images(&self, pairs: &RitzPairs, count: usize) -> (DMatrix<f64>, [DMatrix<f64>; 2]) {
        let (size, all) = (self.size, self.size + self.next.vectors.ncols());
        let ritz = pairs.coefficients.columns(0, count);
        let images = self.projected.view((0, 0), (all, size)) * ritz;
        let squares = [images.tr_mul(&images), ritz.tr_mul(&images.rows(0, size))];
        (images, squares)
    }

    /// Vectors with given coefficients of those in the space and those to come.
    pub fn combinations(&self, coefficients: &DMatrix<f64>) -> DMatrix<f64> {
        let mut out = DMatrix::zeros(self.oscillator.factor.size(), coefficients.ncols());
        let (inside, to_come) = view(coefficients).split_at_row(self.size);
        multiply(self.vectors(), inside, 1.0, Accum::Replace, &mut out);
        multiply(view(&self.next.vectors), to_come, 1.0, Accum::Add, &mut out);
        out
    }
}

/// Eigenvalues (ascending) and eigenvectors of a dense symmetric matrix.
///
/// nalgebra's QR iteration: on the projected operators the divide and conquer of faer 0.24.4 leaves relative residuals
/// of 1e-6, nine digits more than round-off (see also faer-rs issue 273).
pub(super) fn dense_eigen(a: DMatrix<f64>) -> Result<(Vec<f64>, DMatrix<f64>), LinalgError> {
    let size = a.nrows();
    let eigen = SymmetricEigen::try_new(a, f64::EPSILON, 100 * size).ok_or(LinalgError::Eigen { size })?;
    let mut order: Vec<usize> = (0..size).collect();
    order.sort_by(|&i, &j| eigen.eigenvalues[i].total_cmp(&eigen.eigenvalues[j]));
    let values = order.iter().map(|&i| eigen.eigenvalues[i]).collect();
    Ok((values, eigen.eigenvectors.select_columns(&order)))
}

/// Smoothed pseudo-random start vectors, the same in every run.
fn start_block(oscillator: Oscillator<'_>, seed: usize) -> DMatrix<f64> {
    let n = oscillator.factor.size();
    let width = BLOCK.min(n);
    let random = DMatrix::from_iterator(n, width, (1..=width).flat_map(|j| noise(n, seed * BLOCK + j)));
    let mut smooth = oscillator.mass.multiply_columns(&random);
    oscillator.factor.solve_columns(&mut smooth);
    smooth
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

    /// The operator `K⁻¹ M` in a Krylov space of `size` vectors: what [`Krylov`] hands to [`dense_eigen`].
    fn projected_operator(k: &CsrMatrix, m: &CsrMatrix, size: usize) -> DMatrix<f64> {
        let factor = Cholesky::new(k).unwrap();
        let mut space = Krylov::new(Oscillator { mass: m, factor: &factor });
        while space.size < size {
            space.enlarge(size).unwrap();
        }
        DMatrix::from_fn(size, size, |i, j| space.projected[(i.min(j), i.max(j))])
    }

    /// Largest relative residual `‖A v − λ v‖/‖A‖` of the eigenpairs.
    fn residual(a: MatRef<'_, f64>, values: &[f64], vectors: MatRef<'_, f64>) -> f64 {
        let image = a * vectors;
        let norm = values.iter().fold(0.0_f64, |norm, value| norm.max(value.abs()));
        let pairs = values.iter().enumerate();
        pairs
            .map(|(j, value)| (image.col(j) - vectors.col(j) * faer::Scale(*value)).norm_l2() / norm)
            .fold(0.0, f64::max)
    }

    /// Stiffness and lumped mass of a bar held at both ends, whose cells grow by 5 % each.
    fn graded_bar(n: usize) -> [CsrMatrix; 2] {
        let cells: Vec<f64> = std::iter::successors(Some(1.0), |cell| Some(1.05 * cell)).take(n + 1).collect();
        let (mut k, mut m) = (Vec::new(), Vec::new());
        for (i, beside) in cells.windows(2).enumerate() {
            k.push((i, i, 1.0 / beside[0] + 1.0 / beside[1]));
            m.push((i, i, 0.5 * (beside[0] + beside[1])));
            if i > 0 {
                k.extend([(i, i - 1, -1.0 / beside[0]), (i - 1, i, -1.0 / beside[0])]);
            }
        }
        [k, m].map(|entries| CsrMatrix::from_triplets(n, n, &entries).unwrap())
    }

    /// Why [`dense_eigen`] is nalgebra's: on the projected operator of a graded mesh, as those of wheel and rail are, faer
    /// loses digits. Once this test fails because faer is accurate, its own eigenvalue solver can take over.
    #[test]
    fn dense_eigenpairs_are_accurate_to_round_off_where_divide_and_conquer_loses_digits() {
        let [stiffness, mass] = graded_bar(400);
        let a = projected_operator(&stiffness, &mass, 264);
        let (values, vectors) = dense_eigen(a.clone()).unwrap();
        let a = view(&a);
        let ours = residual(a, &values, view(&vectors));
        let other = a.self_adjoint_eigen(faer::Side::Lower).unwrap();
        let values: Vec<f64> = other.S().column_vector().iter().copied().collect();
        let theirs = residual(a, &values, other.U());
        println!("relative residual: nalgebra {ours:.1e}, faer {theirs:.1e}");
        assert!(ours < 1e-13 && theirs > 1e-12);
    }
}
