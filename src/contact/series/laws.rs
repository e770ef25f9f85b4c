//! Laws with several branches around the search for stick: brakes that slip or hold, and friction that depends on the
//! slip.

use super::constants::Constants;
use super::hot_layers::SeriesLayers;
use super::series_line::{SeriesLine, SeriesStart};
use super::stick;
use crate::contact::brake::{self, BrakeState};
use crate::contact::error::ContactError;
use crate::contact::friction::CoefficientSearch;
use crate::contact::problem::{AxisDrive, SingleLine};

/// States of the brakes that are tried: a reversal passes through rest.
const MOST_STATES: usize = 6;
/// Excess over the strength of a brake that is round-off, at the rim over the nominal load \[1].
const ROUND_OFF: f64 = 1e-9;
/// Largest term of the slope of a hot layer beyond those of the pressure, over the slope of the round wheel \[1].
pub const UNRESOLVED: f64 = 0.02;
/// Friction coefficients that are tried.
const MOST_COEFFICIENTS: usize = 150;

/// Solves the contact of a single patch and hands the solution to `finish`.
pub fn solve<R>(
    constants: &Constants,
    problem: SingleLine,
    start: &SeriesStart,
    finish: impl FnOnce(&SeriesLine) -> R,
) -> Result<R, ContactError> {
    let half_width = start.before.tractions.pressure.half_width;
    let mut states = brake::founding(problem.rigid);
    for _ in 0..MOST_STATES {
        let rigid = brake::driven(problem.rigid, states);
        let mut line = SeriesLine::new(constants, SingleLine { rigid: &rigid, ..problem }, start);
        if line.layers.as_ref().is_some_and(|layers| bends(layers, &problem, half_width, UNRESOLVED)) {
            return Err(ContactError::Unsuited { reason: "the pressure cannot follow a hot layer" });
        }
        find(&mut line)?;
        if line.pressed.force.iter().any(|force| *force < 0.0) {
            return Err(ContactError::Unsuited { reason: "the patch opens within" });
        }
        let next = next(&line, &problem, states);
        if next == states {
            return Ok(finish(&line));
        }
        states = next;
    }
    Err(ContactError::Unsuited { reason: "a brake neither slips nor holds" })
}

/// True if layers bend the gap by more than the pressure can follow: a term of the slope beyond those of the pressure
/// exceeds the `share` \[1] of the first one, which holds a patch of this half-width \[m] on the round wheel.
pub fn bends(layers: &SeriesLayers, problem: &SingleLine, half_width: f64, share: f64) -> bool {
    layers.unresolved() > share * half_width * half_width / problem.line.surfaces.radius
}

/// States of the brakes after a solution.
fn next(line: &SeriesLine, problem: &SingleLine, states: [BrakeState; 3]) -> [BrakeState; 3] {
    std::array::from_fn(|axis| {
        let AxisDrive::Braked { load, limit } = problem.rigid[axis].drive else { return states[axis] };
        let arm = if axis == 2 { problem.line.radius() } else { 1.0 };
        let reaction = || line.reaction(axis, line.resultant());
        brake::next(states[axis], [load, limit], reaction, line.rigid[axis], ROUND_OFF * problem.nominal_load * arm)
    })
}

/// Finds tractions and motions, and the friction coefficient that the law gives to their slip.
fn find(line: &mut SeriesLine) -> Result<(), ContactError> {
    stick::solve(line)?;
    let friction = &line.problem.line.friction;
    if !friction.varies() {
        return Ok(());
    }
    let mut search = CoefficientSearch::new(friction.bounds());
    for _ in 0..MOST_COEFFICIENTS {
        match search.next(line.friction, friction.coefficient(line.tread_slip())) {
            Some(next) => line.friction = next,
            None => return Ok(()),
        }
        stick::solve(line)?;
    }
    Err(ContactError::Unsuited { reason: "no friction coefficient belongs to its slip" })
}
