//! Friction in one contact problem.

use super::heating::Heating;
use super::law::FrictionLaw;

/// Friction in one contact problem: the coefficient as a function of the slip that the contact finds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friction {
    law: FrictionLaw,
    /// Coefficient available on the rail [1].
    available: f64,
    /// Share of it that heat of earlier steps leaves [1].
    left: f64,
    /// Rise of the contact temperature at the end of the step per unit of coefficient [K].
    heating: f64,
    memory: Option<Memory>,
}

/// Data of the beginning of the step for a law with a memory.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Memory {
    /// Length of the step over the memory length [s/m].
    reach: f64,
    /// Slip velocity [m/s].
    slip: f64,
    /// Coefficient [1].
    coefficient: f64,
    /// Coefficient of the local law at this slip and at the temperature of this coefficient [1].
    local: f64,
}

impl Friction {
    /// A coefficient that follows the law at once: `available` on the rail \[1], `heating` at the end of the step,
    /// whose length is `ratio` times that of the one before (0 if that says nothing).
    ///
    /// The flash temperature follows the friction within microseconds, `T − T_ref = θ μ`. Solving
    /// `μ = cold (1 − K θ μ)` with θ extrapolated to the end of the step keeps the law stable in long steps and second
    /// order in short ones, and sees slip and temperature at the same time.
    pub fn local(law: FrictionLaw, available: f64, heating: Heating, ratio: f64) -> Self {
        Self { law, available, left: 1.0, heating: heating.predicted(ratio), memory: None }
    }

    /// [`Self::local`] in a contact that may remember its heat: `coefficient` \[1] is that of the step before, and `rise`
    /// tells by how much the temperature rises within the step per unit of coefficient \[K].
    ///
    /// Under a wheel that stands the temperature is that of all the heat since it was locked. Of it the share
    /// `ρ = rise/θ` follows friction in the step, and the rest is that of before: `T − T_ref = θ (ρμ + (1 − ρ) μ_before)`.
    /// If all of it followed, a falling coefficient would seem to cool the contact and heat it in the next step. What
    /// does not follow limits how far θ is extrapolated, and takes no more than the whole coefficient.
    pub fn remembering(
        law: FrictionLaw,
        available: f64,
        heating: Heating,
        ratio: f64,
        coefficient: f64,
        rise: impl FnOnce() -> f64,
    ) -> Self {
        let least = law.followed(available, heating);
        if least == 1.0 {
            return Self::local(law, available, heating, ratio);
        }
        let follows = (rise() / heating.now).clamp(least, 1.0);
        let theta = heating.predicted(ratio * (least / (1.0 - follows)).min(1.0));
        let left = (1.0 - law.softening * theta * coefficient).max(0.0);
        Self { law, available, left: follows + (1.0 - follows) * left, heating: follows * theta, memory: None }
    }

    /// A coefficient that nothing changes \[1].
    pub fn constant(coefficient: f64) -> Self {
        Self::local(FrictionLaw::CONSTANT, coefficient, Heating::default(), 0.0)
    }

    /// This friction in a step of `dt` seconds from a contact with a `coefficient`, of which the rail had another one `available`
    /// \[1], and the mean `slip` velocity [m/s], under the `heating` of that time; they matter if the law has a memory.
    ///
    /// What is remembered is the share of the available coefficient: where the wheel rolls onto another rail, all of the patch is on
    /// it after a patch length.
    pub fn after(mut self, dt: f64, (coefficient, available): (f64, f64), slip: f64, heating: Heating) -> Self {
        if self.law.memory_length > 0.0 {
            let FrictionLaw { softening, softening_floor, .. } = self.law;
            let hot = (1.0 - softening * heating.now.max(0.0) * coefficient).max(softening_floor);
            let local = self.available * self.law.slip.factor(slip) * hot;
            let coefficient = if available > 0.0 { coefficient * (self.available / available) } else { local };
            self.memory = Some(Memory { reach: dt / self.law.memory_length, slip: slip.abs(), coefficient, local });
        }
        self
    }

    /// Dependence of the coefficient on the slip at the end of the step.
    pub fn varies(&self) -> bool {
        self.memory.is_some() || self.law.slip.varies() && self.available > 0.0
    }

    /// Coefficient \[1] at the mean `slip` velocity [m/s] at the end of the step.
    pub fn coefficient(&self, slip: f64) -> f64 {
        let [weight, rest] = self.memory.map_or([1.0, 0.0], |memory| memory.weights(slip.abs()));
        self.softened(weight * self.available * self.law.slip.factor(slip), rest)
    }

    /// Solution of `μ = cold · max(m, left − K θ μ) + rest`: of both branches the larger one.
    fn softened(&self, cold: f64, rest: f64) -> f64 {
        let hot = (cold * self.left + rest) / (1.0 + cold * self.law.softening * self.heating);
        hot.max(cold * self.law.softening_floor + rest)
    }

