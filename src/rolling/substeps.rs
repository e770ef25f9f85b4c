//! Division of a communication step into internal steps.
//!
//! A communication step is first divided evenly by `solver.max_step`. Where a piece must be shorter it is halved, again and
//! again, so that the last piece lands exactly on the end of the communication step; halves are joined again as soon as the
//! errors allow. A piece is halved
//!
//! - where the contact finds no state;
//! - with a `solver.tolerance`, where contact force or contact temperature miss their prediction by more than that. The
//!   prediction continues the line through the two states before, or the last state after a jump of the inputs. What is
//!   missed is of second order in the step and larger than the error of the second-order formula, so that loss of contact,
//!   re-contact, lock-up and breaking loose need no rules of their own. The sliding of a wheel that has broken loose shows
//!   little in it: the force is that of friction whatever the wheel does;
//! - where the contact heats or cools by hundreds of kelvin in one long piece, with or without a tolerance: friction that
//!   falls with the temperature follows the temperatures of the steps before.

use super::control::{Drive, Inputs};
use super::error::StepError;
use super::model::{Model, Workspace};
use super::state::{State, StepControl};
use super::step::{Demand, step};
use crate::config::Tuning;
use crate::heat::HeatFlows;

/// Longest communication step \[s].
pub const LONGEST_STEP: f64 = 3600.0;
/// Shortest internal step \[s]: below, waves do not cross an element and the contact may find no state. Communication
/// steps that are shorter, such as those that rounding leaves at the end of a run, wait for the next one.
pub const SHORTEST_STEP: f64 = 5e-7;
/// Most internal steps into which `solver.max_step` may divide a communication step: the longest one in tenths of a second,
/// and some. They take less than half a minute.
const MOST_PIECES: u64 = 40_000;
/// How often in succession a step that finds no contact state is halved before it is given up.
const MAX_HALVINGS: u32 = 12;
/// Internal step below which errors do not refine any further [s]: forces may jump, with the friction coefficient.
const FINEST: f64 = 1e-5;
/// Change of the highest contact temperature [K] that always refines steps longer than this [s].
const HEATING: (f64, f64) = (300.0, 1e-3);
/// Share of the tolerance, and of [`HEATING`], below which the step doubles; the difference grows fourfold.
const GROWTH: f64 = 0.125;
/// Temperature change that counts as much as the nominal load, unless the contact is hotter [K].
const WARM: f64 = 100.0;

/// Control of a stationary start: the errors do not limit the step yet.
pub fn unlimited(state: &State) -> StepControl {
    StepControl { step: f64::INFINITY, before: controlled(state) }
}

/// Forces on the wheel [N/m] and highest rise of temperature in the contact [K].
fn controlled(state: &State) -> [f64; 3] {
    let [force_x, force_y, _] = state.contact.traction.resultant;
    let temperatures = state.thermal.as_ref().map(|thermal| &thermal.temperatures);
    [force_x, force_y, temperatures.map_or(0.0, |t| t.wheel_max.max(t.rail_max))]
}

/// Place within a communication step: `done` of `pieces` equal pieces lie behind.
#[derive(Clone, Copy)]
struct Place {
    done: u64,
    pieces: u64,
}

impl Place {
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
    model: &Model,
    tuning: &Tuning,
    state: &State,
    inputs: &Inputs,
    h: f64,
    workspace: &mut Workspace,
    out: &mut State,
) -> Result<(), StepError> {
    inputs.validate()?;
    if !(h > 0.0 && h <= LONGEST_STEP) {
        return Err(StepError::StepSize { step: h, longest: LONGEST_STEP });
    }
    let end = inputs.at(h);
    end.validate()?;
    let [velocity, displacement, omega] = state.motion.values();
    let start = Drive { omega, velocity, displacement, ..inputs.at(0.0) };
    let h = h + state.pending;
    if h < SHORTEST_STEP {
        out.clone_from(state);
        out.pending = h;
        return Ok(());
    }
    let [mut now, mut next] = std::mem::take(&mut workspace.states);
    let ramp = Ramp { inputs, start, end, h };
    let result = march(model, tuning, state, &ramp, workspace, &mut now, &mut next);
    if result.is_ok() {
        std::mem::swap(out, &mut now);
        out.time = state.time + h;
    }
    workspace.states = [now, next];
    result
}

/// Inputs over a communication step, as the internal steps take them.
struct Ramp<'a> {
    inputs: &'a Inputs,
    start: Drive,
    end: Drive,
    /// Its length [s].
    h: f64,
}

