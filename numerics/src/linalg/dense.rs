//! Small dense matrices: systems solved over and over in buffers that are kept, and exact symmetry.

use super::vectorised::{BLOCK, by_blocks, load, vectorised};
use nalgebra::DMatrix;

/// A square system `A x = b`, filled row by row and solved by LU factorisation with partial pivoting: unknowns change
/// places, so that equations may have any scale. Systems of contact have some tens of unknowns: blocks, with which
/// libraries begin, do not pay yet.
///
/// Once the buffers have the size of the largest system, nothing is allocated any more.
#[derive(Clone, Default)]
pub struct DenseSystem {
    size: usize,
    /// Rows of `A`, one after the other and each with room for whole registers; overwritten by the factors of `A Q`, L with a
    /// diagonal of 1.
    rows: Vec<f64>,
    rhs: Vec<f64>,
    permuted: Vec<f64>,
    /// Inverses of the pivots.
    inverse: Vec<f64>,
    /// Unknowns in the order of the columns of `A Q`.
    order: Vec<usize>,
}

impl DenseSystem {
    /// Starts a system of `size` unknowns with zero matrix and right-hand side.
    pub fn reset(&mut self, size: usize) {
        self.size = size;
        self.rows.clear();
        self.rows.resize(size * room(size), 0.0);
        self.rhs.clear();
        self.rhs.resize(size, 0.0);
    }

    /// Takes the matrix of `size` unknowns from its rows, for any right-hand side.
    pub fn set<'a>(&mut self, size: usize, rows: impl Iterator<Item = &'a [f64]>) {
        self.size = size;
        self.rows.clear();
        for (i, row) in rows.enumerate() {
            self.rows.extend_from_slice(row);
            self.rows.resize((i + 1) * room(size), 0.0);
        }
    }

    /// Row `i` of the matrix, and its right-hand side.
    pub fn row(&mut self, i: usize) -> (&mut [f64], &mut f64) {
        (&mut self.rows[i * room(self.size)..][..self.size], &mut self.rhs[i])
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
        self.order.clear();
        self.order.extend(0..self.size);
        self.inverse.clear();
        self.inverse.resize(room(self.size), 0.0);
        factorise(&mut self.rows, &mut self.inverse, &mut self.order)
    }

    /// `x ← A⁻¹ x` with the factors of [`Self::factorise`]; whether the result is finite.
    pub fn solve_with(&mut self, x: &mut [f64]) -> bool {
        substitute(&self.rows, x);
        self.permuted.clear();
        self.permuted.extend_from_slice(x);
        self.order.iter().zip(&self.permuted).for_each(|(&to, value)| x[to] = *value);
        x.iter().all(|x| x.is_finite())
    }

    /// [`Self::solve_with`] for D groups of N right-hand sides side by side.
    pub fn solve_with_all<const D: usize, const N: usize>(&self, x: &mut [[[f64; N]; D]]) -> bool {
        substitute_all(&self.rows, x);
        let permuted = x.to_vec();
        self.order.iter().zip(&permuted).for_each(|(&to, value)| x[to] = *value);
        x.as_flattened().as_flattened().iter().all(|x| x.is_finite())
    }
}

/// Numbers of a row with room for whole registers.
fn room(size: usize) -> usize {
    size.next_multiple_of(REGISTER)
}

/// Numbers in a register, at most.
const REGISTER: usize = 4;

vectorised! {
    /// Replaces a matrix, given by rows, by its factors, and exchanges the items of `order` with its columns; `inverse` is memory
    /// for the inverses of the pivots. False: it is singular or not finite.
    fn factorise<'a, S>(simd, rows: &'a mut [f64], inverse: &'a mut [f64], order: &'a mut [usize]) -> bool {
        let (n, room) = (order.len(), inverse.len());
        for i in 0..n {
            let (above, below) = rows.split_at_mut(i * room);
            let row = &mut below[..room];
            eliminate(simd, above, &inverse[..i], row);
            let (mut largest, mut size) = (i, row[i].abs());
            for (j, value) in row[..n].iter().enumerate().skip(i + 1) {
                if value.abs() > size {
                    (largest, size) = (j, value.abs());
                }
            }
            inverse[i] = 1.0 / row[largest];
            if !inverse[i].is_finite() {
                return false;
            }
            if largest > i {
                rows.chunks_exact_mut(room).for_each(|row| row.swap(i, largest));
                order.swap(i, largest);
            }
        }
        true
    }
}

/// Takes multiples of the rows `above`, which are factors already, from a row of the matrix, and leaves them in their place.
#[inline(always)]
fn eliminate<S: pulp::Simd>(simd: S, above: &[f64], inverse: &[f64], row: &mut [f64]) {
    let (room, (fours, rest)) = (row.len(), inverse.as_chunks::<REGISTER>());
    for (block, inverse) in fours.iter().enumerate() {
        eliminate_four(simd, &above[block * REGISTER * room..], inverse, (block * REGISTER, &mut *row));
    }
    let first = fours.len() * REGISTER;
    for (k, inverse) in (first..).zip(rest) {
        let pivot = &above[k * room..][..room];
        let factor = row[k] * inverse;
        row[k] = factor;
        for j in k + 1..first + REGISTER {
            row[j] -= factor * pivot[j];
        }
        let (others, values) = (&pivot[first + REGISTER..], &mut row[first + REGISTER..]);
        let less = simd.splat_f64s(-factor);
        for (value, other) in S::as_mut_simd_f64s(values).0.iter_mut().zip(S::as_simd_f64s(others).0) {
            *value = simd.mul_add_e_f64s(less, *other, *value);
        }
    }
}

