//! Linear problem of a single patch, solved by alternation of pressure and shear. Measured: 0.68 of the time of a step
//! without heat at 20 elements per half-width, 0.46 at 50.
//!
//! For bodies of equal material pressure hardly shears the contact and shear hardly opens it: the dents of wheel and
//! rail cancel. So the pressures, with the height of the hub, are found for given shear, then the shear of the stuck
//! nodes, with the velocities of the hub, for these pressures, and so on until nothing changes any more
//! ([`PressureShear`]). The matrix of the pressures is a part of the compliance, whose factor belongs to the place of
//! the patch alone and is kept ([`KeptFactors`]). Only the equations of the stuck nodes and of the motions are written
//! and factorised in a step.

use super::patch_factor::KeptFactors;
use super::pressure_shear::PressureShear;
use crate::axes::Axis;
use crate::contact::active_set::linear::LinearProblem;
use crate::contact::active_set::unknowns::LineUnknowns;
use crate::contact::line::contact_line::ContactLine;
use crate::contact::line::rows::NodeEquation;
use std::ops::Range;

/// Equations of a single patch, and the factors that are kept.
#[derive(Default)]
pub struct Alternating {
    factors: KeptFactors,
    equations: PressureShear,
}

impl Alternating {
    /// Solves the linear problem of a single patch and gives the line its forces and motions; `false`: there are
    /// several patches or none, or the alternation does not converge. `rows` is memory for the coefficients of all
    /// ports.
    pub fn solve(&mut self, lines: &mut [ContactLine], problem: LinearProblem, rows: &mut [Vec<f64>]) -> bool {
        let ([line], [own]) = (&*lines, problem.unknowns.lines.as_slice()) else { return false };
        let Some(patch) = own.single_patch(line) else { return false };
        let Some(matrices) = self.factors.of(line.problem, line.grid, &patch) else { return false };
        self.equations.write_gaps(line, problem, own, patch);
        self.equations.write_shear(lines, problem, own, rows);
        let solved = self.equations.solve(matrices);
        if solved {
            problem.unknowns.accept(&self.equations.unknowns, lines, problem.axes);
        }
        solved
    }
}

impl PressureShear {
    /// Writes the gaps, and the present unknowns as a guess.
    fn write_gaps(&mut self, line: &ContactLine, problem: LinearProblem, own: &LineUnknowns, patch: Range<usize>) {
        let (LineUnknowns { closed, stuck, friction }, sought) = (own, &problem.unknowns.axes);
        self.place.clear();
        self.place.extend_from_slice(&line.grid.x[patch.clone()]);
        self.friction.clone_from(friction);
        self.stuck.clear();
        self.stuck.extend(stuck.iter().map(|i| i - patch.start));
        self.gap.clear();
        self.motions.iter_mut().for_each(Vec::clear);
        for &i in closed {
            let gap = problem.equation(0, i, NodeEquation::Gap, line.gap_terms(i));
            self.gap.push(LinearProblem::left_over(&gap, line));
            self.motions.iter_mut().zip(sought).for_each(|(motion, &axis)| motion.push(gap.motions[axis]));
        }
        for (of, offset) in self.rim_angle.iter_mut().zip([1, 0]) {
            of.clear();
            of.extend(
                closed.iter().map(|&i| line.iterate.rim.by_force(line.problem.share, line.grid.port(i) + offset)),
            );
        }
        let height = sought.last() == Some(&Axis::Height);
        self.reset(stuck.len() + sought.len() - usize::from(height), height);
        let guess = closed.iter().map(|&i| line.normal(i)).chain(stuck.iter().map(|&i| line.tangential(i)));
        self.unknowns.clear();
        self.unknowns.extend(guess.chain(sought.iter().map(|_| 0.0)));
    }

    /// Writes the equations of the stuck nodes and of the motions.
    fn write_shear(
        &mut self,
        lines: &[ContactLine],
        problem: LinearProblem,
        own: &LineUnknowns,
        rows: &mut [Vec<f64>],
    ) {
        for (r, &i) in own.stuck.iter().enumerate() {
            let slip = problem.node(lines, 0, i, NodeEquation::Slip, rows);
            problem.write(&lines[0], &slip, rows, self.row(r));
        }
        for (r, &axis) in problem.unknowns.axes.iter().enumerate() {
            let balance = problem.balance(axis, lines, rows);
            problem.write(&lines[0], &balance, rows, self.row(own.stuck.len() + r));
        }
    }
}
