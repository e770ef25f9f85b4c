//! Temperatures at the nodes across the streamlines, where bounds and melting act, and the way back to the modes.

use super::depth_modes::DepthModes;
use super::kernels::{dot, weighted_change};
use crate::heat::error::HeatError;
use nalgebra::DMatrix;

/// Maps in both directions between coefficients of modes and values at the nodes across the streamlines.
#[derive(Clone, Debug)]
pub struct Nodal {
    /// Number of modes, padding included.
    modes: usize,
    /// Values of the modes at the nodes, node by node.
    to_nodes: Vec<f64>,
    /// Coefficients of a field that is 1 at one node, node by node.
    to_modes: Vec<f64>,
    /// `∫ g N dz` of every node: its share of the heat content \[m].
    pub weights: Vec<f64>,
    /// The values again, mode by mode.
    shapes: Vec<f64>,
    /// Number of nodes, from the surface on, at which a mode counts: the steep ones live in the thin layers at the
    /// surface.
    reach: Vec<usize>,
    /// Largest value of every mode at a node.
    peaks: Vec<f64>,
}

/// Value of a mode relative to its largest one below which it does not count where a field is searched for its
/// extremes.
const NEGLIGIBLE: f64 = 1e-9;

impl Nodal {
    /// Maps for the nodes of `modes` that are not held.
    pub fn new(modes: &DepthModes) -> Result<Self, HeatError> {
        let (size, nm) = (modes.shapes.nrows(), modes.len());
        let square = modes.shapes.columns(0, size).into_owned();
        let inverse: DMatrix<f64> = square.try_inverse().ok_or(HeatError::Eigen { size })?;
        let mut nodal = Self {
            modes: nm,
            to_nodes: vec![0.0; size * nm],
            to_modes: vec![0.0; size * nm],
            weights: Vec::with_capacity(size),
            shapes: modes.shapes.as_slice().to_vec(),
            reach: Vec::with_capacity(nm),
            peaks: Vec::with_capacity(nm),
        };
        for column in modes.shapes.column_iter() {
            let peak = column.amax();
            let reach =
                column.as_slice().iter().rposition(|value| value.abs() > NEGLIGIBLE * peak).map_or(0, |last| last + 1);
            nodal.reach.push(reach);
            nodal.peaks.push(peak);
        }
        for j in 0..size {
            for m in 0..size {
                nodal.to_nodes[j * nm + m] = modes.shapes[(j, m)];
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
        values.iter_mut().zip(self.to_nodes.chunks_exact(self.modes)).for_each(|(v, shape)| *v = dot(row, shape));
    }

    /// Adds a field given at the nodes below one surface node to its modes.
    pub fn add(&self, values: &[f64], row: &mut [f64]) {
        for (value, column) in values.iter().zip(self.to_modes.chunks_exact(self.modes)) {
            if *value != 0.0 {
                row.iter_mut().zip(column).for_each(|(x, c)| *x += value * c);
            }
        }
    }

    /// Lowest and highest value of a field at its nodes.
    pub fn extremes(&self, field: &[f64]) -> [f64; 2] {
        let rows = field.chunks_exact(self.modes);
        rows.fold(EMPTY, |range, row| joined(range, self.extremes_of_row(row)))
    }

    /// Bounds of the field `to`, where `before` are those of the field `from`: exact at the nodes that change by more
    /// than `slight` or might leave the bounds `allowed`.
    pub fn bounds_after(&self, [from, to]: [&[f64]; 2], known: &Known) -> [f64; 2] {
        let pairs = from.chunks_exact(self.modes).zip(to.chunks_exact(self.modes));
        let bounds = |range: [f64; 2], (from, to): (&[f64], &[f64])| {
            // The largest change at any node below, or more.
            let change = weighted_change(from, to, &self.peaks);
            let bounds = [known.before[0] - change, known.before[1] + change];
            // Written so that NaN is not taken for known.
            let clear = change <= known.slight && bounds[0] >= known.allowed[0] && bounds[1] <= known.allowed[1];
            joined(range, if clear { bounds } else { self.extremes_of_row(to) })
        };
        pairs.fold(EMPTY, bounds)
    }

    /// Lowest and highest value below one surface node, some nodes at a time: their sums stay in registers.
    fn extremes_of_row(&self, row: &[f64]) -> [f64; 2] {
        let size = self.len();
        let (mut range, mut first) = (EMPTY, 0);
        while first + BLOCK <= size {
            let mut sums = [0.0; BLOCK];
            for ((x, shape), &reach) in row.iter().zip(self.shapes.chunks_exact(size)).zip(&self.reach) {
                if reach > first {
                    let shape = &shape[first..first + BLOCK];
                    (0..BLOCK).for_each(|k| sums[k] += x * shape[k]);
                }
            }
            range = sums.iter().fold(range, |range, &value| joined(range, [value; 2]));
            first += BLOCK;
        }
        for node in first..size {
            let value = dot(row, &self.to_nodes[node * self.modes..][..self.modes]);
            range = joined(range, [value; 2]);
        }
        range
    }
}

/// Knowledge of a field before it is searched.
pub struct Known {
    /// Bounds before the step.
    pub before: [f64; 2],
    /// Bounds within which the exact values do not matter.
    pub allowed: [f64; 2],
    /// Largest change that may widen the bounds \[K].
    pub slight: f64,
}

/// Nodes whose values are summed at a time.
const BLOCK: usize = 8;

/// Bounds of no values.
const EMPTY: [f64; 2] = [f64::INFINITY, f64::NEG_INFINITY];

/// Bounds of two sets of values. Comparisons, not `min` and `max`: each compiles to one instruction.
fn joined(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [if b[0] < a[0] { b[0] } else { a[0] }, if b[1] > a[1] { b[1] } else { a[1] }]
}
