//! The data that a step starts from.

use serde::{Deserialize, Serialize};

/// Relative change of speeds, conductance or heat from one step to the next that counts as a jump.
const JUMP: f64 = 0.3;
/// Heat whose changes do not count [W/m]: it warms a rolling contact by less than a kelvin.
const SLIGHT_HEAT: f64 = 1e4;

/// Both temperature fields and what the next step needs to know of the last one.
///
/// The fields are coefficients of the modes across the streamlines, heat contents over `ρc` where steel melts; `wheel_temperature` and `rail_temperature` of
/// [`Heat`](super::Heat) evaluate them.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct HeatState {
    /// Wheel, then rail.
    pub(super) field: Vec<f64>,
    /// Speeds and totals of the last step; `None` if there was none.
    pub(super) last: Option<BoundaryState>,
    /// Coldest datum so far \[K]: nothing in the bodies may be colder.
    pub(super) coldest: f64,
    /// Bounds that the values at all nodes are known to keep \[K].
    pub(super) range: [f64; 2],
}

/// Speeds and totals of what acts during a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct BoundaryState {
    /// Velocity of the wheel's centre [m/s] and angular velocity [rad/s], forward rolling positive.
    pub speeds: [f64; 2],
    /// Contact conductance integrated over the patch [W/(m K)].
    pub conductance: f64,
    /// Friction heat and heat on the tread [W/m].
    pub heat: [f64; 2],
}

impl BoundaryState {
    /// Whether speeds, conductance or heat change so much that the next step cannot continue smoothly.
    pub fn jumps_to(&self, next: &Self) -> bool {
        let jump = |a: f64, b: f64| (a - b).abs() > JUMP * a.abs().max(b.abs());
        let change: f64 = self.heat.iter().zip(&next.heat).map(|(a, b)| (a - b).abs()).sum();
        let larger = self.heat.iter().sum::<f64>().max(next.heat.iter().sum());
        self.speeds.iter().zip(&next.speeds).any(|(a, b)| jump(*a, *b))
            || jump(self.conductance, next.conductance)
            || change > SLIGHT_HEAT + JUMP * larger
    }
}
