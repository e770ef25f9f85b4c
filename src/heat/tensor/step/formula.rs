//! One implicit step of both bodies under one or more lines.
//!
//! Speeds and exchange hold over the step, but for the friction power, whose mean may differ from its end value. The
//! formula is SDIRK2: of second order under constant exchange, stiffly accurate and L-stable (Alexander, *SIAM J.
//! Numer. Anal.* 14 (1977)), with `γ = 1 − 1/√2` and two stages
//!
//! ```text
//! ρcM̃ k₁ = f − A(T + γΔt k₁)
//! ρcM̃ k₂ = f − A(T + (1−γ)Δt k₁ + γΔt k₂)
//! T ← T + (1−γ)Δt k₁ + γΔt k₂
//! ```
//!
//! Where speeds, conductance or heat jump from the last step to this one, and without a last step, one stage with
//! `γ = 1` takes its place: backward Euler, which does not overshoot; likewise where two stages would undershoot by
//! much, and where steel melts.
//!
//! Lines side by side have the same operators where they take the same formula: what belongs to speeds and step size is
//! prepared once, and their fields go through it in pairs.

use super::arrival::arrive;
use super::bounds::{data, search, set_range, swings};
use super::flows::StageEnd;
use super::history::jumps;
use super::limiter::keep_bounds;
use super::load_vector::add_loads;
use super::memory::{HeatScratch, LineWork, StepWork};
use super::plan::StepPlan;
use crate::heat::error::HeatError;
use crate::heat::flows::HeatFlows;
use crate::heat::limits::{check_speeds, check_step};
use crate::heat::model::HeatLine;
use crate::heat::state::HeatState;
use crate::heat::tensor::heat::Heat;
use crate::heat::tensor::mesh::kernels;
use crate::heat::tensor::solve::coefficients::StageCoefficients;
use crate::heat::tensor::solve::line_conduction::contact_nodes;
use crate::heat::tensor::solve::operators::{StageKey, StageOperators};

/// A step of [`HeatModel`](crate::heat::HeatModel).
pub fn advance(
    heat: &Heat,
    lines: &mut [HeatLine],
    dt: f64,
    speeds: [f64; 2],
    scratch: &mut HeatScratch,
) -> Result<(), HeatError> {
    check_step(dt)?;
    check_speeds(speeds)?;
    let layout = &heat.layout;
    if scratch.owner.as_ref() != Some(&layout.config) {
        *scratch = HeatScratch { owner: Some(layout.config.clone()), ..HeatScratch::default() };
    }
    let HeatScratch { begin, lines: own, work, .. } = scratch;
    let count = lines.len().max(own.len());
    begin.resize_with(count, HeatState::default);
    own.resize_with(count, LineWork::default);
    let (begin, own) = (&mut begin[..lines.len()], &mut own[..lines.len()]);
    let mut contact = [0; 2];
    for ((line, begin), own) in lines.iter_mut().zip(&mut *begin).zip(&mut *own) {
        prepare(heat, line, begin, own, dt, speeds)?;
        contact = around(contact, contact_nodes(&own.loads.conductance));
    }
    own.iter_mut().for_each(|own| own.plan.contact = contact);
    let mut first = 0;
    while first < lines.len() {
        let (lines, begin, own) = (&mut lines[first..], &begin[first..], &mut own[first..]);
        first += match (lines.first_chunk_mut::<2>(), begin.first_chunk::<2>(), own.first_chunk_mut::<2>()) {
            (Some(lines), Some(begin), Some(own)) if together(lines, begin, own) => {
                integrate(heat, lines, begin, own, work)?;
                2
            }
            _ => {
                integrate_one(heat, &mut lines[0], &begin[0], &mut own[0], work)?;
                1
            }
        };
    }
    for ((line, begin), own) in lines.iter_mut().zip(&*begin).zip(own) {
        finish(heat, line, begin, own, work)?;
    }
    Ok(())
}

/// Nodes that lie within one of two ranges or between them; equal ends: none.
fn around(a: [usize; 2], b: [usize; 2]) -> [usize; 2] {
    let empty = |range: [usize; 2]| range[0] == range[1];
    match (empty(a), empty(b)) {
        (true, _) => b,
        (_, true) => a,
        _ => [a[0].min(b[0]), a[1].max(b[1])],
    }
}

