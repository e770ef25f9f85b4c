//! Guess of the closed nodes on uneven surfaces, from which the active set starts.
//!
//! New material comes under the contact in every step, so that the edges of the patches move, and the search for all
//! states takes two or three iterations where on smooth surfaces it takes one. Pressures hardly depend on the shear. So
//! closed nodes and normal forces are first found by themselves, with the shear forces and velocities of before. The
//! guess decides nothing; where it fails the search starts from the states of before. Without it every result takes
//! longer and is the same but for the tolerance of the edges: forces on a rough rail change by 1.4e-5.

use super::axes::Axes;
use super::linear::LinearSolver;
use super::present::{self, Present};
use super::pressing::{PressureSearch, Thoroughness};
use super::states::Rules;
use crate::contact::line::contact_line::ContactLine;
use crate::contact::line::exchange;

/// Extent of the search: yielding stays as it is.
const GUESSED: Thoroughness = Thoroughness { most: 6, together: 6, yields: false };

/// Memory of the guess.
#[derive(Default)]
pub struct Guess {
    starts: Vec<Present>,
}

impl Guess {
    /// Sets closed nodes, gaps, normal forces and height of the hub to those that belong to the shear forces and
    /// velocities at hand, where the surfaces are uneven, then the displacements to these forces: lever arms of the step
    /// before would leave a moment that takes an iteration more.
    pub fn find(
        &mut self,
        lines: &mut [ContactLine],
        axes: &Axes,
        rules: &Rules,
        pressing: &mut PressureSearch,
        solver: &mut LinearSolver,
    ) {
        let skipped = |line: &ContactLine| line.given.rail_slope.is_empty() || line.problem.time.is_stationary();
        if lines.iter().all(skipped) {
            return;
        }
        present::take(lines, &mut self.starts);
        if !matches!(pressing.press(lines, axes, rules, GUESSED, solver), Ok(true)) {
            present::give_back(&self.starts, lines);
            return;
        }
        lines.iter_mut().for_each(slide);
        exchange::forces(lines);
        for line in lines {
            line.follow_forces(axes.sought_accelerations(line.traction.rigid));
        }
    }
}

/// Gives nodes that slip the shear forces of friction under the pressures at hand.
fn slide(line: &mut ContactLine) {
    for i in 0..line.grid.len() {
        let status = line.state.status[i];
        if status.is_active() && !status.is_stuck() {
            let shear = line.slide(i).direction.map(|part| part * line.friction(i) * line.normal(i));
            line.state.forces[line.grid.component(i)] = shear[0];
            line.state.lateral.get_mut(i).into_iter().for_each(|lateral| *lateral = shear[1]);
        }
    }
}
