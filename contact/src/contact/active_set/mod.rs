//! Contact on a grid of paired surface nodes: exact Coulomb friction by an active set.
//!
//! The driver of a [line](crate::contact::line): [`search`] iterates, [`states`] has the rules by which nodes open,
//! close, stick and slip, [`slides`] the directions of friction where shear has a lateral part, [`unknowns`] the unknowns of
//! given states, [`linear`] finds them around the [`own_forces`] of every line and [`corrections`] for
//! friction that turns, [`axes`] has the balances of the rigid
//! motions, [`coefficients`] the friction that follows its law, [`guess`] the closed nodes where the search starts, and
//! [`drawn`] the way where it ends nowhere; [`present`] keeps iterates. [`solver`] is the contact solver that uses it. Theory:
//! `docs/theory/contact.md`.

mod axes;
mod coefficients;
mod corrections;
mod drawn;
mod guess;
mod linear;
mod own_forces;
mod present;
mod search;
mod slides;
mod solver;
mod states;
mod unknowns;

pub use search::{ActiveSetScratch, MAX_ITERATIONS};
pub use solver::ActiveSetSolver;
