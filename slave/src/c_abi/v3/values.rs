//! Reading and setting of values, and derivatives.

use super::types::*;
use crate::ArrayAccess;
use crate::array_access::check_length;
use crate::c_abi::call;
use crate::c_abi::component::Component;
use crate::c_abi::marshal::{c_string, slice, store, text};
use crate::log::{CallError, Outcome};
use crate::value::{ElementType, Scalar};

/// Value references or values that a master passed, or places for them, with their number.
type Counted<T> = (T, usize);

/// Writes as many values as the master expects.
unsafe fn store_all<T>((first, count): Counted<*mut T>, values: Vec<T>, argument: &str) -> Outcome {
    check_length(&format!("n{argument}"), count, values.len())?;
    // SAFETY: see the module.
    unsafe { store(first, values, &argument.to_lowercase()) }
}

impl<S: ArrayAccess> Component<S> {
    /// Values of variables of one type, each taken out by `plain`.
    unsafe fn read<T>(
        &mut self,
        (references, count): Counted<*const fmi3ValueReference>,
        wanted: ElementType,
        plain: impl Fn(Scalar) -> Option<T>,
    ) -> Outcome<Vec<T>> {
        // SAFETY: see the module.
        let values = self.instance.read(unsafe { slice(references, count, "valueReferences") }?, wanted)?;
        Ok(values.into_iter().filter_map(plain).collect())
    }

    /// Sets variables of one type.
    unsafe fn write<T>(
        &mut self,
        (references, count): Counted<*const fmi3ValueReference>,
        wanted: ElementType,
        (values, many): Counted<*const T>,
        scalar: impl Fn(&T) -> Outcome<Scalar>,
    ) -> Outcome {
        // SAFETY: see the module.
        let (references, values) =
            unsafe { (slice(references, count, "valueReferences")?, slice(values, many, "values")?) };
        let values = values.iter().map(scalar).collect::<Outcome<Vec<_>>>()?;
        self.instance.write(references, wanted, values)
    }
}

/// Functions that read or set values of one type, as the standard has them.
macro_rules! access {
    ($get:ident, $set:ident, $kind:ty, $wanted:ident, $text:literal, $plain:expr, $scalar:expr) => {
        #[doc = concat!("Reads ", $text, ".")]
        pub unsafe fn $get<S: ArrayAccess>(
            instance: fmi3Instance,
            valueReferences: *const fmi3ValueReference,
            nValueReferences: usize,
            values: *mut $kind,
            nValues: usize,
        ) -> fmi3Status {
            // SAFETY: see the module.
            unsafe {
                call::<S>(instance, stringify!($get), |component| {
                    let read = component.read((valueReferences, nValueReferences), ElementType::$wanted, $plain)?;
                    store_all((values, nValues), read, "Values")
                })
            }
        }

        #[doc = concat!("Sets ", $text, ".")]
        pub unsafe fn $set<S: ArrayAccess>(
            instance: fmi3Instance,
            valueReferences: *const fmi3ValueReference,
            nValueReferences: usize,
            values: *const $kind,
            nValues: usize,
        ) -> fmi3Status {
            // SAFETY: see the module.
            unsafe {
                call::<S>(instance, stringify!($set), |component| {
                    let references = (valueReferences, nValueReferences);
                    component.write(references, ElementType::$wanted, (values, nValues), $scalar)
                })
            }
        }
    };
}

fn number(scalar: Scalar) -> Option<i32> {
    if let Scalar::Integer(v) = scalar { Some(v) } else { None }
}

/// An item of an enumeration: all have numbers of 32 bits.
fn item(value: &fmi3Int64) -> Outcome<Scalar> {
    let outside = |_| CallError::error(format!("{value} is no item of an enumeration: the largest is {}", i32::MAX));
    i32::try_from(*value).map(Scalar::Integer).map_err(outside)
}

access!(
    fmi3GetFloat64,
    fmi3SetFloat64,
    fmi3Float64,
    Float64,
    "real variables",
    |scalar| if let Scalar::Real(v) = scalar { Some(v) } else { None },
    |value| Ok(Scalar::Real(*value))
);
access!(fmi3GetInt32, fmi3SetInt32, fmi3Int32, Int32, "integer variables", number, |value| Ok(Scalar::Integer(*value)));
access!(
    fmi3GetInt64,
    fmi3SetInt64,
    fmi3Int64,
    Int64,
    "enumerations, by the numbers of their items",
    |scalar| number(scalar).map(fmi3Int64::from),
    item
);
access!(
    fmi3GetBoolean,
    fmi3SetBoolean,
    fmi3Boolean,
    Boolean,
    "boolean variables",
    |scalar| if let Scalar::Boolean(v) = scalar { Some(v.into()) } else { None },
    |value| boolean(*value, "values").map(Scalar::Boolean)
);

