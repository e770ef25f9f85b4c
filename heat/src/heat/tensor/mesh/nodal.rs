//! Temperatures at the nodes across the streamlines, where bounds and melting act, and the way back to the modes.

use super::depth_modes::{DepthModes, PADDING};
use super::kernels::{self, dot};
use crate::heat::error::HeatError;
use crate::heat::state::RowBounds;
use crate::linalg::vectorised::add_columns;
use nalgebra::DMatrix;

/// Maps in both directions between coefficients of modes and values at the nodes across the streamlines.
#[derive(Clone, Debug)]
pub struct Nodal {
    /// Number of modes, padding included.
    modes: usize,
    /// Values of the modes at the nodes, mode by mode, where the first node fills up the last register.
    shapes: Vec<f64>,
    /// Coefficients of a field that is 1 at one node, node by node.
    to_modes: Vec<f64>,
    /// `∫ g N dz` of every node: its share of the heat content \[m].
    pub weights: Vec<f64>,
    /// Largest value of every mode at a node.
    pub peaks: Vec<f64>,
}

impl Nodal {
    /// Maps for the nodes of `modes` that are not held.
    pub fn new(modes: &DepthModes) -> Result<Self, HeatError> {
        let (size, nm) = (modes.shapes.nrows(), modes.len());
        let square = modes.shapes.columns(0, size).into_owned();
        let inverse: DMatrix<f64> = square.try_inverse().ok_or(HeatError::Eigen { size })?;
        let mut nodal = Self {
            modes: nm,
            shapes: modes.shapes.as_slice().chunks_exact(size).flat_map(filled_up).collect(),
            to_modes: vec![0.0; size * nm],
            weights: Vec::with_capacity(size),
            peaks: modes.shapes.column_iter().map(|column| column.amax()).collect(),
        };
        for j in 0..size {
            for m in 0..size {
                nodal.to_modes[j * nm + m] = inverse[(m, j)];
            }
            nodal.weights.push(dot(&nodal.to_modes[j * nm..(j + 1) * nm], &modes.content));
        }
        Ok(nodal)
    }

    /// Number of nodes across the streamlines.
    pub fn len(&self) -> usize {
        self.weights.len()
    }

    /// Number of modes, padding included.
    pub fn modes(&self) -> usize {
        self.modes
    }

    /// A bound of the values at the nodes below one surface node.
    pub fn bound(&self, row: &[f64]) -> f64 {
        row.iter().zip(&self.peaks).map(|(x, peak)| x.abs() * peak).sum()
    }

    /// Replaces `values` by those at the nodes below one surface node.
    pub fn values(&self, row: &[f64], values: &mut [f64]) {
        values.fill(0.0);
        add_columns(1.0, &self.shapes, self.shapes.len() / self.modes, row, values);
    }

    /// Adds a field given at the nodes below one surface node to its modes.
    pub fn add(&self, values: &[f64], row: &mut [f64]) {
        for (value, column) in values.iter().zip(self.to_modes.chunks_exact(self.modes)) {
            if *value != 0.0 {
                kernels::add(*value, column, row);
            }
        }
    }

    /// Lowest and highest value of a field at its nodes, or of the part of it below some surface nodes.
    pub fn extremes(&self, field: &[f64]) -> [f64; 2] {
        let mut range = EMPTY;
        kernels::extremes(field, &self.shapes, self.shapes.len() / self.modes, &mut range);
        range
    }

    /// Bounds of all `rows` of a field from what is known of each: one is looked at where it may have left the bounds
    /// `allowed`, or has moved by more than `slight`.
    pub fn look(&self, field: &[f64], rows: &mut [RowBounds], allowed: [f64; 2], slight: f64) -> [f64; 2] {
        let mut range = EMPTY;
        for (row, values) in rows.iter_mut().zip(field.chunks_exact(self.modes)) {
            let bounds = row.range();
            // Written so that NaN is not taken for known.
            let clear = row.moved <= slight && bounds[0] >= allowed[0] && bounds[1] <= allowed[1];
            if !clear {
                *row = RowBounds { found: self.extremes(values), moved: 0.0 };
            }
            range = joined(range, row.range());
        }
        range
    }
}

/// Bounds of no values.
const EMPTY: [f64; 2] = [f64::INFINITY, f64::NEG_INFINITY];

/// Bounds of two sets of values. Comparisons, not `min` and `max`: each compiles to one instruction.
pub fn joined(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [if b[0] < a[0] { b[0] } else { a[0] }, if b[1] > a[1] { b[1] } else { a[1] }]
}

/// The values `column` at the nodes, with the first one again until registers are full.
fn filled_up(column: &[f64]) -> impl Iterator<Item = f64> + '_ {
    let padded = column.len().next_multiple_of(PADDING);
    (0..padded).map(|node| column.get(node).copied().unwrap_or(column[0]))
}
