//! Choice of the multistep formula for a step, and histories that follow it.

use crate::config::{SolverParameters, TimeScheme};
use crate::mechanics::response::TimeDerivative;
use serde::{Deserialize, Serialize};

/// Step ratio up to which two-step backward differences are used (they lose zero-stability at 1 + √2).
const LARGEST_RATIO: f64 = 2.0;

/// Largest relative difference of steps that are meant to be equal: masters step over differences of rounded times.
const ROUNDING: f64 = 1e-9;

/// The step before, if `dt` differs from it by rounding only; otherwise `dt`. Second differences would amplify the
/// rounding, and every new step size costs new operators.
pub fn settled(dt: f64, before: f64) -> f64 {
    if (dt - before).abs() <= ROUNDING * dt { before } else { dt }
}

/// Formula for a step `dt` after a step `before` (0: none, e.g. at the start or after a discontinuity).
pub fn formula(solver: &SolverParameters, dt: f64, before: f64) -> TimeDerivative {
    match solver.time_scheme {
        TimeScheme::Bdf2 if before > 0.0 && dt <= LARGEST_RATIO * before => {
            let ratio = dt / before;
            TimeDerivative {
                a0: (1.0 + 2.0 * ratio) / (dt * (1.0 + ratio)),
                a1: -(1.0 + ratio) / dt,
                a2: ratio * ratio / (dt * (1.0 + ratio)),
                b1: 0.0,
            }
        }
        TimeScheme::Theta if before > 0.0 => {
            let theta = solver.theta;
            let a0 = 1.0 / (theta * dt);
            TimeDerivative { a0, a1: -a0, a2: 0.0, b1: -(1.0 - theta) / theta }
        }
        _ => TimeDerivative { a0: 1.0 / dt, a1: -1.0 / dt, a2: 0.0, b1: 0.0 },
    }
}

/// A scalar with the history its time discretisation needs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Sample {
    pub now: f64,
    pub before: f64,
    /// `d_t` at the present time.
    pub rate: f64,
}

impl Sample {
    /// A value at rest.
    pub fn constant(now: f64) -> Self {
        Self { now, before: now, rate: 0.0 }
    }

    /// Known part of `d_t` in the coming step.
    pub fn offset(&self, td: &TimeDerivative) -> f64 {
        td.offset(self.now, self.before, self.rate)
    }

    /// Moves on to a new value.
    pub fn push(&mut self, td: &TimeDerivative, value: f64) {
        let rate = td.a0 * value + self.offset(td);
        *self = Self { now: value, before: self.now, rate };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn solver(time_scheme: TimeScheme) -> SolverParameters {
        let response = crate::config::Response::Reduced;
        SolverParameters { response, modes_wheel: 1, modes_rail: 1, time_scheme, theta: 0.5 }
    }

    #[test]
    fn steps_that_differ_by_rounding_are_one_step() {
        let differences = (1..500).map(|k| f64::from(k + 1) * 1e-3 - f64::from(k) * 1e-3);
        assert!(differences.clone().any(|dt| dt != 1e-3));
        assert!(differences.map(|dt| settled(dt, 1e-3)).all(|dt| dt == 1e-3));
        for (dt, before) in [(1e-3, 0.0), (1e-3, 1.000001e-3), (5e-4, 1e-3)] {
            assert_eq!(settled(dt, before), dt);
        }
    }

    /// Error of `ẏ = −y` at `t = 1` with `n` steps of alternating length.
    fn decay_error(scheme: TimeScheme, n: usize) -> f64 {
        let solver = solver(scheme);
        let mut y = Sample { now: 1.0, before: 1.0, rate: -1.0 };
        let mut before = 0.0;
        for k in 0..n {
            let dt = if k % 2 == 0 { 0.8 } else { 1.2 } / n as f64;
            let td = formula(&solver, dt, before);
            let value = -y.offset(&td) / (td.a0 + 1.0);
            y.push(&td, value);
            before = dt;
        }
        (y.now - (-1f64).exp()).abs()
    }

    #[test]
    fn formulas_converge_with_their_order_under_variable_steps() {
        for (scheme, order) in [(TimeScheme::BackwardEuler, 1.0), (TimeScheme::Bdf2, 2.0), (TimeScheme::Theta, 2.0)] {
            let observed = (decay_error(scheme, 100) / decay_error(scheme, 200)).log2();
            assert!((observed - order).abs() < 0.1, "{scheme:?}: observed order {observed:.3}");
        }
    }
}
