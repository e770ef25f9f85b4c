//! Ingredients of a model: parameters and the files of profiles and rows that they name, read; why no model can be made.

use super::{BasisStore, StoreError, patch_file};
use crate::config::{Config, ConfigError};
use crate::mechanics::{BasisError, MechanicsError};
use crate::rolling::{ModelError, RollingModel};
use crate::surface::Surfaces;

/// Why a model could not be prepared.
#[derive(Debug, thiserror::Error)]
pub enum PrepareError {
    /// Parameters out of range or against each other.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// Meshes, matrices or modes.
    #[error("finite-element model: {0}")]
    Mechanics(#[from] MechanicsError),
    /// Contact or heat.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// A stored basis that cannot be read.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// A computed basis that cannot be written as bytes.
    #[error("computed basis: {0}")]
    Basis(#[from] BasisError),
}

/// Parameters and what the files hold that they name. Equal names are not enough to share a model: a file may change,
/// and a relative name leads elsewhere from another folder.
#[derive(Clone, PartialEq)]
pub struct Ingredients {
    /// Parameters, with the rows of a patch in the place of the name of their file.
    pub config: Config,
    /// The parameter `contact.rows` as it was given.
    pub rows: String,
    /// Surfaces with the profiles of wheel and rail.
    pub surfaces: Surfaces,
}

impl Ingredients {
    /// Validates the configuration and reads the files that it names.
    pub fn read(config: Config, store: &BasisStore) -> Result<Self, PrepareError> {
        config.validate()?;
        let (rows, config) = (config.contact.rows.clone(), patch_file::read(config, store.resources())?);
        config.validate()?;
        RollingModel::check_size(&config)?;
        let profiles = [&config.wheel.profile, &config.rail.profile].map(String::as_str);
        let surfaces = Surfaces::parse(config.wheel.radius, profiles, store.resources()).map_err(ModelError::from)?;
        Ok(Self { config, rows, surfaces })
    }
}
