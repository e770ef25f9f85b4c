//! Division of a communication step into internal steps.
//!
//! A communication step is first divided evenly by `solver.max_step`. Where a piece must be shorter it is halved, again
//! and again, so that the last piece lands exactly on the end of the communication step; halves are joined again as
//! soon as the errors allow. A piece is halved
//!
//! - where the contact finds no state;
//! - with a `solver.tolerance`, where the contact misses its [`prediction`] by more than that. Loss of contact, re-contact,
//!   lock-up and breaking loose need no rules of their own: all of them bend forces or slip, and steps are halved until the
//!   bend within one step is below the tolerance, down to steps of some 10 µs, and of some 4 µs where contact is made or lost
//!   ([`control`] says when);
//! - where the contact heats or cools by hundreds of kelvin in one long piece, with or without a tolerance: friction that
//!   falls with the temperature follows the temperatures of the steps before;
//! - where it gets hotter than molten steel under friction can be, with or without a tolerance, down to steps of
//!   0.1 ms: a molten film takes friction away only from the step on after which it is seen. What is too hot in the shortest of
//!   them is refused;
//! - where the molten depth is not found.
//!
//! Errors no longer halve a piece where `solver.max_internal_steps` would be exceeded; the other reasons do.

mod control;
mod events;
mod prediction;

use super::control::{Drive, Inputs};
use super::decisions::Decisions;
use super::elevation::HeightCourse;
use super::error::StepError;
use super::model::{RollingModel, Workspace};
use super::state::{Pressing, State, StepControl};
use super::step::{Demand, remember, step};
use crate::axes::PerAxis;
use crate::config::Tuning;
use crate::heat::{HeatError, HeatFlows};
use control::{Control, Verdict};
use events::{condition, shortened};
use prediction::{Found, SWING, controlled, may_melt};
use std::hash::Hasher;

/// Longest communication step \[s].
pub const LONGEST_STEP: f64 = 3600.0;
/// Shortest internal step \[s]: below, waves do not cross an element and the contact may find no state. Communication
/// steps that are shorter, such as those that rounding leaves at the end of a run, wait for the next one.
pub const SHORTEST_STEP: f64 = 5e-7;
/// Most internal steps into which `solver.max_step` may divide a communication step: the longest one in tenths of a
/// second, and some. They take less than half a minute.
const MOST_PIECES: u64 = 40_000;
/// Longest internal step on smooth surfaces where it is chosen automatically \[s].
const AUTOMATIC: f64 = 0.1;
/// Internal steps in which the wheel passes the shortest wave of a profile, where they are chosen automatically: the
/// second-order formula then sees it within a percent.
const STEPS_PER_WAVE: f64 = 40.0;
/// Time in which what coarse steps have missed fades from the estimate of errors \[s]: some periods of the wheel on its contact.
const FADES: f64 = 5e-3;
/// How often in succession a step that finds no contact state is halved before it is given up.
const MAX_HALVINGS: u32 = 12;
/// Control of a stationary start: the errors do not limit the step yet.
pub fn unlimited(model: &RollingModel, state: &State) -> StepControl {
    StepControl { step: f64::INFINITY, before: controlled(model, state), ..StepControl::default() }
}

/// Place within a communication step: `done` of `pieces` equal pieces lie behind.
#[derive(Clone, Copy)]
struct Place {
    done: u64,
    pieces: u64,
}

impl Place {
    /// True if all the rest may be halved after a number of steps `tried`.
    fn may_halve(&self, tuning: &Tuning, tried: u64) -> bool {
        tried + 2 * (self.pieces - self.done) <= tuning.max_internal_steps as u64
    }

    /// Halves a communication step of `h` seconds, after a number of steps `tried`, until the wheel stops in a short one.
    fn meet_stop(&mut self, from: &State, h: f64, tuning: &Tuning, tried: u64) {
        while tuning.tolerance > 0.0 && stops(from, h / self.pieces as f64) && self.may_halve(tuning, tried) {
            self.halve();
        }
    }

    fn halve(&mut self) {
        (self.done, self.pieces) = (2 * self.done, 2 * self.pieces);
    }

    /// Joins two pieces to one where an even number is done and at least `fewest` remain.
    fn join(&mut self, fewest: u64) {
        if self.done.is_multiple_of(2) && self.pieces.is_multiple_of(2) && self.pieces / 2 >= fewest {
            (self.done, self.pieces) = (self.done / 2, self.pieces / 2);
        }
    }
}

