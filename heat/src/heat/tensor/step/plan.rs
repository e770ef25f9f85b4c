//! Plan of a step: which formula it takes, with which operators, by comparison with the step before.

use crate::heat::state::{BoundaryState, HeatState};
use crate::heat::tensor::mesh::layout::HeatLayout;
use crate::heat::tensor::solve::coefficients::StageCoefficients;
use crate::heat::tensor::solve::operators::{StageKey, streams};
use crate::heat::tensor::solve::stage::{CURVED_BELOW, CURVED_STEP};
use std::f64::consts::FRAC_1_SQRT_2;

/// Coefficient `γ` of the formula with two stages.
const TWO_STAGES: f64 = 1.0 - FRAC_1_SQRT_2;

/// Relative change of speeds, conductance or heat from one step to the next that counts as a jump.
const JUMP: f64 = 0.3;
/// Heat whose changes do not count [W/m]: it warms a rolling contact by less than a kelvin.
const SLIGHT_HEAT: f64 = 1e4;
/// Digits after the first of the binary numbers to which shared speeds are rounded.
const SHARED_DIGITS: u32 = 6;

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

/// Speeds near the present ones that many steps share: those of the last step, rounded. Where one has changed by more
/// than rounding does, the present one takes its place.
///
/// They follow from the state, so that a step depends smoothly on its inputs.
fn shared_speeds(state: &HeatState, speeds: [f64; 2]) -> [f64; 2] {
    let near = |shared: f64, speed: f64| (shared - speed).abs() <= speed.abs() / f64::from(1 << SHARED_DIGITS);
    let Some(last) = state.last else { return speeds };
    [0, 1].map(|i| Some(rounded(last.speeds[i])).filter(|shared| near(*shared, speeds[i])).unwrap_or(speeds[i]))
}

/// The nearest number with [`SHARED_DIGITS`] binary digits after the first.
fn rounded(value: f64) -> f64 {
    let rest = f64::MANTISSA_DIGITS - 1 - SHARED_DIGITS;
    f64::from_bits((value.to_bits() + (1 << (rest - 1))) >> rest << rest)
}

/// Test that speeds, conductance or heat change so much from `before` to `next`, in a step of `dt` \[s], that it cannot
/// continue smoothly. A speed does not by which the stream carries material less than an element farther than before.
pub fn jumps(layout: &HeatLayout, before: &BoundaryState, next: &BoundaryState, dt: f64) -> bool {
    let jump = |a: f64, b: f64| (a - b).abs() > JUMP * a.abs().max(b.abs());
    let change: f64 = before.heat.iter().zip(&next.heat).map(|(a, b)| (a - b).abs()).sum();
    let larger = before.heat.iter().sum::<f64>().max(next.heat.iter().sum());
    let streams = [before, next].map(|state| streams(layout, state.speeds));
    let stream = |i: usize| (streams[0][i], streams[1][i]);
    [0, 1].map(stream).into_iter().any(|(a, b)| jump(a, b) && (a - b).abs() * dt > layout.element())
        || jump(before.conductance, next.conductance)
        || change > SLIGHT_HEAT + JUMP * larger
}
