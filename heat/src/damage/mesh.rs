//! The mesh of a spot: arc along the tread times depth below it, finest at the surface and in the middle.

use crate::fem::grading::graded;
use std::f64::consts::PI;

/// Depth of the first node below the surface, growth of the layers, depth of the whole mesh [m].
const FIRST: f64 = 1e-5;
const GROWTH: f64 = 1.15;
const DEPTH: f64 = 0.04;
/// Arc of an element in the middle, in half-widths of the nominal contact, growth beyond it, and how far it reaches
/// [m].
const MIDDLE: f64 = 0.1;
const GROWTH_ALONG: f64 = 1.2;
const BEYOND: f64 = 0.04;
/// Largest layer in depths of the mesh, largest element along the arc in reaches beyond the middle.
const LARGEST: f64 = 0.2;

/// Dimensions, material and boundary of a spot, from which its mesh and the conduction on it follow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpotLayout {
    /// Radius of the wheel \[m].
    pub radius: f64,
    /// Radius of its hub \[m].
    pub hub_radius: f64,
    /// Half-width of the nominal contact \[m].
    pub half_width: f64,
    /// Half-length of the zone in which there may be contact \[m].
    pub zone: f64,
    /// Conductivity [W/(m K)].
    pub conductivity: f64,
    /// Heat capacity ρc [J/(m³ K)].
    pub heat_capacity: f64,
    /// Coefficient of convection to the air [W/(m² K)].
    pub convection: f64,
    /// Absolute temperature over which excess temperatures are counted \[K].
    pub reference: f64,
    /// Size of elements and of the spot's own time steps relative to the usual one \[1].
    pub resolution: f64,
}

/// Nodes over arc and depth with their volumes and links, per unit of the other direction.
///
/// Values at the nodes are stored column by column: `value[column · depths + layer]`.
#[derive(Clone, Debug)]
pub struct SpotMesh {
    /// Distance along the tread from the middle \[m], ascending.
    pub arc: Vec<f64>,
    /// Depth \[m], from the surface down.
    pub depth: Vec<f64>,
    /// Part of the depth that belongs to each of these depths \[m].
    pub(super) shares: Vec<f64>,
    /// Coefficients of conduction along the arc and over the depth.
    pub(super) along: ConductionLine,
    pub(super) across: ConductionLine,
    /// Diffusivity along the arc at each depth over that at the surface [1]: `1/g²`, `g = 1 − z/r`.
    pub(super) stretch: Vec<f64>,
    conductivity: f64,
    heat_capacity: f64,
    /// Size of time steps relative to the usual one [1].
    pub(super) resolution: f64,
}

/// Conduction along one direction: inverse of time per neighbour, for a diffusivity of one [1/m²].
#[derive(Clone, Debug)]
pub(super) struct ConductionLine {
    /// From the node before to each node.
    pub lower: Vec<f64>,
    /// From the node after.
    pub upper: Vec<f64>,
    /// Inverse of the volume of the first node [1/m].
    pub surface: f64,
}

impl SpotMesh {
    /// Mesh for a wheel; it stays within its rim and within a quarter of its circumference on either side.
    pub fn new(layout: &SpotLayout) -> Self {
        let SpotLayout { radius, hub_radius, half_width, zone, resolution, .. } = *layout;
        let thickness = DEPTH.min(0.9 * (radius - hub_radius));
        let first = (resolution * FIRST).min(0.02 * thickness);
        let depth = graded(first, libm::pow(GROWTH, resolution), LARGEST * resolution * thickness, thickness);
        let middle = (zone + half_width).min(0.25 * PI * radius);
        let count = (middle / (MIDDLE * resolution * half_width)).ceil().max(2.0);
        let mut side: Vec<f64> = (0..=count as usize).map(|i| middle * i as f64 / count).collect();
        let beyond = BEYOND.min(0.25 * PI * radius);
        let growth = libm::pow(GROWTH_ALONG, resolution);
        let outer = graded(growth * middle / count, growth, LARGEST * resolution * beyond, beyond);
        side.extend(outer.iter().skip(1).map(|s| middle + s));
        let arc: Vec<f64> = side.iter().rev().map(|s| -s).chain(side.iter().skip(1).copied()).collect();
        let weight = |z: f64| 1.0 - z / radius;
        let at = |k: usize| depth[k.min(depth.len() - 1)];
        let shares = (0..depth.len()).map(|k| 0.5 * (at(k + 1) - at(k.saturating_sub(1)))).collect();
        Self {
            along: ConductionLine::new(&arc, |_| 1.0),
            across: ConductionLine::new(&depth, weight),
            stretch: depth.iter().map(|&z| weight(z).powi(-2)).collect(),
            arc,
            shares,
            depth,
            conductivity: layout.conductivity,
            heat_capacity: layout.heat_capacity,
            resolution,
        }
    }

    /// Number of nodes.
    pub fn size(&self) -> usize {
        self.arc.len() * self.depth.len()
    }

    /// Thermal diffusivity [m²/s].
    pub fn diffusivity(&self) -> f64 {
        self.conductivity / self.heat_capacity
    }

    /// Effusivity `√(kρc)` [W s^½/(m² K)].
    pub fn effusivity(&self) -> f64 {
        (self.conductivity * self.heat_capacity).sqrt()
    }

    /// Rate at which a coefficient of heat transfer [W/(m² K)] cools the nodes at the surface [1/s].
    pub(super) fn cooling(&self, film: f64) -> f64 {
        film / self.heat_capacity * self.across.surface
    }
}

impl ConductionLine {
    /// Finite volumes around the nodes under a weight of area and volume.
    fn new(nodes: &[f64], weight: impl Fn(f64) -> f64) -> Self {
        let n = nodes.len();
        let face = |i: usize| 0.5 * (nodes[i] + nodes[i + 1]);
        let link = |i: usize| weight(face(i)) / (nodes[i + 1] - nodes[i]);
        let volume = |i: usize| {
            let (from, to) = (if i > 0 { face(i - 1) } else { nodes[0] }, if i + 1 < n { face(i) } else { nodes[i] });
            (to - from) * weight(0.5 * (from + to))
        };
        Self {
            lower: (0..n).map(|i| if i > 0 { link(i - 1) / volume(i) } else { 0.0 }).collect(),
            upper: (0..n).map(|i| if i + 1 < n { link(i) / volume(i) } else { 0.0 }).collect(),
            surface: 1.0 / volume(0),
        }
    }
}
