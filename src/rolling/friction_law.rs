//! The friction law that parameters describe.

use crate::config::Tuning;
use crate::contact::{FrictionLaw, SlipDependence};

impl From<&Tuning> for FrictionLaw {
    fn from(tuning: &Tuning) -> Self {
        let slip = match tuning.falling_ratio == 1.0 {
            true => SlipDependence::Constant,
            false => SlipDependence::Exponential { remaining: tuning.falling_ratio, decay: tuning.falling_decay },
        };
        Self {
            slip,
            softening: tuning.softening,
            softening_floor: tuning.softening_floor,
            memory_length: if tuning.memory_length == 0.0 && slip.falls() {
                FrictionLaw::MEMORY
            } else {
                tuning.memory_length
            },
        }
    }
}
