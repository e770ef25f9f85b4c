//! The exported C functions of both versions of FMI. Their code, and all `unsafe` of it, is that of
//! [`wheelrail_slave::c_abi`].

/// FMI 2.0.
#[allow(non_snake_case)]
mod v2 {
    wheelrail_slave::export_fmi2!(crate::fmi::slave::CoachSlave);
}

/// FMI 3.0.
#[allow(non_snake_case)]
mod v3 {
    wheelrail_slave::export_fmi3!(crate::fmi::slave::CoachSlave);
}
