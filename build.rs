//! The library of an FMU exports the functions of the standard and no others, and needs no libraries but those of the C
//! runtime: options for the linker, which the compiler does not take alone.

use std::error::Error;
use std::fs;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed=build.rs");
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
