//! Exchange of forces between lines side by side.

use super::contact_line::{ContactLine, LineScratch};
use super::grid::ContactGrid;
use super::others::add;
use crate::contact::problem::LineProblem;

/// Gives each of several lines the displacements by the hot layers of the others.
pub fn pulls(grid: &ContactGrid, lines: &[LineProblem], scratch: &mut [LineScratch]) {
    for (k, line) in lines.iter().enumerate() {
        if line.bodies.alone.is_none() {
            continue;
        }
        let mut sum = [Vec::new(), Vec::new()];
        for (_, (other, scratch)) in lines.iter().zip(&*scratch).enumerate().filter(|(j, _)| *j != k) {
            let pulls = sum.iter_mut().zip(&scratch.given.layers.pull);
            pulls.for_each(|(sum, pull)| add(other.share, pull, sum));
        }
        scratch[k].given.add_pulls_of_others(grid, &line.bodies.shared, &sum);
        scratch[k].iterate.others.pull = sum;
    }
}

/// Gives each of several lines the contact forces of the others in the present iterate.
pub fn forces(lines: &mut [ContactLine]) {
    for k in 0..lines.len() {
        let (before, rest) = lines.split_at_mut(k);
        let [line, after @ ..] = rest else { return };
        line.iterate.others.forces.fill(0.0);
        for other in before.iter().chain(&*after) {
            line.iterate.others.forces.axpy(other.problem.share, &other.traction.port_forces, 1.0);
        }
    }
    fields(lines);
}

/// Gives lines of a patch what the tangential forces of all of them do.
fn fields(lines: &mut [ContactLine]) {
    for line in &mut *lines {
        let forces = (0..line.grid.len()).map(|i| (i, line.tangential(i)));
        line.iterate.others.moments = line.moments(forces);
        let lateral = (0..line.state.across.force.len()).map(|i| (i, line.lateral(i)));
        line.iterate.across.moments = line.moments(lateral);
    }
    for k in 0..lines.len() {
        let Some(patch) = lines[k].problem.patch else { return };
        if lines[k].is_sideways() {
            let moments = lines.iter().map(|line| [&line.iterate.others.moments, &line.iterate.across.moments]);
            let [along, across] = patch.fields(moments);
            (lines[k].iterate.others.field, lines[k].iterate.across.field) = (along, across);
        } else {
            lines[k].iterate.others.field = patch.field(lines.iter().map(|line| &line.iterate.others.moments));
        }
    }
}
