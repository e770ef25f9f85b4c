//! Why the bodies have no answer.

use crate::fem::FemError;
use crate::linalg::LinalgError;

/// The deformable bodies cannot be set up or factorised.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MechanicsError {
    /// A mesh with more unknowns than can be dealt with.
    #[error(
        "the mesh of the {body} would have {unknowns:.0} unknowns, more than {limit:.0}: {causes}; choose dimensions of \
         similar size, lower mesh.elements_per_half_width or raise model.nominal_load and set \
         drive.load, which follows it unless set"
    )]
    TooLarge {
        /// Which body: wheel or rail.
        body: &'static str,
        /// Number of unknown displacements.
        unknowns: f64,
        /// Largest value that is accepted.
        limit: f64,
        /// Parameters on which the size depends, with their values.
        causes: String,
    },
    /// Vibration modes that need more memory than can be given.
    #[error(
        "the {modes} vibration modes of the {body} on a mesh of {unknowns:.0} unknowns would need {memory:.1e} bytes, more \
         than {limit:.1e}: lower mesh.elements_per_half_width"
    )]
    TooManyModes {
        /// Which body: wheel or rail.
        body: &'static str,
        /// Number of modes.
        modes: usize,
        /// Number of unknown displacements.
        unknowns: f64,
        /// Memory needed \[bytes].
        memory: f64,
        /// Largest value that is accepted.
        limit: f64,
    },
    /// Vibration modes that could not be computed.
    #[error("no {modes} vibration modes of the {body}: {source}; change mesh.elements_per_half_width")]
    Modes {
        /// Which body: wheel or rail.
        body: &'static str,
        /// Number of modes.
        modes: usize,
        /// Why.
        source: LinalgError,
    },
    /// Dimensions on which no mesh can be laid out.
    #[error("no mesh of the {body}: {source}; {advice}")]
    Mesh {
        /// Which body: wheel or rail.
        body: &'static str,
        /// Why.
        source: FemError,
        /// Advice that names parameters.
        advice: &'static str,
    },
    /// A cell or an assembled matrix without meaning.
    #[error(transparent)]
    Fem(#[from] FemError),
    /// A system of equations without a solution.
    #[error(transparent)]
    Linalg(#[from] LinalgError),
}
