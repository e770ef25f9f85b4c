//! A massless layer at the surface with a retarded response: residual flexibility under stiffness-proportional damping.
//!
//! `F λ_e` with the elastic part `λ_e` of the nodal forces, `λ_e + α1 d_t λ_e = λ`: springs and dashpots side by side
//! (Kelvin–Voigt). With `d_t λ_e = a0 λ_e + h` of the time formula, `λ_e = (λ − α1 h)/(1 + α1 a0)`.

use crate::linalg::vectorised::{add_columns, dot};
use crate::multistep::TimeDerivative;
use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

/// A flexible layer with damping.
#[derive(Clone, Debug)]
pub struct RetardedLayer {
    /// `F`, `2n × 2n` [m/(N/m)].
    pub flexibility: DMatrix<f64>,
    /// Relaxation time `α1` \[s].
    pub time: f64,
}

/// Elastic nodal forces of a [`RetardedLayer`] with the history that the time formula needs; empty without a layer.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RetardedForces {
    /// Present value [N/m].
    pub now: DVector<f64>,
    /// Value one step earlier [N/m].
    pub before: DVector<f64>,
    /// `d_t` at the present time [N/(m s)].
    pub rate: DVector<f64>,
}

impl RetardedForces {
    /// True if all three belong to `ports` surface components.
    pub fn fits(&self, ports: usize) -> bool {
        [&self.now, &self.before, &self.rate].iter().all(|values| values.len() == ports)
    }

    /// Known part of `d_t` at one port in the coming step; a state without forces yet is at rest.
    fn offset(&self, td: &TimeDerivative, port: usize) -> f64 {
        let at = |values: &DVector<f64>| values.get(port).copied().unwrap_or(0.0);
        td.offset(at(&self.now), at(&self.before), at(&self.rate))
    }
}

impl RetardedLayer {
    /// Share with which a new force counts at once \[1].
    pub fn share(&self, a0: f64) -> f64 {
        1.0 / (1.0 + self.time * a0)
    }

    /// Writes the elastic forces without new nodal forces into `known`, and adds their displacement to `surface`.
    pub fn add_known(
        &self,
        state: &RetardedForces,
        td: &TimeDerivative,
        known: &mut DVector<f64>,
        surface: &mut DVector<f64>,
    ) {
        fit(known, surface.len());
        let factor = -self.time * self.share(td.a0);
        for (port, value) in known.iter_mut().enumerate() {
            *value = factor * state.offset(td, port);
        }
        add_product(1.0, &self.flexibility, known, surface);
    }

    /// Writes the elastic forces after a step under `forces` into `next`.
    pub fn commit(
        &self,
        known: &DVector<f64>,
        forces: &DVector<f64>,
        td: &TimeDerivative,
        state: &RetardedForces,
        next: &mut RetardedForces,
    ) {
        let share = self.share(td.a0);
        for values in [&mut next.now, &mut next.before, &mut next.rate] {
            fit(values, forces.len());
        }
        for (port, force) in forces.iter().enumerate() {
            let now = share * force + known[port];
            next.now[port] = now;
            next.rate[port] = td.a0 * now + state.offset(td, port);
            let before = state.now.get(port).copied().unwrap_or(0.0);
            next.before[port] = if td.is_stationary() { now } else { before };
        }
    }

    /// Elastic energy [J/m].
    pub fn energy(&self, state: &RetardedForces) -> f64 {
        0.5 * quadratic_form(&self.flexibility, &state.now)
    }

    /// Dissipated power `α1 λ̇_eᵀ F λ̇_e` [W/m].
    pub fn dissipation(&self, state: &RetardedForces) -> f64 {
        self.time * quadratic_form(&self.flexibility, &state.rate)
    }
}

/// `out ← out + factor · A x`.
pub(super) fn add_product(factor: f64, a: &DMatrix<f64>, x: &DVector<f64>, out: &mut DVector<f64>) {
    add_columns(factor, a.as_slice(), out.len(), x.as_slice(), out.as_mut_slice());
}

/// `xᵀ A x`.
pub(super) fn quadratic_form(a: &DMatrix<f64>, x: &DVector<f64>) -> f64 {
    let columns = a.as_slice().chunks_exact(a.nrows().max(1));
    columns.zip(x.as_slice()).map(|(column, factor)| factor * dot(column, x.as_slice())).sum()
}

/// Gives a buffer its length; allocates at the first use only.
pub(super) fn fit(buffer: &mut DVector<f64>, len: usize) {
    if buffer.len() != len {
        *buffer = DVector::zeros(len);
    }
}
