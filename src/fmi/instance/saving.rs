//! The profile of the wheel that a run leaves behind.

use super::{Instance, Outcome};
use crate::fmi::log::{CallError, Status};
use std::path::{Path, PathBuf};

/// End of the name of a profile, by which `wheel.profile` knows a file.
const ENDING: &str = ".csv";

impl Instance {
    /// Where the profile of the wheel is to be written, if anywhere; refuses what could not be written or read again.
    pub(super) fn file_to_save(&self) -> Outcome<Option<PathBuf>> {
        let name = self.config.tuning.profile_save.trim();
        if name.is_empty() {
            return Ok(None);
        }
        let refused = |why: &str| CallError::error(format!("wheel.profile_save = \"{name}\" {why}"));
        let path = PathBuf::from(name);
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        if !name.to_lowercase().ends_with(ENDING) {
            return Err(refused("must end in .csv, by which wheel.profile knows a file"));
        }
        if !folder.is_dir() || path.is_dir() {
            return Err(refused("is no file in a folder that exists; make the folder or give another path"));
        }
        Ok(Some(path))
    }

    /// Writes it, if asked for.
    pub(super) fn save_profile(&self) -> Outcome {
        let (Some(path), Some(simulation)) = (self.file_to_save()?, &self.simulation) else { return Ok(()) };
        std::fs::write(&path, simulation.wheel_profile_file()).map_err(|error| {
            let name = path.display();
            CallError::error(format!("wheel.profile_save: {name} cannot be written ({error}); give another path"))
        })?;
        self.log.report(Status::Ok, &format!("profile of the wheel written to {}", path.display()));
        Ok(())
    }
}
