//! Contact on a grid of paired surface nodes: exact Coulomb friction by an active set.
//!
//! [`rows`] writes gap, slip and balance as rows of a linear system, [`streamline`] gives the slip its upwind
//! differences, [`slopes`] sees what the pressure pushes against, [`frame`] turns with the rim, [`active_set`] finds the states of the nodes, which [`foresight`] guesses where surfaces are uneven, [`brake`] those of brakes, [`kernel`] corrects the
//! compliance at grid scale, [`observe`] reads the traction off the solution, [`power`] balances its power, and [`zone`] watches the ends of the grid. Theory: `docs/theory/contact.md`.

mod active_set;
mod brake;
mod candidates;
mod coefficient;
mod conclude;
mod foresight;
mod frame;
pub(super) mod iterate;
pub mod kernel;
mod late;
mod nested;
pub mod observe;
mod power;
mod rows;
mod slopes;
mod solver;
pub(super) mod state;
pub mod streamline;
mod zone;

pub use active_set::MAX_ITERATIONS;
pub use candidates::ContactGrid;
pub use iterate::GridScratch;
pub use solver::GridSolver;
pub use state::{FrictionHistory, GridState, Status, for_each_patch};
