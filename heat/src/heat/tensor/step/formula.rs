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
//! prepared once.

use super::arrival::arrive;
use super::bounds::{data, search, set_range, swings};
use super::flows::StageEnd;
use super::limiter::keep_bounds;
use super::load_vector::{add_others, add_surface_loads, has_others, set_surface_loads};
use super::memory::{HeatScratch, LineWork, StepWork};
use super::plan::{StepPlan, jumps};
use crate::heat::error::HeatError;
use crate::heat::flows::HeatFlows;
use crate::heat::limits::{check_speeds, check_step};
use crate::heat::model::HeatLine;
use crate::heat::state::HeatState;
use crate::heat::tensor::heat::Heat;
use crate::heat::tensor::mesh::kernels::{self, Advance};
use crate::heat::tensor::solve::line_conduction::contact_nodes;
use crate::heat::tensor::solve::operators::StageKey;
use crate::heat::tensor::solve::stage::RATE;
use crate::linalg::Update;

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
    for ((line, begin), own) in lines.iter_mut().zip(&*begin).zip(&mut *own) {
        integrate(heat, line, begin, own, work)?;
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
    set_range(layout, state, &own.moved, line.next, solidus);
    let melts = heat.melting_within(line.next.range).is_some();
    if !plan.melts && (melts || (plan.smooth && swings(line.next))) {
        own.plan = StepPlan { smooth: false, melts, ..plan };
        integrate(heat, line, begin, own, work)?;
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

/// The time formula from the field of the state in which the step of a line begins to that of the next one.
fn integrate(
    heat: &Heat,
    line: &mut HeatLine,
    begin: &HeatState,
    own: &mut LineWork,
    work: &mut StepWork,
) -> Result<(), HeatError> {
    let layout = &heat.layout;
    let state = beginning(line, begin, own);
    let plan = own.plan;
    let ((_, stages), key) = (plan.stages(), plan.key(state));
    work.stage.operators.set(layout, key)?;
    own.contact.set(&work.stage.operators, layout, &own.loads.conductance)?;
    own.contact.take_sums(layout, state);
    for field in [&mut line.next.values, &mut own.rate, &mut own.between] {
        field.resize(layout.size(), 0.0);
    }
    own.moved.resize(layout.bodies().map(|body| body.streamline.len()).iter().sum(), 0.0);
    line.flows = HeatFlows::default();
    for index in 1..=stages {
        own.loads.friction_share = plan.friction_shares()[index - 1];
        find_rate(heat, line, state, own, work, index, key)?;
        take_on(heat, line, state, own, work, index);
    }
    let StepPlan { dt, speeds: [velocity, omega], .. } = plan;
    if line.flows.is_finite() { Ok(()) } else { Err(HeatError::NotFinite { dt, velocity, omega }) }
}

/// Finds the rate of a stage, counted from 1, of a step from `state`.
fn find_rate(
    heat: &Heat,
    line: &mut HeatLine,
    state: &HeatState,
    own: &mut LineWork,
    work: &mut StepWork,
    index: usize,
    key: StageKey,
) -> Result<(), HeatError> {
    let (layout, StepWork { stage, melting, .. }) = (&heat.layout, work);
    let LineWork { contact, rate, between, loads, plan, .. } = own;
    let (field, operators) = (if index == 1 { &state.values } else { &*between }, &mut stage.operators);
    set_surface_loads(operators, layout, loads, contact);
    if !plan.melts && !key.curved {
        contact.load_conduction(layout, field);
        let mut update = Update::Replace;
        if has_others(loads) {
            rate.fill(0.0);
            add_others(operators, layout, loads, (contact, rate));
            update = Update::Add;
        }
        operators.find_rate(layout, field, (contact, rate), update);
        return Ok(());
    }
    operators.multiply(layout, RATE, field, (contact, rate));
    add_surface_loads(layout, (contact, rate));
    add_others(operators, layout, loads, (contact, rate));
    line.flows.iterations += match &heat.latent {
        Some(latent) if plan.melts => melting.solve(latent, layout, stage, key.coefficients, field, (contact, rate))?,
        _ => stage.solve(layout, key.coefficients, (contact, rate))?,
    };
    Ok(())
}

/// Takes field, sums and flows of a line on by a stage, counted from 1, whose rate has been found; in the last one also
/// tells by how much the field has moved.
fn take_on(
    heat: &Heat,
    line: &mut HeatLine,
    state: &HeatState,
    own: &mut LineWork,
    StepWork { stage, melting, .. }: &mut StepWork,
    index: usize,
) {
    let layout = &heat.layout;
    let LineWork { contact, rate, between, moved, loads, plan, .. } = own;
    let HeatLine { next, flows, .. } = line;
    let (gamma, stages) = plan.stages();
    // Both the weight of the stage and the share of the step by which it takes the field on.
    let weight = if index == stages { gamma } else { 1.0 - gamma };
    let ahead = weight * plan.dt;
    let (from, target, moved) = match index {
        1 if stages == 2 => (&state.values, between, &mut [][..]),
        1 => (&state.values, &mut next.values, &mut moved[..]),
        _ => (&*between, &mut next.values, &mut moved[..]),
    };
    let moved: [_; 2] = moved.split_at_mut(layout.wheel.streamline.len().min(moved.len())).into();
    for (i, ((body, side), moved)) in layout.bodies().into_iter().zip(&mut contact.sides).zip(moved).enumerate() {
        let [rate, from, begin] = [rate, from, &state.values].map(|field| layout.part(i, field));
        let (weights, peaks) = (&body.streamline.weights, &body.nodal.peaks);
        side.sums[1].resize(body.modes.len(), 0.0);
        let stage = Advance { rate, ahead, from, begin, weights, peaks };
        kernels::advance(index == stages, &stage, layout.part_mut(i, target), &mut side.sums[1], moved);
    }
    if plan.melts {
        let temperature = melting.temperature(&next.values);
        contact.set_sums(layout, temperature);
        let ends = StageEnd { temperature, content: &next.values, rate: Some(rate), ahead: 0.0 };
        return contact.add_flows(&stage.operators, layout, loads, &ends, weight, flows);
    }
    let ends = StageEnd { temperature: from, content: from, rate: Some(rate), ahead: gamma * plan.dt };
    contact.add_flows(&stage.operators, layout, loads, &ends, weight, flows);
    contact.advance_sums(ahead);
}
