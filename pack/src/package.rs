//! The FMU as a zip archive.

use super::documentation::index_html;
use super::error::PackageError;
use super::pages::{PICTURES, pages};
use super::platform::{Binary, read};
use super::references;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use wheelrail::files::NewFile;
use wheelrail::fmi::MODEL_IDENTIFIER;
use wheelrail::fmi::interface::Interface;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

/// File name and contents of a precomputed basis.
pub type StoredBasis = (String, Vec<u8>);

/// Contents of an FMU besides those that are made from the table of variables.
#[derive(Clone, Debug)]
pub struct Contents {
    /// Version of the standard, and extent of the model description.
    pub interface: Interface,
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
const FIXED: [(&str, &[u8]); 8] = [
    ("documentation/style.css", include_bytes!("../../docs/style.css")),
    ("terminalsAndIcons/terminalsAndIcons.xml", include_bytes!("../../docs/terminalsAndIcons.xml")),
    ("terminalsAndIcons/icon.png", include_bytes!("../../docs/icon.png")),
    ("terminalsAndIcons/terminal.png", include_bytes!("../../docs/terminal.png")),
    ("documentation/licenses/license.txt", include_bytes!("../../docs/license.txt")),
    ("documentation/licenses/LICENSE-APACHE", include_bytes!("../../LICENSE-APACHE")),
    ("documentation/licenses/LICENSE-MIT", include_bytes!("../../LICENSE-MIT")),
    ("documentation/licenses/LICENSE-THIRD-PARTY", include_bytes!("../../docs/LICENSE-THIRD-PARTY")),
];

/// Place of the picture of the model.
fn figure(interface: Interface) -> &'static str {
    match interface {
        Interface::Two(_) => "model.png",
        Interface::Three => "documentation/diagram.png",
    }
}

/// Files of a directory whose names satisfy the condition, sorted by name.
fn files(directory: &Path, wanted: impl Fn(&str) -> bool) -> Result<Vec<(String, PathBuf)>, PackageError> {
    let failed = |error: io::Error| PackageError::of_file(directory, error);
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
    let interface = contents.interface;
    let mut entries = vec![
        ("modelDescription.xml".to_owned(), interface.description()?.into_bytes()),
        ("documentation/index.html".to_owned(), index_html(interface).into_bytes()),
    ];
    for binary in &contents.binaries {
        let entry = binary.entry(interface)?;
        if entries.iter().any(|(other, _)| *other == entry) {
            return Err(PackageError::Refused(format!("two binaries are to become {entry}")));
        }
        entries.push((entry, binary.read()?));
    }
    entries.push((figure(interface).to_owned(), include_bytes!("../../docs/model.png").to_vec()));
    entries.extend(FIXED.map(|(name, bytes)| (name.to_owned(), bytes.to_vec())));
    entries.extend(pages().map(|page| (format!("documentation/{}", page.file()), page.html().into_bytes())));
    entries.extend(PICTURES.map(|(path, bytes)| (format!("documentation/{path}"), bytes.to_vec())));
    let resources = files(&contents.resources, |name| [".json", ".csv"].iter().any(|end| name.ends_with(end)))?;
    let presets: Vec<_> = resources.iter().filter_map(|(name, _)| name.strip_suffix(".json")).collect();
    entries.extend(references::entries(&presets)?);
    for (name, path) in &resources {
        entries.push((format!("resources/{name}"), read(path)?));
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