    /// Smallest and largest coefficient at any slip \[1].
    pub fn bounds(&self) -> [f64; 2] {
        let ends = self.law.slip.ends().map(|factor| self.softened(self.available * factor, 0.0));
        let memory = self.memory.map_or(ends, |memory| [memory.coefficient, memory.local]);
        let all = ends.into_iter().chain(memory);
        [all.clone().fold(f64::INFINITY, f64::min), all.fold(0.0, f64::max)]
    }
}

impl Memory {
    /// `[w, c]` of the coefficient `w L + c` after a step that ends with the slip velocity `slip` and the local law L.
    ///
    /// Over the sliding distance the law is `dμ/dx = (L − μ)/d`. This is its exact solution for an L that changes
    /// linearly over the distance slid, which is that of the trapezoidal rule: of second order, and a mean of the old
    /// coefficient, the old and the new L with weights that are never negative, so that it cannot overshoot in long
    /// steps.
    fn weights(&self, slip: f64) -> [f64; 2] {
        let z = 0.5 * self.reach * (self.slip + slip);
        let kept = libm::exp(-z);
        let mean = if z > 0.0 { -libm::expm1(-z) / z } else { 1.0 };
        [1.0 - mean, (mean - kept) * self.local + kept * self.coefficient]
    }
}

#[cfg(test)]
mod tests {
    use super::super::slip::SlipDependence;
    use super::*;

