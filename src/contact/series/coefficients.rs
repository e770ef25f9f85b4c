//! Friction coefficients that follow their laws while tractions and motions are found.

use super::contact::SeriesContact;
use super::series_line::SeriesLine;
use super::state::Tractions;
use crate::contact::error::ContactError;
use crate::contact::friction::{CoefficientSearches, Tried};

/// Error of a contact whose slip tells nothing about friction \[1].
const ROUGHEST: f64 = 0.1;
/// Iterations of a contact whose friction varies over those of one whose friction does not.
const FURTHER: usize = 10;

/// The search on all lines; `None`: the slip does not change friction.
pub struct FrictionSearches {
    searches: Option<CoefficientSearches>,
}

impl FrictionSearches {
    pub fn new(contact: &SeriesContact) -> Self {
        let lines = || contact.lines.iter();
        let bounds = || lines().map(|line| line.problem.line.friction.bounds()).collect();
        let varies = lines().any(|line| line.problem.line.friction.varies());
        let searches = varies.then(|| CoefficientSearches::new(bounds(), lines().map(|line| line.law_slope)));
        Self { searches }
    }

    /// Iterations of the contact at most, of which there are `most` where friction does not vary.
    pub fn rounds(&self, most: usize) -> usize {
        if self.searches.is_some() { FURTHER * most } else { most }
    }

    /// Gives lines coefficients nearer to the laws of their slips after an iteration that left a relative `error`; returns
    /// the largest relative distance from a law that one had.
    pub fn follow(&mut self, contact: &mut SeriesContact, error: f64) -> Result<f64, ContactError> {
        if error > ROUGHEST || !self.searches.as_ref().is_some_and(CoefficientSearches::follows) {
            return Ok(0.0);
        }
        contact.find_slips();
        self.improve(contact, error)
    }

    /// True if the friction of a contact that has settled obeys the laws of its slips, too; `false`: it has to settle with
    /// other coefficients.
    pub fn settle(&mut self, contact: &mut SeriesContact) -> Result<bool, ContactError> {
        match &self.searches {
            Some(searches) if !searches.follows() => Ok(self.improve(contact, 0.0)? == 0.0),
            // It has followed so far.
            _ => Ok(true),
        }
    }

    fn improve(&mut self, contact: &mut SeriesContact, error: f64) -> Result<f64, ContactError> {
        let Some(searches) = &mut self.searches else { return Ok(0.0) };
        let used: Vec<f64> = contact.lines.iter().map(|line| line.friction).collect();
        let law = |line: &SeriesLine| line.problem.line.friction.coefficient(line.slip_speed());
        let found: Vec<f64> = contact.lines.iter().map(law).collect();
        let next = match searches.take(&used, &found, error) {
            Tried::Obeyed => return Ok(0.0),
            Tried::Next(next) => next,
            Tried::Exhausted(_) => {
                return Err(ContactError::Unsuited { reason: "no friction coefficient belongs to its slip" });
            }
        };
        for (k, line) in contact.lines.iter_mut().enumerate() {
            line.law_slope = searches.slope(k).unwrap_or(line.law_slope);
        }
        let mut distance = 0.0_f64;
        for (((line, next), used), found) in contact.lines.iter_mut().zip(&next).zip(&used).zip(&found) {
            let Some(next) = next else { continue };
            distance = distance.max((used - found).abs() / used.max(*found));
            line.take_friction(*next);
        }
        if distance > 0.0 {
            contact.displace();
        }
        Ok(distance)
    }
}

impl SeriesContact<'_> {
    /// Finds the slips of the present tractions.
    pub fn find_slips(&mut self) {
        self.exchange();
        for line in &mut self.lines {
            let (places, _) = line.slipping();
            line.slips = line.slip(&places, &line.surface, true);
            if line.is_sideways() {
                line.across.slips = line.lateral_slip(&places, true);
            }
        }
    }
}

impl SeriesLine<'_> {
    /// Takes another friction coefficient, with all of the shear in proportion.
    pub fn take_friction(&mut self, friction: f64) {
        let ratio = friction / std::mem::replace(&mut self.friction, friction);
        let Tractions { slide, stick, lateral, directions, .. } = &mut self.tractions;
        if directions.is_none() {
            *slide = friction.copysign(*slide);
        }
        if ratio.is_finite() {
            stick.terms.iter_mut().chain(&mut lateral.terms).for_each(|term| *term *= ratio);
        }
        self.place_shear();
    }
}
