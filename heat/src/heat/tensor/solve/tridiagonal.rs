//! Factors of the tridiagonal systems of one implicit step, one system per mode across the streamlines.

use super::coefficients::StageCoefficients;
use super::passes::{self, Operator};
use super::ring::{Carried, Ring, factorise, factorise_filled};
use super::transport::Transport;
use crate::heat::error::HeatError;
use crate::heat::tensor::mesh::body::HeatBody;
use crate::linalg::Update;
use std::ops::Range;

/// Factors of the tridiagonal systems of all modes.
///
/// Nodes are eliminated around the ring of the streamline: the first one after the contact comes first, the last one of
/// the contact comes last. An open streamline is a ring with an empty link. So the surface under the contact is known
/// before anything else is substituted back, and a load there is eliminated within the contact alone. The link of the
/// last node with the first one fills a column and a row of the factors,
/// `S = (1 + w + row)(1/inverse)(1 + r) + column`; both fade within some nodes where the stream is faster than
/// conduction.
#[derive(Clone, Debug, Default)]
pub struct TridiagonalFactor {
    /// Factors by which a node acts on the next one in the order of elimination and that one on it, and the inverse
    /// pivots; by nodes.
    pub w: Vec<f64>,
    pub r: Vec<f64>,
    pub inverse: Vec<f64>,
    /// Entries in the column and the row of the last node, by steps of the elimination, as far as they reach.
    pub column: Vec<f64>,
    pub row: Vec<f64>,
    /// The node that is eliminated last.
    last: usize,
    alpha: Vec<f64>,
    carried: Carried,
    /// Solution at the last node.
    moving: Vec<f64>,
}

/// Steps of the elimination that are taken at a time while the row and the column of the last node are filled.
const STRIDE: usize = 8;

impl TridiagonalFactor {
    /// Factorises `S` for all modes; the nodes `contact` are eliminated last.
    pub fn set(
        &mut self,
        body: &HeatBody,
        transport: &Transport,
        coefficients: StageCoefficients,
        contact: &Range<usize>,
    ) -> Result<(), HeatError> {
        let (nm, n) = (body.modes.len(), body.streamline.len());
        let [storage, flow] = coefficients.mass_weight(body);
        self.last = if contact.is_empty() { n - 1 } else { contact.end - 1 };
        self.alpha.clear();
        self.alpha.extend(body.modes.values.iter().map(|value| storage + flow * value));
        for values in [&mut self.w, &mut self.r, &mut self.inverse] {
            values.resize(n * nm, 0.0);
        }
        self.carried.begin(nm);
        for fill in [&mut self.column, &mut self.row] {
            fill.clear();
            fill.reserve(n * nm);
        }
        let ring = Ring { transport, alpha: &self.alpha, flow: coefficients.flow, last: self.last };
        let (mut step, filled) = (0, n - 2);
        while self.carried.alive && step < filled {
            let steps = step..(step + STRIDE).min(filled);
            let rows = step * nm..steps.end * nm;
            step = steps.end;
            self.column.resize(rows.end, 0.0);
            self.row.resize(rows.end, 0.0);
            let fill = [&mut self.column[rows.clone()], &mut self.row[rows]];
            let factors = [&mut self.w[..], &mut self.r, &mut self.inverse];
            factorise_filled(&ring, steps, factors, fill, &mut self.carried);
        }
        if step + contact.len() > n {
            // It reaches the contact: either all of that has an entry, or nothing.
            self.column.resize(filled * nm, 0.0);
            self.row.resize(filled * nm, 0.0);
        }
        let factors = [&mut self.w[..], &mut self.r, &mut self.inverse];
        factorise(&ring, step..n, factors, &mut self.carried);
        let check = self.inverse[self.last * nm..][..nm].iter().sum::<f64>();
        if check.is_finite() { Ok(()) } else { Err(HeatError::Singular { unknowns: body.size() }) }
    }

