//! The FMU as a zip archive.

use super::MODEL_IDENTIFIER;
use super::documentation::index_html;
use super::pages::{PICTURES, pages};
use super::v2::description::{Extent, model_description};
use crate::files::{self, NewFile};
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::str::FromStr;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

/// File name and contents of a precomputed basis.
pub type StoredBasis = (String, Vec<u8>);

/// Contents of an FMU besides those that are made from the table of variables.
#[derive(Clone, Debug)]
pub struct Contents {
    /// Extent of the model description.
    pub extent: Extent,
    /// Shared libraries, one for each platform.
    pub binaries: Vec<Binary>,
    /// Directory with the presets (`*.json`) and their patches (`*.csv`).
    pub resources: PathBuf,
    /// Directory with a run to compare with: inputs, results and their settings (`wheelrail_in.csv`, `_ref.csv`,
    /// `_ref.opt`).
    pub reference: PathBuf,
    /// Bill of materials of the libraries, for `documentation/licenses/`.
    pub sbom: Option<PathBuf>,
    /// Precomputed bases, for `resources/basis/`.
    pub bases: Vec<StoredBasis>,
}

/// Files that do not differ between FMUs: pictures, licence texts, style of the pages.
const FIXED: [(&str, &[u8]); 9] = [
    ("documentation/style.css", include_bytes!("../../docs/style.css")),
    ("model.png", include_bytes!("../../docs/model.png")),
    ("terminalsAndIcons/terminalsAndIcons.xml", include_bytes!("../../docs/terminalsAndIcons.xml")),
    ("terminalsAndIcons/icon.png", include_bytes!("../../docs/icon.png")),
    ("terminalsAndIcons/terminal.png", include_bytes!("../../docs/terminal.png")),
    ("documentation/licenses/license.txt", include_bytes!("../../docs/license.txt")),
    ("documentation/licenses/LICENSE-APACHE", include_bytes!("../../LICENSE-APACHE")),
    ("documentation/licenses/LICENSE-MIT", include_bytes!("../../LICENSE-MIT")),
    ("documentation/licenses/LICENSE-THIRD-PARTY", include_bytes!("../../docs/LICENSE-THIRD-PARTY")),
];

/// Platforms of FMI 2.0 and the extension of their shared libraries.
pub const PLATFORMS: [(&str, &str); 6] = [
    ("win32", "dll"),
    ("win64", "dll"),
    ("linux32", "so"),
    ("linux64", "so"),
    ("darwin32", "dylib"),
    ("darwin64", "dylib"),
];

/// A shared library and the platform it was compiled for; as text `PLATFORM=FILE`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Binary {
    platform: &'static str,
    extension: &'static str,
    file: PathBuf,
}

impl Binary {
    /// A library for one of [`PLATFORMS`].
    pub fn new(platform: &str, file: impl Into<PathBuf>) -> Result<Self, PackageError> {
        let known = PLATFORMS.into_iter().find(|(name, _)| *name == platform);
        let (platform, extension) = known.ok_or_else(|| PackageError::Platform(platform.to_owned()))?;
        Ok(Self { platform, extension, file: file.into() })
    }

    /// The platform.
    pub fn platform(&self) -> &'static str {
        self.platform
    }

    /// The library; refuses files that are none.
    fn read(&self) -> Result<Vec<u8>, PackageError> {
        let bytes = read(&self.file)?;
        let heads: &[&[u8]] = match self.extension {
            "dll" => &[b"MZ"],
            "so" => &[b"\x7fELF"],
            _ => &[b"\xcf\xfa\xed\xfe", b"\xce\xfa\xed\xfe", b"\xca\xfe\xba\xbe"],
        };
        let is_library = heads.iter().any(|head| bytes.starts_with(head));
        is_library
            .then_some(bytes)
            .ok_or_else(|| PackageError::NoLibrary { path: self.file.clone(), platform: self.platform })
    }

    /// Path inside the FMU.
    fn entry(&self) -> String {
        format!("binaries/{}/{MODEL_IDENTIFIER}.{}", self.platform, self.extension)
    }
}

impl FromStr for Binary {
    type Err = PackageError;

    fn from_str(text: &str) -> Result<Self, PackageError> {
        match text.split_once('=') {
            Some((platform, file)) if !file.is_empty() => Self::new(platform, file),
            _ => Err(PackageError::Pair(text.to_owned())),
        }
    }
}

fn platform_names() -> String {
    PLATFORMS.map(|(name, _)| name).join(", ")
}

/// An FMU that cannot be written as asked for.
#[derive(Debug, thiserror::Error)]
pub enum PackageError {
    /// A platform that the standard does not name.
    #[error("platform {0:?} is unknown: {list}", list = platform_names())]
    Platform(String),
    /// A machine for which the standard has no name.
    #[error(
        "FMI 2.0 names no platform for {os} on {architecture}: say with --binary PLATFORM=FILE where your master looks"
    )]
    Unnamed {
        /// Operating system.
        os: &'static str,
        /// Architecture of the processor.
        architecture: &'static str,
    },
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
    /// Two libraries for one platform.
    #[error("two binaries for {0}")]
    Twice(&'static str),
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

/// Directory of the binary inside the FMU for the machine this was compiled for.
pub fn platform() -> Result<&'static str, PackageError> {
    platform_of(std::env::consts::OS, std::env::consts::ARCH)
}

