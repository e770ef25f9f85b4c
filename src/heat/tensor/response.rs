//! Surface temperatures under unit loads on the surface, from the factors of an implicit stage.

use super::modal::HeatBody;
use super::rows;
use super::tridiagonal::TridiagonalFactor;
use crate::linalg::{Update, multiply_transposed};
use std::ops::Range;

/// Surface temperatures at some neighbouring nodes under unit loads at the same nodes.
///
/// Entries of the inverse of a tridiagonal matrix follow from its factors, `X_jj = 1/d_j + r_j w_{j+1} X_{j+1,j+1}`,
/// `X_ij = −w_{j+1} X_{i,j+1}` for `j < i`, `X_ij = −r_i X_{i+1,j}` for `i < j` (Takahashi, Fagan & Chin 1973). Between nodes
/// on both sides of a node `t` they are products of what decays on the way to `t` and from there on, so that the sums over
/// the modes are products of matrices.
#[derive(Clone, Debug, Default)]
pub(super) struct SurfaceResponse {
    /// The temperatures, row-major.
    matrix: Vec<f64>,
    /// Number of nodes.
    count: usize,
    /// Diagonal of the inverse times `φₘ(0)²`, mode by mode, at the nodes.
    diagonal: Vec<f64>,
    /// What a load at the nodes before `t` does there, and what a load at `t` does at the nodes from there on.
    before: Vec<f64>,
    after: Vec<f64>,
    /// One number per mode that a recurrence carries along.
    moving: Vec<f64>,
}

/// Largest number of nodes between which the temperatures are computed pair by pair.
const PAIRS: usize = 8;

/// Influence relative to that of a node on itself that is left out.
const NEGLIGIBLE: f64 = 1e-18;

impl SurfaceResponse {
    /// Temperatures at the node `i` of the range under unit loads at all of them.
    pub fn row(&self, i: usize) -> &[f64] {
        &self.matrix[i * self.count..(i + 1) * self.count]
    }

    /// Fills the response of the nodes `range` of `body`, whose factors are given.
    pub fn set(&mut self, factor: &TridiagonalFactor, body: &HeatBody, range: Range<usize>) {
        let nm = body.modes.len();
        self.count = range.len();
        self.matrix.clear();
        self.matrix.resize(self.count * self.count, 0.0);
        self.set_diagonal(factor, body, &range);
        if self.count > 0 {
            // An influence decays from a node to one before it by the factors of the latter's row, and the other way round.
            let (first, last) = (range.start * nm, (range.end - 1) * nm);
            self.fill(&factor.w[first + nm..last + nm], nm, 0..self.count, Triangle::Lower);
            self.fill(&factor.r[first..last], nm, 0..self.count, Triangle::Upper);
        }
        if body.line.closed > 0.0 {
            self.add_round_trip(factor, body, &range);
        }
    }

    /// Diagonal of the inverse of the chain at the nodes `range`, weighted with `φₘ(0)²`.
    fn set_diagonal(&mut self, factor: &TridiagonalFactor, body: &HeatBody, range: &Range<usize>) {
        let nm = body.modes.len();
        let n = body.line.len() - usize::from(body.line.closed > 0.0);
        self.diagonal.clear();
        self.diagonal.resize(range.len() * nm, 0.0);
        self.moving.clear();
        self.moving.resize(nm, 0.0);
        for i in (range.start..n).rev() {
            let (inverse, moving) = (&factor.inverse[i * nm..][..nm], &mut self.moving[..nm]);
            if i + 1 < n {
                let (r, w) = (&factor.r[i * nm..][..nm], &factor.w[(i + 1) * nm..][..nm]);
                for m in 0..nm {
                    moving[m] = inverse[m] + r[m] * w[m] * moving[m];
                }
            } else {
                moving.copy_from_slice(inverse);
            }
            if i < range.end {
                self.diagonal[(i - range.start) * nm..][..nm].copy_from_slice(&self.moving);
            }
        }
        for row in self.diagonal.chunks_exact_mut(nm) {
            row.iter_mut().zip(&body.modes.surface).for_each(|(x, s)| *x *= s * s);
        }
    }

    /// Fills one triangle of the block of the nodes `nodes`; row `i` of `links` tells how an influence decays between the nodes
    /// `i` and `i + 1`.
    fn fill(&mut self, links: &[f64], nm: usize, nodes: Range<usize>, triangle: Triangle) {
        let Range { start, end } = nodes;
        if nodes.len() <= PAIRS {
            let strides = if triangle == Triangle::Lower { [self.count, 1] } else { [1, self.count] };
            let out = &mut self.matrix[start * (self.count + 1)..];
            let scales = &self.diagonal[start * nm..end * nm];
            return rows::decay_pairs(&links[start * nm..], scales, &mut self.moving, strides, out);
        }
        let middle = start + nodes.len() / 2;
        self.before.resize((middle - start) * nm, 0.0);
        self.after.resize((end - middle) * nm, 0.0);
        rows::decay_towards(&links[start * nm..], &mut self.before, nm);
        rows::decay_from(&links[middle * nm..], &self.diagonal[middle * nm..], &mut self.after, &mut self.moving);
        let (first, second, at) = match triangle {
            Triangle::Lower => (&self.after, &self.before, middle * self.count + start),
            Triangle::Upper => (&self.before, &self.after, start * self.count + middle),
        };
        multiply_transposed(first, second, nm, &mut self.matrix[at..], self.count, Update::Replace);
        self.fill(links, nm, start..middle, triangle);
        self.fill(links, nm, middle..end, triangle);
    }

    /// Adds the influence that goes once around the wheel to the response at the nodes `range`.
    fn add_round_trip(&mut self, factor: &TridiagonalFactor, body: &HeatBody, range: &Range<usize>) {
        let (nm, inner) = (body.modes.len(), range.start * body.modes.len()..range.end * body.modes.len());
        let (row, column) = (&factor.row[inner.clone()], &factor.column[inner]);
        self.after.clear();
        for column in column.chunks_exact(nm) {
            let scales = factor.border[2].iter().zip(&body.modes.surface);
            self.after.extend(column.iter().zip(scales).map(|(c, (pivot, s))| c * pivot * s * s));
        }
        let smallest = (0..self.count).map(|i| self.matrix[i * self.count + i]).fold(f64::INFINITY, f64::min);
        if largest(&self.after) * largest(row) > NEGLIGIBLE * smallest {
            multiply_transposed(&self.after, row, nm, &mut self.matrix, self.count, Update::Add);
        }
    }
}

/// One of the two triangles of a matrix.
#[derive(Clone, Copy, PartialEq)]
enum Triangle {
    Lower,
    Upper,
}

/// Largest magnitude in a vector whose length is a multiple of four.
fn largest(x: &[f64]) -> f64 {
    let mut lanes = [0.0_f64; 4];
    for x in x.chunks_exact(4) {
        for l in 0..4 {
            // A comparison, not `max`: compiles to one instruction.
            lanes[l] = if x[l].abs() > lanes[l] { x[l].abs() } else { lanes[l] };
        }
    }
    lanes.into_iter().fold(0.0, f64::max)
}
