//! Why the bodies have no answer.

use crate::fem::FemError;
use crate::linalg::LinalgError;

/// The deformable bodies cannot be set up or factorised.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MechanicsError {
    /// A mesh with more unknowns than can be dealt with.
    #[error(
        "the mesh of the {body} would have {unknowns:.0} unknowns, more than {limit:.0}: {causes}; choose dimensions of \
         similar size, lower mesh.elements_per_half_width or raise model.nominal_load"
    )]
    TooLarge { body: &'static str, unknowns: f64, limit: f64, causes: String },
    /// Vibration modes that need more memory than can be given.
    #[error(
        "{parameter} = {modes} modes on a mesh of {unknowns:.0} unknowns would need {memory:.1e} bytes, more than \
         {limit:.1e}: lower {parameter} or mesh.elements_per_half_width"
    )]
    TooManyModes { parameter: &'static str, modes: usize, unknowns: f64, memory: f64, limit: f64 },
    /// Vibration modes that could not be computed.
    #[error("no vibration modes for {parameter} = {modes}: {source}; lower it, or change mesh.elements_per_half_width")]
    Modes { parameter: &'static str, modes: usize, source: LinalgError },
    /// Dimensions on which no mesh can be laid out.
    #[error("no mesh of the {body}: {source}; {advice}")]
    Mesh { body: &'static str, source: FemError, advice: &'static str },
    /// A cell or an assembled matrix without meaning.
    #[error(transparent)]
    Fem(#[from] FemError),
    /// A system of equations without a solution.
    #[error(transparent)]
    Linalg(#[from] LinalgError),
}
