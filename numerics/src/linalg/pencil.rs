//! All eigenpairs of a small dense symmetric pencil with 32 digits.
//!
//! For pencils whose eigenvalues span so many decades that the smallest drown in the round-off of the largest. Only the
//! scalar type is that of faer: its routines multiply matrices in blocks, and version 0.24.4 panics there for this
//! type.

use super::LinalgError;
use super::vectorised::vectorised;
use qd::simd::{add_estimate, mul, sub_estimate};

/// A number of 32 digits.
pub use qd::Quad as Wide;

/// A double as a number of 32 digits.
pub fn wide(value: f64) -> Wide {
    Wide::from_f64(value)
}

/// The nearest double.
pub fn narrow(value: Wide) -> f64 {
    value.0 + value.1
}

/// Eigenpairs `K φ = λ M φ` with `Φᵀ M Φ = 1`, λ ascending.
#[derive(Clone, Debug)]
pub struct WideModes {
    /// Eigenvalues λ, ascending.
    pub values: Vec<Wide>,
    /// Row-major, one eigenvector per column.
    pub shapes: Vec<Wide>,
}

/// All eigenpairs of `K φ = λ M φ`: `mass` is positive definite, both are symmetric, row-major and of `size` rows.
///
/// With the Cholesky factor `M = L Lᵀ` they are those of `L⁻¹ K L⁻ᵀ`. Fails for an indefinite mass, and if the
/// iteration does not converge.
pub fn wide_modes(mass: &[Wide], stiffness: &[Wide], size: usize) -> Result<WideModes, LinalgError> {
    let factor = cholesky(mass, size)?;
    let mut matrix = stiffness.to_vec();
    // L⁻¹ K, then the same on the transposed result.
    for _ in 0..2 {
        solve_lower(&factor, &mut matrix, size);
        for i in 0..size {
            for j in 0..i {
                matrix.swap(i * size + j, j * size + i);
            }
        }
    }
    let mut shapes = jacobi(&mut matrix, size).ok_or(LinalgError::Eigen { size })?;
    solve_upper(&factor, &mut shapes, size);
    let mut order: Vec<usize> = (0..size).collect();
    order.sort_by(|&i, &j| matrix[i * size + i].0.total_cmp(&matrix[j * size + j].0));
    let sorted = |row: &[Wide]| -> Vec<Wide> { order.iter().map(|&column| row[column]).collect() };
    Ok(WideModes {
        values: order.iter().map(|&i| matrix[i * size + i]).collect(),
        shapes: shapes.chunks_exact(size).flat_map(sorted).collect(),
    })
}

/// `L` of `M = L Lᵀ`.
fn cholesky(mass: &[Wide], size: usize) -> Result<Vec<Wide>, LinalgError> {
    let mut factor = vec![Wide::ZERO; size * size];
    for i in 0..size {
        for j in 0..=i {
            let mut sum = mass[i * size + j];
            for l in 0..j {
                sum -= factor[i * size + l] * factor[j * size + l];
            }
            if i != j {
                factor[i * size + j] = sum / factor[j * size + j];
            } else if sum.0 > 0.0 {
                factor[i * size + i] = sum.sqrt();
            } else {
                let reason = format!("pivot {i} is {:e}", sum.0);
                return Err(LinalgError::NotPositiveDefinite { size, reason });
            }
        }
    }
    Ok(factor)
}

/// `X ← L⁻¹ X`.
fn solve_lower(factor: &[Wide], matrix: &mut [Wide], size: usize) {
    for column in 0..size {
        for i in 0..size {
            let mut sum = matrix[i * size + column];
            for l in 0..i {
                sum -= factor[i * size + l] * matrix[l * size + column];
            }
            matrix[i * size + column] = sum / factor[i * size + i];
        }
    }
}

/// `X ← L⁻ᵀ X`.
fn solve_upper(factor: &[Wide], matrix: &mut [Wide], size: usize) {
    for column in 0..size {
        for i in (0..size).rev() {
            let mut sum = matrix[i * size + column];
            for l in i + 1..size {
                sum -= factor[l * size + i] * matrix[l * size + column];
            }
            matrix[i * size + column] = sum / factor[i * size + i];
        }
    }
}

