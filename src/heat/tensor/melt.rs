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
//! Every iterate keeps the heat balance to round-off, because the linear equations hold for it exactly. Where in a column the
//! latent part lies is the matter of [`Column`](super::column::Column).

use super::column::Found;
use super::layout::Heat;
use super::modal::{StageCoefficients, dot};
use super::stage::Stage;
use super::state::HeatState;
use crate::heat::error::HeatError;
use crate::heat::melting::Melting;
use crate::heat::model::Observation;
use crate::linalg::anderson::Anderson;
use std::ops::Range;

/// Change of the latent part between two iterations at which it counts as found \[K], and the most that is accepted.
const TOLERANCE: f64 = 0.01;
const ACCEPTED: f64 = 1.0;
/// Heat content over `ρc` from which on iron boils \[K], and what is molten below a surface node needs no exact place.
const BOILING: f64 = 3400.0;
/// Most iterations with columns, and with nodes alone.
const ITERATIONS: [usize; 2] = [30, 100];

/// Memory of the iteration.
#[derive(Clone, Debug, Default)]
pub(super) struct Melt {
    /// Coefficients of the latent part of wheel and rail, and their image.
    latent: Vec<f64>,
    image: Vec<f64>,
    /// Coefficients of the temperature.
    temperature: Vec<f64>,
    /// Heat content at the end of the step.
    content: Vec<f64>,
    search: Search,
    mixing: Mixing,
}

/// Mixing of the columns in which steel melts; most have no latent part before and after.
#[derive(Clone, Debug, Default)]
struct Mixing {
    /// Their coefficients, counted in both bodies.
    places: Vec<usize>,
    latent: Vec<f64>,
    image: Vec<f64>,
    anderson: Anderson,
}

impl Mixing {
    /// Starts with the coefficients that do not vanish before or after the first iteration.
    fn begin(&mut self, latent: &[f64], image: &[f64]) {
        self.anderson.restart();
        self.places.clear();
        self.places.extend((0..latent.len()).filter(|&i| latent[i] != 0.0 || image[i] != 0.0));
    }

