//! Surface temperatures, hot layers and mean temperatures of a state, from weights of the modes.

use super::melt::latent::LatentHeat;
use super::mesh::body::HeatBody;
use super::mesh::kernels::{dot, products};
use super::mesh::layout::HeatLayout;
use crate::heat::observation::{Observation, Temperatures};
use crate::heat::state::HeatState;
use crate::piecewise::peak;

/// Shallowest and number of depths over which means are prepared, in half-widths at the nominal load, and their growth.
const CORE_DEPTH: f64 = 0.1;
const CORE_DEPTHS: i32 = 9;
const CORE_GROWTH: f64 = 1.6;

/// Depth of the layer whose expansion acts on the contact, in half-widths at the nominal load.
const FLASH_DEPTH: f64 = 0.25;

/// Weights of the modes in observations of wheel and rail.
#[derive(Clone, Debug)]
pub struct ObservationWeights {
    /// Integrals over the layer whose expansion acts on the contact \[m]; of the rail less the temperature a half-width
    /// below the surface.
    layer: [Vec<f64>; 2],
    /// First moments over that layer [m²]; of the rail less those of the temperature a half-width below.
    moments: [Vec<f64>; 2],
    /// Means from the surface down to depths that grow by the factor [`CORE_GROWTH`] from [`CORE_DEPTH`] half-widths on
    /// \[1].
    core: [Vec<Vec<f64>>; 2],
}

impl ObservationWeights {
    /// Weights for the modes of both bodies.
    pub fn new(layout: &HeatLayout) -> Self {
        let c = &layout.config;
        let flash = FLASH_DEPTH * c.half_width;
        let mut layer = layout.bodies().map(|body| body.modes.integrals(flash));
        let mut moments = layout.bodies().map(|body| body.modes.moments(flash));
        // Rail that is as warm in the depth grows as a whole and not at the contact.
        let below = layout.rail.modes.at(c.half_width.min(c.rail_height));
        for (weights, of_one) in [(&mut layer[1], flash), (&mut moments[1], 0.5 * flash * flash)] {
            weights.iter_mut().zip(&below).for_each(|(weight, value)| *weight -= of_one * value);
        }
        let core = layout.bodies().map(|body| {
            let depths = (0..CORE_DEPTHS).map(|k| CORE_DEPTH * c.half_width * CORE_GROWTH.powi(k));
            depths.map(|depth| body.modes.integrals(depth).iter().map(|i| i / depth).collect()).collect()
        });
        Self { layer, moments, core }
    }

    /// Replaces `seen` by the observation of a state; `latent` is given where steel melts in it.
    pub fn observe(&self, layout: &HeatLayout, latent: Option<&LatentHeat>, state: &HeatState, seen: &mut Observation) {
        let mut volume_means = [0.0; 2];
        for (i, (body, field)) in layout.bodies().into_iter().zip(layout.split(&state.values)).enumerate() {
            seen.sums.clone_from(&state.sums[i]);
            if seen.sums.is_empty() {
                body.integrate(field, &mut seen.sums);
            }
            volume_means[i] = self.observe_body(layout, i, body, field, seen);
        }
        seen.lowest = state.range[0];
        let melted = latent.map_or([0.0; 2], |latent| self.take_latent_heat(layout, latent, state, seen));
        let (x, [wheel, rail]) = (layout.zone_positions(), &seen.surface);
        seen.temperatures = Temperatures {
            wheel_max: peak(x, wheel),
            rail_max: peak(x, rail),
            wheel_centre: wheel[layout.zone_cells],
            rail_centre: rail[layout.zone_cells],
            wheel_mean: volume_means[0],
            rail_mean: volume_means[1],
            melted,
        };
    }

