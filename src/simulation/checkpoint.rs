//! Points from which a simulation goes on, and derivatives in time from the points before.

use crate::config::Tuning;
use crate::rolling::{Origin, Outputs, State};
use serde::{Deserialize, Serialize};

/// Communication points kept for derivatives in time.
pub const KEPT_POINTS: usize = 2;
/// Largest ratio of the last step to the one before that counts in them.
const LARGEST_RATIO: f64 = 10.0;
/// How far a stationary motion is followed back from the start for them [s].
const LEAD: f64 = 1e-3;

/// All that a simulation needs to continue bit for bit, besides its model and its tunable parameters.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Checkpoint {
    /// The physical state.
    pub state: State,
    /// Tunable parameters with which it was computed; they may have changed since.
    pub tuning: Tuning,
    /// Origin of the state, for derivatives by inputs.
    pub origin: Origin,
    /// Times \[s] and outputs of the communication points before, latest first, for derivatives in time.
    pub before: Vec<(f64, Outputs)>,
}

/// Time \[s] and outputs a little before a stationary start, from those at it.
pub fn followed_back(time: f64, mut earlier: Outputs) -> (f64, Outputs) {
    earlier.wheel_distance -= LEAD * earlier.wheel_velocity;
    earlier.wheel_angle -= LEAD * earlier.wheel_omega;
    earlier.wheel_velocity -= LEAD * earlier.wheel_acceleration;
    earlier.wheel_omega -= LEAD * earlier.wheel_angular_acceleration;
    (time - LEAD, earlier)
}

impl Checkpoint {
    /// Time derivative of an output: second-order backward difference of the last communication points, which the
    /// stationary motion precedes.
    pub fn rate(&self, now: &Outputs, output: impl Fn(&Outputs) -> f64) -> f64 {
        let now = output(now);
        let slope = |(time, before): &(f64, Outputs)| (now - output(before)) / (self.state.clock.time - time);
        let points = &self.before;
        match (points.first(), points.get(1)) {
            (Some(a), Some(b)) => {
                let (h, total) = (self.state.clock.time - a.0, self.state.clock.time - b.0);
                // A much shorter step before would amplify its rounding.
                slope(a) + (slope(a) - slope(b)) * (h / (total - h)).min(LARGEST_RATIO)
            }
            (Some(a), _) => slope(a),
            (None, _) => 0.0,
        }
    }
}
