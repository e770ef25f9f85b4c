//! The heat model on tensor meshes: streamlines × depth, solved mode by mode.
//!
//! Both bodies are described by the distance `s` along their surface (positive in travel direction, contact point at
//! zero) and the depth `z` below it. With the weight `g(z) = 1 − z/r_o` in the wheel (true polar elements) and `g = 1`
//! in the rail, the energy balance of the stream `v = −ω r_o` or `v = −V` reads
//!
//! ```text
//! ρc g (∂_t T + v ∂_s T) = k ∂_z(g ∂_z T) + k g⁻¹ ∂_s² T
//! ```
//!
//! and a tensor-product Galerkin method needs only `∫ g N N dz`, `∫ g N′N′ dz`, `∫ g⁻¹ N N dz` (quadratic) and the
//! linear elements along `s`.

mod depth_modes;
mod field;
mod loads;
mod modal;
mod stage;
mod step;
mod streamline;
#[cfg(test)]
mod tests;
mod tridiagonal;

pub use field::TemperatureField;
pub use step::{LARGEST_STEP, SMALLEST_STEP, Scratch};

use super::{Exchange, HeatConfig, HeatError, HeatFlows, HeatModel, Observation, Temperatures};
use crate::config::Hub;
use crate::fem::grading::graded;
use crate::piecewise::peak;
use depth_modes::DepthModes;
use modal::{HeatBody, dot};
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;
use std::ops::Range;
use step::BoundaryState;
use streamline::Streamline;

/// Both temperature fields and what the next step needs to know of the last one.
///
/// The fields are coefficients of the modes across the streamlines; [`Heat::wheel_temperature`] and
/// [`Heat::rail_temperature`] evaluate them.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct HeatState {
    /// Wheel, then rail.
    field: Vec<f64>,
    /// Speeds and totals of the last step; `None` if there was none.
    last: Option<BoundaryState>,
}

/// Meshes and modes of both bodies; immutable.
#[derive(Clone, Debug)]
pub struct Heat {
    config: HeatConfig,
    wheel: HeatBody,
    rail: HeatBody,
    /// Elements of the contact zone on each side of the contact point.
    zone_cells: usize,
    /// Integrals of the modes over the layer whose expansion acts on the contact, of wheel and rail [m].
    layer_weights: [Vec<f64>; 2],
}

/// First layer across the streamlines in thicknesses of the thermal boundary layer, and at most in half-widths.
const FIRST_LAYER: f64 = 0.25;
const FIRST_LAYER_HALF_WIDTHS: f64 = 0.25;
/// Growth of the layers, and the largest one in thicknesses of the body.
const LAYER_GROWTH: f64 = 1.8;
const LARGEST_LAYER: f64 = 0.15;
/// Growth of the elements along the streamlines, largest one in wheel radii and rail lengths.
const GROWTH: f64 = 1.5;
/// Elements at the edges of the contact, where the temperature starts as a square root, in ordinary ones, and growth.
const EDGE: f64 = 0.2;
const EDGE_GROWTH: f64 = 1.3;
const LARGEST_ALONG: f64 = 0.15;
const LARGEST_ALONG_RAIL: f64 = 0.05;
/// Angular velocity [rad/s] below which, and step [s] from which on, conduction along the streamlines is computed exactly.
///
/// The direct solver works mode by mode. For that it replaces the factor `1/r` of conduction around the wheel by `r/r_o²`,
/// which is right at the tread. In a wheel that turns, the stream outweighs conduction around it, and nothing is lost. In
/// a standing wheel heat spreads around the hub, too, and an iteration (GMRES) corrects the solution; short steps do not
/// need it, since heat does not come far. Measured without correction, relative: faster rolling 1e-6 in all stationary
/// temperatures; locked wheel 4e-5 in the maxima and 2e-3 in the wheel's mean after 10 s (stationary 5e-4 and 8e-2).
pub(super) const CURVED_BELOW: f64 = 1.0;
pub(super) const CURVED_STEP: f64 = 0.01;

