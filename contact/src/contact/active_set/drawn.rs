//! Shear that is drawn to the one before, less and less, where states of nodes end nowhere.
//!
//! The slips of nodes are monotone in their shear, so that there is one solution and this way leads there (R. T. Rockafellar,
//! *SIAM J. Control Optim.* 14 (1976) 877). Coefficients of friction stay as they are meanwhile.

use super::coefficients::FollowedLaws;
use super::present;
use super::search::ActiveSet;
use crate::contact::error::ContactError;
use crate::contact::line::contact_line::Drawn;

/// Strength with which shear is drawn at first, and what it is multiplied with where that succeeds and where it fails \[1].
const FIRST: f64 = 0.5;
const WEAKER: f64 = 0.2;
const STRONGER: f64 = 5.0;
/// Strength below which nothing is drawn \[1].
const WEAKEST: f64 = 1e-3;
/// Times that shear is drawn at most, and iterations of each.
const MOST_DRAWN: usize = 60;
const MOST_ITERATIONS: usize = 40;

impl ActiveSet<'_> {
    /// Finds states of which the search that begins with the present ones has found none; returns the iterations of the last
    /// search.
    pub fn draw(&mut self, laws: &mut FollowedLaws) -> Result<usize, ContactError> {
        let (mut strength, mut begun) = (FIRST, Vec::new());
        for _ in 0..MOST_DRAWN {
            present::take(&self.lines, &mut begun);
            self.lines.iter_mut().for_each(|line| line.iterate.drawn = Some(Drawn::to(line, strength)));
            let found = self.find_states(None, MOST_ITERATIONS);
            self.lines.iter_mut().for_each(|line| line.iterate.drawn = None);
            if found.is_err() {
                present::give_back(&begun, &mut self.lines);
                strength *= STRONGER;
                continue;
            }
            strength *= WEAKER;
            if strength < WEAKEST {
                present::take(&self.lines, &mut begun);
                match self.find_states(Some(laws), MOST_ITERATIONS) {
                    Err(_) => present::give_back(&begun, &mut self.lines),
                    found => return found,
                }
                strength = WEAKEST;
            }
        }
        Err(ContactError::NotConverged { iterations: MOST_DRAWN * MOST_ITERATIONS })
    }
}
