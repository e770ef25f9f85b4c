//! Why an operation has no answer.

/// A linear-algebra operation that has no answer.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LinalgError {
    /// A matrix entry outside the matrix.
    #[error("entry ({row}, {column}) lies outside a matrix of {rows} x {columns}")]
    OutOfRange {
        /// Row.
        row: usize,
        /// Column.
        column: usize,
        /// Number of rows.
        rows: usize,
        /// Number of columns.
        columns: usize,
    },
    /// Two matrices that cannot be combined.
    #[error("matrices of {left} and {right} unknowns do not match")]
    SizeMismatch {
        /// Unknowns of the first one.
        left: usize,
        /// Unknowns of the second one.
        right: usize,
    },
    /// A matrix whose Cholesky factor does not exist.
    #[error("matrix of {size} unknowns is not positive definite: {reason}")]
    NotPositiveDefinite {
        /// Number of unknowns.
        size: usize,
        /// Reason that the factorisation gives.
        reason: String,
    },
    /// The fill-in analysis failed (memory, index range).
    #[error("symbolic factorisation of {size} unknowns failed: {reason}")]
    Symbolic {
        /// Number of unknowns.
        size: usize,
        /// Reason that the factorisation gives.
        reason: String,
    },
    /// A dense symmetric eigenproblem failed.
    #[error("dense eigenproblem of {size} unknowns did not converge")]
    Eigen {
        /// Number of unknowns.
        size: usize,
    },
    /// More modes asked for than the matrix has unknowns.
    #[error("{wanted} modes wanted of a system with {size} unknowns")]
    TooManyModes {
        /// Modes asked for.
        wanted: usize,
        /// Number of unknowns.
        size: usize,
    },
    /// The Lanczos space reached its largest size first.
    #[error("{converged} of {wanted} modes converged in a Krylov space of {space} vectors (residual {residual:.2e})")]
    ModesNotConverged {
        /// Modes asked for.
        wanted: usize,
        /// Modes found.
        converged: usize,
        /// Vectors in the Krylov space.
        space: usize,
        /// Relative residual of the first one missing \[1].
        residual: f64,
    },
}
