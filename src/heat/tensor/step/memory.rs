//! Memory that steps reuse.

use super::loads::SurfaceLoads;
use crate::heat::parameters::HeatConfig;
use crate::heat::state::HeatState;
use crate::heat::tensor::melt::iteration::MeltingIteration;
use crate::heat::tensor::solve::solver::StageSolver;

/// Memory of a step; holds nothing that outlives it.
#[derive(Default)]
pub struct HeatScratch {
    /// Parameters of the model whose operators `work` holds.
    pub(super) owner: Option<HeatConfig>,
    /// State in which the step begins if another rail arrives.
    pub(super) begin: HeatState,
    pub(super) work: StepWork,
}

/// Memory of the stages.
#[derive(Default)]
pub struct StepWork {
    /// Equations of a stage.
    pub solver: StageSolver,
    /// Loads on the surfaces.
    pub loads: SurfaceLoads,
    /// Rate of the field in a stage.
    pub rate: Vec<f64>,
    /// Values at the nodes below one surface node.
    pub values: Vec<f64>,
    /// Search for the latent part.
    pub melting: MeltingIteration,
}
