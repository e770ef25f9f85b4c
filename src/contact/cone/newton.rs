//! Newton's method on the law of [`super::law`] under given pressures, all lines and motions at once.

use super::law::{AlongAcross, ConeProblem, ConeVerdict, SLIPS};
use super::linear::{ConeProblems, FreeMotion, Linearised, TangentialCoupling, sum_between};
use crate::axes::PerAxis;
use crate::contact::error::ContactError;

/// Times that the law is made linear before the shear is drawn.
const MOST: usize = 12;
/// First strength with which the shear is drawn, and what it is multiplied with where that succeeds and where it fails \[1].
const FIRST: f64 = 0.5;
const WEAKER: f64 = 0.2;
const STRONGER: f64 = 5.0;
/// Strength below which nothing is drawn \[1].
const WEAKEST: f64 = 1e-3;
/// Times that it is drawn at most.
const MOST_DRAWN: usize = 60;
/// Share of the violation of friction that a solution of a drawn shear leaves \[1].
const DRAWN: f64 = 0.05;
/// Violation of friction beyond which steps lead nowhere \[1].
const LOST: f64 = 1e3;
/// Part of a momentum that is lost in rounding \[1].
const ROUNDING: f64 = 1e-14;
/// Relative difference of violations that repeat themselves \[1].
const REPEATED: f64 = 1e-6;
/// Share of the violation that a step with a linear law of before may leave \[1].
const SLOW: f64 = 0.2;

/// Where a search is, or was.
pub struct Begun<const N: usize> {
    shears: Vec<AlongAcross<N>>,
    rigid: PerAxis<f64>,
    /// Largest violation of friction and balances \[1].
    pub largest: f64,
}

/// The tangential problem of all lines under given pressures, and where the search is in it.
pub struct Newton<'a, const N: usize> {
    problems: &'a mut [ConeProblem<N>],
    coupling: TangentialCoupling,
    pub shears: Vec<AlongAcross<N>>,
    /// Present motions.
    pub rigid: PerAxis<f64>,
    /// Slips by all but the known one, as polynomials.
    slips: Vec<[f64; SLIPS]>,
    pub verdicts: Vec<ConeVerdict<N>>,
    /// Missing parts of the balances of the free motions [N/m, N].
    unbalance: Vec<f64>,
    /// Linear law of before.
    pub linear: Option<Linearised<N>>,
    /// Times that the law was made linear.
    pub linear_laws: usize,
}

impl<'a, const N: usize> Newton<'a, N> {
    /// Begins with given shears, with motions that differ from those of the known slip by `motion`.
    pub fn new(
        coupling: TangentialCoupling,
        problems: &'a mut [ConeProblem<N>],
        (shears, motion): (&[AlongAcross<N>], PerAxis<f64>),
    ) -> Self {
        let rigid = PerAxis::from_fn(|axis| coupling.base[axis] + motion[axis]);
        let (slips, verdicts, unbalance) = Default::default();
        let (shears, linear) = (shears.to_vec(), None);
        let mut newton = Self { problems, coupling, shears, rigid, slips, verdicts, unbalance, linear, linear_laws: 0 };
        newton.judge();
        newton
    }

    /// Goes on from given shears, with the motions of the known slip.
    pub fn take(&mut self, shears: &[AlongAcross<N>]) {
        self.shears.clone_from_slice(shears);
        self.rigid = self.coupling.base;
        self.judge();
    }

    /// Finds what friction and balances ask for under the present shears and motions.
    fn judge(&mut self) {
        let lines = self.problems.iter().zip(&self.shears);
        let moments: Vec<_> = lines.map(|(problem, shear)| problem.moments(shear)).collect();
        let TangentialCoupling { between, motions, base, .. } = &self.coupling;
        let slips = |at: usize| {
            let mut sum = sum_between(between, at, &moments);
            for FreeMotion { axis, slips, .. } in motions {
                let change = self.rigid[*axis] - base[*axis];
                sum.iter_mut().zip(&slips[at]).for_each(|(sum, slip)| *sum += change * slip);
            }
            sum
        };
        self.slips = (0..self.problems.len()).map(slips).collect();
        let lines = self.problems.iter().zip(&self.shears).zip(&self.slips);
        self.verdicts = lines.map(|((problem, shear), slips)| problem.verdict(shear, slips)).collect();
        let balance = |motion: &FreeMotion| {
            let resisted =
                motions.iter().map(|other| motion.resistance(other.axis) * (self.rigid[other.axis] - base[other.axis]));
            let [resistance, way] = motion.drawn;
            motion.missing + resistance * way + motion.pulls(&moments) - resisted.sum::<f64>()
        };
        self.unbalance = motions.iter().map(balance).collect();
    }

    /// Largest violation of friction and balances \[1].
    pub fn largest(&self) -> f64 {
        let TangentialCoupling { motions, radius, friction, .. } = &self.coupling;
        let balances = motions.iter().zip(&self.unbalance).map(|(motion, missing)| {
            let axis = motion.axis;
            let rounding = ROUNDING * (motion.resistance(axis) * self.rigid[axis]).abs();
            (missing.abs() - rounding).max(0.0) / (axis.arm(*radius) * friction)
        });
        self.verdicts.iter().map(|verdict| verdict.largest).chain(balances).fold(0.0, f64::max)
    }

