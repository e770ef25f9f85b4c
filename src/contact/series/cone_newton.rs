//! Newton's method on the law of [`super::cone`] under given pressures, all lines and motions at once.

use super::across::Vectors;
use super::cone::{ConeProblem, ConeVerdict, SLIPS};
use super::cone_linear::{ConeProblems, FreeMotion, Linearised, sum_between};
use super::contact::SeriesContact;
use super::series_line::SeriesLine;
use crate::axes::{Axis, PerAxis};
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
pub struct Begun {
    shears: Vec<Vectors>,
    rigid: PerAxis<f64>,
    /// Largest violation of friction and balances \[1].
    pub largest: f64,
}

/// The tangential problem of all lines under given pressures, and where the search is in it.
pub struct Newton<'a> {
    problems: &'a mut [ConeProblem],
    /// Slips of every line by the moments of every other one.
    between: Vec<[[f64; SLIPS]; SLIPS]>,
    motions: Vec<FreeMotion>,
    /// Motions of the known slip, and what their balances miss without shear [N/m, N].
    base: PerAxis<f64>,
    without: PerAxis<f64>,
    /// Force of friction on all lines [N/m].
    friction: f64,
    pub shears: Vec<Vectors>,
    /// Present motions.
    pub rigid: PerAxis<f64>,
    /// Slips by all but the known one, as polynomials.
    slips: Vec<[f64; SLIPS]>,
    pub verdicts: Vec<ConeVerdict>,
    /// Missing parts of the balances of the free motions [N/m, N].
    unbalance: Vec<f64>,
    /// Linear law of before.
    pub linear: Option<Linearised>,
}

impl<'a> Newton<'a> {
    /// Begins with given shears, with motions that differ from those of the known slip by `motion`.
    pub fn new(
        contact: &SeriesContact,
        problems: &'a mut [ConeProblem],
        (shears, motion): (&[Vectors], PerAxis<f64>),
    ) -> Self {
        let (base, count, resultant) = (contact.lines[0].rigid, problems.len(), contact.resultant());
        let mut newton = Self {
            problems,
            between: (0..count * count).map(|k| contact.slips_askew([k / count, k % count])).collect(),
            motions: FreeMotion::all(contact),
            base,
            without: PerAxis::from_fn(|axis| -contact.unbalance(axis, resultant[axis])),
            friction: contact.sum(|line| line.friction * line.load()).max(f64::MIN_POSITIVE),
            shears: shears.to_vec(),
            rigid: PerAxis::from_fn(|axis| base[axis] + motion[axis]),
            slips: vec![],
            verdicts: vec![],
            unbalance: vec![],
            linear: None,
        };
        newton.judge(contact);
        newton
    }

    /// Goes on from given shears, with the motions of the known slip.
    pub fn take(&mut self, contact: &SeriesContact, shears: &[Vectors]) {
        self.shears.clone_from_slice(shears);
        self.rigid = self.base;
        self.judge(contact);
    }

    /// Finds what friction and balances ask for under the present shears and motions.
    fn judge(&mut self, contact: &SeriesContact) {
        let lines = self.problems.iter().zip(&self.shears);
        let moments: Vec<_> = lines.map(|(problem, shear)| problem.moments(shear)).collect();
        let slips = |at: usize| {
            let mut sum = sum_between(&self.between, at, &moments);
            for FreeMotion { axis, slips, .. } in &self.motions {
                let change = self.rigid[*axis] - self.base[*axis];
                sum.iter_mut().zip(&slips[at]).for_each(|(sum, slip)| *sum += change * slip);
            }
            sum
        };
        self.slips = (0..self.problems.len()).map(slips).collect();
        let lines = self.problems.iter().zip(&self.shears).zip(&self.slips);
        self.verdicts = lines.map(|((problem, shear), slips)| problem.verdict(shear, slips)).collect();
        let balance = |motion: &FreeMotion| {
            let axis = motion.axis;
            let resisted = contact
                .free_axes()
                .map(|other| contact.resistance(axis, other) * (self.rigid[other] - self.base[other]));
            let [resistance, way] = contact.drawn[axis];
            self.without[axis] + resistance * way + motion.pulls(&moments) - resisted.sum::<f64>()
        };
        self.unbalance = self.motions.iter().map(balance).collect();
    }

    /// Largest violation of friction and balances \[1].
    pub fn largest(&self, contact: &SeriesContact) -> f64 {
        let arm = |axis: Axis| axis.arm(contact.lines[0].problem.line.radius());
        let balances = contact.free_axes().zip(&self.unbalance);
        let balances = balances.map(|(axis, missing)| {
            let rounding = ROUNDING * (contact.resistance(axis, axis) * self.rigid[axis]).abs();
            (missing.abs() - rounding).max(0.0) / (arm(axis) * self.friction)
        });
        self.verdicts.iter().map(|verdict| verdict.largest).chain(balances).fold(0.0, f64::max)
    }

