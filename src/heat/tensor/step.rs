//! One implicit step of both bodies, and their stationary state.

use super::flows::StageEnd;
use super::layout::Heat;
use super::loads::SurfaceLoads;
use super::melt::Melt;
use super::modal::{StageCoefficients, dot};
use super::rows;
use super::stage::{CURVED_BELOW, CURVED_STEP, Stage, StageKey};
use super::state::{BoundaryState, HeatState};
use crate::heat::error::HeatError;
use crate::heat::exchange::{Exchange, TreadHeat};
use crate::heat::melting::Melting;
use crate::heat::model::{HeatFlows, LARGEST_STEP, SMALLEST_STEP};
use crate::heat::parameters::HeatConfig;
use std::f64::consts::{FRAC_1_SQRT_2, PI};

/// Storage that keeps the preconditioner of the stationary state regular, relative to `κ/r_o²` [1].
const REGULARISATION: f64 = 1e-3;

/// Memory of a step; holds nothing that outlives it.
#[derive(Default)]
pub struct Scratch {
    /// Whose operators `work` holds.
    owner: Option<HeatConfig>,
    /// Where the step begins if another rail arrives.
    begin: HeatState,
    work: Work,
}

/// Memory of the stages.
#[derive(Default)]
struct Work {
    stage: Stage,
    loads: SurfaceLoads,
    load: Vec<f64>,
    rate: Vec<f64>,
    /// Values at the nodes below one surface node.
    values: Vec<f64>,
    melt: Melt,
}

/// How a step is taken.
#[derive(Clone, Copy)]
struct March {
    dt: f64,
    speeds: [f64; 2],
    /// By how much the mean friction power exceeds that at the end, relative to the latter [1].
    excess: f64,
    /// Whether two stages may be taken.
    smooth: bool,
    /// Where steel melts or freezes.
    melting: Option<Melting>,
}

impl Heat {
    /// A step of [`HeatModel::step`](crate::heat::HeatModel::step).
    ///
    /// Speeds and exchange hold over the step, but for the friction power, whose mean may differ from its end value. The
    /// formula is SDIRK2: of second order under constant exchange, stiffly
    /// accurate and L-stable (Alexander, *SIAM J. Numer. Anal.* 14 (1977)), with `γ = 1 − 1/√2` and two stages
    ///
    /// ```text
    /// ρcM̃ k₁ = f − A(T + γΔt k₁)
    /// ρcM̃ k₂ = f − A(T + (1−γ)Δt k₁ + γΔt k₂)
    /// T ← T + (1−γ)Δt k₁ + γΔt k₂
    /// ```
    ///
    /// Where speeds, conductance or heat jump from the last step to this one, and without a last step, one stage with
    /// `γ = 1` takes its place: backward Euler, which does not overshoot; likewise where two stages would undershoot
    /// by much, and where steel melts.
    pub(super) fn advance(
        &self,
        state: &HeatState,
        next: &mut HeatState,
        dt: f64,
        speeds: [f64; 2],
        exchange: &Exchange,
        scratch: &mut Scratch,
    ) -> Result<HeatFlows, HeatError> {
        if !(SMALLEST_STEP..=LARGEST_STEP).contains(&dt) {
            return Err(HeatError::StepSize { dt, shortest: SMALLEST_STEP, longest: LARGEST_STEP });
        }
        check_speeds(speeds)?;
        if scratch.owner.as_ref() != Some(&self.config) {
            *scratch = Scratch { owner: Some(self.config.clone()), ..Scratch::default() };
        }
        let Scratch { begin, work, .. } = scratch;
        let met = self.meet(state, speeds[0], exchange, begin);
        let state = if met { &*begin } else { state };
        self.set_loads(exchange, &mut work.loads)?;
        work.loads.arriving = state.arriving;
        self.set_radiation(state, dt, &mut work.loads.radiation);
        let now = boundary(speeds, &work.loads);
        next.arriving = state.arriving;
        next.data = self.data(state, exchange);
        let molten = |range: [f64; 2]| self.melting.filter(|melting| range[1] > melting.solidus);
        let smooth = state.last.is_some_and(|before| !before.jumps_to(&now));
        let march = March { dt, speeds, excess: exchange.friction_excess, smooth, melting: molten(state.range) };
        let mut flows = self.march(state, next, &march, work)?;
        self.set_range(state, next);
        let melting = molten(next.range);
        if march.melting.is_none() && (melting.is_some() || (smooth && next.swings())) {
            flows = self.march(state, next, &March { smooth: false, melting, ..march }, work)?;
            next.range = self.extremes(&next.field);
        }
        self.keep_bounds(next, &mut work.values)?;
        if next.data[0] == f64::NEG_INFINITY {
            // What was cooled is from now on the coldest that acts.
            next.range = self.extremes(&next.field);
            next.data[0] = state.data[0].min(next.range[0]);
        }
        next.last = Some(now);
        Ok(flows)
    }

