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
}

impl HeatState {
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
    /// Friction heat and heat on the tread [W/m].
    pub heat: [f64; 2],
}
