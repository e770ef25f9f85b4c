//! Exact Coulomb contact by a primal–dual active set (semi-smooth Newton) on the condensed contact problem.
//!
//! Unknown are the nodal forces of closed nodes and those rigid motions (V, U, Ω) that are not prescribed. Each
//! iteration solves the linear problem of the present states and takes new states ([`super::states`]). Where the
//! friction coefficient depends on the slip, it follows its law in the same iteration ([`super::coefficients`]).
//!
//! An iteration that stalls all the same is restarted as if all nodes had just closed ([`RESTARTS`]), and the tolerance
//! within which a node keeps its state grows from iteration to iteration. In the end nodes change one by one ([`TOGETHER`]).

use super::axes::Axes;
use super::coefficients::{FollowedLaws, Obedience, Progress};
use super::guess::Guess;
use super::linear::LinearSolver;
use super::present::{self, Present};
use super::slides;
use super::states::{self, Rules};
use super::unknowns::Unknowns;
use crate::axes::Axis;
use crate::contact::error::ContactError;
use crate::contact::line::alone::Alone;
use crate::contact::line::contact_line::{ContactLine, LineScratch, LineStart};
use crate::contact::line::resize::Nodes;
use crate::contact::line::state::NodeStatus;
use crate::contact::line::{ContactGrid, exchange, finish, zone};
use crate::contact::problem::{Begin, ContactProblem};

/// Iterations allowed.
pub const MAX_ITERATIONS: usize = 240;
/// Iterations after which only one node changes its state in each: where many nodes at once go in circles, as in a patch
/// that yields from edge to edge, the last wrong one by itself leads to the solution (Murty 1974), mostly within ten.
const TOGETHER: usize = 40;
/// Iterations at which a stalled iteration restarts as if newly closed. Ordinary steps need one to three iterations and
/// the start of sliding from stick up to fourteen, so that only stalled ones get there.
const RESTARTS: [usize; 2] = [20, 31];
/// Iterations after which the tolerance of the states grows, and its growth per iteration.
const STRICT_ITERATIONS: usize = 8;
const GROWTH: f64 = 3.0;
/// Change of a weight of the upwind differences that counts as none \[1].
const SAME_WEIGHT: f64 = 4e-4;
/// Largest difference between the rim angle and that of the linear problem, which weights it with the forces of the
/// iterate before \[rad]. It tilts the gap by less than a tenth of a nanometre; ordinary steps differ by 4e-10.
const ANGLE_TOLERANCE: f64 = 1e-8;
/// Largest moment that may be missing with the lever arms of the last iterate, over nominal load times radius \[1].
const MOMENT_TOLERANCE: f64 = 2e-8;
/// Most iterations for that: in steps of less than a microsecond the moment is a small difference of large ones, which
/// round-off keeps from balancing so well.
const MOST_BALANCING: usize = 4;
/// Distance of friction from its direction over the largest of the line, from which directions go on turning, and which is none \[1].
const TELLING: f64 = 1e-3;
const MISSED: f64 = 1e-9;
/// Such a distance from which solutions are corrected for new directions, and its part that a correction leaves at most, so that
/// another one follows \[1].
const TURNING: f64 = 0.05;
const FALLING: f64 = 0.3;
/// Way of the material in a step, over the distance of the nodes, at which it stands \[1].
const STANDS: f64 = 1e-9;

/// Buffers of the active set; of their content only functions of the operators outlive a solution.
#[derive(Default)]
pub struct ActiveSetScratch {
    lines: Vec<LineScratch>,
    memory: SearchMemory,
}

impl ActiveSetScratch {
    /// Linear problems solved so far.
    pub fn solved(&self) -> u64 {
        self.memory.solved
    }
}

/// Buffers of the search.
#[derive(Default)]
pub(super) struct SearchMemory {
    unknowns: Unknowns,
    /// States before an update.
    before: Vec<NodeStatus>,
    /// States, forces and motions with which the search has begun.
    begun: Vec<Present>,
    guess: Guess,
    solver: LinearSolver,
    solved: u64,
}

