//! Newton's method on the law of [`super::cone`] under given pressures, all lines and motions at once.

use super::across::Vectors;
use super::cone::{ConeAnswer, ConeProblem, ConeVerdict, SLIPS};
use super::contact::{MOST_LINES, SeriesContact};
use super::together::Answer;
use crate::axes::PerAxis;
use crate::contact::error::ContactError;
use crate::contact::flexibility::polynomial;

/// Steps of Newton's method that are tried whole, and with a search along each.
const WHOLE: usize = 12;
const SEARCHED: usize = 30;
/// Share of the promised fall of the violations that a step has to keep, and the shortest step \[1].
const KEPT: f64 = 0.1;
const SHORTEST: f64 = 0.01;
/// Violation of friction that ends searches on the way \[1].
const ROUGH: f64 = 1e-5;
/// Parts of a path at most.
const MOST_PARTS: usize = 24;
/// Violations of friction that end a search where whole steps, and where all else has failed \[1].
pub const UNSEEN: [f64; 2] = [1e-5, 5e-3];
/// Relative difference of violations that repeat themselves \[1].
const REPEATED: f64 = 1e-6;

/// Ways to search for a first shear.
#[derive(Clone, Copy)]
enum NewtonWay {
    Whole,
    Along,
    Path,
}

/// Shears, slips by all but the known ones, and motions.
pub type Begun = (Vec<Vectors>, Vec<[f64; SLIPS]>, PerAxis<f64>);

