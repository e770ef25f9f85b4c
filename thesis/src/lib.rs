//! The methods of A. Draganis' thesis, as they stand in it, and its figures and tables beside the product's results.
//!
//! The product solves the same equations by other means. Nothing of this crate enters it; here the thesis's own schemes
//! exist, run and are compared. `docs/thesis.md` says which equations were changed and what came out.
//!
//! `[A]` to `[D]` are the papers of the thesis, `[I]` its introduction: a number in brackets is an equation, one after
//! § a section, and figures and tables have their names.
//!
//! SI units, per metre of width. x points in travel direction, y up.
#![forbid(unsafe_code)]
#![warn(missing_docs)]

pub mod annulus;
pub mod contact;
pub mod coupled;
pub mod decomposition;
pub mod dual;
pub mod dynamic;
pub mod elastic;
pub mod errors;
pub mod figures;
pub mod flow;
pub mod heat;
pub mod iteration;
pub mod mesh;
pub mod newton;
pub mod one_dimension;
pub mod ours;
pub mod page;
pub mod paper_a;
pub mod plot;
pub mod quoted;
pub mod rail;
pub mod report;
pub mod rivara;
pub mod rolling;
pub mod sparse;
pub mod stabilise;
pub mod transient;
pub mod triangle;
pub mod unstructured;
pub mod warming;
pub mod waves;
pub mod wheel;

/// Why a computation has no result.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// A system without a unique solution.
    #[error("system of {size} unknowns cannot be solved: {reason}")]
    Singular {
        /// Number of unknowns.
        size: usize,
        /// Message of the factorisation.
        reason: String,
    },
    /// A Newton iteration that does not end.
    #[error("Newton's iteration stalls after {iterations} steps at a residual of {residual:.1e} of the load")]
    NotConverged {
        /// Steps taken.
        iterations: usize,
        /// Largest residual over the load \[1].
        residual: f64,
    },
}
