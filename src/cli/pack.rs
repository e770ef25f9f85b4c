//! `pack`: the FMU with everything its presets need.

use super::describe::Described;
use super::interrupt::Interrupt;
use super::{Failure, model};
use std::fs;
use std::path::PathBuf;
use wheelrail::fmi::package::{self, Contents, StoredBasis};
use wheelrail::fmi::package_error::PackageError;
use wheelrail::fmi::platform::{self, Binary};
use wheelrail::fmi::presets;

/// Compute what every preset needs and write the FMU.
#[derive(clap::Args)]
pub struct Pack {
    /// The FMU to write.
    #[arg(long, default_value = "target/wheelrail.fmu")]
    out: PathBuf,
    /// Shared library compiled for this machine.
    #[arg(long, default_value = "target/release/libwheelrail.so")]
    library: PathBuf,
    /// Library compiled for a further platform, e.g. win64=path/to/wheelrail.dll; may be repeated. One for the platform
    /// of this machine takes the place of --library.
    #[arg(long = "binary", value_name = "PLATFORM=FILE")]
    binaries: Vec<Binary>,
    #[command(flatten)]
    interface: Described,
    /// Directory with the presets.
    #[arg(long, default_value = "resources")]
    resources: PathBuf,
    /// Directory with the run that users can compare theirs with.
    #[arg(long, default_value = "examples/reference")]
    reference: PathBuf,
    /// Bill of materials of the libraries (CycloneDX, packaging/sbom.py), to be packed beside the licences.
    #[arg(long, value_name = "FILE")]
    sbom: Option<PathBuf>,
    /// Directory that keeps computed bases for the next time, in its subdirectory `basis`.
    #[arg(long, default_value = "target")]
    cache: PathBuf,
}

impl Pack {
    /// Computes or finds the basis of every preset and writes the FMU.
    pub fn run(self, interrupt: &Interrupt) -> Result<(), Failure> {
        fs::create_dir_all(&self.cache)?;
        let mut bases = Vec::new();
        for name in presets::available(Some(&self.resources)) {
            bases.extend(self.basis(&name)?);
            interrupt.check()?;
        }
        if let Some(parent) = self.out.parent() {
            fs::create_dir_all(parent)?;
        }
        let failed = |error: PackageError| Failure::Run(error.to_string());
        let interface = self.interface.interface();
        let Pack { out, library, mut binaries, resources, reference, sbom, .. } = self;
        match platform::own_platform() {
            Ok(own) if binaries.iter().any(|binary| binary.platform() == own) => {}
            Ok(own) if binaries.is_empty() || own.name(interface).is_ok() => {
                binaries.insert(0, Binary::new(own.three, library).map_err(failed)?);
            }
            Err(unnamed) if binaries.is_empty() => return Err(failed(unnamed)),
            _ => {}
        }
        package::write(&out, &Contents { interface, binaries, resources, reference, sbom, bases }).map_err(failed)?;
        println!("{} ({:.1} MB)", out.display(), fs::metadata(&out)?.len() as f64 / 1e6);
        Ok(())
    }

    /// The basis that a preset needs.
    fn basis(&self, preset: &str) -> Result<Option<StoredBasis>, Failure> {
        let bar = model::bar(preset, 100);
        let config = presets::load(Some(&self.resources), preset).map_err(Failure::Run)?;
        let model = model::prepare(config, &self.resources, &self.cache, &bar)?;
        bar.set_message("ready");
        bar.set_position(100);
        bar.abandon();
        Ok(model.basis_file())
    }
}
