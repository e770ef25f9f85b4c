//! One implicit step of both bodies.
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

use super::arrival::arrive;
use super::bounds::{data, search, set_range, swings};
use super::flows::StageEnd;
use super::history::{jumps, shared_speeds};
use super::limiter::keep_bounds;
use super::load_vector::add_loads;
use super::memory::{HeatScratch, StepWork};
use crate::heat::error::HeatError;
use crate::heat::exchange::Exchange;
use crate::heat::flows::HeatFlows;
use crate::heat::limits::{check_speeds, check_step};
use crate::heat::state::HeatState;
use crate::heat::tensor::heat::Heat;
use crate::heat::tensor::melt::latent::LatentHeat;
use crate::heat::tensor::mesh::kernels;
use crate::heat::tensor::mesh::layout::HeatLayout;
use crate::heat::tensor::solve::coefficients::StageCoefficients;
use crate::heat::tensor::solve::solver::{CURVED_BELOW, CURVED_STEP};
use crate::heat::tensor::solve::stage::StageKey;
use std::f64::consts::FRAC_1_SQRT_2;

/// Coefficient `γ` of the formula with two stages.
const TWO_STAGES: f64 = 1.0 - FRAC_1_SQRT_2;

/// Plan of a step.
#[derive(Clone, Copy)]
struct StepPlan<'a> {
    dt: f64,
    speeds: [f64; 2],
    /// By how much the mean friction power exceeds that at the end, relative to the latter \[1].
    excess: f64,
    /// True where two stages may be taken.
    smooth: bool,
    /// Latent heat, where steel melts or freezes.
    melting: Option<&'a LatentHeat>,
}

impl StepPlan<'_> {
    /// Coefficient γ of each stage, and how many there are.
    fn stages(&self) -> (f64, usize) {
        if self.smooth && self.melting.is_none() { (TWO_STAGES, 2) } else { (1.0, 1) }
    }

    /// Speeds and coefficients of the matrix of a stage.
    fn key(&self, state: &HeatState) -> StageKey {
        let &Self { dt, speeds, .. } = self;
        let (gamma, stages) = self.stages();
        let curved = speeds[1].abs() < CURVED_BELOW && dt >= CURVED_STEP;
        // Two stages bear a neighbouring matrix: where nothing changes in time, their result does not depend on it.
        let inverted = if stages == 2 && !curved { shared_speeds(state, speeds) } else { speeds };
        let coefficients = StageCoefficients { storage: 1.0, flow: gamma * dt };
        StageKey { speeds, inverted, coefficients, rate: 1.0 / (gamma * dt), curved }
    }

    /// Shares of the friction power at the end of the step that act in the stages. Their mean over the step is the
    /// given one; the share of the last one is 1, unless the first one had to cool for that.
    fn friction_shares(&self) -> [f64; 2] {
        let (gamma, stages) = self.stages();
        let held = 1.0 + self.excess;
        let first = 1.0 + self.excess / (1.0 - gamma);
        if stages == 2 && first >= 0.0 { [first, 1.0] } else { [held, held] }
    }
}

