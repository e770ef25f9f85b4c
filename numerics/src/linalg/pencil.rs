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

/// All eigenpairs of `K φ = λ M φ`: `mass` is positive definite, both are symmetric, row-major and of `size` rows. A mass
/// with a narrow band takes less time.
///
/// With the Cholesky factor `M = L Lᵀ` they are those of `L⁻¹ K L⁻ᵀ`. Fails for an indefinite mass, and if the
/// iteration does not converge.
pub fn wide_modes(mass: &[Wide], stiffness: &[Wide], size: usize) -> Result<WideModes, LinalgError> {
    let factor = Factor::new(mass, size)?;
    let mut matrix = stiffness.to_vec();
    // L⁻¹ K, then the same on the transposed result.
    for _ in 0..2 {
        factor.solve_lower(&mut matrix);
        for i in 0..size {
            for j in 0..i {
                matrix.swap(i * size + j, j * size + i);
            }
        }
    }
    let (mut values, mut beside, mut vectors) = tridiagonal(&matrix, size);
    diagonalise(&mut values, &mut beside, &mut vectors).ok_or(LinalgError::Eigen { size })?;
    let mut shapes: Vec<Wide> = (0..size * size).map(|at| vectors.get(at % size, at / size)).collect();
    factor.solve_upper(&mut shapes);
    let mut order: Vec<usize> = (0..size).collect();
    order.sort_by(|&i, &j| values[i].0.total_cmp(&values[j].0));
    let sorted = |row: &[Wide]| -> Vec<Wide> { order.iter().map(|&column| row[column]).collect() };
    Ok(WideModes { values: sorted(&values), shapes: shapes.chunks_exact(size).flat_map(sorted).collect() })
}

/// `L` of `M = L Lᵀ`, row-major.
struct Factor {
    size: usize,
    /// First column of every row that is not zero, in `M` and in `L`.
    first: Vec<usize>,
    entries: Vec<Wide>,
    /// Reciprocals of the diagonal.
    inverse: Vec<Wide>,
}

impl Factor {
    fn new(mass: &[Wide], size: usize) -> Result<Self, LinalgError> {
        let begin = |(i, row): (usize, &[Wide])| row.iter().position(|entry| entry.0 != 0.0).unwrap_or(i).min(i);
        let first: Vec<usize> = mass.chunks_exact(size).enumerate().map(begin).collect();
        let mut entries = vec![Wide::ZERO; size * size];
        for i in 0..size {
            for j in first[i]..=i {
                let mut sum = mass[i * size + j];
                for l in first[i].max(first[j])..j {
                    sum -= entries[i * size + l] * entries[j * size + l];
                }
                if i != j {
                    entries[i * size + j] = sum / entries[j * size + j];
                } else if sum.0 > 0.0 && sum.0.is_finite() {
                    entries[i * size + i] = sum.sqrt();
                } else {
                    let reason = format!("pivot {i} is {:e}", sum.0);
                    return Err(LinalgError::NotPositiveDefinite { size, reason });
                }
            }
        }
        let inverse = (0..size).map(|i| Wide::ONE / entries[i * (size + 1)]).collect();
        Ok(Self { size, first, entries, inverse })
    }

    /// `X ← L⁻¹ X`.
    fn solve_lower(&self, matrix: &mut [Wide]) {
        let Self { size, first, entries, inverse } = self;
        for i in 0..*size {
            for column in 0..*size {
                let mut sum = matrix[i * size + column];
                for l in first[i]..i {
                    sum -= entries[i * size + l] * matrix[l * size + column];
                }
                matrix[i * size + column] = sum * inverse[i];
            }
        }
    }

