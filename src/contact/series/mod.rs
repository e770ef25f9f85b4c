//! Contact on a single smooth patch: tractions as series that fit the patch and the part of it that sticks.
//!
//! [`chebyshev`] has the series and their effect on a half-plane, [`tables`] and [`constants`] their constants,
//! [`surface`] the smooth part of the bodies, [`field`] what the lines of a patch do to each other, [`hot_layers`] the
//! effect of hot layers, [`places`] integrates over tractions, [`series_line`] has one line and [`contact`] what lines
//! share, [`normal`] solves the normal problem, [`slip`], [`stretch`] and [`together`] given stretches of
//! stick, [`stick`] finds where slip begins; [`points`], [`cone`] and [`cone_search`] have friction where slip is not one
//! stretch in one direction, [`along`] chooses between both, [`across`] has the lateral direction, [`open`] a wheel in the air, [`coefficients`] friction that depends on the slip, [`laws`] the states
//! of brakes, [`finish`] takes traction and power, and [`solver`] is the contact solver that says which contacts suit it. Theory:
//! `docs/theory/patch-contact.md`, `docs/theory/lines.md`.

mod across;
mod along;
pub mod chebyshev;
mod coefficients;
mod cone;
mod cone_search;
pub(super) mod constants;
mod contact;
mod field;
mod finish;
mod hot_layers;
mod laws;
mod moments;
mod normal;
mod open;
mod places;
mod points;
mod series_line;
mod slip;
mod solver;
pub(super) mod state;
mod stick;
mod stretch;
mod surface;
pub(super) mod tables;
mod together;

pub use chebyshev::Arch;
pub use solver::SeriesSolver;
pub use state::{GridPast, Past, SeriesState, Tractions};
