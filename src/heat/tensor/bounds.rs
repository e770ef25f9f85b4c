//! Nothing becomes colder than its surroundings: the bound that the discretisation itself does not keep.
//!
//! Steep gradients make finite elements of higher order, short steps with consistent mass, upwinding at contact edges and
//! the second stage of the time formula undershoot. Where a node falls below the coldest datum, it is lifted to it, and
//! the heat for it is taken in proportion to the excess over the bound: from the nodes below the same surface node, or
//! from the whole body where those have too little. The heat content of each body stays what it was, to round-off.

use super::layout::Heat;
use super::modal::HeatBody;
use super::nodal::Nodal;
use super::state::HeatState;
use crate::heat::error::HeatError;
use crate::heat::exchange::Exchange;

/// How far a node may fall below the coldest datum before it is lifted \[K].
const MARGIN: f64 = 0.08;
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
    pub(super) fn set_range(&self, state: &HeatState, next: &mut HeatState, values: &mut Vec<f64>) {
        let size = self.wheel.size();
        let [wheel, rail] = &self.nodal;
        let change = wheel
            .largest_change(&state.field[..size], &next.field[..size])
            .max(rail.largest_change(&state.field[size..], &next.field[size..]));
        let melts = self.melting.map_or(f64::INFINITY, |melting| melting.solidus);
        next.range = [state.range[0] - change, state.range[1] + change];
        // Written so that what is not a number is not taken for known.
        let low = (next.coldest - MARGIN).max(-NEAR_ZERO * self.config.thermal.reference);
        let known = next.range[0] >= low && next.range[1] <= melts;
        if !known {
            next.range = self.extremes(&next.field, values);
        }
    }

    /// Lowest and highest value at the nodes of both bodies.
    pub(super) fn extremes(&self, field: &[f64], values: &mut Vec<f64>) -> [f64; 2] {
        let (wheel, rail) = field.split_at(self.wheel.size());
        let (a, b) = (self.nodal[0].extremes(wheel, values), self.nodal[1].extremes(rail, values));
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
        for (body, nodal, field) in [(&self.wheel, &self.nodal[0], wheel), (&self.rail, &self.nodal[1], rail)] {
            values.resize(nodal.len(), 0.0);
            if !lift_body(body, nodal, field, *coldest, values) {
                return Err(HeatError::Undershoot { lowest: range[0], coldest: *coldest });
            }
        }
        range[0] = *coldest;
        Ok(())
    }
}

/// Lifts the nodes of one body; whether its heat content allows it.
fn lift_body(body: &HeatBody, nodal: &Nodal, field: &mut [f64], floor: f64, values: &mut [f64]) -> bool {
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
    if missing > total {
        return false;
    }
    if missing > 0.0 {
        // Now nothing lies below the bound: the excess of the whole body shrinks.
        let share = missing / total;
        for row in field.chunks_exact_mut(modes.len()) {
            row.iter_mut().zip(&modes.free).for_each(|(x, one)| *x -= share * (*x - floor * one));
        }
    }
    true
}
