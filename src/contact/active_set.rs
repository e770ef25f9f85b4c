//! Exact Coulomb contact by a primal–dual active set (semi-smooth Newton) on the condensed contact problem.
//!
//! Unknown are the nodal forces of closed nodes and those rigid motions (V, U, Ω) that are not prescribed. Each
//! iteration solves the linear problem of the present states and updates the states:
//! - closed if `λ_n − c g > 0`;
//! - a stuck node slips when `|λ_t| > μ λ_n`; a slipping node whose friction force no longer opposes the slip sticks, so
//!   a reversal of slip always passes through stick, and a node that closes starts in stick. Without these two rules
//!   the iteration cycles.

use super::Status;
use super::problem::{AffineRow, ContactProblem, ContactSolution};
use super::streamline::{Upwind, upwind_rows};
use nalgebra::{DMatrix, DVector};

/// Iterations allowed.
pub const MAX_ITERATIONS: usize = 40;
/// Iterations at which a stalled iteration restarts from full stick.
const RESTARTS: [usize; 2] = [20, 31];

/// Why no contact state could be found.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ContactError {
    #[error("contact iteration did not converge in {iterations} iterations")]
    NotConverged { iterations: usize },
    #[error("singular contact equations with {closed} closed nodes")]
    Singular { closed: usize },
    #[error("the contact patch reached the end of the candidate zone (±{zone:.3e} m) at a line load of {load:.6e} N/m")]
    ZoneExceeded { zone: f64, load: f64 },
}

