//! Extremes of all hot places together.

use serde::{Deserialize, Serialize};

/// Extremes at the depths of the mesh, of all places that were heated in one piece so far; empty without any.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Worst {
    /// Highest temperatures \[K].
    pub peaks: Vec<f64>,
    /// Largest integral over the depth of the highest excess temperatures of a column [K m].
    pub heat: f64,
    /// Position of that column in the material: distance along the tread, as the place of a spot \[m].
    pub hottest: f64,
}
