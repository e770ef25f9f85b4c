//! Unknowns of the linear problem, in their order: of every line normal forces of the closed nodes and tangential
//! forces of the stuck ones, then changes of the motions that are sought. Motions themselves would ask for forces
//! thousands of times as large in the elimination, since velocities of hub and rim hardly differ, and rounding with
//! them.

use super::axes::Axes;
use crate::axes::Axis;
use crate::contact::line::ContactGrid;
use crate::contact::line::contact_line::ContactLine;
use crate::contact::line::rows::NodeEquation;
use std::ops::Range;

/// Unknowns of given states.
#[derive(Default)]
pub(super) struct Unknowns {
    /// Those of every line.
    pub lines: Vec<LineUnknowns>,
    /// Axes whose motions are sought; the height of the hub comes last.
    pub axes: Vec<Axis>,
}

/// Unknown forces of one line.
#[derive(Default)]
pub(super) struct LineUnknowns {
    /// Closed nodes.
    pub closed: Vec<usize>,
    /// Stuck nodes.
    pub stuck: Vec<usize>,
    /// Tangential force over normal force at each of the closed nodes if it slips, with its sign; zero if it sticks
    /// \[1].
    pub friction: Vec<f64>,
}

impl Unknowns {
    /// Lists the unknowns of the present states.
    pub fn list(&mut self, lines: &[ContactLine], axes: &Axes) {
        self.lines.resize_with(lines.len(), LineUnknowns::default);
        self.lines.iter_mut().zip(lines).for_each(|(unknowns, line)| unknowns.list(line));
        self.axes.clear();
        self.axes.extend(axes.sought());
    }

    /// Lists the normal forces of the closed nodes and the height of the hub, if that is sought, alone.
    pub fn list_pressures(&mut self, lines: &[ContactLine], axes: &Axes) {
        self.lines.resize_with(lines.len(), LineUnknowns::default);
        for (unknowns, line) in self.lines.iter_mut().zip(lines) {
            unknowns.list_closed(line);
            unknowns.stuck.clear();
            unknowns.friction.clear();
            unknowns.friction.resize(unknowns.closed.len(), 0.0);
        }
        self.axes.clear();
        self.axes.extend(axes.sought().filter(|&axis| axis == Axis::Height));
    }

    /// Number of unknowns.
    pub fn len(&self) -> usize {
        self.lines.iter().map(LineUnknowns::len).sum::<usize>() + self.axes.len()
    }

    /// Closed nodes of all lines.
    pub fn closed(&self) -> usize {
        self.lines.iter().map(|line| line.closed.len()).sum()
    }

    /// Gives the lines the solution of the linear problem: port forces and changes of the motions.
    pub fn accept(&self, solution: &[f64], lines: &mut [ContactLine], axes: &Axes) {
        let mut rest = solution;
        for (unknowns, line) in self.lines.iter().zip(&mut *lines) {
            let (own, others) = rest.split_at(unknowns.len());
            unknowns.accept(own, line);
            rest = others;
        }
        for (change, &k) in rest.iter().zip(&self.axes) {
            let value = if axes.holds(k) { 0.0 } else { lines[0].traction.rigid[k] + change };
            lines.iter_mut().for_each(|line| line.traction.rigid[k] = value);
        }
    }
}

impl LineUnknowns {
    /// Lists the unknowns of the present states.
    fn list(&mut self, line: &ContactLine) {
        let status = &line.state.status;
        self.list_closed(line);
        self.stuck.clear();
        self.stuck.extend(self.closed.iter().filter(|&&i| status[i].is_stuck()));
        self.friction.clear();
        self.friction.extend(self.closed.iter().map(|&i| status[i].friction_direction() * line.friction(i)));
    }

    /// Lists the closed nodes alone.
    fn list_closed(&mut self, line: &ContactLine) {
        let status = &line.state.status;
        self.closed.clear();
        self.closed.extend((0..status.len()).filter(|&i| status[i].is_active()));
    }

    /// Number of unknowns.
    pub fn len(&self) -> usize {
        self.closed.len() + self.stuck.len()
    }

    /// Nodes and kinds of the equations of the line, in the order of its unknowns.
    pub fn equations(&self) -> impl Iterator<Item = (usize, NodeEquation)> {
        let gaps = self.closed.iter().map(|&i| (i, NodeEquation::Gap));
        gaps.chain(self.stuck.iter().map(|&i| (i, NodeEquation::Slip)))
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

    /// Writes the coefficients of the unknowns, given those of all port `forces`.
    pub fn write(&self, target: &mut [f64], forces: &[f64], grid: &ContactGrid) {
        let (normal, tangential) = target.split_at_mut(self.closed.len());
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
    }

    /// Gives a line its part of the solution.
    fn accept(&self, solution: &[f64], line: &mut ContactLine) {
        line.traction.port_forces.fill(0.0);
        self.place(solution, line.grid, line.traction.port_forces.as_mut_slice());
    }

    /// Writes the forces of a solution at the ports of the closed nodes.
    pub fn place(&self, solution: &[f64], grid: &ContactGrid, forces: &mut [f64]) {
        let (normal, tangential) = solution.split_at(self.closed.len());
        for ((&i, force), friction) in self.closed.iter().zip(normal).zip(&self.friction) {
            let port = grid.port(i);
            forces[port + 1] = *force;
            forces[port] = friction * force;
        }
        for (force, &i) in tangential.iter().zip(&self.stuck) {
            forces[grid.port(i)] = *force;
        }
    }
}

/// Scales the coefficients of an equation to a largest one of one; returns the factor.
pub(super) fn scale(coefficients: &mut [f64]) -> f64 {
    let largest = largest(coefficients);
    let scale = if largest > 0.0 { 1.0 / largest } else { 1.0 };
    coefficients.iter_mut().for_each(|value| *value *= scale);
    scale
}

/// Largest amount, of four at a time.
fn largest(values: &[f64]) -> f64 {
    let larger = |a: f64, b: f64| if b > a { b } else { a };
    let (fours, rest) = values.as_chunks::<4>();
    let four =
        fours.iter().fold([0.0; 4], |most: [f64; 4], four| std::array::from_fn(|k| larger(most[k], four[k].abs())));
    rest.iter().map(|value| value.abs()).chain(four).fold(0.0, larger)
}
