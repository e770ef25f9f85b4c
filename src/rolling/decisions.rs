//! Fingerprint of the decisions by which a communication step was computed.
//!
//! Between changes of state a step is an analytic function of its inputs. Two steps from the same state with the same
//! fingerprint took the same internal steps, and in each of them the same states of contact by the same number of
//! iterations, with the edges of the patches in the same elements of the temperatures: they lie on one branch of that
//! function.

use super::model::RollingModel;
use super::state::State;
use std::hash::{Hash, Hasher};

/// Decisions of the internal steps so far. A chain of multiplications by an odd number and shifts, on whole words.
#[derive(Clone, Copy, Debug)]
pub struct Decisions(u64);

impl Default for Decisions {
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl Hasher for Decisions {
    fn finish(&self) -> u64 {
        self.0
    }

    fn write(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|byte| self.write_u64(u64::from(*byte)));
    }

    fn write_u64(&mut self, word: u64) {
        let mixed = (self.0 ^ word).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        self.0 = mixed ^ (mixed >> 29);
    }

    fn write_usize(&mut self, word: usize) {
        self.write_u64(word as u64);
    }

    fn write_isize(&mut self, word: isize) {
        self.write_u64(word as u64);
    }
}

impl Decisions {
    /// Adds those of an internal step that ended in a state, as one of so many `pieces` of the communication step.
    pub fn add(&mut self, model: &RollingModel, state: &State, pieces: u64) {
        pieces.hash(self);
        (state.clock.restarted, state.hub.brake.locked, state.iterations()).hash(self);
        self.add_contact(model, state);
    }

    /// Adds those with which the contact of a state was found.
    pub fn add_contact(&mut self, model: &RollingModel, state: &State) {
        for line in &state.lines {
            model.contact.solver.decisions(&line.contact, self);
            if let Some(heat) = &model.thermal {
                heat.elements(&line.contact).for_each(|element| element.hash(self));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Fingerprint of numbers.
    fn of(numbers: impl IntoIterator<Item = usize>) -> u64 {
        let mut decisions = Decisions::default();
        numbers.into_iter().for_each(|number| number.hash(&mut decisions));
        decisions.finish()
    }

    #[test]
    fn a_fingerprint_tells_numbers_their_order_and_their_count() {
        let mut seen: Vec<u64> = (0..40).flat_map(|a| (0..40).map(move |b| of([a, b]))).collect();
        seen.extend((0..40).map(|a| of([a])));
        seen.extend([of([0; 3]), of([0; 4])]);
        let count = seen.len();
        seen.sort_unstable();
        seen.dedup();
        assert_eq!(seen.len(), count);
    }
}
