//! The compiled library as a file: what it exports and what it needs.
#![allow(unsafe_code)]

use crate::slave::*;
use std::ffi::CStr;

/// The dynamic symbols of a Linux library: defined for others or not.
#[cfg(target_os = "linux")]
fn symbols(defined: bool) -> Vec<String> {
    use object::{Object, ObjectSymbol};
    let bytes = std::fs::read(library()).unwrap();
    let file = object::File::parse(&*bytes).unwrap();
    let wanted = file.dynamic_symbols().filter(|s| s.is_global() && s.is_definition() == defined);
    let mut names: Vec<_> = wanted.map(|symbol| symbol.name().unwrap().to_owned()).collect();
    names.sort();
    names
}

/// Names of the libraries that must be there to load ours, without their versions.
#[cfg(target_os = "linux")]
fn needed() -> Vec<String> {
    use object::read::elf::ElfFile64;
    let bytes = std::fs::read(library()).unwrap();
    let file = ElfFile64::<object::Endianness>::parse(&*bytes).unwrap();
    let table = file.elf_section_table().dynamic_table(file.endian(), &*bytes).unwrap();
    let entries = table.iter().filter(|entry| entry.tag == object::elf::DT_NEEDED);
    let name = |entry| String::from_utf8(table.string(entry).unwrap().to_owned()).unwrap();
    entries.map(|entry| name(entry).split(".so").next().unwrap().to_owned()).collect()
}

#[test]
#[cfg(target_os = "linux")]
fn it_needs_nothing_but_the_c_runtime() {
    let needed = needed();
    let known = ["libc", "ld-linux-x86-64", "ld-linux-aarch64"];
    println!("{needed:?}");
    assert!(needed.iter().any(|name| name == "libc"), "{needed:?}");
    // `libm` would mean that results depend on the mathematical library of the machine: on its version, and on the
    // instructions that it picks for the processor.
    assert!(needed.iter().all(|name| known.contains(&name.as_str())), "{needed:?}");
}

/// Largest size of what is loaded of the ordinary library \[bytes]. `make fmu ALL=1` links the same code for whole
/// programs and refuses more than 6 MB (`packaging/check.py`); this build has 1.43 times as much.
#[cfg(target_os = "linux")]
const LARGEST: u64 = 8_600_000;

#[test]
#[cfg(target_os = "linux")]
fn what_is_loaded_of_it_leaves_room_for_the_limit_of_all_platforms() {
    use object::{Object, ObjectSegment};
    let bytes = std::fs::read(library()).unwrap();
    let file = object::File::parse(&*bytes).unwrap();
    let size: u64 = file.segments().map(|segment| segment.file_range().1).sum();
    println!("{:.2} MB", size as f64 / 1e6);
    assert!((1_000_000..LARGEST).contains(&size), "{size} bytes: find what has grown, or move both limits");
}

#[test]
#[cfg(target_os = "linux")]
fn exactly_the_34_functions_of_fmi_2_and_the_75_of_fmi_3_are_exported() {
    let expected = "fmi2CancelStep fmi2DeSerializeFMUstate fmi2DoStep fmi2EnterInitializationMode \
        fmi2ExitInitializationMode fmi2FreeFMUstate fmi2FreeInstance fmi2GetBoolean fmi2GetBooleanStatus \
        fmi2GetDirectionalDerivative fmi2GetFMUstate fmi2GetInteger fmi2GetIntegerStatus fmi2GetReal \
        fmi2GetRealOutputDerivatives fmi2GetRealStatus fmi2GetStatus fmi2GetString fmi2GetStringStatus \
        fmi2GetTypesPlatform fmi2GetVersion fmi2Instantiate fmi2Reset fmi2SerializeFMUstate \
        fmi2SerializedFMUstateSize fmi2SetBoolean fmi2SetDebugLogging fmi2SetFMUstate fmi2SetInteger fmi2SetReal \
        fmi2SetRealInputDerivatives fmi2SetString fmi2SetupExperiment fmi2Terminate";
    let expected: Vec<&str> = expected.split_whitespace().collect();
    assert_eq!(expected.len(), 34);
    let (two, three): (Vec<_>, Vec<_>) = symbols(true).into_iter().partition(|name| name.starts_with("fmi2"));
    assert_eq!(two, expected);
    // Their names and arguments are compared with the header by `fmpy_tests/test_fmi3.py`.
    assert!(three.len() == 75 && three.iter().all(|name| name.starts_with("fmi3")), "{three:?}");
}

#[test]
fn version_and_platform_are_those_of_the_standard() {
    let dll = load();
    let [version, platform] =
        unsafe { [dll.fmi2GetVersion(), dll.fmi2GetTypesPlatform()].map(|text| CStr::from_ptr(text)) };
    assert_eq!((version, platform), (c"2.0", c"default"));
}
