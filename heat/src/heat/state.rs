//! Data that a step starts from.

use serde::{Deserialize, Serialize};

/// Temperatures of both bodies and the memory of the last step: plain data, whose meaning the model knows that made it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct HeatState {
    /// Unknowns of the temperature fields; of the tensor model coefficients of the modes across the streamlines, wheel,
    /// then rail, heat contents over `ρc` where steel melts \[K].
    pub values: Vec<f64>,
    /// Speeds and totals of the last step; `None` if there was none.
    pub(super) last: Option<BoundaryState>,
    /// Heat content over `ρc` of the rail that arrives \[K].
    pub(super) arriving: f64,
    /// Coldest and hottest datum so far \[K]: nothing in the bodies may lie beyond. Infinite: there is no bound.
    pub(super) data: [f64; 2],
    /// Bounds that the values at all nodes are known to keep \[K].
    pub(super) range: [f64; 2],
    /// Bounds of the values below every surface node, the wheel's first; empty: none are known.
    pub(super) rows: Vec<RowBounds>,
    /// `∫ x ds` of every mode along the streamlines of wheel and rail [K m]; empty: not known.
    pub(super) sums: [Vec<f64>; 2],
}

/// Bounds of the values below one surface node.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct RowBounds {
    /// Lowest and highest value when all were looked at \[K].
    pub found: [f64; 2],
    /// Distance by which they may have moved since \[K].
    pub moved: f64,
}

impl RowBounds {
    /// Nothing is known.
    pub const UNKNOWN: Self = Self { found: [0.0; 2], moved: f64::INFINITY };

    /// Bounds that the values keep now \[K].
    pub fn range(&self) -> [f64; 2] {
        [self.found[0] - self.moved, self.found[1] + self.moved]
    }
}

impl HeatState {
    /// Forgets the sums along the streamlines.
    pub(super) fn forget_sums(&mut self) {
        self.sums.iter_mut().for_each(Vec::clear);
    }

    /// State of the given unknowns to which no step has led.
    pub fn new(values: Vec<f64>) -> Self {
        Self { values, ..Self::default() }
    }
}

/// Speeds and total loads of a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct BoundaryState {
    /// Velocity of the wheel's centre [m/s] and angular velocity [rad/s], forward rolling positive.
    pub speeds: [f64; 2],
    /// Contact conductance integrated over the patch [W/(m K)].
    pub conductance: f64,
    /// Friction heat and heat of the sources [W/m].
    pub heat: [f64; 2],
}
