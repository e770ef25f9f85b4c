//! Exchange of forces between lines side by side.

use super::contact_line::{ContactLine, LineScratch};
use crate::contact::problem::LineProblem;
use nalgebra::DVector;

/// Displaces all lines by what the hot layers of all do to the bodies.
pub fn pulls(lines: &[LineProblem], scratch: &mut [LineScratch]) {
    let Some(bodies) = lines.first().map(|line| &line.bodies) else { return };
    for body in 0..2 {
        let mut sum: DVector<f64> = DVector::zeros(0);
        for (line, scratch) in lines.iter().zip(&*scratch) {
            let pull = &scratch.given.layers.on_ports[body];
            if sum.is_empty() && !pull.is_empty() {
                sum = DVector::zeros(pull.len());
            }
            if !pull.is_empty() {
                sum.axpy(line.share, pull, 1.0);
            }
        }
        let displaced = (!sum.is_empty()).then(|| bodies.shared.compliance[body] * &sum);
        for scratch in &mut *scratch {
            if let (Some(displaced), Some(grid)) = (&displaced, &scratch.grid) {
                scratch.given.add_pulled(grid, body, displaced);
            }
            if body == 0 {
                scratch.iterate.all.pull.clone_from(&sum);
            }
        }
    }
}

/// Gives lines the contact forces of all in the present iterate.
pub fn forces(lines: &mut [ContactLine]) {
    let mut all: DVector<f64> = DVector::zeros(0);
    for line in &mut *lines {
        line.traction.port_forces = line.grid.moments(line.state.forces.as_slice());
        if all.is_empty() {
            all = DVector::zeros(line.traction.port_forces.len());
        }
        all.axpy(line.problem.share, &line.traction.port_forces, 1.0);
    }
    lines.iter_mut().for_each(|line| line.iterate.all.contact.clone_from(&all));
    fields(lines);
}

/// Gives lines of a patch what the forces of all of them along and across do.
fn fields(lines: &mut [ContactLine]) {
    for line in &mut *lines {
        line.iterate.moments = Default::default();
        for direction in 0..line.state.directions() {
            line.iterate.moments[direction] = line.moments_of_shear(direction);
        }
    }
    for k in 0..lines.len() {
        let Some(patch) = lines[k].problem.patch else { return };
        lines[k].iterate.fields = patch.fields(lines.iter().map(|line| line.iterate.moments));
    }
}

/// Gives lines of a patch whose nodes have its size the derivatives of what all of them do to each other by it.
pub fn growths(lines: &mut [ContactLine]) {
    for k in 0..lines.len() {
        let LineProblem { patch: Some(patch), size: Some(_), .. } = lines[k].problem else { continue };
        lines[k].iterate.growths = patch.growths(lines.iter().map(|line| line.iterate.moments));
    }
}