/// Directory of the binary for an operating system and an architecture, both as Rust calls them. The names of FMI 2.0
/// stand for x86 processors, on macOS for those of Apple as well; a master on another machine finds no binary under
/// them.
fn platform_of(os: &'static str, architecture: &'static str) -> Result<&'static str, PackageError> {
    match (os, architecture) {
        ("windows", "x86_64") => Ok("win64"),
        ("windows", "x86") => Ok("win32"),
        ("linux", "x86_64") => Ok("linux64"),
        ("linux", "x86") => Ok("linux32"),
        ("macos", "x86_64" | "aarch64") => Ok("darwin64"),
        _ => Err(PackageError::Unnamed { os, architecture }),
    }
}

fn read(path: &Path) -> Result<Vec<u8>, PackageError> {
    files::read(path).map_err(|source| PackageError::File { path: path.to_owned(), source })
}

/// Files of a directory whose names satisfy the condition, sorted by name.
fn files(directory: &Path, wanted: impl Fn(&str) -> bool) -> Result<Vec<(String, PathBuf)>, PackageError> {
    let failed = |source| PackageError::File { path: directory.to_owned(), source };
    let mut found = Vec::new();
    for entry in fs::read_dir(directory).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default().to_owned();
        if path.is_file() && wanted(&name) {
            found.push((name, path));
        }
    }
    found.sort();
    Ok(found)
}

/// Writes the FMU to `out`. Equal contents give equal bytes: entries are in a fixed order and carry a fixed date.
pub fn write(out: &Path, contents: &Contents) -> Result<(), PackageError> {
    let mut entries = vec![
        ("modelDescription.xml".to_owned(), model_description(contents.extent)?.into_bytes()),
        ("documentation/index.html".to_owned(), index_html().into_bytes()),
    ];
    for (i, binary) in contents.binaries.iter().enumerate() {
        if contents.binaries[..i].iter().any(|other| other.platform == binary.platform) {
            return Err(PackageError::Twice(binary.platform));
        }
        entries.push((binary.entry(), binary.read()?));
    }
    entries.extend(FIXED.map(|(name, bytes)| (name.to_owned(), bytes.to_vec())));
    entries.extend(pages().map(|page| (format!("documentation/{}", page.file()), page.html().into_bytes())));
    entries.extend(PICTURES.map(|(path, bytes)| (format!("documentation/{path}"), bytes.to_vec())));
    for (name, path) in files(&contents.resources, |name| [".json", ".csv"].iter().any(|end| name.ends_with(end)))? {
        entries.push((format!("resources/{name}"), read(&path)?));
    }
    for (name, path) in files(&contents.reference, |name| name.starts_with(MODEL_IDENTIFIER))? {
        entries.push((format!("documentation/reference/{name}"), read(&path)?));
    }
    if let Some(path) = &contents.sbom {
        entries.push((format!("documentation/licenses/{MODEL_IDENTIFIER}.cdx.json"), read(path)?));
    }
    let mut bases = contents.bases.clone();
    bases.sort();
    bases.dedup();
    entries.extend(bases.into_iter().map(|(name, bytes)| (format!("resources/basis/{name}"), bytes)));

    let mut archive = ZipWriter::new(NewFile::create(out)?);
    let plain = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Deflated)
        .last_modified_time(DateTime::default())
        .unix_permissions(0o644);
    for (name, bytes) in entries {
        let executable = name.starts_with("binaries/");
        archive.start_file(name, if executable { plain.unix_permissions(0o755) } else { plain })?;
        archive.write_all(&bytes)?;
    }
    Ok(archive.finish()?.finish()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn binaries_go_to_the_directory_and_name_of_their_platform() {
        let entry = |text: &str| text.parse::<Binary>().unwrap().entry();
        assert_eq!(entry("win64=a/wheelrail.dll"), "binaries/win64/wheelrail.dll");
        assert_eq!(entry("darwin64=b=c"), "binaries/darwin64/wheelrail.dylib");
    }

    #[test]
    fn machines_that_the_standard_does_not_name_are_refused() {
        for (os, architecture, expected) in [
            ("linux", "x86_64", "linux64"),
            ("windows", "x86_64", "win64"),
            ("macos", "x86_64", "darwin64"),
            ("macos", "aarch64", "darwin64"),
        ] {
            let platform = platform_of(os, architecture).unwrap();
            assert_eq!(platform, expected);
            assert!(PLATFORMS.iter().any(|(name, _)| *name == platform));
        }
        for (os, architecture) in
            [("linux", "aarch64"), ("linux", "riscv64"), ("windows", "aarch64"), ("freebsd", "x86_64")]
        {
            let refusal = platform_of(os, architecture).unwrap_err().to_string();
            assert!(refusal.contains(&format!("{os} on {architecture}")), "{refusal}");
        }
    }

    #[test]
    fn unknown_platforms_are_refused_with_the_list_of_known_ones() {
        let refusal = |text: &str| text.parse::<Binary>().unwrap_err().to_string();
        let expected = "platform \"amiga\" is unknown: win32, win64, linux32, linux64, darwin32, darwin64";
        assert_eq!(refusal("amiga=wheelrail.so"), expected);
        for text in ["win64", "win64=", "wheelrail.dll"] {
            assert!(refusal(text).contains("PLATFORM=FILE"), "{text}");
        }
    }
}
