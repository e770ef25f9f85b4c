//! A step in which steel melts or freezes.
//!
//! The field is the heat content `h` over `ρc`; the stream carries it, but only the temperature `T = h − ℓ(h)` conducts,
//! ℓ the latent part. With the matrices of storage and stream `A_h` and of conduction `A_T` the stage
//! `ρcM̃ k = f − A_h h − A_T T` is that of a step without melting and one more load,
//!
//! ```text
//! S k = f − (A_h + A_T) hₙ + A_T ℓ(hₙ + Δt k) .
//! ```
//!
//! ℓ is found as a fixed point. The map is a contraction, since ℓ changes by less than h, and Anderson mixing speeds it up.
//! Every iterate keeps the heat balance to round-off, because the linear equations hold for it exactly.

use super::layout::Heat;
use super::modal::StageCoefficients;
use super::stage::Stage;
use super::state::HeatState;
use crate::heat::error::HeatError;
use crate::heat::melting::Melting;
use crate::heat::model::Observation;
use crate::linalg::anderson::Anderson;

/// Change of the latent part between two iterations at which it counts as found \[K], and the most that is accepted.
const TOLERANCE: f64 = 0.01;
const ACCEPTED: f64 = 1.0;
const ITERATIONS: usize = 200;

/// Memory of the iteration.
#[derive(Clone, Debug, Default)]
pub(super) struct Melt {
    /// Latent part at the nodes of wheel and rail, and its image.
    latent: Vec<f64>,
    image: Vec<f64>,
    /// Coefficients of the latent part, then of the temperature.
    modal: Vec<f64>,
    /// Heat content at the end of the step.
    content: Vec<f64>,
    mixing: Anderson,
}

impl Melt {
    /// Coefficients of the temperature at the heat content that the last step ended with.
    pub fn temperature(&mut self, content: &[f64]) -> &[f64] {
        self.modal.iter_mut().zip(content).for_each(|(x, h)| *x = h - *x);
        &self.modal
    }
}

impl Heat {
    /// Replaces `rate` by that of a backward Euler step from the heat content `before` with the load `base`, melting
    /// included; the number of iterations.
    pub(super) fn melt(
        &self,
        melting: &Melting,
        stage: &mut Stage,
        coefficients: StageCoefficients,
        before: &[f64],
        [base, rate]: [&mut Vec<f64>; 2],
        work: &mut Melt,
    ) -> Result<usize, HeatError> {
        stage.set_still(self);
        let Melt { latent, image, modal, content, mixing } = work;
        mixing.restart();
        self.latent_at_nodes(melting, before, latent);
        let mut change = f64::INFINITY;
        for iteration in 1..=ITERATIONS {
            self.to_modes(latent, modal);
            rate.clone_from(base);
            stage.multiply_still(self, StageCoefficients { storage: 0.0, flow: 1.0 }, modal, rate);
            stage.solve(self, coefficients, rate)?;
            content.clear();
            content.extend(before.iter().zip(&*rate).map(|(h, k)| h + coefficients.flow * k));
            self.latent_at_nodes(melting, content, image);
            change = latent.iter().zip(&*image).fold(0.0, |largest: f64, (a, b)| largest.max((a - b).abs()));
            if change <= TOLERANCE || (iteration == ITERATIONS && change <= ACCEPTED) {
                return Ok(iteration);
            }
            mixing.mix(latent, image);
            latent.iter_mut().for_each(|value| *value = value.clamp(0.0, melting.latent));
        }
        Err(HeatError::MeltingNotConverged { change })
    }

    /// Turns heat contents that were observed into temperatures; the largest molten thickness of wheel and rail in the
    /// contact zone \[m].
    pub(super) fn observe_melting(&self, state: &HeatState, seen: &mut Observation) -> [f64; 2] {
        let mut melted = [0.0_f64; 2];
        let Some(melting) = self.melting.filter(|melting| state.range[1] > melting.solidus) else { return melted };
        let fields = self.split(state);
        let Observation { surface, layer, sums: values, .. } = seen;
        for (i, (body, field)) in [(&self.wheel, fields.0), (&self.rail, fields.1)].into_iter().enumerate() {
            let (nodal, zone, nm) = (&self.nodal[i], self.zone_nodes(body), body.modes.len());
            surface[i].iter_mut().for_each(|t| *t = melting.temperature(*t));
            values.resize(nodal.len(), 0.0);
            for (row, layer) in field[zone.start * nm..zone.end * nm].chunks_exact(nm).zip(&mut layer[i]) {
                nodal.values(row, values);
                values.iter_mut().for_each(|value| *value = melting.latent_part(*value));
                *layer -= values.iter().zip(&self.layer_nodes[i]).map(|(value, weight)| value * weight).sum::<f64>();
                melted[i] = melted[i].max(nodal.integral(values) / melting.latent);
            }
        }
        melted
    }

    /// Replaces `out` by the latent part at all nodes of both bodies.
    fn latent_at_nodes(&self, melting: &Melting, content: &[f64], out: &mut Vec<f64>) {
        let counts = [self.wheel.line.len() * self.nodal[0].len(), self.rail.line.len() * self.nodal[1].len()];
        out.clear();
        out.resize(counts[0] + counts[1], 0.0);
        let (fields, outs) = (content.split_at(self.wheel.size()), out.split_at_mut(counts[0]));
        for (nodal, field, out) in [(&self.nodal[0], fields.0, outs.0), (&self.nodal[1], fields.1, outs.1)] {
            for (row, out) in field.chunks_exact(nodal.modes()).zip(out.chunks_exact_mut(nodal.len())) {
                // Most rows are known to be solid without a look at their nodes.
                if nodal.bound(row) > melting.solidus {
                    nodal.values(row, out);
                    out.iter_mut().for_each(|value| *value = melting.latent_part(*value));
                }
            }
        }
    }

    /// Replaces `modal` by the coefficients of a field that is given at the nodes of both bodies.
    fn to_modes(&self, values: &[f64], modal: &mut Vec<f64>) {
        modal.clear();
        modal.resize(self.wheel.size() + self.rail.size(), 0.0);
        let split = self.wheel.line.len() * self.nodal[0].len();
        let (fields, values) = (modal.split_at_mut(self.wheel.size()), values.split_at(split));
        for (nodal, field, values) in [(&self.nodal[0], fields.0, values.0), (&self.nodal[1], fields.1, values.1)] {
            let rows = field.chunks_exact_mut(nodal.modes()).zip(values.chunks_exact(nodal.len()));
            rows.for_each(|(row, values)| nodal.add(values, row));
        }
    }
}
