//! Temperatures at the nodes across the streamlines, where bounds and melting act, and the way back to the modes.

use super::depth_modes::DepthModes;
use super::modal::dot;
use crate::heat::error::HeatError;
use nalgebra::DMatrix;

/// Both ways between coefficients of modes and values at the nodes across the streamlines.
#[derive(Clone, Debug)]
pub(super) struct Nodal {
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
    /// How far into the depth a mode counts: the steep ones live in the thin layers at the surface only.
    reach: Vec<usize>,
    /// Largest value of every mode at a node.
    peaks: Vec<f64>,
}

/// Value of a mode relative to its largest one below which it does not count where a field is searched for its extremes.
const NEGLIGIBLE: f64 = 1e-9;

impl Nodal {
    /// For the nodes of `modes` that are not held.
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

    /// `∫ g · dz` of what is given at the nodes below one surface node.
    pub fn integral(&self, values: &[f64]) -> f64 {
        values.iter().zip(&self.weights).map(|(v, w)| v * w).sum()
    }

    /// Weights of the nodes in a sum whose weights for the modes are `weights`.
    pub fn weights_of(&self, weights: &[f64]) -> Vec<f64> {
        self.to_modes.chunks_exact(self.modes).map(|column| dot(column, weights)).collect()
    }

    /// Lowest and highest value of a field at its nodes; `values` is work space.
    pub fn extremes(&self, field: &[f64], values: &mut Vec<f64>) -> [f64; 2] {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        values.resize(self.len(), 0.0);
        for row in field.chunks_exact(self.modes) {
            values.fill(0.0);
            for ((x, shape), &reach) in row.iter().zip(self.shapes.chunks_exact(self.len())).zip(&self.reach) {
                values[..reach].iter_mut().zip(&shape[..reach]).for_each(|(v, s)| *v += x * s);
            }
            for &value in &*values {
                // Comparisons, not `min` and `max`: each compiles to one instruction.
                low = if value < low { value } else { low };
                high = if value > high { value } else { high };
            }
        }
        [low, high]
    }

    /// Largest change at any node between two fields, or more.
    pub fn largest_change(&self, from: &[f64], to: &[f64]) -> f64 {
        let rows = from.chunks_exact(self.modes).zip(to.chunks_exact(self.modes));
        rows.fold(0.0, |largest, (from, to)| {
            let mut sums = [0.0; 4];
            let lanes = from.chunks_exact(4).zip(to.chunks_exact(4)).zip(self.peaks.chunks_exact(4));
            for ((a, b), peak) in lanes {
                (0..4).for_each(|l| sums[l] += (b[l] - a[l]).abs() * peak[l]);
            }
            let change = sums.iter().sum();
            if change > largest { change } else { largest }
        })
    }
}