/// The search in one contact problem.
pub(super) struct ActiveSet<'a> {
    problem: &'a ContactProblem<'a>,
    grid: &'a ContactGrid,
    pub lines: Vec<ContactLine<'a>>,
    /// Stiffness by which every line compares gaps with forces [N/m per m].
    penalties: Vec<f64>,
    axes: Axes<'a>,
    memory: &'a mut SearchMemory,
}

impl<'a> ActiveSet<'a> {
    /// A search that starts from the given states, one for each line of the problem, on nodes that `follow` the load where they may.
    pub fn new(
        grid: &'a ContactGrid,
        (problem, follow): (&'a ContactProblem<'a>, bool),
        mut starts: Vec<LineStart<'a>>,
        scratch: &'a mut ActiveSetScratch,
    ) -> Self {
        let accelerations = problem.rigid.map(|motion| motion.known_acceleration());
        let motions = [problem.rigid.travel.start(), problem.rigid.rotation.start()];
        let suited = problem.lines.iter().zip(&starts).map(|(line, start)| start.state.suited(line)).max();
        let nodes = suited.filter(|_| follow).unwrap_or(Nodes::OfTheGrid);
        let ActiveSetScratch { lines: buffers, memory } = scratch;
        buffers.resize_with(problem.lines.len(), LineScratch::default);
        for ((line, start), buffers) in problem.lines.iter().zip(&mut starts).zip(&mut *buffers) {
            buffers.begin(grid, line, start.state, ((motions, nodes), accelerations));
        }
        exchange::pulls(&problem.lines, buffers);
        let together = problem.lines.iter().zip(starts).zip(buffers);
        let mut lines: Vec<_> =
            together.map(|((line, start), buffers)| ContactLine::new(grid, line, start, buffers)).collect();
        for line in &mut lines {
            line.traction.rigid = problem.rigid.map(|motion| motion.start());
            line.drift = if line.state.directions() > 1 { problem.drift } else { line.drift };
        }
        exchange::forces(&mut lines);
        // Lever arms of the start: without what the lines' own flexibility adds to them moments would not balance at once.
        lines.iter_mut().for_each(|line| {
            let alone = Alone { kernel: line.kernel, grid: line.grid };
            alone.find(line.state.forces.as_slice(), &mut line.iterate.own);
            line.lift();
            line.displace_across();
        });
        let penalties = lines.iter().map(states::penalty).collect();
        Self { problem, grid, lines, penalties, axes: Axes::new(&problem.rigid), memory }
    }

    /// Iterates from the states and forces of the start to the solution.
    pub fn run(mut self) -> Result<(), ContactError> {
        for line in &mut self.lines {
            if line.problem.time.is_stationary() {
                states::found_anew(line);
            }
            slides::begin(line);
        }
        let mut laws = FollowedLaws::begin(&mut self.lines);
        self.guess_closed();
        for line in &mut self.lines {
            line.begin_upwind();
            line.take_surface_angle();
            line.frame.rim_angle = line.predicted_angle();
            line.iterate.own_slip = if line.state.directions() > 1 { line.own_slip() } else { 0.0 };
        }
        self.begin_states();
        self.support();
        self.open_apart()?;
        let mut begun = std::mem::take(&mut self.memory.begun);
        present::take(&self.lines, &mut begun);
        let turns = self.lines.iter().any(|line| line.state.directions() > 1);
        let found = self.find_states(Some(&mut laws), if turns { TOGETHER } else { MAX_ITERATIONS });
        let found = found.or_else(|error| {
            let ContactError::NotConverged { .. } = error else { return Err(error) };
            present::give_back(&begun, &mut self.lines);
            self.draw(&mut laws)
        });
        self.memory.begun = begun;
        let iterations = found?;
        self.lines.iter_mut().for_each(|line| line.traction.iterations = iterations);
        self.lines.iter().try_for_each(zone::check)?;
        finish::finish(&mut self.lines);
        Ok(())
    }

