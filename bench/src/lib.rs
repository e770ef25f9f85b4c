//! The wheel on a bench: runs that a page in the browser drives, as a module of WebAssembly.
//!
//! The model is the crate `wheelrail`, unchanged. A run is a text ([`settings`]): how it starts and what is changed
//! when. [`run`] steps it, [`frame`] is what the page draws of it, [`record`] its table and [`python`] the program that
//! repeats it. [`abi`] is what the page calls; natively it is a library of the same functions.
#![deny(unsafe_code)]
#![warn(missing_docs)]

#[allow(unsafe_code)]
pub mod abi;
pub mod bench;
pub mod frame;
pub mod link;
pub mod patch_map;
pub mod python;
pub mod rail;
pub mod record;
pub mod run;
pub mod script;
pub mod settings;
