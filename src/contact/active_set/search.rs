//! Exact Coulomb contact by a primal–dual active set (semi-smooth Newton) on the condensed contact problem.
//!
//! Unknown are the nodal forces of closed nodes and those rigid motions (V, U, Ω) that are not prescribed. Each
//! iteration solves the linear problem of the present states and updates the states:
//! - closed if `λ_n − c g > 0`;
//! - a stuck node slips when `|λ_t| > μ λ_n`, and so does a [brake](super::brake) beyond its strength; a slipping node whose friction force no longer opposes the slip sticks, so
//!   a reversal of slip always passes through stick; a node that closes takes the state of its nearest closed neighbour
//!   and sticks where it has none, unless the surfaces run against each other. Without these rules the iteration cycles.
//!
//! Where the friction coefficient depends on the slip, a search around this iteration finds the one that belongs to its own
//! slip ([`super::coefficient`]); each of its evaluations starts from the states found before.
//!
//! An iteration that stalls all the same is restarted as if all nodes had just closed ([`RESTARTS`]), and the tolerance
//! within which a node keeps its state grows from iteration to iteration.

use super::coefficient::CoefficientSearch;
use super::iterate::Iterate;
use crate::contact::error::ContactError;
use crate::contact::line::state::Status;
use crate::contact::line::streamline::upwind_rows;

/// Iterations allowed.
pub const MAX_ITERATIONS: usize = 40;
/// Iterations at which a stalled iteration restarts as if newly closed. Ordinary steps need one to three iterations and the
/// start of sliding from stick up to fourteen, so that only stalled ones get there.
const RESTARTS: [usize; 2] = [20, 31];
/// Iterations after which the tolerance of the states grows, and its growth per iteration.
const STRICT_ITERATIONS: usize = 8;
const GROWTH: f64 = 3.0;
/// Tolerance of nodal forces in mean nodal loads, at first and at most.
pub(super) const FORCE_TOLERANCE: [f64; 2] = [1e-9, 1e-4];
/// Tolerance of slip velocities in rolling speeds, at first and at most.
const SLIP_TOLERANCE: [f64; 2] = [1e-12, 1e-8];
/// Slip velocity of stuck nodes that is round-off: in rolling speeds \[1], in displacements over the step \[1], and in any case
/// [m/s]. Measured with steps of 1 to 10 µs at 2 mm/s: 1e-12 of the displacements over the step.
const SLIP_ROUND_OFF: [f64; 3] = [1e-9, 1e-11, 1e-13];
/// Stuck nodes that carry more than this multiple of what friction allows say nothing about pressures and gaps yet.
const OVERLOAD: f64 = 3.0;
/// Friction coefficients tried: smooth laws need five, steep ones in long steps some tens.
const MAX_COEFFICIENTS: usize = 150;
/// Largest difference between the turn of the rim and that of the linear problem, which weights it with the forces of the
/// iterate before [rad]. It tilts the gap by less than a tenth of a nanometre; ordinary steps differ by 4e-10.
const ANGLE_TOLERANCE: f64 = 1e-8;