    /// Takes the states with which the search begins. Upwind differences begin with those of the step before all the same: from
    /// others they would end elsewhere within their tolerance, and forces would jump where a layout is tried more or less.
    fn begin_states(&mut self) {
        self.lines.iter_mut().for_each(states::foresee);
        match self.problem.begin {
            Begin::Before(factor) => {
                self.lines.iter_mut().for_each(|line| states::stretch(line, factor / line.resized));
            }
            Begin::Found => self.lines.iter_mut().for_each(ContactLine::resume),
        }
    }

    /// Opens all nodes of a stationary contact whose surfaces are apart under the given motions: from nodes that hold them
    /// together the search would open one after the other.
    fn open_apart(&mut self) -> Result<(), ContactError> {
        if self.axes.sought().next().is_some() || !self.lines.iter().all(|line| line.problem.time.is_stationary()) {
            return Ok(());
        }
        let begun: Vec<_> = self.lines.iter().map(|line| line.state.status.clone()).collect();
        self.lines.iter_mut().for_each(|line| line.state.status.fill(NodeStatus::Open));
        self.solve_linear()?;
        if self.lines.iter().any(|line| line.state.gap.iter().any(|gap| *gap < 0.0)) {
            self.lines.iter_mut().zip(begun).for_each(|(line, status)| line.state.status = status);
        }
        Ok(())
    }

    /// Guesses the closed nodes from which the search starts.
    fn guess_closed(&mut self) {
        let SearchMemory { guess, solver, .. } = &mut *self.memory;
        let rules = Rules::new(&self.lines[0], self.penalties[0], self.problem.nominal_load, 1.0, false);
        guess.find(&mut self.lines, &self.axes, &rules, solver);
    }

    /// Finds the states of all nodes at the friction coefficients of their slips; returns the iterations until states were
    /// settled at first.
    pub fn find_states(&mut self, mut laws: Option<&mut FollowedLaws>, most: usize) -> Result<usize, ContactError> {
        let (mut settled, mut first, mut decided, mut balancing, mut last) = (false, true, 0, 0, f64::INFINITY);
        // Iterations at the coefficients of settled states.
        let mut iteration = 0;
        while iteration < most {
            // Each correction leaves a small part of what the one before has left, so that there are few.
            if !(last < TURNING && self.correct()) {
                iteration += 1;
                if RESTARTS.contains(&iteration) {
                    self.restart();
                }
                self.solve_linear()?;
            }
            let turned =
                self.lines.iter().any(|line| (line.frame.rim_angle - line.iterate.rim.value).abs() > ANGLE_TOLERANCE);
            let (states_changed, missed) = self.update_states(iteration);
            let changed = states_changed || missed > TELLING;
            // Once states and edges are settled, only motions and rim angle are refined: smooth functions of the data.
            decided += usize::from(first);
            settled = !changed && (settled || self.edges_settled() || self.stands());
            first = first && !settled;
            let corrects = !states_changed && (settled || changed) && !turned && missed < FALLING * last;
            last = if corrects { missed } else { f64::INFINITY };
            let refined = settled && missed <= MISSED && !turned && self.lines.iter().all(states::sticks);
            let progress = match settled {
                true if refined => Progress::Refined,
                true => Progress::Settled,
                false if iteration <= STRICT_ITERATIONS => Progress::Searching,
                false => continue,
            };
            let obedience = laws.as_mut().map(|laws| laws.follow(&mut self.lines, progress)).transpose()?;
            // Slips by which laws are followed are those of a linear problem with their coefficients.
            if obedience == Some(Obedience::Moved) {
                last = f64::INFINITY;
            }
            match obedience.unwrap_or(Obedience::Obeyed) {
                Obedience::Moved if settled => iteration = 0,
                Obedience::Obeyed if refined => {
                    if balancing == MOST_BALANCING || self.turns_balance() {
                        return Ok(decided);
                    }
                    (balancing, last) = (balancing + 1, f64::INFINITY);
                }
                _ => {}
            }
        }
        Err(ContactError::NotConverged { iterations: most })
    }

