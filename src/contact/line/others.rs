//! Forces of the other lines, by which the bodies displace a line.
//!
//! All lines press the same bodies. What the forces of a line do to the surface beneath it beyond what they do to the
//! bodies as a whole is its own ([`super::alone`]); the rest acts on all lines alike.

use super::vectors::copy;
use crate::contact::flexibility::{ByPowers, Field};
use nalgebra::DVector;

/// Forces on a line, or those of several.
#[derive(Clone, Copy)]
pub struct LineForces<'a> {
    /// Contact forces on the ports of the wheel [N/m].
    pub contact: &'a DVector<f64>,
    /// Pulls of hot layers at the candidates, on wheel and rail [N/m]; empty: there are none.
    pub pull: &'a [Vec<f64>; 2],
}

/// Forces of the other lines on the ports of wheel and rail, each line weighted with its share of the width.
#[derive(Default)]
pub struct OtherLines {
    /// Contact forces on the wheel [N/m]; empty: there are no other lines.
    pub forces: DVector<f64>,
    /// Pulls of hot layers at the candidates, on wheel and rail [N/m]; empty: there are none.
    pub pull: [Vec<f64>; 2],
    /// Moments of the line's own tangential forces with the powers of the place [N/m], and what the forces of all lines
    /// of the patch do to it.
    pub moments: ByPowers,
    pub field: Field,
    /// Contact forces and pulls of all lines together.
    mean: (DVector<f64>, [Vec<f64>; 2]),
}

impl OtherLines {
    /// Takes away all forces; `ports` is the number of ports, or zero where there are no other lines.
    pub fn reset(&mut self, ports: usize) {
        if self.forces.len() == ports {
            self.forces.fill(0.0)
        } else {
            self.forces = DVector::zeros(ports)
        }
        self.pull.iter_mut().for_each(Vec::clear);
    }

    /// Forces of all lines together, as the bodies feel them, from those of the line itself with its `share` of the
    /// width.
    pub fn mean<'a>(&'a mut self, share: f64, own: LineForces<'a>) -> LineForces<'a> {
        if self.forces.is_empty() {
            return own;
        }
        let Self { forces, pull, mean, .. } = self;
        copy(&mut mean.0, forces);
        mean.0.axpy(share, own.contact, 1.0);
        for ((mean, others), own) in mean.1.iter_mut().zip(pull).zip(own.pull) {
            mean.clone_from(others);
            add(share, own, mean);
        }
        LineForces { contact: &mean.0, pull: &mean.1 }
    }
}

/// Adds a multiple of values; no values are zeros.
pub(super) fn add(factor: f64, values: &[f64], sum: &mut Vec<f64>) {
    if sum.len() < values.len() {
        sum.resize(values.len(), 0.0);
    }
    sum.iter_mut().zip(values).for_each(|(sum, value)| *sum += factor * value);
}