/// Computes the state `out` after a communication step of `h` seconds under `inputs`; on error `out` is meaningless.
pub fn advance(
    model: &RollingModel,
    tuning: &Tuning,
    state: &State,
    inputs: &Inputs,
    h: f64,
    workspace: &mut Workspace,
    out: &mut State,
) -> Result<(), StepError> {
    advance_until(model, tuning, state, &Span { inputs, h, stop: None }, workspace, out).map(drop)
}

/// A communication step and what ends it early.
struct Span<'a> {
    inputs: &'a Inputs,
    h: f64,
    /// Condition on the state after an internal step.
    stop: Option<&'a dyn Fn(&State) -> bool>,
}

/// Computes the state `out` after a communication step and returns the time that it has taken \[s]: less than its length where
/// the condition holds before its end; then, and on error, `out` is meaningless.
fn advance_until(
    model: &RollingModel,
    tuning: &Tuning,
    state: &State,
    span: &Span,
    workspace: &mut Workspace,
    out: &mut State,
) -> Result<f64, StepError> {
    let Span { inputs, h, stop } = *span;
    inputs.validate()?;
    model.wheel.sideways.check(inputs)?;
    model.wheel.wheelset.check(inputs)?;
    if !(h > 0.0 && h <= LONGEST_STEP) {
        return Err(StepError::StepSize { step: h, longest: LONGEST_STEP });
    }
    let end = inputs.at(h);
    end.validate()?;
    model.wheel.wheelset.within(&end)?;
    let PerAxis { travel: velocity, height: displacement, rotation: omega, lateral } = state.motion.values();
    let drive = state.motion.pose.into(inputs.at(0.0));
    let start = Drive { omega, velocity, displacement, lateral_velocity: lateral, ..drive };
    let h = h + state.clock.pending;
    if h < SHORTEST_STEP {
        out.clone_from(state);
        out.clock.pending = h;
        return Ok(span.h);
    }
    let [mut now, mut next] = std::mem::take(&mut workspace.states);
    let elevation = state.rise.course([state.elevation, end.elevation], end.elevation_rate, h);
    let ramp = Ramp { inputs, start, end, elevation, h, stop };
    let result = march(model, tuning, state, &ramp, workspace, &mut now, &mut next);
    let share = result.as_ref().copied().unwrap_or(0.0);
    if share == 1.0 {
        std::mem::swap(out, &mut now);
        out.clock.time = state.clock.time + h;
        out.rise = ramp.elevation.rise();
    }
    workspace.states = [now, next];
    result.map(|_| if share == 1.0 { span.h } else { h * share })
}

/// Computes the state `out` after a communication step of at most `h` seconds under `inputs`; returns the inputs over it and its
/// length \[s]. It ends after the internal step in which an event happens, and is then computed once more as a step of that
/// length, so that nothing depends on what was asked for. A step over which the height of the rail changes is not cut, nor one
/// that makes up for steps too short to be computed. On error `out` is meaningless.
pub fn advance_to_event(
    model: &RollingModel,
    tuning: &Tuning,
    state: &State,
    (inputs, h): (&Inputs, f64),
    workspace: &mut Workspace,
    out: &mut State,
) -> Result<(Inputs, f64), StepError> {
    let level = state.elevation == inputs.at(h).elevation && inputs.drive.elevation_rate == 0.0;
    let (cut, before) = (level && state.clock.pending == 0.0, condition(state));
    let stop = |now: &State| condition(now) != before;
    let span = Span { inputs, h, stop: if cut { Some(&stop) } else { None } };
    let reached = advance_until(model, tuning, state, &span, workspace, out)?;
    if reached == h {
        return Ok((*inputs, h));
    }
    let inputs = shortened(model, state, inputs, h, reached);
    advance(model, tuning, state, &inputs, reached, workspace, out)?;
    Ok((inputs, reached))
}

/// Inputs over a communication step, as the internal steps take them.
struct Ramp<'a> {
    inputs: &'a Inputs,
    start: Drive,
    end: Drive,
    elevation: HeightCourse,
    /// Its length [s].
    h: f64,
    /// Condition that ends it early.
    stop: Option<&'a dyn Fn(&State) -> bool>,
}

