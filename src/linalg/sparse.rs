//! Sparse matrices by rows, and the Cholesky factorisation `A = L Lᵀ` of symmetric positive definite ones (faer).

use super::LinalgError;
use faer::linalg::solvers::SolveCore;
use faer::sparse::linalg::solvers::{Llt, SymbolicLlt};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Side};
use nalgebra::DMatrix;

/// Sparse matrix by rows, columns ascending within a row.
#[derive(Clone, Debug, PartialEq)]
pub struct CsrMatrix {
    rows: usize,
    columns: usize,
    /// Entries of row `i` are `starts[i]..starts[i + 1]`.
    starts: Vec<usize>,
    indices: Vec<usize>,
    values: Vec<f64>,
}

impl CsrMatrix {
    /// Sums `(row, column, value)` triplets; equal positions add up in the order given.
    pub fn from_triplets(rows: usize, columns: usize, triplets: &[(usize, usize, f64)]) -> Result<Self, LinalgError> {
        let mut ends = vec![0_usize; rows + 1];
        for &(row, column, _) in triplets {
            if row >= rows || column >= columns {
                return Err(LinalgError::OutOfRange { row, column, rows, columns });
            }
            ends[row + 1] += 1;
        }
        for i in 0..rows {
            ends[i + 1] += ends[i];
        }
        let mut next = ends.clone();
        let mut sorted = vec![(0_usize, 0.0_f64); triplets.len()];
        for &(row, column, value) in triplets {
            sorted[next[row]] = (column, value);
            next[row] += 1;
        }
        let (mut starts, mut indices, mut values) = (vec![0], Vec::new(), Vec::new());
        for i in 0..rows {
            let row = &mut sorted[ends[i]..ends[i + 1]];
            row.sort_by_key(|entry| entry.0);
            let first = indices.len();
            for &(column, value) in row.iter() {
                if indices.len() > first && indices.last() == Some(&column) {
                    if let Some(last) = values.last_mut() {
                        *last += value;
                    }
                } else {
                    indices.push(column);
                    values.push(value);
                }
            }
            starts.push(indices.len());
        }
        Ok(Self { rows, columns, starts, indices, values })
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Number of columns.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Number of stored entries.
    pub fn stored(&self) -> usize {
        self.values.len()
    }

    /// Stored `(column, value)` pairs of one row.
    pub fn row(&self, i: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let range = self.starts[i]..self.starts[i + 1];
        self.indices[range.clone()].iter().copied().zip(self.values[range].iter().copied())
    }

    /// Entry `(i, j)`, zero where nothing is stored.
    pub fn get(&self, i: usize, j: usize) -> f64 {
        self.row(i).find(|entry| entry.0 == j).map_or(0.0, |entry| entry.1)
    }

    /// `y ← A x`.
    pub fn multiply(&self, x: &[f64], y: &mut [f64]) {
        y.fill(0.0);
        self.multiply_add(1.0, x, y);
    }

    /// `y ← y + α A x`.
    pub fn multiply_add(&self, alpha: f64, x: &[f64], y: &mut [f64]) {
        for (yi, window) in y.iter_mut().zip(self.starts.windows(2)) {
            let range = window[0]..window[1];
            let sum: f64 = self.indices[range.clone()].iter().zip(&self.values[range]).map(|(&j, a)| a * x[j]).sum();
            *yi += alpha * sum;
        }
    }

    /// `A X` for a block of columns.
    pub fn multiply_columns(&self, x: &DMatrix<f64>) -> DMatrix<f64> {
        let mut y = DMatrix::zeros(self.rows, x.ncols());
        if self.rows > 0 && self.columns > 0 {
            for (xj, yj) in x.as_slice().chunks(self.columns).zip(y.as_mut_slice().chunks_mut(self.rows)) {
                self.multiply(xj, yj);
            }
        }
        y
    }

    /// `xᵀ A y`.
    pub fn bilinear(&self, x: &[f64], y: &[f64]) -> f64 {
        x.iter().enumerate().map(|(i, xi)| xi * self.row(i).map(|(j, a)| a * y[j]).sum::<f64>()).sum()
    }

    /// `α A + β B`; the pattern is the union of both, whatever the coefficients.
    pub fn combination(alpha: f64, a: &Self, beta: f64, b: &Self) -> Result<Self, LinalgError> {
        if a.rows != b.rows || a.columns != b.columns {
            return Err(LinalgError::SizeMismatch { left: a.rows, right: b.rows });
        }
        let capacity = a.stored().max(b.stored());
        let (mut starts, mut indices, mut values) =
            (vec![0], Vec::with_capacity(capacity), Vec::with_capacity(capacity));
        for i in 0..a.rows {
            let (mut ra, mut rb) = (a.row(i).peekable(), b.row(i).peekable());
            loop {
                let (column, value) = match (ra.peek().copied(), rb.peek().copied()) {
                    (Some((ja, va)), Some((jb, vb))) if ja == jb => {
                        ra.next();
                        rb.next();
                        (ja, alpha * va + beta * vb)
                    }
                    (Some((ja, va)), next) if next.is_none_or(|(jb, _)| ja < jb) => {
                        ra.next();
                        (ja, alpha * va)
                    }
                    (_, Some((jb, vb))) => {
                        rb.next();
                        (jb, beta * vb)
                    }
                    _ => break,
                };
                indices.push(column);
                values.push(value);
            }
            starts.push(indices.len());
        }
        Ok(Self { rows: a.rows, columns: a.columns, starts, indices, values })
    }

    /// The stored pattern read by columns: for a symmetric matrix the same thing as by rows.
    fn pattern(&self) -> SymbolicSparseColMatRef<'_, usize> {
        SymbolicSparseColMatRef::new_checked(self.rows, self.columns, &self.starts, None, &self.indices)
    }
}

