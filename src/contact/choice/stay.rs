//! How long lines that have left the points stay on fixed nodes: the memory of the choice.

use serde::{Deserialize, Serialize};

/// Number of further steps on fixed nodes before the points are tried again.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Stay(u32);

impl Stay {
    /// Stay of a line that comes from the points or is at rest.
    pub const LONG: Self = Self(32);
    const ONE_STEP: Self = Self(1);

    /// True if the points may be tried.
    pub fn is_over(self) -> bool {
        self.0 == 0
    }

    /// Stay after one more step. At its end, material that `stands` is looked at again in every step, so that it is
    /// handed over as soon as it moves; a contact that does not suit the points (`suits`) stays as long as at first.
    pub fn after_step(self, stands: impl FnOnce() -> bool, suits: impl FnOnce() -> bool) -> Self {
        match self.0.saturating_sub(1) {
            0 if stands() => Self::ONE_STEP,
            0 if !suits() => Self::LONG,
            left => Self(left),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stay_ends_after_its_steps_where_the_contact_suits_and_begins_anew_where_it_does_not() {
        let last = (1..32).fold(Stay::LONG, |stay, _| stay.after_step(|| panic!(), || panic!()));
        assert!(!last.is_over() && last.after_step(|| false, || true).is_over());
        assert_eq!(last.after_step(|| false, || false), Stay::LONG);
        let standing = last.after_step(|| true, || panic!());
        assert!(!standing.is_over() && standing.after_step(|| false, || true).is_over());
    }
}
