//! How the shared library is linked: an FMU exports the functions of the standard, no others, and needs no libraries but
//! those of the C runtime.

use std::error::Error;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed=build.rs");
    let target = |key: &str| std::env::var(format!("CARGO_CFG_TARGET_{key}")).unwrap_or_default();
    if target("OS") == "linux" {
        println!("cargo::rustc-cdylib-link-arg=-Wl,--exclude-libs,ALL");
        if target("ENV") == "gnu" {
            // The unwinder behind the panic barrier from the static library: the standard library asks for `gcc_s`, and
            // the linker finds this script under that name first.
            let directory = std::env::var("OUT_DIR")?;
            std::fs::write(Path::new(&directory).join("libgcc_s.so"), "INPUT(-lgcc_eh -lgcc)\n")?;
            println!("cargo::rustc-cdylib-link-arg=-L{directory}");
        }
    }
    Ok(())
}
