//! The methods of A. Draganis' thesis, as they stand in it, and its figures and tables beside the product's results.
//!
//! The product solves the same equations by other means. Nothing of this crate enters it; here the thesis's own schemes
//! exist, run and are compared. `docs/thesis.md` goes through them equation by equation.
//!
//! SI units, per metre of width. x points in travel direction, y up.
#![forbid(unsafe_code)]
#![warn(missing_docs)]

pub mod annulus;
pub mod errors;
pub mod figures;
pub mod flow;
pub mod mesh;
pub mod one_dimension;
pub mod ours;
pub mod plot;
pub mod quoted;
pub mod rail;
pub mod report;
pub mod rivara;
pub mod sparse;
pub mod stabilise;
pub mod triangle;
pub mod wheel;

/// Why a computation has no result.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// A system without a unique solution.
    #[error("system of {size} unknowns cannot be solved: {reason}")]
    Singular {
        /// Number of unknowns.
        size: usize,
        /// What the factorisation says.
        reason: String,
    },
}
