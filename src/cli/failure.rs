//! Why a command stopped.

use std::io::{self, Write};

/// Why a command stopped.
#[derive(Debug, thiserror::Error)]
pub enum Failure {
    /// Something the user can say differently.
    #[error("{0}")]
    Usage(String),
    /// The model or the machine did not do it.
    #[error("{0}")]
    Run(String),
    /// A signal asked for the end.
    #[error("stopped by {name}")]
    Interrupted {
        /// Its number.
        signal: i32,
        /// Its name.
        name: &'static str,
    },
    #[error("output: {0}")]
    Output(#[from] io::Error),
    #[error("output: {0}")]
    Csv(#[from] csv::Error),
}

impl Failure {
    /// Exit code of the process; of a signal that of shells, 128 more than its number.
    pub fn exit_code(&self) -> u8 {
        match self {
            Failure::Usage(_) => 2,
            Failure::Interrupted { signal, .. } => u8::try_from(128 + signal).unwrap_or(1),
            Failure::Run(_) | Failure::Output(_) | Failure::Csv(_) => 1,
        }
    }

    /// True if nobody reads the output any more.
    pub fn is_closed_pipe(&self) -> bool {
        let kind = match self {
            Failure::Output(error) => Some(error.kind()),
            Failure::Csv(error) => match error.kind() {
                csv::ErrorKind::Io(error) => Some(error.kind()),
                _ => None,
            },
            _ => None,
        };
        kind == Some(io::ErrorKind::BrokenPipe)
    }
}

/// Tells a line on standard error, which may be gone.
pub fn told(line: &str) {
    let _ = writeln!(io::stderr(), "{line}");
}
