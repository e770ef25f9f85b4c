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
        "{parameter} = {modes} modes on a mesh of {unknowns:.0} unknowns would need {memory:.1e} bytes, more than \
         {limit:.1e}: lower {parameter} or mesh.elements_per_half_width"
    )]
    TooManyModes {
        /// Name of the parameter.
        parameter: &'static str,
        /// Its value.
        modes: usize,
        /// Number of unknown displacements.
        unknowns: f64,
        /// Memory needed \[bytes].
        memory: f64,
        /// Largest value that is accepted.
        limit: f64,
    },
    /// Vibration modes that could not be computed.
    #[error("no vibration modes for {parameter} = {modes}: {source}; lower it, or change mesh.elements_per_half_width")]
    Modes {
        /// Name of the parameter.
        parameter: &'static str,
        /// Its value.
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
