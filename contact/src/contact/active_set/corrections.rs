//! Corrections of a linear problem for new directions of friction.
//!
//! Between two iterates with the same states the equations of a line hardly change: friction turns a little. So what the present
//! forces miss is found by the factors of the directions before, at the cost of one right-hand side in place of a factor and some
//! thirty columns. What is missed is exact, so that the factors decide how fast the search ends and not where.

use super::own_forces::{OwnForces, add, add_factors, product};
use super::unknowns::ShearUnknown;
use crate::axes::Axis;
use crate::contact::line::contact_line::ContactLine;

impl<const C: usize, const N: usize> OwnForces<C, N> {
    /// Takes the shear that friction of the present directions and nodes that stick miss, as far as the line alone answers it, into
    /// [`Self::corrections`]; returns the sums over it. `None`: it is not finite.
    pub(super) fn correct(&mut self, line: &ContactLine, sought: &[Axis]) -> Option<[f64; N]> {
        let Self { nodes, unknown, shear, corrected, corrections, .. } = self;
        corrected.clear();
        corrected.extend(unknown.iter().map(|of| missed(line, nodes[of.place], of)));
        if !unknown.is_empty() && !shear.solve_with(corrected) {
            return None;
        }
        corrections.clear();
        corrections.extend(nodes.iter().map(|&i| short(line, i)));
        unknown.iter().zip(corrected).for_each(|(of, force)| add(*force, &of.direction, &mut corrections[of.place]));
        let (mut sums, mut pulls) = ([0.0; N], [(0.0, [0.0; 2]); Axis::COUNT]);
        for (&i, correction) in nodes.iter().zip(corrections) {
            pulls.iter_mut().zip(sought).for_each(|(pull, &axis)| *pull = line.pull_of_forces(axis, i));
            add_factors(line, (i, &pulls), (0.0, *correction), &mut sums);
        }
        Some(sums)
    }
}

/// Slip by which node `i` misses the equation of an unknown shear [m/s].
fn missed(line: &ContactLine, i: usize, of: &ShearUnknown) -> f64 {
    if line.state.status[i].is_stuck() {
        return -product(&of.direction, &[line.state.slip[0][i], line.state.slip[1][i]]);
    }
    let slide = line.slide(i);
    let [along, across] = slide.direction;
    // Friction points along `q − s/b`, see `super::slides`: across it the slip is b times the shear.
    -(line.iterate.own_slip + slide.turn) * product(&line.shear(i), &[-across, along])
}

/// Shear by which friction at node `i` misses its limit, in its direction [N/m]; zero where it sticks.
fn short(line: &ContactLine, i: usize) -> [f64; 2] {
    let direction = line.slide(i).direction;
    let short = line.friction(i) * line.normal(i) - product(&line.shear(i), &direction);
    direction.map(|part| if line.state.status[i].is_stuck() { 0.0 } else { short * part })
}
