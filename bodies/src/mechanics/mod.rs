//! Deformation of wheel and rail: elasticity, inertia and convection in the streaming frame, per metre of width.

pub mod ale;
pub mod basis;
pub mod damping;
pub mod elasticity;
mod ends;
mod error;
pub mod field;
pub mod full;
mod kinds;
mod meshes;
mod motion;
mod pair;
mod parameters;
mod products;
mod rectangle;
pub mod reduced;
pub mod reduction;
pub mod response;
mod shapes;
pub mod size;
pub mod smooth;
pub mod solver;
pub mod system;
#[cfg(test)]
pub mod testing;
mod triangle;

pub use basis::{Basis, BasisError};
pub use damping::BodyDamping;
pub use error::MechanicsError;
pub use full::FullBody;
pub use meshes::{rail_mesh, rail_system, wheel_mesh, wheel_system};
pub use motion::BodyResponse;
pub use pair::{Pair, bodies};
pub use parameters::{BodyParameters, Ends};
pub use reduced::ReducedBody;
pub use reduction::ReducedBasis;
pub use response::{BodyState, Convection, FreeResponse, StepOperator};
pub use size::{check_size, contact_zone};
pub use system::BodySystem;
