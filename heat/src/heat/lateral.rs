//! Heat that spreads sideways from line to line.
//!
//! Conduction across the width, `α ∂²T/∂y²`, is the same at all depths and places, so that it commutes with conduction
//! and stream in the planes of the lines. A step of all lines and a mixing of their fields, the same matrix at every
//! place, are therefore a splitting of the three-dimensional equation whose error comes from the sources alone: heat
//! that has entered since the last mixing has not spread yet (`docs/theory/heat.md`, section 9).

use super::error::HeatError;
use super::state::{HeatState, RowBounds};
use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

/// Cells across the width of the bodies, from one side to the other or from the plane of symmetry outwards: one for
/// each line and, beside the contact, for the rest of tread and rail head. Nothing passes the two outer faces.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct LateralCells {
    /// Faces \[m], ascending, one more than cells; gaps between cells do not count.
    faces: Vec<f64>,
    /// Places of the temperatures \[m], gaps counted.
    places: Vec<f64>,
}

impl LateralCells {
    /// Cells side by side of the given widths \[m].
    pub fn side_by_side(widths: &[f64]) -> Result<Self, HeatError> {
        let unusable = widths.iter().find(|width| !(**width > 0.0 && width.is_finite()));
        if let Some(&value) = unusable {
            return Err(HeatError::Input { name: "width of a line", value });
        }
        let mut faces = vec![0.0];
        faces.extend(widths.iter().scan(0.0, |end, width| {
            *end += width;
            Some(*end)
        }));
        let places = faces.windows(2).map(|ends| 0.5 * (ends[0] + ends[1])).collect();
        Ok(Self { faces, places })
    }

    /// Cells of one half of a symmetric contact, from its middle outwards: the first line lies in the middle and has
    /// the first of the `lines`' widths \[m] in both halves together; beyond the lines, the cells of the `rest`.
    pub fn half(lines: &[f64], rest: &[f64]) -> Result<Self, HeatError> {
        let mut widths: Vec<f64> = lines.iter().chain(rest).copied().collect();
        if let Some(middle) = widths.first_mut() {
            *middle *= 0.5;
        }
        let mut cells = Self::side_by_side(&widths)?;
        if let Some(middle) = cells.places.first_mut() {
            *middle = 0.0;
        }
        Ok(cells)
    }

    /// Cells with free widths `gaps` \[m] before them, which heat crosses and which keep none; missing ones are
    /// zero.
    pub fn apart(mut self, gaps: &[f64]) -> Self {
        let mut shift = 0.0;
        for (place, gap) in self.places.iter_mut().zip(gaps) {
            shift += gap;
            *place += shift;
        }
        self
    }

    /// Number of cells.
    pub fn len(&self) -> usize {
        self.places.len()
    }

    /// True without cells.
    pub fn is_empty(&self) -> bool {
        self.places.is_empty()
    }

    /// Width of a cell \[m], of the part that is modelled.
    pub fn width(&self, cell: usize) -> f64 {
        self.faces[cell + 1] - self.faces[cell]
    }

    /// Time \[s] in which heat of the diffusivity `diffusivity` [m²/s] spreads by the share `share` \[1] of the
    /// smallest distance of two cells, `share · d²/α`; infinite for a single cell.
    pub fn spreading_time(&self, diffusivity: f64, share: f64) -> f64 {
        let nearest = self.places.windows(2).map(|ends| ends[1] - ends[0]).fold(f64::INFINITY, f64::min);
        share * nearest * nearest / diffusivity
    }