    /// Fills surface and layer of the body `i` (0: wheel, 1: rail), whose sums along the streamlines are known; its mean
    /// over the volume \[K].
    fn observe_body(
        &self,
        layout: &HeatLayout,
        i: usize,
        body: &HeatBody,
        field: &[f64],
        seen: &mut Observation,
    ) -> f64 {
        let (nodes, nm) = (layout.zone_nodes(body), body.modes.len());
        let (weights, moments) = (&self.layer[i], &self.moments[i]);
        let zone = &field[nodes.start * nm..nodes.end * nm];
        let out = [&mut seen.surface[i], &mut seen.layer[i], &mut seen.moments].map(|values| {
            values.resize(nodes.len(), 0.0);
            &mut values[..]
        });
        for (shape, out) in [&body.modes.surface, weights, moments].into_iter().zip(out) {
            products(zone, shape, out);
        }
        let mean = |weights: &[f64]| {
            if body.streamline.closed > 0.0 { dot(&seen.sums, weights) / body.streamline.closed } else { 0.0 }
        };
        let (along, moment_along) = (mean(weights), mean(moments));
        seen.layer[i].iter_mut().for_each(|content| *content -= along);
        let moments = seen.moments.iter().map(|moment| moment - moment_along);
        seen.layer_depth[i] = mean_depth(moments, &seen.layer[i]);
        body.heat_capacity * dot(&seen.sums, &body.modes.content) / layout.heat_capacity(body)
    }

    /// Turns heat contents that were observed into temperatures; the largest molten thickness of wheel and rail in the
    /// contact zone \[m].
    fn take_latent_heat(
        &self,
        layout: &HeatLayout,
        latent: &LatentHeat,
        state: &HeatState,
        seen: &mut Observation,
    ) -> [f64; 2] {
        let Observation { surface, layer, sums: values, .. } = seen;
        let (mut melted, mut search) = ([0.0_f64; 2], Default::default());
        for (i, (body, field)) in layout.bodies().into_iter().zip(layout.split(&state.values)).enumerate() {
            let (zone, nm) = (layout.zone_nodes(body), body.modes.len());
            values.resize(nm, 0.0);
            let rows = field[zone.start * nm..zone.end * nm].chunks_exact(nm);
            for ((row, surface), layer) in rows.zip(&mut surface[i]).zip(&mut layer[i]) {
                if let Some(molten) = latent.below(i, &body.nodal, row, values, &mut search) {
                    *surface -= dot(values, &body.modes.surface);
                    *layer -= dot(values, &self.layer[i]);
                    melted[i] = melted[i].max(molten);
                }
            }
        }
        melted
    }

    /// Replaces `out` by the mean temperatures of wheel and rail from the surface down to `depth` \[m] at the surface
    /// nodes of the contact zone.
    pub fn mean_over_depth(&self, layout: &HeatLayout, field: &[f64], depth: f64, out: &mut [Vec<f64>; 2]) {
        let (above, share) = core_place(depth, layout.config.half_width);
        for (i, (body, field)) in layout.bodies().into_iter().zip(layout.split(field)).enumerate() {
            let (nodes, nm) = (layout.zone_nodes(body), body.modes.len());
            let [low, high] = [above, above + 1].map(|k| &self.core[i][k]);
            let shape: Vec<f64> = low.iter().zip(high).map(|(low, high)| low + share * (high - low)).collect();
            out[i].resize(nodes.len(), 0.0);
            products(&field[nodes.start * nm..nodes.end * nm], &shape, &mut out[i]);
        }
    }
}

/// Place of a depth \[m] among the prepared ones: the one above it and the share of the next.
fn core_place(depth: f64, half_width: f64) -> (usize, f64) {
    let place = libm::log(depth / (CORE_DEPTH * half_width)) / libm::log(CORE_GROWTH);
    let place = place.clamp(0.0, f64::from(CORE_DEPTHS - 1));
    let above = (place.floor() as usize).min(CORE_DEPTHS as usize - 2);
    (above, place - above as f64)
}

/// Mean depth of heat \[m] with the first moments and the contents `layer` of the columns; zero where the layer is
/// colder than the rest of the tread, and in between where it is warmer in parts.
fn mean_depth(moments: impl Iterator<Item = f64>, layer: &[f64]) -> f64 {
    let (net, content) = layer.iter().fold((0.0, 0.0), |(net, sum), heat| (net + heat, sum + heat.abs()));
    let warm = f64::max(net / content, 0.0);
    if warm > 0.0 { warm * moments.map(f64::abs).sum::<f64>() / content } else { 0.0 }
}
