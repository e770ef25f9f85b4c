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
            scratch.iterate.all.pull[body].clone_from(&sum);
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

/// Gives lines of a patch what the tangential forces of all of them do.
fn fields(lines: &mut [ContactLine]) {
    for line in &mut *lines {
        let forces = (0..line.grid.len()).map(|i| (i, line.tangential(i)));
        line.iterate.moments = line.moments(forces);
        let lateral = (0..line.state.across.force.len()).map(|i| (i, line.lateral(i)));
        line.iterate.across.moments = line.moments(lateral);
    }
    for k in 0..lines.len() {
        let Some(patch) = lines[k].problem.patch else { return };
        if lines[k].is_sideways() {
            let moments = lines.iter().map(|line| [&line.iterate.moments, &line.iterate.across.moments]);
            let [along, across] = patch.fields(moments);
            (lines[k].iterate.field, lines[k].iterate.across.field) = (along, across);
        } else {
            lines[k].iterate.field = patch.field(lines.iter().map(|line| &line.iterate.moments));
        }
    }
}

/// Gives lines of a patch whose nodes have its size the derivatives of what all of them do to each other by it.
pub fn growths(lines: &mut [ContactLine]) {
    for k in 0..lines.len() {
        let LineProblem { patch: Some(patch), size: Some(_), .. } = lines[k].problem else { continue };
        let moments = lines.iter().map(|line| [&line.iterate.moments, &line.iterate.across.moments]);
        lines[k].iterate.growth = patch.growths(moments);
    }
}
