//! Newton's method on the law of [`super::cone`] under given pressures, all lines and motions at once.

use super::across::Vectors;
use super::cone::{ConeAnswer, ConeProblem, ConeVerdict, SLIPS};
use super::contact::{MOST_LINES, SeriesContact};
use super::series_line::SeriesLine;
use super::together::Answer;
use crate::axes::PerAxis;
use crate::contact::error::ContactError;
use crate::contact::flexibility::polynomial;

/// Steps of Newton's method before the shear is drawn.
const STEPS: usize = 12;
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
/// Relative difference of violations that repeat themselves \[1].
const REPEATED: f64 = 1e-6;

/// Where a search is, or was.
pub struct Begun {
    shears: Vec<Vectors>,
    slips: Vec<[f64; SLIPS]>,
    rigid: PerAxis<f64>,
    /// Largest violation of friction \[1].
    pub largest: f64,
}

/// The tangential problem of all lines under given pressures, and where the search is in it.
pub struct Newton<'a> {
    problems: &'a mut [ConeProblem],
    /// Slips of every line by the moments of every other one.
    between: Vec<[[f64; SLIPS]; SLIPS]>,
    /// Motions of the known slip.
    base: PerAxis<f64>,
    pub shears: Vec<Vectors>,
    /// Slips by all but the known one, as polynomials.
    slips: Vec<[f64; SLIPS]>,
    /// Present motions.
    pub rigid: PerAxis<f64>,
    pub verdicts: Vec<ConeVerdict>,
}

impl<'a> Newton<'a> {
    pub fn new(contact: &SeriesContact, problems: &'a mut [ConeProblem]) -> Self {
        let (rigid, count) = (contact.lines[0].rigid, problems.len());
        let between = (0..count * count).map(|k| contact.slips_askew([k / count, k % count])).collect();
        Self { problems, between, base: rigid, shears: vec![], slips: vec![], rigid, verdicts: vec![] }
    }

    /// Goes on from given shears, with motions that differ from those of the known slip by `motion`.
    pub fn take(&mut self, contact: &mut SeriesContact, shears: &[Vectors], motion: PerAxis<f64>) {
        contact.lines.iter_mut().for_each(|line| line.rigid = self.base);
        let moments: Vec<_> = self.problems.iter().zip(shears).map(|(problem, shear)| problem.moments(shear)).collect();
        let (contact, count) = (&*contact, moments.len());
        let slips = |at: usize| {
            let mut sum = [0.0; SLIPS];
            for (by, moments) in moments.iter().enumerate() {
                let slips = polynomial(&self.between[count * at + by], moments);
                sum.iter_mut().zip(slips).for_each(|(sum, slip)| *sum += slip);
            }
            for axis in contact.free_axes() {
                let slips = ConeAnswer::by_motion(&contact.lines[at], axis);
                sum.iter_mut().zip(slips).for_each(|(sum, slip)| *sum += motion[axis] * slip);
            }
            sum
        };
        self.slips = (0..self.problems.len()).map(slips).collect();
        self.shears = shears.to_vec();
        self.rigid = PerAxis::from_fn(|axis| self.base[axis] + motion[axis]);
        self.judge();
    }

    /// Finds what friction asks for under the present shears.
    fn judge(&mut self) {
        let lines = self.problems.iter().zip(&self.shears).zip(&self.slips);
        self.verdicts = lines.map(|((problem, shear), slips)| problem.verdict(shear, slips)).collect();
    }

    /// Largest violation of friction \[1].
    pub fn largest(&self) -> f64 {
        self.verdicts.iter().map(|verdict| verdict.largest).fold(0.0, f64::max)
    }

    /// Goes on until friction is violated by no more than the `tolerance`, by steps that are taken whole. Where these end
    /// nowhere the shear is drawn to the one before, less and less: the slips of points are monotone in their shear, so
    /// that there is one solution and this way leads there (R. T. Rockafellar, *SIAM J. Control Optim.* 14 (1976) 877).
    pub fn run(&mut self, contact: &mut SeriesContact, tolerance: f64, moved: bool) -> Result<(), ContactError> {
        let begun = self.now();
        if self.steps(contact, tolerance, moved) {
            return Ok(());
        }
        self.restart(&begun);
        let mut strength = FIRST;
        for _ in 0..MOST_DRAWN {
            let begun = self.now();
            let inner = (DRAWN * self.largest()).max(tolerance);
            let found = self.draw(contact, strength, inner);
            if !found {
                self.restart(&begun);
            } else if self.largest() <= tolerance {
                return Ok(());
            }
            strength *= if found { WEAKER } else { STRONGER };
            if found && strength < WEAKEST {
                let begun = self.now();
                if self.steps(contact, tolerance, false) {
                    return Ok(());
                }
                self.restart(&begun);
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
        self.judge();
        let found = self.steps(contact, tolerance, true);
        contact.drawn = PerAxis::default();
        self.problems.clone_from_slice(&problems);
        self.judge();
        found
    }

    /// Present shears, slips and motions.
    pub fn now(&self) -> Begun {
        let Self { shears, slips, rigid, .. } = self;
        Begun { shears: shears.clone(), slips: slips.clone(), rigid: *rigid, largest: self.largest() }
    }

    /// Begins anew with shears, slips and motions.
    pub fn restart(&mut self, begun: &Begun) {
        self.shears.clone_from(&begun.shears);
        self.slips.clone_from(&begun.slips);
        self.rigid = begun.rigid;
        self.judge();
    }

    /// Corrections of the slips by those in the places of the present shear.
    pub fn corrections(&self) -> Vec<Vectors> {
        let all = self.problems.iter().zip(&self.shears).zip(&self.slips);
        all.map(|((problem, shear), slips)| problem.correction(shear, slips)).collect()
    }

    /// Corrects the known slips.
    pub fn correct(&mut self, corrections: &[Vectors]) {
        self.problems.iter_mut().zip(corrections).for_each(|(problem, slips)| problem.add(slips));
        self.judge();
    }

    /// True if a few steps were enough, of which one is taken in any case if motions may have `moved`.
    fn steps(&mut self, contact: &mut SeriesContact, tolerance: f64, mut moved: bool) -> bool {
        let mut before = [f64::INFINITY; 2];
        for _ in 0..STEPS {
            let largest = self.largest();
            if largest <= tolerance && !moved {
                return true;
            }
            // Two states that ask for each other have the same violations again and again.
            if (largest / before[0] - 1.0).abs() < REPEATED || self.step(contact).is_none() {
                return false;
            }
            (before, moved) = ([before[1], largest], false);
        }
        self.largest() <= tolerance
    }

    /// One step; `None`: there is none.
    fn step(&mut self, contact: &mut SeriesContact) -> Option<()> {
        contact.newton_steps += 1;
        let answers = self.problems.iter().zip(&self.verdicts).map(|(problem, verdict)| problem.answer(verdict));
        let answers: Vec<_> = answers.collect();
        if answers.iter().any(Option::is_none) {
            return None;
        }
        contact.lines.iter_mut().for_each(|line| line.rigid = self.base);
        let (between, count) = (&self.between, answers.len());
        let found: [_; MOST_LINES] = contact.share(&answers, |_, [at, by]| between[count * at + by]).ok()?;
        self.rigid = contact.lines[0].rigid;
        self.slips = found[..answers.len()].to_vec();
        self.shears = answers.iter().flatten().zip(&self.slips).map(|(answer, slips)| answer.shear(slips)).collect();
        self.judge();
        (self.largest() < LOST).then_some(())
    }
}
