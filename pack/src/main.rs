//! `wheelrail-pack`: makes the FMU, and prints its description.

use clap::{Args, Parser, Subcommand};
use std::error::Error;
use std::fs;
use std::io::{self, Write};
use std::path::PathBuf;
use std::process::ExitCode;
use wheelrail::fmi::interface::Interface;
use wheelrail::fmi::v2::description::Extent;
use wheelrail::fmi::{presets, reference};
use wheelrail::simulation::{BasisStore, Model, advice};
use wheelrail_pack::package::{self, Contents, StoredBasis};
use wheelrail_pack::platform::{self, Binary};

/// Commands of the earlier program `wheelrail`, and what does now what they did.
const MOVED: [(&str, &str); 3] = [
    ("simulate", "wheelrail simulate, a command of the Python package"),
    ("steady", "wheelrail steady, a command of the Python package"),
    ("export", "cargo run --release --example fields"),
];

/// Packs the FMU of a wheel on a rail, and describes it. Runs are computed by the command `wheelrail` of the Python package.
#[derive(Parser)]
#[command(version)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Pack(Pack),
    Describe(Describe),
}

/// Compute what every preset needs and write the FMU.
#[derive(Args)]
struct Pack {
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

/// Print modelDescription.xml, or the reference of all variables.
#[derive(Args)]
struct Describe {
    /// The reference of all variables as Markdown, docs/reference.md.
    #[arg(long)]
    markdown: bool,
    #[command(flatten)]
    interface: Described,
}

/// Version of FMI and extent of a model description.
#[derive(Args)]
struct Described {
    /// Version of FMI: 2 or 3.
    #[arg(long, value_name = "VERSION", default_value_t = 2, value_parser = clap::value_parser!(u8).range(2..=3))]
    fmi: u8,
    /// Leave the points of profiles out of the model description of FMI 2.0; value references and library stay the same.
    /// In FMI 3.0 a profile is one variable.
    #[arg(long)]
    no_profiles: bool,
}

impl Described {
    fn interface(&self) -> Interface {
        match (self.fmi, self.no_profiles) {
            (3, _) => Interface::Three,
            (_, false) => Interface::Two(Extent::Full),
            (_, true) => Interface::Two(Extent::WithoutProfiles),
        }
    }
}

impl Describe {
    fn run(&self) -> Result<(), Box<dyn Error>> {
        let text = if self.markdown { reference::markdown() } else { self.interface.interface().description()? };
        Ok(io::stdout().write_all(text.as_bytes())?)
    }
}

impl Pack {
    /// Computes or finds the basis of every preset and writes the FMU.
    fn run(self) -> Result<(), Box<dyn Error>> {
        fs::create_dir_all(&self.cache)?;
        let mut bases = Vec::new();
        for name in presets::available(Some(&self.resources)) {
            bases.extend(self.basis(&name)?);
        }
        if let Some(parent) = self.out.parent() {
            fs::create_dir_all(parent)?;
        }
        let interface = self.interface.interface();
        let Pack { out, library, mut binaries, resources, reference, sbom, .. } = self;
        match platform::own_platform() {
            Ok(own) if binaries.iter().any(|binary| binary.platform() == own) => {}
            Ok(own) if binaries.is_empty() || own.name(interface).is_ok() => {
                binaries.insert(0, Binary::new(own.three, library)?);
            }
            Err(unnamed) if binaries.is_empty() => return Err(unnamed.into()),
            _ => {}
        }
        package::write(&out, &Contents { interface, binaries, resources, reference, sbom, bases })?;
        println!("{} ({:.1} MB)", out.display(), fs::metadata(&out)?.len() as f64 / 1e6);
        Ok(())
    }

    /// The basis that a preset needs, which is kept in the cache.
    fn basis(&self, preset: &str) -> Result<Option<StoredBasis>, Box<dyn Error>> {
        let config = presets::load(Some(&self.resources), preset)?;
        let store = BasisStore::within(&self.cache).with_packed(Some(&self.resources));
        let model = Model::shared(config.clone(), &store, &mut |_, _| {});
        let model = model.map_err(|error| advice::failed_preparation(&error, &config))?;
        if let Some(why) = model.not_kept() {
            eprintln!("warning: {why}");
        }
        Ok(model.basis_file())
    }
}

fn main() -> ExitCode {
    let word = std::env::args().nth(1).unwrap_or_default();
    if let Some((command, instead)) = MOVED.iter().find(|(command, _)| *command == word) {
        eprintln!("error: {command} is no command of this program: use {instead}");
        return ExitCode::from(2);
    }
    let done = match Arguments::parse().command {
        Command::Pack(pack) => pack.run(),
        Command::Describe(describe) => describe.run(),
    };
    done.map_or_else(
        |problem| {
            eprintln!("error: {problem}");
            ExitCode::FAILURE
        },
        |()| ExitCode::SUCCESS,
    )
}
