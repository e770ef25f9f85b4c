//! Contact on a grid of paired surface nodes: exact Coulomb friction by an active set.
//!
//! [`rows`] writes gap, slip and balance as rows of a linear system, [`streamline`] gives the slip its upwind
//! differences, [`slopes`] sees what the pressure pushes against, [`frame`] turns with the rim, [`active_set`] finds the states of the nodes and [`linear`] the forces that belong to them, on a single patch [`by_turns`], while [`foresight`] guesses the states where surfaces are uneven, [`brake`] those of brakes, [`kernel`] corrects the
//! compliance at grid scale, [`observe`] reads the traction off the solution, [`strength`] limits the forces to what steel bears, [`power`] balances its power, and [`zone`] watches the ends of the grid. Theory: `docs/theory/contact.md`.

mod active_set;
mod brake;
mod by_turns;
mod candidates;
mod coefficient;
mod conclude;
mod foresight;
mod frame;
pub(super) mod iterate;
pub mod kernel;
mod late;
mod linear;
mod nested;
pub mod observe;
mod patch_inverse;
mod power;
mod rows;
mod slopes;
mod solver;
pub(super) mod state;
pub mod streamline;
mod strength;
mod turns;
mod zone;

pub use active_set::MAX_ITERATIONS;
pub use candidates::ContactGrid;
pub use iterate::GridScratch;
pub use solver::GridSolver;
pub use state::{FrictionHistory, GridState, Status, for_each_patch};
