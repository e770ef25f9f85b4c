//! Linear problem of any lines, solved line by line.
//!
//! Lines feel each other through the bodies and the motions of the hub alone, and what the bodies pass on is smooth. So
//! the equations of each line are factorised by themselves, the motions follow from their balances, and the forces of
//! the other lines from an iteration (GMRES) to which all of this is a good approximation: four lines cost four times
//! as much as one, not 64 times.

use crate::axes::Axis;
use crate::contact::active_set::linear::LinearProblem;
use crate::contact::active_set::unknowns::{LineUnknowns, Unknowns, scale};
use crate::contact::flexibility::{ByMoments, ByPowers, add, at};
use crate::contact::line::ContactGrid;
use crate::contact::line::contact_line::ContactLine;
use crate::contact::line::rows::NodeEquation;
use crate::linalg::DenseSystem;
use crate::linalg::gmres::{Gmres, LinearSystem};
use crate::linalg::vectorised::dot;
use std::ops::Range;

/// Change of the forces that counts as none, and that which is accepted where round-off allows no smaller one, over
/// their norm \[1].
const PRECISION: [f64; 2] = [1e-14, 1e-11];

/// Equations of all lines, and the memory to solve them.
#[derive(Default)]
pub struct LineByLine {
    lines: Vec<LineEquations>,
    motions: MotionBalances,
    /// Ports from the first to the last closed node of all lines.
    window: Range<usize>,
    /// Forces of all lines at these ports, by their shares of the width [N/m].
    mean: Vec<f64>,
    /// Forces of all lines, then the motions.
    unknowns: Vec<f64>,
    /// Their change.
    change: Vec<f64>,
    gmres: Gmres,
}

/// Equations of one line.
#[derive(Default)]
struct LineEquations {
    /// Share of the width \[1].
    share: f64,
    /// Coefficients of its own forces.
    own: DenseSystem,
    /// Own forces without those of other lines at the present motions, and their change with the motions.
    alone: Vec<f64>,
    by_motions: [Vec<f64>; Axis::COUNT],
    /// Coefficients of other lines' forces at the ports of the window, row by row.
    shared: Vec<f64>,
    /// Slips by unit moments of every line of the patch, in which the own ones are none; empty: there is no patch.
    by_lines: Vec<ByMoments>,
    /// Powers of the places of the closed nodes, and those of the stuck ones beside the factors of their equations
    /// \[1].
    places: Vec<ByPowers>,
    stuck: Vec<(ByPowers, f64)>,
    /// Moments of the own forces [N/m].
    moments: ByPowers,
    /// Coefficients of the own forces in the balances.
    balances: [Vec<f64>; Axis::COUNT],
    /// Forces at all ports, those within the window [N/m].
    forces: Vec<f64>,
    /// An equation.
    row: Vec<f64>,
}

/// Balances of the motions that are sought.
#[derive(Default)]
struct MotionBalances {
    count: usize,
    /// Coefficients of the motions once the forces are eliminated.
    system: DenseSystem,
    known: [f64; Axis::COUNT],
    /// Changes of the motions.
    changes: [f64; Axis::COUNT],
}

impl LineByLine {
    /// Solves a linear problem and gives the lines their forces and motions; `false`: it takes all equations together.
    /// `rows` is memory for the coefficients of all ports of every line.
    pub fn solve(&mut self, lines: &mut [ContactLine], problem: LinearProblem, rows: &mut [Vec<f64>]) -> bool {
        let solved = self.write(lines, problem, rows) && self.find(lines[0].grid, problem.unknowns);
        if solved {
            problem.unknowns.accept(&self.unknowns, lines, problem.axes);
        }
        solved
    }

    /// Writes all equations, and the present forces as a guess; whether those of every line have a solution.
    fn write(&mut self, lines: &[ContactLine], problem: LinearProblem, rows: &mut [Vec<f64>]) -> bool {
        let Some(grid) = lines.first().map(|line| line.grid) else { return false };
        let unknowns = &problem.unknowns.lines;
        let windows = unknowns.iter().map(|line| line.window(grid)).filter(|window| !window.is_empty());
        let Some(window) = windows.reduce(|a, b| a.start.min(b.start)..a.end.max(b.end)) else { return false };
        self.window = window;
        self.lines.resize_with(lines.len(), LineEquations::default);
        self.unknowns.clear();
        for (k, equations) in self.lines.iter_mut().enumerate() {
            if !equations.write(k, lines, problem, &self.window, &mut rows[k]) {
                return false;
            }
            equations.write_patch(k, &unknowns[k], lines);
            let present = unknowns[k].closed.iter().map(|&i| lines[k].normal(i));
            self.unknowns.extend(present.chain(unknowns[k].stuck.iter().map(|&i| lines[k].tangential(i))));
        }
        self.write_balances(lines, problem, rows)
    }

