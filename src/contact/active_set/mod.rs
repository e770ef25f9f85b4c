//! Contact on a grid of paired surface nodes: exact Coulomb friction by an active set.
//!
//! [`search`] finds the states of the nodes, [`linear`] the forces that belong to them, [`rows`] writes gap, slip and balance as
//! rows of that linear problem, [`brake`] has the states of brakes, [`coefficient`] the search for a friction coefficient that
//! depends on the slip, [`strength`] limits the forces to what steel bears, [`retarded`] has the force of retarded layers,
//! [`zone`] watches the ends of the grid, [`finish`] reads off the result. What only saves time is in [`fast`].
//! Theory: `docs/theory/contact.md`.

mod brake;
mod coefficient;
mod fast;
mod finish;
pub(super) mod iterate;
mod linear;
mod retarded;
mod rows;
mod search;
mod solver;
mod strength;
mod zone;

pub use iterate::ActiveSetScratch;
pub use search::MAX_ITERATIONS;
pub use solver::ActiveSetSolver;
