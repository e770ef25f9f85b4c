//! Exact Coulomb contact by a primal–dual active set (semi-smooth Newton) on the condensed contact problem.
//!
//! Unknown are the nodal forces of closed nodes and those rigid motions (V, U, Ω) that are not prescribed. Each
//! iteration solves the linear problem of the present states and takes new states ([`super::states`]). Where the
//! friction coefficient depends on the slip, a search around this iteration finds the one that belongs to its own slip
//! ([`super::coefficient`]); each of its evaluations starts from the states found before.
//!
//! An iteration that stalls all the same is restarted as if all nodes had just closed ([`RESTARTS`]), and the tolerance
//! within which a node keeps its state grows from iteration to iteration.

use super::axes::Axes;
use super::coefficient::CoefficientSearch;
use super::fast::Shortcuts;
use super::linear;
use super::states::{self, Comparison, Rules};
use super::unknowns::Unknowns;
use crate::contact::error::ContactError;
use crate::contact::line::contact_line::{ContactLine, LineScratch, LineStart};
use crate::contact::line::state::NodeStatus;
use crate::contact::line::{ContactGrid, finish, zone};
use crate::contact::problem::ContactProblem;
use crate::linalg::DenseSystem;

/// Iterations allowed.
pub const MAX_ITERATIONS: usize = 40;
/// Iterations at which a stalled iteration restarts as if newly closed. Ordinary steps need one to three iterations and
/// the start of sliding from stick up to fourteen, so that only stalled ones get there.
const RESTARTS: [usize; 2] = [20, 31];
/// Iterations after which the tolerance of the states grows, and its growth per iteration.
const STRICT_ITERATIONS: usize = 8;
const GROWTH: f64 = 3.0;
/// Friction coefficients tried: smooth laws need five, steep ones in long steps some tens.
const MAX_COEFFICIENTS: usize = 150;
/// Largest difference between the rim angle and that of the linear problem, which weights it with the forces of the
/// iterate before \[rad]. It tilts the gap by less than a tenth of a nanometre; ordinary steps differ by 4e-10.
const ANGLE_TOLERANCE: f64 = 1e-8;
/// Change of the force of retarded layers in the last iteration that counts as none, over the nominal load \[1].
const RETARDED_TOLERANCE: f64 = 1e-7;

/// Buffers of the active set; of their content only functions of the operators outlive a solution.
#[derive(Default)]
pub struct ActiveSetScratch {
    line: LineScratch,
    memory: SearchMemory,
}

impl ActiveSetScratch {
    /// Linear problems solved so far by alternation, and all equations together: ordinary steps need no others than the
    /// first.
    pub fn solved(&self) -> [u64; 2] {
        self.memory.solved
    }
}

/// Buffers of the search.
#[derive(Default)]
struct SearchMemory {
    unknowns: Unknowns,
    /// Coefficients of all port forces in the row at hand.
    row: Vec<f64>,
    system: DenseSystem,
    /// States before an update.
    before: Vec<NodeStatus>,
    fast: Shortcuts,
    solved: [u64; 2],
}

/// The search in one contact problem.
pub(super) struct ActiveSet<'a> {
    problem: &'a ContactProblem<'a>,
    line: ContactLine<'a>,
    axes: Axes<'a>,
    memory: &'a mut SearchMemory,
}

impl<'a> ActiveSet<'a> {
    /// A search that starts from the given states.
    pub fn new(
        grid: &'a ContactGrid,
        problem: &'a ContactProblem<'a>,
        start: LineStart<'a>,
        scratch: &'a mut ActiveSetScratch,
    ) -> Self {
        start.2.rigid = problem.rigid.map(|motion| motion.start());
        let accelerations = problem.rigid.map(|motion| motion.known_acceleration());
        let ActiveSetScratch { line, memory } = scratch;
        memory.row.resize(grid.ports(), 0.0);
        let line = ContactLine::new(grid, &problem.line, accelerations, start, line);
        Self { problem, line, axes: Axes::new(&problem.rigid), memory }
    }

