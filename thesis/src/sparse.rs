//! Sparse systems without symmetry: convection makes every matrix of this crate unsymmetric.
//!
//! The product needs Cholesky factors only. The LU factorisation therefore stays here, over the same library.

use crate::Error;
use faer::MatMut;
use faer::linalg::solvers::Solve;
use faer::sparse::linalg::solvers::Lu;
use faer::sparse::{SparseColMat, SymbolicSparseColMat};

/// A square matrix as a list of entries; equal positions add up.
#[derive(Clone, Debug, Default)]
pub struct Matrix {
    /// Number of rows and columns.
    pub size: usize,
    /// Row, column and value of each entry.
    pub entries: Vec<(usize, usize, f64)>,
}

impl Matrix {
    /// The zero matrix.
    pub fn new(size: usize) -> Self {
        Self { size, entries: Vec::new() }
    }

    /// Adds to one entry.
    pub fn add(&mut self, row: usize, column: usize, value: f64) {
        self.entries.push((row, column, value));
    }

    /// Sum of matrices of one size, each times its factor, compressed.
    pub fn sum(parts: &[(f64, &Self)]) -> Self {
        let size = parts.iter().map(|(_, part)| part.size).max().unwrap_or_default();
        let scaled = |(factor, part): &(f64, &Self)| {
            let factor = *factor;
            part.entries.iter().map(|(i, j, value)| (*i, *j, factor * value)).collect::<Vec<_>>()
        };
        Self { size, entries: parts.iter().flat_map(scaled).collect() }.compressed()
    }

    /// Matrix with one entry for each position, row by row.
    pub fn compressed(self) -> Self {
        let by_columns = sorted(&self.entries, self.size, |entry| entry.1);
        let mut entries = sorted(&by_columns, self.size, |entry| entry.0);
        entries.dedup_by(|next, kept| {
            let same = (next.0, next.1) == (kept.0, kept.1);
            kept.2 += if same { next.2 } else { 0.0 };
            same
        });
        entries.retain(|entry| entry.2 != 0.0);
        Self { size: self.size, entries }
    }

    /// `A x`.
    pub fn multiply(&self, x: &[f64]) -> Vec<f64> {
        let mut y = vec![0.0; self.size];
        for &(row, column, value) in &self.entries {
            y[row] += value * x[column];
        }
        y
    }

    /// Replaces the rows of `fixed` by those of the identity. Returns the former rows: times the solution, less the
    /// former load, they are what holds the fixed unknowns.
    pub fn fix(&mut self, fixed: &[usize]) -> Self {
        let mut is_fixed = vec![false; self.size];
        fixed.iter().for_each(|row| is_fixed[*row] = true);
        let held = self.entries.extract_if(.., |entry| is_fixed[entry.0]).collect();
        self.entries.extend(fixed.iter().map(|row| (*row, *row, 1.0)));
        Self { size: self.size, entries: held }
    }

    /// LU factors with partial pivoting, of rows whose largest entries are one: pivots are chosen by size, and a row
    /// that fixes a temperature is to count as much as one of a strong stream. Without that the heat of an annulus
    /// balances a hundred times worse.
    pub fn factorise(&self) -> Result<Factors, Error> {
        let singular = |reason: String| Error::Singular { size: self.size, reason };
        let mut largest = vec![0.0_f64; self.size];
        self.entries.iter().for_each(|(row, _, value)| largest[*row] = largest[*row].max(value.abs()));
        let scale: Vec<f64> = largest.iter().map(|most| if *most > 0.0 { most.recip() } else { 1.0 }).collect();
        let transposed = self.entries.iter().map(|&(row, column, value)| (column, row, value * scale[row])).collect();
        let Self { entries, .. } = Self { size: self.size, entries: transposed }.compressed();
        let mut starts = vec![0; self.size + 1];
        entries.iter().for_each(|(column, ..)| starts[column + 1] += 1);
        (0..self.size).for_each(|column| starts[column + 1] += starts[column]);
        let rows = entries.iter().map(|(_, row, _)| *row).collect();
        let values = entries.iter().map(|(.., value)| *value).collect();
        let pattern = SymbolicSparseColMat::new_checked(self.size, self.size, starts, None, rows);
        let matrix = SparseColMat::new(pattern, values);
        let lu = matrix.sp_lu().map_err(|error| singular(format!("{error:?}")))?;
        Ok(Factors { size: self.size, scale, lu })
    }
}

/// Factors of a [`Matrix`].
pub struct Factors {
    size: usize,
    /// By what each row was multiplied.
    scale: Vec<f64>,
    lu: Lu<usize, f64>,
}

