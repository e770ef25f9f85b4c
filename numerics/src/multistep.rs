//! The time formula: how the new value of a quantity, its history and its time derivative are linked in one step.
//!
//! All balances of momentum and the slip are discretised by the same formula ([`TimeDerivative`]); its weights follow
//! from the length of the step and of the step before ([`formula`]).

use serde::{Deserialize, Serialize};

/// Step ratio up to which two-step backward differences are used (they lose zero-stability at 1 + √2).
const LARGEST_RATIO: f64 = 2.0;

/// Largest relative difference of steps that are meant to be equal: masters step over differences of rounded times.
const ROUNDING: f64 = 1e-9;

/// Linear multistep formula `d_t y = a0 y_{n+1} + a1 y_n + a2 y_{n−1} + b1 (d_t y)_n`; all zero: stationary.
///
/// A constant has no derivative: `a0 + a1 + a2 = 0`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct TimeDerivative {
    /// Weight of the new value [1/s].
    pub a0: f64,
    /// Weight of the present value [1/s].
    pub a1: f64,
    /// Weight of the value one step earlier [1/s].
    pub a2: f64,
    /// Weight of the present derivative \[1].
    pub b1: f64,
}

impl TimeDerivative {
    /// The part of `d_t y` known before the step.
    pub fn offset(&self, now: f64, before: f64, rate: f64) -> f64 {
        self.a1 * now + self.a2 * before + self.b1 * rate
    }

    /// Impulse [N s] that the formula attributes to the force `now` \[N] at the end of a step.
    ///
    /// `before` is the force at its beginning and `last` the impulse of the step before [N s]. Derivation: the formula
    /// turns the balance `d_t p = f` of a momentum `p` into `a0 p_{n+1} + a1 p_n + a2 p_{n−1} + b1 f_n = f_{n+1}`,
    /// since the derivative known from the last step is the force that acted at its end. With `a1 = −a0 − a2` and the
    /// impulses `J_{n+1} = p_{n+1} − p_n` this is `a0 J_{n+1} − a2 J_n + b1 f_n = f_{n+1}`, a recursion that is linear
    /// in the force. It therefore holds for each force by itself: every one gets its own impulse, and the impulses of
    /// all forces add up to the change of momentum exactly, whatever the size of the steps. Backward Euler gives
    /// `f_{n+1} Δt`, the trapezoidal rule `½ (f_n + f_{n+1}) Δt`.
    pub fn impulse(&self, now: f64, before: f64, last: f64) -> f64 {
        (now - self.b1 * before + self.a2 * last) / self.a0
    }

    /// Force \[N] that has the impulse `now` [N s] over a step: the inverse of [`Self::impulse`], for forces that are
    /// held or vary linearly during the step, so that their impulse is known.
    pub fn force(&self, now: f64, before: f64, last: f64) -> f64 {
        self.a0 * now + self.b1 * before - self.a2 * last
    }

    /// Length of the step over that of the step before \[1]; `None`: the formula does not look farther back than its beginning.
    pub fn ratio(&self) -> Option<f64> {
        let share = (-self.a2 / self.a1).sqrt();
        (share > 0.0).then(|| share / (1.0 - share))
    }

    /// No time derivative at all: every step is an equilibrium.
    pub fn is_stationary(&self) -> bool {
        *self == Self::default()
    }
}

/// The step before, if `dt` differs from it by rounding only; otherwise `dt`. Second differences would amplify the
/// rounding, and every new step size costs new operators.
pub fn settled(dt: f64, before: f64) -> f64 {
    if (dt - before).abs() <= ROUNDING * dt { before } else { dt }
}

/// Formula for a step `dt` after a step `before` \[s] (0: none, e.g. at the start or after a discontinuity):
/// second-order backward differences, and backward Euler where there is no step before or the step more than doubles.
pub fn formula(dt: f64, before: f64) -> TimeDerivative {
    if before > 0.0 && dt <= LARGEST_RATIO * before {
        let ratio = dt / before;
        TimeDerivative {
            a0: (1.0 + 2.0 * ratio) / (dt * (1.0 + ratio)),
            a1: -(1.0 + ratio) / dt,
            a2: ratio * ratio / (dt * (1.0 + ratio)),
            b1: 0.0,
        }
    } else {
        TimeDerivative { a0: 1.0 / dt, a1: -1.0 / dt, a2: 0.0, b1: 0.0 }
    }
}

/// Formula for the position of a free mass whose velocity follows `td` in a step `dt`.
///
/// After a start the velocity takes one step of backward Euler. The position then follows the mean velocity, so that a
/// constant force does in that step the work which the mass receives. With backward Euler the position would be ahead
/// by `½ a Δt²` after this step and, since differences of it go on, by `¾ a Δt²` for ever.
pub fn position(td: &TimeDerivative, dt: f64, before: f64) -> TimeDerivative {
    if before > 0.0 {
        return *td;
    }
    TimeDerivative { a0: 2.0 / dt, a1: -2.0 / dt, a2: 0.0, b1: -1.0 }
}

