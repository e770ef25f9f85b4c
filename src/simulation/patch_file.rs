//! Rows of a patch in a file.

use crate::config::{Config, ConfigError, RowsError, patch_rows};
use crate::files;
use std::path::Path;

/// The configuration with the content of the file in the place of its name, where `contact.rows` names one and counts;
/// relative paths begin in the working directory or else in `folder`.
pub fn read(mut config: Config, folder: Option<&Path>) -> Result<Config, ConfigError> {
    let Err(RowsError::Unread(name)) = config.patch_rows() else { return Ok(config) };
    (_, config.contact.rows) = files::read_named(name.trim(), folder).map_err(RowsError::from)?;
    // A text that ends like a name would be taken for one for ever.
    match patch_rows::is_file(&config.contact.rows) {
        true => Err(RowsError::Count(0).into()),
        false => Ok(config),
    }
}
