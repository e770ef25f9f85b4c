//! Contact on a single smooth patch: tractions as series that fit the patch and the part of it that sticks.
//!
//! [`chebyshev`] has the series and their effect on a half-plane, [`tables`] and [`constants`] their constants,
//! [`surface`] the smooth part of the bodies, [`hot_layers`] the effect of hot layers, [`places`] integrates over
//! tractions, [`normal`] solves the normal problem, [`slip`] and [`equations`] a given stretch of stick, [`stick`]
//! finds where slip begins, [`laws`] the states of brakes and the friction coefficient, [`finish`] takes traction and
//! power, [`transfer`] leads to the grid and back, and [`solver`] decides between the two. Theory:
//! `docs/theory/patch-contact.md`.

pub mod chebyshev;
mod constants;
mod equations;
mod finish;
mod hot_layers;
mod laws;
mod normal;
mod places;
mod series_line;
mod slip;
mod solver;
pub(super) mod state;
mod stick;
mod surface;
mod tables;
mod transfer;

pub use chebyshev::Arch;
pub use solver::{Fallback, SeriesSolver};
pub use state::{Past, SeriesState, Tractions};
