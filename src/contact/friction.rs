//! Laws of the friction coefficient. Within a step the friction cone is exact, whatever law gave its coefficient.

use serde::{Deserialize, Serialize};

/// Coefficient that falls with the slip velocity of the tread and with the temperature of the contact:
///
/// `μ(s, T) = μ₀ · (A + (1 − A) e^{−B |s|}) · max(m, 1 − K (T − T_ref))`
///
/// with the available coefficient `μ₀`, the mean slip velocity s of the surfaces in the patch and their mean temperature T, both
/// weighted with the pressure (O. Polach, *Wear* 258 (2005) 992–1000, for the falling part). With a memory the coefficient follows this local law
/// over a sliding distance `d`: `dμ/dt = (μ(s, T) − μ) |s|/d` (after E. A. H. Vollebregt, H. M. Schuttelaars, *J. Sound
/// Vib.* 331 (2012) 2141–2155).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrictionLaw {
    /// `A`: share of the coefficient that remains at high slip velocity \[1]; 1: constant; above 1 friction rises.
    pub falling_ratio: f64,
    /// `B`: decay with the slip velocity [s/m].
    pub falling_decay: f64,
    /// `K`: decay with the contact temperature [1/K]; 0: constant.
    pub softening: f64,
    /// `m`: share of the coefficient that remains in a hot contact \[1].
    pub softening_floor: f64,
    /// `d`: sliding distance over which the coefficient follows the law \[m]; 0: at once.
    pub memory_length: f64,
}

/// Rise of the mean contact temperature per unit of friction coefficient \[K], at the end of the last step and of the one
/// before.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Heating {
    /// At the end of the last step.
    pub now: f64,
    /// One step earlier.
    pub before: f64,
}

impl Heating {
    /// Extrapolated linearly over the coming step, whose length is `ratio` times that of the last one.
    fn predicted(&self, ratio: f64) -> f64 {
        (self.now + ratio * (self.now - self.before)).clamp(0.0, 2.0 * self.now.max(0.0))
    }
}

/// Friction in one contact problem: the coefficient as a function of the slip that the contact finds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friction {
    law: FrictionLaw,
    /// Coefficient available on the rail [1].
    available: f64,
    /// Rise of the contact temperature per unit of coefficient at the end of the step [K].
    heating: f64,
    memory: Option<Memory>,
}

/// What a law with a memory knows of the beginning of the step.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Memory {
    /// Length of the step over the memory length [s/m].
    reach: f64,
    /// Slip velocity [m/s].
    slip: f64,
    /// Coefficient [1].
    coefficient: f64,
    /// What the law gives at this slip and at the temperature of this coefficient [1].
    local: f64,
}

impl FrictionLaw {
    /// Share e of its change over which the heating θ may be extrapolated \[1] in steps too short for the temperature to
    /// follow friction.
    ///
    /// There θ falls by what μ rises, and a θ extrapolated in full feeds on itself where friction has lost most of its value.
    /// With `G = −dln μ/dln θ = κ/(1 + κ)`, `κ = μ₀Kθ`, no deviation of θ grows if `G (1 + 2e) ≤ 1`.
    pub fn extrapolated(&self, available: f64, heating: Heating) -> f64 {
        let softened = available * self.softening * heating.now.max(0.0);
        if softened > 0.5 { 0.5 / softened } else { 1.0 }
    }
}

impl Friction {
    /// The coefficient follows the law at once: `available` on the rail \[1], `heating` at the end of the step, whose length
    /// is `ratio` times that of the one before (0 if that says nothing).
    ///
    /// The flash temperature follows the friction within microseconds, `T − T_ref = θ μ`. Solving `μ = cold (1 − K θ μ)`
    /// with θ extrapolated to the end of the step keeps the law stable in long steps and second order in short ones, and
    /// sees slip and temperature at the same time.
    pub fn local(law: FrictionLaw, available: f64, heating: Heating, ratio: f64) -> Self {
        Self { law, available, heating: heating.predicted(ratio), memory: None }
    }

    /// A coefficient that nothing changes \[1].
    pub fn constant(coefficient: f64) -> Self {
        let law = FrictionLaw {
            falling_ratio: 1.0,
            falling_decay: 0.0,
            softening: 0.0,
            softening_floor: 1.0,
            memory_length: 0.0,
        };
        Self::local(law, coefficient, Heating::default(), 0.0)
    }

