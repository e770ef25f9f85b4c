//! All tests of this crate in one program, so that short ones fill the time of a core while a long one runs on the
//! other.

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

/// A file of tests that is not listed above would never run.
#[test]
fn every_file_of_tests_is_part_of_this_program() {
    let listed: Vec<&str> =
        include_str!("all.rs").lines().filter_map(|line| line.strip_prefix("mod ")?.strip_suffix(';')).collect();
    let entries = std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/tests")).unwrap();
    let mut found: Vec<String> =
        entries.map(|entry| entry.unwrap().path().file_stem().unwrap().to_string_lossy().into_owned()).collect();
    found.retain(|name| name != "all");
    found.sort_unstable();
    assert_eq!(found, listed);
}
