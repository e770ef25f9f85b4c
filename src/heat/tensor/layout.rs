//! Meshes and modes of both bodies.

use super::column::Column;
use super::depth_modes::DepthModes;
use super::modal::{HeatBody, dot};
use super::nodal::Nodal;
use super::section::{Grading, Section};
use super::state::HeatState;
use super::streamline::Streamline;
use crate::config::Hub;
use crate::fem::grading::graded;
use crate::heat::error::HeatError;
use crate::heat::melting::Melting;
use crate::heat::parameters::HeatConfig;
use std::f64::consts::PI;
use std::ops::Range;

/// Meshes and modes of both bodies; immutable.
#[derive(Clone, Debug)]
pub struct Heat {
    pub(super) config: HeatConfig,
    pub(super) wheel: HeatBody,
    pub(super) rail: HeatBody,
    /// Nodes across the streamlines of wheel and rail.
    pub(super) nodal: [Nodal; 2],
    /// Elements of the contact zone on each side of the contact point.
    pub(super) zone_cells: usize,
    /// Integrals of the modes over the layer whose expansion acts on the contact, of wheel and rail [m]; of the rail less the
    /// temperature a half-width below the surface.
    pub(super) layer_weights: [Vec<f64>; 2],
    /// First moments of the modes over that layer, of wheel and rail [m²]; the same is subtracted.
    pub(super) layer_moments: [Vec<f64>; 2],
    /// Means of the modes from the surface down to depths that grow by the factor [`CORE_GROWTH`] from
    /// [`CORE_DEPTH`] half-widths on, of wheel and rail [1].
    pub(super) core_weights: [Vec<Vec<f64>>; 2],
    /// Columns of wheel and rail in which steel may melt.
    pub(super) columns: [Column; 2],
    /// Unless melting is left out.
    pub(super) melting: Option<Melting>,
}

/// Shallowest and number of depths over which means are prepared, in half-widths at the nominal load, and their growth.
const CORE_DEPTH: f64 = 0.1;
const CORE_DEPTHS: i32 = 9;
const CORE_GROWTH: f64 = 1.6;

/// First layer across the streamlines in thicknesses of the thermal boundary layer, and at most in half-widths.
const FIRST_LAYER: f64 = 0.25;
const FIRST_LAYER_HALF_WIDTHS: f64 = 0.25;
/// Growth of the layers.
const LAYER_GROWTH: f64 = 1.8;
/// Growth of the elements along the streamlines, largest one in wheel radii and rail lengths.
const GROWTH: f64 = 1.5;
/// Elements at the edges of the contact, where the temperature starts as a square root, in ordinary ones, and growth.
const EDGE: f64 = 0.2;
const EDGE_GROWTH: f64 = 1.3;
/// Growth of the elements between the zones of ordinary and of wide patches.
const WING_GROWTH: f64 = 1.4;
const LARGEST_ALONG: f64 = 0.15;
const LARGEST_ALONG_RAIL: f64 = 0.05;
/// Depth of the layer whose expansion acts on the contact, in half-widths at the nominal load.
const FLASH_DEPTH: f64 = 0.25;

impl Heat {
    /// Meshes and modes for the given parameters.
    ///
    /// Fails for parameters on which no mesh can be laid, and if the modes over the depth are not found.
    pub fn new(config: &HeatConfig) -> Result<Self, HeatError> {
        Self::with_layers(config, LAYER_GROWTH)
    }

