//! Guess of the closed nodes of several lines on uneven surfaces: as [`super::initial_guess`] for a single one, but
//! with the gaps of all lines and the balance of the height solved [line by line](super::line_by_line).

use super::line_by_line::{self, Known, LineByLine};
use crate::axes::Axis;
use crate::contact::active_set::axes::Axes;
use crate::contact::active_set::states::{Comparison, guess_state};
use crate::contact::active_set::unknowns::Unknowns;
use crate::contact::line::contact_line::ContactLine;
use crate::contact::line::state::NodeStatus;
use crate::linalg::vectorised::{add_columns, dot};
use nalgebra::DVector;

/// Guesses of the closed nodes at most.
const MAX_GUESSES: usize = 6;

/// Memory of the guess.
#[derive(Default)]
pub struct GuessOfLines {
    unknowns: Unknowns,
    /// Shear forces before the guess, and the gap by them.
    known: Known,
    /// Forces of one component at the candidates of every line [N/m].
    forces: Vec<Vec<f64>>,
    /// Gap by them at the candidates of every line \[m].
    gaps: Vec<Vec<f64>>,
    displaced: Displaced,
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

impl GuessOfLines {
    /// Sets closed nodes, gaps, normal forces and height of the hub to those that belong to the shear forces and
    /// velocities at hand, where the surfaces are uneven. `rows` is memory for the coefficients of all ports.
    pub fn find(
        &mut self,
        lines: &mut [ContactLine],
        axes: &Axes,
        comparison: Comparison,
        (rows, equations): (&mut [Vec<f64>], &mut LineByLine),
    ) {
        let skipped = |line: &ContactLine| line.given.rail_slope.is_empty() || line.problem.time.is_stationary();
        if lines.iter().all(skipped) {
            return;
        }
        type Start = (Vec<NodeStatus>, DVector<f64>, f64);
        let of_line = |line: &ContactLine| {
            (line.state.status.clone(), line.traction.port_forces.clone(), line.traction.rigid.height)
        };
        let starts: Vec<Start> = lines.iter().map(of_line).collect();
        if self.settle(lines, axes, comparison, (rows, equations)) {
            return;
        }
        for (line, (status, forces, height)) in lines.iter_mut().zip(starts) {
            line.state.status = status;
            line.traction.port_forces = forces;
            line.traction.rigid.height = height;
        }
    }

    /// Guesses until the closed nodes stay; `false` if nothing is closed or they do not.
    fn settle(
        &mut self,
        lines: &mut [ContactLine],
        axes: &Axes,
        comparison: Comparison,
        (rows, equations): (&mut [Vec<f64>], &mut LineByLine),
    ) -> bool {
        lines.iter_mut().for_each(ContactLine::update_rim);
        self.take_shear(lines);
        for _ in 0..MAX_GUESSES {
            self.unknowns.list_pressures(lines, axes);
            let known = (&self.unknowns, &self.known);
            let pressed = line_by_line::solve(lines, axes, known, rows, equations);
            self.give_shear(lines);
            if pressed && !self.close(lines, axes, comparison) {
                return true;
            }
            if self.unknowns.closed() == 0 {
                break;
            }
        }
        false
    }

    /// Takes the shear forces, and the gap by them.
    fn take_shear(&mut self, lines: &[ContactLine]) {
        let Self { known, forces, displaced, .. } = self;
        known.forces.resize_with(lines.len(), Vec::new);
        for (line, ports) in lines.iter().zip(&mut known.forces) {
            ports.clear();
            ports.resize(line.grid.ports(), 0.0);
            (0..line.grid.len()).for_each(|i| ports[line.grid.port(i)] = line.tangential(i));
        }
        take(lines, 0, forces);
        displaced.gaps(lines, 0, forces, &mut known.gaps);
    }

    /// Gives closed nodes the shear forces of before.
    fn give_shear(&self, lines: &mut [ContactLine]) {
        for (line, forces) in lines.iter_mut().zip(&self.known.forces) {
            for i in (0..line.grid.len()).filter(|&i| line.state.status[i].is_active()) {
                line.traction.port_forces[line.grid.port(i)] = forces[line.grid.port(i)];
            }
        }
    }

    /// Opens closed nodes that pull and closes open ones that overlap; returns whether there were any.
    fn close(&mut self, lines: &mut [ContactLine], axes: &Axes, comparison: Comparison) -> bool {
        let Self { known, forces, gaps, displaced, before, .. } = self;
        take(lines, 1, forces);
        displaced.gaps(lines, 1, forces, gaps);
        let mut changed = false;
        for ((line, known), gaps) in lines.iter_mut().zip(&known.gaps).zip(gaps) {
            before.clone_from(&line.state.status);
            for i in 0..line.grid.len() {
                let equation = axes.equation(line.gap_terms(i));
                let sought = Axis::ALL.into_iter().filter(|&axis| axes.seeks(axis));
                let by_motions: f64 = sought.map(|axis| equation.motions[axis] * line.traction.rigid[axis]).sum();
                let gap = axes.constant(&equation) + by_motions + known[i] + gaps[i];
                changed |= guess_state(line, i, gap, comparison, before);
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
        let columns = &relative.as_slice()[first * grid.ports()..];
        add_columns(1.0, columns, 2 * grid.ports(), mean, ports);
        gaps.resize_with(lines.len(), Vec::new);
        for ((line, forces), gaps) in lines.iter().zip(forces).zip(gaps) {
            let of_ports = line.rim.shared[first..].iter().step_by(2);
            let mut turned: f64 = of_ports.zip(&*mean).map(|(by_force, force)| by_force * force).sum();
            alone.clear();
            alone.resize(grid.ports() / 2, 0.0);
            if let Some(of_line) = line.problem.alone() {
                match component {
                    0 => turned += dot(&line.rim.alone[first / 2..][..grid.len()], forces),
                    _ => of_line.displace(1, (first / 2, forces), alone),
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