    /// Iterates from the states and forces of the start to the solution.
    pub fn run(mut self) -> Result<(), ContactError> {
        self.line.update_retarded();
        if self.line.problem.time.is_stationary() {
            states::found_anew(&mut self.line);
        }
        let (penalty, friction) = (states::penalty(&self.line), self.problem.friction);
        self.guess_closed(penalty);
        self.line.traction.friction.coefficient = friction.coefficient(self.line.traction.friction.tread_slip);
        self.line.update_upwind();
        self.line.take_surface_angle();
        self.line.frame.rim_angle = self.line.predicted_angle();
        self.line.traction.iterations = self.find_states(penalty)?;
        self.line.traction.friction.tread_slip = states::mean_slip(&self.line);
        if friction.varies() {
            self.find_coefficient(penalty)?;
        }
        zone::check(&self.line)?;
        finish::finish(self.line);
        Ok(())
    }

    /// Guesses the closed nodes from which the search starts.
    fn guess_closed(&mut self, penalty: f64) {
        let SearchMemory { unknowns, row, before, fast, .. } = &mut *self.memory;
        let tolerance = states::FORCE_TOLERANCE[0] * self.problem.nominal_load / self.line.grid.len() as f64;
        let comparison = Comparison { penalty, tolerance };
        fast.guess(&mut self.line, &self.axes, comparison, (unknowns, row, before));
    }

    /// Finds the states of all nodes at the present friction coefficient; returns the iterations made.
    fn find_states(&mut self, penalty: f64) -> Result<usize, ContactError> {
        let (mut settled, mut decided) = (false, 0);
        for iteration in 1..=MAX_ITERATIONS {
            if RESTARTS.contains(&iteration) {
                self.line.state.status.iter_mut().filter(|s| s.is_active()).for_each(|s| *s = NodeStatus::Stick);
                states::found_anew(&mut self.line);
            }
            self.solve_linear()?;
            let turned = (self.line.frame.rim_angle - self.line.rim.value).abs() > ANGLE_TOLERANCE;
            let changed = self.update_states(penalty, iteration);
            // Once states and edges are settled, only motions and rim angle are refined: smooth functions of the data.
            decided += usize::from(!settled);
            settled = !changed && (settled || self.edges_settled());
            let relieved = self.line.update_retarded().abs() > RETARDED_TOLERANCE * self.problem.nominal_load;
            let relieved = relieved && self.axes.seeks(2);
            if settled && !turned && !relieved && states::sticks(&self.line) {
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
            let law = friction.coefficient(self.line.traction.friction.tread_slip);
            let Some(next) = search.next(self.line.traction.friction.coefficient, law) else { return Ok(()) };
            self.line.traction.friction.coefficient = next;
            self.find_states(penalty)?;
            self.line.traction.friction.tread_slip = states::mean_slip(&self.line);
        }
        Err(ContactError::NotConverged { iterations: MAX_COEFFICIENTS })
    }

    /// Solves the linear problem of the present states; fills forces, rigid motions, displacements, slips and gaps.
    fn solve_linear(&mut self) -> Result<(), ContactError> {
        let Self { line, axes, memory, .. } = self;
        let SearchMemory { unknowns, row, system, fast, solved, .. } = &mut **memory;
        unknowns.list(line, axes);
        line.update_rim();
        let alternated = fast.solve(line, axes, unknowns, row);
        if !alternated {
            linear::solve(line, axes, unknowns, row, system)?;
        }
        solved[usize::from(!alternated)] += 1;
        line.evaluate(axes.sought_accelerations(line.traction.rigid));
        Ok(())
    }

    /// Takes new states of nodes and brakes; returns whether any changed.
    fn update_states(&mut self, penalty: f64, iteration: usize) -> bool {
        let growth = GROWTH.powi(iteration.saturating_sub(STRICT_ITERATIONS) as i32);
        let founding = (RESTARTS[0]..RESTARTS[1]).contains(&iteration);
        let Self { line, axes, memory, problem } = self;
        let rules = Rules::new(line, penalty, problem.nominal_load, growth, founding);
        let changed = states::update(line, &rules, &mut memory.before);
        let braked = axes.update_brakes(line, &mut memory.row, rules.force * line.grid.len() as f64);
        // A static problem needs a support.
        let held = problem.rigid[1].gain != 0.0 || !axes.seeks(1);
        let closed = !held && states::support(line);
        closed || changed || braked
    }

    /// True if the edges of the patches are settled. The weights of the present solution are kept if so: with weights
    /// that change from one coefficient to the next the slip would be no function of the coefficient.
    fn edges_settled(&mut self) -> bool {
        let settled = self.line.update_upwind() <= self.problem.edge_tolerance;
        if settled {
            self.line.upwind.restore();
        }
        settled
    }
}
