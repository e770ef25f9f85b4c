//! Contact with lateral tractions on paired nodes: pressure and shear by turns.
//!
//! Normal forces are those of the shear of before ([`super::pressing`]); the shear along and across all lines, with the
//! motions that are free, is that of these normal forces ([`crate::contact::cone`]). Each turn begins with the exact gaps and
//! slips of the last one, so that what its equations leave out only makes turns more: [`slips`] has the flexibility of a
//! line by itself, [`coupling`] what lines and motions do to each other, [`friction`] the shear of a turn.
//! Theory: `docs/theory/sideways.md`.

mod coupling;
mod friction;
mod slips;

use super::coefficients::{FollowedLaws, Obedience, Progress};
use super::pressing::Thoroughness;
use super::search::{ActiveSet, SearchMemory};
use super::states::{self, Rules};
use crate::axes::Axis;
use crate::contact::error::ContactError;
use crate::contact::line::contact_line::ContactLine;
use crate::contact::line::{exchange, finish, zone};
use friction::{Prepared, TOLERANCE};

/// Nodes of a line at most that touch.
const MOST_NODES: usize = 256;
/// Turns at most.
const MOST: usize = 120;
/// Extent of the search for the states of the normal problem in a turn.
const PRESSED: Thoroughness = Thoroughness { most: 80, together: 30, yields: true };
/// Violation and change at which coefficients of friction begin to follow their laws \[1].
const TELLING: f64 = 1e-3;
impl ActiveSet<'_> {
    /// Iterates from the states and forces of the start to the solution of a contact with lateral tractions; returns the times
    /// that the law of friction was made linear. Stacks of contacts in one direction have no room for its numbers.
    #[inline(never)]
    pub fn run_across(mut self) -> Result<usize, ContactError> {
        let spin = self.problem.spin;
        for line in &mut self.lines {
            line.spin = spin;
            line.update_retarded();
        }
        exchange::forces(&mut self.lines);
        let laws = FollowedLaws::begin(&mut self.lines);
        for line in &mut self.lines {
            line.begin_upwind();
            line.take_surface_angle();
            line.frame.rim_angle = line.predicted_angle();
        }
        self.begin_states();
        let pressed = self.press()?;
        let mut turns = Turns { laws, pressed, made: 0, linear_laws: 0 };
        let ended = self.turn_about::<32>(&mut turns)?
            || self.turn_about::<64>(&mut turns)?
            || self.turn_about::<128>(&mut turns)?
            || self.turn_about::<MOST_NODES>(&mut turns)?;
        if !ended {
            return Err(ContactError::Sideways { most: MOST_NODES });
        }
        self.lines.iter_mut().for_each(|line| line.traction.iterations = turns.made);
        self.lines.iter().try_for_each(zone::check)?;
        finish::finish(&mut self.lines);
        Ok(turns.linear_laws)
    }

    /// Finds pressure and shear by turns; false: more than N nodes of a line touch.
    #[inline(never)]
    fn turn_about<const N: usize>(&mut self, turns: &mut Turns) -> Result<bool, ContactError> {
        let (mut prepared, mut last) = (None, f64::INFINITY);
        while turns.made < MOST {
            if self.lines.iter().any(|line| line.closed_nodes().len() > N) {
                return Ok(false);
            }
            turns.made += 1;
            self.evaluate();
            let settled = self.edges_settled() || self.stands();
            let relieved = self.update_retarded().abs() / self.problem.nominal_load;
            let mut friction = Prepared::<N>::renewed(prepared.take(), self, last);
            let violation = friction.shear(self, &mut turns.linear_laws)?;
            prepared = Some(friction);
            let braked = self.brakes_change();
            let pressed = self.press()?;
            let change = pressed.change_from(&turns.pressed, self.problem.nominal_load).max(relieved).max(violation);
            (turns.pressed, last) = (pressed, violation);
            let progress = match change {
                change if change <= TOLERANCE && settled && !braked => Progress::Refined,
                change if change <= TELLING => Progress::Settled,
                _ => continue,
            };
            if turns.laws.follow(&mut self.lines, progress)? == Obedience::Obeyed && progress == Progress::Refined {
                self.evaluate();
                return Ok(true);
            }
        }
        Err(ContactError::NotConverged { iterations: MOST })
    }

    /// Takes displacements, gaps and slips of the present forces and motions.
    fn evaluate(&mut self) {
        exchange::forces(&mut self.lines);
        for axis in Axis::along().filter(|axis| self.axes.holds(*axis)) {
            self.lines.iter_mut().for_each(|line| line.traction.rigid[axis] = 0.0);
        }
        for line in &mut self.lines {
            line.evaluate(self.axes.sought_accelerations(line.traction.rigid));
        }
    }

    /// Finds closed nodes and normal forces under the present shear.
    fn press(&mut self) -> Result<Pressed, ContactError> {
        let Self { lines, axes, memory, penalties, problem, .. } = self;
        let rules = Rules::new(&lines[0], penalties[0], problem.nominal_load, 1.0, false);
        // A static problem needs a support.
        if problem.rigid.height.gain == 0.0 && axes.seeks(Axis::Height) {
            states::support(lines);
        }
        let SearchMemory { pressing, solver, .. } = &mut **memory;
        let settled = pressing.press(lines, axes, &rules, PRESSED, solver)?;
        for line in lines.iter_mut() {
            for i in 0..line.grid.len() {
                if !line.state.status[i].is_active() {
                    line.state.lateral[i] = 0.0;
                }
            }
        }
        match settled {
            true => Ok(Pressed::of(lines)),
            false => Err(ContactError::NotConverged { iterations: PRESSED.most }),
        }
    }

    /// Takes new states of the brakes; whether any changed.
    fn brakes_change(&mut self) -> bool {
        let Self { lines, axes, penalties, problem, grid, .. } = self;
        let rules = Rules::new(&lines[0], penalties[0], problem.nominal_load, 1.0, false);
        axes.update_brakes(lines, rules.force * grid.len() as f64)
    }
}

/// Where the turns are.
struct Turns {
    laws: FollowedLaws,
    /// Normal forces of the last one.
    pressed: Pressed,
    /// Number of turns.
    made: usize,
    /// Times that the law of friction was made linear.
    linear_laws: usize,
}

/// Normal forces of all lines after a turn [N/m].
struct Pressed(Vec<f64>);

impl Pressed {
    fn of(lines: &[ContactLine]) -> Self {
        Self(lines.iter().flat_map(|line| (0..line.grid.len()).map(|i| line.normal(i))).collect())
    }

    /// Largest change from others, over the mean nodal force of the nominal load \[1].
    fn change_from(&self, before: &Self, load: f64) -> f64 {
        let changes = self.0.iter().zip(&before.0).map(|(now, before)| (now - before).abs());
        changes.fold(0.0, f64::max) * self.0.len() as f64 / load
    }
}
