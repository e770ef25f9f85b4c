//! Models shared by all simulations of a process: the one global of the crate outside of the C interface.
//!
//! A model is prepared by the first who asks for it; others who ask meanwhile wait for it. Nobody keeps a model but its
//! users: with the last of them it is gone.

use super::ingredients::Ingredients;
use super::lock::lock;
use super::{BasisStore, Model, PrepareError};
use crate::config::Config;
use std::sync::{Arc, Mutex, Weak};

/// A model that exists, existed or is being prepared.
struct Entry {
    ingredients: Ingredients,
    model: Mutex<Weak<Model>>,
}

static ENTRIES: Mutex<Vec<Arc<Entry>>> = Mutex::new(Vec::new());

impl Entry {
    fn model(
        &self,
        ingredients: Ingredients,
        store: &BasisStore,
        progress: &mut dyn FnMut(&str, f64),
    ) -> Result<Arc<Model>, PrepareError> {
        let mut place = lock(&self.model);
        if let Some(model) = place.upgrade() {
            return Ok(model);
        }
        let model = Model::with_ingredients(ingredients, store, progress)?;
        *place = Arc::downgrade(&model);
        Ok(model)
    }
}

/// The entry of parameters and files, a new one if there is none.
fn entry(ingredients: &Ingredients) -> Arc<Entry> {
    let mut entries = lock(&ENTRIES);
    if let Some(known) = entries.iter().find(|entry| entry.ingredients == *ingredients) {
        return known.clone();
    }
    let entry = Arc::new(Entry { ingredients: ingredients.clone(), model: Mutex::default() });
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
    /// The model that others of this process use for an equal configuration and equal contents of its files, or one
    /// prepared now (see [`Model::prepare`]).
    pub fn shared(
        config: Config,
        store: &BasisStore,
        progress: &mut dyn FnMut(&str, f64),
    ) -> Result<Arc<Self>, PrepareError> {
        let ingredients = Ingredients::read(config, store)?;
        let entry = entry(&ingredients);
        let model = entry.model(ingredients, store, progress);
        if model.is_err() {
            drop(entry);
            forget_unused();
        }
        model
    }
}
