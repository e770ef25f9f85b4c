//! One contact line on a grid of paired surface nodes: what is closed, what sticks, and what forces do to gap and slip.
//!
//! A line knows no solver, no rigid axis and no brake. [`ContactGrid`] has the nodes, [`LineState`] their states and history,
//! [`streamline`] the upwind differences of the slip, [`kernel`] the correction of the compliance at grid scale, [`slopes`] the
//! slopes against which pressure pushes, [`rim`] the frame that turns with the rim, [`regrid`] the change to a wider or narrower
//! grid, [`observe`] the traction and [`power`] the power of a solution. Theory: `docs/theory/contact.md`.

pub mod grid;
pub mod kernel;
pub mod observe;
pub(super) mod power;
pub(super) mod regrid;
pub(super) mod rim;
pub(super) mod slopes;
pub(super) mod state;
pub mod streamline;

pub use grid::ContactGrid;
pub use state::{FrictionHistory, LineState, Status, for_each_patch};
