//! Closed nodes, normal forces and height of the hub under known shear forces and velocities.

use super::axes::{Axes, Equation};
use super::fast::LinearSolver;
use super::linear::{Known, LinearProblem};
use super::states::{Rules, guess_state, yields};
use super::unknowns::Unknowns;
use crate::contact::error::ContactError;
use crate::contact::line::contact_line::ContactLine;
use crate::contact::line::state::NodeStatus;
use crate::linalg::vectorised::{add_columns, dot};

/// How far states of nodes are looked for.
#[derive(Clone, Copy)]
pub(super) struct Thoroughness {
    /// Iterations at most, and those after which only one node changes its state in each.
    pub most: usize,
    pub together: usize,
    /// True if nodes begin and cease to yield.
    pub yields: bool,
}

/// Memory of the normal problem.
#[derive(Default)]
pub(super) struct PressureSearch {
    unknowns: Unknowns,
    /// Shear forces, and the gap by them.
    known: Known,
    /// Gaps at the candidates of every line under these forces alone.
    open: Vec<Vec<Equation>>,
    /// Forces of one component at the candidates of every line [N/m].
    forces: Vec<Vec<f64>>,
    /// Gap by them at the candidates of every line \[m].
    gaps: Vec<Vec<f64>>,
    displaced: Displaced,
    /// States before an update.
    before: Vec<NodeStatus>,
}

/// Displacements by forces of one component.
#[derive(Default)]
struct Displaced {
    /// Forces of all lines at the candidates, by their shares of the width [N/m].
    mean: Vec<f64>,
    /// Displacement of both bodies at all ports, and of a line besides at all nodes \[m].
    ports: Vec<f64>,
    alone: Vec<f64>,
}

