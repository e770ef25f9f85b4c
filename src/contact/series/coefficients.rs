//! Friction coefficients that follow their laws while tractions and motions are found.

use super::contact::SeriesContact;
use super::series_line::SeriesLine;
use super::state::Tractions;
use crate::contact::error::ContactError;
use crate::contact::friction::{CoefficientSearch, CoefficientsTogether};

/// Error of a contact whose slip tells nothing about friction \[1].
const ROUGHEST: f64 = 0.1;
/// Friction coefficients that are tried, and those of all lines together.
const MOST: usize = 200;
const TOGETHER: usize = 50;
/// Iterations of a contact whose friction varies over those of one whose friction does not.
const FURTHER: usize = 10;

/// The searches on all lines; `None`: the slip does not change friction.
pub struct FrictionSearches {
    searches: Option<Searches>,
    tried: usize,
}

/// A search on all lines together, and in its place one on each where that has found nothing.
enum Searches {
    Together(CoefficientsTogether),
    Apart(Vec<CoefficientSearch>),
}

impl FrictionSearches {
    pub fn new(contact: &SeriesContact) -> Self {
        let varies = contact.lines.iter().any(|line| line.problem.line.friction.varies());
        let slopes = contact.lines.iter().map(|line| line.law_slope);
        let searches = varies.then(|| Searches::Together(CoefficientsTogether::new(bounds(contact), slopes)));
        Self { searches, tried: 0 }
    }

    /// Iterations of the contact at most, of which there are `most` where friction does not vary.
    pub fn rounds(&self, most: usize) -> usize {
        if self.searches.is_some() { FURTHER * most } else { most }
    }

    /// Gives lines coefficients nearer to the laws of their slips after an iteration that left a relative `error`; returns
    /// the largest relative distance from a law that one had.
    pub fn follow(&mut self, contact: &mut SeriesContact, error: f64) -> Result<f64, ContactError> {
        if error > ROUGHEST || !matches!(self.searches, Some(Searches::Together(_))) {
            return Ok(0.0);
        }
        contact.find_slips();
        self.improve(contact, error)
    }

    /// True if the friction of a contact that has settled obeys the laws of its slips, too; `false`: it has to settle with
    /// other coefficients.
    pub fn settle(&mut self, contact: &mut SeriesContact) -> Result<bool, ContactError> {
        match self.searches {
            // It has followed so far.
            None | Some(Searches::Together(_)) => Ok(true),
            Some(Searches::Apart(_)) => Ok(self.improve(contact, 0.0)? == 0.0),
        }
    }

    fn improve(&mut self, contact: &mut SeriesContact, error: f64) -> Result<f64, ContactError> {
        let Some(searches) = &mut self.searches else { return Ok(0.0) };
        let used: Vec<f64> = contact.lines.iter().map(|line| line.friction).collect();
        let law = |line: &SeriesLine| line.problem.line.friction.coefficient(line.slip_speed());
        let found: Vec<f64> = contact.lines.iter().map(law).collect();
        let next: Vec<Option<f64>> = match searches {
            Searches::Together(search) => {
                let next = search.next(used.clone(), &found, error);
                contact.lines.iter_mut().enumerate().for_each(|(k, line)| line.law_slope = search.slope(k));
                let of = |k: usize| next.as_ref().map(|next| next[k]);
                (0..used.len()).map(of).collect()
            }
            Searches::Apart(searches) => {
                let all = searches.iter_mut().zip(used.iter().zip(&found));
                all.map(|(search, (used, found))| search.next(*used, *found)).collect()
            }
        };
        let mut distance = 0.0_f64;
        for (((line, next), used), found) in contact.lines.iter_mut().zip(&next).zip(&used).zip(&found) {
            let Some(next) = next else { continue };
            distance = distance.max((used - found).abs() / used.max(*found));
            line.take_friction(*next);
        }
        if distance > 0.0 {
            self.tried += 1;
            contact.displace();
        }
        if self.tried == TOGETHER {
            let apart = bounds(contact).into_iter().map(CoefficientSearch::new).collect();
            self.searches = Some(Searches::Apart(apart));
        }
        match self.tried > MOST {
            true => Err(ContactError::Unsuited { reason: "no friction coefficient belongs to its slip" }),
            false => Ok(distance),
        }
    }
}

/// Smallest and largest coefficient of every line.
fn bounds(contact: &SeriesContact) -> Vec<[f64; 2]> {
    contact.lines.iter().map(|line| line.problem.line.friction.bounds()).collect()
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
