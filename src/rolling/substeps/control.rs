//! When an internal step is too long, and when the next one may be longer.
//!
//! A step is too long where its [error](super::prediction) exceeds the tolerance. Halving it must then make the error
//! smaller: fourfold where the motion is smooth, twofold where it bends. What does not become smaller is no error of
//! the time formula but noise: forces that jump with the state of a contact node, or that depend on the length of the
//! step itself. Shorter steps do not cure it, so the control learns its size and lets it pass, up to [`NOISIEST`] times
//! the tolerance, until it fades. It learns
//!
//! - where half a step misses by hardly less than the whole one;
//! - where a step fails that was doubled because the errors were small, although both its halves turn out to be quiet.
//!
//! Events are over after some milliseconds, and vibrations deserve their steps. In long dry slides, however, heat,
//! expansion and pressure excite each other without end, and steel that yields makes the force jump from node to node.
//! A tread with dents strikes at every turn as long as the run lasts. The finest steps serve nobody there: where the
//! contact is beyond Ac1 or yields, or the tread has dents, the more steps were taken of late, the longer is the shortest
//! one that errors ask for ([`PERSISTENCE`]).

use super::prediction::Found;
use crate::config::Tuning;
use crate::rolling::state::StepControl;

/// Internal step that errors alone do not halve any further at tolerances of [`TOLERANCE`] and more [s]: forces may
/// jump, with the friction coefficient. Events are located to twice this time at best. Errors go with the square of the
/// step, and this step with the root of a finer tolerance.
const FINEST: f64 = 1e-5;
/// Internal step in which contact is made or lost that errors alone do not halve any further \[s]: the force begins or
/// ends somewhere within, and its energy errs by what it does on the way of the whole step.
const STRIKE: f64 = 2e-6;
/// Internal step that errors of the temperature alone do not halve [s]: of a wheel that turns, and of one that its brake holds.
/// Shorter ones bring no better temperatures, since those of a hot sliding contact scatter by as much whatever the step. When
/// the wheel turns again, however, hot and cold places follow each other.
const WARMING: [f64; 2] = [2.5e-4, 1e-3];
/// Tolerance \[1] below which shorter steps than [`FINEST`] and [`STRIKE`] are taken, and the shortest of them over
/// those \[1].
const TOLERANCE: f64 = 2e-3;
const SHORTEST: f64 = 0.1;
/// Time in which internal steps of a contact that yields, is beyond Ac1 or has dents on its tread are forgotten [s], and the number of
/// remembered ones that doubles [`FINEST`]; twice as many make it five times as long. The shortest steps fall from
/// sixty in a millisecond to some six if they go on.
const PERSISTENCE: (f64, f64) = (0.3, 500.0);
/// Change of the highest contact temperature [K] that always refines steps longer than this [s].
const HEATING: (f64, f64) = (300.0, 1e-3);
/// Internal step that overheating alone does not halve any further [s]: a molten film takes friction away in the next
/// one.
const OVERHEATED: f64 = 1e-4;
/// Share of the tolerance, and of [`HEATING`], below which the step doubles; the difference grows fourfold.
const GROWTH: f64 = 0.125;
/// Largest noise that passes, in tolerances [1].
const NOISIEST: f64 = 5.0;
/// Share of an error below which that of half the step is smaller \[1]: half of it remains of a bend, all of a jump, and
/// `1/√2` of what goes with the root of time.
const SMALLER: f64 = 0.7;
/// Allowance for noise of the size learned, and how fast it fades with every step [1].
const ALLOWANCE: f64 = 1.5;
const FADING: f64 = 0.95;

/// Fate of a step that was tried.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// It counts.
    Accepted,
    /// It counts, although its error asks for shorter steps: there may be no more of them.
    Limited,
    /// It is taken again in halves.
    TooLong,
}

/// Control of the internal steps of one communication step.
pub struct Control<'a> {
    tuning: &'a Tuning,
    /// Memory from one communication step to the next.
    pub memory: StepControl,
    /// Error of the last attempt from the present state, which failed; zero if there was none.
    failed: f64,
    /// True if it failed before its heat was known.
    failed_in_motion: bool,
}

impl<'a> Control<'a> {
    /// Goes on where the last communication step ended.
    pub fn new(tuning: &'a Tuning, memory: StepControl) -> Self {
        Self { tuning, memory, failed: 0.0, failed_in_motion: false }
    }

    /// True if the errors so far allow a step of `dt` seconds.
    pub fn allows(&self, dt: f64) -> bool {
        self.tuning.tolerance == 0.0 || dt <= self.memory.step * (1.0 + 1e-9)
    }

