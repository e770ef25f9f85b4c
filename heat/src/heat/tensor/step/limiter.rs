//! Conservative limiter: nodes that are too cold are raised, those that are too hot are lowered, and the heat comes
//! from or goes to as near as there is room for it.
//!
//! An undershoot is the other side of an overshoot close by: steep gradients make elements of higher order swing about
//! the exact field. So the heat comes from the nearest nodes below the same surface node, and where these have too
//! little from the rows beside. Nodes within the margin are left alone: raising every swing by a hundredth of a
//! kelvin, and be it step by step, drives the heat into the depth and cools the hot surface by some percent within
//! milliseconds. Lowering is raising of the negative field.

use super::bounds::{MARGIN, beyond};
use crate::heat::error::HeatError;
use crate::heat::state::{HeatState, RowBounds};
use crate::heat::tensor::mesh::body::HeatBody;
use crate::heat::tensor::mesh::kernels::dot;
use crate::heat::tensor::mesh::layout::HeatLayout;

/// Share of the margin to which nodes are raised \[1]: a node that is raised does not fall below the margin at once
/// again.
const RAISED: f64 = 0.5;

/// Moves all nodes back that lie beyond a datum by more than a share of the margin, if one does by more than the
/// margin, and tells whether it does; each body keeps its heat content.
pub fn keep_bounds(layout: &HeatLayout, state: &mut HeatState, values: &mut Vec<f64>) -> Result<bool, HeatError> {
    let [below, above] = beyond(state);
    let HeatState { values: field, data, range, rows, .. } = state;
    if below > 0.0 {
        let floor = data[0] - RAISED * MARGIN;
        if !raise(layout, field, rows, floor, values) {
            return Err(HeatError::OutOfBounds { found: range[0], datum: data[0], extreme: "coldest" });
        }
        range[0] = floor;
    }
    if above > 0.0 {
        let ceiling = data[1] + RAISED * MARGIN;
        negate(field, rows);
        let kept = raise(layout, field, rows, -ceiling, values);
        negate(field, rows);
        if !kept {
            return Err(HeatError::OutOfBounds { found: range[1], datum: data[1], extreme: "hottest" });
        }
        range[1] = ceiling;
    }
    Ok(below > 0.0 || above > 0.0)
}

fn negate(field: &mut [f64], rows: &mut [RowBounds]) {
    field.iter_mut().for_each(|value| *value = -*value);
    rows.iter_mut().for_each(|row| row.found = [-row.found[1], -row.found[0]]);
}

/// Raises all nodes to `floor`, and tells whether both bodies have the heat for it; `rows` is what is known of them.
fn raise(layout: &HeatLayout, field: &mut [f64], rows: &mut [RowBounds], floor: f64, values: &mut Vec<f64>) -> bool {
    let rows: [_; 2] = rows.split_at_mut(layout.wheel.streamline.len()).into();
    let mut bodies = layout.bodies().into_iter().zip(layout.split_mut(field)).zip(rows);
    bodies.all(|((body, field), rows)| raise_body(body, field, rows, floor, values) <= 0.0)
}

/// Heat content below one surface node over `ρc` above that at the temperature `floor`, per length [K m].
fn row_excess(body: &HeatBody, row: &[f64], floor: f64) -> f64 {
    dot(row, &body.modes.content) - floor * body.nodal.weights.iter().sum::<f64>()
}

/// Moves the temperatures below one surface node by `share` of the way to `floor`.
fn shrink(body: &HeatBody, row: &mut [f64], floor: f64, share: f64) {
    row.iter_mut().zip(&body.modes.free).for_each(|(x, one)| *x -= share * (*x - floor * one));
}

