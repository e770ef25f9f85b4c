//! Sparse matrices by rows.

use super::LinalgError;
use super::vectorised::add_multiples;
use faer::sparse::SymbolicSparseColMatRef;
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
        Ok(Self::from_rows([rows, columns, sorted.len()], |i, row| {
            row.extend_from_slice(&sorted[ends[i]..ends[i + 1]])
        }))
    }

    /// A matrix with numbers of rows and columns and room for entries, whose rows are given one after the other: `fill` appends the entries of a row to an empty list, in any
    /// order; equal columns add up in the order given.
    pub(super) fn from_rows(
        [rows, columns, room]: [usize; 3],
        mut fill: impl FnMut(usize, &mut Vec<(usize, f64)>),
    ) -> Self {
        let (mut starts, mut row) = (Vec::with_capacity(rows + 1), Vec::new());
        let (mut indices, mut values) = (Vec::<usize>::with_capacity(room), Vec::<f64>::with_capacity(room));
        starts.push(0);
        for i in 0..rows {
            row.clear();
            fill(i, &mut row);
            row.sort_by_key(|entry| entry.0);
            let first = indices.len();
            for &(column, value) in &row {
                match values.last_mut().filter(|_| indices.len() > first && indices.last() == Some(&column)) {
                    Some(last) => *last += value,
                    None => {
                        indices.push(column);
                        values.push(value);
                    }
                }
            }
            starts.push(indices.len());
        }
        Self { rows, columns, starts, indices, values }
    }

    /// A square matrix with the columns `columns[starts[i]..starts[i + 1]]` in row `i`, ascending; zeros are left out.
    pub fn from_pattern(rows: usize, starts: &[usize], columns: &[usize], values: &[f64]) -> Self {
        let stored = values.iter().filter(|value| **value != 0.0).count();
        let (mut indices, mut kept, mut ends) = (Vec::with_capacity(stored), Vec::with_capacity(stored), vec![0]);
        for row in starts.windows(2) {
            for at in (row[0]..row[1]).filter(|&at| values[at] != 0.0) {
                indices.push(columns[at]);
                kept.push(values[at]);
            }
            ends.push(indices.len());
        }
        Self { rows, columns: rows, starts: ends, indices, values: kept }
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
        self.multiply_into(x.as_slice(), y.as_mut_slice());
        y
    }

    /// `Y ← A X` for columns one after the other.
    pub(super) fn multiply_into(&self, x: &[f64], y: &mut [f64]) {
        if self.rows == 0 || self.columns == 0 {
            return y.fill(0.0);
        }
        let (eight, mut lines) = (8 * self.columns, Vec::new());
        let (mut x, mut y) = (x, y);
        while x.len() > eight / 2 {
            let (some, others) = x.split_at(x.len().min(eight));
            let (product, further) = std::mem::take(&mut y).split_at_mut(some.len() / self.columns * self.rows);
            self.multiply_together::<8>(some, product, &mut lines);
            (x, y) = (others, further);
        }
        if !x.is_empty() {
            self.multiply_together::<4>(x, y, &mut Vec::new());
        }
    }

    /// `Y ← A X` for at most `W` columns one after the other, whose entries are put side by side in `lines`.
    fn multiply_together<const W: usize>(&self, x: &[f64], y: &mut [f64], lines: &mut Vec<[f64; W]>) {
        lines.resize(self.columns, [0.0; W]);
        for (k, column) in x.chunks(self.columns).enumerate() {
            lines.iter_mut().zip(column).for_each(|(line, value)| line[k] = *value);
        }
        pulp::Arch::new().dispatch(BlockProduct { matrix: self, lines, y });
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

    /// The stored values, row by row.
    pub(super) fn values(&self) -> &[f64] {
        &self.values
    }

    /// The stored pattern read by columns: for a symmetric matrix the same thing as by rows.
    pub(super) fn pattern(&self) -> SymbolicSparseColMatRef<'_, usize> {
        SymbolicSparseColMatRef::new_checked(self.rows, self.columns, &self.starts, None, &self.indices)
    }
}

/// The product of a matrix with some columns.
struct BlockProduct<'a, const W: usize> {
    matrix: &'a CsrMatrix,
    /// Entries of the columns, side by side.
    lines: &'a [[f64; W]],
    /// Columns of the product, one after the other, as many as wanted.
    y: &'a mut [f64],
}

impl<const W: usize> pulp::WithSimd for BlockProduct<'_, W> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, simd: S) {
        let Self { matrix: CsrMatrix { rows, starts, indices, values, .. }, lines, y } = self;
        for (i, window) in starts.windows(2).enumerate() {
            let mut sum = [0.0; W];
            let range = window[0]..window[1];
            for (&j, a) in indices[range.clone()].iter().zip(&values[range]) {
                add_multiples(simd, [*a], &[lines[j]], &mut sum);
            }
            for (column, sum) in y.chunks_mut(*rows).zip(sum) {
                column[i] = sum;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_outside_the_matrix_are_refused() {
        let outside = CsrMatrix::from_triplets(2, 2, &[(0, 2, 1.0)]);
        assert!(matches!(outside, Err(LinalgError::OutOfRange { column: 2, .. })));
    }

    #[test]
    fn products_with_many_columns_are_those_with_each() {
        let triplets: Vec<_> = (0..35).map(|k| ((5 * k) % 7, (3 * k) % 9, f64::from(k as u32) - 11.0)).collect();
        let a = CsrMatrix::from_triplets(7, 9, &triplets).unwrap();
        for columns in [1, 8, 19] {
            let x = DMatrix::from_fn(9, columns, |i, j| (3 * i + j) as f64 - 4.0);
            let product = a.multiply_columns(&x);
            for j in 0..columns {
                let mut y = [0.0; 7];
                a.multiply(&x.as_slice()[9 * j..9 * (j + 1)], &mut y);
                assert_eq!(product.column(j).as_slice(), y);
            }
        }
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