impl PressureSearch {
    /// Sets closed nodes, gaps, normal forces and height of the hub to those that belong to the shear forces and
    /// velocities at hand; true if states settled. `rows` is memory for the coefficients of all ports.
    pub fn press(
        &mut self,
        lines: &mut [ContactLine],
        axes: &Axes,
        rules: &Rules,
        thoroughness: Thoroughness,
        solver: &mut LinearSolver,
        rows: &mut [Vec<f64>],
    ) -> Result<bool, ContactError> {
        lines.iter_mut().for_each(ContactLine::update_rim);
        self.take_shear(lines, axes);
        for iteration in 0..thoroughness.most {
            self.unknowns.list_pressures(lines, axes);
            let problem = LinearProblem { axes, unknowns: &self.unknowns, known: &self.known };
            let solved = solver.solve(lines, problem, rows);
            self.give_shear(lines);
            solved?;
            if !self.close(lines, rules, thoroughness, iteration) {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Takes the shear forces, and the gaps under them.
    fn take_shear(&mut self, lines: &[ContactLine], axes: &Axes) {
        let Self { known, open, forces, displaced, .. } = self;
        known.forces.resize_with(lines.len(), Vec::new);
        for (line, ports) in lines.iter().zip(&mut known.forces) {
            ports.clear();
            ports.resize(line.grid.ports(), 0.0);
            (0..line.grid.len()).for_each(|i| ports[line.grid.port(i)] = line.tangential(i));
        }
        take(lines, 0, forces);
        displaced.gaps(lines, 0, forces, &mut known.gaps);
        open.resize_with(lines.len(), Vec::new);
        for ((line, open), gaps) in lines.iter().zip(open).zip(&known.gaps) {
            open.clear();
            open.extend(gaps.iter().enumerate().map(|(i, gap)| {
                let equation = axes.equation(line.gap_terms(i));
                Equation { constant: equation.constant + gap, ..equation }
            }));
        }
    }

    /// Gives closed nodes the shear forces of before.
    fn give_shear(&self, lines: &mut [ContactLine]) {
        for (line, forces) in lines.iter_mut().zip(&self.known.forces) {
            for i in (0..line.grid.len()).filter(|&i| line.state.status[i].is_active()) {
                line.traction.port_forces[line.grid.port(i)] = forces[line.grid.port(i)];
            }
        }
    }

    /// Opens closed nodes that pull and closes open ones that overlap; returns whether there were any, or yielding has
    /// changed.
    fn close(
        &mut self,
        lines: &mut [ContactLine],
        rules: &Rules,
        thoroughness: Thoroughness,
        iteration: usize,
    ) -> bool {
        let last = iteration >= thoroughness.together;
        let Self { open, forces, gaps, displaced, before, .. } = self;
        take(lines, 1, forces);
        displaced.gaps(lines, 1, forces, gaps);
        let mut changed = false;
        for ((line, open), gaps) in lines.iter_mut().zip(open).zip(gaps) {
            before.clone_from(&line.state.status);
            for (i, (open, gap)) in open.iter().zip(gaps).enumerate() {
                let gap = open.constant + open.motions.dot(line.traction.rigid) + *gap;
                changed |= guess_state(line, i, gap, rules, before);
                if thoroughness.yields {
                    let yields = line.state.status[i].is_active() && yields(line, i, rules.force);
                    changed |= std::mem::replace(&mut line.state.yielded[i], yields) != yields;
                }
                if last && changed {
                    return true;
                }
            }
        }
        changed
    }
}

/// Takes the tangential (`component` 0) or normal forces (1) at all candidates of every line.
fn take(lines: &[ContactLine], component: usize, forces: &mut Vec<Vec<f64>>) {
    forces.resize_with(lines.len(), Vec::new);
    for (line, forces) in lines.iter().zip(forces) {
        forces.clear();
        forces.extend((0..line.grid.len()).map(|i| line.traction.port_forces[line.grid.port(i) + component]));
    }
}

impl Displaced {
    /// Writes the change of the gap at all candidates of every line with tangential (`component` 0) or normal `forces`
    /// (1) at the candidates.
    fn gaps(&mut self, lines: &[ContactLine], component: usize, forces: &[Vec<f64>], gaps: &mut Vec<Vec<f64>>) {
        let Some(ContactLine { grid, problem, .. }) = lines.first() else { return };
        let (relative, first) = (problem.bodies.shared.relative, grid.port(0) + component);
        let Self { mean, ports, alone } = self;
        mean.clear();
        mean.resize(grid.len(), 0.0);
        for (line, forces) in lines.iter().zip(forces) {
            mean.iter_mut().zip(forces).for_each(|(mean, force)| *mean += line.problem.share * force);
        }
        ports.clear();
        ports.resize(grid.ports(), 0.0);
        let begin = mean.iter().position(|force| *force != 0.0).unwrap_or(mean.len());
        let end = mean.iter().rposition(|force| *force != 0.0).map_or(begin, |last| last + 1);
        let columns = relative.as_slice().get((first + 2 * begin) * grid.ports()..).unwrap_or_default();
        add_columns(1.0, columns, 2 * grid.ports(), &mean[begin..end], ports);
        gaps.resize_with(lines.len(), Vec::new);
        for ((line, forces), gaps) in lines.iter().zip(forces).zip(gaps) {
            let of_ports = line.iterate.rim.shared[first..].iter().step_by(2);
            let mut turned: f64 = of_ports.zip(&*mean).map(|(by_force, force)| by_force * force).sum();
            alone.clear();
            alone.resize(grid.ports() / 2, 0.0);
            if let Some(of_line) = line.problem.alone() {
                match component {
                    0 => turned += dot(&line.iterate.rim.alone[first / 2..][..grid.len()], forces),
                    _ => of_line.displace(1, first / 2, forces, alone),
                }
            }
            gaps.clear();
            gaps.extend((0..grid.len()).map(|i| {
                let port = grid.port(i);
                ports[port + 1] + 2.0 * alone[port / 2] - grid.x[i] * turned
            }));
        }
    }
}
