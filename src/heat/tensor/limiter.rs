//! Conservative limiter: nodes that are too cold are lifted, those that are too hot are lowered, and the heat comes from or goes
//! to as near as there is room for it.
//!
//! An undershoot is the other side of an overshoot close by: steep gradients make elements of higher order swing about the
//! exact field. So the heat comes from the nearest nodes below the same surface node, and where these have too little from
//! the rows beside. What lies within the margin is left alone: lifting every swing by a hundredth of a kelvin, and be it
//! step by step, drives the heat into the depth and cools the hot surface by some percent within milliseconds. Lowering is
//! lifting of the negative field.

use super::bounds::MARGIN;
use super::layout::Heat;
use super::modal::{HeatBody, dot};
use super::nodal::Nodal;
use super::state::HeatState;
use crate::heat::error::HeatError;

/// Share of the margin to which nodes are lifted \[1]: what is lifted does not fall below the margin at once again.
const LIFTED: f64 = 0.5;

impl Heat {
    /// Moves all nodes back that lie beyond a datum by more than a share of the margin, if one does by more than the margin; each
    /// body keeps its heat content.
    pub(super) fn keep_bounds(&self, state: &mut HeatState, values: &mut Vec<f64>) -> Result<(), HeatError> {
        let [below, above] = state.beyond();
        let HeatState { field, data, range, .. } = state;
        if below > 0.0 {
            let floor = data[0] - LIFTED * MARGIN;
            if !self.lift(field, floor, values) {
                return Err(HeatError::Undershoot { lowest: range[0], coldest: data[0] });
            }
            range[0] = floor;
        }
        if above > 0.0 {
            let ceiling = data[1] + LIFTED * MARGIN;
            let negate = |field: &mut [f64]| field.iter_mut().for_each(|value| *value = -*value);
            negate(field);
            let kept = self.lift(field, -ceiling, values);
            negate(field);
            if !kept {
                return Err(HeatError::Overshoot { highest: range[1], hottest: data[1] });
            }
            range[1] = ceiling;
        }
        Ok(())
    }

    /// Lifts all nodes to `floor`; whether both bodies have the heat for it.
    fn lift(&self, field: &mut [f64], floor: f64, values: &mut Vec<f64>) -> bool {
        let (wheel, rail) = field.split_at_mut(self.wheel.size());
        let bodies = [(&self.wheel, &self.nodal[0], wheel), (&self.rail, &self.nodal[1], rail)];
        bodies.into_iter().all(|(body, nodal, field)| lift_body(body, nodal, field, floor, values) <= 0.0)
    }
}

/// Heat content below one surface node over `ρc` above that at the temperature `floor`, per length [K m].
fn row_excess(body: &HeatBody, nodal: &Nodal, row: &[f64], floor: f64) -> f64 {
    dot(row, &body.modes.content) - floor * nodal.weights.iter().sum::<f64>()
}

/// Moves the temperatures below one surface node by `share` of the way to `floor`.
fn shrink(body: &HeatBody, row: &mut [f64], floor: f64, share: f64) {
    row.iter_mut().zip(&body.modes.free).for_each(|(x, one)| *x -= share * (*x - floor * one));
}

/// Lifts the nodes of one body to `floor`; the heat over `ρc` that it lacks for it [K m²].
fn lift_body(body: &HeatBody, nodal: &Nodal, field: &mut [f64], floor: f64, values: &mut Vec<f64>) -> f64 {
    let (nm, size) = (nodal.modes(), nodal.len());
    values.resize(2 * size, 0.0);
    let (lifted, change) = values.split_at_mut(size);
    let mut poor = Vec::new();
    for (i, (row, weight)) in field.chunks_exact_mut(nm).zip(&body.line.weights).enumerate() {
        nodal.values(row, lifted);
        if lifted.iter().all(|value| *value >= floor) {
            continue;
        }
        lifted.iter_mut().for_each(|value| *value -= floor);
        change.copy_from_slice(lifted);
        let lack = lift_column(lifted, &nodal.weights);
        change.iter_mut().zip(&*lifted).for_each(|(before, after)| *before = after - *before);
        nodal.add(change, row);
        if lack > 0.0 {
            poor.push((i, weight * lack));
        }
    }
    poor.into_iter().map(|(i, lack)| take_beside(body, nodal, field, floor, i, lack)).sum()
}

/// Lifts negative values to zero and takes as much from the nearest positive ones; what is lacking, in values times weights.
fn lift_column(values: &mut [f64], weights: &[f64]) -> f64 {
    let mut missing = 0.0;
    for j in 0..values.len() {
        let mut lack = (-values[j] * weights[j]).max(0.0);
        values[j] = values[j].max(0.0);
        let mut distance = 1;
        while lack > 0.0 && distance < values.len() {
            let near = [j.checked_sub(distance), Some(j + distance).filter(|&k| k < values.len())];
            let has: f64 = near.iter().flatten().map(|&k| (values[k] * weights[k]).max(0.0)).sum();
            let share = if has > lack { lack / has } else { 1.0 };
            for k in near.into_iter().flatten() {
                // What is still to be lifted gives nothing.
                values[k] *= if values[k] > 0.0 { 1.0 - share } else { 1.0 };
            }
            lack -= share * has;
            distance += 1;
        }
        missing += lack.max(0.0);
    }
    missing
}

/// Takes `lack` [K m²] from the rows nearest to the row `i`, all of which lie above the floor; what is still lacking.
fn take_beside(body: &HeatBody, nodal: &Nodal, field: &mut [f64], floor: f64, i: usize, mut lack: f64) -> f64 {
    let (nm, n) = (nodal.modes(), body.line.len());
    let closed = body.line.closed > 0.0;
    let farthest = if closed { n.div_ceil(2) } else { n };
    for distance in 1..farthest {
        let (before, after) = (i.checked_sub(distance), Some(i + distance).filter(|&k| k < n));
        let around = |k: usize| Some(k % n).filter(|_| closed);
        let near = [before.or_else(|| around(i + n - distance)), after.or_else(|| around(i + distance))];
        let has = near.map(|k| {
            k.map_or(0.0, |k| body.line.weights[k] * row_excess(body, nodal, &field[k * nm..][..nm], floor).max(0.0))
        });
        let total = has[0] + has[1];
        let share = if total > lack { lack / total } else { 1.0 };
        for k in near.into_iter().flatten() {
            shrink(body, &mut field[k * nm..][..nm], floor, share);
        }
        lack -= share * total;
        if lack <= 0.0 {
            return 0.0;
        }
    }
    lack
}

#[cfg(test)]
mod tests {
    use super::lift_column;

    #[test]
    fn the_nearest_nodes_lift_an_undershoot_and_the_surface_keeps_its_heat() {
        let (mut values, weights) = ([100.0, 10.0, -1.0, 4.0, 0.0], [1.0, 1.0, 2.0, 1.0, 1.0]);
        assert_eq!(lift_column(&mut values, &weights), 0.0);
        let share = 2.0 / 14.0;
        assert_eq!(values, [100.0, 10.0 * (1.0 - share), 0.0, 4.0 * (1.0 - share), 0.0]);
    }

    #[test]
    fn what_a_column_lacks_is_told() {
        let mut values = [1.0, -3.0, 0.5];
        assert_eq!(lift_column(&mut values, &[1.0, 1.0, 2.0]), 1.0);
        assert_eq!(values, [0.0; 3]);
    }
}