impl Ramp<'_> {
    /// Values at a fraction of the step; prescribed motions move linearly, the rail smoothly.
    fn at(&self, fraction: f64) -> Drive {
        let linear = self.start.zip(&self.end, |a, b| if fraction == 1.0 { b } else { a + fraction * (b - a) });
        Drive { elevation: self.elevation.at(fraction), ..linear }
    }
}

/// Longest internal step that resolves the surfaces which the wheel meets in the coming `h` seconds \[s].
fn resolving_step(model: &RollingModel, state: &State, h: f64) -> f64 {
    let (radius, motion) = (model.wheel.radius, state.motion.values());
    let speed = motion.travel.abs().max((radius * motion.rotation).abs());
    let patch = 2.0 * model.contact.nominal_half_width();
    let wave = model.contact.surfaces.shortest_wavelength(state.place(radius), model.zone + speed * h, patch);
    (wave / (STEPS_PER_WAVE * speed)).min(AUTOMATIC)
}

/// Number of pieces into which `solver.max_step`, or the surfaces, and the elevation of the rail divide a communication
/// step.
fn fewest_pieces(model: &RollingModel, tuning: &Tuning, state: &State, ramp: &Ramp) -> Result<u64, StepError> {
    let h = ramp.h;
    let max_step = if tuning.max_step > 0.0 { tuning.max_step } else { resolving_step(model, state, h) };
    let uneven = ramp.elevation.pieces(model.wheel.inertia.height, state.resultant().height);
    let pieces = ((h / max_step - 1e-9).ceil().max(1.0) as u64).max(uneven);
    if pieces > MOST_PIECES {
        return Err(StepError::TooManySteps { step: h, max_step, pieces, most: MOST_PIECES });
    }
    Ok(pieces)
}

/// Sums and means over the internal steps of a communication step.
#[derive(Default)]
struct Sums {
    /// Internal steps, those among them whose error was let pass, and the contact iterations of all.
    counts: [u64; 3],
    /// Estimated errors of force [N/m] and temperature \[K].
    errors: [f64; 2],
    /// Mean heat flows of every line per metre of all lines [W/m]: lines become wider and narrower.
    flows: Vec<HeatFlows>,
    pressing: Pressing,
    decisions: Decisions,
}

impl Sums {
    /// Adds the internal step of `dt` seconds that ended in `next`, one of a communication step of `h` seconds.
    fn add(&mut self, next: &State, (verdict, found): (Verdict, &Found), dt: f64, h: f64) {
        let [steps, spoilt, iterations] = self.counts;
        self.counts =
            [steps + 1, spoilt + u64::from(verdict == Verdict::Limited), iterations + next.iterations() as u64];
        self.errors = [self.errors[0] + found.force, self.errors[1] + found.temperature];
        self.flows.resize(next.lines.len(), HeatFlows::default());
        for (flows, line) in self.flows.iter_mut().zip(&next.lines) {
            line.thermal.iter().for_each(|thermal| flows.add(line.layout.share * (dt / h), &thermal.flows));
        }
        self.pressing.add(next, dt);
    }

    /// Gives a state what its communication step of `h` seconds, which began with `before`, has summed up.
    fn give(self, state: &mut State, before: &State, h: f64) {
        state.friction_power = (state.audit.friction - before.audit.friction) / h;
        state.hub.brake.power = (state.audit.brake - before.audit.brake) / h;
        state.pressing = self.pressing;
        for (line, flows) in state.lines.iter_mut().zip(self.flows) {
            let Some(thermal) = &mut line.thermal else { continue };
            thermal.flows = HeatFlows::default();
            thermal.flows.add(1.0 / line.layout.share, &flows);
        }
        [state.clock.internal_steps, state.clock.limited_steps, state.clock.iterations] = self.counts;
        let left = libm::exp(-h / FADES);
        state.clock.errors = [0, 1].map(|k| self.errors[k].max(left * before.clock.errors[k]));
        state.clock.decisions = self.decisions.finish();
    }
}

