//! Inverse of a symmetric positive definite matrix that grows and shrinks by rows at its end.

use super::vectorised::vectorised;

/// Rows that are multiplied at a time: they are filled up with zeros to a multiple of this length.
const BLOCK: usize = 4;

/// The lower triangular factor `W` of an inverse, `A⁻¹ = WᵀW`.
///
/// Its first n rows are the factor of the first n rows and columns of `A`. So one factor serves all leading parts, and
/// a row more costs n² operations. A row is computed from those before it, always in the same way: whatever came
/// before, the same matrix has the same bits.
#[derive(Clone, Debug, Default)]
pub struct InverseFactor {
    size: usize,
    /// The rows one after the other; a row of a block is as long as its last one.
    rows: Vec<f64>,
    /// The row that is being made, and products.
    row: Vec<f64>,
    product: Vec<f64>,
}

/// Where row `i` begins.
fn start(i: usize) -> usize {
    let (block, row) = (i / BLOCK, i % BLOCK);
    (block + 1) * (BLOCK * BLOCK * block / 2 + BLOCK * row)
}

impl InverseFactor {
    /// Rows of the matrix.
    pub fn size(&self) -> usize {
        self.size
    }

    /// Keeps the first `size` rows and columns of the matrix.
    pub fn truncate(&mut self, size: usize) {
        self.size = size.min(self.size);
        self.rows.truncate(start(self.size));
    }

    /// Adds a row and a column: the entries `beside` the diagonal, one for each row before, and the `diagonal` one.
    /// `None`, and nothing added, if the matrix is not positive definite.
    pub fn append(&mut self, beside: impl Iterator<Item = f64>, diagonal: f64) -> Option<()> {
        let n = self.size;
        let Self { rows, row, product, .. } = self;
        row.clear();
        row.extend(beside);
        debug_assert_eq!(row.len(), n);
        row.resize(n.next_multiple_of(BLOCK), 0.0);
        // The row of the Cholesky factor is W a, that of its inverse −Wᵀ (W a) over the pivot.
        multiply(rows, n, row, product);
        let pivot = (diagonal - product.iter().map(|l| l * l).sum::<f64>()).sqrt();
        if !(pivot > 0.0 && pivot.is_finite()) {
            return None;
        }
        multiply_transposed(rows, product, row);
        rows.extend(row[..n].iter().map(|value| -value / pivot));
        rows.push(1.0 / pivot);
        self.size = n + 1;
        rows.resize(start(self.size), 0.0);
        Some(())
    }

    /// `x ← A⁻¹ x` with the first rows and columns of `A`, as many as `x` has entries, which are at most all. `product`
    /// is memory for this.
    pub fn solve(&self, x: &mut Vec<f64>, product: &mut Vec<f64>) {
        let n = x.len().min(self.size);
        x.resize(n.next_multiple_of(BLOCK), 0.0);
        multiply(&self.rows, n, x, product);
        multiply_transposed(&self.rows, product, x);
        x.truncate(n);
    }
}

/// `y ← W x` with `n` rows; `x` is as long as the last one, and `y` becomes so with zeros.
fn multiply(rows: &[f64], n: usize, x: &[f64], y: &mut Vec<f64>) {
    y.clear();
    y.resize(x.len(), 0.0);
    multiply_rows(rows, x, &mut y[..n]);
}

vectorised! {
    fn multiply_rows<'a, S>(simd, rows: &'a [f64], x: &'a [f64], y: &'a mut [f64]) {
        let mut at = 0;
        for (block, y) in y.chunks_mut(BLOCK).enumerate() {
            let length = BLOCK * (block + 1);
            let x = S::as_simd_f64s(&x[..length]).0;
            if y.len() == BLOCK {
                let rows: [_; BLOCK] = std::array::from_fn(|r| S::as_simd_f64s(&rows[at + r * length..][..length]).0);
                let [a, b, c, d] = rows.map(|row| &row[..x.len()]);
                let mut sums = [simd.splat_f64s(0.0); BLOCK];
                for (k, &x) in x.iter().enumerate() {
                    sums[0] = simd.mul_add_e_f64s(a[k], x, sums[0]);
                    sums[1] = simd.mul_add_e_f64s(b[k], x, sums[1]);
                    sums[2] = simd.mul_add_e_f64s(c[k], x, sums[2]);
                    sums[3] = simd.mul_add_e_f64s(d[k], x, sums[3]);
                }
                y.iter_mut().zip(sums).for_each(|(y, sum)| *y = simd.reduce_sum_f64s(sum));
            } else {
                for (r, y) in y.iter_mut().enumerate() {
                    let row = S::as_simd_f64s(&rows[at + r * length..][..length]).0;
                    let zero = simd.splat_f64s(0.0);
                    let sum = row.iter().zip(x).fold(zero, |sum, (&w, &x)| simd.mul_add_e_f64s(w, x, sum));
                    *y = simd.reduce_sum_f64s(sum);
                }
            }
            at += BLOCK * length;
        }
    }
}

