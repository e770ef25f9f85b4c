//! Commands of the binary: packing and describing the FMU, and a master of its own around the slave inside it.
//!
//! `setting` (variables by name, values as text) → `setup` (preset and settings → slave) → `run` (scenario, steps; `clock`: times) →
//! `simulate`, `steady`, `export`; `model` prepares models under a progress bar, `vtu` writes files for ParaView.

mod clock;
mod describe;
mod export;
mod failure;
mod interrupt;
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

pub use failure::{Failure, told};

use clap::{Parser, Subcommand};
use interrupt::Interrupt;

/// Transient wheel-rail rolling contact as a co-simulation unit of FMI 2.0 and 3.0.
///
/// Values are in SI units. Exit codes: 0 done, 1 run failed, 2 wrong arguments, 130 stopped by Ctrl-C (128 and the number of the
/// signal). What was computed until then is written.
#[derive(Parser)]
#[command(version)]
pub struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Pack(pack::Pack),
    Describe(describe::Describe),
    Simulate(simulate::Simulate),
    Steady(steady::Steady),
    Export(export::Export),
}

impl Arguments {
    /// Carries the command out.
    pub fn run(self) -> Result<(), Failure> {
        let interrupt = Interrupt::listen()?;
        match self.command {
            Command::Pack(pack) => pack.run(&interrupt),
            Command::Describe(describe) => describe.run(),
            Command::Simulate(simulate) => simulate.run(&interrupt),
            Command::Steady(steady) => steady.run(&interrupt),
            Command::Export(export) => export.run(&interrupt),
        }
    }
}
