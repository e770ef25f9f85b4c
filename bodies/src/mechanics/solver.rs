//! How the equations of a step `(a0² M + a0 D + K) y = f` are solved.

use crate::linalg::{Cholesky, LinalgError};
use nalgebra::{DMatrix, DVector, Dyn};

/// A factorised matrix `A = a0² M + a0 D + K`, symmetric and positive definite.
pub trait StepSolver: Send + Sync {
    /// `f ← A⁻¹ f`; allocates nothing unless the matrix is sparse.
    fn solve_in_place(&self, f: &mut DVector<f64>);
}

/// Vibration modes without damping, or with damping that does not couple them: `A` is diagonal.
pub struct Diagonal {
    /// Entries of `A⁻¹`.
    pub inverse: DVector<f64>,
}

impl StepSolver for Diagonal {
    fn solve_in_place(&self, f: &mut DVector<f64>) {
        f.component_mul_assign(&self.inverse);
    }
}

/// Vibration modes that damping couples: the Cholesky factor of a small dense matrix.
pub struct Dense {
    factor: nalgebra::Cholesky<f64, Dyn>,
}

impl Dense {
    /// Factorises `matrix`; an error unless it is positive definite.
    pub fn new(matrix: DMatrix<f64>) -> Result<Self, LinalgError> {
        let size = matrix.nrows();
        let reason = || "dense Cholesky factorisation met a pivot that is not positive".to_owned();
        let factor = matrix.cholesky().ok_or_else(|| LinalgError::NotPositiveDefinite { size, reason: reason() })?;
        Ok(Self { factor })
    }

    /// `A⁻¹ B`.
    pub fn solve(&self, columns: &DMatrix<f64>) -> DMatrix<f64> {
        self.factor.solve(columns)
    }
}

impl StepSolver for Dense {
    fn solve_in_place(&self, f: &mut DVector<f64>) {
        self.factor.solve_mut(f);
    }
}

impl StepSolver for Cholesky {
    fn solve_in_place(&self, f: &mut DVector<f64>) {
        Cholesky::solve_in_place(self, f.as_mut_slice());
    }
}
