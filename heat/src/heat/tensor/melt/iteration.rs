//! A step in which steel melts or freezes.
//!
//! The field is the heat content `h` over `ρc`; the stream carries it, but only the temperature `T = h − ℓ(h)`
//! conducts, ℓ the latent part. With the matrices of storage and stream `A_h` and of conduction `A_T` the stage
//! `ρcM̃ k = f − A_h h − A_T T` is that of a step without melting and one more load,
//!
//! ```text
//! S k = f − (A_h + A_T) hₙ + A_T ℓ(hₙ + Δt k) .
//! ```
//!
//! ℓ is found as a fixed point. The map is a contraction, since ℓ changes by less than h, and Anderson mixing speeds it
//! up. Every iterate keeps the heat balance to round-off, because the linear equations hold for it exactly. Where in a
//! column the latent part lies is found by [`DepthColumn`](super::column::DepthColumn).

use super::latent::{ColumnSearch, LatentHeat};
use crate::heat::error::HeatError;
use crate::heat::tensor::mesh::layout::HeatLayout;
use crate::heat::tensor::solve::coefficients::StageCoefficients;
use crate::heat::tensor::solve::line_conduction::LineConduction;
use crate::heat::tensor::solve::stage::Stage;
use crate::linalg::anderson::Anderson;

/// Change of the latent part between two iterations at which it counts as found \[K], and the most that is accepted.
const TOLERANCE: f64 = 0.01;
const ACCEPTED: f64 = 1.0;
/// Most iterations with columns, and with nodes alone.
const ITERATIONS: [usize; 2] = [30, 100];

/// Fixed-point iteration for the latent part, with its memory.
#[derive(Clone, Debug, Default)]
pub struct MeltingIteration {
    /// Coefficients of the latent part of wheel and rail, and their image.
    latent: Vec<f64>,
    image: Vec<f64>,
    /// Coefficients of the temperature.
    temperature: Vec<f64>,
    /// Heat content at the end of the step.
    content: Vec<f64>,
    /// Load on the equations, without the latent part.
    base: Vec<f64>,
    search: ColumnSearch,
    mixing: ColumnMixing,
}

/// Mixing of the columns in which steel melts; most have no latent part before and after.
#[derive(Clone, Debug, Default)]
struct ColumnMixing {
    /// Their coefficients, counted in both bodies.
    places: Vec<usize>,
    latent: Vec<f64>,
    image: Vec<f64>,
    anderson: Anderson,
}

impl ColumnMixing {
    /// Starts with the coefficients that do not vanish before or after the first iteration.
    fn begin(&mut self, latent: &[f64], image: &[f64]) {
        self.anderson.restart();
        self.places.clear();
        self.places.extend((0..latent.len()).filter(|&i| latent[i] != 0.0 || image[i] != 0.0));
    }

    /// Moves the latent part on; coefficients that change after the first iteration take their image.
    fn mix(&mut self, latent: &mut [f64], image: &[f64]) {
        let Self { places, latent: few, image: few_images, anderson } = self;
        for (few, all) in [(&mut *few, &*latent), (&mut *few_images, image)] {
            few.clear();
            few.extend(places.iter().map(|&i| all[i]));
        }
        anderson.mix(few, few_images);
        latent.copy_from_slice(image);
        places.iter().zip(few).for_each(|(&i, value)| latent[i] = *value);
    }
}

impl MeltingIteration {
    /// Coefficients of the temperature at the heat content that the last step ended with.
    pub fn temperature(&mut self, content: &[f64]) -> &[f64] {
        self.temperature.clear();
        self.temperature.extend(content.iter().zip(&self.latent).map(|(h, latent)| h - latent));
        &self.temperature
    }

    /// Replaces `rate`, the load on a backward Euler step from the heat content `before`, by the rate of that step,
    /// melting included; the number of iterations.
    pub fn solve(
        &mut self,
        law: &LatentHeat,
        layout: &HeatLayout,
        stage: &mut Stage,
        coefficients: StageCoefficients,
        before: &[f64],
        (line, rate): (&mut LineConduction, &mut Vec<f64>),
    ) -> Result<usize, HeatError> {
        let Self { latent, image, content, base, search, mixing, .. } = self;
        base.clone_from(rate);
        stage.operators.set_still(layout);
        let mut change = f64::INFINITY;
        // Where columns are too coarse for a front, the molten part may jump between both searches.
        for (by_nodes, most) in [false, true].into_iter().zip(ITERATIONS) {
            search.by_nodes = by_nodes;
            law.find(layout, before, latent, search);
            for iteration in 1..=most {
                rate.clone_from(base);
                let conduction = StageCoefficients { storage: 0.0, flow: 1.0 };
                stage.operators.multiply_still(layout, conduction, latent, (&mut *line, &mut rate[..]));
                stage.solve(layout, coefficients, (&mut *line, &mut rate[..]))?;
                content.clear();
                content.extend(before.iter().zip(&*rate).map(|(h, k)| h + coefficients.flow * k));
                law.find(layout, content, image, search);
                change = largest_difference(layout, latent, image, &mut search.values);
                if change <= TOLERANCE || (iteration == most && change <= ACCEPTED) {
                    return Ok(iteration);
                }
                if iteration == 1 {
                    mixing.begin(latent, image);
                }
                mixing.mix(latent, image);
            }
        }
        Err(HeatError::MeltingNotConverged { change })
    }
}

/// Largest difference of two fields at the nodes \[K]; `values` is a buffer.
fn largest_difference(layout: &HeatLayout, a: &[f64], b: &[f64], values: &mut Vec<f64>) -> f64 {
    let (mut largest, mut difference) = (0.0_f64, Vec::new());
    for (body, (a, b)) in layout.bodies().into_iter().zip(layout.split(a).into_iter().zip(layout.split(b))) {
        let nodal = &body.nodal;
        values.resize(nodal.len(), 0.0);
        for (a, b) in a.chunks_exact(nodal.modes()).zip(b.chunks_exact(nodal.modes())) {
            difference.clear();
            difference.extend(a.iter().zip(b).map(|(a, b)| a - b));
            if nodal.bound(&difference) > TOLERANCE {
                nodal.values(&difference, values);
                largest = values.iter().fold(largest, |largest, value| largest.max(value.abs()));
            }
        }
    }
    largest
}