/// Fill-reducing ordering and pattern of a Cholesky factor, shared by all matrices of one pattern.
#[derive(Clone, Debug)]
pub struct CholeskyPattern {
    size: usize,
    symbolic: SymbolicLlt<usize>,
}

impl CholeskyPattern {
    /// Analyses the pattern of a symmetric matrix.
    pub fn new(a: &CsrMatrix) -> Result<Self, LinalgError> {
        let size = a.rows;
        if a.rows != a.columns {
            return Err(LinalgError::SizeMismatch { left: a.rows, right: a.columns });
        }
        let symbolic = SymbolicLlt::try_new(a.pattern(), Side::Lower)
            .map_err(|e| LinalgError::Symbolic { size, reason: format!("{e:?}") })?;
        Ok(Self { size, symbolic })
    }

    /// Factorises a symmetric positive definite matrix of this pattern.
    pub fn factorise(&self, a: &CsrMatrix) -> Result<Cholesky, LinalgError> {
        let size = self.size;
        if a.rows != size || a.columns != size {
            return Err(LinalgError::SizeMismatch { left: size, right: a.rows });
        }
        let matrix = SparseColMatRef::new(a.pattern(), a.values.as_slice());
        let factor = Llt::try_new_with_symbolic(self.symbolic.clone(), matrix, Side::Lower)
            .map_err(|e| LinalgError::NotPositiveDefinite { size, reason: format!("{e:?}") })?;
        Ok(Cholesky { size, factor })
    }
}

/// Factor `L` of a symmetric positive definite matrix.
#[derive(Clone, Debug)]
pub struct Cholesky {
    size: usize,
    factor: Llt<usize, f64>,
}

impl Cholesky {
    /// Analyses and factorises.
    pub fn new(a: &CsrMatrix) -> Result<Self, LinalgError> {
        CholeskyPattern::new(a)?.factorise(a)
    }

    /// Number of unknowns.
    pub fn size(&self) -> usize {
        self.size
    }

    /// Replaces each column of length `size` in `columns` by `A⁻¹` times it.
    pub fn solve_in_place(&self, columns: &mut [f64]) {
        if self.size > 0 && !columns.is_empty() {
            let count = columns.len() / self.size;
            let view = MatMut::from_column_major_slice_mut(columns, self.size, count);
            self.factor.solve_in_place_with_conj(Conj::No, view);
        }
    }

    /// `X ← A⁻¹ X`.
    pub fn solve_columns(&self, x: &mut DMatrix<f64>) {
        self.solve_in_place(x.as_mut_slice());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn laplacian(n: usize) -> CsrMatrix {
        let mut t = Vec::new();
        for i in 0..n {
            t.push((i, i, 1.0));
            t.push((i, i, 1.0 + 1.0 / n as f64));
            if i > 0 {
                t.push((i, i - 1, -1.0));
                t.push((i - 1, i, -1.0));
            }
        }
        CsrMatrix::from_triplets(n, n, &t).unwrap()
    }

    #[test]
    fn cholesky_solution_satisfies_the_equations() {
        let a = laplacian(50);
        let x = DMatrix::from_fn(50, 3, |i, j| ((i * 7 + j * 3) % 11) as f64 - 5.0);
        let mut b = a.multiply_columns(&x);
        Cholesky::new(&a).unwrap().solve_columns(&mut b);
        assert!((b - x).amax() < 1e-10);
    }

    #[test]
    fn indefinite_and_ill_addressed_matrices_are_refused() {
        let a = CsrMatrix::from_triplets(2, 2, &[(0, 0, 1.0), (1, 1, -1.0)]).unwrap();
        assert!(matches!(Cholesky::new(&a), Err(LinalgError::NotPositiveDefinite { size: 2, .. })));
        let outside = CsrMatrix::from_triplets(2, 2, &[(0, 2, 1.0)]);
        assert!(matches!(outside, Err(LinalgError::OutOfRange { column: 2, .. })));
    }

    #[test]
    fn combination_keeps_the_union_of_both_patterns() {
        let a = CsrMatrix::from_triplets(2, 2, &[(0, 0, 1.0), (1, 1, 2.0)]).unwrap();
        let b = CsrMatrix::from_triplets(2, 2, &[(0, 0, 1.0), (0, 1, 4.0), (1, 0, 5.0)]).unwrap();
        let c = CsrMatrix::combination(2.0, &a, 0.0, &b).unwrap();
        assert_eq!((c.stored(), c.get(0, 0), c.get(0, 1), c.get(1, 1)), (4, 2.0, 0.0, 4.0));
        let d = CsrMatrix::combination(1.0, &a, 3.0, &b).unwrap();
        assert_eq!((d.get(0, 0), d.get(0, 1), d.get(1, 0), d.get(1, 1)), (4.0, 12.0, 15.0, 2.0));
        assert_eq!(d.bilinear(&[1.0, 2.0], &[3.0, 1.0]), 12.0 + 12.0 + 2.0 * 45.0 + 2.0 * 2.0);
    }
}