    /// `X ← L⁻ᵀ X`.
    fn solve_upper(&self, matrix: &mut [Wide]) {
        let Self { size, first, entries, inverse } = self;
        for i in (0..*size).rev() {
            for column in 0..*size {
                let value = matrix[i * size + column] * inverse[i];
                matrix[i * size + column] = value;
                for l in first[i]..i {
                    matrix[l * size + column] -= entries[i * size + l] * value;
                }
            }
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

/// Turns a symmetric matrix by plane rotations until it is tridiagonal (Golub & Van Loan, *Matrix Computations*, 4th ed.,
/// 5.1 and 8.3): its diagonal, what stands beside it, and the rotation, whose rows are the new directions.
fn tridiagonal(matrix: &[Wide], n: usize) -> (Vec<Wide>, Vec<Wide>, WideRows) {
    let (mut a, mut vectors) = (WideRows::square(n), WideRows::square(n));
    for i in 0..n {
        vectors.set(i, i, Wide::ONE);
        (0..n).for_each(|j| a.set(i, j, matrix[i * n + j]));
    }
    for k in 0..n {
        for q in k + 2..n {
            let (kept, gone) = (a.get(k, k + 1), a.get(k, q));
            if gone.0 != 0.0 {
                let length = (kept * kept + gone * gone).sqrt();
                let rotation = [kept / length, -gone / length];
                turn(&mut a, k + 1, q, rotation);
                vectors.rotate(k + 1, q, rotation);
            }
        }
    }
    let beside = (1..n).map(|i| a.get(i - 1, i)).chain([Wide::ZERO]).collect();
    ((0..n).map(|i| a.get(i, i)).collect(), beside, vectors)
}

/// Turns the rows and columns `p` and `q` of a symmetric matrix.
fn turn(a: &mut WideRows, p: usize, q: usize, rotation: [Wide; 2]) {
    let [c, s] = rotation;
    a.rotate(p, q, rotation);
    // Now the columns: those of the other rows are what their rows have become.
    let [pp, pq, qp, qq] = [(p, p), (p, q), (q, p), (q, q)].map(|(i, j)| a.get(i, j));
    a.set(p, p, c * pp - s * pq);
    a.set(q, q, s * qp + c * qq);
    let across = s * pp + c * pq;
    a.set(p, q, across);
    a.set(q, p, across);
    let rows = a.high.len() / a.stride;
    for l in (0..rows).filter(|&l| l != p && l != q) {
        a.set(l, p, a.get(p, l));
        a.set(l, q, a.get(q, l));
    }
}

/// Iteration with implicit shifts by Wilkinson on a tridiagonal matrix (Golub & Van Loan, 8.3): leaves the eigenvalues on
/// its diagonal `d`, nothing in `e` beside it, and the eigenvectors in the rows of `vectors`; `None` without convergence.
fn diagonalise(d: &mut [Wide], e: &mut [Wide], vectors: &mut WideRows) -> Option<()> {
    const MOST: usize = 60;
    // Entries at the round-off of the matrix are zero, whatever the diagonal (eigenvalue zero of an insulated body).
    let floor = 1e-32 * d.iter().fold(0.0, |most: f64, d| most.max(d.0.abs()));
    for first in 0..d.len() {
        for round in 0.. {
            let small = |&i: &usize| e[i].0.abs() <= floor.max(1e-32 * (d[i].0.abs() + d[i + 1].0.abs()));
            let last = (first..d.len() - 1).find(small).unwrap_or(d.len() - 1);
            if last == first {
                break;
            }
            if round == MOST || !e[first].0.is_finite() {
                return None;
            }
            chase(d, e, [first, last], vectors);
        }
    }
    // What is no number may stand alone on the diagonal.
    d.iter().all(|d| d.0.is_finite()).then_some(())
}

/// One step of [`diagonalise`] on the rows from the first to the last.
fn chase(d: &mut [Wide], e: &mut [Wide], [first, last]: [usize; 2], vectors: &mut WideRows) {
    let half = (d[first + 1] - d[first]) / (wide(2.0) * e[first]);
    let root = (half * half + Wide::ONE).sqrt();
    let by = if half.0 >= 0.0 { half + root } else { half - root };
    let mut g = d[last] - d[first] + e[first] / by;
    let (mut s, mut c, mut moved) = (Wide::ONE, Wide::ONE, Wide::ZERO);
    for i in (first..last).rev() {
        let (f, b) = (s * e[i], c * e[i]);
        let length = (f * f + g * g).sqrt();
        e[i + 1] = length;
        if length.0 == 0.0 {
            // Falls into two parts here.
            d[i + 1] -= moved;
            e[last] = Wide::ZERO;
            return;
        }
        (s, c) = (f / length, g / length);
        g = d[i + 1] - moved;
        let turned = (d[i] - g) * s + wide(2.0) * c * b;
        moved = s * turned;
        d[i + 1] = g + moved;
        g = c * turned - b;
        vectors.rotate(i, i + 1, [c, s]);
    }
    d[first] -= moved;
    (e[first], e[last]) = (g, Wide::ZERO);
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

    /// Diagonal pencils, and ones with many equal eigenvalues, of which the rotations leave parts that do not know of each other.
    #[test]
    fn equal_eigenvalues_and_parts_apart_are_found() {
        let n = 12;
        let unit = |i: usize, j: usize| wide(f64::from(u8::from(i == j)));
        let diagonal = matrix(n, |i, j| wide((n - i / 3) as f64) * unit(i, j));
        let ones = matrix(n, |i, j| Wide::ONE + unit(i, j));
        for (stiffness, exact) in [
            (diagonal, vec![9.0, 9.0, 9.0, 10.0, 10.0, 10.0, 11.0, 11.0, 11.0, 12.0, 12.0, 12.0]),
            (ones, [vec![1.0; n - 1], vec![n as f64 + 1.0]].concat()),
        ] {
            let modes = wide_modes(&matrix(n, unit), &stiffness, n).unwrap();
            let transposed = matrix(n, |i, j| modes.shapes[j * n + i]);
            let ritz = product(n, &product(n, &transposed, &stiffness), &modes.shapes);
            for (at, entry) in ritz.iter().enumerate() {
                let expected = if at % (n + 1) == 0 { exact[at / n] } else { 0.0 };
                assert!((*entry - wide(expected)).0.abs() < 1e-29, "{at}: {entry:?}");
            }
        }
    }

    #[test]
    fn a_stiffness_without_numbers_has_no_modes() {
        let unit = |i: usize, j: usize| wide(f64::from(u8::from(i == j)));
        let stiffness = matrix(3, |_, _| wide(f64::NAN));
        assert!(matches!(wide_modes(&matrix(3, unit), &stiffness, 3), Err(LinalgError::Eigen { size: 3 })));
    }

    #[test]
    fn an_indefinite_mass_is_refused() {
        let mass = matrix(2, |i, j| wide(if i == j { 1.0 - 2.0 * i as f64 } else { 0.0 }));
        assert!(matches!(wide_modes(&mass, &mass, 2), Err(LinalgError::NotPositiveDefinite { .. })));
    }
}
