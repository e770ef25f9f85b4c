//! GMRES: iterative solution of a linear system with a good approximate inverse.

use super::vectorised::dot;

/// A linear system and an approximate inverse of its matrix.
pub trait LinearSystem {
    /// `out ← A x`.
    fn apply(&mut self, x: &[f64], out: &mut [f64]);
    /// `x ← P⁻¹ x` with `P ≈ A`.
    fn precondition(&mut self, x: &mut [f64]);
}

/// An iteration that ended before the residual was small enough.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("relative residual {residual:.2e} after {iterations} iterations")]
pub struct Stopped {
    /// `|b − A x| / |b|` reached \[1].
    pub residual: f64,
    /// Iterations done.
    pub iterations: usize,
}

/// Vectors kept before a restart.
const SPACE: usize = 60;
const RESTARTS: usize = 8;

/// The solver: memory that is kept from one solution to the next; nothing in it outlives a solution.
#[derive(Clone, Debug, Default)]
pub struct Gmres {
    solution: Vec<f64>,
    residual: Vec<f64>,
    update: Vec<f64>,
    /// Orthonormal vectors of the Krylov space; those beyond the current ones are spare memory.
    basis: Vec<Vec<f64>>,
    /// Columns of the triangular factor, one after the other: column k has k + 1 entries.
    triangle: Vec<f64>,
    /// Givens rotations: cosine and sine.
    rotations: Vec<[f64; 2]>,
    /// Rotated right-hand side, then coefficients of the basis.
    rhs: Vec<f64>,
}

impl Gmres {
    /// Replaces `b` by `A⁻¹ b`; returns the number of iterations (0: the preconditioner alone was enough).
    ///
    /// Right-preconditioned and restarted (Saad, *Iterative Methods for Sparse Linear Systems*, 2nd ed., 9.3.2). Stops
    /// at `|residual| ≤ tolerance |b|`, or where round-off stops it below `accepted |b|`. On error `b` is untouched.
    pub fn solve(
        &mut self,
        system: &mut dyn LinearSystem,
        b: &mut [f64],
        tolerance: f64,
        accepted: f64,
    ) -> Result<usize, Stopped> {
        let size = norm(b);
        if size == 0.0 {
            return Ok(0);
        }
        refill(&mut self.solution, b);
        system.precondition(&mut self.solution);
        let (mut iterations, mut before) = (0, f64::INFINITY);
        for _ in 0..=RESTARTS {
            refill(&mut self.residual, b);
            system.apply(&self.solution, &mut self.residual);
            self.residual.iter_mut().zip(&*b).for_each(|(r, b)| *r = b - *r);
            let left = norm(&self.residual) / size;
            if left <= tolerance || (left <= accepted && left > 0.5 * before) {
                b.copy_from_slice(&self.solution);
                return Ok(iterations);
            }
            if !left.is_finite() {
                break;
            }
            before = left;
            let vectors = self.build_space(system, left, size, tolerance);
            iterations += vectors;
            self.correct(system, vectors, size);
        }
        Err(Stopped { residual: before, iterations })
    }

    /// Spans the Krylov space of the residual, of relative size `left`; the number of its usable vectors.
    fn build_space(&mut self, system: &mut dyn LinearSystem, left: f64, size: f64, tolerance: f64) -> usize {
        let n = self.residual.len();
        let scale = left * size;
        spare(&mut self.basis, 0, n);
        self.basis[0].iter_mut().zip(&self.residual).for_each(|(v, r)| *v = r / scale);
        self.triangle.clear();
        self.rotations.clear();
        self.rhs.clear();
        self.rhs.push(left);
        for k in 0..SPACE {
            spare(&mut self.basis, k + 1, n);
            let (basis, rest) = self.basis.split_at_mut(k + 1);
            let next = &mut rest[0];
            refill(&mut self.update, &basis[k]);
            system.precondition(&mut self.update);
            system.apply(&self.update, next);
            let start = self.triangle.len();
            self.triangle.resize(start + k + 1, 0.0);
            let column = &mut self.triangle[start..];
            // Orthogonalised twice, which is enough.
            for _ in 0..2 {
                for (h, v) in column.iter_mut().zip(&*basis) {
                    let part = dot(v, next);
                    *h += part;
                    add(-part, v, next);
                }
            }
            let length = norm(next);
            for (i, &[c, s]) in self.rotations.iter().enumerate() {
                let (p, q) = (column[i], column[i + 1]);
                (column[i], column[i + 1]) = (c * p + s * q, c * q - s * p);
            }
            let diagonal = libm::hypot(column[k], length);
            if !(diagonal > 0.0 && diagonal.is_finite()) {
                return k;
            }
            let (c, s) = (column[k] / diagonal, length / diagonal);
            column[k] = diagonal;
            self.rotations.push([c, s]);
            let top = self.rhs[k];
            self.rhs[k] = c * top;
            self.rhs.push(-s * top);
            if (s * top).abs() <= 0.5 * tolerance || length <= f64::EPSILON * diagonal {
                return k + 1;
            }
            next.iter_mut().for_each(|v| *v /= length);
        }
        SPACE
    }

    /// Adds the best vector of the Krylov space to the solution.
    fn correct(&mut self, system: &mut dyn LinearSystem, vectors: usize, size: f64) {
        let entry = |row: usize, column: usize| self.triangle[column * (column + 1) / 2 + row];
        for i in (0..vectors).rev() {
            self.rhs[i] /= entry(i, i);
            let value = self.rhs[i];
            (0..i).for_each(|l| self.rhs[l] -= entry(l, i) * value);
        }
        self.update.fill(0.0);
        for (value, v) in self.rhs[..vectors].iter().zip(&self.basis) {
            add(value * size, v, &mut self.update);
        }
        system.precondition(&mut self.update);
        add(1.0, &self.update, &mut self.solution);
    }
}

