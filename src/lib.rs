#![deny(unsafe_code)]
pub mod analytic;
pub mod config;
pub mod contact;
pub mod fem;
pub mod linalg;
pub mod mechanics;
pub mod rolling;
pub mod simulation;