/// State in which the step of a line begins.
fn beginning<'a>(line: &HeatLine<'a>, begin: &'a HeatState, own: &LineWork) -> &'a HeatState {
    if own.arrived { begin } else { line.state }
}

/// Test that two lines have the same operators.
fn together(lines: &[HeatLine; 2], begin: &[HeatState; 2], own: &[LineWork; 2]) -> bool {
    let key = |i: usize| own[i].plan.key(beginning(&lines[i], &begin[i], &own[i]));
    own.iter().all(|own| !own.plan.melts) && key(0) == key(1)
}

/// Fills loads and plan of a line.
fn prepare(
    heat: &Heat,
    line: &mut HeatLine,
    begin: &mut HeatState,
    own: &mut LineWork,
    dt: f64,
    speeds: [f64; 2],
) -> Result<(), HeatError> {
    let (layout, exchange) = (&heat.layout, line.exchange);
    own.arrived = arrive(layout, line.state, heat.content(exchange.arriving), speeds[0], exchange, begin);
    let state = beginning(line, begin, own);
    let loads = &mut own.loads;
    loads.set(layout, exchange, state.arriving)?;
    let bodies = layout.bodies().into_iter().zip(layout.split(&state.values));
    for ((body, field), radiation) in bodies.zip(&mut loads.radiation) {
        radiation.set(body, &layout.config.thermal, field, dt);
    }
    let now = loads.boundary(speeds);
    line.next.arriving = state.arriving;
    line.next.data = data(layout, state, exchange);
    let smooth = state.last.is_some_and(|before| !jumps(layout, &before, &now, dt));
    let (excess, melts) = (exchange.friction_excess, heat.melting_within(state.range).is_some());
    own.plan = StepPlan { dt, speeds, excess, smooth, melts, now, contact: [0; 2] };
    Ok(())
}

/// Keeps the bounds after the time formula, which is replaced where it swings or where steel begins to melt.
fn finish(
    heat: &Heat,
    line: &mut HeatLine,
    begin: &HeatState,
    own: &mut LineWork,
    work: &mut StepWork,
) -> Result<(), HeatError> {
    let (layout, plan) = (&heat.layout, own.plan);
    let state = beginning(line, begin, own);
    let solidus = heat.latent.as_ref().map_or(f64::INFINITY, |latent| latent.melting.solidus);
    set_range(layout, state, line.next, solidus);
    let melts = heat.melting_within(line.next.range).is_some();
    if !plan.melts && (melts || (plan.smooth && swings(line.next))) {
        own.plan = StepPlan { smooth: false, melts, ..plan };
        integrate_one(heat, line, begin, own, work)?;
        search(layout, line.next);
    }
    let next = &mut *line.next;
    let moved = keep_bounds(layout, next, &mut work.values)?;
    if moved || plan.melts || melts {
        next.forget_sums();
    } else {
        own.contact.leave_sums(next);
    }
    if next.data[0] == f64::NEG_INFINITY {
        // The coldest node is a datum from now on.
        search(layout, next);
        next.data[0] = state.data[0].min(next.range[0]);
    }
    next.last = Some(plan.now);
    Ok(())
}

/// [`integrate`] for one line.
fn integrate_one(
    heat: &Heat,
    line: &mut HeatLine,
    begin: &HeatState,
    own: &mut LineWork,
    work: &mut StepWork,
) -> Result<(), HeatError> {
    use std::array::{from_mut, from_ref};
    integrate(heat, from_mut(line), from_ref(begin), from_mut(own), work)
}

