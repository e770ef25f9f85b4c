//! Shear that is drawn to the one before, less and less, where states of nodes end nowhere.
//!
//! The slips of nodes are monotone in their shear, so that there is one solution and this way leads there (R. T. Rockafellar,
//! *SIAM J. Control Optim.* 14 (1976) 877). Coefficients of friction stay as they are meanwhile.

use super::coefficients::FollowedLaws;
use super::search::ActiveSet;
use crate::axes::PerAxis;
use crate::contact::error::ContactError;
use crate::contact::line::contact_line::{ContactLine, Drawn, Slide};
use crate::contact::line::state::NodeStatus;
use nalgebra::DVector;

/// Strength with which shear is drawn at first, and what it is multiplied with where that succeeds and where it fails \[1].
const FIRST: f64 = 0.5;
const WEAKER: f64 = 0.2;
const STRONGER: f64 = 5.0;
/// Strength below which nothing is drawn \[1].
const WEAKEST: f64 = 1e-3;
/// Times that shear is drawn at most, and iterations of each.
const MOST_DRAWN: usize = 60;
const MOST_ITERATIONS: usize = 40;

/// States, forces and motions of a line in an iterate.
#[derive(Default)]
pub(super) struct Present {
    status: Vec<NodeStatus>,
    yielded: Vec<bool>,
    forces: DVector<f64>,
    lateral: Vec<f64>,
    slides: Vec<Slide>,
    rigid: PerAxis<f64>,
}

impl Present {
    /// Takes those of a line.
    pub fn take(&mut self, line: &ContactLine) {
        self.status.clone_from(&line.state.status);
        self.yielded.clone_from(&line.state.yielded);
        self.forces.clone_from(&line.state.forces);
        self.lateral.clone_from(&line.state.lateral);
        self.slides.clone_from(&line.iterate.slides);
        self.rigid = line.traction.rigid;
    }

    /// Gives them back.
    pub fn give_back(&self, line: &mut ContactLine) {
        line.state.status.clone_from(&self.status);
        line.state.yielded.clone_from(&self.yielded);
        line.state.forces.clone_from(&self.forces);
        line.state.lateral.clone_from(&self.lateral);
        line.iterate.slides.clone_from(&self.slides);
        line.traction.rigid = self.rigid;
    }
}

impl ActiveSet<'_> {
    /// Takes states, forces and motions of all lines.
    pub fn remember(&self, present: &mut Vec<Present>) {
        present.resize_with(self.lines.len(), Present::default);
        present.iter_mut().zip(&self.lines).for_each(|(present, line)| present.take(line));
    }

    /// Goes back to states, forces and motions.
    pub fn go_back(&mut self, present: &[Present]) {
        self.lines.iter_mut().zip(present).for_each(|(line, present)| present.give_back(line));
    }

    /// Finds states of which the search that begins with the present ones has found none; returns the iterations of the last
    /// search.
    pub fn draw(&mut self, laws: &mut FollowedLaws) -> Result<usize, ContactError> {
        let (mut strength, mut begun) = (FIRST, Vec::new());
        for _ in 0..MOST_DRAWN {
            self.remember(&mut begun);
            self.lines.iter_mut().for_each(|line| line.iterate.drawn = Some(Drawn::to(line, strength)));
            let found = self.find_states(None, MOST_ITERATIONS);
            self.lines.iter_mut().for_each(|line| line.iterate.drawn = None);
            if found.is_err() {
                self.go_back(&begun);
                strength *= STRONGER;
                continue;
            }
            strength *= WEAKER;
            if strength < WEAKEST {
                self.remember(&mut begun);
                match self.find_states(Some(laws), MOST_ITERATIONS) {
                    Err(_) => self.go_back(&begun),
                    found => return found,
                }
                strength = WEAKEST;
            }
        }
        Err(ContactError::NotConverged { iterations: MOST_DRAWN * MOST_ITERATIONS })
    }
}
