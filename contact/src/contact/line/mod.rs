//! One contact line on a grid of paired surface nodes: states, history, gap, slip and read-off.
//!
//! A line knows no solver, no rigid axis and no brake: rigid motions are numbers to it. [`ContactGrid`] has the nodes,
//! [`GridState`] their states, [`LineHistory`] rim angle and friction of the step before, [`given`] the
//! known part of a problem with its [`hot_layers`] and the [`strength`] of the steel, [`contact_line`] the line in the
//! present iterate, [`kinematics`] its displacements, gaps and slips, [`rows`] the same as affine functions, [`alone`]
//! the flexibility that it has for itself, [`across`] its lateral direction, [`exchange`] how lines feel the forces of all,
//! [`field`] what the lines of a patch do to each other, [`layer`] flexibilities besides those of the bodies, [`streamline`] the upwind differences of the slip,
//! [`kernel`] the half-plane on the nodes, [`slopes`] the slopes against which pressure pushes,
//! [`rim`] the frame that turns with the rim, [`zone`] the ends of the
//! grid, [`resize`] the way to nodes of another size. Of a solution [`power`] takes the power, [`observe`] the traction,
//! with the [`slip_zone`] of every patch, and [`mod@finish`] both. Theory: `docs/theory/contact.md`.

pub(super) mod across;
pub(super) mod alone;
pub(super) mod contact_line;
pub(super) mod exchange;
pub(super) mod field;
pub(super) mod finish;
pub(super) mod given;
pub mod grid;
pub(super) mod history;
pub(super) mod hot_layers;
pub mod kernel;
pub(super) mod kinematics;
pub(super) mod layer;
pub mod observe;
pub(super) mod power;
pub(super) mod resize;
pub(super) mod rim;
pub(super) mod rows;
pub(super) mod slip_zone;
pub(super) mod slopes;
pub(super) mod state;
pub mod streamline;
pub(super) mod strength;
pub(super) mod vectors;
pub(super) mod zone;

pub use grid::ContactGrid;
pub use history::{FrictionHistory, LineHistory};
pub use state::{GridState, NodeStatus, for_each_patch};