/// Replaces the content of a buffer.
fn refill(buffer: &mut Vec<f64>, values: &[f64]) {
    buffer.clear();
    buffer.extend_from_slice(values);
}

/// Makes sure that there is a vector `index` of `n` numbers.
fn spare(vectors: &mut Vec<Vec<f64>>, index: usize, n: usize) {
    if vectors.len() <= index {
        vectors.resize(index + 1, Vec::new());
    }
    vectors[index].resize(n, 0.0);
}

fn norm(x: &[f64]) -> f64 {
    dot(x, x).sqrt()
}

fn add(factor: f64, x: &[f64], y: &mut [f64]) {
    y.iter_mut().zip(x).for_each(|(y, x)| *y += factor * x);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Convection and diffusion on a line, preconditioned with the diagonal or not at all.
    struct ConvectedLine {
        convection: f64,
        shift: f64,
        diagonal: bool,
    }

    impl LinearSystem for ConvectedLine {
        fn apply(&mut self, x: &[f64], out: &mut [f64]) {
            for i in 0..x.len() {
                let before = if i > 0 { x[i - 1] } else { 0.0 };
                let after = x.get(i + 1).copied().unwrap_or(0.0);
                out[i] = (2.0 + self.shift * (1 + i % 7) as f64) * x[i]
                    - (1.0 + self.convection) * before
                    - (1.0 - self.convection) * after;
            }
        }

        fn precondition(&mut self, x: &mut [f64]) {
            if self.diagonal {
                x.iter_mut().enumerate().for_each(|(i, x)| *x /= 2.0 + self.shift * (1 + i % 7) as f64);
            }
        }
    }

    fn load(n: usize) -> Vec<f64> {
        (0..n).map(|i| (1.0 + i as f64).sin()).collect()
    }

    fn residual(system: &mut ConvectedLine, x: &[f64], b: &[f64]) -> f64 {
        let mut out = vec![0.0; x.len()];
        system.apply(x, &mut out);
        out.iter_mut().zip(b).for_each(|(o, b)| *o -= b);
        norm(&out) / norm(b)
    }

    #[test]
    fn solution_of_an_unsymmetric_system_has_the_residual_asked_for() {
        let mut gmres = Gmres::default();
        for (n, diagonal) in [(1, false), (30, false), (200, true), (200, false)] {
            let mut system = ConvectedLine { convection: 0.4, shift: 1.0, diagonal };
            let b = load(n);
            let mut x = b.clone();
            let iterations = gmres.solve(&mut system, &mut x, 1e-12, 1e-10).unwrap();
            assert!(residual(&mut system, &x, &b) < 1e-12, "{n} unknowns, {iterations} iterations");
            assert!(iterations > 0 && iterations <= 60);
        }
    }

    #[test]
    fn exact_preconditioner_needs_no_iteration_and_zero_stays_zero() {
        let mut system = ConvectedLine { convection: 0.0, shift: 0.0, diagonal: true };
        let mut zero = vec![0.0; 10];
        assert_eq!(Gmres::default().solve(&mut system, &mut zero, 1e-12, 1e-12), Ok(0));
        assert!(zero.iter().all(|x| *x == 0.0));
        struct Scaling;
        impl LinearSystem for Scaling {
            fn apply(&mut self, x: &[f64], out: &mut [f64]) {
                out.iter_mut().zip(x).for_each(|(o, x)| *o = 4.0 * x);
            }
            fn precondition(&mut self, x: &mut [f64]) {
                x.iter_mut().for_each(|x| *x /= 4.0);
            }
        }
        let mut x = vec![4.0, 8.0];
        assert_eq!(Gmres::default().solve(&mut Scaling, &mut x, 1e-14, 1e-14), Ok(0));
        assert_eq!(x, [1.0, 2.0]);
    }

    #[test]
    fn restarts_reach_a_solution_that_one_space_does_not_contain() {
        let mut system = ConvectedLine { convection: 0.1, shift: 5e-3, diagonal: false };
        let b = load(400);
        let mut x = b.clone();
        let iterations = Gmres::default().solve(&mut system, &mut x, 1e-10, 1e-10).unwrap();
        assert!(iterations > SPACE, "{iterations} iterations");
        assert!(residual(&mut system, &x, &b) <= 1e-10);
    }

    #[test]
    fn singular_systems_are_refused_with_the_residual_and_leave_the_load_alone() {
        struct SingularProjection;
        impl LinearSystem for SingularProjection {
            fn apply(&mut self, x: &[f64], out: &mut [f64]) {
                out.copy_from_slice(x);
                out[0] = 0.0;
            }
            fn precondition(&mut self, _: &mut [f64]) {}
        }
        let b = vec![1.0; 4];
        let mut x = b.clone();
        let stopped = Gmres::default().solve(&mut SingularProjection, &mut x, 1e-10, 1e-10).unwrap_err();
        assert!((stopped.residual - 0.5).abs() < 1e-12, "{stopped}");
        assert_eq!(x, b);
    }

    #[test]
    fn results_do_not_depend_on_what_was_solved_before() {
        let solve = |gmres: &mut Gmres, n: usize| {
            let mut x = load(n);
            gmres
                .solve(&mut ConvectedLine { convection: 0.3, shift: 0.5, diagonal: true }, &mut x, 1e-12, 1e-12)
                .unwrap();
            x
        };
        let mut used = Gmres::default();
        solve(&mut used, 300);
        assert_eq!(solve(&mut used, 50), solve(&mut Gmres::default(), 50));
    }
}
