//! Matrix of one implicit stage in one body, as a weighted sum of storage and flow.
//!
//! With the fields written in the modes across the streamlines, an implicit step is one tridiagonal system per mode,
//!
//! ```text
//! [μ ρc M̃ + β (k λₘ M̃ + F)] xₘ = bₘ ,
//! ```
//!
//! cyclic in the wheel.

use super::passes::{self, Operator};
use super::transport::Transport;
use crate::heat::tensor::mesh::body::HeatBody;
use crate::linalg::Update;

/// Weights of storage and flow in the matrix of a stage: `S = μ ρc M̃ + β A`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StageCoefficients {
    /// `μ` [1].
    pub storage: f64,
    /// `β` [s]; 1 in the stationary state.
    pub flow: f64,
}

impl StageCoefficients {
    /// `a` and `b` in the weight `a + b λ` of the mass of a mode with the eigenvalue λ.
    pub fn mass_weight(&self, body: &HeatBody) -> [f64; 2] {
        [self.storage * body.heat_capacity, self.flow * body.conductivity]
    }

    /// The matrix of the modal solver.
    pub fn operator<'a>(&self, body: &'a HeatBody, transport: &'a Transport) -> Operator<'a> {
        let [storage, conduction] = self.mass_weight(body);
        Operator { body, transport, weights: [storage, conduction, self.flow] }
    }

    /// `out ← S x` with the operator of the modal solver, or `out ← out + S x`.
    pub fn multiply(&self, body: &HeatBody, transport: &Transport, x: &[f64], out: &mut [f64], update: Update) {
        let (last, nothing) = (body.streamline.len() - 1, &body.nothing[..]);
        passes::load(update == Update::Add, &self.operator(body, transport), last, [nothing; 2], x, out);
    }

    /// `out ← out + β k K ⊗ ∫(1/g − g)NN x`: the part of the conduction along the streamlines that the modal solver
    /// leaves out. `work` has the length of a field.
    pub fn add_curvature(&self, body: &HeatBody, x: &[f64], out: &mut [f64], work: &mut Vec<f64>) {
        if body.modes.curvature.is_empty() {
            return;
        }
        let nm = body.modes.len();
        work.clear();
        work.resize(body.size(), 0.0);
        for (e, h) in body.streamline.lengths.iter().enumerate() {
            let (a, b) = (e * nm, body.streamline.after(e) * nm);
            for m in 0..nm {
                let flux = self.flow * body.conductivity / h * (x[a + m] - x[b + m]);
                work[a + m] += flux;
                work[b + m] -= flux;
            }
        }
        let columns = body.modes.curvature.as_slice();
        for (source, target) in work.chunks_exact(nm).zip(out.chunks_exact_mut(nm)) {
            for (value, column) in source.iter().zip(columns.chunks_exact(nm)) {
                target.iter_mut().zip(column).for_each(|(t, c)| *t += value * c);
            }
        }
    }
}
