//! Why an FMU is not packed.

use std::fmt::Display;
use std::io;
use std::path::Path;

/// An FMU that cannot be written as asked for.
#[derive(Debug, thiserror::Error)]
pub enum PackageError {
    /// Something that is asked for and cannot be, in words.
    #[error("{0}")]
    Refused(String),
    /// The archive cannot be made.
    #[error(transparent)]
    Zip(#[from] zip::result::ZipError),
    /// The archive cannot be written.
    #[error(transparent)]
    Write(#[from] io::Error),
}

impl PackageError {
    /// Problem with a file, by its name.
    pub fn of_file(path: &Path, problem: impl Display) -> Self {
        Self::Refused(format!("{}: {problem}", path.display()))
    }
}
