//! The profile of the wheel that a run leaves behind.

use crate::config::Config;
use crate::simulation::Simulation;
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use wheelrail_slave::{CallError, Log, Outcome, Status};

/// End of the name of a profile, by which `wheel.profile` knows a file.
const ENDING: &str = ".csv";

/// Path to which the profile of the wheel is to be written, if anywhere; refuses one that could not be written or read
/// again.
fn file_to_save(config: &Config) -> Outcome<Option<PathBuf>> {
    let name = config.files.profile_save.trim();
    if name.is_empty() {
        return Ok(None);
    }
    let refused = |why: &str| CallError::error(format!("wheel.profile_save = \"{name}\" {why}"));
    let path = PathBuf::from(name);
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if !name.to_lowercase().ends_with(ENDING) {
        return Err(refused("must end in .csv, by which wheel.profile knows a file"));
    }
    if !folder.is_dir() || path.exists() && !path.is_file() {
        return Err(refused("is no file in a folder that exists; make the folder or give another path"));
    }
    // What a link leads to is written, not the link.
    Ok(Some(fs::canonicalize(&path).unwrap_or(path)))
}

/// Writes beside the file and hands over the place there: at any time the file is the old one or the new one.
fn write_beside(path: &Path, content: Option<&str>) -> io::Result<()> {
    if fs::metadata(path).is_ok_and(|about| about.permissions().readonly()) {
        return Err(io::Error::new(io::ErrorKind::PermissionDenied, "the file is read-only"));
    }
    // A name that two wheels of this process, or of two, do not share: the address of a local value.
    let own = 0_u8;
    let beside = path.with_extension(format!("csv-{}-{:x}", std::process::id(), (&raw const own).addr()));
    let text = content.unwrap_or_default();
    let written = File::create_new(&beside).and_then(|mut file| io::Write::write_all(&mut file, text.as_bytes()));
    let moved = written.and_then(|()| if content.is_some() { fs::rename(&beside, path) } else { Ok(()) });
    if content.is_none() || moved.is_err() {
        // The trial is over, or has failed: nothing stays.
        let _ = fs::remove_file(&beside);
    }
    moved
}

fn cannot(path: &Path, error: &io::Error) -> CallError {
    let name = path.display();
    CallError::error(format!("wheel.profile_save = \"{name}\" cannot be written ({error}); give another path"))
}

/// Tries, without touching the file, if the profile of the wheel can be written where `config` asks for it.
pub(super) fn try_to_save(config: &Config) -> Outcome {
    let Some(path) = file_to_save(config)? else { return Ok(()) };
    write_beside(&path, None).map_err(|error| cannot(&path, &error))
}

/// Writes the profile of the wheel, if `config` asks for it.
pub(super) fn save_profile(config: &Config, simulation: Option<&Simulation>, log: &Log) -> Outcome {
    let (Some(path), Some(simulation)) = (file_to_save(config)?, simulation) else { return Ok(()) };
    write_beside(&path, Some(&simulation.wheel_profile_file())).map_err(|error| cannot(&path, &error))?;
    log.report(Status::Ok, &format!("profile of the wheel written to {}", path.display()));
    Ok(())
}
