//! Steps of building the shared library that the compiler does not take alone.
//!
//! - The library of an FMU exports the functions of the standard and no others, and needs no libraries but those of the
//!   C runtime: options for the linker.
//! - Reduced bases are computed once and stored. A basis is only right for the code that computed it, so the build
//!   gives the code a digest of its own sources, which becomes part of the key under which a basis is stored.

use std::collections::BTreeMap;
use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed=build.rs");
    println!(
        "cargo::rustc-env=BASIS_CODE={:016x}",
        digest(&[
            "contact/src/axes.rs",
            "numerics/src/analytic.rs",
            "numerics/src/fem",
            "numerics/src/linalg",
            "src/material.rs",
            "src/mechanics",
        ])?
    );
    let target = |key: &str| std::env::var(format!("CARGO_CFG_TARGET_{key}")).unwrap_or_default();
    if target("OS") == "linux" {
        let directory = std::env::var("OUT_DIR")?;
        let zig = std::env::var("RUSTC_LINKER").is_ok_and(|linker| linker.contains("zigcc"));
        if zig {
            // The linker of zig knows no `--exclude-libs`; of several version scripts it takes the last, which is this
            // one.
            let script = Path::new(&directory).join("exports");
            fs::write(&script, "{ global: fmi2*; fmi3*; local: *; };\n")?;
            println!("cargo::rustc-cdylib-link-arg=-Wl,--version-script={}", script.display());
        } else {
            println!("cargo::rustc-cdylib-link-arg=-Wl,--exclude-libs,ALL");
        }
        if target("ENV") == "gnu" && !zig {
            // The unwinder behind the panic barrier from the static library: the standard library asks for `gcc_s`, and
            // the linker finds this script under that name first. Zig brings its own, linked statically.
            fs::write(Path::new(&directory).join("libgcc_s.so"), "INPUT(-lgcc_eh -lgcc)\n")?;
            println!("cargo::rustc-cdylib-link-arg=-L{directory}");
        }
    }
    Ok(())
}

/// Digest of some files, and of all in some directories: 64-bit FNV-1a of names and contents, each with its length.
///
/// Equal on every machine and with every compiler, unlike the hashes of the standard library; `tests/tree/basis_code.rs`
/// computes it once more.
fn digest(sources: &[&str]) -> Result<u64, Box<dyn Error>> {
    let mut files: BTreeMap<String, Vec<u8>> = BTreeMap::new();
    let mut paths: Vec<PathBuf> = sources.iter().map(PathBuf::from).collect();
    while let Some(path) = paths.pop() {
        println!("cargo::rerun-if-changed={}", path.display());
        if path.is_dir() {
            paths.extend(fs::read_dir(path)?.map(|entry| Ok(entry?.path())).collect::<std::io::Result<Vec<_>>>()?);
        } else {
            let name: Vec<String> = path.iter().map(|part| part.to_string_lossy().into_owned()).collect();
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