    /// Goes on until friction and balances are violated by no more than the `tolerance`, by steps that are taken whole. Where
    /// these end nowhere the shear is drawn to the one before, less and less: the slips of points are monotone in their
    /// shear, so that there is one solution and this way leads there (R. T. Rockafellar, *SIAM J. Control Optim.* 14 (1976)
    /// 877).
    pub fn run(&mut self, contact: &mut SeriesContact, tolerance: f64) -> Result<(), ContactError> {
        if self.largest(contact) <= tolerance {
            return Ok(());
        }
        let begun = self.now(contact);
        if self.steps(contact, tolerance) {
            return Ok(());
        }
        self.restart(contact, &begun);
        let mut strength = FIRST;
        for _ in 0..MOST_DRAWN {
            let begun = self.now(contact);
            let found = self.draw(contact, strength, (DRAWN * begun.largest).max(tolerance));
            if !found {
                self.restart(contact, &begun);
            } else if self.largest(contact) <= tolerance {
                return Ok(());
            }
            strength *= if found { WEAKER } else { STRONGER };
            if found && strength < WEAKEST {
                let begun = self.now(contact);
                if self.steps(contact, tolerance) {
                    return Ok(());
                }
                self.restart(contact, &begun);
                strength = WEAKEST;
            }
        }
        Err(ContactError::Unsuited { reason: "the shear of points along and across is not found" })
    }

    /// Goes to the solution of a shear that is drawn to the present one; true if it is found.
    fn draw(&mut self, contact: &mut SeriesContact, strength: f64, tolerance: f64) -> bool {
        let (problems, shears) = (self.problems.to_vec(), &self.shears);
        let resists = |(problem, line): (&ConeProblem, &SeriesLine)| line.problem.line.share * problem.resistance();
        let resistance = strength * self.problems.iter().zip(&contact.lines).map(resists).sum::<f64>();
        self.problems.iter_mut().zip(shears).for_each(|(problem, shear)| problem.draw(strength, shear));
        for axis in contact.free_axes() {
            let arm = axis.arm(contact.lines[0].problem.line.radius());
            contact.drawn[axis] = [resistance * arm * arm, self.rigid[axis] - self.base[axis]];
        }
        self.judge(contact);
        self.linear = None;
        let found = self.steps(contact, tolerance);
        contact.drawn = PerAxis::default();
        self.linear = None;
        self.problems.clone_from_slice(&problems);
        self.judge(contact);
        found
    }

    /// Present shears and motions.
    pub fn now(&self, contact: &SeriesContact) -> Begun {
        Begun { shears: self.shears.clone(), rigid: self.rigid, largest: self.largest(contact) }
    }

    /// Begins anew with shears and motions.
    pub fn restart(&mut self, contact: &SeriesContact, begun: &Begun) {
        self.shears.clone_from(&begun.shears);
        self.rigid = begun.rigid;
        self.judge(contact);
    }

    /// Corrects the known slips by those in the places of the present shear.
    pub fn correct(&mut self, contact: &SeriesContact) {
        for ((problem, shear), slips) in self.problems.iter_mut().zip(&self.shears).zip(&self.slips) {
            problem.add(&problem.correction(shear, slips));
        }
        self.judge(contact);
    }

    /// True if a few steps were enough. The linear law of before is used as long as the same points stick and it leads on.
    fn steps(&mut self, contact: &mut SeriesContact, tolerance: f64) -> bool {
        let (mut before, mut made) = ([f64::INFINITY; 2], 0);
        loop {
            let largest = self.largest(contact);
            if largest <= tolerance {
                return true;
            }
            if self.linear.as_ref().is_some_and(|law| law.is_of(&self.verdicts)) {
                let begun = self.now(contact);
                if self.step(contact).is_some() && self.largest(contact) < SLOW * largest {
                    continue;
                }
                self.restart(contact, &begun);
            }
            // Two states that ask for each other have the same violations again and again.
            made += 1;
            if made > MOST || (largest / before[0] - 1.0).abs() < REPEATED {
                return false;
            }
            contact.linear_laws += 1;
            self.linear = Linearised::new(&self.problem(), contact, &self.verdicts);
            if self.step(contact).is_none() || self.largest(contact) > LOST {
                return false;
            }
            before = [before[1], largest];
        }
    }

    fn problem(&self) -> ConeProblems<'_> {
        ConeProblems {
            lines: self.problems,
            between: &self.between,
            motions: &self.motions,
            unbalance: &self.unbalance,
        }
    }

    /// One step with the linear law; `None`: there is none.
    fn step(&mut self, contact: &SeriesContact) -> Option<()> {
        let mut linear = self.linear.take()?;
        let (changes, motions) = linear.changes(&self.problem(), &self.verdicts)?;
        self.linear = Some(linear);
        for (shear, change) in self.shears.iter_mut().zip(&changes) {
            let shear = shear.as_flattened_mut().iter_mut();
            shear.zip(change.as_flattened()).for_each(|(shear, change)| *shear += change);
        }
        contact.free_axes().zip(motions).for_each(|(axis, change)| self.rigid[axis] += change);
        self.judge(contact);
        self.largest(contact).is_finite().then_some(())
    }
}