/// The tangential problem of all lines under given pressures, and where the search is in it.
pub struct Newton<'a> {
    problems: &'a mut [ConeProblem],
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
        let rigid = contact.lines[0].rigid;
        Self { problems, base: rigid, shears: vec![], slips: vec![], rigid, verdicts: vec![] }
    }

    /// Goes on from given shears, with motions that differ from those of the known slip by `motion`.
    pub fn take(&mut self, contact: &mut SeriesContact, shears: &[Vectors], motion: PerAxis<f64>) {
        contact.lines.iter_mut().for_each(|line| line.rigid = self.base);
        let moments: Vec<_> = self.problems.iter().zip(shears).map(|(problem, shear)| problem.moments(shear)).collect();
        let contact = &*contact;
        let slips = |at: usize| {
            let mut sum = [0.0; SLIPS];
            for (by, moments) in moments.iter().enumerate() {
                let slips = polynomial(&ConeAnswer::between(contact, [at, by]), moments);
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
        self.verdicts = self.judge(&self.shears, &self.slips);
    }

    fn judge(&self, shears: &[Vectors], slips: &[[f64; SLIPS]]) -> Vec<ConeVerdict> {
        self.problems.iter().zip(shears).zip(slips).map(|((problem, q), slips)| problem.verdict(q, slips)).collect()
    }

    /// Largest violation of friction \[1].
    pub fn largest(&self) -> f64 {
        self.verdicts.iter().map(|verdict| verdict.largest).fold(0.0, f64::max)
    }

    /// Goes on until friction is violated by no more than the `tolerance`: by whole steps, or else with a search along
    /// steps, or drawn to the shear before in every round. Where a single point neither sticks nor slips, next to
    /// the pole of a spin, what is left of it has no more to tell; so a violation that nobody sees is a solution, too.
    pub fn run(&mut self, contact: &mut SeriesContact, tolerance: f64, moved: bool) -> Result<(), ContactError> {
        let begun = self.now();
        let mut best = (self.largest(), begun.clone());
        for (search, unseen) in
            [(NewtonWay::Whole, UNSEEN[0]), (NewtonWay::Along, UNSEEN[1]), (NewtonWay::Path, UNSEEN[1])]
        {
            let found = match search {
                NewtonWay::Whole => self.steps(contact, tolerance, (WHOLE, false, moved), &mut best),
                NewtonWay::Along => self.steps(contact, tolerance, (SEARCHED, true, moved), &mut best),
                NewtonWay::Path => {
                    self.follow(contact) && self.steps(contact, tolerance, (SEARCHED, true, moved), &mut best)
                }
            };
            if found {
                return Ok(());
            }
            if best.0 <= unseen {
                self.restart(&best.1);
                return Ok(());
            }
            self.restart(&begun);
        }
        Err(ContactError::Unsuited { reason: "the shear of points along and across is not found" })
    }

    /// Present shears, slips and motions.
    pub fn now(&self) -> Begun {
        (self.shears.clone(), self.slips.clone(), self.rigid)
    }

    /// Begins anew with shears, slips and motions.
    pub fn restart(&mut self, begun: &Begun) {
        (self.shears, self.slips, self.rigid) = begun.clone();
        self.verdicts = self.judge(&self.shears, &self.slips);
    }

    /// Corrections of the slips by those in the places of the present shear.
    pub fn corrections(&self) -> Vec<Vectors> {
        let all = self.problems.iter().zip(&self.shears).zip(&self.slips);
        all.map(|((problem, shear), slips)| problem.correction(shear, slips)).collect()
    }

    /// Corrects the known slips by a share.
    pub fn correct(&mut self, share: f64, corrections: &[Vectors]) {
        self.problems.iter_mut().zip(corrections).for_each(|(problem, slips)| problem.add(share, slips));
        self.verdicts = self.judge(&self.shears, &self.slips);
    }

    /// Follows the solutions of slips that change from those whose solution is the present shear to the known ones; true if
    /// it arrives.
    fn follow(&mut self, contact: &mut SeriesContact) -> bool {
        let missing =
            |((problem, shear), slips): ((&ConeProblem, &Vectors), &[f64; SLIPS])| problem.missing(shear, slips);
        let missing: Vec<_> = self.problems.iter().zip(&self.shears).zip(&self.slips).map(missing).collect();
        let add = |newton: &mut Self, share: f64| {
            newton.problems.iter_mut().zip(&missing).for_each(|(problem, slips)| problem.add(share, slips));
        };
        add(self, 1.0);
        let (mut left, mut part) = (1.0_f64, 0.25_f64);
        for _ in 0..MOST_PARTS {
            let (begun, mut best) = (self.now(), (0.0, Begun::default()));
            let next = (left - part).max(0.0);
            add(self, next - left);
            self.restart(&begun);
            if self.steps(contact, ROUGH, (WHOLE, false, false), &mut best) {
                (left, part) = (next, 1.7 * part);
                if left == 0.0 {
                    return true;
                }
            } else {
                add(self, left - next);
                self.restart(&begun);
                part *= 0.4;
            }
        }
        add(self, -left);
        false
    }

    /// True if at most `most` steps were enough, of which one is taken in any case if motions may have `moved`; the iterate
    /// that violates friction least becomes the `best`.
    fn steps(
        &mut self,
        contact: &mut SeriesContact,
        tolerance: f64,
        (most, search, mut moved): (usize, bool, bool),
        best: &mut (f64, Begun),
    ) -> bool {
        let mut before = [f64::INFINITY; 2];
        for _ in 0..most {
            let largest = self.largest();
            if largest <= tolerance && !moved {
                return true;
            }
            // Two states that ask for each other have the same violations again and again.
            if (largest / before[0] - 1.0).abs() < REPEATED || self.step(contact, search).is_none() {
                return false;
            }
            (before, moved) = ([before[1], largest], false);
            if self.largest() < best.0 {
                *best = (self.largest(), self.now());
            }
        }
        self.largest() <= tolerance
    }

    /// One step; `None`: there is none.
    fn step(&mut self, contact: &mut SeriesContact, search: bool) -> Option<()> {
        contact.newton_steps += 1;
        let answers = self.problems.iter().zip(&self.verdicts).map(|(problem, verdict)| problem.answer(verdict));
        let answers: Vec<_> = answers.collect();
        if answers.iter().any(Option::is_none) {
            return None;
        }
        contact.lines.iter_mut().for_each(|line| line.rigid = self.base);
        let found: [_; MOST_LINES] = contact.share(&answers).ok()?;
        let (rigid, slips) = (contact.lines[0].rigid, &found[..answers.len()]);
        let shears: Vec<_> = answers.iter().flatten().zip(slips).map(|(answer, slips)| answer.shear(slips)).collect();
        let squares = |verdicts: &[ConeVerdict]| verdicts.iter().map(|verdict| verdict.squares).sum::<f64>();
        let before = squares(&self.verdicts).sqrt();
        let mut part = 1.0;
        loop {
            let mix = |old: f64, new: f64| old + part * (new - old);
            let mut tried = self.shears.clone();
            for (old, new) in
                tried.as_flattened_mut().as_flattened_mut().iter_mut().zip(shears.as_flattened().as_flattened())
            {
                *old = mix(*old, *new);
            }
            let mut moved = self.slips.clone();
            for (old, new) in moved.as_flattened_mut().iter_mut().zip(slips.as_flattened()) {
                *old = mix(*old, *new);
            }
            let verdicts = self.judge(&tried, &moved);
            let enough = squares(&verdicts).sqrt() <= before * (1.0 - KEPT * part);
            if !search || enough || part < SHORTEST {
                let rigid = PerAxis::from_fn(|axis| mix(self.rigid[axis], rigid[axis]));
                (self.shears, self.slips, self.rigid, self.verdicts) = (tried, moved, rigid, verdicts);
                return self.largest().is_finite().then_some(());
            }
            part *= 0.5;
        }
    }
}
