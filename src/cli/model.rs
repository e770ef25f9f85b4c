//! Models under a progress bar, with computed bases kept for the next time.

use super::{Failure, told};
use indicatif::{ProgressBar, ProgressStyle};
use std::path::Path;
use std::sync::Arc;
use wheelrail::config::Config;
use wheelrail::simulation::{BasisStore, Model, PrepareError, advice};

/// A progress bar on standard error with a title; invisible where that is no terminal.
pub fn bar(title: &str, length: u64) -> ProgressBar {
    let bar = ProgressBar::new(length);
    if let Ok(style) = ProgressStyle::with_template("{prefix:>9} {bar:30} {percent:>3} % {msg}") {
        bar.set_style(style);
    }
    bar.set_prefix(title.to_owned());
    bar
}

/// The model of a configuration; its basis comes from `<resources>/basis` or `<cache>/basis`, or from the cache of the
/// user if `cache` is no directory. If it must be computed, it is kept in the cache.
pub fn prepare(config: Config, resources: &Path, cache: &Path, bar: &ProgressBar) -> Result<Arc<Model>, Failure> {
    let store = if cache.is_dir() { BasisStore::within(cache) } else { BasisStore::of_user() };
    let mut progress = |what: &str, share: f64| {
        bar.set_message(what.to_owned());
        bar.set_position((share * bar.length().unwrap_or(0) as f64) as u64);
    };
    let model = Model::shared(config.clone(), &store.with_packed(Some(resources)), &mut progress);
    let model = model.map_err(|error| match error {
        PrepareError::Config(error) => Failure::Usage(error.to_string()),
        error => Failure::Run(advice::failed_preparation(&error, &config)),
    })?;
    if let Some(why) = model.not_kept() {
        bar.suspend(|| told(&format!("warning: {why}")));
    }
    Ok(model)
}