impl ContactProblem<'_> {
    /// Solves from the states, forces and rigid values of `start`.
    pub fn solve(&self, start: &ContactSolution) -> Result<ContactSolution, ContactError> {
        let mut solution = start.clone();
        solution.radius = self.radius;
        for (k, motion) in self.rigid.iter().enumerate() {
            solution.rigid[k] = motion.value;
        }
        let constants = self.constant_displacements();
        let relative = self.wheel.compliance + self.rail.compliance;
        let c_n = self.grid.len() as f64 / (0..self.grid.len()).map(|i| self.diagonal(&relative, i)).sum::<f64>();
        let mut to_right = self.upstream_right(&solution.rigid);
        let mut rows = self.rows(&solution, to_right);

        for iteration in 1..=MAX_ITERATIONS {
            if RESTARTS.contains(&iteration) {
                for s in &mut solution.status {
                    if s.is_active() {
                        *s = Status::Stick;
                    }
                }
            }
            self.solve_linear(&mut solution, &relative, &constants, &rows, to_right)?;
            solution.iterations = iteration;

            let changed = self.update_states(&mut solution, c_n, iteration);
            to_right = self.upstream_right(&solution.rigid);
            let new_rows = self.rows(&solution, to_right);
            let edge_change = rows.iter().zip(&new_rows).map(|(a, b)| (a.w1 - b.w1).abs()).fold(0.0, f64::max);
            rows = new_rows;
            let scale = solution.rigid[0].abs() + (self.radius * solution.rigid[2]).abs();
            let slip_error = (0..self.grid.len())
                .filter(|&i| solution.status[i] == Status::Stick)
                .map(|i| solution.slip[i].abs())
                .fold(0.0, f64::max);
            if !changed && edge_change <= self.edge_tolerance && slip_error <= 1e-9 * scale + 1e-13 {
                return self.check_zone(solution);
            }
        }
        Err(ContactError::NotConverged { iterations: MAX_ITERATIONS })
    }

    fn rows(&self, solution: &ContactSolution, to_right: bool) -> Vec<Upwind> {
        let pressure: Vec<f64> = (0..self.grid.len()).map(|i| solution.normal(self.grid, i)).collect();
        upwind_rows(&solution.status, &pressure, to_right)
    }

    /// Solves the linear problem of the present states; fills forces, rigid values, displacements, slips and gaps.
    fn solve_linear(
        &self,
        solution: &mut ContactSolution,
        relative: &DMatrix<f64>,
        wheel_constant: &DVector<f64>,
        rows: &[Upwind],
        to_right: bool,
    ) -> Result<(), ContactError> {
        let grid = self.grid;
        let closed: Vec<usize> = (0..grid.len()).filter(|&i| solution.status[i].is_active()).collect();
        let stuck: Vec<usize> = closed.iter().copied().filter(|&i| solution.status[i] == Status::Stick).collect();
        let unknown: Vec<usize> = (0..3).filter(|&k| !self.rigid[k].prescribed).collect();
        let size = closed.len() + stuck.len() + unknown.len();
        let fixed = solution.rigid;

        let mut system = DMatrix::zeros(size, size);
        let mut rhs = DVector::zeros(size);
        let mut put = |r: usize, row: &AffineRow| {
            let mut constant = row.constant;
            let mut largest = 0.0f64;
            for (c, &i) in closed.iter().enumerate() {
                let d = grid.dof(i);
                let value = row.forces[d + 1] + solution.status[i].friction_direction() * self.friction * row.forces[d];
                system[(r, c)] = value;
                largest = largest.max(value.abs());
            }
            for (c, &i) in stuck.iter().enumerate() {
                let value = row.forces[grid.dof(i)];
                system[(r, closed.len() + c)] = value;
                largest = largest.max(value.abs());
            }
            for k in 0..3 {
                if self.rigid[k].prescribed {
                    constant += row.rigid[k] * self.rigid[k].value;
                }
            }
            for (c, &k) in unknown.iter().enumerate() {
                system[(r, closed.len() + stuck.len() + c)] = row.rigid[k];
                largest = largest.max(row.rigid[k].abs());
            }
            let scale = if largest > 0.0 { 1.0 / largest } else { 1.0 };
            for c in 0..size {
                system[(r, c)] *= scale;
            }
            rhs[r] = -constant * scale;
        };
        for (r, &i) in closed.iter().enumerate() {
            put(r, &self.gap_row(i, relative, wheel_constant));
        }
        for (r, &i) in stuck.iter().enumerate() {
            put(closed.len() + r, &self.slip_row(i, solution, relative, wheel_constant, rows[i], to_right));
        }
        for (r, &k) in unknown.iter().enumerate() {
            put(closed.len() + stuck.len() + r, &self.balance_row(k, solution));
        }
        let singular = ContactError::Singular { closed: closed.len() };
        // Nothing is unknown when a wheel with prescribed motions is off the rail.
        let x = if size == 0 { rhs } else { system.lu().solve(&rhs).ok_or(singular.clone())? };
        if x.iter().any(|v| !v.is_finite()) {
            return Err(singular);
        }

        solution.forces.fill(0.0);
        for (c, &i) in closed.iter().enumerate() {
            solution.forces[grid.dof(i) + 1] = x[c];
            solution.forces[grid.dof(i)] = solution.status[i].friction_direction() * self.friction * x[c];
        }
        for (c, &i) in stuck.iter().enumerate() {
            solution.forces[grid.dof(i)] = x[closed.len() + c];
        }
        solution.rigid = fixed;
        for (c, &k) in unknown.iter().enumerate() {
            solution.rigid[k] = x[closed.len() + stuck.len() + c];
        }
        self.evaluate(solution, wheel_constant, rows, to_right);
        Ok(())
    }

    /// New states from forces, gaps and slips; returns whether any changed.
    fn update_states(&self, solution: &mut ContactSolution, c_n: f64, iteration: usize) -> bool {
        let grid = self.grid;
        let growth = 3f64.powi(iteration.saturating_sub(8) as i32);
        let share = self.nominal_load / grid.len() as f64;
        let tolerance = (1e-9 * growth).min(1e-4) * share;
        let speed = solution.rigid[0].abs() + (self.radius * solution.rigid[2]).abs();
        let slip_tolerance = (1e-12 * growth).min(1e-8) * speed;
        let before = solution.status.clone();
        let overloaded = self.overloaded(solution);
        let mut changed = false;
        for i in 0..grid.len() {
            let old = before[i];
            let (t, n) = (solution.tangential(grid, i), solution.normal(grid, i));
            let indicator = n - c_n * solution.gap[i];
            let closed = if overloaded || indicator.abs() <= tolerance { old.is_active() } else { indicator > 0.0 };
            let new = match (closed, old) {
                (false, _) => Status::Open,
                (true, Status::Open) => self.closing_state(&before, i, iteration),
                (true, Status::Stick) => {
                    if t.abs() <= self.friction * n + tolerance * self.friction.min(1.0) && self.friction > 0.0 {
                        Status::Stick
                    } else if t >= 0.0 {
                        Status::SlipForward
                    } else {
                        Status::SlipBackward
                    }
                }
                (true, slipping) => {
                    let opposes = slipping.friction_direction() * solution.slip[i] <= slip_tolerance;
                    if opposes || self.friction == 0.0 { slipping } else { Status::Stick }
                }
            };
            changed |= new != old;
            solution.status[i] = new;
        }
        // A static problem needs at least one support.
        if self.rigid[1].gain == 0.0 && !self.rigid[1].prescribed && solution.status.iter().all(|s| !s.is_active()) {
            let nearest = (0..grid.len()).min_by(|&a, &b| solution.gap[a].total_cmp(&solution.gap[b]));
            if let Some(i) = nearest {
                solution.status[i] = Status::Stick;
                changed = true;
            }
        }
        changed
    }

    /// Whether the stuck nodes carry far more than friction allows, as happens when sliding starts from stick: normal
    /// forces and gaps then mean nothing yet.
    fn overloaded(&self, solution: &ContactSolution) -> bool {
        let nodes = 0..self.grid.len();
        let limit: f64 = nodes.clone().map(|i| solution.normal(self.grid, i).max(0.0)).sum::<f64>() * self.friction;
        let stuck: f64 = nodes
            .filter(|&i| solution.status[i] == Status::Stick)
            .map(|i| solution.tangential(self.grid, i).abs())
            .sum();
        stuck > 3.0 * limit && self.friction > 0.0
    }

    /// State of a node that has just closed: that of the nearest closed node, or stick where it founds a patch. Between
    /// the two restarts it always sticks.
    fn closing_state(&self, before: &[Status], i: usize, iteration: usize) -> Status {
        if (RESTARTS[0]..RESTARTS[1]).contains(&iteration) {
            return Status::Stick;
        }
        let left = before[..i].iter().rev().position(|s| s.is_active());
        let right = before[i + 1..].iter().position(|s| s.is_active());
        match (left, right) {
            (Some(l), Some(r)) if r < l => before[i + 1 + r],
            (Some(l), _) => before[i - 1 - l],
            (None, Some(r)) => before[i + 1 + r],
            (None, None) => Status::Stick,
        }
    }

    fn check_zone(&self, solution: ContactSolution) -> Result<ContactSolution, ContactError> {
        let ends = [solution.status.first(), solution.status.last()];
        if ends.iter().flatten().any(|s| s.is_active()) {
            let zone = self.grid.x.last().copied().unwrap_or(0.0);
            let load = solution.resultant(self.grid)[1];
            return Err(ContactError::ZoneExceeded { zone, load });
        }
        Ok(solution)
    }
}