/// The time formula from the fields of the states in which the step of the lines begins to those of the next ones; all
/// lines have the same operators.
fn integrate<const L: usize>(
    heat: &Heat,
    lines: &mut [HeatLine; L],
    begin: &[HeatState; L],
    own: &mut [LineWork; L],
    work: &mut StepWork,
) -> Result<(), HeatError> {
    let layout = &heat.layout;
    let states: [&HeatState; L] = std::array::from_fn(|l| beginning(&lines[l], &begin[l], &own[l]));
    let plan = own[0].plan;
    let (dt, (gamma, stages), key) = (plan.dt, plan.stages(), plan.key(states[0]));
    work.solver.stage.operators.set(layout, key)?;
    for ((line, own), state) in lines.iter_mut().zip(&mut *own).zip(states) {
        own.contact.set(&work.solver.stage.operators, layout, &own.loads.conductance)?;
        own.contact.take_sums(layout, state);
        let known = &mut line.next.values;
        if own.plan.melts {
            known.clone_from(&state.values);
        }
        known.resize(state.values.len(), 0.0);
        own.rate.resize(known.len(), 0.0);
        line.flows = HeatFlows::default();
    }
    for index in 1..=stages {
        // Both the weight of the stage and the share of the step by which it takes the field on.
        let weight = if index == stages { gamma } else { 1.0 - gamma };
        let from: [&[f64]; L] =
            std::array::from_fn(|l| if index == 1 { &states[l].values[..] } else { &lines[l].next.values[..] });
        let rates = own.each_mut().map(|own| (&mut own.contact, &mut own.rate[..]));
        work.solver.stage.multiply(layout, StageCoefficients { storage: 0.0, flow: -1.0 }, from, rates);
        for own in &mut *own {
            own.loads.friction_share = own.plan.friction_shares()[index - 1];
            add_loads(&work.solver.stage.operators, layout, &own.loads, (&mut own.contact, &mut own.rate[..]));
        }
        if plan.melts {
            for (line, own) in lines.iter_mut().zip(&mut *own) {
                melt(heat, line, own, key, weight, work)?;
            }
            continue;
        }
        let rates = own.each_mut().map(|own| (&mut own.contact, &mut own.rate[..]));
        let iterations = work.solver.solve(layout, key.coefficients, rates)?;
        let from = if index == 1 { states.map(Some) } else { [None; L] };
        for (((line, own), from), count) in lines.iter_mut().zip(&mut *own).zip(from).zip(iterations) {
            line.flows.iterations += count;
            take_on(heat, line, own, from, [weight, gamma].map(|share| share * dt), &work.solver.stage.operators);
        }
    }
    let [velocity, omega] = plan.speeds;
    if lines.iter().all(|line| line.flows.is_finite()) {
        Ok(())
    } else {
        Err(HeatError::NotFinite { dt, velocity, omega })
    }
}

/// A stage of a line in which steel melts or freezes, from the load that its `rate` holds.
fn melt(
    heat: &Heat,
    line: &mut HeatLine,
    own: &mut LineWork,
    key: StageKey,
    weight: f64,
    work: &mut StepWork,
) -> Result<(), HeatError> {
    let Some(latent) = &heat.latent else { return Ok(()) };
    let (layout, StepWork { solver, melting, .. }) = (&heat.layout, work);
    let LineWork { contact, rate, loads, plan, .. } = own;
    let HeatLine { next, flows, .. } = line;
    let known = &mut next.values;
    flows.iterations += melting.solve(latent, layout, solver, key.coefficients, known, (contact, rate))?;
    kernels::add(weight * plan.dt, rate, known);
    let temperature = melting.temperature(known);
    contact.set_sums(layout, temperature);
    let ends = StageEnd { temperature, content: known, rate: Some(rate), ahead: 0.0 };
    contact.add_flows(&solver.stage.operators, layout, loads, &ends, weight, flows);
    Ok(())
}

/// Takes field, sums and flows of a line on by a stage whose rate has been found, by `ahead` seconds of the step, from
/// the field of the state `from` or, without one, from the field found so far; the flows are those `implicit` seconds
/// on.
fn take_on(
    heat: &Heat,
    line: &mut HeatLine,
    own: &mut LineWork,
    from: Option<&HeatState>,
    [ahead, implicit]: [f64; 2],
    operators: &StageOperators,
) {
    let LineWork { contact, rate, loads, plan, .. } = own;
    let HeatLine { next, flows, .. } = line;
    let field = from.map_or(&next.values, |state| &state.values);
    let ends = StageEnd { temperature: field, content: field, rate: Some(rate), ahead: implicit };
    contact.add_flows(operators, &heat.layout, loads, &ends, ahead / plan.dt, flows);
    match from {
        Some(state) => kernels::sum(&state.values, ahead, rate, &mut next.values),
        None => kernels::add(ahead, rate, &mut next.values),
    }
    contact.advance_sums(ahead);
}