/// Raises the nodes of one body to `floor`; the heat over `ρc` that it lacks for it [K m²].
fn raise_body(body: &HeatBody, field: &mut [f64], rows: &mut [RowBounds], floor: f64, values: &mut Vec<f64>) -> f64 {
    let nodal = &body.nodal;
    let (nm, size) = (nodal.modes(), nodal.len());
    values.resize(2 * size, 0.0);
    let (raised, change) = values.split_at_mut(size);
    let mut poor = Vec::new();
    let weighted = field.chunks_exact_mut(nm).zip(&body.streamline.weights);
    for (i, ((row, weight), known)) in weighted.zip(&mut *rows).enumerate() {
        if known.range()[0] >= floor {
            continue;
        }
        // Bounds that have not moved since the row was looked at are its extremes.
        if known.moved != 0.0 {
            *known = RowBounds { found: nodal.extremes(row), moved: 0.0 };
        }
        if known.found[0] >= floor {
            continue;
        }
        nodal.values(row, raised);
        raised.iter_mut().for_each(|value| *value -= floor);
        change.copy_from_slice(raised);
        let lack = raise_column(raised, &nodal.weights);
        change.iter_mut().zip(&*raised).for_each(|(before, after)| *before = after - *before);
        nodal.add(change, row);
        known.found = [floor, known.found[1].max(floor)];
        if lack > 0.0 {
            poor.push((i, weight * lack));
        }
    }
    if !poor.is_empty() {
        // The rows beside that give heat approach the floor.
        rows.iter_mut().for_each(|known| known.found[0] = known.found[0].min(floor + known.moved));
    }
    poor.into_iter().map(|(i, lack)| take_beside(body, field, floor, i, lack)).sum()
}

/// Raises negative values to zero and takes as much from the nearest positive ones; returns the lack, in values times
/// weights.
fn raise_column(values: &mut [f64], weights: &[f64]) -> f64 {
    let mut missing = 0.0;
    for j in 0..values.len() {
        if values[j] > 0.0 {
            continue;
        }
        let mut lack = (-values[j] * weights[j]).max(0.0);
        values[j] = 0.0;
        let mut distance = 1;
        while lack > 0.0 && distance < values.len() {
            let near = [j.wrapping_sub(distance), j + distance];
            // A value that is still to be raised gives nothing.
            let has = near.map(|k| values.get(k).map_or(0.0, |value| (value * weights[k]).max(0.0)));
            let has = has[0] + has[1];
            let share = if has > lack { lack / has } else { 1.0 };
            for k in near {
                if let Some(value) = values.get_mut(k).filter(|value| **value > 0.0) {
                    *value *= 1.0 - share;
                }
            }
            lack -= share * has;
            distance += 1;
        }
        missing += lack.max(0.0);
    }
    missing
}

/// Takes `lack` [K m²] from the rows nearest to the row `i`, all of which lie above the floor, and returns the rest
/// that is still lacking.
fn take_beside(body: &HeatBody, field: &mut [f64], floor: f64, i: usize, mut lack: f64) -> f64 {
    let (nm, n) = (body.nodal.modes(), body.streamline.len());
    let closed = body.streamline.closed > 0.0;
    let farthest = if closed { n.div_ceil(2) } else { n };
    for distance in 1..farthest {
        let (before, after) = (i.checked_sub(distance), Some(i + distance).filter(|&k| k < n));
        let around = |k: usize| Some(k % n).filter(|_| closed);
        let near = [before.or_else(|| around(i + n - distance)), after.or_else(|| around(i + distance))];
        let has = near.map(|k| {
            k.map_or(0.0, |k| body.streamline.weights[k] * row_excess(body, &field[k * nm..][..nm], floor).max(0.0))
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
    use super::raise_column;

    #[test]
    fn the_nearest_nodes_raise_an_undershoot_and_the_surface_keeps_its_heat() {
        let (mut values, weights) = ([100.0, 10.0, -1.0, 4.0, 0.0], [1.0, 1.0, 2.0, 1.0, 1.0]);
        assert_eq!(raise_column(&mut values, &weights), 0.0);
        let share = 2.0 / 14.0;
        assert_eq!(values, [100.0, 10.0 * (1.0 - share), 0.0, 4.0 * (1.0 - share), 0.0]);
    }

    #[test]
    fn what_a_column_lacks_is_told() {
        let mut values = [1.0, -3.0, 0.5];
        assert_eq!(raise_column(&mut values, &[1.0, 1.0, 2.0]), 1.0);
        assert_eq!(values, [0.0; 3]);
    }
}