vectorised! {
    /// `x ← Wᵀ y`; zeros at the end of `y` stand for rows that are not there.
    fn multiply_transposed<'a, S>(simd, rows: &'a [f64], y: &'a [f64], x: &'a mut [f64]) {
        x.fill(0.0);
        let mut at = 0;
        for (block, y) in y.chunks(BLOCK).enumerate() {
            let length = BLOCK * (block + 1);
            let x = S::as_mut_simd_f64s(&mut x[..length]).0;
            let weights: [_; BLOCK] = std::array::from_fn(|r| simd.splat_f64s(y[r]));
            if rows.len() >= at + BLOCK * length {
                let rows: [_; BLOCK] = std::array::from_fn(|r| S::as_simd_f64s(&rows[at + r * length..][..length]).0);
                let [a, b, c, d] = rows.map(|row| &row[..x.len()]);
                for (k, x) in x.iter_mut().enumerate() {
                    let sum = simd.mul_add_e_f64s(weights[1], b[k], simd.mul_add_e_f64s(weights[0], a[k], *x));
                    *x = simd.mul_add_e_f64s(weights[3], d[k], simd.mul_add_e_f64s(weights[2], c[k], sum));
                }
            } else {
                for (row, weight) in rows[at.min(rows.len())..].chunks(length).zip(weights) {
                    let row = S::as_simd_f64s(row).0;
                    x.iter_mut().zip(row).for_each(|(x, &w)| *x = simd.mul_add_e_f64s(weight, w, *x));
                }
            }
            at += BLOCK * length;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Compliance of a line of points under a surface: as smooth as those of contacts.
    fn entry(i: usize, j: usize) -> f64 {
        5.0 - (0.3 + (i as f64 - j as f64).abs()).ln()
    }

    fn factor(size: usize) -> InverseFactor {
        let mut factor = InverseFactor::default();
        (0..size).for_each(|n| factor.append((0..n).map(|j| entry(n, j)), entry(n, n)).unwrap());
        factor
    }

    fn sides(n: usize) -> Vec<f64> {
        (0..n).map(|i| (1.3 * i as f64).sin() + 0.2).collect()
    }

    #[test]
    fn every_leading_part_is_solved() {
        let (factor, mut product) = (factor(43), Vec::new());
        for n in [0, 1, 2, 3, 4, 5, 8, 41, 42, 43] {
            let mut x = sides(n);
            factor.solve(&mut x, &mut product);
            assert_eq!(x.len(), n);
            let error = |(i, side): (usize, f64)| ((0..n).map(|j| entry(i, j) * x[j]).sum::<f64>() - side).abs();
            let worst = sides(n).into_iter().enumerate().map(error).fold(0.0, f64::max);
            assert!(worst < 1e-13, "{n}: {worst:e}");
        }
    }

    #[test]
    fn the_past_leaves_no_trace() {
        let (whole, mut grown, mut product) = (factor(42), factor(50), Vec::new());
        for n in [45, 7, 33, 2] {
            grown.truncate(n);
            (n..42).for_each(|k| grown.append((0..k).map(|j| entry(k, j)), entry(k, k)).unwrap());
            let [mut a, mut b] = [sides(42), sides(42)];
            whole.solve(&mut a, &mut product);
            grown.solve(&mut b, &mut product);
            assert_eq!((grown.size() >= 42, a), (true, b));
        }
    }

    #[test]
    fn a_matrix_that_is_not_positive_definite_does_not_grow() {
        let mut factor = factor(5);
        assert!(factor.append((0..5).map(|j| entry(4, j)), entry(4, 4) - 1e-3).is_none());
        assert!(factor.append([f64::NAN; 5].into_iter(), 1.0).is_none());
        let mut x = sides(5);
        factor.solve(&mut x, &mut Vec::new());
        assert!((factor.size(), x.iter().all(|x| x.is_finite())) == (5, true));
    }
}
