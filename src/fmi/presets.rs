//! Presets: parameter sets by name.

use crate::config::Config;
use crate::files;
use std::path::Path;
use std::{fs, io};

/// Name of the preset that holds until another is chosen.
pub const DEFAULT: &str = "railway";

/// Similarity of two names from which one may be a slip of the other \[1].
const SIMILAR: f64 = 0.8;

/// Reads `<resources>/<name>.json`. Without resources only the default is known, which is `Config::default()`. The
/// error text lists the presets that exist.
pub fn load(resources: Option<&Path>, name: &str) -> Result<Config, String> {
    let unknown = |why: &str| {
        let names = available(resources).join(", ");
        Err(format!("preset = \"{name}\" {why}; available presets: {names}"))
    };
    let plain = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    if name.is_empty() || !name.chars().all(plain) {
        return unknown("is not a preset name (letters, digits, _ and -)");
    }
    let text = match resources.map(|directory| files::read_text(&directory.join(format!("{name}.json")))) {
        Some(Ok(text)) => text,
        Some(Err(error)) if name == DEFAULT && error.kind() == io::ErrorKind::NotFound => return Ok(Config::default()),
        None if name == DEFAULT => return Ok(Config::default()),
        Some(Err(error)) if error.kind() == io::ErrorKind::NotFound => {
            let names = available(resources);
            let near = names.iter().map(|known| (strsim::jaro_winkler(known, name), known));
            let near = near.max_by(|a, b| a.0.total_cmp(&b.0)).filter(|(similar, _)| *similar > SIMILAR);
            let hint = near.map_or_else(String::new, |(_, known)| format!("; did you mean \"{known}\"?"));
            return unknown(&format!("is unknown{hint}"));
        }
        Some(Err(error)) => return unknown(&format!("cannot be read ({error})")),
        None => return unknown("is unknown because the resources of the FMU cannot be read"),
    };
    crate::config::presets::parse(&text).or_else(|why| unknown(&why))
}

/// Names of the presets in the directory, sorted; the default is always among them.
pub fn available(resources: Option<&Path>) -> Vec<String> {
    let files = resources.and_then(|directory| fs::read_dir(directory).ok()).into_iter().flatten();
    let json = |path: &Path| path.extension().is_some_and(|e| e == "json");
    let mut names: Vec<String> = files
        .filter_map(|entry| Some(entry.ok()?.path()).filter(|path| json(path)))
        .filter_map(|path| Some(path.file_stem()?.to_str()?.to_owned()))
        .chain([DEFAULT.to_owned()])
        .collect();
    names.sort();
    names.dedup();
    names
}
