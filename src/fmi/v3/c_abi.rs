//! The exported C functions. Their code, and all `unsafe` of it, is that of [`wheelrail_slave::c_abi`].

#![allow(non_snake_case)]

wheelrail_slave::export_fmi3!(crate::fmi::instance::WheelSlave);
