//! Commands of the binary: packing and describing the FMU, and a master of its own around the slave inside it.
//!
//! `setting` (variables by name, values as text) → `setup` (preset and settings → slave) → `run` (scenario, steps) →
//! `simulate`, `steady`, `export`; `model` prepares models under a progress bar, `vtu` writes files for ParaView.

mod export;
mod failure;
mod model;
mod pack;
mod run;
mod scenario;
mod setting;
mod setup;
mod simulate;
mod steady;
mod table;
mod track;
mod vtu;

pub use failure::Failure;

use clap::{Parser, Subcommand};
use std::io::{self, Write};
use wheelrail::fmi::reference;
use wheelrail::fmi::v2::description::{Extent, model_description};

/// Transient wheel-rail rolling contact as an FMI 2.0 co-simulation unit.
///
/// Values are in SI units. Exit codes: 0 done, 1 run failed, 2 wrong arguments.
#[derive(Parser)]
#[command(version)]
pub struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Pack(pack::Pack),
    /// Print modelDescription.xml, or the reference of all variables.
    Describe {
        /// The reference of all variables as Markdown, docs/reference.md.
        #[arg(long)]
        markdown: bool,
    },
    Simulate(simulate::Simulate),
    Steady(steady::Steady),
    Export(export::Export),
}

impl Arguments {
    /// Carries the command out.
    pub fn run(self) -> Result<(), Failure> {
        match self.command {
            Command::Pack(pack) => pack.run(),
            Command::Describe { markdown } => {
                let text = if markdown { reference::markdown() } else { model_description(Extent::Full)? };
                Ok(io::stdout().write_all(text.as_bytes())?)
            }
            Command::Simulate(simulate) => simulate.run(),
            Command::Steady(steady) => steady.run(),
            Command::Export(export) => export.run(),
        }
    }
}