    /// Judges a step of `dt` seconds; after one that was too long half of it is allowed. Errors are let pass unless the
    /// step `may_halve`.
    pub fn judge(&mut self, found: &Found, dt: f64, may_halve: bool) -> Verdict {
        let tolerance = self.tuning.tolerance;
        let error = error(found, dt);
        // Like is compared with like.
        let comparable = if self.failed_in_motion { found.error } else { error };
        if !found.first && self.failed > 0.0 && comparable > SMALLER * self.failed {
            self.learn(comparable);
        }
        let limit = tolerance.max((ALLOWANCE * self.memory.noise).min(NOISIEST * tolerance));
        let finest = if found.strikes { STRIKE } else { FINEST };
        let finest = finest * (tolerance / TOLERANCE).sqrt().clamp(SHORTEST, 1.0);
        let finest = finest * (1.0 + (self.memory.effort / PERSISTENCE.1).powi(2));
        let inaccurate = tolerance > 0.0 && error > limit && dt > 2.0 * finest;
        let overheats = found.overheats && dt > 2.0 * OVERHEATED;
        let heats = overheats || (found.heating > HEATING.0 && dt > HEATING.1 * (1.0 + 1e-9));
        match (heats, inaccurate, may_halve) {
            (false, false, _) => return Verdict::Accepted,
            (false, true, false) => return Verdict::Limited,
            (true, _, _) | (false, true, true) => {}
        }
        self.memory.step = 0.5 * dt;
        (self.failed, self.failed_in_motion) = (error, !found.whole);
        let doubled = inaccurate && found.doubled;
        (self.memory.suspect, self.memory.quiet) = if doubled { (error, 0) } else { (0.0, 0) };
        Verdict::TooLong
    }

    /// Takes note of a step of `dt` seconds that was not refused, and says whether the next one may be longer.
    pub fn grows(&mut self, found: &Found, dt: f64) -> bool {
        let tolerance = self.tuning.tolerance;
        self.failed = 0.0;
        self.memory.noise *= FADING;
        let long = found.yields || found.dented || found.hottest > self.tuning.austenitisation;
        let counted = if long { 1.0 } else { 0.0 };
        self.memory.effort = counted + self.memory.effort * libm::exp(-dt / PERSISTENCE.0);
        let quiet = error(found, 2.0 * dt) <= GROWTH * tolerance;
        if self.memory.suspect > 0.0 {
            self.memory.quiet = if quiet { self.memory.quiet + 1 } else { 0 };
            if self.memory.quiet == 2 {
                self.learn(self.memory.suspect);
            }
            if !quiet || self.memory.quiet == 2 {
                self.memory.suspect = 0.0;
            }
        }
        let grows = (tolerance == 0.0 || quiet) && found.heating <= GROWTH * HEATING.0;
        if grows {
            self.memory.step = self.memory.step.max(2.0 * dt);
        }
        grows
    }

    /// Remembers the size of what shorter steps do not cure.
    fn learn(&mut self, noise: f64) {
        self.memory.noise = self.memory.noise.max(noise);
    }
}

/// Error by which a step of `dt` seconds is judged \[1].
fn error(found: &Found, dt: f64) -> f64 {
    let shortest = WARMING[usize::from(found.locked)];
    if dt > shortest * (1.0 + 1e-9) { found.error.max(found.warming) } else { found.error }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Length \[s] down to which errors halve steps after a time \[s] in steps of a length \[s], on a tread with dents or not.
    fn finest(dented: bool, dt: f64, time: f64) -> f64 {
        let tuning = Tuning { tolerance: TOLERANCE, ..Tuning::default() };
        let mut control = Control::new(&tuning, StepControl::default());
        let mut found = Found::default();
        found.dented = dented;
        for _ in 0..(time / dt).round() as usize {
            control.grows(&found, dt);
        }
        (found.error, found.first) = (100.0 * TOLERANCE, true);
        let mut tried = 1e-3;
        while control.judge(&found, tried, true) == Verdict::TooLong {
            tried *= 0.5;
        }
        tried
    }

    /// Errors ask for steps of 10 to 20 µs; a tread with dents that has taken 5000 of them a second gets longer ones, one
    /// that takes a step in a millisecond does not.
    #[test]
    fn dents_that_are_passed_for_long_get_longer_steps() {
        let [smooth, dented, calm] = [finest(false, 2e-4, 1.0), finest(true, 2e-4, 1.0), finest(true, 1e-3, 1.0)];
        println!("{smooth:.1e}, {dented:.1e}, {calm:.1e} s");
        assert!((FINEST..2.0 * FINEST).contains(&smooth) && (5.0 * FINEST..2e-4).contains(&dented));
        assert!(calm < 3.0 * FINEST);
    }
}
