//! Friction coefficient: the only place of its law, with slope and bounds. Within a step the friction cone is exact,
//! whatever law gave its coefficient.
//!
//! | file | content |
//! |---|---|
//! | `slip` | factor by which the coefficient depends on the slip, one variant for each law |
//! | `law` | the whole law, from its parameters: factors of slip and temperature, and a memory |
//! | `heating` | temperature per friction coefficient, extrapolated over a step |
//! | `step` | the coefficient in one contact problem: memory, bounds |
//! | `coefficient` | search for the coefficient that the law gives to the slip that it causes |
//! | `together` | that search for several lines at once |
//! | `searches` | the search of one contact problem: together, else on each line |

mod coefficient;
mod heating;
mod law;
mod searches;
mod slip;
mod step;
mod together;

pub use heating::Heating;
pub use law::FrictionLaw;
pub(super) use searches::{CoefficientSearches, Tried};
pub use slip::SlipDependence;
pub use step::Friction;
