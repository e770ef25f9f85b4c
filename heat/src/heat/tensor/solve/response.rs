//! Surface temperatures under unit loads on the surface, from the factors of an implicit stage.

use super::decay;
use super::tridiagonal::TridiagonalFactor;
use crate::heat::tensor::mesh::body::HeatBody;
use crate::linalg::{Update, multiply_transposed};
use std::ops::Range;

/// Influence matrix: surface temperatures at some neighbouring nodes under unit loads at the same nodes.
///
/// Entries of the inverse of a tridiagonal matrix follow from its factors, `X_jj = 1/d_j + r_j w_{j+1} X_{j+1,j+1}`,
/// `X_ij = −w_{j+1} X_{i,j+1}` for `j < i`, `X_ij = −r_i X_{i+1,j}` for `i < j` (Takahashi, Fagan & Chin 1973). Between
/// nodes on both sides of a node `t` they are products of the decay on the way to `t` and of that from there on, so
/// that the sums over the modes are products of matrices.
#[derive(Clone, Debug, Default)]
pub struct SurfaceInfluence {
    /// The temperatures, row-major.
    matrix: Vec<f64>,
    /// Number of nodes.
    count: usize,
    /// Diagonal of the inverse times `φₘ(0)²`, mode by mode, at the nodes.
    diagonal: Vec<f64>,
    /// Influence of a load at the nodes before `t` on that node, and of a load at `t` on the nodes from there on.
    before: Vec<f64>,
    after: Vec<f64>,
    /// Buffer of one number per mode, which a recurrence carries along.
    moving: Vec<f64>,
}

/// Largest number of nodes between which the temperatures are computed pair by pair.
const PAIRS: usize = 8;

impl SurfaceInfluence {
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
            // An influence decays from a node to one before it by the factors of the latter's row, and the other way
            // round.
            let (first, last) = (range.start * nm, (range.end - 1) * nm);
            self.fill(&factor.w[first + nm..last + nm], nm, 0..self.count, Triangle::Lower);
            self.fill(&factor.r[first..last], nm, 0..self.count, Triangle::Upper);
        }
        self.add_round_trip(factor, body, &range);
    }

    /// Diagonal of the inverse at the nodes `range`, of which the last one is eliminated last, weighted with `φₘ(0)²`;
    /// without the part that goes around the ring, which includes all of the last node if there is any.
    fn set_diagonal(&mut self, factor: &TridiagonalFactor, body: &HeatBody, range: &Range<usize>) {
        let nm = body.modes.len();
        let around = !factor.fill(range, nm)[0].is_empty();
        self.diagonal.resize(range.len() * nm, 0.0);
        self.moving.clear();
        self.moving.resize(nm, 0.0);
        for i in range.clone().rev() {
            let (inverse, moving) = (&factor.inverse[i * nm..][..nm], &mut self.moving[..nm]);
            if i + 1 < range.end {
                let (r, w) = (&factor.r[i * nm..][..nm], &factor.w[(i + 1) * nm..][..nm]);
                for m in 0..nm {
                    moving[m] = inverse[m] + r[m] * w[m] * moving[m];
                }
            } else if !around {
                moving.copy_from_slice(inverse);
            }
            let diagonal = &mut self.diagonal[(i - range.start) * nm..][..nm];
            for ((diagonal, x), s) in diagonal.iter_mut().zip(&*moving).zip(&body.modes.surface) {
                *diagonal = x * s * s;
            }
        }
    }

    /// Fills one triangle of the block of the nodes `nodes`; row `i` of `links` tells how an influence decays between
    /// the nodes `i` and `i + 1`.
    fn fill(&mut self, links: &[f64], nm: usize, nodes: Range<usize>, triangle: Triangle) {
        let Range { start, end } = nodes;
        if nodes.len() <= PAIRS {
            let strides = match triangle {
                Triangle::Lower => [self.count, 1],
                Triangle::Upper => [1, self.count],
            };
            let out = &mut self.matrix[start * (self.count + 1)..];
            let scales = &self.diagonal[start * nm..end * nm];
            return decay::decay_pairs(&links[start * nm..], scales, &mut self.moving, strides, out);
        }
        let middle = start + nodes.len() / 2;
        self.before.resize((middle - start) * nm, 0.0);
        self.after.resize((end - middle) * nm, 0.0);
        // Beyond some nodes hardly anything is left upstream.
        let first = decay::decay_towards(&links[start * nm..], &mut self.before, nm);
        let scales = &self.diagonal[middle * nm..];
        let count = decay::decay_from(&links[middle * nm..], scales, &mut self.after, &mut self.moving);
        let (before, after) = (&self.before[first * nm..], &self.after[..count * nm]);
        let (rows, columns, at) = match triangle {
            Triangle::Lower => (after, before, middle * self.count + start + first),
            Triangle::Upper => (before, after, (start + first) * self.count + middle),
        };
        multiply_transposed(rows, columns, nm, &mut self.matrix[at..], self.count, Update::Replace);
        self.fill(links, nm, start..middle, triangle);
        self.fill(links, nm, middle..end, triangle);
    }

    /// Adds the part that runs through the last node to the response at the nodes `range`, if the ring is closed for
    /// some modes.
    fn add_round_trip(&mut self, factor: &TridiagonalFactor, body: &HeatBody, range: &Range<usize>) {
        let nm = body.modes.len();
        let [column, row] = factor.fill(range, nm);
        if column.is_empty() {
            return;
        }
        // Influence of the last node on the others, and of these on it: both substitutions for a unit there.
        let (count, first) = (self.count, range.start * nm);
        self.before.clear();
        self.before.resize(count * nm, 1.0);
        self.after.clear();
        self.after.resize(count * nm, 1.0);
        let last = (count - 1) * nm;
        for j in (0..last).rev() {
            let filled = column.get(j).map_or(0.0, |c| c * factor.inverse[first + j]);
            self.after[j] = -factor.r[first + j] * self.after[j + nm] - filled;
            self.before[j] = -factor.w[first + j + nm] * self.before[j + nm] - row.get(j).copied().unwrap_or(0.0);
        }
        let pivots = &factor.inverse[first + last..];
        for after in self.after.chunks_exact_mut(nm) {
            let scales = pivots.iter().zip(&body.modes.surface);
            after.iter_mut().zip(scales).for_each(|(after, (pivot, s))| *after *= pivot * s * s);
        }
        multiply_transposed(&self.after, &self.before, nm, &mut self.matrix, count, Update::Add);
    }
}

/// Triangle of a matrix.
#[derive(Clone, Copy)]
enum Triangle {
    Lower,
    Upper,
}
