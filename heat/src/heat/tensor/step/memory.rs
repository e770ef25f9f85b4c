//! Memory that steps reuse.

use super::loads::SurfaceLoads;
use super::plan::StepPlan;
use crate::heat::parameters::HeatParameters;
use crate::heat::state::HeatState;
use crate::heat::tensor::melt::iteration::MeltingIteration;
use crate::heat::tensor::solve::line_conduction::LineConduction;
use crate::heat::tensor::solve::stage::Stage;

/// Memory of a step; holds nothing that outlives it.
#[derive(Default)]
pub struct HeatScratch {
    /// Parameters of the model whose operators `work` holds.
    pub(super) owner: Option<HeatParameters>,
    /// States in which the step of each line begins if another rail arrives.
    pub(super) begin: Vec<HeatState>,
    /// Memory of each line.
    pub(super) lines: Vec<LineWork>,
    pub(super) work: StepWork,
}

/// Memory of the stages that lines use in turn or together.
#[derive(Default)]
pub struct StepWork {
    /// Equations of a stage.
    pub stage: Stage,
    /// Values at the nodes below one surface node.
    pub values: Vec<f64>,
    /// Search for the latent part.
    pub melting: MeltingIteration,
}

/// Memory of a line.
#[derive(Default)]
pub struct LineWork {
    /// Plan of its step.
    pub plan: StepPlan,
    /// True if another rail arrives.
    pub arrived: bool,
    /// Loads on the surfaces.
    pub loads: SurfaceLoads,
    /// Conduction through the contact.
    pub contact: LineConduction,
    /// Rate of the field in a stage, and the field between two stages.
    pub rate: Vec<f64>,
    pub between: Vec<f64>,
    /// Distances by which values below every surface node may have moved in the step \[K], the wheel's first.
    pub moved: Vec<f64>,
}