    const LAW: FrictionLaw = FrictionLaw {
        slip: SlipDependence::Exponential { remaining: 0.4, decay: 1.5 },
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
    fn a_deviation_of_the_heating_does_not_feed_on_itself_in_short_steps() {
        // The temperature stays, θ = T/μ: the extreme of a short step.
        for temperature in [50.0, 300.0, 700.0, 850.0] {
            let exact = 0.3 * (1.0 - LAW.softening * temperature);
            let mut mu = 1.01 * exact;
            let mut heating = Heating { now: temperature / mu, before: temperature / exact };
            for _ in 0..400 {
                mu = Friction::remembering(LAW, 0.3, heating, 1.0, mu, || 0.0).coefficient(0.0);
                assert!((mu / exact - 1.0).abs() < 0.0101, "{temperature} K: {mu} for {exact}");
                heating = Heating { now: temperature / mu, before: heating.now };
            }
            assert!((mu / exact - 1.0).abs() < 1e-9, "{temperature} K: {mu} for {exact}");
        }
    }

    /// Temperature per unit of power of a half-space that stands in a contact and of one that passes it in unit time,
    /// over the time, both with the effusivity 1.
    fn warmed(time: f64) -> f64 {
        libm::expm1(-time) / (std::f64::consts::PI * time).sqrt() + libm::erf(time.sqrt())
    }

    /// Largest relative deviation of the coefficient from the law at the temperature of the same time, over the last
    /// quarter of 400 steps of the length `h` after the start of a slide that would settle at the heating `theta`.
    fn misfit(law: FrictionLaw, theta: f64, h: f64) -> f64 {
        let rise = theta * (h / std::f64::consts::PI).sqrt();
        let (mut coefficients, mut heating, mut worst) = (vec![0.3], Heating::default(), 0.0_f64);
        for n in 1..=400 {
            let before = coefficients[n - 1];
            let mu = Friction::remembering(law, 0.3, heating, 1.0, before, || rise).coefficient(0.0);
            coefficients.push(mu);
            let since = |k: usize| if k > n { 0.0 } else { warmed((n + 1 - k) as f64 * h) };
            let temperature: f64 = (1..=n).map(|k| theta * coefficients[k] * (since(k) - since(k + 1))).sum();
            heating = Heating { now: temperature / mu, before: if n > 1 { heating.now } else { temperature / mu } };
            let softened = 0.3 * (1.0 - law.softening * temperature).max(law.softening_floor);
            if n > 300 {
                worst = worst.max((mu / softened - 1.0).abs());
            }
        }
        worst
    }

    /// With a temperature that followed friction within every step, the coefficient swung by itself with a period of
    /// ten steps where 0.9 of it were lost.
    #[test]
    fn a_wheel_that_stands_and_remembers_its_heat_has_the_friction_of_its_temperature_in_every_length_of_step() {
        let law = FrictionLaw { slip: SlipDependence::Constant, softening_floor: 0.01, ..LAW };
        for lost in [0.25, 0.5, 0.8, 0.9, 0.95] {
            let theta = lost / (1.0 - lost) / (0.3 * law.softening);
            for h in [1e-3, 1e-2, 0.1, 0.3, 1.0, 3.0] {
                let misfit = misfit(law, theta, h);
                println!("{lost} lost, steps of {h} passages: coefficient within {misfit:.1e} of its law");
                assert!(misfit < 0.02);
            }
        }
    }

    /// Where the remembered temperature alone would end friction, it falls from step to step and never ends.
    #[test]
    fn friction_of_a_contact_that_starts_too_hot_for_any_falls_and_stays_positive() {
        let law = FrictionLaw { slip: SlipDependence::Constant, softening_floor: 0.0, ..LAW };
        let mut mu = 0.3;
        for _ in 0..50 {
            let heating = Heating { now: 1500.0 / mu, before: 1500.0 / mu };
            let next = Friction::remembering(law, 0.3, heating, 1.0, mu, || 0.0).coefficient(0.0);
            assert!(next > 0.0 && next < 0.7 * mu, "{next} after {mu}");
            mu = next;
        }
    }

    #[test]
    fn only_a_law_that_changes_with_the_slip_says_so() {
        let varies = |law: FrictionLaw| Friction::local(law, 0.3, steady(100.0), 0.0).varies();
        assert!(varies(LAW));
        assert!(!varies(LAW.at_rest()));
        assert!(!varies(FrictionLaw { slip: SlipDependence::Exponential { remaining: 0.4, decay: 0.0 }, ..LAW }));
        assert!(!Friction::constant(0.3).varies());
    }

    #[test]
    fn every_coefficient_lies_within_the_bounds() {
        for (ratio, length, theta) in [(0.4, 0.0, 0.0), (0.4, 1e-3, 900.0), (1.6, 1e-3, 3e4), (0.0, 0.0, 3e4)] {
            let slip = SlipDependence::Exponential { remaining: ratio, decay: 1.5 };
            let law = FrictionLaw { slip, memory_length: length, ..LAW };
            for before in [0.05, 0.3, 0.5] {
                let friction =
                    Friction::local(law, 0.3, steady(theta), 0.0).after(1e-3, (before, 0.3), 0.7, steady(theta));
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
            friction.after(1.0 / f64::from(n), (mu, 0.3), slip(k - 1), heating).coefficient(slip(k))
        })
    }

    #[test]
    fn memory_is_of_second_order() {
        let exact = remembered(20_000);
        let [coarse, fine] = [50, 100].map(|n| (remembered(n) - exact).abs());
        println!("{coarse:.2e} {fine:.2e}");
        assert!((coarse / fine).log2() > 1.8);
    }

    /// Under steady heating it arrives at the coefficient of the law without memory, whose temperature is its own.
    #[test]
    fn memory_arrives_at_the_softened_coefficient() {
        let (law, heating, slip) = (FrictionLaw { memory_length: 0.01, ..LAW }, steady(2000.0), 0.5);
        let exact = Friction::local(LAW, 0.3, heating, 0.0).coefficient(slip);
        let mut mu = 0.3;
        for _ in 0..1000 {
            mu = Friction::local(law, 0.3, heating, 0.0).after(1e-3, (mu, 0.3), slip, heating).coefficient(slip);
        }
        assert!((mu / exact - 1.0).abs() < 1e-9, "{mu} for {exact}");
    }

    /// A wheel that does not slip remembers everything, but the rail below it is another one.
    #[test]
    fn memory_is_that_of_the_share_of_what_the_rail_has() {
        let law = FrictionLaw { memory_length: 0.01, ..LAW };
        let rests = |available, before| {
            Friction::local(law, available, steady(0.0), 0.0).after(1e-3, before, 0.0, steady(0.0)).coefficient(0.0)
        };
        assert!((rests(0.02, (0.24, 0.3)) - 0.016).abs() < 1e-16);
        assert_eq!([rests(0.3, (0.0, 0.0)), rests(0.0, (0.24, 0.3))], [0.3, 0.0]);
    }

    #[test]
    fn memory_decays_exponentially_over_the_sliding_distance_and_keeps_in_stick() {
        let falling = SlipDependence::Exponential { remaining: 0.5, decay: 1e3 };
        let law = FrictionLaw { slip: falling, softening: 0.0, memory_length: 0.01, ..LAW };
        let (mut mu, slip, dt) = (0.3, 2.0, 1e-3);
        for _ in 0..10 {
            mu = Friction::local(law, 0.3, Heating::default(), 0.0)
                .after(dt, (mu, 0.3), slip, Heating::default())
                .coefficient(slip);
        }
        assert!((mu - (0.15 + 0.15 * (-2.0f64).exp())).abs() < 1e-14);
        let stuck = Friction::local(law, 0.3, Heating::default(), 0.0).after(dt, (mu, 0.3), 0.0, Heating::default());
        assert_eq!(stuck.coefficient(0.0), mu);
        // In one long step it has arrived, without overshoot.
        let long = Friction::local(law, 0.3, Heating::default(), 0.0).after(1e3, (0.9, 0.3), slip, Heating::default());
        assert!((long.coefficient(slip) - 0.15).abs() < 1e-6);
    }
}
