//! All tests of this crate in one program, so that short ones fill the time of a core while a long one runs on the other.

mod annulus;
mod coupled;
mod dynamic;
mod meshes;
mod one_dimension;
mod report;
mod rivara;
mod rolling;
mod transient;
mod warming;