/// Rows of numbers of 32 digits: their leading parts and the rest, each as long as fills whole vector registers.
struct WideRows {
    stride: usize,
    high: Vec<f64>,
    low: Vec<f64>,
}

/// Length of rows is a multiple of this.
const PADDED: usize = 8;

impl WideRows {
    /// `count` rows of as many zeros.
    fn square(count: usize) -> Self {
        let stride = count.next_multiple_of(PADDED);
        Self { stride, high: vec![0.0; count * stride], low: vec![0.0; count * stride] }
    }

    fn get(&self, i: usize, j: usize) -> Wide {
        let at = i * self.stride + j;
        Wide(self.high[at], self.low[at])
    }

    fn set(&mut self, i: usize, j: usize, value: Wide) {
        let at = i * self.stride + j;
        (self.high[at], self.low[at]) = (value.0, value.1);
    }

    /// Rotates row `p` and a later one: `(c x − s y, s x + c y)`.
    fn rotate(&mut self, p: usize, q: usize, rotation: [Wide; 2]) {
        let width = self.stride;
        let rows = [&mut self.high, &mut self.low].map(|values| {
            let (before, from) = values.split_at_mut(q * width);
            [&mut before[p * width..(p + 1) * width], &mut from[..width]]
        });
        rotate(rotation, rows);
    }
}

vectorised! {
    /// `(x, y) ← (c x − s y, s x + c y)` for the rotation `[c, s]`; the leading parts of both rows, and the rest of
    /// both.
    fn rotate<'a, S>(simd, rotation: [Wide; 2], rows: [[&'a mut [f64]; 2]; 2]) {
        let [c, s] = rotation.map(|value| Wide(simd.splat_f64s(value.0), simd.splat_f64s(value.1)));
        let [[x, y], [x_low, y_low]] = rows.map(|pair| pair.map(|row| S::as_mut_simd_f64s(row).0));
        for ((x, x_low), (y, y_low)) in x.iter_mut().zip(x_low).zip(y.iter_mut().zip(y_low)) {
            let (a, b) = (Wide(*x, *x_low), Wide(*y, *y_low));
            let first = sub_estimate(simd, mul(simd, c, a), mul(simd, s, b));
            let second = add_estimate(simd, mul(simd, s, a), mul(simd, c, b));
            (*x, *x_low, *y, *y_low) = (first.0, first.1, second.0, second.1);
        }
    }
}

/// Cyclic Jacobi iteration (Golub & Van Loan, *Matrix Computations*, 4th ed., 8.5): leaves the eigenvalues on the
/// diagonal of `matrix` and returns the eigenvectors as columns; `None` without convergence.
fn jacobi(matrix: &mut [Wide], n: usize) -> Option<Vec<Wide>> {
    const SWEEPS: usize = 60;
    let (mut a, mut vectors) = (WideRows::square(n), WideRows::square(n));
    for i in 0..n {
        vectors.set(i, i, Wide::ONE);
        (0..n).for_each(|j| a.set(i, j, matrix[i * n + j]));
    }
    // Entries at the round-off of the matrix are zero, whatever the diagonal (eigenvalue zero of an insulated body).
    let floor = 1e-31 * (0..n).map(|i| a.get(i, i).0).fold(0.0, f64::max);
    for _ in 0..SWEEPS {
        let mut largest: f64 = 0.0;
        for p in 0..n {
            for q in p + 1..n {
                let size = a.get(p, q).0.abs();
                let scale = (a.get(p, p).0.abs() * a.get(q, q).0.abs()).sqrt();
                if size <= floor.max(1e-28 * scale) {
                    continue;
                }
                largest = largest.max(size / scale.max(floor));
                let rotation = annihilate(&mut a, p, q);
                vectors.rotate(p, q, rotation);
            }
        }
        if largest.is_nan() {
            return None;
        }
        if largest < 1e-20 {
            (0..n).for_each(|i| matrix[i * (n + 1)] = a.get(i, i));
            return Some((0..n * n).map(|at| vectors.get(at % n, at / n)).collect());
        }
    }
    None
}

