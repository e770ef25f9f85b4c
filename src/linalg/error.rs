//! Why an operation has no answer.

/// A linear-algebra operation that has no answer.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LinalgError {
    /// A matrix entry outside the matrix.
    #[error("entry ({row}, {column}) lies outside a matrix of {rows} x {columns}")]
    OutOfRange { row: usize, column: usize, rows: usize, columns: usize },
    /// Two matrices that cannot be combined.
    #[error("matrices of {left} and {right} unknowns do not match")]
    SizeMismatch { left: usize, right: usize },
    /// A matrix whose Cholesky factor does not exist.
    #[error("matrix of {size} unknowns is not positive definite: {reason}")]
    NotPositiveDefinite { size: usize, reason: String },
    /// The fill-in analysis failed (memory, index range).
    #[error("symbolic factorisation of {size} unknowns failed: {reason}")]
    Symbolic { size: usize, reason: String },
    /// A dense symmetric eigenproblem failed.
    #[error("dense eigenproblem of {size} unknowns did not converge")]
    Eigen { size: usize },
    /// More modes asked for than the matrix has unknowns.
    #[error("{wanted} modes wanted of a system with {size} unknowns")]
    TooManyModes { wanted: usize, size: usize },
    /// The Lanczos space reached its largest size first.
    #[error("{converged} of {wanted} modes converged in a Krylov space of {space} vectors (residual {residual:.2e})")]
    ModesNotConverged { wanted: usize, converged: usize, space: usize, residual: f64 },
}
