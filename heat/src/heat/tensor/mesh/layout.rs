//! Meshes and modes of both bodies.

use super::body::HeatBody;
use super::depth_modes::DepthModes;
use super::section::{LayerGrading, Section};
use super::streamline::Streamline;
use crate::fem::grading::graded;
use crate::heat::error::HeatError;
use crate::heat::parameters::HeatParameters;
use std::f64::consts::PI;
use std::ops::Range;

/// First layer across the streamlines in thicknesses of the thermal boundary layer, and at most in half-widths.
const FIRST_LAYER: f64 = 0.25;
const FIRST_LAYER_HALF_WIDTHS: f64 = 0.25;
/// Growth of the layers.
pub const LAYER_GROWTH: f64 = 2.2;
/// Growth of the elements along the streamlines, largest one in wheel radii and rail lengths.
const GROWTH: f64 = 2.0;
/// Elements at the edges of the contact, where the temperature starts as a square root, in ordinary ones, and growth.
const EDGE: f64 = 0.2;
const EDGE_GROWTH: f64 = 1.3;
/// Growth of the elements between the zones of ordinary and of wide patches.
const WING_GROWTH: f64 = 1.6;
const LARGEST_ALONG: f64 = 0.15;
const LARGEST_ALONG_RAIL: f64 = 0.05;

/// Meshes and modes of both bodies; immutable.
#[derive(Clone, Debug)]
pub struct HeatLayout {
    /// Parameters that the meshes follow from.
    pub config: HeatParameters,
    /// Mesh of the wheel.
    pub wheel: HeatBody,
    /// Mesh of the rail.
    pub rail: HeatBody,
    /// Elements of the contact zone on each side of the contact point.
    pub zone_cells: usize,
}

impl HeatLayout {
    /// Meshes with layers that grow by `growth` from one to the next.
    ///
    /// Fails for parameters on which no mesh can be laid, and if the modes over the depth are not found.
    pub fn new(config: &HeatParameters, growth: f64) -> Result<Self, HeatError> {
        config.validate()?;
        let c = config.clone();
        let (radius, smallest) = (c.radius, c.smallest_half_width());
        let boundary_layer = (2.0 * c.diffusivity() * smallest / c.max_speed).sqrt();
        let first = (FIRST_LAYER * boundary_layer).min(FIRST_LAYER_HALF_WIDTHS * smallest);
        let grading = LayerGrading { first, growth };
        let (conductivity, convection) = (c.material.conductivity, c.convection);
        let biot = convection / conductivity;
        let zone = zone_nodes(&c);
        let streamline =
            |half: f64, largest: f64, closed: bool| Streamline::around_contact(&zone, half, GROWTH, largest, closed);
        let body = |streamline: Streamline, modes: DepthModes| {
            HeatBody::new(streamline, modes, c.heat_capacity(), conductivity, convection)
        };
        let wheel = body(
            streamline(PI * radius, LARGEST_ALONG * radius, true),
            DepthModes::new(&Section::wheel(&c, grading), 1.0 / radius, c.hub_held, biot)?,
        )?;
        let rail = body(
            streamline(0.5 * c.rail_length, LARGEST_ALONG_RAIL * c.rail_length, false),
            DepthModes::new(&Section::rail(&c, grading), 0.0, false, biot)?,
        )?;
        Ok(Self { wheel, rail, zone_cells: zone.len() - 1, config: c })
    }

    /// Wheel and rail.
    pub fn bodies(&self) -> [&HeatBody; 2] {
        [&self.wheel, &self.rail]
    }

    /// Number of values of a field of both bodies, the wheel's first.
    pub fn size(&self) -> usize {
        self.wheel.size() + self.rail.size()
    }

    /// Fields of wheel and rail.
    pub fn split<'a>(&self, field: &'a [f64]) -> [&'a [f64]; 2] {
        field.split_at(self.wheel.size()).into()
    }

    /// Field of a body (0: wheel, 1: rail).
    pub fn part<'a>(&self, body: usize, field: &'a [f64]) -> &'a [f64] {
        let [wheel, rail] = self.split(field);
        if body == 0 { wheel } else { rail }
    }

    /// Field of a body (0: wheel, 1: rail), to be changed.
    pub fn part_mut<'a>(&self, body: usize, field: &'a mut [f64]) -> &'a mut [f64] {
        let [wheel, rail] = self.split_mut(field);
        if body == 0 { wheel } else { rail }
    }

    /// Fields of wheel and rail, to be changed.
    pub fn split_mut<'a>(&self, field: &'a mut [f64]) -> [&'a mut [f64]; 2] {
        field.split_at_mut(self.wheel.size()).into()
    }

    /// Surface positions of the common nodes in the contact zone \[m], ascending.
    pub fn zone_positions(&self) -> &[f64] {
        &self.rail.streamline.nodes[self.zone_nodes(&self.rail)]
    }

    /// Length of the elements inside the contact \[m].
    pub fn element(&self) -> f64 {
        element(&self.config)
    }

    /// Number of elements of the contact zone.
    pub fn zone_elements(&self) -> usize {
        2 * self.zone_cells
    }

    /// Nodes of the contact zone, counted in a body.
    pub fn zone_nodes(&self, body: &HeatBody) -> Range<usize> {
        body.streamline.zone..body.streamline.zone + self.zone_elements() + 1
    }

    /// Heat capacity of a whole body [J/(m K)], over the width of the contact.
    pub fn heat_capacity(&self, body: &HeatBody) -> f64 {
        let length = if body.streamline.closed > 0.0 { body.streamline.closed } else { self.config.rail_length };
        body.heat_capacity * length * body.modes.section
    }

    /// Lowest and highest value of a field at the nodes of both bodies.
    pub fn extremes(&self, field: &[f64]) -> [f64; 2] {
        let [wheel, rail] = self.split(field);
        let (a, b) = (self.wheel.nodal.extremes(wheel), self.rail.nodal.extremes(rail));
        [a[0].min(b[0]), a[1].max(b[1])]
    }
}

fn element(c: &HeatParameters) -> f64 {
    c.smallest_half_width() / c.elements_per_half_width as f64
}

/// Nodes of the contact zone from the contact point outwards: finest at the edge of the nominal contact.
fn zone_nodes(c: &HeatParameters) -> Vec<f64> {
    let spacing = element(c);
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