/// Depth of the layer whose expansion acts on the contact, in half-widths at the nominal load.
const FLASH_DEPTH: f64 = 0.25;

impl HeatModel for Heat {
    type State = HeatState;
    type Scratch = Scratch;

    fn initial(&self, bulk: f64) -> HeatState {
        let free = &self.wheel.modes.free;
        let wheel = free.iter().cycle().take(self.wheel.size()).map(|c| bulk * c);
        HeatState { field: wheel.chain(std::iter::repeat_n(0.0, self.rail.size())).collect(), last: None }
    }

    fn step(
        &self,
        state: &HeatState,
        next: &mut HeatState,
        dt: f64,
        velocity: f64,
        omega: f64,
        exchange: &Exchange,
        scratch: &mut Scratch,
    ) -> Result<HeatFlows, HeatError> {
        self.check_state(state)?;
        self.advance(state, next, dt, [velocity, omega], exchange, scratch)
    }

    fn stationary(&self, velocity: f64, omega: f64, exchange: &Exchange) -> Result<(HeatState, HeatFlows), HeatError> {
        self.settle([velocity, omega], exchange)
    }

    fn zone_x(&self) -> &[f64] {
        &self.rail.line.nodes[self.zone_nodes(&self.rail)]
    }

    fn observe(&self, state: &HeatState, seen: &mut Observation) -> Result<(), HeatError> {
        self.check_state(state)?;
        let (wheel, rail) = self.split(state);
        let mut volume_means = [0.0; 2];
        for (i, (body, field)) in [(&self.wheel, wheel), (&self.rail, rail)].into_iter().enumerate() {
            let nodes = self.zone_nodes(body);
            body.trace(nodes.clone(), field, &mut seen.surface[i]);
            body.integrate(field, &mut seen.sums);
            volume_means[i] = body.heat_capacity * dot(&seen.sums, &body.modes.content) / self.heat_capacity(body);
            let weights = &self.layer_weights[i];
            let along = if body.line.closed > 0.0 { dot(&seen.sums, weights) / body.line.closed } else { 0.0 };
            let nm = body.modes.len();
            let rows = field[nodes.start * nm..nodes.end * nm].chunks_exact(nm);
            seen.layer[i].clear();
            seen.layer[i].extend(rows.map(|row| dot(row, weights) - along));
        }
        let [wheel, rail] = &seen.surface;
        seen.temperatures = Temperatures {
            wheel_max: peak(self.zone_x(), wheel),
            rail_max: peak(self.zone_x(), rail),
            wheel_centre: wheel[self.zone_cells],
            rail_centre: rail[self.zone_cells],
            wheel_mean: volume_means[0],
            rail_mean: volume_means[1],
        };
        Ok(())
    }
}

impl Heat {
    /// Meshes and modes for the given parameters.
    ///
    /// Fails for parameters on which no mesh can be laid, and if the modes over the depth are not found.
    pub fn new(config: &HeatConfig) -> Result<Self, HeatError> {
        config.validate()?;
        let c = config.clone();
        let (radius, smallest) = (c.wheel.radius, c.smallest_half_width());
        let boundary_layer = (2.0 * c.diffusivity() * smallest / c.thermal.max_speed).sqrt();
        let first = (FIRST_LAYER * boundary_layer).min(FIRST_LAYER_HALF_WIDTHS * smallest);
        let film = c.thermal.convection / c.material.conductivity;
        let modes = |thickness: f64, curvature: f64, fixed: bool| {
            let layers = graded(first.min(0.1 * thickness), LAYER_GROWTH, LARGEST_LAYER * thickness, thickness);
            DepthModes::new(&layers, curvature, fixed, film)
        };
        let zone = zone_nodes(&c);
        let line =
            |half: f64, largest: f64, closed: bool| Streamline::around_contact(&zone, half, GROWTH, largest, closed);
        let body = |line: Streamline, modes: DepthModes| HeatBody {
            line,
            modes,
            heat_capacity: c.heat_capacity(),
            conductivity: c.material.conductivity,
            film: c.thermal.convection,
        };
        let wheel = body(
            line(PI * radius, LARGEST_ALONG * radius, true),
            modes(radius - c.wheel.hub_radius, 1.0 / radius, c.thermal.hub == Hub::Fixed)?,
        );
        let rail = body(
            line(0.5 * c.rail.length, LARGEST_ALONG_RAIL * c.rail.length, false),
            modes(c.rail.height, 0.0, false)?,
        );
        let layer_weights = [&wheel, &rail].map(|body| body.modes.integrals(FLASH_DEPTH * c.half_width));
        Ok(Self { wheel, rail, zone_cells: zone.len() - 1, layer_weights, config: c })
    }

