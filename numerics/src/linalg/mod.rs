//! Linear algebra: sparse matrices with a Cholesky factorisation (over faer), the lowest modes of a pencil,
//! small dense systems, GMRES and Anderson mixing.
//!
//! Two libraries share the work. faer factorises and multiplies large matrices; substitutions with its sparse factors
//! are ours, for several columns side by side. nalgebra holds the small dense ones of the bodies and solves the dense
//! symmetric eigenproblems of the modes, because the divide and conquer of faer 0.24.4 loses nine digits there (also
//! faer-rs issue 273); a test in [`krylov`] tells when that has changed. Loops that take most of the time of a step are
//! written for the vector registers at hand ([`vectorised`], over pulp).

pub mod anderson;
mod blocks;
pub mod cholesky;
pub mod dense;
mod error;
pub mod gmres;
mod krylov;
mod lagrange;
pub mod modes;
pub mod parity;
pub mod pencil;
mod side_by_side;
pub mod sparse;
pub mod vectorised;

pub use cholesky::{Cholesky, CholeskyPattern};
pub use dense::DenseSystem;
pub use error::LinalgError;
pub use krylov::Oscillator;
pub use lagrange::{Lagrange, POINTS, Polynomial};
pub use modes::{VibrationModes, lowest_modes, lowest_modes_of_parts};
pub use parity::{Parity, ParityPart, Reflection};
pub use side_by_side::{join, side_by_side};
pub use sparse::CsrMatrix;
pub use vectorised::{Update, multiply_transposed};
