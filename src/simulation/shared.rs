//! Models shared by all simulations of a process: the one global of the crate outside of the C interface.
//!
//! A model is prepared by the first who asks for it; others who ask meanwhile wait for it. Nobody keeps a model but its
//! users: with the last of them it is gone.

use super::lock::lock;
use super::{BasisStore, Model, PrepareError};
use crate::config::Config;
use std::sync::{Arc, Mutex, Weak};

/// A model that exists, existed or is being prepared.
struct Entry {
    config: Config,
    model: Mutex<Weak<Model>>,
}

static ENTRIES: Mutex<Vec<Arc<Entry>>> = Mutex::new(Vec::new());

impl Entry {
    fn model(
        &self,
        config: Config,
        store: &BasisStore,
        progress: &mut dyn FnMut(&str, f64),
    ) -> Result<Arc<Model>, PrepareError> {
        let mut place = lock(&self.model);
        if let Some(model) = place.upgrade() {
            return Ok(model);
        }
        let model = Model::prepare(config, store, progress)?;
        *place = Arc::downgrade(&model);
        Ok(model)
    }
}

/// The entry of a configuration, a new one if there is none.
fn entry(config: &Config) -> Arc<Entry> {
    let mut entries = lock(&ENTRIES);
    if let Some(known) = entries.iter().find(|entry| entry.config == *config) {
        return known.clone();
    }
    let entry = Arc::new(Entry { config: config.clone(), model: Mutex::default() });
    entries.push(entry.clone());
    entry
}

/// Forgets models that nobody uses or prepares, and gives their memory back: nothing is left when a library is
/// unloaded.
fn forget_unused() {
    let mut entries = lock(&ENTRIES);
    entries.retain(|entry| Arc::strong_count(entry) > 1 || lock(&entry.model).strong_count() > 0);
    entries.shrink_to_fit();
}

impl Drop for Model {
    fn drop(&mut self) {
        forget_unused();
    }
}

impl Model {
    /// The model that others of this process use for an equal configuration, or one prepared now
    /// (see [`Model::prepare`]).
    pub fn shared(
        config: Config,
        store: &BasisStore,
        progress: &mut dyn FnMut(&str, f64),
    ) -> Result<Arc<Self>, PrepareError> {
        let entry = entry(&config);
        let model = entry.model(config, store, progress);
        if model.is_err() {
            drop(entry);
            forget_unused();
        }
        model
    }
}
