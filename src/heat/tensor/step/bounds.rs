//! Maximum principle: nothing becomes colder than the coldest datum or, without heat, hotter than the hottest one, to
//! [`MARGIN`].
//!
//! The discretisation itself does not keep this bound. Steep gradients make finite elements of higher order, short
//! steps with consistent mass, upwinding at contact edges and the second stage of the time formula swing beyond it.
//! Where a node lies beyond a datum by more than a margin, all that do are [moved back](super::limiter).

use crate::heat::exchange::Exchange;
use crate::heat::state::HeatState;
use crate::heat::tensor::mesh::layout::HeatLayout;
use crate::heat::tensor::mesh::nodal::Known;

/// Distance by which a node may lie beyond a datum before it is moved back \[K].
pub const MARGIN: f64 = 0.09;
/// Change in a step, in such margins, up to which bounds are widened without a look at the nodes [1].
const SLOWLY: f64 = 0.25;
/// Share of the way from the reference to absolute zero from which on the lowest temperature is exact \[1].
const NEAR_ZERO: f64 = 0.9;
/// Excess relative to the span of temperatures up to which moving back is enough: the step is not taken again \[1].
const SLIGHT: f64 = 0.05;
/// Flux of friction heat that counts as none [W/m²]: that of a contact that sticks all over is round-off.
const NO_FLUX: f64 = 1e-6;

/// Coldest and hottest datum of a step \[K]: hub and air at the reference, the arriving rail, the wheel at the start,
/// and the range of reversible temperatures. There is no lower bound while brake blocks cool, and no upper one while
/// they or friction heat; from the end of the heat on, the hottest node is a datum. Friction never cools: where
/// round-off gives it a negative share somewhere, the lower bound holds all the same.
pub fn data(layout: &HeatLayout, state: &HeatState, exchange: &Exchange) -> [f64; 2] {
    let moved = exchange.reversible.value.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
    let cooled = exchange.tread.iter().any(|tread| tread.heat < 0.0);
    let heated = exchange.friction_power.value.iter().any(|power| *power > NO_FLUX)
        || exchange.tread.iter().any(|tread| tread.heat > 0.0);
    let [low, high] = state.data;
    let high = if high == f64::INFINITY && !heated { layout.extremes(&state.values)[1].max(0.0) } else { high };
    [
        if cooled { f64::NEG_INFINITY } else { low.min(state.arriving).min(-moved) },
        if heated { f64::INFINITY } else { high.max(state.arriving).max(moved) },
    ]
}

/// Fills the bounds of the nodal values of `next`, exactly where they are needed: beyond the data, near absolute zero,
/// and from the temperature `melts` \[K] on.
///
/// Rows that hardly change keep the bounds before, a little wider; bounds that have become too wide are searched anew.
pub fn set_range(layout: &HeatLayout, state: &HeatState, next: &mut HeatState, melts: f64) {
    let [coldest, hottest] = next.data;
    let low = (coldest - MARGIN).max(-NEAR_ZERO * layout.config.thermal.reference);
    let high = melts.min(hottest + MARGIN);
    // Bounds that have become wide do not come back by themselves.
    let wide = state.range[0] < coldest - 0.75 * MARGIN || state.range[1] > hottest + 0.75 * MARGIN;
    if !wide {
        let known = Known { before: state.range, allowed: [low, high], slight: SLOWLY * MARGIN };
        let ([from_wheel, from_rail], [wheel, rail]) = (layout.split(&state.values), layout.split(&next.values));
        let a = layout.wheel.nodal.bounds_after([from_wheel, wheel], &known);
        let b = layout.rail.nodal.bounds_after([from_rail, rail], &known);
        next.range = [a[0].min(b[0]), a[1].max(b[1])];
    }
    // Written so that NaN is not taken for known.
    let known = !wide && next.range[0] >= low && next.range[1] <= high;
    if !known {
        next.range = layout.extremes(&next.values);
    }
}

/// Distances by which the nodes lie below the coldest and above the hottest datum, where that is more than the margin
/// \[K].
pub fn beyond(state: &HeatState) -> [f64; 2] {
    let ([low, high], [coldest, hottest]) = (state.range, state.data);
    [coldest - low, high - hottest].map(|excess| if excess > MARGIN { excess } else { 0.0 })
}

/// Test that the field swings so far beyond its data that another time formula is worth a try.
pub fn swings(state: &HeatState) -> bool {
    let [below, above] = beyond(state);
    below > SLIGHT * (state.range[1] - state.data[0]) || above > SLIGHT * (state.data[1] - state.range[0])
}