    /// Mixing by conduction for `time` \[s] with the diffusivity `diffusivity` [m²/s]: finite volumes across the width,
    /// exact in time.
    ///
    /// With the widths `W` and the conductances `1/d` of the faces between cells at the distances d, `W Ṫ = −α G T`.
    /// The exponential of a matrix whose rows sum to zero and whose entries beside the diagonal are positive is a mean
    /// of the temperatures with weights of at least zero, and keeps `Σ W T`.
    pub fn conduction(&self, diffusivity: f64, time: f64) -> LateralMixing {
        let n = self.len();
        let mut matrix: DMatrix<f64> = DMatrix::zeros(n, n);
        for (i, ends) in self.places.windows(2).enumerate() {
            let conductance = 1.0 / (ends[1] - ends[0]);
            for (row, column, sign) in [(i, i, 1.0), (i + 1, i + 1, 1.0), (i, i + 1, -1.0), (i + 1, i, -1.0)] {
                matrix[(row, column)] += sign * conductance / (self.width(row) * self.width(column)).sqrt();
            }
        }
        let eigen = matrix.symmetric_eigen();
        let decayed = eigen.eigenvalues.map(|value| libm::exp(-diffusivity * time * value.max(0.0)));
        let shares = &eigen.eigenvectors * DMatrix::from_diagonal(&decayed) * eigen.eigenvectors.transpose();
        let scaled = |i: usize, j: usize| (shares[(i, j)] * (self.width(j) / self.width(i)).sqrt()).max(0.0);
        LateralMixing { shares: DMatrix::from_fn(n, n, scaled) }
    }

    /// Mixing where the faces have moved from `before` to where they are, while the material stayed: each cell takes
    /// the mean of what it covers now. The heat is kept, if the outer faces have not moved.
    pub fn moved_from(&self, before: &Self) -> LateralMixing {
        let overlap = |i: usize, j: usize| {
            let low = self.faces[i].max(before.faces[j]);
            let high = self.faces[i + 1].min(before.faces[j + 1]);
            (high - low).max(0.0) / self.width(i)
        };
        LateralMixing { shares: DMatrix::from_fn(self.len(), before.len(), overlap) }
    }
}

/// Means of the fields of several cells, the same at all places.
#[derive(Clone, Debug, PartialEq)]
pub struct LateralMixing {
    /// Share of the second cell in the first one after mixing; rows sum to one.
    shares: DMatrix<f64>,
}

/// Values of a field that are mixed at a time.
const BLOCK: usize = 256;

impl LateralMixing {
    /// Share of the cell `from` before in the cell `to` after mixing \[1].
    pub fn share(&self, to: usize, from: usize) -> f64 {
        self.shares[(to, from)]
    }

    /// Both mixings, `first` before this one.
    pub fn after(&self, first: &Self) -> Self {
        Self { shares: &self.shares * &first.shares }
    }

    /// Mixes the states of all cells, which belong to one heat model, with all that a state knows about its field: its
    /// bounds, which a mean keeps, and its sums. Where steel melts, heat contents are mixed as if they were
    /// temperatures.
    ///
    /// Fails if the number of states is not that of the cells, or their sizes differ.
    pub fn apply(&self, states: &mut [&mut HeatState]) -> Result<(), HeatError> {
        let size = states.first().map_or(0, |state| state.values.len());
        let fits = states.len() == self.shares.nrows() && states.len() == self.shares.ncols();
        if let Some(other) = states.iter().find(|state| !fits || state.values.len() != size) {
            return Err(HeatError::StateSize { expected: size, found: other.values.len() });
        }
        self.mix_values(states, |state| &mut state.values);
        for body in 0..2 {
            if states.iter().all(|state| !state.sums[body].is_empty()) {
                self.mix_values(states, |state| &mut state.sums[body]);
            } else {
                states.iter_mut().for_each(|state| state.sums[body].clear());
            }
        }
        self.mix_bounds(states);
        Ok(())
    }

    /// Mixes numbers of all states that have the same place.
    fn mix_values(&self, states: &mut [&mut HeatState], of: impl Fn(&mut HeatState) -> &mut Vec<f64>) {
        let (n, size) = (states.len(), states.first_mut().map_or(0, |state| of(state).len()));
        let mut before = vec![0.0; n * BLOCK];
        for first in (0..size).step_by(BLOCK) {
            let places = first..(first + BLOCK).min(size);
            for (before, state) in before.chunks_exact_mut(BLOCK).zip(&mut *states) {
                before[..places.len()].copy_from_slice(&of(state)[places.clone()]);
            }
            for (i, state) in states.iter_mut().enumerate() {
                let out = &mut of(state)[places.clone()];
                out.fill(0.0);
                for (j, before) in before.chunks_exact(BLOCK).enumerate() {
                    let share = self.share(i, j);
                    out.iter_mut().zip(before).for_each(|(out, value)| *out += share * value);
                }
            }
        }
    }

