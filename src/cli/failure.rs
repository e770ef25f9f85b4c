//! Why a command stopped.

use std::io;

/// Why a command stopped.
#[derive(Debug, thiserror::Error)]
pub enum Failure {
    /// Something the user can say differently.
    #[error("{0}")]
    Usage(String),
    /// The model or the machine did not do it.
    #[error("{0}")]
    Run(String),
    #[error("output: {0}")]
    Output(#[from] io::Error),
    #[error("output: {0}")]
    Csv(#[from] csv::Error),
}

impl Failure {
    /// Exit code of the process.
    pub fn exit_code(&self) -> u8 {
        if matches!(self, Failure::Usage(_)) { 2 } else { 1 }
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