    /// Rows of the column and the row of the last node at the nodes `contact`; none where these have faded before.
    pub fn fill(&self, contact: &Range<usize>, nm: usize) -> [&[f64]; 2] {
        [&self.column, &self.row].map(|filled| reaching(filled, self.inverse.len() - contact.len() * nm))
    }

    /// `x ← S⁻¹ x`.
    #[cfg(test)]
    pub fn solve(&mut self, body: &HeatBody, x: &mut [f64]) {
        self.eliminate(body, x);
        self.substitute(body, x);
    }

    /// The first half of a solution, `x ← (1 + w + row)⁻¹ x`.
    pub fn eliminate(&mut self, body: &HeatBody, x: &mut [f64]) {
        passes::eliminate(self.last, &self.w, x, body.modes.len());
        self.take_filled(body, x);
    }

    /// The first half of a solution for the product of a matrix with the field `x` and the surface `loads` of all nodes
    /// of `body`; what `out` holds is replaced, or a load, too.
    pub fn load(
        &mut self,
        body: &HeatBody,
        operator: &Operator,
        loads: &[f64],
        x: &[f64],
        out: &mut [f64],
        update: Update,
    ) {
        passes::load(update == Update::Add, operator, self.last, [&self.w, loads], x, out);
        self.take_filled(body, out);
    }

    /// Takes the part of the filled row from the last node.
    fn take_filled(&mut self, body: &HeatBody, x: &mut [f64]) {
        let (nm, end) = (body.modes.len(), self.last * body.modes.len());
        let (before, rest) = x.split_at_mut(end);
        let (last, after) = rest.split_at_mut(nm);
        let (of_after, of_before) = self.row.split_at(self.row.len().min(after.len()));
        passes::take(of_after, after, last);
        passes::take(of_before, before, last);
    }

    /// The second half of a solution.
    pub fn substitute(&mut self, body: &HeatBody, x: &mut [f64]) {
        let (nm, end) = (body.modes.len(), self.last * body.modes.len());
        let (before, rest) = x.split_at_mut(end);
        let (last, after) = rest.split_at_mut(nm);
        self.moving.clear();
        self.moving.extend(last.iter().zip(&self.inverse[end..]).map(|(x, d)| x * d));
        let (of_after, of_before) = self.column.split_at(self.column.len().min(after.len()));
        passes::leave(of_after, &self.moving, after);
        passes::leave(of_before, &self.moving, before);
        passes::substitute([&self.inverse, &self.r], x, nm, self.last);
    }

    /// Surface values of the solution at the nodes `contact`, after [`Self::eliminate`]; they end with the node that
    /// was eliminated last, or before it.
    pub fn surface(&self, body: &HeatBody, contact: &Range<usize>, x: &[f64], out: &mut Vec<f64>) {
        let nm = body.modes.len();
        let rows = contact.start * nm..(self.last + 1) * nm;
        let column = reaching(&self.column, self.inverse.len() - rows.len());
        let factors = [&self.inverse[rows.clone()], &self.r[rows.clone()], column];
        out.resize(rows.len() / nm, 0.0);
        passes::surface(factors, &x[rows], &body.modes.surface, out);
        out.truncate(contact.len());
    }

    /// Adds a load on the surface at the nodes from `first` on after [`Self::eliminate`]; where it ends before the node
    /// that was eliminated last, it is filled up with zeros.
    pub fn add_load(&self, body: &HeatBody, first: usize, load: &mut Vec<f64>, x: &mut [f64]) {
        let nm = body.modes.len();
        let rows = first * nm..(self.last + 1) * nm;
        load.resize(rows.len() / nm, 0.0);
        let factors = [&self.w[rows.clone()], reaching(&self.row, self.inverse.len() - rows.len())];
        passes::add_load(factors, load, &body.modes.surface, &mut x[rows]);
    }
}

/// Part of a filled column or row from the place `first` on; nothing if it has faded before.
fn reaching(filled: &[f64], first: usize) -> &[f64] {
    filled.get(first..).unwrap_or_default()
}
