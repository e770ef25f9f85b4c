//! States from outside: one that no run can have left behind is refused before it can do harm.

use crate::rolling::State;
use crate::rolling::substeps::{LONGEST_STEP, SHORTEST_STEP};

/// Times and step sizes of a state as a run leaves them behind. Others could make a step endless; wrong values
/// of the fields only make it fail.
pub(super) fn is_plausible(state: &State) -> bool {
    state.clock.time.is_finite()
        && (0.0..SHORTEST_STEP).contains(&state.clock.pending)
        && (0.0..=LONGEST_STEP).contains(&state.clock.last_step)
        && state.clock.control.step >= SHORTEST_STEP
        && state.motion.values().iter().all(|(_, value)| value.is_finite())
        && [state.motion.distance, state.motion.angle, state.motion.aside].iter().all(|value| value.is_finite())
}
