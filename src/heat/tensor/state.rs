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
    /// Heat content over `ρc` of the rail that arrives \[K].
    pub(super) arriving: f64,
    /// Coldest and hottest datum so far \[K]: nothing in the bodies may lie beyond. Infinite: there is no bound.
    pub(super) data: [f64; 2],
    /// Bounds that the values at all nodes are known to keep \[K].
    pub(super) range: [f64; 2],
}

/// Digits after the first of the binary numbers to which shared speeds are rounded.
const SHARED_DIGITS: u32 = 8;

impl HeatState {
    /// Speeds near the present ones that many steps share: those of the last step, rounded. Where one has changed by more than
    /// rounding does, the present one takes its place.
    ///
    /// They follow from the state, so that a step depends smoothly on its inputs.
    pub(super) fn shared_speeds(&self, speeds: [f64; 2]) -> [f64; 2] {
        let near = |shared: f64, speed: f64| (shared - speed).abs() <= speed.abs() / f64::from(1 << SHARED_DIGITS);
        let Some(last) = self.last else { return speeds };
        [0, 1].map(|i| Some(rounded(last.speeds[i])).filter(|shared| near(*shared, speeds[i])).unwrap_or(speeds[i]))
    }
}

/// The nearest number with [`SHARED_DIGITS`] binary digits after the first.
fn rounded(value: f64) -> f64 {
    let rest = f64::MANTISSA_DIGITS - 1 - SHARED_DIGITS;
    f64::from_bits((value.to_bits() + (1 << (rest - 1))) >> rest << rest)
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
