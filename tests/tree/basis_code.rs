//! The digest of the code in the keys of stored bases is what the sources say, independent of compiler and machine.

use std::fs;
use std::path::Path;
use wheelrail::mechanics::basis::CODE;

/// Sources on which a basis depends, besides the configuration.
const SOURCES: [&str; 5] =
    ["bodies/src", "numerics/src/analytic.rs", "numerics/src/axes.rs", "numerics/src/fem", "numerics/src/linalg"];

/// Relative names of a file, or of all files in a directory.
fn names(root: &Path, name: &str) -> Vec<String> {
    let path = root.join(name);
    if path.is_file() {
        return vec![name.to_owned()];
    }
    let entries = fs::read_dir(path).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
    entries.flat_map(|entry| names(root, &format!("{name}/{entry}"))).collect()
}

/// 64-bit FNV-1a (Fowler, Noll, Vo; RFC 9923).
fn fnv(hash: u64, bytes: &[u8]) -> u64 {
    bytes.iter().fold(hash, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(1_099_511_628_211))
}

#[test]
fn digest_of_the_code_is_that_of_its_sources() {
    // Published test vectors.
    const EMPTY: u64 = 14_695_981_039_346_656_037;
    assert_eq!((fnv(EMPTY, b"a"), fnv(EMPTY, b"foobar")), (0xaf63_dc4c_8601_ec8c, 0x8594_4171_f739_67e8));
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut all: Vec<String> = SOURCES.iter().flat_map(|source| names(root, source)).collect();
    all.sort();
    assert!(all.len() > 15, "{all:?}");
    let with_length = |hash: u64, bytes: &[u8]| fnv(fnv(hash, &(bytes.len() as u64).to_le_bytes()), bytes);
    let digest = all
        .iter()
        .fold(EMPTY, |hash, name| with_length(with_length(hash, name.as_bytes()), &fs::read(root.join(name)).unwrap()));
    assert_eq!(CODE, format!("{digest:016x}"));
}