/// A step of [`HeatModel::step`](crate::heat::HeatModel::step).
pub fn advance(
    heat: &Heat,
    state: &HeatState,
    next: &mut HeatState,
    dt: f64,
    speeds: [f64; 2],
    exchange: &Exchange,
    scratch: &mut HeatScratch,
) -> Result<HeatFlows, HeatError> {
    check_step(dt)?;
    check_speeds(speeds)?;
    let layout = &heat.layout;
    if scratch.owner.as_ref() != Some(&layout.config) {
        *scratch = HeatScratch { owner: Some(layout.config.clone()), ..HeatScratch::default() };
    }
    let HeatScratch { begin, work, .. } = scratch;
    let arrived = arrive(layout, state, heat.content(exchange.arriving), speeds[0], exchange, begin);
    let state = if arrived { &*begin } else { state };
    work.loads.set(layout, exchange, state.arriving)?;
    let bodies = layout.bodies().into_iter().zip(layout.split(&state.values));
    for ((body, field), radiation) in bodies.zip(&mut work.loads.radiation) {
        radiation.set(body, &layout.config.thermal, field, dt);
    }
    let now = work.loads.boundary(speeds);
    next.arriving = state.arriving;
    next.data = data(layout, state, exchange);
    let smooth = state.last.is_some_and(|before| !jumps(&before, &now));
    let excess = exchange.friction_excess;
    let plan = StepPlan { dt, speeds, excess, smooth, melting: heat.melting_within(state.range) };
    let mut flows = integrate(layout, state, next, &plan, work)?;
    let melts = heat.latent.as_ref().map_or(f64::INFINITY, |latent| latent.melting.solidus);
    set_range(layout, state, next, melts);
    let melting = heat.melting_within(next.range);
    if plan.melting.is_none() && (melting.is_some() || (smooth && swings(next))) {
        flows = integrate(layout, state, next, &StepPlan { smooth: false, melting, ..plan }, work)?;
        search(layout, next);
    }
    let moved = keep_bounds(layout, next, &mut work.values)?;
    if moved || plan.melting.or(melting).is_some() {
        next.forget_sums();
    } else {
        work.solver.stage.leave_sums(next);
    }
    if next.data[0] == f64::NEG_INFINITY {
        // The coldest node is a datum from now on.
        search(layout, next);
        next.data[0] = state.data[0].min(next.range[0]);
    }
    next.last = Some(now);
    Ok(flows)
}

/// The time formula from the field of `state` to that of `next`.
fn integrate(
    layout: &HeatLayout,
    state: &HeatState,
    next: &mut HeatState,
    plan: &StepPlan,
    work: &mut StepWork,
) -> Result<HeatFlows, HeatError> {
    let StepWork { solver, loads, rate, melting: iteration, .. } = work;
    let (dt, (gamma, stages), key) = (plan.dt, plan.stages(), plan.key(state));
    solver.stage.set(layout, &loads.conductance, key)?;
    let shares = plan.friction_shares();
    let known = &mut next.values;
    if plan.melting.is_some() {
        known.clone_from(&state.values);
    }
    known.resize(state.values.len(), 0.0);
    solver.stage.take_sums(layout, state);
    let mut flows = HeatFlows::default();
    for index in 1..=stages {
        // Both the weight of the stage and the share of the step by which it takes the field on.
        let weight = if index == stages { gamma } else { 1.0 - gamma };
        loads.friction_share = shares[index - 1];
        rate.resize(known.len(), 0.0);
        let from = if index == 1 { &state.values } else { &*known };
        solver.stage.multiply(layout, StageCoefficients { storage: 0.0, flow: -1.0 }, from, rate);
        add_loads(&mut solver.stage, layout, loads, rate);
        if let Some(latent) = plan.melting {
            flows.iterations += iteration.solve(latent, layout, solver, key.coefficients, known, rate)?;
            kernels::add(weight * dt, rate, known);
            let temperature = iteration.temperature(known);
            solver.stage.set_sums(layout, temperature);
            let ends = StageEnd { temperature, content: known, rate: Some(rate), ahead: 0.0 };
            solver.stage.add_flows(layout, loads, &ends, weight, &mut flows);
        } else {
            flows.iterations += solver.solve(layout, key.coefficients, rate)?;
            let from = if index == 1 { &state.values } else { &*known };
            let ends = StageEnd { temperature: from, content: from, rate: Some(rate), ahead: gamma * dt };
            solver.stage.add_flows(layout, loads, &ends, weight, &mut flows);
            match index {
                1 => kernels::sum(&state.values, weight * dt, rate, known),
                _ => kernels::add(weight * dt, rate, known),
            }
            solver.stage.advance_sums(weight * dt);
        }
    }
    let [velocity, omega] = plan.speeds;
    if flows.is_finite() { Ok(flows) } else { Err(HeatError::NotFinite { dt, velocity, omega }) }
}
