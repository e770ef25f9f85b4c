//! The linear problem of given states: unknown are the nodal forces of closed nodes and the free motions.
//!
//! In general all equations are solved together. Those of a single patch are solved [by turns](super::alternating).

use super::iterate::{ActiveSetScratch, Iterate};
use super::rows::AffineRow;
use crate::contact::error::ContactError;
use crate::contact::line::state::Status;
use crate::linalg::DenseSystem;
use std::ops::Range;

impl Iterate<'_> {
    /// Solves the linear problem of the present states; fills forces, rigid values, displacements, slips and gaps.
    pub(super) fn solve_linear(&mut self) -> Result<(), ContactError> {
        self.list_unknowns();
        self.write_rim_angle();
        let alternating = self.solve_alternating();
        if !alternating {
            self.solve_together()?;
        }
        self.scratch.solved[usize::from(!alternating)] += 1;
        self.evaluate();
        Ok(())
    }

    /// Solves all equations together.
    fn solve_together(&mut self) -> Result<(), ContactError> {
        let singular = ContactError::Singular { closed: self.scratch.closed.len() };
        let mut system = std::mem::take(&mut self.scratch.system);
        self.assemble(&mut system);
        // Nothing is unknown when a wheel with prescribed motions is off the rail.
        let solved = system.solve().map(|x| self.accept(x));
        self.scratch.system = system;
        solved.ok_or(singular)
    }

    /// Lists the unknowns; the height of the hub comes last.
    fn list_unknowns(&mut self) {
        let mut friction = std::mem::take(&mut self.scratch.friction);
        let status = &self.state.status;
        let ActiveSetScratch { closed, stuck, axes, .. } = &mut *self.scratch;
        closed.clear();
        closed.extend((0..status.len()).filter(|&i| status[i].is_active()));
        stuck.clear();
        stuck.extend(closed.iter().filter(|&&i| status[i] == Status::Stick));
        axes.clear();
        axes.extend([0, 2, 1].into_iter().filter(|&k: &usize| self.problem.rigid[k].target().is_none()));
        friction.clear();
        friction.extend(self.scratch.closed.iter().map(|&i| status[i].friction_direction() * self.coefficient(i)));
        self.scratch.friction = friction;
    }

    /// Writes the equations: no gap at closed nodes, no slip at stuck ones, balances of the free axes.
    fn assemble(&mut self, system: &mut DenseSystem) {
        let (closed, stuck, axes) = (self.scratch.closed.len(), self.scratch.stuck.len(), self.scratch.axes.len());
        system.reset(closed + stuck + axes);
        let mut forces = std::mem::take(&mut self.scratch.row);
        let window = self.window();
        for r in 0..closed {
            let row = self.gap_row(self.scratch.closed[r], window.clone(), &mut forces);
            self.write(system.row(r), &row, &forces);
        }
        for r in 0..stuck {
            let row = self.slip_row(self.scratch.stuck[r], window.clone(), &mut forces);
            self.write(system.row(closed + r), &row, &forces);
        }
        for r in 0..axes {
            let row = self.axis_row(self.scratch.axes[r], &mut forces);
            self.write(system.row(closed + stuck + r), &row, &forces);
        }
        self.scratch.row = forces;
    }

    /// Ports from the first to the last closed node.
    pub(super) fn window(&self) -> Range<usize> {
        match (self.scratch.closed.first(), self.scratch.closed.last()) {
            (Some(&first), Some(&last)) => self.grid.port(first)..self.grid.port(last) + 2,
            _ => 0..0,
        }
    }

    /// Writes one equation, scaled to a largest coefficient of one.
    pub(super) fn write(&self, (target, rhs): (&mut [f64], &mut f64), row: &AffineRow, forces: &[f64]) {
        let ActiveSetScratch { closed, friction, stuck, axes, .. } = &*self.scratch;
        let (normal, rest) = target.split_at_mut(closed.len());
        let (tangential, rigid) = rest.split_at_mut(stuck.len());
        let nodes = forces.as_chunks::<2>().0;
        let pressed = |[tangential, normal]: &[f64; 2], friction: &f64| normal + friction * tangential;
        match (closed.first(), closed.last()) {
            // Neighbours: loops over them run several at a time.
            (Some(&first), Some(&last)) if last - first < closed.len() => {
                let patch = &nodes[self.grid.port(first) / 2..];
                let terms = normal.iter_mut().zip(patch).zip(friction);
                terms.for_each(|((value, node), friction)| *value = pressed(node, friction));
            }
            _ => {
                let terms = normal.iter_mut().zip(closed).zip(friction);
                terms.for_each(|((value, &i), friction)| *value = pressed(&nodes[self.grid.port(i) / 2], friction));
            }
        }
        for (value, &i) in tangential.iter_mut().zip(stuck) {
            *value = forces[self.grid.port(i)];
        }
        for (value, &k) in rigid.iter_mut().zip(axes) {
            *value = row.rigid[k];
        }
        let largest = largest(target);
        let scale = if largest > 0.0 { 1.0 / largest } else { 1.0 };
        target.iter_mut().for_each(|value| *value *= scale);
        *rhs = -self.constant(row) * scale;
    }

    /// Constant of an equation with the prescribed motions.
    pub(super) fn constant(&self, row: &AffineRow) -> f64 {
        let prescribed =
            self.problem.rigid.iter().zip(row.rigid).map(|(motion, by)| by * motion.target().unwrap_or(0.0));
        row.constant + prescribed.sum::<f64>()
    }

    /// Takes the solution of the linear problem: port forces and free motions.
    pub(super) fn accept(&mut self, solution: &[f64]) {
        let ActiveSetScratch { closed, friction, stuck, axes, .. } = &*self.scratch;
        let forces = &mut self.traction.port_forces;
        let (normal, rest) = solution.split_at(closed.len());
        let (tangential, rigid) = rest.split_at(stuck.len());
        forces.fill(0.0);
        for ((&i, force), friction) in closed.iter().zip(normal).zip(friction) {
            let port = self.grid.port(i);
            forces[port + 1] = *force;
            forces[port] = friction * force;
        }
        for (force, &i) in tangential.iter().zip(stuck) {
            forces[self.grid.port(i)] = *force;
        }
        for (value, &k) in rigid.iter().zip(axes) {
            self.traction.rigid[k] = if self.holds(k) { 0.0 } else { *value };
        }
    }
}

/// Largest amount, of four at a time.
pub(super) fn largest(values: &[f64]) -> f64 {
    let larger = |a: f64, b: f64| if b > a { b } else { a };
    let (fours, rest) = values.as_chunks::<4>();
    let four =
        fours.iter().fold([0.0; 4], |most: [f64; 4], four| std::array::from_fn(|k| larger(most[k], four[k].abs())));
    rest.iter().map(|value| value.abs()).chain(four).fold(0.0, larger)
}