impl Iterate<'_> {
    /// Iterates from the states and forces of the start to the solution.
    pub fn run(mut self) -> Result<(), ContactError> {
        self.traction.rigid = self.problem.rigid.map(|motion| motion.start());
        self.prepare();
        self.update_retarded();
        if self.problem.time.is_stationary() {
            self.found_anew();
        }
        let (penalty, friction) = (self.penalty(), self.problem.friction);
        self.guess_closed(penalty);
        self.traction.friction = friction.coefficient(self.traction.tread_slip);
        self.update_upwind();
        self.surface_angle = self.frame.angle_of(&self.traction.surface[0], &self.traction.port_forces);
        self.frame.rim_angle = self.predicted_angle();
        self.traction.iterations = self.find_states(penalty)?;
        self.traction.tread_slip = self.mean_slip();
        if friction.varies() {
            self.find_coefficient(penalty)?;
        }
        self.check_zone()?;
        self.finish();
        Ok(())
    }

    /// Finds the states of all nodes at the present friction coefficient; returns the iterations made.
    fn find_states(&mut self, penalty: f64) -> Result<usize, ContactError> {
        let (mut settled, mut decided) = (false, 0);
        for iteration in 1..=MAX_ITERATIONS {
            if RESTARTS.contains(&iteration) {
                self.state.status.iter_mut().filter(|s| s.is_active()).for_each(|s| *s = Status::Stick);
                self.found_anew();
            }
            self.solve_linear()?;
            let turned = (self.frame.rim_angle - self.scratch.rim_angle.expected).abs() > ANGLE_TOLERANCE;
            let changed = self.update_states(penalty, iteration);
            // Once states and edges are settled, only motions and turn are refined: smooth functions of the data.
            decided += usize::from(!settled);
            settled = !changed && (settled || self.edges_settled());
            let late = self.update_retarded() && self.problem.rigid[2].target().is_none();
            if settled && !turned && !late && self.sticks() {
                return Ok(decided);
            }
        }
        Err(ContactError::NotConverged { iterations: MAX_ITERATIONS })
    }

    /// Finds the coefficient that the law gives to the slip of the states that it leads to.
    fn find_coefficient(&mut self, penalty: f64) -> Result<(), ContactError> {
        let friction = self.problem.friction;
        let mut search = CoefficientSearch::new(friction.bounds());
        for _ in 0..MAX_COEFFICIENTS {
            let law = friction.coefficient(self.traction.tread_slip);
            let Some(next) = search.next(self.traction.friction, law) else { return Ok(()) };
            self.traction.friction = next;
            self.find_states(penalty)?;
            self.traction.tread_slip = self.mean_slip();
        }
        Err(ContactError::NotConverged { iterations: MAX_COEFFICIENTS })
    }

    /// Mean slip velocity of the closed nodes [m/s], weighted with their normal forces. It is that of the friction law, with
    /// upwind differences, which vanishes where nodes stick.
    fn mean_slip(&self) -> f64 {
        let (mut sum, mut load) = (0.0, 0.0);
        for (i, status) in self.state.status.iter().enumerate() {
            let weight = self.normal(i).max(0.0);
            load += weight;
            // What is left of the slip at stuck nodes is round-off.
            sum += if *status == Status::Stick { 0.0 } else { weight * self.state.slip[i] };
        }
        if load > 0.0 { sum / load } else { 0.0 }
    }

    /// Turn of the rim [rad] if it goes on turning as it does.
    fn predicted_angle(&self) -> f64 {
        let (turn, time) = (&self.state.rim_angle, &self.problem.time);
        if time.is_stationary() { turn.now } else { (turn.rate - turn.offset(time)) / time.a0 }
    }

    /// State of a node without a past or a neighbour: it sticks, unless the surfaces run against each other, and that by
    /// more than a cell in the step. There sticking needs strains of order one; where both velocities are about opposite
    /// (`rΩ = −V`) its equation even loses its force coefficients, and their sign is no direction of friction.
    fn founding_state(&self) -> Status {
        let (v, rim) = (self.traction.rigid[0], self.rim_velocity());
        if v * rim >= 0.0 || (v - rim).abs() <= self.problem.time.a0 * self.grid.spacing {
            Status::Stick
        } else if v < rim {
            Status::SlipForward
        } else {
            Status::SlipBackward
        }
    }

    /// Gives all stuck nodes the state of founding ones.
    fn found_anew(&mut self) {
        let founding = self.founding_state();
        self.state.status.iter_mut().filter(|s| **s == Status::Stick).for_each(|s| *s = founding);
    }

    /// Mean stiffness of the nodes [N/m per m]: it compares gaps with forces.
    fn penalty(&self) -> f64 {
        let stiffness = |i: usize| {
            let port = self.grid.port(i) + 1;
            self.problem.bodies.relative[(port, port)]
        };
        self.grid.len() as f64 / (0..self.grid.len()).map(stiffness).sum::<f64>()
    }

    /// Whether the edges of the patches are settled. The weights of the present solution are kept if so: with weights that
    /// change from one coefficient to the next the slip would be no function of the coefficient.
    fn edges_settled(&mut self) -> bool {
        let settled = self.update_upwind() <= self.problem.edge_tolerance;
        if settled {
            std::mem::swap(&mut self.scratch.upwind, &mut self.scratch.upwind_before);
        }
        settled
    }

    /// Upwind weights of the present states and pressures; returns their largest change.
    fn update_upwind(&mut self) -> f64 {
        let to_right = self.upstream_right();
        let (grid, forces) = (self.grid, &self.traction.port_forces);
        std::mem::swap(&mut self.scratch.upwind, &mut self.scratch.upwind_before);
        let pressure = |i: usize| forces[grid.port(i) + 1] * grid.share(i);
        upwind_rows(&self.state.status, pressure, to_right, &mut self.scratch.upwind);
        let pairs = self.scratch.upwind.iter().zip(&self.scratch.upwind_before);
        pairs.map(|(now, before)| (now.w1 - before.w1).abs()).fold(0.0, f64::max)
    }

    /// Whether the stuck nodes do not slip, round-off apart: their rows are linearised in V and Ω. In short steps of slow
    /// wheels the rate of the displacements, new less known ones over the step, has the larger round-off.
    fn sticks(&self) -> bool {
        let rate = self.problem.time.a0 * self.traction.surface.iter().map(|u| u.amax()).fold(0.0, f64::max);
        let round_off = SLIP_ROUND_OFF[0] * self.speed() + SLIP_ROUND_OFF[1] * rate + SLIP_ROUND_OFF[2];
        let stuck = self.state.status.iter().zip(&self.state.slip).filter(|(status, _)| **status == Status::Stick);
        stuck.map(|(_, slip)| slip.abs()).fold(0.0, f64::max) <= round_off
    }

    /// New states from forces, gaps and slips; returns whether any changed.
    fn update_states(&mut self, penalty: f64, iteration: usize) -> bool {
        let growth = GROWTH.powi(iteration.saturating_sub(STRICT_ITERATIONS) as i32);
        let share = self.problem.nominal_load / self.grid.len() as f64;
        let force = (FORCE_TOLERANCE[0] * growth).min(FORCE_TOLERANCE[1]) * share;
        let slip = (SLIP_TOLERANCE[0] * growth).min(SLIP_TOLERANCE[1]) * self.speed();
        self.scratch.status_before.clone_from(&self.state.status);
        let overloaded = self.overloaded();
        let mut changed = false;
        for i in 0..self.grid.len() {
            let old = self.scratch.status_before[i];
            let indicator = self.normal(i) - penalty * self.state.gap[i];
            let closed = if overloaded || indicator.abs() <= force { old.is_active() } else { indicator > 0.0 };
            let new = match (closed, old) {
                (false, _) => Status::Open,
                (true, Status::Open) => self.closing_state(i, iteration),
                (true, Status::Stick) => self.stuck_state(i, force),
                (true, slipping) => self.slipping_state(i, slipping, slip),
            };
            let yields = new.is_active() && self.yields(i, force);
            changed |= new != old || yields != self.state.yielded[i];
            self.state.status[i] = new;
            self.state.yielded[i] = yields;
        }
        let braked = self.update_brakes(force * self.grid.len() as f64);
        self.support() || changed || braked
    }

    /// State of a node that has stuck: it slips where friction cannot hold it.
    fn stuck_state(&self, i: usize, tolerance: f64) -> Status {
        let (t, n, friction) = (self.tangential(i), self.normal(i), self.coefficient(i));
        if t.abs() <= friction * n + tolerance * friction.min(1.0) && friction > 0.0 {
            Status::Stick
        } else if t >= 0.0 {
            Status::SlipForward
        } else {
            Status::SlipBackward
        }
    }

    /// State of a node that has slipped: it sticks where friction no longer opposes the slip.
    fn slipping_state(&self, i: usize, slipping: Status, tolerance: f64) -> Status {
        let opposes = slipping.friction_direction() * self.state.slip[i] <= tolerance;
        if opposes || self.coefficient(i) == 0.0 { slipping } else { Status::Stick }
    }

    /// Closes the nearest node where a static problem has no support; returns whether it did.
    fn support(&mut self) -> bool {
        let height = &self.problem.rigid[1];
        let supported = height.gain != 0.0 || height.target().is_some();
        if supported || self.state.status.iter().any(|s| s.is_active()) {
            return false;
        }
        let gap = &self.state.gap;
        let nearest = (0..self.grid.len()).min_by(|&a, &b| gap[a].total_cmp(&gap[b]));
        if let Some(i) = nearest {
            self.state.status[i] = self.founding_state();
        }
        nearest.is_some()
    }

    /// Whether the stuck nodes carry far more than friction allows, as happens when sliding starts from stick: normal
    /// forces and gaps then mean nothing yet.
    fn overloaded(&self) -> bool {
        let nodes = 0..self.grid.len();
        let limit: f64 = nodes.clone().map(|i| self.normal(i).max(0.0)).sum::<f64>() * self.traction.friction;
        let stuck = nodes.filter(|&i| self.state.status[i] == Status::Stick).map(|i| self.tangential(i).abs());
        stuck.sum::<f64>() > OVERLOAD * limit && self.traction.friction > 0.0
    }

    /// State of a node that has just closed: that of the nearest closed node, or its own where it founds a patch, as
    /// between the two restarts.
    pub(super) fn closing_state(&self, i: usize, iteration: usize) -> Status {
        if (RESTARTS[0]..RESTARTS[1]).contains(&iteration) {
            return self.founding_state();
        }
        let before = &self.scratch.status_before;
        let left = before[..i].iter().rev().position(|s| s.is_active());
        let right = before[i + 1..].iter().position(|s| s.is_active());
        match (left, right) {
            (Some(l), Some(r)) if r < l => before[i + 1 + r],
            (Some(l), _) => before[i - 1 - l],
            (None, Some(r)) => before[i + 1 + r],
            (None, None) => self.founding_state(),
        }
    }
}
