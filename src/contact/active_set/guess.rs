//! Guess of the closed nodes on uneven surfaces, from which the active set starts.
//!
//! New material comes under the contact in every step, so that the edges of the patches move, and the search for all
//! states takes two or three iterations where on smooth surfaces it takes one. Pressures hardly depend on the shear. So
//! closed nodes and normal forces are first found by themselves, with the shear forces and velocities of before. The
//! guess decides nothing; where it fails the search starts from the states of before. Without it every result takes
//! longer and is the same but for the tolerance of the edges: forces on a rough rail change by 1.4e-5.

use super::axes::{Axes, Equation};
use super::fast::LinearSolver;
use super::linear::{Known, LinearProblem};
use super::states::{Rules, guess_state};
use super::unknowns::Unknowns;
use crate::contact::line::contact_line::ContactLine;
use crate::contact::line::state::NodeStatus;
use crate::linalg::vectorised::{add_columns, dot};
use nalgebra::DVector;

/// Guesses of the closed nodes at most.
const MAX_GUESSES: usize = 6;

/// Memory of the guess.
#[derive(Default)]
pub struct Guess {
    unknowns: Unknowns,
    /// Shear forces before the guess, and the gap by them.
    known: Known,
    /// Gaps at the candidates of every line under these forces alone.
    open: Vec<Vec<Equation>>,
    /// Forces of one component at the candidates of every line [N/m].
    forces: Vec<Vec<f64>>,
    /// Gap by them at the candidates of every line \[m].
    gaps: Vec<Vec<f64>>,
    displaced: Displaced,
    starts: Vec<LineBefore>,
    /// States before an update.
    before: Vec<NodeStatus>,
}

/// A line before the guess.
#[derive(Default)]
struct LineBefore {
    status: Vec<NodeStatus>,
    port_forces: DVector<f64>,
    height: f64,
}

impl LineBefore {
    fn take(&mut self, line: &ContactLine) {
        self.status.clone_from(&line.state.status);
        self.port_forces.clone_from(&line.traction.port_forces);
        self.height = line.traction.rigid.height;
    }

    fn give_back(&self, line: &mut ContactLine) {
        line.state.status.clone_from(&self.status);
        line.traction.port_forces.clone_from(&self.port_forces);
        line.traction.rigid.height = self.height;
    }
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

impl Guess {
    /// Sets closed nodes, gaps, normal forces and height of the hub to those that belong to the shear forces and
    /// velocities at hand, where the surfaces are uneven. `rows` is memory for the coefficients of all ports.
    pub fn find(
        &mut self,
        lines: &mut [ContactLine],
        axes: &Axes,
        rules: &Rules,
        solver: &mut LinearSolver,
        rows: &mut [Vec<f64>],
    ) {
        let skipped = |line: &ContactLine| line.given.rail_slope.is_empty() || line.problem.time.is_stationary();
        if lines.iter().all(skipped) {
            return;
        }
        self.starts.resize_with(lines.len(), LineBefore::default);
        self.starts.iter_mut().zip(&*lines).for_each(|(start, line)| start.take(line));
        lines.iter_mut().for_each(ContactLine::update_rim);
        self.take_shear(lines, axes);
        for _ in 0..MAX_GUESSES {
            self.unknowns.list_pressures(lines, axes);
            let problem = LinearProblem { axes, unknowns: &self.unknowns, known: &self.known };
            let pressed = solver.solve(lines, problem, rows).is_ok();
            self.give_shear(lines);
            if pressed && !self.close(lines, rules) {
                return;
            }
            if self.unknowns.closed() == 0 {
                break;
            }
        }
        self.starts.iter().zip(lines).for_each(|(start, line)| start.give_back(line));
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

    /// Opens closed nodes that pull and closes open ones that overlap; returns whether there were any.
    fn close(&mut self, lines: &mut [ContactLine], rules: &Rules) -> bool {
        let Self { open, forces, gaps, displaced, before, .. } = self;
        take(lines, 1, forces);
        displaced.gaps(lines, 1, forces, gaps);
        let mut changed = false;
        for ((line, open), gaps) in lines.iter_mut().zip(open).zip(gaps) {
            before.clone_from(&line.state.status);
            for (i, (open, gap)) in open.iter().zip(gaps).enumerate() {
                let gap = open.constant + open.motions.dot(line.traction.rigid) + *gap;
                changed |= guess_state(line, i, gap, rules, before);
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