    /// The same in a step of `dt` seconds from a contact with the `coefficient` \[1] and the mean `slip` velocity [m/s],
    /// under the `heating` of that time; they matter if the law has a memory.
    pub fn after(mut self, dt: f64, coefficient: f64, slip: f64, heating: Heating) -> Self {
        if self.law.memory_length > 0.0 {
            let FrictionLaw { softening, softening_floor, .. } = self.law;
            let hot = (1.0 - softening * heating.now.max(0.0) * coefficient).max(softening_floor);
            let local = self.available * self.falling(slip) * hot;
            self.memory = Some(Memory { reach: dt / self.law.memory_length, slip: slip.abs(), coefficient, local });
        }
        self
    }

    /// Whether the coefficient depends on the slip at the end of the step.
    pub fn varies(&self) -> bool {
        self.memory.is_some() || self.law.falling_ratio != 1.0 && self.law.falling_decay > 0.0 && self.available > 0.0
    }

    /// Coefficient \[1] at the mean `slip` velocity [m/s] at the end of the step.
    pub fn coefficient(&self, slip: f64) -> f64 {
        let [weight, rest] = self.memory.map_or([1.0, 0.0], |memory| memory.weights(slip.abs()));
        self.softened(weight * self.available * self.falling(slip), rest)
    }

    /// Share of the cold coefficient at the mean `slip` velocity.
    fn falling(&self, slip: f64) -> f64 {
        let FrictionLaw { falling_ratio, falling_decay, .. } = self.law;
        falling_ratio + (1.0 - falling_ratio) * (-falling_decay * slip.abs()).exp()
    }

    /// The solution of `μ = cold · max(m, 1 − K θ μ) + rest`: of both branches the larger one.
    fn softened(&self, cold: f64, rest: f64) -> f64 {
        let hot = (cold + rest) / (1.0 + cold * self.law.softening * self.heating);
        hot.max(cold * self.law.softening_floor + rest)
    }

    /// Smallest and largest coefficient at any slip \[1].
    pub fn bounds(&self) -> [f64; 2] {
        let ends = [1.0, self.law.falling_ratio].map(|falling| self.softened(self.available * falling, 0.0));
        let memory = self.memory.map_or(ends, |memory| [memory.coefficient, memory.local]);
        let all = ends.into_iter().chain(memory);
        [all.clone().fold(f64::INFINITY, f64::min), all.fold(0.0, f64::max)]
    }
}

