//! Frictional contact of two deformable bodies: unilateral contact and exact Coulomb friction.
//!
//! The bodies enter only through the answer of their surfaces ([`ContactProblem`]), so this room knows neither finite
//! elements nor how the rolling motion is advanced. [`active_set`] solves a contact on the paired surface nodes of a
//! [`mod@line`]; what anyone else learns of a solved contact is its [`Traction`]. Everything is per metre of width;
//! [`crate::patch`] has the closed forms of a patch of finite width. Forces are those on the *wheel*: `F_x > 0` drives it
//! forward, `F_y > 0` (pressure) lifts it; the rail receives the opposite.

pub mod active_set;
mod brake;
pub mod error;
pub mod film;
mod flexibility;
pub mod friction;
mod kernel;
pub mod layout;
pub mod limits;
pub mod line;
pub mod problem;
mod projection;
mod state;
pub mod traction;
mod undeformed;

pub use active_set::{ActiveSetScratch, ActiveSetSolver};
pub use error::ContactError;
pub use flexibility::{HalfSpace, InPatch, PatchFlexibility};
pub use friction::{Friction, FrictionLaw, Heating, SlipDependence};
pub use kernel::{Layer, LineKernel, Logarithm};
pub use layout::{LineLayout, NodeSize, PatchLayout, PatchMaterial};
pub use limits::SteelLimits;
pub use problem::{
    AxisDrive, Begin, BySpeed, ContactProblem, Drift, Influence, LineProblem, RigidMotion, SurfaceResponse,
};
pub use state::ContactState;
pub use traction::{SolvedFriction, Traction, Yielding};
pub use undeformed::{Undeformed, Unevenness};
