//! Friction coefficients that follow the laws of their slips while states, forces and motions are found.

use crate::contact::error::ContactError;
use crate::contact::friction::{CoefficientSearches, Tried};
use crate::contact::line::contact_line::ContactLine;
use std::ops::Range;

/// Relative error of a contact whose states are settled and whose motions are not yet, and of one without settled states.
const UNREFINED: f64 = 1e-6;
const UNSETTLED: f64 = f64::INFINITY;
/// Slopes of the excess over the law that leave it a single solution, as far as the states before tell: coefficients
/// follow the slips of states that are not settled \[1].
const GENTLE: Range<f64> = 0.5..2.0;
/// Largest relative distance from the law that such slips can tell anything about \[1].
const LARGEST: f64 = 0.1;

/// Progress of a contact between two evaluations of its friction.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Progress {
    /// States still change.
    Searching,
    /// States are settled.
    Settled,
    /// Motions are refined, too.
    Refined,
}

/// Outcome of one evaluation.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Obedience {
    /// All coefficients obey their laws.
    Obeyed,
    /// There are new coefficients.
    Moved,
    /// The contact has to settle first.
    Waiting,
}

/// The coefficients in one search.
pub(super) struct FollowedLaws {
    /// Search on all lines; `None`: slip does not change friction.
    searches: Option<CoefficientSearches>,
    /// True if the laws have a single solution about the state before.
    gentle: bool,
}

impl FollowedLaws {
    /// Begins with the coefficients of the slips before.
    pub fn begin(lines: &mut [ContactLine]) -> Self {
        for line in &mut *lines {
            let friction = &mut line.traction.friction;
            friction.coefficient = line.problem.friction.coefficient(friction.tread_slip);
        }
        let slopes = || lines.iter().map(|line| line.traction.friction.law_slope);
        let bounds = || lines.iter().map(|line| line.problem.friction.bounds()).collect();
        let varies = lines.iter().any(|line| line.problem.friction.varies());
        let searches = varies.then(|| CoefficientSearches::new(bounds(), slopes()));
        Self { searches, gentle: slopes().all(|slope| GENTLE.contains(&slope)) }
    }

    /// Takes the slips of a solution and gives lines coefficients nearer to their laws.
    pub fn follow(&mut self, lines: &mut [ContactLine], progress: Progress) -> Result<Obedience, ContactError> {
        for line in &mut *lines {
            let [along, across] = line.mean_slips();
            let friction = &mut line.traction.friction;
            (friction.tread_slip, friction.slip_speed) = (along, libm::hypot(along, across));
        }
        let Some(searches) = &mut self.searches else { return Ok(Obedience::Obeyed) };
        let used: Vec<f64> = lines.iter().map(|line| line.traction.friction.coefficient).collect();
        let law = |line: &ContactLine| line.problem.friction.coefficient(line.traction.friction.slip_speed);
        let found: Vec<f64> = lines.iter().map(law).collect();
        let tells = |(used, found): (&f64, &f64)| (used - found).abs() <= LARGEST * used.max(*found);
        let error = match progress {
            Progress::Refined => 0.0,
            Progress::Settled if searches.follows() => UNREFINED,
            Progress::Searching if searches.follows() && self.gentle && used.iter().zip(&found).all(tells) => UNSETTLED,
            Progress::Settled | Progress::Searching => return Ok(Obedience::Waiting),
        };
        let next = match searches.take(&used, &found, error) {
            Tried::Obeyed => return Ok(Obedience::Obeyed),
            Tried::Next(next) => next,
            Tried::Exhausted(iterations) => return Err(ContactError::NotConverged { iterations }),
        };
        for (k, (line, next)) in lines.iter_mut().zip(next).enumerate() {
            let friction = &mut line.traction.friction;
            friction.coefficient = next.unwrap_or(friction.coefficient);
            friction.law_slope = searches.slope(k).unwrap_or(friction.law_slope);
        }
        Ok(Obedience::Moved)
    }
}
