//! Small dense matrices: systems solved over and over in buffers that are kept, and exact symmetry.

use super::vectorised::vectorised;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::lu::partial_pivoting::factor::{self, PartialPivLuParams};
use faer::{Auto, MatMut, Par, Spec};
use nalgebra::DMatrix;

/// Factorises column by column, without products of blocks: those keep a buffer with a destructor in the thread that
/// asks for them, which would hold a library of an FMU loaded as long as the thread of its master lives.
fn by_columns() -> Spec<PartialPivLuParams, f64> {
    Spec::new(PartialPivLuParams { recursion_threshold: usize::MAX, ..<PartialPivLuParams as Auto<f64>>::auto() })
}

/// A square system `A x = b`, filled row by row and solved by LU factorisation with partial pivoting.
///
/// Once the buffers have the size of the largest system, nothing is allocated any more.
#[derive(Default)]
pub struct DenseSystem {
    size: usize,
    /// Rows of `A`, one after the other; overwritten by the factors of `Aᵀ`.
    rows: Vec<f64>,
    rhs: Vec<f64>,
    permuted: Vec<f64>,
    permutation: [Vec<usize>; 2],
    stack: Option<MemBuffer>,
    /// Size for which `stack` suffices.
    prepared: usize,
}

impl DenseSystem {
    /// Starts a system of `size` unknowns with zero matrix and right-hand side.
    pub fn reset(&mut self, size: usize) {
        self.size = size;
        self.rows.clear();
        self.rows.resize(size * size, 0.0);
        self.rhs.clear();
        self.rhs.resize(size, 0.0);
    }

    /// Row `i` of the matrix, and its right-hand side.
    pub fn row(&mut self, i: usize) -> (&mut [f64], &mut f64) {
        (&mut self.rows[i * self.size..(i + 1) * self.size], &mut self.rhs[i])
    }

    /// Solves the system, which is used up; `None` if the matrix is singular or the solution is not finite.
    pub fn solve(&mut self) -> Option<&[f64]> {
        let mut rhs = std::mem::take(&mut self.rhs);
        let solved = self.factorise() && self.solve_with(&mut rhs);
        self.rhs = rhs;
        solved.then_some(&self.rhs)
    }

    /// Replaces the matrix by its factors; whether they are finite.
    pub fn factorise(&mut self) -> bool {
        let n = self.size;
        if n == 0 {
            return true;
        }
        if self.stack.is_none() || self.prepared < n {
            let factor = factor::lu_in_place_scratch::<usize, f64>(n, n, Par::Seq, by_columns());
            self.stack = Some(MemBuffer::new(factor));
            self.prepared = n;
        }
        let [forward, inverse] = &mut self.permutation;
        forward.resize(n, 0);
        inverse.resize(n, 0);
        let Some(stack) = &mut self.stack else { return false };
        // Rows of A in memory are columns of Aᵀ, which faer factorises; A x = b is then the transposed solve.
        let transposed = MatMut::from_column_major_slice_mut(&mut self.rows, n, n);
        let (forward, inverse) = (&mut forward[..n], &mut inverse[..n]);
        factor::lu_in_place(transposed, forward, inverse, Par::Seq, MemStack::new(stack), by_columns());
        (0..n).all(|i| self.rows[i * (n + 1)].is_finite())
    }

    /// `x ← A⁻¹ x` with the factors of [`Self::factorise`]; whether the result is finite.
    pub fn solve_with(&mut self, x: &mut [f64]) -> bool {
        // Aᵀ = P⁻¹ L U, so that A = Uᵀ Lᵀ P.
        substitute_transposed(&self.rows, x);
        self.permuted.clear();
        self.permuted.extend_from_slice(x);
        let [_, inverse] = &self.permutation;
        x.iter_mut().zip(inverse).for_each(|(x, &from)| *x = self.permuted[from]);
        x.iter().all(|x| x.is_finite())
    }
}

vectorised! {
    /// `x ← L⁻ᵀ U⁻ᵀ x` with the factors of a matrix, columns one after the other; the diagonal of L is 1.
    fn substitute_transposed<'a, S>(simd, factors: &'a [f64], x: &'a mut [f64]) {
        let n = x.len();
        let product = |a: &[f64], b: &[f64]| {
            let ((a, a_rest), (b, b_rest)) = (S::as_simd_f64s(a), S::as_simd_f64s(b));
            let zero = simd.splat_f64s(0.0);
            let sum = a.iter().zip(b).fold(zero, |sum, (&a, &b)| simd.mul_add_e_f64s(a, b, sum));
            simd.reduce_sum_f64s(sum) + a_rest.iter().zip(b_rest).map(|(a, b)| a * b).sum::<f64>()
        };
        for j in 0..n {
            let column = &factors[j * n..(j + 1) * n];
            x[j] = (x[j] - product(&column[..j], &x[..j])) / column[j];
        }
        for j in (0..n).rev() {
            let column = &factors[j * n..(j + 1) * n];
            x[j] -= product(&column[j + 1..], &x[j + 1..]);
        }
    }
}

/// Removes the round-off between `a_ij` and `a_ji`.
pub fn symmetrise(a: &mut DMatrix<f64>) {
    for i in 0..a.nrows() {
        for j in 0..i {
            let mean = 0.5 * (a[(i, j)] + a[(j, i)]);
            a[(i, j)] = mean;
            a[(j, i)] = mean;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Solves a system given by rows.
    fn solve<const N: usize>(system: &mut DenseSystem, rows: [[f64; N]; N], rhs: [f64; N]) -> Option<Vec<f64>> {
        system.reset(N);
        for i in 0..N {
            let (row, b) = system.row(i);
            row.copy_from_slice(&rows[i]);
            *b = rhs[i];
        }
        system.solve().map(<[f64]>::to_vec)
    }

    #[test]
    fn systems_of_changing_size_are_solved_in_the_same_buffers() {
        let mut system = DenseSystem::default();
        // The first pivot is zero: rows must be exchanged.
        let x = solve(&mut system, [[0.0, 2.0, 1.0], [1.0, -1.0, 0.0], [3.0, 0.5, -2.0]], [7.0, -1.0, -2.0]).unwrap();
        assert!(x.iter().zip([1.0, 2.0, 3.0]).all(|(x, exact)| (x - exact).abs() < 1e-14), "{x:?}");
        assert_eq!(solve(&mut system, [[4.0]], [2.0]), Some(vec![0.5]));
        assert_eq!(solve(&mut system, [], []), Some(vec![]));
        let x = solve(&mut system, [[2.0, 1.0], [1.0, 3.0]], [3.0, 5.0]).unwrap();
        assert!((x[0] - 0.8).abs() < 1e-15 && (x[1] - 1.4).abs() < 1e-15);
    }

    #[test]
    fn a_singular_system_has_no_solution() {
        assert_eq!(solve(&mut DenseSystem::default(), [[1.0, 2.0], [2.0, 4.0]], [1.0, 1.0]), None);
        assert_eq!(solve(&mut DenseSystem::default(), [[0.0]], [1.0]), None);
    }
}
