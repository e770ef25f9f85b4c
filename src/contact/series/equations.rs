//! The small linear system of a stretch that sticks, solved in vector registers.

use super::tables::STICK;
use crate::linalg::vectorised::vectorised;

/// Most unknowns: terms of the shear, the strength of a root at the end where slip begins, V and Ω.
pub const UNKNOWNS: usize = STICK + 2;
/// Room for equations: whole vector registers.
pub const ROOM: usize = 16;

/// Coefficients of one unknown, by equation.
pub type Coefficients = [f64; ROOM];

/// Equations of a stretch that sticks, by columns. Those beyond their number are zero.
#[derive(Clone)]
pub struct StickEquations {
    /// Coefficients of every unknown, and behind them the right-hand side.
    pub columns: [Coefficients; UNKNOWNS + 1],
    /// Number of equations and unknowns.
    pub count: usize,
}

impl StickEquations {
    pub fn new(count: usize) -> Self {
        Self { columns: [[0.0; ROOM]; UNKNOWNS + 1], count }
    }

    /// The right-hand side.
    pub fn right(&mut self) -> &mut Coefficients {
        &mut self.columns[self.count]
    }

    /// Solution by elimination with the largest pivot of each column; every row is scaled first.
    pub fn solve(mut self) -> Option<[f64; UNKNOWNS]> {
        solve(&mut self)
    }
}

vectorised! {
    /// See [`StickEquations::solve`].
    fn solve<'a, S>(_simd, equations: &'a mut StickEquations) -> Option<[f64; UNKNOWNS]> {
        // The right-hand side is a column like the others.
        let StickEquations { columns, count } = equations;
        let (count, columns) = (*count, &mut columns[..=*count]);
        let mut scale = [0.0_f64; ROOM];
        for column in &columns[..count] {
            for i in 0..ROOM {
                scale[i] = scale[i].max(column[i].abs());
            }
        }
        for scale in &mut scale {
            *scale = if *scale > 0.0 { 1.0 / *scale } else { 0.0 };
        }
        for column in columns.iter_mut() {
            for i in 0..ROOM {
                column[i] *= scale[i];
            }
        }
        // Rows stay where they are: no part of a register moves. Those that have been pivots have the factor zero.
        let (mut pivots, mut open) = ([0; UNKNOWNS], [0.0; ROOM]);
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
                return None;
            }
            (pivots[k], open[best]) = (best, 0.0);
            let (mut factors, over) = (columns[k], 1.0 / columns[k][best]);
            for i in 0..ROOM {
                factors[i] *= open[i] * over;
            }
            for column in &mut columns[k + 1..] {
                let pivot = column[best];
                for i in 0..ROOM {
                    column[i] -= factors[i] * pivot;
                }
            }
        }
        let (mut right, mut x) = (columns[count], [0.0; UNKNOWNS]);
        for k in (0..count).rev() {
            let known = right[pivots[k]] / columns[k][pivots[k]];
            x[k] = known;
            for i in 0..ROOM {
                right[i] -= columns[k][i] * known;
            }
        }
        x.iter().all(|v| v.is_finite()).then_some(x)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equations_of_any_number_are_solved_and_singular_ones_are_refused() {
        for count in [1, 2, 11, 12, UNKNOWNS] {
            let entry = |i: usize, k: usize| ((7 * i * i + 3 * k * k + 5 * i * k) % 11) as f64 - 4.5 + 1e-3 * i as f64;
            let mut equations = StickEquations::new(count);
            let exact: [f64; UNKNOWNS] = std::array::from_fn(|k| if k < count { 1.0 + k as f64 } else { 0.0 });
            for i in 0..count {
                let scale = 10.0_f64.powi(i as i32 - 5);
                for k in 0..count {
                    equations.columns[k][i] = scale * (entry(i, k) + if i + 1 == k { 20.0 } else { 0.0 });
                }
                equations.right()[i] = (0..count).map(|k| equations.columns[k][i] * exact[k]).sum();
            }
            let mut singular = equations.clone();
            let found = equations.solve().unwrap();
            assert!(found.iter().zip(exact).all(|(a, b)| (a - b).abs() < 1e-9), "{count}: {found:?}");
            singular.columns[count - 1] = [0.0; ROOM];
            assert!(singular.solve().is_none());
        }
    }
}