impl Factors {
    /// `A⁻¹` times each column of length `size` in `columns`; an error where a result is not finite.
    pub fn solve(&self, mut columns: Vec<f64>) -> Result<Vec<f64>, Error> {
        let count = columns.len() / self.size;
        for column in columns.chunks_mut(self.size.max(1)) {
            column.iter_mut().zip(&self.scale).for_each(|(value, scale)| *value *= scale);
        }
        self.lu.solve_in_place(MatMut::from_column_major_slice_mut(&mut columns, self.size, count));
        if columns.iter().all(|value| value.is_finite()) {
            Ok(columns)
        } else {
            Err(Error::Singular { size: self.size, reason: "the solution is not finite".into() })
        }
    }
}

/// Entries in the order of their keys, which are below `size`; those of one key stay in their order. The time is linear
/// in both.
fn sorted(
    entries: &[(usize, usize, f64)],
    size: usize,
    key: impl Fn(&(usize, usize, f64)) -> usize,
) -> Vec<(usize, usize, f64)> {
    let mut next = vec![0; size + 1];
    entries.iter().for_each(|entry| next[key(entry) + 1] += 1);
    (0..size).for_each(|i| next[i + 1] += next[i]);
    let mut sorted = vec![(0, 0, 0.0); entries.len()];
    for entry in entries {
        let place = &mut next[key(entry)];
        sorted[*place] = *entry;
        *place += 1;
    }
    sorted
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Unsymmetric, with zeros on the diagonal, so that only pivoting solves it.
    fn circulant(n: usize) -> Matrix {
        let mut matrix = Matrix::new(n);
        for i in 0..n {
            matrix.add(i, (i + 1) % n, 3.0);
            matrix.add(i, (i + 2) % n, 0.5);
            matrix.add(i, (i + 2) % n, 0.5);
            matrix.add(i, (i + n - 1) % n, -1.0);
        }
        matrix
    }

    #[test]
    fn lu_solves_unsymmetric_systems_with_zeros_on_the_diagonal() {
        let matrix = circulant(60);
        let x: Vec<f64> = (0..120).map(|i| ((i * 7) % 11) as f64 - 5.0).collect();
        let b = [matrix.multiply(&x[..60]), matrix.multiply(&x[60..])].concat();
        let found = matrix.factorise().unwrap().solve(b).unwrap();
        let error = found.iter().zip(&x).fold(0.0_f64, |worst, (a, b)| worst.max((a - b).abs()));
        println!("error {error:.1e}");
        assert!(error < 1e-12);
    }

    #[test]
    fn singular_matrices_are_refused() {
        let mut matrix = Matrix::new(3);
        for i in 0..3 {
            matrix.add(i, 0, 1.0);
            matrix.add(i, 1, 2.0);
            matrix.add(i, 2, 3.0);
        }
        let outcome = matrix.factorise().and_then(|factors| factors.solve(vec![1.0, 2.0, 4.0]));
        assert!(matches!(outcome, Err(Error::Singular { size: 3, .. })));
    }

    /// A row of springs, both ends held and one of them displaced: what holds the ends is the one force that all carry,
    /// in balance, however stiff they are.
    #[test]
    fn rows_that_were_fixed_give_the_forces_that_hold_what_they_fix() {
        for stiffness in [1e-11, 1.0, 1e11] {
            let n = 40;
            let springs: Vec<f64> = (0..n - 1).map(|i| stiffness * (1.0 + ((i * 7) % 11) as f64)).collect();
            let mut matrix = Matrix::new(n);
            for (i, spring) in springs.iter().enumerate() {
                for (row, column, sign) in [(i, i, 1.0), (i + 1, i + 1, 1.0), (i, i + 1, -1.0), (i + 1, i, -1.0)] {
                    matrix.add(row, column, sign * spring);
                }
            }
            let rows = matrix.fix(&[0, n - 1]);
            let mut right = vec![0.0; n];
            (right[0], right[n - 1]) = (0.1, 0.3);
            let found = matrix.factorise().unwrap().solve(right).unwrap();
            let (held, force) = (rows.multiply(&found), 0.2 / springs.iter().map(|spring| spring.recip()).sum::<f64>());
            println!("{stiffness:e} N/m: {:.1e}, {:.1e}", held[0] / force + 1.0, held[n - 1] / force - 1.0);
            assert!((held[0] / force + 1.0).abs() < 1e-12 && (held[n - 1] / force - 1.0).abs() < 1e-12);
            assert!(held[1..n - 1].iter().all(|force| *force == 0.0));
        }
    }

    #[test]
    fn fixed_rows_return_their_values() {
        let mut matrix = circulant(5);
        matrix.fix(&[2]);
        let x = matrix.factorise().unwrap().solve(vec![1.0, 0.0, 7.0, 0.0, 2.0]).unwrap();
        assert!((x[2] - 7.0).abs() < 1e-14);
    }
}
