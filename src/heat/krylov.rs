//! Preconditioned GMRES for the exact operator, which the modal solver inverts but for the curvature of the wheel.

use super::HeatError;

/// A linear system and an approximate inverse of its matrix.
pub(super) trait System {
    /// `out ← A x`.
    fn apply(&mut self, x: &[f64], out: &mut [f64]);
    /// `x ← P⁻¹ x`.
    fn precondition(&mut self, x: &mut [f64]);
}

/// Vectors kept before a restart.
const SPACE: usize = 60;
const RESTARTS: usize = 8;

fn norm(x: &[f64]) -> f64 {
    product(x, x).sqrt()
}

fn product(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn add(factor: f64, x: &[f64], y: &mut [f64]) {
    y.iter_mut().zip(x).for_each(|(y, x)| *y += factor * x);
}

/// Replaces `b` by `A⁻¹ b`; returns the number of iterations (0: the preconditioner alone was enough).
///
/// Right-preconditioned, restarted (Saad, *Iterative Methods for Sparse Linear Systems*, 2nd ed., 9.3.2). Stops at
/// `|residual| ≤ tolerance |b|`, or where round-off stops it below `accepted |b|`.
pub(super) fn solve(
    system: &mut dyn System,
    b: &mut Vec<f64>,
    tolerance: f64,
    accepted: f64,
) -> Result<usize, HeatError> {
    let n = b.len();
    let size = norm(b);
    if size == 0.0 {
        return Ok(0);
    }
    let mut x = b.clone();
    system.precondition(&mut x);
    let mut residual = vec![0.0; n];
    let (mut iterations, mut before) = (0, f64::INFINITY);
    let mut update = vec![0.0; n];
    for _ in 0..=RESTARTS {
        system.apply(&x, &mut residual);
        residual.iter_mut().zip(&*b).for_each(|(r, b)| *r = b - *r);
        let left = norm(&residual) / size;
        if left <= tolerance || (left <= accepted && left > 0.5 * before) {
            *b = x;
            return Ok(iterations);
        }
        if !left.is_finite() {
            break;
        }
        before = left;
        let mut basis = vec![residual.iter().map(|r| r / (left * size)).collect::<Vec<f64>>()];
        // Columns of the triangular factor, Givens rotations, rotated right-hand side.
        let (mut columns, mut rotations, mut rhs) = (Vec::<Vec<f64>>::new(), Vec::new(), vec![left]);
        for k in 0..SPACE {
            update.copy_from_slice(&basis[k]);
            system.precondition(&mut update);
            let mut next = vec![0.0; n];
            system.apply(&update, &mut next);
            let mut column = vec![0.0; k + 1];
            // Twice is enough.
            for _ in 0..2 {
                for (h, v) in column.iter_mut().zip(&basis) {
                    let part = product(v, &next);
                    *h += part;
                    add(-part, v, &mut next);
                }
            }
            let length = norm(&next);
            for (i, &(c, s)) in rotations.iter().enumerate() {
                let (p, q): (f64, f64) = (column[i], column[i + 1]);
                (column[i], column[i + 1]) = (c * p + s * q, c * q - s * p);
            }
            let diagonal = column[k].hypot(length);
            if !(diagonal > 0.0 && diagonal.is_finite()) {
                break;
            }
            let (c, s) = (column[k] / diagonal, length / diagonal);
            column[k] = diagonal;
            rotations.push((c, s));
            let top = rhs[k];
            rhs[k] = c * top;
            rhs.push(-s * top);
            columns.push(column);
            iterations += 1;
            if (s * top).abs() <= 0.5 * tolerance || length <= f64::EPSILON * diagonal {
                break;
            }
            next.iter_mut().for_each(|v| *v /= length);
            basis.push(next);
        }
        let m = columns.len();
        let mut y = rhs[..m].to_vec();
        for i in (0..m).rev() {
            y[i] /= columns[i][i];
            let value = y[i];
            (0..i).for_each(|l| y[l] -= columns[i][l] * value);
        }
        update.fill(0.0);
        for (value, v) in y.iter().zip(&basis) {
            add(value * size, v, &mut update);
        }
        system.precondition(&mut update);
        add(1.0, &update, &mut x);
    }
    Err(HeatError::NotConverged { residual: before, iterations })
}
