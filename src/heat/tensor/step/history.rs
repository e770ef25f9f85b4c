//! Comparison of a step with the one before.

use crate::heat::state::{BoundaryState, HeatState};
use crate::heat::tensor::mesh::layout::HeatLayout;
use crate::heat::tensor::solve::operators::streams;

/// Relative change of speeds, conductance or heat from one step to the next that counts as a jump.
const JUMP: f64 = 0.3;
/// Heat whose changes do not count [W/m]: it warms a rolling contact by less than a kelvin.
const SLIGHT_HEAT: f64 = 1e4;
/// Digits after the first of the binary numbers to which shared speeds are rounded.
const SHARED_DIGITS: u32 = 6;

/// Speeds near the present ones that many steps share: those of the last step, rounded. Where one has changed by more
/// than rounding does, the present one takes its place.
///
/// They follow from the state, so that a step depends smoothly on its inputs.
pub fn shared_speeds(state: &HeatState, speeds: [f64; 2]) -> [f64; 2] {
    let near = |shared: f64, speed: f64| (shared - speed).abs() <= speed.abs() / f64::from(1 << SHARED_DIGITS);
    let Some(last) = state.last else { return speeds };
    [0, 1].map(|i| Some(rounded(last.speeds[i])).filter(|shared| near(*shared, speeds[i])).unwrap_or(speeds[i]))
}

/// The nearest number with [`SHARED_DIGITS`] binary digits after the first.
fn rounded(value: f64) -> f64 {
    let rest = f64::MANTISSA_DIGITS - 1 - SHARED_DIGITS;
    f64::from_bits((value.to_bits() + (1 << (rest - 1))) >> rest << rest)
}

/// Test that speeds, conductance or heat change so much from `before` to `next`, in a step of `dt` \[s], that it cannot
/// continue smoothly. A speed does not by which the stream carries material less than an element farther than before.
pub fn jumps(layout: &HeatLayout, before: &BoundaryState, next: &BoundaryState, dt: f64) -> bool {
    let jump = |a: f64, b: f64| (a - b).abs() > JUMP * a.abs().max(b.abs());
    let change: f64 = before.heat.iter().zip(&next.heat).map(|(a, b)| (a - b).abs()).sum();
    let larger = before.heat.iter().sum::<f64>().max(next.heat.iter().sum());
    let streams = [before, next].map(|state| streams(layout, state.speeds));
    let stream = |i: usize| (streams[0][i], streams[1][i]);
    [0, 1].map(stream).into_iter().any(|(a, b)| jump(a, b) && (a - b).abs() * dt > layout.element())
        || jump(before.conductance, next.conductance)
        || change > SLIGHT_HEAT + JUMP * larger
}