    /// Writes the balances, from which the forces are eliminated; whether they have a solution.
    fn write_balances(&mut self, lines: &[ContactLine], problem: LinearProblem, rows: &mut [Vec<f64>]) -> bool {
        let (Self { lines: equations, motions, .. }, unknowns) = (self, problem.unknowns);
        motions.count = unknowns.axes.len();
        motions.system.reset(motions.count);
        for (a, &axis) in unknowns.axes.iter().enumerate() {
            let balance = problem.balance(axis, lines, rows);
            let (coefficients, _) = motions.system.row(a);
            coefficients.iter_mut().zip(&unknowns.axes).for_each(|(value, &axis)| *value = balance.motions[axis]);
            for ((line, own), row) in equations.iter_mut().zip(&unknowns.lines).zip(&*rows) {
                let LineEquations { balances, by_motions, .. } = line;
                balances[a].resize(own.len(), 0.0);
                own.write(&mut balances[a], row, lines[0].grid);
                coefficients.iter_mut().zip(by_motions).for_each(|(value, by)| *value -= dot(&balances[a], by));
            }
            let scale = scale(coefficients);
            equations.iter_mut().for_each(|line| line.balances[a].iter_mut().for_each(|value| *value *= scale));
            motions.known[a] = -LinearProblem::left_over(&balance, &lines[0]) * scale;
        }
        motions.system.factorise()
    }

    /// Solves for all forces and motions; `false`: the iteration does not converge.
    fn find(&mut self, grid: &ContactGrid, unknowns: &Unknowns) -> bool {
        let mut forces = std::mem::take(&mut self.unknowns);
        let mut change = std::mem::take(&mut self.change);
        change.clear();
        change.resize(forces.len(), 0.0);
        let mut solved = self.answer(grid, unknowns, &forces, true, &mut change);
        if solved {
            change.iter_mut().zip(&forces).for_each(|(change, force)| *change -= force);
            let norm = |values: &[f64]| dot(values, values).sqrt();
            let [most, size] = [norm(&change), norm(&forces).max(norm(&change))];
            let mut gmres = std::mem::take(&mut self.gmres);
            let [tolerance, accepted] = PRECISION.map(|precision| precision * size / most);
            let mut system = BetweenLines { equations: self, grid, unknowns };
            solved = most <= PRECISION[0] * size || gmres.solve(&mut system, &mut change, tolerance, accepted).is_ok();
            self.gmres = gmres;
            forces.iter_mut().zip(&change).for_each(|(force, change)| *force += change);
            // Once more with the motions, which belong to these forces.
            solved = solved && self.answer(grid, unknowns, &forces, true, &mut change);
            std::mem::swap(&mut forces, &mut change);
        }
        forces.extend(&self.motions.changes[..self.motions.count]);
        (self.unknowns, self.change) = (forces, change);
        solved
    }

    /// Writes the forces of all lines that belong to given ones of the others, and takes the motions; those without
    /// the `known` part of the equations are their change. Whether all are finite.
    fn answer(
        &mut self,
        grid: &ContactGrid,
        unknowns: &Unknowns,
        given: &[f64],
        known: bool,
        forces: &mut [f64],
    ) -> bool {
        let Self { lines, motions, window, mean, .. } = self;
        mean.clear();
        mean.resize(window.len(), 0.0);
        let mut rest = given;
        for (line, own) in lines.iter_mut().zip(&unknowns.lines) {
            let (given, others) = rest.split_at(own.len());
            line.place(own, given, grid, window, mean);
            rest = others;
        }
        let moments: Vec<_> = lines.iter().map(|line| line.moments).collect();
        motions.changes = if known { motions.known } else { [0.0; Axis::COUNT] };
        let values = &mut motions.changes[..motions.count];
        let (mut rest, mut finite) = (&mut *forces, true);
        for (line, own) in lines.iter_mut().zip(&unknowns.lines) {
            let (forces, others) = rest.split_at_mut(own.len());
            finite &= line.answer(mean, &moments, window, known, forces);
            values.iter_mut().zip(&line.balances).for_each(|(value, balance)| *value -= dot(balance, forces));
            rest = others;
        }
        finite &= motions.system.solve_with(values);
        let mut rest = forces;
        for (line, own) in lines.iter().zip(&unknowns.lines) {
            let (forces, others) = rest.split_at_mut(own.len());
            for (value, by_motion) in values.iter().zip(&line.by_motions) {
                forces.iter_mut().zip(by_motion).for_each(|(force, by)| *force -= by * value);
            }
            rest = others;
        }
        finite
    }
}

