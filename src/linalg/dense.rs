//! Small dense matrices: systems solved over and over in buffers that are kept, and exact symmetry.

use super::vectorised::vectorised;
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
    /// Right-hand side with room for whole registers.
    permuted: Vec<f64>,
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
        factorise(&mut self.rows, &mut self.order)
    }

    /// `x ← A⁻¹ x` with the factors of [`Self::factorise`]; whether the result is finite.
    pub fn solve_with(&mut self, x: &mut [f64]) -> bool {
        self.permuted.clear();
        self.permuted.extend_from_slice(x);
        self.permuted.resize(room(x.len()), 0.0);
        substitute(&self.rows, &mut self.permuted, x.len());
        self.order.iter().zip(&self.permuted).for_each(|(&to, value)| x[to] = *value);
        x.iter().all(|x| x.is_finite())
    }

    /// [`Self::solve_with`] for right-hand sides side by side.
    pub fn solve_with_all<const N: usize>(&self, x: &mut [[f64; N]]) -> bool {
        substitute_all(&self.rows, x);
        let permuted = x.to_vec();
        self.order.iter().zip(&permuted).for_each(|(&to, value)| x[to] = *value);
        x.as_flattened().iter().all(|x| x.is_finite())
    }
}

/// Numbers of a row with room for whole registers.
fn room(size: usize) -> usize {
    size.next_multiple_of(REGISTER)
}

/// Numbers in a register, at most.
const REGISTER: usize = 4;

vectorised! {
    /// Replaces a matrix, given by rows, by its factors, and exchanges the items of `order` with its columns. Rows below take as
    /// many pivots at a time as a register has numbers. False: it is singular or not finite.
    fn factorise<'a, S>(simd, rows: &'a mut [f64], order: &'a mut [usize]) -> bool {
        let n = order.len();
        let room = room(n);
        for first in (0..n).step_by(REGISTER) {
            let (count, mut over) = (REGISTER.min(n - first), [0.0; REGISTER]);
            for k in first..first + count {
                let (above, row) = rows.split_at_mut(k * room);
                let row = &mut row[..room];
                for p in first..k {
                    let factor = row[p] * over[p - first];
                    row[p] = factor;
                    let pivot = &above[p * room..][..room];
                    row[p + 1..].iter_mut().zip(&pivot[p + 1..]).for_each(|(value, pivot)| *value -= factor * pivot);
                }
                let mut largest = k;
                for j in k + 1..n {
                    if row[j].abs() > row[largest].abs() {
                        largest = j;
                    }
                }
                over[k - first] = 1.0 / row[largest];
                if !over[k - first].is_finite() {
                    return false;
                }
                if largest > k {
                    rows.chunks_exact_mut(room).for_each(|row| row.swap(k, largest));
                    order.swap(k, largest);
                }
            }
            let end = first + count;
            let (above, below) = rows.split_at_mut(end * room);
            let pivots: [&[f64]; REGISTER] = std::array::from_fn(|p| &above[(first + p.min(count - 1)) * room..][..room]);
            let others = pivots.map(|pivot| S::as_simd_f64s(&pivot[end.min(room)..]));
            for row in below.chunks_exact_mut(room) {
                let mut less = [0.0; REGISTER];
                for p in 0..REGISTER {
                    let by_earlier: f64 = (0..p).map(|e| less[e] * pivots[e][first + p]).sum();
                    less[p] = -(row[first + p] + by_earlier) * over[p];
                }
                row[first..end].iter_mut().zip(less).for_each(|(value, less)| *value = -less);
                let (values, values_rest) = S::as_mut_simd_f64s(&mut row[end..]);
                let each = less.map(|less| simd.splat_f64s(less));
                for (i, value) in values.iter_mut().enumerate() {
                    for p in 0..REGISTER {
                        *value = simd.mul_add_e_f64s(each[p], others[p].0[i], *value);
                    }
                }
                for (i, value) in values_rest.iter_mut().enumerate() {
                    *value += (0..REGISTER).map(|p| less[p] * others[p].1[i]).sum::<f64>();
                }
            }
        }
        true
    }
}

