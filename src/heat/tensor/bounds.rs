//! Nothing becomes colder than its surroundings, to [`MARGIN`]: the bound that the discretisation itself does not keep.
//!
//! Steep gradients make finite elements of higher order, short steps with consistent mass, upwinding at contact edges and
//! the second stage of the time formula undershoot. Where a node falls below the coldest datum by more than a margin, all
//! that are too cold are [lifted](super::lift).

use super::layout::Heat;
use super::nodal::Known;
use super::state::HeatState;
use crate::heat::error::HeatError;
use crate::heat::exchange::Exchange;

/// How far a node may fall below the coldest datum before it is lifted \[K].
pub(super) const MARGIN: f64 = 0.09;
/// Change in a step, in such margins, up to which bounds are widened without a look at the nodes [1].
const SLOWLY: f64 = 0.25;
/// Share of the way from the reference to absolute zero from which on the lowest temperature is exact \[1].
const NEAR_ZERO: f64 = 0.9;
/// Undershoot relative to the span of temperatures up to which lifting is enough: the step is not taken again \[1].
const SLIGHT: f64 = 0.05;

impl Heat {
    /// Coldest datum of a step \[K]: hub, air and arriving rail at the reference, the wheel at the start, and what
    /// reversible temperatures may have withdrawn. None while brake blocks cool: then only absolute zero is a bound.
    /// Friction never cools; where round-off gives it a negative share somewhere, the bound holds all the same.
    pub(super) fn coldest(&self, state: &HeatState, exchange: &Exchange) -> f64 {
        if exchange.tread.iter().any(|tread| tread.heat < 0.0) {
            return f64::MIN;
        }
        exchange.reversible.value.iter().fold(state.coldest, |low, value| low.min(-value.abs()))
    }

    /// Fills the bounds of the nodal values of `next`, exactly where they are needed.
    ///
    /// What hardly changes keeps the bounds before, a little wider; what has become too wide is searched anew.
    pub(super) fn set_range(&self, state: &HeatState, next: &mut HeatState) {
        let low = (next.coldest - MARGIN).max(-NEAR_ZERO * self.config.thermal.reference);
        let high = self.melting.map_or(f64::INFINITY, |melting| melting.solidus);
        // Bounds that have become wide do not come back by themselves.
        let wide = state.range[0] < next.coldest - 0.75 * MARGIN;
        if !wide {
            let size = self.wheel.size();
            let known = Known { before: state.range, allowed: [low, high], slight: SLOWLY * MARGIN };
            let (before, after) = (state.field.split_at(size), next.field.split_at(size));
            let [wheel, rail] = &self.nodal;
            let a = wheel.bounds_after([before.0, after.0], &known);
            let b = rail.bounds_after([before.1, after.1], &known);
            next.range = [a[0].min(b[0]), a[1].max(b[1])];
        }
        // Written so that what is not a number is not taken for known.
        let known = !wide && next.range[0] >= low && next.range[1] <= high;
        if !known {
            next.range = self.extremes(&next.field);
        }
    }

    /// The sum of temperature fields that hold at the same time, as if no step had led to it. Only the sum has to keep the
    /// bounds: what a wheel loses in passing is far below its datum, and the bounds of the parts say little about it.
    pub fn superposed(&self, parts: &[HeatState]) -> Result<HeatState, HeatError> {
        let mut sum = HeatState { field: vec![0.0; self.wheel.size() + self.rail.size()], ..HeatState::default() };
        for part in parts {
            self.check_state(part)?;
            sum.field.iter_mut().zip(&part.field).for_each(|(sum, value)| *sum += value);
            sum.coldest += part.coldest;
        }
        self.bounded(sum)
    }

    /// A state found without a step, with its extremes, and lifted where it undershoots.
    pub(super) fn bounded(&self, mut state: HeatState) -> Result<HeatState, HeatError> {
        state.range = self.extremes(&state.field);
        if self.undershoots(&state) {
            self.lift(&mut state, &mut Vec::new())?;
        }
        Ok(state)
    }

    /// Lowest and highest value at the nodes of both bodies.
    pub(super) fn extremes(&self, field: &[f64]) -> [f64; 2] {
        let (wheel, rail) = field.split_at(self.wheel.size());
        let (a, b) = (self.nodal[0].extremes(wheel), self.nodal[1].extremes(rail));
        [a[0].min(b[0]), a[1].max(b[1])]
    }

    /// Whether a field is colder somewhere than it may be.
    pub(super) fn undershoots(&self, state: &HeatState) -> bool {
        state.range[0] < state.coldest - MARGIN
    }

    /// Whether it is so much colder that another time formula is worth a try.
    pub(super) fn undershoots_badly(&self, state: &HeatState) -> bool {
        let [low, high] = state.range;
        self.undershoots(state) && state.coldest - low > SLIGHT * (high - state.coldest)
    }
}
