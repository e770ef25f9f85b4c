//! Friction coefficients that follow their laws while tractions and motions are found.

use super::contact::SeriesContact;
use super::series_line::SeriesLine;
use super::state::Tractions;
use crate::contact::error::ContactError;
use crate::contact::friction::CoefficientSearch;

/// Error of a contact whose slip tells nothing about friction \[1].
const ROUGHEST: f64 = 0.1;
/// Friction coefficients that are tried.
const MOST: usize = 150;
/// Iterations of a contact whose friction varies over those of one whose friction does not.
const FURTHER: usize = 10;

/// The searches on all lines; `None`: the slip does not change friction.
pub struct FrictionSearches {
    searches: Vec<Option<CoefficientSearch>>,
    tried: usize,
}

impl FrictionSearches {
    pub fn new(contact: &SeriesContact) -> Self {
        let begun = |line: &SeriesLine| {
            let law = &line.problem.line.friction;
            law.varies().then(|| CoefficientSearch::new(law.bounds(), line.law_slope))
        };
        Self { searches: contact.lines.iter().map(begun).collect(), tried: 0 }
    }

    fn vary(&self) -> bool {
        self.searches.iter().any(Option::is_some)
    }

    /// Iterations of the contact at most, of which there are `most` where friction does not vary.
    pub fn rounds(&self, most: usize) -> usize {
        if self.vary() { FURTHER * most } else { most }
    }

    /// Gives lines coefficients nearer to the laws of their slips after an iteration that left a relative `error`; returns
    /// the largest relative distance from a law that one had.
    pub fn follow(&mut self, contact: &mut SeriesContact, error: f64) -> Result<f64, ContactError> {
        if error > ROUGHEST || !self.vary() {
            return Ok(0.0);
        }
        contact.find_slips();
        self.improve(contact, |search, used, found| search.approach(used, found, error))
    }

    /// True if the friction of a contact that has settled obeys the laws of its slips; `false`: it has to settle with other coefficients.
    pub fn settle(&mut self, contact: &mut SeriesContact) -> Result<bool, ContactError> {
        Ok(self.improve(contact, CoefficientSearch::next)? == 0.0)
    }

    fn improve(
        &mut self,
        contact: &mut SeriesContact,
        better: impl Fn(&mut CoefficientSearch, f64, f64) -> Option<f64>,
    ) -> Result<f64, ContactError> {
        let mut distance = 0.0_f64;
        for (line, search) in contact.lines.iter_mut().zip(&mut self.searches) {
            let Some(search) = search else { continue };
            let (used, found) = (line.friction, line.problem.line.friction.coefficient(line.slip_speed()));
            let Some(next) = better(search, used, found) else { continue };
            distance = distance.max((used - found).abs() / used.max(found));
            line.law_slope = search.slope();
            line.take_friction(next);
        }
        if distance > 0.0 {
            self.tried += 1;
            contact.displace();
        }
        match self.tried > MOST {
            true => Err(ContactError::Unsuited { reason: "no friction coefficient belongs to its slip" }),
            false => Ok(distance),
        }
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