/// Reads text variables; the texts live until the next call of this function.
pub unsafe fn fmi3GetString<S: ArrayAccess>(
    instance: fmi3Instance,
    valueReferences: *const fmi3ValueReference,
    nValueReferences: usize,
    values: *mut fmi3String,
    nValues: usize,
) -> fmi3Status {
    let plain = |scalar| if let Scalar::String(v) = scalar { Some(c_string(&v)) } else { None };
    // SAFETY: see the module.
    unsafe {
        call::<S>(instance, "fmi3GetString", |component| {
            component.strings = component.read((valueReferences, nValueReferences), ElementType::String, plain)?;
            let strings = component.strings.iter().map(|string| string.as_ptr()).collect();
            store_all((values, nValues), strings, "Values")
        })
    }
}

/// Sets text variables.
pub unsafe fn fmi3SetString<S: ArrayAccess>(
    instance: fmi3Instance,
    valueReferences: *const fmi3ValueReference,
    nValueReferences: usize,
    values: *const fmi3String,
    nValues: usize,
) -> fmi3Status {
    // SAFETY: see the module.
    unsafe {
        call::<S>(instance, "fmi3SetString", |component| {
            let string = |value: &fmi3String| text(*value, "values").map(Scalar::String);
            let references = (valueReferences, nValueReferences);
            component.write(references, ElementType::String, (values, nValues), string)
        })
    }
}

/// Derivatives of outputs along a direction of inputs.
#[allow(clippy::too_many_arguments)]
pub unsafe fn fmi3GetDirectionalDerivative<S: ArrayAccess>(
    instance: fmi3Instance,
    unknowns: *const fmi3ValueReference,
    nUnknowns: usize,
    knowns: *const fmi3ValueReference,
    nKnowns: usize,
    seed: *const fmi3Float64,
    nSeed: usize,
    sensitivity: *mut fmi3Float64,
    nSensitivity: usize,
) -> fmi3Status {
    // SAFETY: see the module.
    unsafe {
        call::<S>(instance, "fmi3GetDirectionalDerivative", |component| {
            let (unknowns, knowns) = (slice(unknowns, nUnknowns, "unknowns")?, slice(knowns, nKnowns, "knowns")?);
            let found = component.instance.directional(unknowns, knowns, slice(seed, nSeed, "seed")?)?;
            store_all((sensitivity, nSensitivity), found, "Sensitivity")
        })
    }
}

/// Derivatives of a weighted sum of outputs by each input.
#[allow(clippy::too_many_arguments)]
pub unsafe fn fmi3GetAdjointDerivative<S: ArrayAccess>(
    instance: fmi3Instance,
    unknowns: *const fmi3ValueReference,
    nUnknowns: usize,
    knowns: *const fmi3ValueReference,
    nKnowns: usize,
    seed: *const fmi3Float64,
    nSeed: usize,
    sensitivity: *mut fmi3Float64,
    nSensitivity: usize,
) -> fmi3Status {
    // SAFETY: see the module.
    unsafe {
        call::<S>(instance, "fmi3GetAdjointDerivative", |component| {
            let (unknowns, knowns) = (slice(unknowns, nUnknowns, "unknowns")?, slice(knowns, nKnowns, "knowns")?);
            let found = component.instance.adjoint(unknowns, knowns, slice(seed, nSeed, "seed")?)?;
            store_all((sensitivity, nSensitivity), found, "Sensitivity")
        })
    }
}

/// Time derivatives of outputs.
pub unsafe fn fmi3GetOutputDerivatives<S: ArrayAccess>(
    instance: fmi3Instance,
    valueReferences: *const fmi3ValueReference,
    nValueReferences: usize,
    orders: *const fmi3Int32,
    values: *mut fmi3Float64,
    nValues: usize,
) -> fmi3Status {
    // SAFETY: see the module.
    unsafe {
        call::<S>(instance, "fmi3GetOutputDerivatives", |component| {
            let references = slice(valueReferences, nValueReferences, "valueReferences")?;
            let orders = slice(orders, nValueReferences, "orders")?;
            store_all((values, nValues), component.instance.output_rates(references, orders)?, "Values")
        })
    }
}
