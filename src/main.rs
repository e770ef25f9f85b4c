//! Command line around the library: packs the FMU and prints its description.

use clap::{Parser, Subcommand};
use indicatif::{ProgressBar, ProgressStyle};
use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use wheelrail::fmi::package::{self, Basis, Binary, Contents};
use wheelrail::fmi::{description, presets};
use wheelrail::simulation::Model;

/// Transient wheel-rail rolling contact as an FMI 2.0 co-simulation unit.
#[derive(Parser)]
#[command(version)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Compute what every preset needs and write the FMU.
    Pack {
        /// The FMU to write.
        #[arg(long, default_value = "target/wheelrail.fmu")]
        out: PathBuf,
        /// Compiled shared library.
        #[arg(long, default_value = "target/release/libwheelrail.so")]
        library: PathBuf,
        /// Library compiled for a further platform, e.g. win64=path/to/wheelrail.dll; may be repeated.
        #[arg(long = "binary", value_name = "PLATFORM=FILE")]
        binaries: Vec<Binary>,
        /// Directory with the presets.
        #[arg(long, default_value = "resources")]
        resources: PathBuf,
        /// Directory that keeps computed bases for the next time, in its subdirectory `basis`.
        #[arg(long, default_value = "target")]
        cache: PathBuf,
    },
    /// Print modelDescription.xml.
    Describe,
}

fn main() -> ExitCode {
    let result = match Arguments::parse().command {
        Command::Pack { out, library, binaries, resources, cache } => {
            let own = Binary::new(package::platform(), library);
            own.map_err(Into::into).and_then(|own| pack(&out, [vec![own], binaries].concat(), resources, &cache))
        }
        Command::Describe => {
            print!("{}", description::model_description());
            Ok(())
        }
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn pack(out: &Path, binaries: Vec<Binary>, resources: PathBuf, cache: &Path) -> Result<(), Box<dyn Error>> {
    let mut bases = Vec::new();
    for name in presets::available(Some(&resources)) {
        if let Some(basis) = basis(&name, &resources, cache)? {
            bases.push(basis);
        }
    }
    if let Some(parent) = out.parent() {
        fs::create_dir_all(parent)?;
    }
    package::write(out, &Contents { binaries, resources, bases, root: PathBuf::from(".") })?;
    println!("{} ({:.1} MB)", out.display(), fs::metadata(out)?.len() as f64 / 1e6);
    Ok(())
}

/// The basis that a preset needs, from the cache or computed under a progress bar and kept there.
fn basis(preset: &str, resources: &Path, cache: &Path) -> Result<Option<Basis>, Box<dyn Error>> {
    let bar = ProgressBar::new(100);
    bar.set_style(ProgressStyle::with_template("{prefix:>9} {bar:30} {percent:>3} % {msg}")?);
    bar.set_prefix(preset.to_owned());
    let config = presets::load(Some(resources), preset)?;
    let mut progress = |what: &str, share: f64| {
        bar.set_message(what.to_owned());
        bar.set_position((100.0 * share) as u64);
    };
    let model = Model::prepare(config, Some(cache), &mut progress)?;
    bar.set_message("ready");
    bar.set_position(100);
    bar.abandon();
    let file = model.basis_file();
    if let Some((name, bytes)) = &file {
        let directory = cache.join("basis");
        fs::create_dir_all(&directory)?;
        if !directory.join(name).exists() {
            fs::write(directory.join(name), bytes)?;
        }
    }
    Ok(file)
}
