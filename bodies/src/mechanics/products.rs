//! Products of matrices and vectors, and buffers for them.

use crate::linalg::vectorised::{add_columns, dot};
use nalgebra::{DMatrix, DVector};

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