/// A scalar with the history its time discretisation needs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct History {
    /// Present value.
    pub now: f64,
    /// Value one step earlier.
    pub before: f64,
    /// `d_t` at the present time.
    pub rate: f64,
}

impl History {
    /// A value at rest.
    pub fn constant(now: f64) -> Self {
        Self { now, before: now, rate: 0.0 }
    }

    /// Known part of `d_t` in the coming step.
    pub fn offset(&self, td: &TimeDerivative) -> f64 {
        td.offset(self.now, self.before, self.rate)
    }

    /// Moves on to a new value, or rests there where a step has no time.
    pub fn reach(&mut self, td: &TimeDerivative, value: f64) {
        if td.is_stationary() { *self = Self::constant(value) } else { self.push(td, value) }
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

    #[test]
    fn a_formula_knows_the_ratio_of_its_steps() {
        for ratio in [0.1, 0.5, 1.0, 1.9] {
            assert!((formula(ratio * 1e-3, 1e-3).ratio().unwrap() / ratio - 1.0).abs() < 1e-12);
        }
        let forgetful = [formula(1e-3, 0.0), formula(1e-3, 1e-4), TimeDerivative::default()];
        assert!(forgetful.iter().all(|formula| formula.ratio().is_none()));
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

    /// Error of `ẏ = −y` at `t = 1` with `n` steps of alternating length, each of which starts afresh or goes on.
    fn decay_error(afresh: bool, n: usize) -> f64 {
        let mut y = History { now: 1.0, before: 1.0, rate: -1.0 };
        let mut before = 0.0;
        for k in 0..n {
            let dt = if k % 2 == 0 { 0.8 } else { 1.2 } / n as f64;
            let td = formula(dt, if afresh { 0.0 } else { before });
            let value = -y.offset(&td) / (td.a0 + 1.0);
            y.push(&td, value);
            before = dt;
        }
        (y.now - (-1f64).exp()).abs()
    }

    #[test]
    fn steps_that_go_on_are_of_second_order_and_steps_that_start_afresh_of_first() {
        for (afresh, order) in [(true, 1.0), (false, 2.0)] {
            let observed = (decay_error(afresh, 100) / decay_error(afresh, 200)).log2();
            assert!((observed - order).abs() < 0.1, "afresh {afresh}: observed order {observed:.3}");
        }
    }

    /// A mass at rest falls freely in steps of any length, of which the first starts afresh.
    #[test]
    fn a_free_fall_is_exact_in_steps_of_any_length() {
        let acceleration = -9.0;
        let (mut height, mut velocity) = (History::constant(2.0), History::constant(0.0));
        let (mut before, mut t) = (0.0, 0.0);
        for dt in [1e-2, 2e-2, 5e-3, 1e-2, 1.5e-2] {
            let td = formula(dt, before);
            let of_height = position(&td, dt, before);
            let speed = match before {
                0.0 => velocity.now + dt * acceleration,
                _ => (acceleration - velocity.offset(&td)) / td.a0,
            };
            let value = (speed - height.offset(&of_height)) / of_height.a0;
            height.push(&of_height, value);
            velocity.push(&td, height.rate);
            (before, t) = (dt, t + dt);
            let exact = 2.0 + 0.5 * acceleration * t * t;
            assert!((height.now - exact).abs() < 1e-14, "{t} s: {} for {exact}", height.now);
        }
    }

    /// A mass under two forces in steps of alternating length, of which every seventh starts afresh.
    #[test]
    fn impulses_of_all_forces_add_up_to_the_change_of_momentum() {
        let forces = |t: f64| [3.0 + t * t, -(5.0 * t).sin()];
        let mut momentum = History { now: 2.0, before: 2.0, rate: forces(0.0).iter().sum() };
        let (mut before, mut last, mut present, mut t, mut total) = (0.0, [0.0; 2], forces(0.0), 0.0, 0.0);
        for k in 0..40 {
            let dt = if k % 2 == 0 { 0.02 } else { 0.03 };
            let td = formula(dt, if k % 7 == 0 { 0.0 } else { before });
            t += dt;
            let new = forces(t);
            let impulse = [0, 1].map(|i| td.impulse(new[i], present[i], last[i]));
            let value = (new.iter().sum::<f64>() - momentum.offset(&td)) / td.a0;
            momentum.push(&td, value);
            total += impulse.iter().sum::<f64>();
            (before, last, present) = (dt, impulse, new);
            assert!((momentum.now - 2.0 - total).abs() < 1e-13, "{} and {total}", momentum.now - 2.0);
        }
    }
}
