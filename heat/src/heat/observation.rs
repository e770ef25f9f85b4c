//! Temperatures as the rest of the program sees them.

use crate::fem::Mesh;
use serde::{Deserialize, Serialize};

/// Observation of a state; pairs are wheel and rail.
#[derive(Clone, Debug, Default)]
pub struct Observation {
    /// Maxima, values at the contact point and means.
    pub temperatures: Temperatures,
    /// Surface temperatures at the positions of [`HeatModel::zone_x`](super::HeatModel::zone_x), over the reference
    /// \[K].
    pub surface: [Vec<f64>; 2],
    /// Temperature integrated over the layer whose expansion acts on the contact, at the same positions [K m]: of the
    /// wheel less its mean along the tread, of the rail less the temperature in the depth.
    pub layer: [Vec<f64>; 2],
    /// Mean depth of the heat in that layer \[m].
    pub layer_depth: [f64; 2],
    /// Mean temperatures over a depth, see [`HeatModel::mean_over_depth`](super::HeatModel::mean_over_depth); filled on
    /// demand only.
    pub core: [Vec<f64>; 2],
    /// No node of the bodies is colder, over the reference \[K]; exact where it comes near absolute zero.
    pub lowest: f64,
    /// Work space: a field summed along the streamlines, or the nodes below one surface node.
    pub(super) sums: Vec<f64>,
    /// Work space: first moments of the layers.
    pub(super) moments: Vec<f64>,
}

/// Temperatures that a run reports, over the reference \[K].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Temperatures {
    /// Maximum of the wheel's surface in the contact zone.
    pub wheel_max: f64,
    /// Maximum of the rail's surface in the contact zone.
    pub rail_max: f64,
    /// Surface of the wheel at the contact point.
    pub wheel_centre: f64,
    /// Surface of the rail at the contact point.
    pub rail_centre: f64,
    /// Mean of the wheel over its volume.
    pub wheel_mean: f64,
    /// Mean of the modelled rail over its volume.
    pub rail_mean: f64,
    /// Largest molten thickness of wheel and rail in the contact zone now, the molten fraction integrated over the
    /// depth \[m].
    pub melted: [f64; 2],
}

/// Temperature of one body.
#[derive(Clone, Debug)]
pub struct TemperatureField {
    /// Mesh of the body: the wheel about its centre, the rail with the contact point at the origin; cells between all
    /// nodes, those in the middle of the quadratic layers included.
    pub mesh: Mesh,
    /// Temperatures at the nodes, over the reference \[K].
    pub temperature: Vec<f64>,
}
