//! Command line.

use crate::cases::{self, Case};
use std::path::PathBuf;

/// Cost of a step in ordinary driving, of the present library beside an older one.
#[derive(clap::Parser)]
pub struct Options {
    /// The older FMU; without it the present library runs alone.
    #[arg(long, value_name = "FILE")]
    pub before: Option<PathBuf>,
    /// The present FMU; by default the library built with this program.
    #[arg(long, value_name = "FILE")]
    pub after: Option<PathBuf>,
    /// Variable of the present library only; may be repeated. What a case itself sets has precedence.
    #[arg(long, value_name = "NAME=VALUE", value_parser = pair)]
    pub set: Vec<(String, String)>,
    /// Variable of the older library only.
    #[arg(long, value_name = "NAME=VALUE", value_parser = pair)]
    pub set_before: Vec<(String, String)>,
    /// Cases to run, separated by commas; all without it.
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub cases: Vec<String>,
    /// Name the cases and end.
    #[arg(long)]
    pub list: bool,
    /// Runs of every case at least, of which each step counts with its smallest time.
    #[arg(long, default_value_t = 3, value_parser = clap::value_parser!(u32).range(1..))]
    pub repeats: u32,
    /// Wall time in which a case is run again and again; short ones need many runs to meet a quiet machine \[s].
    #[arg(long, default_value_t = 6.0, value_name = "TIME", value_parser = duration)]
    pub seconds: f64,
    /// Steps that a library takes until it is the turn of the other.
    #[arg(long, default_value_t = 20, value_parser = clap::value_parser!(u32).range(1..))]
    pub batch: u32,
    /// File that receives all numbers as JSON.
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// Task of a process that this program starts.
    #[arg(long, hide = true)]
    pub worker: Option<String>,
    /// Passed by `cargo bench`.
    #[arg(long, hide = true)]
    bench: bool,
}

impl Options {
    /// The cases that are asked for, in the order of the table.
    pub fn cases(&self) -> Result<Vec<Case>, String> {
        let all = cases::all();
        if let Some(unknown) = self.cases.iter().find(|name| all.iter().all(|case| case.name() != name.as_str())) {
            let names: Vec<_> = all.iter().map(Case::name).collect();
            return Err(format!("--cases: \"{unknown}\" is no case; there are {}", names.join(", ")));
        }
        let wanted = |case: &Case| self.cases.is_empty() || self.cases.iter().any(|name| name == case.name());
        Ok(all.into_iter().filter(wanted).collect())
    }
}

fn pair(text: &str) -> Result<(String, String), String> {
    let (name, value) = text.split_once('=').ok_or("expected NAME=VALUE, such as contact.lines=5")?;
    Ok((name.trim().to_owned(), value.trim().to_owned()))
}

fn duration(text: &str) -> Result<f64, String> {
    let time = text.parse().ok().filter(|time: &f64| time.is_finite() && *time >= 0.0);
    time.ok_or_else(|| "expected a time in seconds, such as 6".to_owned())
}
