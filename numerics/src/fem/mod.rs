//! Finite elements: meshes, bilinear quadrilaterals, assembly.

pub mod assembly;
pub mod element;
mod error;
pub mod graded;
pub mod grading;
pub mod mesh;

pub use assembly::{AssemblyPattern, DofMap, assemble, assemble_faces, assemble_vector};
pub use element::CellPoint;
pub use error::FemError;
pub use graded::ContactZone;
pub use mesh::{Face, Mesh};