    /// Moves the latent part on; what melts later than in the first iteration takes its image.
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

/// Memory of a look at one column.
#[derive(Clone, Debug, Default)]
pub(super) struct Search {
    /// Heat content at the nodes.
    values: Vec<f64>,
    found: Found,
    /// Whether the nodes alone decide what is molten.
    by_nodes: bool,
}

impl Melt {
    /// Coefficients of the temperature at the heat content that the last step ended with.
    pub fn temperature(&mut self, content: &[f64]) -> &[f64] {
        self.temperature.clear();
        self.temperature.extend(content.iter().zip(&self.latent).map(|(h, latent)| h - latent));
        &self.temperature
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
        let Melt { latent, image, content, search, mixing, .. } = work;
        let mut change = f64::INFINITY;
        // Where columns are too coarse for a front, what is molten may jump between both ways to find it.
        for (by_nodes, most) in [false, true].into_iter().zip(ITERATIONS) {
            search.by_nodes = by_nodes;
            self.set_latent(melting, before, latent, search);
            for iteration in 1..=most {
                rate.clone_from(base);
                stage.multiply_still(self, StageCoefficients { storage: 0.0, flow: 1.0 }, latent, rate);
                stage.solve(self, coefficients, rate)?;
                content.clear();
                content.extend(before.iter().zip(&*rate).map(|(h, k)| h + coefficients.flow * k));
                self.set_latent(melting, content, image, search);
                change = self.largest_difference(latent, image, search);
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

    /// Turns heat contents that were observed into temperatures; the largest molten thickness of wheel and rail in the
    /// contact zone \[m].
    pub(super) fn observe_melting(&self, state: &HeatState, seen: &mut Observation) -> [f64; 2] {
        let mut melted = [0.0_f64; 2];
        let Some(melting) = self.melting_at(state) else { return melted };
        let fields = self.split(state);
        let mut search = Search::default();
        let Observation { surface, layer, sums: values, .. } = seen;
        for (i, (body, field)) in [(&self.wheel, fields.0), (&self.rail, fields.1)].into_iter().enumerate() {
            let (zone, nm) = (self.zone_nodes(body), body.modes.len());
            values.resize(nm, 0.0);
            let rows = field[zone.start * nm..zone.end * nm].chunks_exact(nm);
            for ((row, surface), layer) in rows.zip(&mut surface[i]).zip(&mut layer[i]) {
                if self.latent_below(i, &melting, row, values, &mut search) {
                    *surface -= dot(values, &body.modes.surface);
                    *layer -= dot(values, &self.layer_weights[i]);
                    melted[i] = melted[i].max(search.found.molten);
                }
            }
        }
        melted
    }

    /// Replaces the heat contents of columns of a body (0: wheel, 1: rail) by their temperatures, where steel melts in `state`.
    pub(super) fn cool_columns(&self, body: usize, state: &HeatState, rows: &mut [f64]) {
        let Some(melting) = self.melting_at(state) else { return };
        let nm = self.nodal[body].modes();
        let (mut search, mut latent) = (Search::default(), vec![0.0; nm]);
        for row in rows.chunks_exact_mut(nm) {
            if self.latent_below(body, &melting, row, &mut latent, &mut search) {
                row.iter_mut().zip(&latent).for_each(|(x, latent)| *x -= latent);
            }
        }
    }

    /// How steel melts, if any does in a state.
    fn melting_at(&self, state: &HeatState) -> Option<Melting> {
        self.melting.filter(|melting| state.range[1] > melting.solidus)
    }

    /// Replaces `latent` by the coefficients of the latent part below one surface node of a body; whether there is any.
    fn latent_below(
        &self,
        body: usize,
        melting: &Melting,
        row: &[f64],
        latent: &mut [f64],
        search: &mut Search,
    ) -> bool {
        let (nodal, column) = (&self.nodal[body], &self.columns[body]);
        let Search { values, found, by_nodes } = search;
        // Most rows are known to be solid without a look at their nodes.
        if nodal.bound(row) <= melting.solidus {
            return false;
        }
        values.resize(nodal.len(), 0.0);
        nodal.values(row, values);
        if values.iter().all(|h| *h <= melting.solidus) {
            return false;
        }
        if *by_nodes || values.iter().any(|h| *h > BOILING) {
            column.find_by_nodes(melting, values, found);
        } else {
            column.find(melting, values, found);
        }
        latent.fill(0.0);
        nodal.add(&found.latent, latent);
        true
    }

    /// Replaces `out` by the coefficients of the latent part of both bodies.
    fn set_latent(&self, melting: &Melting, content: &[f64], out: &mut Vec<f64>, search: &mut Search) {
        out.clear();
        out.resize(content.len(), 0.0);
        for (body, range) in self.ranges().into_iter().enumerate() {
            let nm = self.nodal[body].modes();
            for (row, out) in content[range.clone()].chunks_exact(nm).zip(out[range].chunks_exact_mut(nm)) {
                self.latent_below(body, melting, row, out, search);
            }
        }
    }

    /// Largest difference of two fields at the nodes \[K].
    fn largest_difference(&self, a: &[f64], b: &[f64], search: &mut Search) -> f64 {
        let (mut largest, mut difference) = (0.0_f64, Vec::new());
        for (body, range) in self.ranges().into_iter().enumerate() {
            let nodal = &self.nodal[body];
            search.values.resize(nodal.len(), 0.0);
            for (a, b) in a[range.clone()].chunks_exact(nodal.modes()).zip(b[range].chunks_exact(nodal.modes())) {
                difference.clear();
                difference.extend(a.iter().zip(b).map(|(a, b)| a - b));
                if nodal.bound(&difference) > TOLERANCE {
                    nodal.values(&difference, &mut search.values);
                    largest = search.values.iter().fold(largest, |largest, value| largest.max(value.abs()));
                }
            }
        }
        largest
    }

    /// Where the coefficients of wheel and rail lie in a field.
    fn ranges(&self) -> [Range<usize>; 2] {
        let wheel = self.wheel.size();
        [0..wheel, wheel..wheel + self.rail.size()]
    }
}
