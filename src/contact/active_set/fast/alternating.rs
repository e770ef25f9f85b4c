//! The linear problem on a single patch, solved by turns.
//!
//! For bodies of equal material pressure hardly shears the contact and shear hardly opens it: the dents of wheel and rail cancel.
//! So the pressures, with the height of the hub, are found for given shear, then the shear of the stuck nodes, with the velocities
//! of the hub, for these pressures, and so on until nothing changes any more ([`PressureShear`]). The matrix of the pressures is a part of
//! the compliance, whose inverse belongs to the place of the patch alone and is kept (see [`KeptInverses`](super::patch_inverse::KeptInverses)).
//! What is written and factorised in a step are the equations of the stuck nodes and free motions alone.

use super::pressure_shear::PressureShear;
use crate::contact::active_set::iterate::{ActiveSetScratch, Iterate};
use std::ops::Range;

impl Iterate<'_> {
    /// Solves the linear problem of a single patch; `false`: this is none, or the turns do not converge.
    pub(in crate::contact::active_set) fn solve_alternating(&mut self) -> bool {
        let Some(patch) = self.single_patch() else { return false };
        let (mut kept, mut turns) =
            (std::mem::take(&mut self.scratch.kept), std::mem::take(&mut self.scratch.pressure_shear));
        let solved = match kept.of(self.problem, self.grid, &patch) {
            Some(inverse) => {
                self.write_gaps(patch, &mut turns);
                self.write_shear(&mut turns);
                turns.solve(inverse)
            }
            None => false,
        };
        if solved {
            self.accept(&turns.unknowns);
        }
        (self.scratch.kept, self.scratch.pressure_shear) = (kept, turns);
        solved
    }

    /// The closed nodes, if they are neighbours and none of them yields. Stationary problems are solved directly.
    pub(in crate::contact::active_set) fn single_patch(&self) -> Option<Range<usize>> {
        let closed = &self.scratch.closed;
        let (&first, &last) = (closed.first()?, closed.last()?);
        let single = last + 1 - first == closed.len() && !self.problem.time.is_stationary();
        (single && !self.state.yielded[first..=last].contains(&true)).then_some(first..last + 1)
    }

    /// Writes the gaps, and the present unknowns as a guess.
    fn write_gaps(&self, patch: Range<usize>, turns: &mut PressureShear) {
        let ActiveSetScratch { closed, friction, stuck, axes, rim_angle: turn, .. } = &*self.scratch;
        turns.place.clear();
        turns.place.extend_from_slice(&self.grid.x[patch.clone()]);
        turns.friction.clone_from(friction);
        turns.stuck.clear();
        turns.stuck.extend(stuck.iter().map(|i| i - patch.start));
        turns.gap.clear();
        turns.motions.iter_mut().for_each(Vec::clear);
        for &i in closed {
            let row = self.gap_terms(i);
            turns.gap.push(self.constant(&row));
            turns.motions.iter_mut().zip(axes).for_each(|(motion, &axis)| motion.push(row.rigid[axis]));
        }
        for (of, offset) in turns.turn.iter_mut().zip([1, 0]) {
            of.clear();
            of.extend(closed.iter().map(|&i| turn.forces[self.grid.port(i) + offset]));
        }
        let height = axes.last() == Some(&1);
        turns.reset(stuck.len() + axes.len() - usize::from(height), height);
        let guess = closed.iter().map(|&i| self.normal(i)).chain(stuck.iter().map(|&i| self.tangential(i)));
        let motions = axes.iter().map(|&axis| self.traction.rigid[axis]);
        turns.unknowns.iter_mut().zip(guess.chain(motions)).for_each(|(value, guess)| *value = guess);
    }

    /// Writes the equations of the stuck nodes and the balances of the free motions.
    fn write_shear(&mut self, turns: &mut PressureShear) {
        let (stuck, axes) = (self.scratch.stuck.len(), self.scratch.axes.len());
        let (mut forces, window) = (std::mem::take(&mut self.scratch.row), self.window());
        for r in 0..stuck {
            let row = self.slip_row(self.scratch.stuck[r], window.clone(), &mut forces);
            self.write(turns.row(r), &row, &forces);
        }
        for r in 0..axes {
            let row = self.axis_row(self.scratch.axes[r], &mut forces);
            self.write(turns.row(stuck + r), &row, &forces);
        }
        self.scratch.row = forces;
    }
}