/// Turns the rows and columns `p` and `q` of a symmetric matrix until their common entry is zero; `[c, s]` of the
/// rotation.
fn annihilate(a: &mut WideRows, p: usize, q: usize) -> [Wide; 2] {
    let theta = (a.get(q, q) - a.get(p, p)) / (wide(2.0) * a.get(p, q));
    let root = (theta * theta + Wide::ONE).sqrt();
    let t = if theta.0 >= 0.0 { Wide::ONE / (theta + root) } else { Wide::ONE / (theta - root) };
    let c = Wide::ONE / (t * t + Wide::ONE).sqrt();
    let s = t * c;
    a.rotate(p, q, [c, s]);
    // Now the columns: those of the other rows are what their rows have become.
    let [pp, pq, qp, qq] = [(p, p), (p, q), (q, p), (q, q)].map(|(i, j)| a.get(i, j));
    a.set(p, p, c * pp - s * pq);
    a.set(q, q, s * qp + c * qq);
    a.set(p, q, Wide::ZERO);
    a.set(q, p, Wide::ZERO);
    let rows = a.high.len() / a.stride;
    for l in (0..rows).filter(|&l| l != p && l != q) {
        a.set(l, p, a.get(p, l));
        a.set(l, q, a.get(q, l));
    }
    [c, s]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn matrix(n: usize, entry: impl Fn(usize, usize) -> Wide) -> Vec<Wide> {
        (0..n * n).map(|at| entry(at / n, at % n)).collect()
    }

    fn product(n: usize, a: &[Wide], b: &[Wide]) -> Vec<Wide> {
        matrix(n, |i, j| (0..n).fold(Wide::ZERO, |sum, l| sum + a[i * n + l] * b[l * n + j]))
    }

    #[test]
    fn eigenvalues_over_twelve_decades_keep_the_digits_of_a_double() {
        // K = Q D Q with a Householder reflection Q, M = 1: the eigenvalues are D.
        let n = 40;
        let exact: Vec<f64> = (0..n).map(|i| 10f64.powf(-2.0 + 12.0 * i as f64 / (n - 1) as f64)).collect();
        let v: Vec<Wide> = (0..n).map(|i| wide(1.0 + (i as f64).sin())).collect();
        let length = v.iter().fold(Wide::ZERO, |sum, v| sum + *v * *v);
        let unit = |i: usize, j: usize| wide(f64::from(u8::from(i == j)));
        let q = matrix(n, |i, j| unit(i, j) - wide(2.0) * v[i] * v[j] / length);
        let d = matrix(n, |i, j| wide(exact[i]) * unit(i, j));
        let modes = wide_modes(&matrix(n, unit), &product(n, &product(n, &q, &d), &q), n).unwrap();
        for (found, exact) in modes.values.iter().zip(&exact) {
            assert!((narrow(*found) / exact - 1.0).abs() < 1e-14, "{} for {exact}", narrow(*found));
        }
    }

    #[test]
    fn shapes_are_orthonormal_in_the_mass_and_diagonalise_the_stiffness() {
        let n = 25;
        let band = |main: f64, side: f64| {
            matrix(n, |i, j| match i.abs_diff(j) {
                0 => wide(main * (1.0 + i as f64)),
                1 => wide(side),
                _ => Wide::ZERO,
            })
        };
        let (mass, stiffness) = (band(4.0, 1.0), band(2.0, -1.0));
        let modes = wide_modes(&mass, &stiffness, n).unwrap();
        let transposed = matrix(n, |i, j| modes.shapes[j * n + i]);
        let unit = product(n, &product(n, &transposed, &mass), &modes.shapes);
        let ritz = product(n, &product(n, &transposed, &stiffness), &modes.shapes);
        for i in 0..n {
            for j in 0..n {
                let one = if i == j { 1.0 } else { 0.0 };
                assert!((unit[i * n + j] - wide(one)).0.abs() < 1e-29);
                assert!((ritz[i * n + j] - modes.values[i] * wide(one)).0.abs() < 1e-19);
            }
        }
        assert!(modes.values.windows(2).all(|v| v[0].0 <= v[1].0));
    }

    #[test]
    fn an_indefinite_mass_is_refused() {
        let mass = matrix(2, |i, j| wide(if i == j { 1.0 - 2.0 * i as f64 } else { 0.0 }));
        assert!(matches!(wide_modes(&mass, &mass, 2), Err(LinalgError::NotPositiveDefinite { .. })));
    }
}