    /// Goes on until friction and balances are violated by no more than the `tolerance`, by steps that are taken whole. Where
    /// these end nowhere the shear is drawn to the one before, less and less: the slips of points are monotone in their
    /// shear, so that there is one solution and this way leads there (R. T. Rockafellar, *SIAM J. Control Optim.* 14 (1976)
    /// 877).
    pub fn run(&mut self, tolerance: f64) -> Result<(), ContactError> {
        if self.largest() <= tolerance {
            return Ok(());
        }
        let begun = self.now();
        if self.steps(tolerance) {
            return Ok(());
        }
        self.restart(&begun);
        let mut strength = FIRST;
        for _ in 0..MOST_DRAWN {
            let begun = self.now();
            let found = self.draw(strength, (DRAWN * begun.largest).max(tolerance));
            if !found {
                self.restart(&begun);
            } else if self.largest() <= tolerance {
                return Ok(());
            }
            strength *= if found { WEAKER } else { STRONGER };
            if found && strength < WEAKEST {
                let begun = self.now();
                if self.steps(tolerance) {
                    return Ok(());
                }
                self.restart(&begun);
                strength = WEAKEST;
            }
        }
        Err(ContactError::Unsuited { reason: "the shear of points along and across is not found" })
    }

    /// Goes to the solution of a shear that is drawn to the present one; true if it is found.
    fn draw(&mut self, strength: f64, tolerance: f64) -> bool {
        let (problems, shears) = (self.problems.to_vec(), &self.shears);
        let resists = |(problem, share): (&ConeProblem<N>, &f64)| share * problem.resistance();
        let resistance = strength * self.problems.iter().zip(&self.coupling.shares).map(resists).sum::<f64>();
        self.problems.iter_mut().zip(shears).for_each(|(problem, shear)| problem.draw(strength, shear));
        let TangentialCoupling { motions, base, radius, .. } = &mut self.coupling;
        for FreeMotion { axis, drawn, .. } in motions {
            let arm = axis.arm(*radius);
            *drawn = [resistance * arm * arm, self.rigid[*axis] - base[*axis]];
        }
        self.judge();
        self.linear = None;
        let found = self.steps(tolerance);
        self.coupling.motions.iter_mut().for_each(|motion| motion.drawn = [0.0; 2]);
        self.linear = None;
        self.problems.clone_from_slice(&problems);
        self.judge();
        found
    }

    /// Present shears and motions.
    pub fn now(&self) -> Begun<N> {
        Begun { shears: self.shears.clone(), rigid: self.rigid, largest: self.largest() }
    }

    /// Begins anew with shears and motions.
    pub fn restart(&mut self, begun: &Begun<N>) {
        self.shears.clone_from(&begun.shears);
        self.rigid = begun.rigid;
        self.judge();
    }

    /// Corrects the known slips by those in the places of the present shear.
    pub fn correct(&mut self) {
        for ((problem, shear), slips) in self.problems.iter_mut().zip(&self.shears).zip(&self.slips) {
            problem.add(&problem.correction(shear, slips));
        }
        self.judge();
    }

    /// True if a few steps were enough. The linear law of before is used as long as the same points stick and it leads on.
    fn steps(&mut self, tolerance: f64) -> bool {
        let (mut before, mut made) = ([f64::INFINITY; 2], 0);
        loop {
            let largest = self.largest();
            if largest <= tolerance {
                return true;
            }
            if self.linear.as_ref().is_some_and(|law| law.is_of(&self.verdicts)) {
                let begun = self.now();
                if self.step().is_some() && self.largest() < SLOW * largest {
                    continue;
                }
                self.restart(&begun);
            }
            // Two states that ask for each other have the same violations again and again.
            made += 1;
            if made > MOST || (largest / before[0] - 1.0).abs() < REPEATED {
                return false;
            }
            self.linear_laws += 1;
            self.linear = Linearised::new(&self.problem(), &self.verdicts);
            if self.step().is_none() || self.largest() > LOST {
                return false;
            }
            before = [before[1], largest];
        }
    }

    fn problem(&self) -> ConeProblems<'_, N> {
        ConeProblems { lines: self.problems, coupling: &self.coupling, unbalance: &self.unbalance }
    }

    /// One step with the linear law; `None`: there is none.
    fn step(&mut self) -> Option<()> {
        let mut linear = self.linear.take()?;
        let (changes, motions) = linear.changes(&self.problem(), &self.verdicts)?;
        self.linear = Some(linear);
        for (shear, change) in self.shears.iter_mut().zip(&changes) {
            let shear = shear.as_flattened_mut().iter_mut();
            shear.zip(change.as_flattened()).for_each(|(shear, change)| *shear += change);
        }
        let motions = self.coupling.motions.iter().zip(motions);
        motions.for_each(|(motion, change)| self.rigid[motion.axis] += change);
        self.judge();
        self.largest().is_finite().then_some(())
    }
}
