//! Brakes that slip or hold, around the search for stick.

use super::cone_search;
use super::constants::Constants;
use super::contact::{Relaid, SeriesContact};
use super::hot_layers::SeriesLayers;
use super::series_line::{SeriesLine, SeriesStart};
use super::{along, open};
use crate::axes::PerAxis;
use crate::contact::brake::{self, BrakeState};
use crate::contact::error::ContactError;
use crate::contact::problem::{AxisDrive, ContactProblem, OneLine};
use crate::linalg::DenseSystem;
use std::cell::OnceCell;

/// States of the brakes that are tried: a reversal passes through rest.
const MOST_STATES: usize = 6;
/// Excess over the strength of a brake that is round-off, at the rim over the nominal load \[1].
const ROUND_OFF: f64 = 1e-9;
/// Largest term of the slope of a hot layer beyond those of the pressure, over the slope of the round wheel \[1].
pub const UNRESOLVED: f64 = 0.02;
/// Layouts that follow the load.
const MOST_LAYOUTS: usize = 30;

/// Solves the contact of lines with a single patch each and hands the solution to `finish`; `starts` are the results of
/// the step before, one for each line, `system` is memory for their equations.
pub fn solve<R>(
    constants: &Constants,
    problem: &ContactProblem,
    starts: &[SeriesStart],
    system: &mut DenseSystem,
    finish: impl FnOnce(&SeriesContact) -> R,
) -> Result<R, ContactError> {
    let mut states = brake::founding(&problem.rigid);
    for _ in 0..MOST_STATES {
        let rigid = brake::driven(&problem.rigid, states);
        let memory: [_; MOST_LAYOUTS] = std::array::from_fn(|_| OnceCell::new());
        let line =
            |(line, start)| SeriesLine::new(constants, OneLine { line, rigid: &rigid, spin: problem.spin }, start);
        let lines = problem.lines.iter().zip(starts).map(line).collect();
        let mut contact = SeriesContact::new(lines, &rigid, Relaid { problem, memory: &memory });
        check_layers(&contact)?;
        std::mem::swap(&mut contact.system, system);
        let solve = if contact.lines[0].is_sideways() { sideways } else { along::solve };
        let found = solve(&mut contact);
        std::mem::swap(&mut contact.system, system);
        found?;
        let opens = |line: &SeriesLine| line.pressed.force.iter().any(|force| *force < 0.0);
        if contact.lines.iter().any(opens) {
            return Err(ContactError::Unsuited { reason: "the patch opens within" });
        }
        let next = next(&contact, problem, states);
        if next == states {
            return Ok(finish(&contact));
        }
        states = next;
    }
    Err(ContactError::Unsuited { reason: "a brake neither slips nor holds" })
}

/// Refuses hot layers that pressures cannot follow.
fn check_layers(contact: &SeriesContact) -> Result<(), ContactError> {
    let bends = |line: &SeriesLine| {
        let half_width = line.before.tractions.pressure.half_width;
        !line.is_sideways()
            && line.layers.as_ref().is_some_and(|layers| bends(layers, &line.problem, half_width, UNRESOLVED))
    };
    match contact.lines.iter().any(bends) {
        true => Err(ContactError::Unsuited { reason: "the pressure cannot follow a hot layer" }),
        false => Ok(()),
    }
}

/// True if layers bend the gap by more than the pressure can follow: a term of the slope beyond those of the pressure
/// exceeds the `share` \[1] of the first one, which holds a patch of this half-width \[m] on the round wheel.
pub fn bends(layers: &SeriesLayers, problem: &OneLine, half_width: f64, share: f64) -> bool {
    layers.unresolved() > share * half_width * half_width / problem.line.surfaces.radius
}

/// States of the brakes after a solution.
fn next(contact: &SeriesContact, problem: &ContactProblem, states: PerAxis<BrakeState>) -> PerAxis<BrakeState> {
    let first = &contact.lines[0];
    PerAxis::from_fn(|axis| {
        let AxisDrive::Braked { load, limit } = problem.rigid[axis].drive else { return states[axis] };
        let arm = axis.arm(first.problem.line.radius());
        let reaction = || contact.reaction(axis, contact.resultant()[axis]);
        brake::next(states[axis], [load, limit], reaction, first.rigid[axis], ROUND_OFF * problem.nominal_load * arm)
    })
}

/// Finds tractions along and across and motions, or motions without tractions where no line touches.
fn sideways(contact: &mut SeriesContact) -> Result<(), ContactError> {
    contact.opened = 0;
    let Err(error) = cone_search::solve::<2>(contact) else { return Ok(()) };
    if matches!(open::solve(contact), Ok(true)) {
        return Ok(());
    }
    // A wheel that just touches may do so on some of its lines.
    contact.lines.iter_mut().for_each(SeriesLine::begin_anew);
    (contact.opened, contact.partly) = (0, true);
    cone_search::solve::<2>(contact).map_err(|_| error)
}
