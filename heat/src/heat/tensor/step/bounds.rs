//! Maximum principle: nothing becomes colder than the coldest datum or, without heat, hotter than the hottest one, to
//! [`MARGIN`].
//!
//! The discretisation itself does not keep this bound. Steep gradients make finite elements of higher order, short
//! steps with consistent mass, upwinding at contact edges and the second stage of the time formula swing beyond it.
//! Where a node lies beyond a datum by more than a margin, all that do are [moved back](super::limiter).

use crate::heat::exchange::Exchange;
use crate::heat::state::{HeatState, RowBounds};
use crate::heat::tensor::mesh::layout::HeatLayout;
use crate::heat::tensor::mesh::nodal::joined;

/// Distance by which a node may lie beyond a datum before it is moved back \[K].
pub const MARGIN: f64 = 0.09;
/// Share of the way from the reference to absolute zero from which on the lowest temperature is exact \[1].
const NEAR_ZERO: f64 = 0.9;
/// Excess relative to the span of temperatures up to which moving back is enough: the step is not taken again \[1].
const SLIGHT: f64 = 0.05;
/// Flux of friction heat that counts as none [W/m²]: that of a contact that sticks all over is round-off.
const NO_FLUX: f64 = 1e-6;

/// Coldest and hottest datum of a step \[K]: hub and air at the reference, the arriving rail, the wheel at the start,
/// and the range of reversible temperatures. There is no lower bound while a source cools, and no upper one while
/// one or friction heats; from the end of the heat on, the hottest node is a datum. Friction never cools: where
/// round-off gives it a negative share somewhere, the lower bound holds all the same.
pub fn data(layout: &HeatLayout, state: &HeatState, exchange: &Exchange) -> [f64; 2] {
    let moved = exchange.reversible.value.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
    let cooled = exchange.sources.iter().any(|source| source.heat < 0.0);
    let heated = exchange.friction_power.value.iter().any(|power| *power > NO_FLUX)
        || exchange.sources.iter().any(|source| source.heat > 0.0);
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
/// Below every surface node the bounds before hold, wider by how far values may have `moved`, until that has become too
/// much.
pub fn set_range(layout: &HeatLayout, state: &HeatState, moved: &[f64], next: &mut HeatState, melts: f64) {
    let [coldest, hottest] = next.data;
    let low = (coldest - MARGIN).max(-NEAR_ZERO * layout.config.reference);
    next.rows.clear();
    let moved = state.rows.iter().zip(moved);
    next.rows.extend(moved.map(|(row, change)| RowBounds { moved: row.moved + change, ..*row }));
    look(layout, next, [low, melts.min(hottest + MARGIN)]);
}

/// Fills the bounds of the nodal values of `state` after a look at all of them.
pub fn search(layout: &HeatLayout, state: &mut HeatState) {
    state.rows.clear();
    look(layout, state, [f64::NEG_INFINITY, f64::INFINITY]);
}

/// Fills the bounds of the nodal values of a state from those below every surface node (see [`Nodal::look`]).
///
/// [`Nodal::look`]: crate::heat::tensor::mesh::nodal::Nodal::look
fn look(layout: &HeatLayout, state: &mut HeatState, allowed: [f64; 2]) {
    let HeatState { values, rows, range, .. } = state;
    let count = layout.bodies().map(|body| body.streamline.len());
    if rows.len() != count[0] + count[1] {
        rows.clear();
        rows.resize(count[0] + count[1], RowBounds::UNKNOWN);
    }
    let rows: [_; 2] = rows.split_at_mut(count[0]).into();
    let ranges = layout.bodies().into_iter().zip(layout.split(values)).zip(rows);
    let ranges = ranges.map(|((body, field), rows)| body.nodal.look(field, rows, allowed, MARGIN));
    *range = ranges.reduce(joined).unwrap_or_default();
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