impl Ramp<'_> {
    /// Values at a fraction of the step; prescribed motions move linearly.
    fn at(&self, fraction: f64) -> Drive {
        self.start.zip(&self.end, |a, b| if fraction == 1.0 { b } else { a + fraction * (b - a) })
    }
}

/// Takes all internal steps; `now` is the state after the last one, `next` a buffer.
fn march(
    model: &Model,
    tuning: &Tuning,
    state: &State,
    ramp: &Ramp,
    workspace: &mut Workspace,
    now: &mut State,
    next: &mut State,
) -> Result<(), StepError> {
    let fewest = (ramp.h / tuning.max_step - 1e-9).ceil().max(1.0) as u64;
    if fewest > MOST_PIECES {
        let (step, max_step) = (ramp.h, tuning.max_step);
        return Err(StepError::TooManySteps { step, max_step, pieces: fewest, most: MOST_PIECES });
    }
    let mut place = Place { done: 0, pieces: fewest };
    let mut control = state.control;
    while tuning.tolerance > 0.0 && ramp.h / place.pieces as f64 > control.step * (1.0 + 1e-9) {
        place.halve();
    }
    let (mut last_step, mut failures, mut begun, mut counts) = (state.last_step, 0, false, [0, 0]);
    let mut flows = HeatFlows::default();
    while place.done < place.pieces {
        let from: &State = if begun { now } else { state };
        let dt = ramp.h / place.pieces as f64;
        let [begin, target] = [place.done, place.done + 1].map(|done| ramp.at(done as f64 / place.pieces as f64));
        let demand = Demand { inputs: ramp.inputs, begin: &begin, target: &target, tuning, last_step };
        match step(model, from, &demand, dt, workspace, next) {
            Ok(()) => {}
            Err(StepError::Contact { .. } | StepError::NotFinite { .. })
                if failures < MAX_HALVINGS && dt >= 2.0 * SHORTEST_STEP =>
            {
                failures += 1;
                last_step = 0.0;
                place.halve();
                continue;
            }
            Err(error) => return Err(error),
        }
        let found = Found::compare(model, from, next, &control, last_step, dt);
        if found.too_rough(tuning.tolerance, dt) {
            control.step = 0.5 * dt;
            place.halve();
            continue;
        }
        control.before = controlled(from);
        place.done += 1;
        failures = 0;
        if found.allows_growth(tuning.tolerance) {
            control.step = control.step.max(2.0 * dt);
            place.join(fewest);
        }
        counts = [counts[0] + 1, counts[1] + next.contact.traction.iterations as u64];
        if let Some(thermal) = &next.thermal {
            flows.add(dt / ramp.h, &thermal.flows);
        }
        last_step = next.last_step;
        begun = true;
        std::mem::swap(now, next);
    }
    now.control = control;
    now.friction_power = (now.audit.friction - state.audit.friction) / ramp.h;
    if let Some(thermal) = &mut now.thermal {
        thermal.flows = flows;
    }
    [now.internal_steps, now.iterations] = counts;
    Ok(())
}

/// How far an internal step was from its prediction.
struct Found {
    /// Largest deviation of the controlled quantities from their prediction [1].
    error: f64,
    /// Change of the highest contact temperature [K].
    heating: f64,
}

impl Found {
    fn compare(model: &Model, from: &State, to: &State, control: &StepControl, last_step: f64, dt: f64) -> Self {
        let (before, now, found) = (control.before, controlled(from), controlled(to));
        let load = model.contact.nominal_line_load();
        let scales = [load, load, WARM.max(found[2].abs())];
        // The first step after a jump of the inputs has no history.
        let ratio = if to.restarted || last_step == 0.0 { 0.0 } else { dt / last_step };
        let missed = |k: usize| (found[k] - now[k] - ratio * (now[k] - before[k])).abs() / scales[k];
        Self { error: (0..3).map(missed).fold(0.0, f64::max), heating: (found[2] - now[2]).abs() }
    }

    fn too_rough(&self, tolerance: f64, dt: f64) -> bool {
        let inaccurate = tolerance > 0.0 && self.error > tolerance && dt > 2.0 * FINEST;
        inaccurate || (self.heating > HEATING.0 && dt > HEATING.1 * (1.0 + 1e-9))
    }

    fn allows_growth(&self, tolerance: f64) -> bool {
        (tolerance == 0.0 || self.error <= GROWTH * tolerance) && self.heating <= GROWTH * HEATING.0
    }
}
