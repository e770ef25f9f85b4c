//! Rows of a patch in a file.

use crate::config::{Config, ConfigError, RowsError, patch_rows};
use crate::files;
use std::path::{Path, PathBuf};

/// The configuration with the content of the file in the place of its name, where `contact.rows` names one and counts;
/// relative paths begin in `folder`.
pub fn read(mut config: Config, folder: Option<&Path>) -> Result<Config, ConfigError> {
    let Err(RowsError::Unread(name)) = config.patch_rows() else { return Ok(config) };
    let path = folder.map_or_else(|| PathBuf::from(name.trim()), |folder| folder.join(name.trim()));
    config.contact.rows = files::read_text(&path).map_err(|error| RowsError::Unreadable {
        path: path.display().to_string(),
        reason: error.to_string(),
        folder: folder.map_or_else(|| "the working directory".to_owned(), |folder| folder.display().to_string()),
    })?;
    // A text that ends like a name would be taken for one for ever.
    match patch_rows::is_file(&config.contact.rows) {
        true => Err(RowsError::Count(0).into()),
        false => Ok(config),
    }
}
