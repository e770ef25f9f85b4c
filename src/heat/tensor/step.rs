//! One implicit step of both bodies, and their stationary state.

use super::layout::Heat;
use super::loads::SurfaceLoads;
use super::modal::{StageCoefficients, dot};
use super::stage::{CURVED_BELOW, CURVED_STEP, Stage, StageKey};
use super::state::{BoundaryState, HeatState};
use crate::heat::error::HeatError;
use crate::heat::exchange::{Exchange, TreadHeat};
use crate::heat::model::{HeatFlows, LARGEST_STEP, SMALLEST_STEP};
use crate::heat::parameters::HeatConfig;
use std::f64::consts::{FRAC_1_SQRT_2, PI};

/// Storage that keeps the preconditioner of the stationary state regular, relative to `κ/r_o²` [1].
const REGULARISATION: f64 = 1e-3;

/// Memory of a step; holds nothing that outlives it.
#[derive(Clone, Debug, Default)]
pub struct Scratch {
    /// Whose operators `stage` holds.
    owner: Option<HeatConfig>,
    stage: Stage,
    loads: SurfaceLoads,
    load: Vec<f64>,
    rate: Vec<f64>,
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
    /// `γ = 1` takes its place: backward Euler, which does not overshoot.
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
        let Scratch { stage, loads, load, rate, .. } = scratch;
        self.set_loads(exchange, loads)?;
        self.set_radiation(state, dt, &mut loads.radiation);
        let now = boundary(speeds, loads);
        let smooth = state.last.is_some_and(|before| !before.jumps_to(&now));
        let (gamma, stages) = if smooth { (1.0 - FRAC_1_SQRT_2, 2) } else { (1.0, 1) };
        let coefficients = StageCoefficients { storage: 1.0, flow: gamma * dt };
        let curved = speeds[1].abs() < CURVED_BELOW && dt >= CURVED_STEP;
        stage.set(self, loads, StageKey { speeds, coefficients, rate: 1.0 / (gamma * dt), curved })?;
        let held = 1.0 + exchange.friction_excess;
        // The friction power of the stages is that whose mean over the step is the given one; at the end it is the last one's.
        let shares = if stages == 2 { [1.0 + exchange.friction_excess / (1.0 - gamma), 1.0] } else { [held, held] };
        let known = &mut next.field;
        known.clone_from(&state.field);
        let mut flows = HeatFlows::default();
        for index in 1..=stages {
            let (weight, onward) = if index == stages { (gamma, 0.0) } else { (1.0 - gamma, 1.0 - 2.0 * gamma) };
            loads.friction_share = shares[index - 1];
            stage.set_loads(self, loads, load);
            rate.clone_from(load);
            stage.multiply(self, StageCoefficients { storage: 0.0, flow: -1.0 }, known, rate);
            flows.iterations += stage.solve(self, coefficients, rate)?;
            // Temperature at this stage, then the known part of the next one.
            known.iter_mut().zip(&*rate).for_each(|(t, k)| *t += gamma * dt * k);
            stage.add_flows(self, loads, known, Some(rate), weight, &mut flows);
            if onward != 0.0 {
                known.iter_mut().zip(&*rate).for_each(|(t, k)| *t += onward * dt * k);
            }
        }
        if !flows.is_finite() {
            return Err(HeatError::NotFinite { dt, velocity: speeds[0], omega: speeds[1] });
        }
        next.last = Some(now);
        Ok(flows)
    }

    /// The stationary state of [`HeatModel::stationary`](crate::heat::HeatModel::stationary).
    pub(super) fn settle(&self, speeds: [f64; 2], exchange: &Exchange) -> Result<(HeatState, HeatFlows), HeatError> {
        check_speeds(speeds)?;
        let (mut stage, mut loads) = (Stage::default(), SurfaceLoads::default());
        self.set_loads(exchange, &mut loads)?;
        let storage = REGULARISATION * self.config.diffusivity() / self.config.wheel.radius.powi(2);
        let coefficients = StageCoefficients { storage, flow: 1.0 };
        stage.set(self, &loads, StageKey { speeds, coefficients, rate: 0.0, curved: true })?;
        let mut field = Vec::new();
        stage.set_loads(self, &loads, &mut field);
        let solved = stage.solve(self, StageCoefficients { storage: 0.0, flow: 1.0 }, &mut field);
        let iterations = solved.map_err(|error| match error {
            HeatError::NotConverged { residual, iterations, .. } => {
                HeatError::NoStationaryState { residual, iterations }
            }
            other => other,
        })?;
        let mut flows = HeatFlows { iterations, ..HeatFlows::default() };
        stage.add_flows(self, &loads, &field, None, 1.0, &mut flows);
        if !flows.is_finite() {
            return Err(HeatError::NotFinite { dt: f64::INFINITY, velocity: speeds[0], omega: speeds[1] });
        }
        Ok((HeatState { field, last: Some(boundary(speeds, &loads)) }, flows))
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
        stage.set(self, &loads, StageKey { speeds, coefficients, rate: 0.0, curved: false })?;
        let mut field = Vec::new();
        stage.set_loads(self, &loads, &mut field);
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
        Ok(HeatState { field, last: None })
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
