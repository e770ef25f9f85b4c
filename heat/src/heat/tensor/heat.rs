//! Heat model on tensor meshes: its immutable data.

use super::melt::latent::LatentHeat;
use super::mesh::body::HeatBody;
use super::mesh::kernels::dot;
use super::mesh::layout::{HeatLayout, LAYER_GROWTH};
use super::weights::ObservationWeights;
use crate::heat::error::HeatError;
use crate::heat::parameters::HeatParameters;
use crate::heat::state::HeatState;

/// Temperatures of wheel and rail on tensor meshes (streamlines × depth); immutable.
#[derive(Clone, Debug)]
pub struct Heat {
    /// Meshes of both bodies.
    pub(super) layout: HeatLayout,
    /// Latent heat, unless melting is left out.
    pub(super) latent: Option<LatentHeat>,
    /// Weights of the modes in observations.
    pub(super) weights: ObservationWeights,
}

impl Heat {
    /// Meshes and modes for the given parameters.
    ///
    /// Fails for parameters on which no mesh can be laid, and if the modes over the depth are not found.
    pub fn new(config: &HeatParameters) -> Result<Self, HeatError> {
        Self::with_layers(config, LAYER_GROWTH)
    }

    /// Meshes with layers that grow by `growth` from one to the next, for studies of the mesh.
    pub fn with_layers(config: &HeatParameters, growth: f64) -> Result<Self, HeatError> {
        let layout = HeatLayout::new(config, growth)?;
        Ok(Self { latent: LatentHeat::new(&layout), weights: ObservationWeights::new(&layout), layout })
    }

    /// Parameters that this model was made from.
    pub fn config(&self) -> &HeatParameters {
        &self.layout.config
    }

    /// Number of unknown temperatures.
    pub fn unknowns(&self) -> usize {
        self.layout.bodies().map(|body| body.streamline.len() * body.modes.shapes.nrows()).iter().sum()
    }

    /// Heat contents of wheel and rail over the reference temperature [J/m], over the width of the contact.
    pub fn heat_content(&self, state: &HeatState) -> Result<[f64; 2], HeatError> {
        self.check_state(state)?;
        let (bodies, fields) = (self.layout.bodies(), self.layout.split(&state.values));
        Ok([0, 1].map(|i| {
            let mut sums = Vec::new();
            bodies[i].integrate(fields[i], &mut sums);
            bodies[i].heat_capacity * dot(&sums, &bodies[i].modes.content)
        }))
    }

    /// State of bodies at the uniform temperatures `wheel` and `rail` over the reference \[K].
    pub(super) fn uniform(&self, wheel: f64, rail: f64) -> HeatState {
        let [wheel, rail] = [wheel, rail].map(|temperature| self.content(temperature));
        let uniform = |body: &HeatBody, content: f64| -> Vec<f64> {
            body.modes.free.iter().cycle().take(body.size()).map(|one| content * one).collect()
        };
        let data = [wheel.min(rail).min(0.0), wheel.max(rail).max(0.0)];
        let values = [uniform(&self.layout.wheel, wheel), uniform(&self.layout.rail, rail)].concat();
        HeatState { values, arriving: rail, data, range: data, ..HeatState::default() }
    }

    /// Heat content over `ρc` at a temperature over the reference \[K].
    pub(super) fn content(&self, temperature: f64) -> f64 {
        self.latent.as_ref().map_or(temperature, |latent| latent.melting.content(temperature))
    }

    /// Latent heat, if the nodal values of a field that keeps the bounds `range` \[K] may melt.
    pub(super) fn melting_within(&self, range: [f64; 2]) -> Option<&LatentHeat> {
        self.latent.as_ref().filter(|latent| range[1] > latent.melting.solidus)
    }

    /// Refuses a state of another model.
    pub(super) fn check_state(&self, state: &HeatState) -> Result<(), HeatError> {
        let (expected, found) = (self.layout.size(), state.values.len());
        if found == expected { Ok(()) } else { Err(HeatError::StateSize { expected, found }) }
    }
}