/// [`eliminate`] for four rows from the column `at` a place on, at which the first of them has its pivot.
#[inline(always)]
fn eliminate_four<S: pulp::Simd>(simd: S, pivots: &[f64], inverse: &[f64; REGISTER], (at, row): (usize, &mut [f64])) {
    let room = row.len();
    let (pivots, from) = (&pivots[..REGISTER * room], at + REGISTER);
    let [first, second, third] = [&pivots[at..], &pivots[room + at..], &pivots[2 * room + at..]];
    let own = &mut row[at..from];
    let a = own[0] * inverse[0];
    let b = (own[1] - a * first[1]) * inverse[1];
    let c = (own[2] - a * first[2] - b * second[2]) * inverse[2];
    let d = (own[3] - a * first[3] - b * second[3] - c * third[3]) * inverse[3];
    own.copy_from_slice(&[a, b, c, d]);
    let (a, b, c, d) = (simd.splat_f64s(-a), simd.splat_f64s(-b), simd.splat_f64s(-c), simd.splat_f64s(-d));
    let row = S::as_mut_simd_f64s(&mut row[from..]).0;
    let (first, second) = (S::as_simd_f64s(&pivots[from..room]).0, S::as_simd_f64s(&pivots[room + from..2 * room]).0);
    let (third, fourth) = (&pivots[2 * room + from..3 * room], &pivots[3 * room + from..]);
    let (third, fourth) = (S::as_simd_f64s(third).0, S::as_simd_f64s(fourth).0);
    // One place counts for all rows.
    let count = row.len();
    let (first, second, third, fourth) = (&first[..count], &second[..count], &third[..count], &fourth[..count]);
    for q in 0..count {
        let sum = simd.mul_add_e_f64s(b, second[q], simd.mul_add_e_f64s(a, first[q], row[q]));
        row[q] = simd.mul_add_e_f64s(d, fourth[q], simd.mul_add_e_f64s(c, third[q], sum));
    }
}

vectorised! {
    /// `x ← U⁻¹ L⁻¹ x` with the factors of a matrix, by rows.
    fn substitute<'a, S>(simd, factors: &'a [f64], x: &'a mut [f64]) {
        let (n, room) = (x.len(), room(x.len()));
        let product = |a: &[f64], b: &[f64]| {
            let ((a, a_rest), (b, b_rest)) = (S::as_simd_f64s(a), S::as_simd_f64s(b));
            let zero = simd.splat_f64s(0.0);
            let sum = a.iter().zip(b).fold(zero, |sum, (&a, &b)| simd.mul_add_e_f64s(a, b, sum));
            simd.reduce_sum_f64s(sum) + a_rest.iter().zip(b_rest).map(|(a, b)| a * b).sum::<f64>()
        };
        for i in 0..n {
            x[i] -= product(&factors[i * room..][..i], &x[..i]);
        }
        for i in (0..n).rev() {
            let row = &factors[i * room..][..n];
            x[i] = (x[i] - product(&row[i + 1..], &x[i + 1..])) / row[i];
        }
    }
}

vectorised! {
    /// `X ← U⁻¹ L⁻¹ X` with the factors of a matrix, both by rows.
    fn substitute_all<'a, S, const D: usize, const N: usize>(
        simd,
        factors: &'a [f64],
        x: &'a mut [[[f64; N]; D]],
    ) {
        let (n, room) = (x.len(), room(x.len()));
        for i in 0..n {
            let (above, below) = x.split_at_mut(i);
            take(simd, &factors[i * room..][..i], above.as_flattened().as_flattened(), below[0].as_flattened_mut());
        }
        for i in (0..n).rev() {
            let (row, (above, below)) = (&factors[i * room..][..n], x.split_at_mut(i + 1));
            let solved = above[i].as_flattened_mut();
            take(simd, &row[i + 1..], below.as_flattened().as_flattened(), solved);
            let over = 1.0 / row[i];
            solved.iter_mut().for_each(|value| *value *= over);
        }
    }
}

/// Takes multiples of the rows `others` from a row.
#[inline(always)]
fn take<S: pulp::Simd>(simd: S, factors: &[f64], others: &[f64], row: &mut [f64]) {
    let width = row.len();
    by_blocks!(width / S::F64_LANES, take_block::<S>(simd, factors, others, row));
    for at in width / S::F64_LANES * S::F64_LANES..width {
        row[at] -= factors.iter().enumerate().map(|(j, factor)| factor * others[j * width + at]).sum::<f64>();
    }
}

/// [`take`] for `B` registers from the one `at` a place on.
#[inline(always)]
fn take_block<S: pulp::Simd, const B: usize>(simd: S, factors: &[f64], others: &[f64], row: &mut [f64], at: usize) {
    let (first, width, length) = (at * S::F64_LANES, row.len(), B * S::F64_LANES);
    let own = &mut S::as_mut_simd_f64s(&mut row[first..][..length]).0[..B];
    let mut sums: [S::f64s; B] = load(own, 0);
    for (j, factor) in factors.iter().enumerate() {
        let (less, other) = (simd.splat_f64s(-factor), S::as_simd_f64s(&others[j * width + first..][..length]).0);
        for (sum, other) in sums.iter_mut().zip(load::<_, B>(other, 0)) {
            *sum = simd.mul_add_e_f64s(less, other, *sum);
        }
    }
    own.copy_from_slice(&sums);
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
