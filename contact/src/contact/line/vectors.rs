//! Vectors that keep their memory from solution to solution.

use nalgebra::DVector;

/// Copies without allocating where the lengths agree.
pub fn copy(target: &mut DVector<f64>, source: &DVector<f64>) {
    if target.len() == source.len() { target.copy_from(source) } else { target.clone_from(source) }
}
