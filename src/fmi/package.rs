//! The FMU as a zip archive.

use super::MODEL_IDENTIFIER;
use super::description::model_description;
use super::documentation::index_html;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

/// File name and contents of a precomputed basis.
pub type Basis = (String, Vec<u8>);

/// What goes into an FMU besides what is made from the table of variables.
#[derive(Clone, Debug)]
pub struct Contents {
    /// The shared library, for [`platform`].
    pub library: PathBuf,
    /// Directory with the presets (`*.json`).
    pub resources: PathBuf,
    /// Precomputed bases, for `resources/basis/`.
    pub bases: Vec<Basis>,
    /// Directory with licence texts (`LICENSE*`) and the picture `model.png`; what is missing is left out.
    pub root: PathBuf,
}

/// A file that cannot be read or written.
#[derive(Debug, thiserror::Error)]
pub enum PackageError {
    #[error("{}: {source}", path.display())]
    File { path: PathBuf, source: io::Error },
    #[error(transparent)]
    Zip(#[from] zip::result::ZipError),
    #[error(transparent)]
    Write(#[from] io::Error),
}

/// Directory of the binary inside the FMU for the machine this was compiled for.
pub fn platform() -> &'static str {
    match (cfg!(target_os = "windows"), cfg!(target_os = "macos")) {
        (true, _) => "win64",
        (_, true) => "darwin64",
        _ => "linux64",
    }
}

fn read(path: &Path) -> Result<Vec<u8>, PackageError> {
    fs::read(path).map_err(|source| PackageError::File { path: path.to_owned(), source })
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
    let extension = std::env::consts::DLL_EXTENSION;
    let mut entries = vec![
        ("modelDescription.xml".to_owned(), model_description().into_bytes()),
        (format!("binaries/{}/{MODEL_IDENTIFIER}.{extension}", platform()), read(&contents.library)?),
        ("documentation/index.html".to_owned(), index_html().into_bytes()),
    ];
    for (name, path) in files(&contents.root, |name| name.starts_with("LICENSE"))? {
        entries.push((format!("documentation/licenses/{name}"), read(&path)?));
    }
    for (name, path) in files(&contents.root, |name| name == "model.png")? {
        entries.push((name, read(&path)?));
    }
    for (name, path) in files(&contents.resources, |name| name.ends_with(".json"))? {
        entries.push((format!("resources/{name}"), read(&path)?));
    }
    let mut bases = contents.bases.clone();
    bases.sort();
    bases.dedup();
    entries.extend(bases.into_iter().map(|(name, bytes)| (format!("resources/basis/{name}"), bytes)));

    let file = File::create(out).map_err(|source| PackageError::File { path: out.to_owned(), source })?;
    let mut archive = ZipWriter::new(io::BufWriter::new(file));
    let plain = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Deflated)
        .last_modified_time(DateTime::default())
        .unix_permissions(0o644);
    for (name, bytes) in entries {
        let executable = name.starts_with("binaries/");
        archive.start_file(name, if executable { plain.unix_permissions(0o755) } else { plain })?;
        archive.write_all(&bytes)?;
    }
    archive.finish()?.flush()?;
    Ok(())
}
