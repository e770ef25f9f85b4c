//! Tensor meshes of wheel and rail: streamlines along the surface, modes over the depth, and fields on them.

pub mod body;
pub mod depth_modes;
pub mod kernels;
pub mod layout;
pub mod nodal;
pub mod section;
pub mod streamline;
