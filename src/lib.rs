#![deny(unsafe_code)]
pub mod analytic;
pub mod config;
pub mod contact;
