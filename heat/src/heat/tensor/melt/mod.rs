//! Melting and freezing: where the latent heat lies below a surface node, and the step in which it changes.

pub mod column;
pub mod iteration;
pub mod latent;
mod parabola;
