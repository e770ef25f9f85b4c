//! One implicit step of both bodies, and their stationary state.

use super::loads::SurfaceLoads;
use super::modal::StageCoefficients;
use super::stage::{Stage, StageKey};
use super::{CURVED_BELOW, CURVED_STEP, Heat, HeatState};
use crate::heat::{Exchange, HeatConfig, HeatError, HeatFlows};
use serde::{Deserialize, Serialize};
use std::f64::consts::FRAC_1_SQRT_2;

/// Shortest step \[s].
pub const SMALLEST_STEP: f64 = 1e-9;
/// Longest step \[s].
pub const LARGEST_STEP: f64 = 1e6;
/// Storage that keeps the preconditioner of the stationary state regular, relative to `κ/r_o²` [1].
const REGULARISATION: f64 = 1e-3;

/// Relative change of speeds, conductance or heat from one step to the next that counts as a jump.
const JUMP: f64 = 0.3;
/// Heat whose changes do not count [W/m]: it warms a rolling contact by less than a kelvin.
const SLIGHT_HEAT: f64 = 1e4;

/// Speeds and totals of what acts during a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct BoundaryState {
    /// Velocity of the wheel's centre [m/s] and angular velocity [rad/s], forward rolling positive.
    speeds: [f64; 2],
    /// Contact conductance integrated over the patch [W/(m K)].
    conductance: f64,
    /// Friction heat and heat on the tread [W/m].
    heat: [f64; 2],
}

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
    /// A step of [`HeatModel::step`](super::HeatModel::step).
    ///
    /// Speeds and exchange hold over the step. The formula is SDIRK2: of second order under constant exchange, stiffly
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
            return Err(HeatError::StepSize { dt });
        }
        check_speeds(speeds)?;
        if scratch.owner.as_ref() != Some(&self.config) {
            *scratch = Scratch { owner: Some(self.config.clone()), ..Scratch::default() };
        }
        let Scratch { stage, loads, load, rate, .. } = scratch;
        self.set_loads(exchange, loads)?;
        let now = BoundaryState::new(speeds, loads);
        let smooth = state.last.is_some_and(|before| !before.jumps_to(&now));
        let (gamma, stages) = if smooth { (1.0 - FRAC_1_SQRT_2, 2) } else { (1.0, 1) };
        let coefficients = StageCoefficients { storage: 1.0, flow: gamma * dt };
        let curved = speeds[1].abs() < CURVED_BELOW && dt >= CURVED_STEP;
        stage.set(self, loads, StageKey { speeds, coefficients, rate: 1.0 / (gamma * dt), curved })?;
        stage.set_loads(self, loads, load);
        let known = &mut next.field;
        known.clone_from(&state.field);
        let mut flows = HeatFlows::default();
        for index in 1..=stages {
            let (weight, onward) = if index == stages { (gamma, 0.0) } else { (1.0 - gamma, 1.0 - 2.0 * gamma) };
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

    /// The stationary state of [`HeatModel::stationary`](super::HeatModel::stationary).
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
            HeatError::NotConverged { residual, iterations } => HeatError::NoStationaryState { residual, iterations },
            other => other,
        })?;
        let mut flows = HeatFlows { iterations, ..HeatFlows::default() };
        stage.add_flows(self, &loads, &field, None, 1.0, &mut flows);
        if !flows.is_finite() {
            return Err(HeatError::NotFinite { dt: f64::INFINITY, velocity: speeds[0], omega: speeds[1] });
        }
        Ok((HeatState { field, last: Some(BoundaryState::new(speeds, &loads)) }, flows))
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

impl BoundaryState {
    fn new(speeds: [f64; 2], loads: &SurfaceLoads) -> Self {
        let total = |moments: &[[f64; 2]]| moments.iter().map(|q| q[0]).sum();
        Self {
            speeds,
            conductance: loads.conductance.iter().map(|c| c[0]).sum(),
            heat: [total(&loads.friction), total(&loads.tread)],
        }
    }

    /// Whether speeds, conductance or heat change so much that the next step cannot continue smoothly.
    fn jumps_to(&self, next: &Self) -> bool {
        let jump = |a: f64, b: f64| (a - b).abs() > JUMP * a.abs().max(b.abs());
        let change: f64 = self.heat.iter().zip(&next.heat).map(|(a, b)| (a - b).abs()).sum();
        let larger = self.heat.iter().sum::<f64>().max(next.heat.iter().sum());
        self.speeds.iter().zip(&next.speeds).any(|(a, b)| jump(*a, *b))
            || jump(self.conductance, next.conductance)
            || change > SLIGHT_HEAT + JUMP * larger
    }
}
