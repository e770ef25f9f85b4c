//! Why an FMU is not packed.

use std::io;
use std::path::PathBuf;

/// An FMU that cannot be written as asked for.
#[derive(Debug, thiserror::Error)]
pub enum PackageError {
    /// A platform that the standard does not name.
    #[error("platform {name:?} is unknown: {known}")]
    Platform {
        /// Its name.
        name: String,
        /// Those that it names.
        known: String,
    },
    /// A machine for which the standard has no name.
    #[error(
        "FMI names no platform for {os} on {architecture}: say with --binary PLATFORM=FILE where your master looks"
    )]
    Unnamed {
        /// Operating system.
        os: &'static str,
        /// Architecture of the processor.
        architecture: &'static str,
    },
    /// A platform that FMI 3.0 alone names.
    #[error("FMI 2.0 has no name for {0}: pack the FMU with --fmi 3, which has one")]
    OnlyThree(&'static str),
    /// An argument without platform or file.
    #[error("{0:?} is not of the form PLATFORM=FILE")]
    Pair(String),
    /// A file that is no shared library of its platform.
    #[error("{} is no shared library for {platform}", path.display())]
    NoLibrary {
        /// The file.
        path: PathBuf,
        /// The platform.
        platform: &'static str,
    },
    /// Two libraries at one place.
    #[error("two binaries are to become {0}")]
    Twice(String),
    /// A file that cannot be read.
    #[error("{}: {source}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// The archive cannot be made.
    #[error(transparent)]
    Zip(#[from] zip::result::ZipError),
    /// The archive cannot be written.
    #[error(transparent)]
    Write(#[from] io::Error),
}
