//! Maximum principle: nothing becomes colder than the coldest datum or, without heat, hotter than the hottest one, to [`MARGIN`].
//!
//! The discretisation itself does not keep this bound. Steep gradients make finite elements of higher order, short steps with
//! consistent mass, upwinding at contact edges and the second stage of the time formula swing beyond it. Where a node lies
//! beyond a datum by more than a margin, all that do are [moved back](super::limiter).

use super::layout::Heat;
use super::nodal::Known;
use super::state::HeatState;
use crate::heat::error::HeatError;
use crate::heat::exchange::Exchange;

/// How far a node may lie beyond a datum before it is moved back \[K].
pub(super) const MARGIN: f64 = 0.09;
/// Change in a step, in such margins, up to which bounds are widened without a look at the nodes [1].
const SLOWLY: f64 = 0.25;
/// Share of the way from the reference to absolute zero from which on the lowest temperature is exact \[1].
const NEAR_ZERO: f64 = 0.9;
/// Excess relative to the span of temperatures up to which moving back is enough: the step is not taken again \[1].
const SLIGHT: f64 = 0.05;
/// Flux of friction heat that counts as none [W/m²]: that of a contact that sticks all over is round-off.
const NO_FLUX: f64 = 1e-6;

impl Heat {
    /// Coldest and hottest datum of a step \[K]: hub and air at the reference, the arriving rail, the wheel at the start, and what
    /// reversible temperatures may have moved. There is no lower bound while brake blocks cool, and no upper one while they or
    /// friction heat; from the end of the heat on, what is hottest then is a datum. Friction never cools: where round-off gives
    /// it a negative share somewhere, the lower bound holds all the same.
    pub(super) fn data(&self, state: &HeatState, exchange: &Exchange) -> [f64; 2] {
        let moved = exchange.reversible.value.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        let cooled = exchange.tread.iter().any(|tread| tread.heat < 0.0);
        let heated = exchange.friction_power.value.iter().any(|power| *power > NO_FLUX)
            || exchange.tread.iter().any(|tread| tread.heat > 0.0);
        let [low, high] = state.data;
        let high = if high == f64::INFINITY && !heated { self.extremes(&state.field)[1].max(0.0) } else { high };
        [
            if cooled { f64::NEG_INFINITY } else { low.min(state.arriving).min(-moved) },
            if heated { f64::INFINITY } else { high.max(state.arriving).max(moved) },
        ]
    }

    /// Fills the bounds of the nodal values of `next`, exactly where they are needed.
    ///
    /// What hardly changes keeps the bounds before, a little wider; what has become too wide is searched anew.
    pub(super) fn set_range(&self, state: &HeatState, next: &mut HeatState) {
        let [coldest, hottest] = next.data;
        let low = (coldest - MARGIN).max(-NEAR_ZERO * self.config.thermal.reference);
        let high = self.melting.map_or(f64::INFINITY, |melting| melting.solidus).min(hottest + MARGIN);
        // Bounds that have become wide do not come back by themselves.
        let wide = state.range[0] < coldest - 0.75 * MARGIN || state.range[1] > hottest + 0.75 * MARGIN;
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
            sum.arriving += part.arriving;
            sum.data = [0, 1].map(|end| sum.data[end] + part.data[end]);
        }
        self.bounded(sum)
    }

    /// A state found without a step, with its extremes and within its bounds.
    pub(super) fn bounded(&self, mut state: HeatState) -> Result<HeatState, HeatError> {
        state.range = self.extremes(&state.field);
        self.keep_bounds(&mut state, &mut Vec::new())?;
        Ok(state)
    }

    /// Lowest and highest value at the nodes of both bodies.
    pub(super) fn extremes(&self, field: &[f64]) -> [f64; 2] {
        let (wheel, rail) = field.split_at(self.wheel.size());
        let (a, b) = (self.nodal[0].extremes(wheel), self.nodal[1].extremes(rail));
        [a[0].min(b[0]), a[1].max(b[1])]
    }
}

impl HeatState {
    /// How far the nodes lie below the coldest and above the hottest datum, where that is more than the margin \[K].
    pub(super) fn beyond(&self) -> [f64; 2] {
        let ([low, high], [coldest, hottest]) = (self.range, self.data);
        [coldest - low, high - hottest].map(|excess| if excess > MARGIN { excess } else { 0.0 })
    }

    /// Whether the field swings so far beyond its data that another time formula is worth a try.
    pub(super) fn swings(&self) -> bool {
        let [below, above] = self.beyond();
        below > SLIGHT * (self.range[1] - self.data[0]) || above > SLIGHT * (self.data[1] - self.range[0])
    }
}
