//! Plan of a step: which formula it takes, with which operators.

use super::history::shared_speeds;
use crate::heat::state::{BoundaryState, HeatState};
use crate::heat::tensor::solve::coefficients::StageCoefficients;
use crate::heat::tensor::solve::operators::StageKey;
use crate::heat::tensor::solve::stage::{CURVED_BELOW, CURVED_STEP};
use std::f64::consts::FRAC_1_SQRT_2;

/// Coefficient `γ` of the formula with two stages.
const TWO_STAGES: f64 = 1.0 - FRAC_1_SQRT_2;

/// Plan of the step of a line.
#[derive(Clone, Copy, Default)]
pub struct StepPlan {
    /// Length of the step \[s].
    pub dt: f64,
    /// Velocity of the wheel's centre [m/s] and angular velocity [rad/s].
    pub speeds: [f64; 2],
    /// By how much the mean friction power exceeds that at the end, relative to the latter \[1].
    pub excess: f64,
    /// True where two stages may be taken.
    pub smooth: bool,
    /// True where steel melts or freezes.
    pub melts: bool,
    /// Speeds and total loads.
    pub now: BoundaryState,
    /// Nodes that any line touches, see [`StageKey::contact`].
    pub contact: [usize; 2],
}

impl StepPlan {
    /// Coefficient γ of each stage, and how many there are.
    pub fn stages(&self) -> (f64, usize) {
        if self.smooth && !self.melts { (TWO_STAGES, 2) } else { (1.0, 1) }
    }

    /// Speeds and coefficients of the matrix of a stage.
    pub fn key(&self, state: &HeatState) -> StageKey {
        let &Self { dt, speeds, contact, .. } = self;
        let (gamma, stages) = self.stages();
        let curved = speeds[1].abs() < CURVED_BELOW && dt >= CURVED_STEP;
        // Two stages bear a neighbouring matrix: where nothing changes in time, their result does not depend on it.
        let inverted = if stages == 2 && !curved { shared_speeds(state, speeds) } else { speeds };
        let coefficients = StageCoefficients { storage: 1.0, flow: gamma * dt };
        StageKey { speeds, inverted, coefficients, rate: 1.0 / (gamma * dt), curved, contact }
    }

    /// Shares of the friction power at the end of the step that act in the stages. Their mean over the step is the
    /// given one; the share of the last one is 1, unless the first one had to cool for that.
    pub fn friction_shares(&self) -> [f64; 2] {
        let (gamma, stages) = self.stages();
        let held = 1.0 + self.excess;
        let first = 1.0 + self.excess / (1.0 - gamma);
        if stages == 2 && first >= 0.0 { [first, 1.0] } else { [held, held] }
    }
}
