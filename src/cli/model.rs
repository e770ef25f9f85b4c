//! Models under a progress bar, with computed bases kept for the next time.

use super::Failure;
use indicatif::{ProgressBar, ProgressStyle};
use std::fs;
use std::path::Path;
use std::process;
use std::sync::Arc;
use wheelrail::config::Config;
use wheelrail::simulation::{Model, PrepareError, basis_file_name};

/// A progress bar on standard error with a title; invisible where that is no terminal.
pub fn bar(title: &str, length: u64) -> ProgressBar {
    let bar = ProgressBar::new(length);
    if let Ok(style) = ProgressStyle::with_template("{prefix:>9} {bar:30} {percent:>3} % {msg}") {
        bar.set_style(style);
    }
    bar.set_prefix(title.to_owned());
    bar
}

/// The model of a configuration; its basis comes from `<resources>/basis` or `<cache>/basis`, or is computed and kept in
/// the latter if that directory exists.
pub fn prepare(config: Config, resources: &Path, cache: &Path, bar: &ProgressBar) -> Result<Arc<Model>, Failure> {
    let name = basis_file_name(&config);
    let stored = resources.join("basis").join(&name).exists();
    let mut progress = |what: &str, share: f64| {
        bar.set_message(what.to_owned());
        bar.set_position((share * bar.length().unwrap_or(0) as f64) as u64);
    };
    let directory = if stored { resources } else { cache };
    let model = Model::prepare(config, Some(directory), &mut progress).map_err(|error| match error {
        PrepareError::Config(error) => Failure::Usage(error.to_string()),
        error => Failure::Run(error.to_string()),
    })?;
    if let Some((name, bytes)) = model.basis_file().filter(|_| !stored && cache.is_dir()) {
        keep(&cache.join("basis"), &name, &bytes)
            .map_err(|error| Failure::Run(format!("basis cannot be kept in {}: {error}", cache.display())))?;
    }
    Ok(model)
}

/// Writes a file that others may be reading or writing at the same time.
fn keep(directory: &Path, name: &str, bytes: &[u8]) -> std::io::Result<()> {
    let path = directory.join(name);
    if path.exists() {
        return Ok(());
    }
    fs::create_dir_all(directory)?;
    let unfinished = directory.join(format!("{name}.{}", process::id()));
    fs::write(&unfinished, bytes)?;
    fs::rename(unfinished, path)
}