    /// One step of the time formula from the field of `state` to that of `next`.
    fn march(
        &self,
        state: &HeatState,
        next: &mut HeatState,
        march: &March,
        work: &mut Work,
    ) -> Result<HeatFlows, HeatError> {
        let &March { dt, speeds, excess, smooth, melting } = march;
        let Work { stage, loads, load, rate, melt, .. } = work;
        let two = smooth && melting.is_none();
        let (gamma, stages) = if two { (1.0 - FRAC_1_SQRT_2, 2) } else { (1.0, 1) };
        let coefficients = StageCoefficients { storage: 1.0, flow: gamma * dt };
        let curved = speeds[1].abs() < CURVED_BELOW && dt >= CURVED_STEP;
        // Two stages bear a neighbouring matrix: where nothing changes in time, their result does not depend on it.
        let inverted = if two && !curved { state.shared_speeds(speeds) } else { speeds };
        stage.set(self, loads, StageKey { speeds, inverted, coefficients, rate: 1.0 / (gamma * dt), curved })?;
        let held = 1.0 + excess;
        // The friction power of the stages is that whose mean over the step is the given one; at the end it is the last
        // one's, unless the first one had to cool for that.
        let first = 1.0 + excess / (1.0 - gamma);
        let shares = if stages == 2 && first >= 0.0 { [first, 1.0] } else { [held, held] };
        let known = &mut next.field;
        if melting.is_some() {
            known.clone_from(&state.field);
        }
        known.resize(state.field.len(), 0.0);
        stage.set_sums(self, &state.field);
        let mut flows = HeatFlows::default();
        for index in 1..=stages {
            // Both the weight of the stage and the share of the step by which it takes the field on.
            let weight = if index == stages { gamma } else { 1.0 - gamma };
            loads.friction_share = shares[index - 1];
            rate.resize(known.len(), 0.0);
            let from = if index == 1 { &state.field } else { &*known };
            stage.multiply(self, StageCoefficients { storage: 0.0, flow: -1.0 }, from, rate);
            stage.add_loads(self, loads, rate);
            flows.iterations += match &melting {
                None => stage.solve(self, coefficients, rate)?,
                Some(melting) => {
                    load.clone_from(rate);
                    self.melt(melting, stage, coefficients, known, [load, rate], melt)?
                }
            };
            if melting.is_some() {
                rows::add(weight * dt, rate, known);
                let temperature = melt.temperature(known);
                stage.set_sums(self, temperature);
                let ends = StageEnd { temperature, content: known, rate: Some(rate), ahead: 0.0 };
                stage.add_flows(self, loads, &ends, weight, &mut flows);
            } else {
                let from = if index == 1 { &state.field } else { &*known };
                let ends = StageEnd { temperature: from, content: from, rate: Some(rate), ahead: gamma * dt };
                stage.add_flows(self, loads, &ends, weight, &mut flows);
                match index {
                    1 => rows::sum(&state.field, weight * dt, rate, known),
                    _ => rows::add(weight * dt, rate, known),
                }
                stage.advance_sums(weight * dt);
            }
        }
        if !flows.is_finite() {
            return Err(HeatError::NotFinite { dt, velocity: speeds[0], omega: speeds[1] });
        }
        Ok(flows)
    }