    /// Mixes the bounds that fields keep, and the data: the mean of fields that stay within the margin of theirs stays
    /// within the margin of their mean.
    fn mix_bounds(&self, states: &mut [&mut HeatState]) {
        let count = states.first().map_or(0, |state| state.rows.len());
        if states.iter().any(|state| state.rows.len() != count) {
            states.iter_mut().for_each(|state| state.rows.clear());
        }
        let known: Vec<Vec<RowBounds>> = states.iter().map(|state| state.rows.clone()).collect();
        let ranges: Vec<[f64; 2]> = states.iter().map(|state| state.range).collect();
        let data: Vec<[f64; 2]> = states.iter().map(|state| state.data).collect();
        for (i, state) in states.iter_mut().enumerate() {
            for (place, row) in state.rows.iter_mut().enumerate() {
                let mut mean = RowBounds { found: [0.0; 2], moved: 0.0 };
                for (j, rows) in known.iter().enumerate().filter(|(j, _)| self.share(i, *j) > 0.0) {
                    let (share, row) = (self.share(i, j), rows[place]);
                    (0..2).for_each(|end| mean.found[end] += share * row.found[end]);
                    mean.moved += share * row.moved;
                }
                *row = mean;
            }
            let mixed = |of: &[[f64; 2]]| {
                let shares = (0..of.len()).map(|j| self.share(i, j)).enumerate().filter(|(_, share)| *share > 0.0);
                shares.fold([0.0; 2], |mean, (j, share)| [0, 1].map(|end| mean[end] + share * of[j][end]))
            };
            (state.range, state.data) = (mixed(&ranges), mixed(&data));
        }
    }
}

/// How long the lines of a state have been without exchange: plain data, to be kept with the states of the lines.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct LateralHistory {
    /// Time since the last mixing \[s].
    pub waited: f64,
    /// Cells at the last mixing; without any, none was yet.
    pub cells: LateralCells,
}

/// Share of the square of a cell's distance that heat spreads between two mixings \[1]; what that costs is in
/// `docs/theory/heat.md`, section 9.
pub const MIXED_AT: f64 = 0.25;

/// Change of a temperature by a mixing that contact and friction feel as a jump \[K].
const FELT: f64 = 1.0;

/// Share of its width by which a face moves until fields are mixed \[1].
const MOVED_AT: f64 = 0.02;

impl LateralHistory {
    /// Follows a step of `dt` \[s] of all cells, at whose end they are `cells` and their highest temperatures up to `apart`
    /// \[K] apart: the mixing that is due, `None` while there is time.
    ///
    /// The mixing follows from states and steps alone. Callers apply it to the states of all cells at the end of the
    /// step, before these are observed.
    pub fn advance(&mut self, dt: f64, cells: &LateralCells, apart: f64, diffusivity: f64) -> Option<LateralMixing> {
        if self.cells.len() != cells.len() {
            self.cells = cells.clone();
            self.waited = 0.0;
        }
        self.waited += dt;
        let faces = self.cells.faces.iter().zip(&cells.faces).enumerate();
        let moved = faces.fold(0.0_f64, |most, (i, (before, now))| {
            let width = cells.width(i.min(cells.len().saturating_sub(1)));
            most.max((now - before).abs() / width)
        });
        let share = if apart * MIXED_AT > FELT { FELT / apart } else { MIXED_AT };
        if self.waited < cells.spreading_time(diffusivity, share) && moved < MOVED_AT {
            return None;
        }
        let conduction = cells.conduction(diffusivity, self.waited);
        let mixing = if moved > 0.0 { conduction.after(&cells.moved_from(&self.cells)) } else { conduction };
        self.waited = 0.0;
        self.cells.clone_from(cells);
        Some(mixing)
    }
}
