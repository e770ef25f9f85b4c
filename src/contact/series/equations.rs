//! Small linear systems of contact by series, solved in vector registers.

use crate::linalg::vectorised::vectorised;

/// Room for equations: whole vector registers.
pub const ROOM: usize = 16;

/// Coefficients of one unknown, by equation; those beyond the number of equations are zero.
pub type Coefficients = [f64; ROOM];

/// Solves `count` equations with several right-hand sides by elimination with the largest pivot of each column; every
/// row is scaled first. `columns` has the coefficients of every unknown and behind them the right-hand sides, which
/// become the solutions. Returns false for singular equations.
pub fn eliminate<const R: usize>(columns: &mut [[f64; R]], count: usize) -> bool {
    solve(columns, count)
}

vectorised! {
    /// See [`eliminate`].
    fn solve<'a, S, const R: usize>(_simd, columns: &'a mut [[f64; R]], count: usize) -> bool {
        let mut scale = [0.0_f64; R];
        for column in &columns[..count] {
            for i in 0..R {
                scale[i] = scale[i].max(column[i].abs());
            }
        }
        for scale in &mut scale {
            *scale = if *scale > 0.0 { 1.0 / *scale } else { 0.0 };
        }
        for column in columns.iter_mut() {
            for i in 0..R {
                column[i] *= scale[i];
            }
        }
        // Rows stay where they are: no part of a register moves. Those that have been pivots have the factor zero.
        let (mut pivots, mut open) = ([0; R], [0.0; R]);
        open[..count].fill(1.0);
        for k in 0..count {
            let (mut best, mut most) = (0, -1.0);
            for i in 0..count {
                let size = open[i] * columns[k][i].abs();
                if size > most {
                    (best, most) = (i, size);
                }
            }
            if !(most > 0.0 && most.is_finite()) {
                return false;
            }
            (pivots[k], open[best]) = (best, 0.0);
            let (mut factors, over) = (columns[k], 1.0 / columns[k][best]);
            for i in 0..R {
                factors[i] *= open[i] * over;
            }
            for column in &mut columns[k + 1..] {
                let pivot = column[best];
                for i in 0..R {
                    column[i] -= factors[i] * pivot;
                }
            }
        }
        let (unknowns, right) = columns.split_at_mut(count);
        let mut finite = true;
        for right in right {
            let mut x = [0.0; R];
            for k in (0..count).rev() {
                let known = right[pivots[k]] / unknowns[k][pivots[k]];
                x[k] = known;
                for i in 0..R {
                    right[i] -= unknowns[k][i] * known;
                }
            }
            *right = x;
            for value in &x {
                finite &= value.is_finite();
            }
        }
        finite
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equations_of_any_number_are_solved_and_singular_ones_are_refused() {
        for count in [1, 2, 11, 12, 13] {
            let entry = |i: usize, k: usize| ((7 * i * i + 3 * k * k + 5 * i * k) % 11) as f64 - 4.5 + 1e-3 * i as f64;
            let mut columns = [[0.0; ROOM]; 15];
            let exact = [1.0, -2.0].map(|first| -> Coefficients {
                std::array::from_fn(|k| if k < count { first + k as f64 } else { 0.0 })
            });
            let scale = |i: usize| 10.0_f64.powi(i as i32 - 5);
            for (k, column) in columns[..count].iter_mut().enumerate() {
                for (i, coefficient) in column[..count].iter_mut().enumerate() {
                    *coefficient = scale(i) * (entry(i, k) + if i + 1 == k { 20.0 } else { 0.0 });
                }
            }
            let (unknowns, right) = columns.split_at_mut(count);
            for (right, exact) in right.iter_mut().zip(&exact) {
                for (column, x) in unknowns.iter().zip(exact) {
                    right.iter_mut().zip(column).for_each(|(sum, coefficient)| *sum += coefficient * x);
                }
            }
            let mut singular = columns;
            assert!(eliminate(&mut columns[..count + 2], count));
            for (side, exact) in exact.iter().enumerate() {
                let found = columns[count + side];
                assert!(found.iter().zip(exact).all(|(a, b)| (a - b).abs() < 1e-9), "{count}: {found:?}");
            }
            singular[count - 1] = [0.0; ROOM];
            assert!(!eliminate(&mut singular[..count + 2], count));
        }
    }
}
