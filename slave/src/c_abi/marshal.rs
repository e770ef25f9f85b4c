//! Values on their way through the C interface: pointers are checked, C integers matched, never trusted.

use crate::log::{CallError, Outcome};
use std::ffi::{CStr, CString, c_char};

/// Refuses a number of elements that no array has: there are no more value references, and no more memory to address.
pub fn check_count<T>(count: usize, name: &str) -> Outcome {
    let most = (u32::MAX as usize).min(isize::MAX as usize / size_of::<T>());
    if count <= most {
        return Ok(());
    }
    Err(CallError::error(format!("number of elements of {name} = {count} is outside its range: at most {most}")))
}

/// The array a master passed; an empty one may be NULL.
///
/// # Safety
/// `first` is NULL or the first of `count` elements that outlive the call.
pub unsafe fn slice<'a, T>(first: *const T, count: usize, name: &str) -> Outcome<&'a [T]> {
    check_count::<T>(count, name)?;
    match (count, first.is_null()) {
        (0, _) => Ok(&[]),
        (_, true) => Err(CallError::error(format!("{name} is NULL"))),
        // SAFETY: the condition of this function, and no more bytes than can be addressed.
        _ => Ok(unsafe { std::slice::from_raw_parts(first, count) }),
    }
}

/// Writes `values` to the array at `first`.
///
/// # Safety
/// `first` is NULL or has room for as many elements as there are values.
pub unsafe fn store<T>(first: *mut T, values: Vec<T>, name: &str) -> Outcome {
    if first.is_null() && !values.is_empty() {
        return Err(CallError::error(format!("{name} is NULL")));
    }
    for (i, value) in values.into_iter().enumerate() {
        // SAFETY: the condition of this function.
        unsafe { first.add(i).write(value) };
    }
    Ok(())
}

/// A string of the master, copied.
///
/// # Safety
/// `string` is NULL or ends with NUL.
pub unsafe fn text(string: *const c_char, name: &str) -> Outcome<String> {
    if string.is_null() {
        return Err(CallError::error(format!("{name} is NULL")));
    }
    // SAFETY: the condition of this function.
    let bytes = unsafe { CStr::from_ptr(string) };
    let text = bytes.to_str().map_err(|_| CallError::error(format!("{name} is not UTF-8: {bytes:?}")))?;
    Ok(text.to_owned())
}

/// The text as a C string; NUL inside becomes a space.
pub fn c_string(text: &str) -> CString {
    CString::new(text.replace('\0', " ")).unwrap_or_default()
}

/// The value of a C boolean of a version of the standard. Only 0 and 1 are values of it: another number is a mistake of the
/// master, for example an integer variable taken for a boolean one.
pub fn flag(value: i32, version: u8, name: &str) -> Outcome<bool> {
    match value {
        0 => Ok(false),
        1 => Ok(true),
        _ => {
            let right = format!("pass 0 (fmi{version}False) or 1 (fmi{version}True)");
            Err(CallError::error(format!("{name} = {value} is no fmi{version}Boolean: {right}")))
        }
    }
}
