//! What the compiler alone does not do for the shared library.
//!
//! - The library of an FMU exports the functions of the standard and no others, and needs no libraries but those of the C
//!   runtime: options for the linker.
//! - Reduced bases are computed once and stored. A basis is only right for the code that computed it, so the build gives the
//!   code a digest of its own sources, which becomes part of the key under which a basis is stored.

use std::collections::BTreeMap;
use std::error::Error;
use std::fs;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed=build.rs");
    println!(
        "cargo::rustc-env=BASIS_CODE={:016x}",
        digest(&["src/analytic.rs", "src/linalg", "src/fem", "src/mechanics"])?
    );
    let target = |key: &str| std::env::var(format!("CARGO_CFG_TARGET_{key}")).unwrap_or_default();
    if target("OS") == "linux" {
        println!("cargo::rustc-cdylib-link-arg=-Wl,--exclude-libs,ALL");
        if target("ENV") == "gnu" {
            // The unwinder behind the panic barrier from the static library: the standard library asks for `gcc_s`, and
            // the linker finds this script under that name first.
            let directory = std::env::var("OUT_DIR")?;
            fs::write(Path::new(&directory).join("libgcc_s.so"), "INPUT(-lgcc_eh -lgcc)\n")?;
            println!("cargo::rustc-cdylib-link-arg=-L{directory}");
        }
    }
    Ok(())
}

/// Digest of some files, and of all in some directories.
fn digest(sources: &[&str]) -> Result<u64, Box<dyn Error>> {
    let mut files: BTreeMap<PathBuf, Vec<u8>> = BTreeMap::new();
    let mut paths: Vec<PathBuf> = sources.iter().map(PathBuf::from).collect();
    while let Some(path) = paths.pop() {
        println!("cargo::rerun-if-changed={}", path.display());
        if path.is_dir() {
            paths.extend(fs::read_dir(path)?.map(|entry| Ok(entry?.path())).collect::<std::io::Result<Vec<_>>>()?);
        } else {
            files.insert(path.clone(), fs::read(path)?);
        }
    }
    let mut hasher = DefaultHasher::new();
    files.hash(&mut hasher);
    Ok(hasher.finish())
}