    /// The parameters this was made from.
    pub fn config(&self) -> &HeatConfig {
        &self.config
    }

    /// Number of unknown temperatures.
    pub fn unknowns(&self) -> usize {
        let count = |b: &HeatBody| b.line.len() * b.modes.shapes.nrows();
        count(&self.wheel) + count(&self.rail)
    }

    /// Heat contents of wheel and rail over the reference temperature [J/m].
    pub fn heat_content(&self, state: &HeatState) -> Result<[f64; 2], HeatError> {
        self.check_state(state)?;
        let (wheel, rail) = self.split(state);
        Ok([(&self.wheel, wheel), (&self.rail, rail)].map(|(body, field)| {
            let mut sums = Vec::new();
            body.integrate(field, &mut sums);
            body.heat_capacity * dot(&sums, &body.modes.content)
        }))
    }

    /// Sum of two temperature fields, as if no step had led to it.
    pub fn sum(&self, a: &HeatState, b: &HeatState) -> Result<HeatState, HeatError> {
        self.check_state(a)?;
        self.check_state(b)?;
        Ok(HeatState { field: a.field.iter().zip(&b.field).map(|(a, b)| a + b).collect(), last: None })
    }

    /// Whether a state has the dimensions of this model.
    pub fn fits(&self, state: &HeatState) -> bool {
        state.field.len() == self.wheel.size() + self.rail.size()
    }

    fn check_state(&self, state: &HeatState) -> Result<(), HeatError> {
        let (expected, found) = (self.wheel.size() + self.rail.size(), state.field.len());
        self.fits(state).then_some(()).ok_or(HeatError::StateSize { expected, found })
    }

    /// Fields of wheel and rail.
    fn split<'a>(&self, state: &'a HeatState) -> (&'a [f64], &'a [f64]) {
        state.field.split_at(self.wheel.size())
    }

    /// Number of elements of the contact zone.
    fn zone_elements(&self) -> usize {
        2 * self.zone_cells
    }

    /// Nodes of the contact zone, counted in a body.
    fn zone_nodes(&self, body: &HeatBody) -> Range<usize> {
        body.line.zone..body.line.zone + self.zone_elements() + 1
    }

    /// Heat capacity of a whole body [J/(m K)].
    fn heat_capacity(&self, body: &HeatBody) -> f64 {
        let HeatConfig { wheel, rail, .. } = &self.config;
        let area = if body.line.closed > 0.0 {
            PI * (wheel.radius * wheel.radius - wheel.hub_radius * wheel.hub_radius)
        } else {
            rail.length * rail.height
        };
        body.heat_capacity * area
    }
}

/// Nodes of the contact zone from the contact point outwards: finest at the edge of the nominal contact.
fn zone_nodes(c: &HeatConfig) -> Vec<f64> {
    let spacing = c.smallest_half_width() / c.elements_per_half_width as f64;
    let inside = graded(EDGE * spacing, EDGE_GROWTH, spacing, c.half_width);
    let mut nodes: Vec<f64> = inside.iter().rev().map(|s| c.half_width - s).collect();
    if c.zone > c.half_width {
        let outside = graded(EDGE * spacing, EDGE_GROWTH, spacing, c.zone - c.half_width);
        nodes.extend(outside.iter().skip(1).map(|s| c.half_width + s));
    }
    nodes
}