impl Memory {
    /// `[w, c]` of the coefficient `w L + c` after a step that ends with the slip velocity `slip` and the local law L.
    ///
    /// Over the sliding distance the law is `dμ/dx = (L − μ)/d`. This is its exact solution for an L that changes linearly
    /// over the distance slid, which is that of the trapezoidal rule: of second order, and a mean of the old coefficient,
    /// the old and the new L with weights that are never negative, so that it cannot overshoot in long steps.
    fn weights(&self, slip: f64) -> [f64; 2] {
        let z = 0.5 * self.reach * (self.slip + slip);
        let kept = (-z).exp();
        let mean = if z > 0.0 { -(-z).exp_m1() / z } else { 1.0 };
        [1.0 - mean, (mean - kept) * self.local + kept * self.coefficient]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAW: FrictionLaw = FrictionLaw {
        falling_ratio: 0.4,
        falling_decay: 1.5,
        softening: 1e-3,
        softening_floor: 0.1,
        memory_length: 0.0,
    };

    fn steady(theta: f64) -> Heating {
        Heating { now: theta, before: theta }
    }

    #[test]
    fn friction_falls_from_the_available_coefficient_to_the_remaining_share() {
        let cold = |slip| Friction::local(LAW, 0.3, Heating::default(), 0.0).coefficient(slip);
        assert_eq!(cold(0.0), 0.3);
        assert!((cold(-2.0) - 0.3 * (0.4 + 0.6 * (-3.0f64).exp())).abs() < 1e-16);
        assert!((cold(1e3) - 0.12).abs() < 1e-15);
    }

    #[test]
    fn the_softened_coefficient_and_its_temperature_belong_together() {
        // μ = μ₀ (1 − K θ μ) with θ in kelvin per unit of friction.
        let mu = Friction::local(LAW, 0.3, steady(2000.0), 1.0).coefficient(0.0);
        assert!((mu - 0.3 * (1.0 - LAW.softening * 2000.0 * mu)).abs() < 1e-15);
        assert!((Friction::local(LAW, 0.3, steady(1e6), 0.0).coefficient(0.0) - 0.03).abs() < 1e-16);
    }

    #[test]
    fn heating_is_extrapolated_but_never_below_zero_or_beyond_twice_its_value() {
        assert_eq!(Heating { now: 300.0, before: 200.0 }.predicted(1.0), 400.0);
        assert_eq!(Heating { now: 300.0, before: -900.0 }.predicted(1.0), 600.0);
        assert_eq!(Heating { now: 300.0, before: 900.0 }.predicted(2.0), 0.0);
        assert_eq!(Heating { now: -5.0, before: -5.0 }.predicted(0.0), 0.0);
    }

    #[test]
    fn a_deviation_of_the_heating_does_not_feed_on_itself_in_short_steps() {
        // The temperature stays, θ = T/μ: the extreme of a short step.
        for temperature in [50.0, 300.0, 700.0, 850.0] {
            let mut mu = 0.3 * (1.0 - LAW.softening * temperature);
            let exact = mu;
            let mut heating = Heating { now: temperature / (1.01 * mu), before: temperature / mu };
            for _ in 0..400 {
                mu = Friction::local(LAW, 0.3, heating, LAW.extrapolated(0.3, heating)).coefficient(0.0);
                assert!((mu / exact - 1.0).abs() < 0.0101, "{temperature} K: {mu} for {exact}");
                heating = Heating { now: temperature / mu, before: heating.now };
            }
            assert!((mu / exact - 1.0).abs() < 1e-9, "{temperature} K: {mu} for {exact}");
        }
    }

    #[test]
    fn only_a_law_that_changes_with_the_slip_says_so() {
        let varies = |law: FrictionLaw| Friction::local(law, 0.3, steady(100.0), 0.0).varies();
        assert!(varies(LAW));
        assert!(!varies(FrictionLaw { falling_ratio: 1.0, ..LAW }));
        assert!(!varies(FrictionLaw { falling_decay: 0.0, ..LAW }));
        assert!(!Friction::constant(0.3).varies());
    }

    #[test]
    fn every_coefficient_lies_within_the_bounds() {
        for (ratio, length, theta) in [(0.4, 0.0, 0.0), (0.4, 1e-3, 900.0), (1.6, 1e-3, 3e4), (0.0, 0.0, 3e4)] {
            let law = FrictionLaw { falling_ratio: ratio, memory_length: length, ..LAW };
            for before in [0.05, 0.3, 0.5] {
                let friction = Friction::local(law, 0.3, steady(theta), 0.0).after(1e-3, before, 0.7, steady(theta));
                let [low, high] = friction.bounds();
                for k in -30..30 {
                    let mu = friction.coefficient(10f64.powf(f64::from(k) * 0.1));
                    assert!(mu >= low * (1.0 - 1e-14) && mu <= high * (1.0 + 1e-14), "{low} {mu} {high}");
                }
            }
        }
    }

    /// Coefficient after sliding at `1 + sin 3t` m/s for a second in `n` steps, memory over 0.3 m.
    fn remembered(n: u32) -> f64 {
        let law = FrictionLaw { memory_length: 0.3, ..LAW };
        let heating = steady(400.0);
        let slip = |k: u32| 1.0 + (3.0 * f64::from(k) / f64::from(n)).sin();
        (1..=n).fold(0.3, |mu, k| {
            let friction = Friction::local(law, 0.3, heating, 1.0);
            friction.after(1.0 / f64::from(n), mu, slip(k - 1), heating).coefficient(slip(k))
        })
    }

    #[test]
    fn memory_is_of_second_order() {
        let exact = remembered(20_000);
        let [coarse, fine] = [50, 100].map(|n| (remembered(n) - exact).abs());
        println!("{coarse:.2e} {fine:.2e}");
        assert!((coarse / fine).log2() > 1.8);
    }

    #[test]
    fn memory_decays_exponentially_over_the_sliding_distance_and_keeps_in_stick() {
        let law = FrictionLaw { falling_ratio: 0.5, falling_decay: 1e3, softening: 0.0, memory_length: 0.01, ..LAW };
        let (mut mu, slip, dt) = (0.3, 2.0, 1e-3);
        for _ in 0..10 {
            mu = Friction::local(law, 0.3, Heating::default(), 0.0)
                .after(dt, mu, slip, Heating::default())
                .coefficient(slip);
        }
        assert!((mu - (0.15 + 0.15 * (-2.0f64).exp())).abs() < 1e-14);
        let stuck = Friction::local(law, 0.3, Heating::default(), 0.0).after(dt, mu, 0.0, Heating::default());
        assert_eq!(stuck.coefficient(0.0), mu);
        // In one long step it has arrived, without overshoot.
        let long = Friction::local(law, 0.3, Heating::default(), 0.0).after(1e3, 0.9, slip, Heating::default());
        assert!((long.coefficient(slip) - 0.15).abs() < 1e-6);
    }
}