    /// The same with layers that grow by `growth` from one to the next, for studies of the mesh.
    pub fn with_layers(config: &HeatConfig, growth: f64) -> Result<Self, HeatError> {
        config.validate()?;
        let c = config.clone();
        let (radius, smallest) = (c.wheel.radius, c.smallest_half_width());
        let boundary_layer = (2.0 * c.diffusivity() * smallest / c.thermal.max_speed).sqrt();
        let first = (FIRST_LAYER * boundary_layer).min(FIRST_LAYER_HALF_WIDTHS * smallest);
        let grading = Grading { first, growth };
        let film = c.thermal.convection / c.material.conductivity;
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
            DepthModes::new(&Section::wheel(&c, grading), 1.0 / radius, c.thermal.hub == Hub::Fixed, film)?,
        );
        let rail = body(
            line(0.5 * c.rail.length, LARGEST_ALONG_RAIL * c.rail.length, false),
            DepthModes::new(&Section::rail(&c, grading), 0.0, false, film)?,
        );
        let flash = FLASH_DEPTH * c.half_width;
        let mut layer_weights = [&wheel, &rail].map(|body| body.modes.integrals(flash));
        let mut layer_moments = [&wheel, &rail].map(|body| body.modes.moments(flash));
        // Rail that is as warm in the depth grows as a whole and not at the contact.
        let below = rail.modes.at(c.half_width.min(c.rail.height));
        for (weights, of_one) in [(&mut layer_weights[1], flash), (&mut layer_moments[1], 0.5 * flash * flash)] {
            weights.iter_mut().zip(&below).for_each(|(weight, value)| *weight -= of_one * value);
        }
        let core_weights = [&wheel, &rail].map(|body| {
            let depths = (0..CORE_DEPTHS).map(|k| CORE_DEPTH * c.half_width * CORE_GROWTH.powi(k));
            depths.map(|depth| body.modes.integrals(depth).iter().map(|i| i / depth).collect()).collect()
        });
        let nodal = [Nodal::new(&wheel.modes)?, Nodal::new(&rail.modes)?];
        let columns = [&wheel, &rail].map(|body| Column::new(&body.modes));
        let melting = Melting::new(&c);
        let zone_cells = zone.len() - 1;
        Ok(Self {
            wheel,
            rail,
            nodal,
            columns,
            melting,
            zone_cells,
            layer_weights,
            layer_moments,
            core_weights,
            config: c,
        })
    }

    /// Surface positions of the common nodes in the contact zone [m], ascending.
    pub(super) fn zone_positions(&self) -> &[f64] {
        &self.rail.line.nodes[self.zone_nodes(&self.rail)]
    }

    /// The parameters this was made from.
    pub fn config(&self) -> &HeatConfig {
        &self.config
    }

    /// Place of a depth [m] among the prepared ones: the one above it and the share of the next.
    pub(super) fn core_place(&self, depth: f64) -> (usize, f64) {
        let place = (depth / (CORE_DEPTH * self.config.half_width)).ln() / CORE_GROWTH.ln();
        let place = place.clamp(0.0, f64::from(CORE_DEPTHS - 1));
        let above = (place.floor() as usize).min(CORE_DEPTHS as usize - 2);
        (above, place - above as f64)
    }

    /// Number of unknown temperatures.
    pub fn unknowns(&self) -> usize {
        let count = |b: &HeatBody| b.line.len() * b.modes.shapes.nrows();
        count(&self.wheel) + count(&self.rail)
    }

    /// Heat contents of wheel and rail over the reference temperature [J/m], over the width of the contact.
    pub fn heat_content(&self, state: &HeatState) -> Result<[f64; 2], HeatError> {
        self.check_state(state)?;
        let (wheel, rail) = self.split(state);
        Ok([(&self.wheel, wheel), (&self.rail, rail)].map(|(body, field)| {
            let mut sums = Vec::new();
            body.integrate(field, &mut sums);
            body.heat_capacity * dot(&sums, &body.modes.content)
        }))
    }

    /// Heat content over `ρc` at a temperature over the reference \[K].
    pub(super) fn content(&self, temperature: f64) -> f64 {
        self.melting.map_or(temperature, |melting| melting.content(temperature))
    }

    /// Whether a state has the dimensions of this model.
    pub fn fits(&self, state: &HeatState) -> bool {
        state.field.len() == self.wheel.size() + self.rail.size()
    }

    pub(super) fn check_state(&self, state: &HeatState) -> Result<(), HeatError> {
        let (expected, found) = (self.wheel.size() + self.rail.size(), state.field.len());
        self.fits(state).then_some(()).ok_or(HeatError::StateSize { expected, found })
    }

    /// Fields of wheel and rail.
    pub(super) fn split<'a>(&self, state: &'a HeatState) -> (&'a [f64], &'a [f64]) {
        state.field.split_at(self.wheel.size())
    }

    /// Number of elements of the contact zone.
    pub(super) fn zone_elements(&self) -> usize {
        2 * self.zone_cells
    }

    /// Nodes of the contact zone, counted in a body.
    pub(super) fn zone_nodes(&self, body: &HeatBody) -> Range<usize> {
        body.line.zone..body.line.zone + self.zone_elements() + 1
    }

    /// Heat capacity of a whole body [J/(m K)], over the width of the contact.
    pub(super) fn heat_capacity(&self, body: &HeatBody) -> f64 {
        let length = if body.line.closed > 0.0 { body.line.closed } else { self.config.rail.length };
        body.heat_capacity * length * body.modes.section
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
    if c.reach > c.zone {
        let wing = graded(WING_GROWTH * spacing, WING_GROWTH, c.reach, c.reach - c.zone);
        nodes.extend(wing.iter().skip(1).map(|s| c.zone + s));
    }
    nodes
}