    /// Lets all closed nodes stick, as if they had just closed.
    fn restart(&mut self) {
        for line in &mut self.lines {
            line.state.status.iter_mut().filter(|s| s.is_active()).for_each(|s| *s = NodeStatus::Stick);
            states::found_anew(line);
        }
    }

    /// True if the moments balance with the lever arms of the present iterate, too: it was found with those before.
    fn turns_balance(&mut self) -> bool {
        let missing = self.axes.missing_moment(&self.lines);
        missing.abs() <= MOMENT_TOLERANCE * self.problem.nominal_load * self.lines[0].problem.radius()
    }

    /// Solves the linear problem of the present states; fills forces, rigid motions, displacements, slips and gaps.
    fn solve_linear(&mut self) -> Result<(), ContactError> {
        let Self { lines, axes, memory, .. } = self;
        let SearchMemory { unknowns, solver, solved, .. } = &mut **memory;
        unknowns.list(lines, axes);
        lines.iter_mut().for_each(ContactLine::update_rim);
        solver.solve(lines, (axes, unknowns), None)?;
        *solved += 1;
        self.evaluate();
        Ok(())
    }

    /// Corrects the solution of the linear problem of these states for new directions of friction; whether it could.
    fn correct(&mut self) -> bool {
        let Self { lines, axes, memory, .. } = self;
        let drawn = lines.iter().any(|line| line.iterate.drawn.is_some());
        if drawn || !memory.solver.correct(lines, (axes, &memory.unknowns)) {
            return false;
        }
        self.evaluate();
        true
    }

    /// Displacements, slips and gaps of the present forces and motions.
    fn evaluate(&mut self) {
        exchange::forces(&mut self.lines);
        for line in &mut self.lines {
            line.evaluate(self.axes.sought_accelerations(line.traction.rigid));
        }
    }

    /// Takes new states of nodes and brakes; returns whether any changed, and how far friction is from its directions \[1].
    fn update_states(&mut self, iteration: usize) -> (bool, f64) {
        let growth = GROWTH.powi(iteration.saturating_sub(STRICT_ITERATIONS) as i32);
        let founding = (RESTARTS[0]..RESTARTS[1]).contains(&iteration);
        let Self { lines, penalties, axes, memory, problem, grid } = self;
        let (mut changed, mut tolerance, mut missed) = (false, 0.0, 0.0_f64);
        for (line, penalty) in lines.iter_mut().zip(penalties) {
            let rules = Rules::new(line, *penalty, problem.nominal_load, growth, founding);
            tolerance = rules.force;
            if iteration <= TOGETHER || !changed {
                changed |= states::update(line, &rules, iteration > TOGETHER, &mut memory.before);
                missed = missed.max(slides::turn(line, &memory.before));
            }
        }
        let braked = axes.update_brakes(lines, tolerance * grid.len() as f64);
        let supported = self.support();
        (supported || changed || braked, missed)
    }

    /// Closes a node where there is none and a static problem needs a support; returns whether it did.
    fn support(&mut self) -> bool {
        let held = self.problem.rigid.height.gain != 0.0 || !self.axes.seeks(Axis::Height);
        !held && states::support(&mut self.lines)
    }

    /// True if the material moves by so little in the step that it does not matter where it comes from.
    fn stands(&self) -> bool {
        let moves = |line: &ContactLine| (line.traction.rigid.travel + line.rim_velocity()).abs();
        let cell = |line: &ContactLine| STANDS * line.problem.time.a0 * line.grid.spacing;
        self.lines.iter().all(|line| moves(line) < cell(line))
    }

    /// True if the edges of the patches are settled. The weights of the present solution are kept if so: with weights
    /// that change from one coefficient to the next the slip would be no function of the coefficient.
    fn edges_settled(&mut self) -> bool {
        let tolerance = self.problem.edge_tolerance;
        let change = self.lines.iter_mut().map(|line| line.update_upwind(tolerance)).fold(0.0, f64::max);
        let settled = change <= tolerance.min(SAME_WEIGHT);
        if settled {
            self.lines.iter_mut().for_each(|line| line.iterate.upwind.restore());
        }
        settled
    }
}