vectorised! {
    /// `x ← U⁻¹ L⁻¹ x` with the factors of a matrix of `n` rows, by rows; `x` has room for whole registers, zeros at the end.
    fn substitute<'a, S>(simd, factors: &'a [f64], x: &'a mut [f64], n: usize) {
        let room = x.len();
        let rows = |first: usize| -> [&[f64]; REGISTER] {
            std::array::from_fn(|r| &factors[(first + r).min(n - 1) * room..][..room])
        };
        // Some rows times the numbers from one place to another.
        let products = |rows: [&[f64]; REGISTER], from: usize, to: usize, x: &[f64]| {
            let (x, x_rest) = S::as_simd_f64s(&x[from..to]);
            let mut sums = [simd.splat_f64s(0.0); REGISTER];
            let rows = rows.map(|row| S::as_simd_f64s(&row[from..to]));
            for (i, x) in x.iter().enumerate() {
                for r in 0..REGISTER {
                    sums[r] = simd.mul_add_e_f64s(rows[r].0[i], *x, sums[r]);
                }
            }
            let mut products = [0.0; REGISTER];
            for r in 0..REGISTER {
                let rest: f64 = rows[r].1.iter().zip(x_rest).map(|(a, b)| a * b).sum();
                products[r] = simd.reduce_sum_f64s(sums[r]) + rest;
            }
            products
        };
        for first in (0..n).step_by(REGISTER) {
            let rows = rows(first);
            let known = products(rows, 0, first, x);
            for r in 0..REGISTER.min(n - first) {
                let within: f64 = (0..r).map(|e| rows[r][first + e] * x[first + e]).sum();
                x[first + r] -= known[r] + within;
            }
        }
        for first in (0..n).step_by(REGISTER).rev() {
            let rows = rows(first);
            let known = products(rows, first + REGISTER, room, x);
            for r in (0..REGISTER.min(n - first)).rev() {
                let within: f64 = (r + 1..REGISTER).map(|e| rows[r][first + e] * x[first + e]).sum();
                x[first + r] = (x[first + r] - known[r] - within) / rows[r][first + r];
            }
        }
    }
}

vectorised! {
    /// `X ← U⁻¹ L⁻¹ X` with the factors of a matrix, both by rows.
    fn substitute_all<'a, S, const N: usize>(_simd, factors: &'a [f64], x: &'a mut [[f64; N]]) {
        let (n, room) = (x.len(), room(x.len()));
        let take = |row: &mut [f64; N], factors: &[f64], others: &[[f64; N]]| {
            for (factor, other) in factors.iter().zip(others) {
                row.iter_mut().zip(other).for_each(|(value, other)| *value -= factor * other);
            }
        };
        for i in 0..n {
            let (above, below) = x.split_at_mut(i);
            take(&mut below[0], &factors[i * room..][..i], above);
        }
        for i in (0..n).rev() {
            let (row, (above, below)) = (&factors[i * room..][..n], x.split_at_mut(i + 1));
            take(&mut above[i], &row[i + 1..], below);
            let over = 1.0 / row[i];
            above[i].iter_mut().for_each(|value| *value *= over);
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

    /// Blocks of rows begin and end everywhere, and every unknown may be the pivot.
    #[test]
    fn systems_of_any_size_are_solved_to_round_off() {
        let mut seed = 3_u64;
        let mut random = || {
            seed = seed.wrapping_mul(0x5851_f42d_4c95_7f2d).wrapping_add(0x1405_7b7e_f767_814f);
            (seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        };
        for size in 1..80 {
            let mut system = DenseSystem::default();
            system.reset(size);
            let exact: Vec<f64> = (0..size).map(|_| random()).collect();
            let mut rhs = vec![0.0; size];
            for (i, rhs) in rhs.iter_mut().enumerate() {
                let row = system.row(i).0;
                row.iter_mut().for_each(|value| *value = random());
                *rhs = row.iter().zip(&exact).map(|(a, x)| a * x).sum();
            }
            assert!(system.factorise());
            let mut side_by_side: Vec<[f64; 2]> = rhs.iter().map(|rhs| [*rhs, -2.0 * rhs]).collect();
            assert!(system.solve_with(&mut rhs) && system.solve_with_all(&mut side_by_side));
            for ((x, both), exact) in rhs.iter().zip(&side_by_side).zip(&exact) {
                assert!((x - exact).abs() < 1e-9, "{size}: {x} for {exact}");
                assert!((both[0] - exact).abs() < 1e-9 && (both[1] + 2.0 * exact).abs() < 1e-9, "{size}");
            }
        }
    }

    #[test]
    fn a_singular_system_has_no_solution() {
        assert_eq!(solve(&mut DenseSystem::default(), [[1.0, 2.0], [2.0, 4.0]], [1.0, 1.0]), None);
        assert_eq!(solve(&mut DenseSystem::default(), [[0.0]], [1.0]), None);
    }
}
