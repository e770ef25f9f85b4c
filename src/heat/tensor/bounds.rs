//! Nothing becomes colder than its surroundings, to [`MARGIN`]: the bound that the discretisation itself does not keep.
//!
//! Steep gradients make finite elements of higher order, short steps with consistent mass, upwinding at contact edges and
//! the second stage of the time formula undershoot. Where a node falls below the coldest datum, it is lifted to it, and
//! the heat for it is taken in proportion to the excess over the bound: from the nodes below the same surface node, or
//! from the whole body where those have too little. The heat content of each body stays what it was, to round-off. A body
//! without that much heat keeps an undershoot of up to [`TOLERATED`]; more is refused as a step.

use super::layout::Heat;
use super::modal::HeatBody;
use super::nodal::{Known, Nodal};
use super::state::HeatState;
use crate::heat::error::HeatError;
use crate::heat::exchange::Exchange;

/// How far a node may fall below the coldest datum before it is lifted \[K].
const MARGIN: f64 = 0.08;
/// Change in a step, in such margins, up to which bounds are widened without a look at the nodes [1].
const SLOWLY: f64 = 0.25;
/// Share of the way from the reference to absolute zero from which on the lowest temperature is exact \[1].
const NEAR_ZERO: f64 = 0.9;
/// Undershoot that passes where a body has no heat to lift it with \[K].
const TOLERATED: f64 = 1.0;
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
        let wide = state.range[0] < next.coldest - 0.5 * MARGIN;
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

    /// Lifts all nodes to the coldest datum and keeps the heat contents.
    pub(super) fn lift(&self, state: &mut HeatState, values: &mut Vec<f64>) -> Result<(), HeatError> {
        let HeatState { field, coldest, range, .. } = state;
        let (wheel, rail) = field.split_at_mut(self.wheel.size());
        let mut lifted = true;
        for (body, nodal, field) in [(&self.wheel, &self.nodal[0], wheel), (&self.rail, &self.nodal[1], rail)] {
            values.resize(nodal.len(), 0.0);
            if affords(body, nodal, field, *coldest, values) {
                lift_body(body, nodal, field, *coldest, values);
            } else if range[0] < *coldest - TOLERATED {
                return Err(HeatError::Undershoot { lowest: range[0], coldest: *coldest });
            } else {
                lifted = false;
            }
        }
        if lifted {
            range[0] = *coldest;
        }
        Ok(())
    }
}

/// Whether the heat content of a body allows its nodes to be lifted: one that is hardly warm anywhere may lack the heat.
fn affords(body: &HeatBody, nodal: &Nodal, field: &[f64], floor: f64, values: &mut [f64]) -> bool {
    let mut total = 0.0;
    for (row, weight) in field.chunks_exact(body.modes.len()).zip(&body.line.weights) {
        nodal.values(row, values);
        let excess = values.iter().zip(&nodal.weights).map(|(value, share)| (value - floor) * share);
        total += weight * excess.sum::<f64>();
    }
    total >= 0.0
}

/// Lifts the nodes of one body.
fn lift_body(body: &HeatBody, nodal: &Nodal, field: &mut [f64], floor: f64, values: &mut [f64]) {
    let modes = &body.modes;
    let (mut missing, mut total) = (0.0, 0.0);
    for (row, weight) in field.chunks_exact_mut(modes.len()).zip(&body.line.weights) {
        nodal.values(row, values);
        values.iter_mut().for_each(|value| *value -= floor);
        let (mut lack, mut surplus) = (0.0, 0.0);
        for (value, weight) in values.iter().zip(&nodal.weights) {
            let heat = value * weight;
            if heat < 0.0 { lack -= heat } else { surplus += heat }
        }
        if lack > 0.0 {
            let given = if lack <= surplus { lack / surplus } else { 0.0 };
            values.iter_mut().for_each(|value| *value = if *value < 0.0 { -*value } else { -given * *value });
            nodal.add(values, row);
            let left = if given > 0.0 { 0.0 } else { lack };
            missing += weight * left;
            surplus -= lack - left;
        }
        total += weight * surplus;
    }
    if missing > 0.0 && total > 0.0 {
        // Now nothing lies below the bound: the excess of the whole body shrinks.
        let share = missing / total;
        for row in field.chunks_exact_mut(modes.len()) {
            row.iter_mut().zip(&modes.free).for_each(|(x, one)| *x -= share * (*x - floor * one));
        }
    }
}
