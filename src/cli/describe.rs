//! `describe`: the model description of either version of FMI, and the reference of all variables.

use super::Failure;
use std::io::{self, Write};
use wheelrail::fmi::interface::Interface;
use wheelrail::fmi::reference;
use wheelrail::fmi::v2::description::Extent;

/// Print modelDescription.xml, or the reference of all variables.
#[derive(clap::Args)]
pub struct Describe {
    /// The reference of all variables as Markdown, docs/reference.md.
    #[arg(long)]
    markdown: bool,
    #[command(flatten)]
    interface: Described,
}

/// Version of FMI and extent of a model description.
#[derive(clap::Args)]
pub struct Described {
    /// Version of FMI: 2 or 3.
    #[arg(long, value_name = "VERSION", default_value_t = 2, value_parser = clap::value_parser!(u8).range(2..=3))]
    fmi: u8,
    /// Leave the points of profiles out of the model description of FMI 2.0; value references and library stay the same.
    /// In FMI 3.0 a profile is one variable.
    #[arg(long)]
    no_profiles: bool,
}

impl Described {
    /// The interface that is described.
    pub fn interface(&self) -> Interface {
        match (self.fmi, self.no_profiles) {
            (3, _) => Interface::Three,
            (_, false) => Interface::Two(Extent::Full),
            (_, true) => Interface::Two(Extent::WithoutProfiles),
        }
    }
}

impl Describe {
    /// Prints what is asked for.
    pub fn run(self) -> Result<(), Failure> {
        let text = if self.markdown { reference::markdown() } else { self.interface.interface().description()? };
        Ok(io::stdout().write_all(text.as_bytes())?)
    }
}