impl LineEquations {
    /// Writes the equations of the line number `k`; whether they have a solution. `forces` is memory for the
    /// coefficients of its ports.
    fn write(
        &mut self,
        k: usize,
        lines: &[ContactLine],
        problem: LinearProblem,
        window: &Range<usize>,
        forces: &mut [f64],
    ) -> bool {
        let (line, own, axes) = (&lines[k], &problem.unknowns.lines[k], &problem.unknowns.axes);
        let (size, patch) = (own.len(), own.window(line.grid));
        self.share = line.problem.share;
        self.own.reset(size);
        self.row.resize(size + axes.len(), 0.0);
        self.alone.resize(size, 0.0);
        self.by_motions.iter_mut().for_each(|values| values.resize(size, 0.0));
        self.shared.clear();
        self.stuck.clear();
        let others = &mut self.forces;
        others.resize(line.grid.ports(), 0.0);
        for (r, (i, kind)) in own.equations().enumerate() {
            kind.by_shared(line, i, 1.0, window.clone(), others);
            let shared = forces[patch.clone()].iter_mut().zip(&others[patch.clone()]);
            shared.for_each(|(force, by_all)| *force = self.share * by_all);
            let equation = problem.equation(k, i, kind, kind.add_own(line, i, patch.clone(), forces));
            let (coefficients, motions) = self.row.split_at_mut(size);
            own.write(coefficients, forces, line.grid);
            motions.iter_mut().zip(axes).for_each(|(value, &axis)| *value = equation.motions[axis]);
            let scale = scale(&mut self.row);
            self.alone[r] = -scale * LinearProblem::left_over(&equation, line);
            self.own.row(r).0.copy_from_slice(&self.row[..size]);
            self.by_motions.iter_mut().zip(&self.row[size..]).for_each(|(by_motion, value)| by_motion[r] = *value);
            self.shared.extend(others[window.clone()].iter().map(|by_all| scale * by_all));
            if let (Some(patch), NodeEquation::Slip) = (line.problem.patch, kind) {
                self.stuck.push((patch.powers(line.grid.x[i]), scale));
            }
        }
        let motions = self.by_motions.iter_mut().take(axes.len());
        self.own.factorise() && motions.chain([&mut self.alone]).all(|side| self.own.solve_with(side))
    }

    /// Takes what the other lines of the patch do to this one, which has the number `k`.
    fn write_patch(&mut self, k: usize, own: &LineUnknowns, lines: &[ContactLine]) {
        let line = &lines[k];
        self.by_lines.clear();
        self.places.clear();
        let Some(patch) = line.problem.patch else { return };
        let by = |by: usize| if by == k { Some(ByMoments::default()) } else { line.slip_by_moments(by) };
        self.by_lines.extend((0..lines.len()).filter_map(by));
        self.places.extend(own.closed.iter().map(|&i| patch.powers(line.grid.x[i])));
    }

    /// Takes the forces of a solution, and adds them to those of all lines at the ports of the window.
    fn place(
        &mut self,
        own: &LineUnknowns,
        forces: &[f64],
        grid: &ContactGrid,
        window: &Range<usize>,
        mean: &mut [f64],
    ) {
        self.forces.resize(grid.ports(), 0.0);
        self.forces[window.clone()].fill(0.0);
        own.place(forces, grid, &mut self.forces);
        mean.iter_mut().zip(&self.forces[window.clone()]).for_each(|(mean, force)| *mean += self.share * force);
        self.moments = ByPowers::default();
        for (&i, place) in own.closed.iter().zip(&self.places) {
            let force = self.forces[grid.port(i)];
            self.moments.iter_mut().zip(place).for_each(|(moment, power)| *moment += force * power);
        }
    }

    /// Writes the forces that belong to those of the other lines; whether they are finite. `mean`: forces of all lines,
    /// `moments`: those of every line.
    fn answer(
        &mut self,
        mean: &[f64],
        moments: &[ByPowers],
        window: &Range<usize>,
        known: bool,
        forces: &mut [f64],
    ) -> bool {
        let others = &mut self.forces[window.clone()];
        others.iter_mut().zip(mean).for_each(|(force, mean)| *force = mean - self.share * *force);
        let rows = self.shared.chunks_exact(window.len());
        forces.iter_mut().zip(rows).for_each(|(force, row)| *force = -dot(row, others));
        let mut slip = ByPowers::default();
        self.by_lines.iter().zip(moments).for_each(|(by, moments)| add(by, moments, &mut slip));
        let (_, sticking) = forces.split_at_mut(forces.len() - self.stuck.len());
        sticking.iter_mut().zip(&self.stuck).for_each(|(force, (place, scale))| *force -= scale * at(&slip, place));
        let finite = self.own.solve_with(forces);
        if known {
            forces.iter_mut().zip(&self.alone).for_each(|(force, alone)| *force += alone);
        }
        finite
    }
}

/// Change of the forces by those of the other lines.
struct BetweenLines<'a> {
    equations: &'a mut LineByLine,
    grid: &'a ContactGrid,
    unknowns: &'a Unknowns,
}

impl LinearSystem for BetweenLines<'_> {
    fn apply(&mut self, x: &[f64], out: &mut [f64]) {
        // What is not finite ends the iteration.
        self.equations.answer(self.grid, self.unknowns, x, false, out);
        out.iter_mut().zip(x).for_each(|(out, x)| *out = x - *out);
    }

    fn precondition(&mut self, _: &mut [f64]) {}
}
