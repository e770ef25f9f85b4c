//! Reading and setting of values.

use super::marshal::boolean;
use super::types::*;
use crate::c_abi::call;
use crate::c_abi::component::Component;
use crate::c_abi::marshal::{c_string, slice, store, text};
use crate::instance::ScalarAccess;
use crate::log::Outcome;
use crate::value::{Scalar, Type};

impl<S: ScalarAccess> Component<S> {
    /// Values of variables of one type, each taken out by `plain`.
    unsafe fn values<T>(
        &mut self,
        (vr, nvr): (*const fmi2ValueReference, usize),
        wanted: Type,
        plain: impl Fn(Scalar) -> Option<T>,
    ) -> Outcome<Vec<T>> {
        // SAFETY: see the module.
        let values = self.instance.get(unsafe { slice(vr, nvr, "vr") }?, wanted)?;
        Ok(values.into_iter().filter_map(|value| plain(value.try_into().ok()?)).collect())
    }

    /// Sets variables to values of one type.
    unsafe fn set_values(
        &mut self,
        (vr, nvr): (*const fmi2ValueReference, usize),
        values: impl Iterator<Item = Scalar>,
    ) -> Outcome {
        // SAFETY: see the module.
        self.instance.set(unsafe { slice(vr, nvr, "vr") }?, values.map(S::Value::from).collect())
    }
}

/// Reads real variables.
pub unsafe fn fmi2GetReal<S: ScalarAccess>(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    value: *mut fmi2Real,
) -> fmi2Status {
    let plain = |scalar| if let Scalar::Real(v) = scalar { Some(v) } else { None };
    // SAFETY: see the module.
    unsafe {
        call::<S>(c, "fmi2GetReal", |component| store(value, component.values((vr, nvr), Type::Real, plain)?, "value"))
    }
}

/// Reads integer variables.
pub unsafe fn fmi2GetInteger<S: ScalarAccess>(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    value: *mut fmi2Integer,
) -> fmi2Status {
    let plain = |scalar| if let Scalar::Integer(v) = scalar { Some(v) } else { None };
    // SAFETY: see the module.
    unsafe {
        call::<S>(c, "fmi2GetInteger", |component| {
            store(value, component.values((vr, nvr), Type::Integer, plain)?, "value")
        })
    }
}

/// Reads boolean variables.
pub unsafe fn fmi2GetBoolean<S: ScalarAccess>(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    value: *mut fmi2Boolean,
) -> fmi2Status {
    let plain = |scalar| if let Scalar::Boolean(v) = scalar { Some(v.into()) } else { None };
    // SAFETY: see the module.
    unsafe {
        call::<S>(c, "fmi2GetBoolean", |component| {
            store(value, component.values((vr, nvr), Type::Boolean, plain)?, "value")
        })
    }
}

/// Reads text variables; the texts live until the next call of this function.
pub unsafe fn fmi2GetString<S: ScalarAccess>(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    value: *mut fmi2String,
) -> fmi2Status {
    let plain = |scalar| if let Scalar::String(v) = scalar { Some(c_string(&v)) } else { None };
    // SAFETY: see the module.
    unsafe {
        call::<S>(c, "fmi2GetString", |component| {
            component.strings = component.values((vr, nvr), Type::String, plain)?;
            store(value, component.strings.iter().map(|string| string.as_ptr()).collect(), "value")
        })
    }
}

/// Sets real variables.
pub unsafe fn fmi2SetReal<S: ScalarAccess>(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    value: *const fmi2Real,
) -> fmi2Status {
    // SAFETY: see the module.
    unsafe {
        call::<S>(c, "fmi2SetReal", |component| {
            component.set_values((vr, nvr), slice(value, nvr, "value")?.iter().map(|v| Scalar::Real(*v)))
        })
    }
}

/// Sets integer variables.
pub unsafe fn fmi2SetInteger<S: ScalarAccess>(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    value: *const fmi2Integer,
) -> fmi2Status {
    // SAFETY: see the module.
    unsafe {
        call::<S>(c, "fmi2SetInteger", |component| {
            component.set_values((vr, nvr), slice(value, nvr, "value")?.iter().map(|v| Scalar::Integer(*v)))
        })
    }
}

/// Sets boolean variables.
pub unsafe fn fmi2SetBoolean<S: ScalarAccess>(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    value: *const fmi2Boolean,
) -> fmi2Status {
    // SAFETY: see the module.
    unsafe {
        call::<S>(c, "fmi2SetBoolean", |component| {
            let name = |reference: &fmi2ValueReference| {
                S::name_of(*reference).unwrap_or_else(|| format!("value reference {reference}"))
            };
            let pairs = slice(vr, nvr, "vr")?.iter().zip(slice(value, nvr, "value")?);
            let values = pairs.map(|(reference, v)| boolean(*v, &name(reference))).collect::<Outcome<Vec<_>>>()?;
            component.set_values((vr, nvr), values.into_iter().map(Scalar::Boolean))
        })
    }
}

/// Sets text variables.
pub unsafe fn fmi2SetString<S: ScalarAccess>(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    value: *const fmi2String,
) -> fmi2Status {
    // SAFETY: see the module.
    unsafe {
        call::<S>(c, "fmi2SetString", |component| {
            let values = slice(value, nvr, "value")?.iter().map(|v| text(*v, "value")).collect::<Outcome<Vec<_>>>()?;
            component.set_values((vr, nvr), values.into_iter().map(Scalar::String))
        })
    }
}