    /// The stationary state of [`HeatModel::stationary`](crate::heat::HeatModel::stationary), before undershoots are lifted.
    pub fn settle(&self, speeds: [f64; 2], exchange: &Exchange) -> Result<(HeatState, HeatFlows), HeatError> {
        check_speeds(speeds)?;
        let (mut stage, mut loads) = (Stage::default(), SurfaceLoads::default());
        self.set_loads(exchange, &mut loads)?;
        let storage = REGULARISATION * self.config.diffusivity() / self.config.wheel.radius.powi(2);
        let coefficients = StageCoefficients { storage, flow: 1.0 };
        stage.set(self, &loads, StageKey { speeds, inverted: speeds, coefficients, rate: 0.0, curved: true })?;
        let mut field = vec![0.0; self.wheel.size() + self.rail.size()];
        stage.add_loads(self, &loads, &mut field);
        let solved = stage.solve(self, StageCoefficients { storage: 0.0, flow: 1.0 }, &mut field);
        let iterations = solved.map_err(|error| match error {
            HeatError::NotConverged { residual, iterations, .. } => {
                HeatError::NoStationaryState { residual, iterations }
            }
            other => other,
        })?;
        let mut flows = HeatFlows { iterations, ..HeatFlows::default() };
        stage.set_sums(self, &field);
        let ends = StageEnd { temperature: &field, content: &field, rate: None, ahead: 0.0 };
        stage.add_flows(self, &loads, &ends, 1.0, &mut flows);
        if !flows.is_finite() {
            return Err(HeatError::NotFinite { dt: f64::INFINITY, velocity: speeds[0], omega: speeds[1] });
        }
        let (last, arriving) = (Some(boundary(speeds, &loads)), loads.arriving);
        let mut state = HeatState { field, last, arriving, ..HeatState::default() };
        state.data = self.data(&state, exchange);
        state.range = self.extremes(&state.field);
        Ok((state, flows))
    }

    /// What a wheel loses and the rail gains where they touch, as after many turns, if the mean temperature of the tread is
    /// `tread` \[K]; of `exchange` only patches and pressure count.
    ///
    /// It is the stationary state of a wheel that is kept warm by even heat on its tread, less the mean along every
    /// streamline of the wheel, which changes within minutes. The modal solver is exact enough for it: what it neglects
    /// acts on the mean.
    pub fn passing(&self, speeds: [f64; 2], exchange: &Exchange, tread: f64) -> Result<HeatState, HeatError> {
        check_speeds(speeds)?;
        let (mut stage, mut loads) = (Stage::default(), SurfaceLoads::default());
        let even = Exchange {
            patches: exchange.patches.clone(),
            pressure: exchange.pressure.clone(),
            tread: vec![TreadHeat { angle: 0.0, width: 2.0 * PI, heat: 1.0 }],
            ..Exchange::default()
        };
        self.set_loads(&even, &mut loads)?;
        let storage = REGULARISATION * self.config.diffusivity() / self.config.wheel.radius.powi(2);
        let coefficients = StageCoefficients { storage, flow: 1.0 };
        stage.set(self, &loads, StageKey { speeds, inverted: speeds, coefficients, rate: 0.0, curved: false })?;
        let mut field = vec![0.0; self.wheel.size() + self.rail.size()];
        stage.add_loads(self, &loads, &mut field);
        stage.solve(self, coefficients, &mut field)?;
        let (wheel, mut mean) = (&self.wheel, Vec::new());
        wheel.integrate(&field[..wheel.size()], &mut mean);
        mean.iter_mut().for_each(|sum| *sum /= wheel.line.closed);
        for row in field[..wheel.size()].chunks_exact_mut(wheel.modes.len()) {
            row.iter_mut().zip(&mean).for_each(|(value, mean)| *value -= mean);
        }
        let scale = tread / dot(&mean, &wheel.modes.surface);
        field.iter_mut().for_each(|value| *value *= scale);
        if !field.iter().all(|value| value.is_finite()) {
            return Err(HeatError::NotFinite { dt: f64::INFINITY, velocity: speeds[0], omega: speeds[1] });
        }
        let range = self.extremes(&field);
        Ok(HeatState { field, range, ..HeatState::default() })
    }
}

/// What acts during a step, summed up.
fn boundary(speeds: [f64; 2], loads: &SurfaceLoads) -> BoundaryState {
    let total = |moments: &[[f64; 2]]| moments.iter().map(|q| q[0]).sum();
    BoundaryState {
        speeds,
        conductance: loads.conductance.iter().map(|c| c[0]).sum(),
        heat: [total(&loads.friction), total(&loads.tread)],
    }
}

fn check_speeds(speeds: [f64; 2]) -> Result<(), HeatError> {
    for (name, value) in ["velocity", "angular velocity"].into_iter().zip(speeds) {
        if !value.is_finite() {
            return Err(HeatError::Input { name, value });
        }
    }
    Ok(())
}
