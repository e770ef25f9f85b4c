//! Closed forms of the elliptical patch and of the contact lines side by side that stand for it.
//!
//! Pure mathematics: shape and approach after Hertz, rows of any patch, the ordinates of the lines, and half-spaces
//! under the tangential tractions of their strips. Here `x` is the direction of rolling with the half axis `a`, `z` the
//! lateral one with `b`; `η = z/b`. Everything holds for any ratio `a/b`, narrow patches as well as wide ones.

pub mod elliptic;
pub mod gauss;
pub mod hertz;
pub mod reach;
pub mod rows;
pub mod tiles;

pub use gauss::GaussLine;
pub use hertz::{Ellipse, Hertz};
pub use rows::{EquivalentEllipse, PatchRow};
pub use tiles::Tile;
