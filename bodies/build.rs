//! Reduced bases are computed once and stored. A basis is only right for the code that computed it, so the build gives the
//! code a digest of its own sources, which becomes part of the key under which a basis is stored.

use std::collections::BTreeMap;
use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed=build.rs");
    println!(
        "cargo::rustc-env=BASIS_CODE={:016x}",
        digest(&[
            "bodies/src",
            "numerics/src/analytic.rs",
            "numerics/src/axes.rs",
            "numerics/src/fem",
            "numerics/src/linalg",
        ])?
    );
    Ok(())
}

/// Digest of some files, and of all in some directories, named from the root of the checkout: 64-bit FNV-1a of names and
/// contents, each with its length.
///
/// Equal on every machine and with every compiler, unlike the hashes of the standard library; `tests/tree/basis_code.rs`
/// computes it once more.
fn digest(sources: &[&str]) -> Result<u64, Box<dyn Error>> {
    let mut files: BTreeMap<String, Vec<u8>> = BTreeMap::new();
    let root = Path::new("..");
    let mut paths: Vec<PathBuf> = sources.iter().map(|source| root.join(source)).collect();
    while let Some(path) = paths.pop() {
        println!("cargo::rerun-if-changed={}", path.display());
        if path.is_dir() {
            paths.extend(fs::read_dir(path)?.map(|entry| Ok(entry?.path())).collect::<std::io::Result<Vec<_>>>()?);
        } else {
            let name: Vec<String> =
                path.strip_prefix(root)?.iter().map(|part| part.to_string_lossy().into_owned()).collect();
            files.insert(name.join("/"), fs::read(path)?);
        }
    }
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    let mut add = |bytes: &[u8]| {
        for byte in (bytes.len() as u64).to_le_bytes().iter().chain(bytes) {
            hash = (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    };
    for (name, content) in &files {
        add(name.as_bytes());
        add(content);
    }
    Ok(hash)
}