/// True if a step of `dt` seconds is too long to be tried since the wheel stops in it, or has stopped in the one before: its
/// rim swings about the hub afterwards.
fn stops(from: &State, dt: f64) -> bool {
    let omega = from.motion.omega;
    let (stopped, stopping) = match from.hub.brake.locked {
        true => (omega.before != 0.0, false),
        false => (false, from.hub.brake.moment * omega.now < 0.0 && omega.now * (omega.now + dt * omega.rate) < 0.0),
    };
    (stopped || stopping) && dt > 2.0 * SWING * (1.0 + 1e-9)
}

/// True if a shorter step may succeed where one has failed with this error.
fn shorter_may_succeed(error: &StepError) -> bool {
    matches!(
        error,
        StepError::Contact { .. }
            | StepError::NotFinite { .. }
            | StepError::Heat(HeatError::MeltingNotConverged { .. })
    )
}

/// Computes the state `next` after an internal step of `dt` seconds, unless its motion alone shows that it is too long, and
/// judges it.
fn judged(
    model: &RollingModel,
    from: &State,
    demand: &Demand,
    (dt, may_halve): (f64, bool),
    control: &mut Control,
    workspace: &mut Workspace,
    next: &mut State,
) -> Result<(Verdict, Found), StepError> {
    let (mut found, before) = (Found::default(), control.memory.before);
    let melts = may_melt(model, from);
    let mut passes = |to: &State| {
        found = Found::in_motion(model, from, to, &before, demand.last_step, dt);
        melts || control.judge(&found, dt, may_halve) != Verdict::TooLong
    };
    if !step(model, from, demand, dt, &mut passes, workspace, next)? {
        return Ok((Verdict::TooLong, found));
    }
    let found = found.with_heat(model, from, next, &before);
    Ok((control.judge(&found, dt, may_halve), found))
}

/// Takes the internal steps and returns the share of the communication step that they make: all of it, unless a condition ends
/// it early. `now` is the state after the last one, `next` a buffer.
fn march(
    model: &RollingModel,
    tuning: &Tuning,
    state: &State,
    ramp: &Ramp,
    workspace: &mut Workspace,
    now: &mut State,
    next: &mut State,
) -> Result<f64, StepError> {
    let fewest = fewest_pieces(model, tuning, state, ramp)?;
    let mut place = Place { done: 0, pieces: fewest };
    let mut control = Control::new(tuning, state.clock.control);
    while !control.allows(ramp.h / place.pieces as f64) && place.may_halve(tuning, 0) {
        place.halve();
    }
    let (mut last_step, mut failures, mut begun, mut tried) = (state.clock.last_step, 0, false, 0);
    let mut sums = Sums { pressing: state.pressing.begun(), ..Sums::default() };
    while place.done < place.pieces {
        let from: &State = if begun { now } else { state };
        place.meet_stop(from, ramp.h, tuning, tried);
        let dt = ramp.h / place.pieces as f64;
        let (interim, before) = (place.done + 1 < place.pieces, control.memory.before);
        let [begin, target] = [place.done, place.done + 1].map(|done| ramp.at(done as f64 / place.pieces as f64));
        let demand = Demand { inputs: ramp.inputs, begin: &begin, target: &target, tuning, interim, last_step, before };
        let (verdict, found) =
            match judged(model, from, &demand, (dt, place.may_halve(tuning, tried + 1)), &mut control, workspace, next)
            {
                Ok(judged) => judged,
                Err(error) if failures < MAX_HALVINGS && dt >= 2.0 * SHORTEST_STEP && shorter_may_succeed(&error) => {
                    failures += 1;
                    last_step = 0.0;
                    place.halve();
                    continue;
                }
                Err(error) => return Err(error),
            };
        tried += 1;
        if verdict == Verdict::TooLong {
            place.halve();
            continue;
        }
        found.check(model)?;
        remember(model, from, &demand, dt, workspace, next);
        control.memory.before = controlled(model, from);
        sums.decisions.add(model, next, place.pieces);
        (place.done, failures) = (place.done + 1, 0);
        if place.done < place.pieces && ramp.stop.is_some_and(|stop| stop(next)) {
            return Ok(place.done as f64 / place.pieces as f64);
        }
        if control.grows(&found, dt) {
            place.join(fewest);
        }
        sums.add(next, (verdict, &found), dt, ramp.h);
        (last_step, begun) = (next.clock.last_step, true);
        std::mem::swap(now, next);
    }
    now.clock.control = control.memory;
    sums.give(now, state, ramp.h);
    Ok(1.0)
}
