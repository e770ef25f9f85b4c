//! Unknowns of the linear problem, in their order: normal forces of the closed nodes, tangential forces of the stuck
//! ones, motions that are sought.

use super::axes::{Axes, Equation};
use crate::contact::line::ContactGrid;
use crate::contact::line::contact_line::ContactLine;
use std::ops::Range;

/// Unknowns of given states.
#[derive(Default)]
pub(super) struct Unknowns {
    /// Closed nodes.
    pub closed: Vec<usize>,
    /// Stuck nodes.
    pub stuck: Vec<usize>,
    /// Axes whose motions are sought; the height of the hub comes last.
    pub axes: Vec<usize>,
    /// Tangential force over normal force at each of the closed nodes if it slips, with its sign; zero if it sticks
    /// \[1].
    pub friction: Vec<f64>,
}

impl Unknowns {
    /// Lists the unknowns of the present states.
    pub fn list(&mut self, line: &ContactLine, axes: &Axes) {
        let status = &line.state.status;
        self.list_closed(line);
        self.stuck.clear();
        self.stuck.extend(self.closed.iter().filter(|&&i| status[i].is_stuck()));
        self.axes.clear();
        self.axes.extend(axes.sought());
        self.friction.clear();
        self.friction.extend(self.closed.iter().map(|&i| status[i].friction_direction() * line.friction(i)));
    }

    /// Lists the closed nodes alone.
    pub fn list_closed(&mut self, line: &ContactLine) {
        let status = &line.state.status;
        self.closed.clear();
        self.closed.extend((0..status.len()).filter(|&i| status[i].is_active()));
    }

    /// Number of unknowns.
    pub fn len(&self) -> usize {
        self.closed.len() + self.stuck.len() + self.axes.len()
    }

    /// Ports from the first to the last closed node.
    pub fn window(&self, grid: &ContactGrid) -> Range<usize> {
        match (self.closed.first(), self.closed.last()) {
            (Some(&first), Some(&last)) => grid.port(first)..grid.port(last) + 2,
            _ => 0..0,
        }
    }

    /// The closed nodes, if they are neighbours and none of them yields. Stationary problems have no single patch.
    pub fn single_patch(&self, line: &ContactLine) -> Option<Range<usize>> {
        let (&first, &last) = (self.closed.first()?, self.closed.last()?);
        let single = last + 1 - first == self.closed.len() && !line.problem.time.is_stationary();
        (single && !line.state.yielded[first..=last].contains(&true)).then_some(first..last + 1)
    }

    /// Writes one equation with the coefficients `forces` of all ports, scaled to a largest coefficient of one.
    pub fn write(
        &self,
        (target, side): (&mut [f64], &mut f64),
        (equation, forces): (&Equation, &[f64]),
        grid: &ContactGrid,
        axes: &Axes,
    ) {
        let (normal, rest) = target.split_at_mut(self.closed.len());
        let (tangential, motions) = rest.split_at_mut(self.stuck.len());
        let nodes = forces.as_chunks::<2>().0;
        let pressed = |[tangential, normal]: &[f64; 2], friction: &f64| normal + friction * tangential;
        match (self.closed.first(), self.closed.last()) {
            // Neighbours: loops over them run several at a time.
            (Some(&first), Some(&last)) if last - first < self.closed.len() => {
                let patch = &nodes[grid.port(first) / 2..];
                let terms = normal.iter_mut().zip(patch).zip(&self.friction);
                terms.for_each(|((value, node), friction)| *value = pressed(node, friction));
            }
            _ => {
                let terms = normal.iter_mut().zip(&self.closed).zip(&self.friction);
                terms.for_each(|((value, &i), friction)| *value = pressed(&nodes[grid.port(i) / 2], friction));
            }
        }
        for (value, &i) in tangential.iter_mut().zip(&self.stuck) {
            *value = forces[grid.port(i)];
        }
        for (value, &k) in motions.iter_mut().zip(&self.axes) {
            *value = equation.motions[k];
        }
        let largest = largest(target);
        let scale = if largest > 0.0 { 1.0 / largest } else { 1.0 };
        target.iter_mut().for_each(|value| *value *= scale);
        *side = -axes.constant(equation) * scale;
    }

    /// Gives the line the solution of the linear problem: port forces and motions.
    pub fn accept(&self, solution: &[f64], line: &mut ContactLine, axes: &Axes) {
        let forces = &mut line.traction.port_forces;
        let (normal, rest) = solution.split_at(self.closed.len());
        let (tangential, motions) = rest.split_at(self.stuck.len());
        forces.fill(0.0);
        for ((&i, force), friction) in self.closed.iter().zip(normal).zip(&self.friction) {
            let port = line.grid.port(i);
            forces[port + 1] = *force;
            forces[port] = friction * force;
        }
        for (force, &i) in tangential.iter().zip(&self.stuck) {
            forces[line.grid.port(i)] = *force;
        }
        for (value, &k) in motions.iter().zip(&self.axes) {
            line.traction.rigid[k] = if axes.holds(k) { 0.0 } else { *value };
        }
    }
}

/// Largest amount, of four at a time.
fn largest(values: &[f64]) -> f64 {
    let larger = |a: f64, b: f64| if b > a { b } else { a };
    let (fours, rest) = values.as_chunks::<4>();
    let four =
        fours.iter().fold([0.0; 4], |most: [f64; 4], four| std::array::from_fn(|k| larger(most[k], four[k].abs())));
    rest.iter().map(|value| value.abs()).chain(four).fold(0.0, larger)
}
