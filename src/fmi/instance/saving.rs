//! The profile of the wheel that a run leaves behind.

use super::owners::Claim;
use crate::config::Config;
use crate::files::{self, NewFile};
use crate::simulation::Simulation;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use wheelrail_slave::{CallError, Life, Outcome, Status};

/// End of the name of a profile, by which `wheel.profile` knows a file.
const ENDING: &str = ".csv";

fn refused(config: &Config, why: &str) -> CallError {
    CallError::error(format!("wheel.profile_save = \"{}\" {why}", config.files.profile_save.trim()))
}

/// Place to which the profile of the wheel is to be written, if anywhere; refuses one that could not be written or read
/// again. A relative path begins in the present working directory; what a link leads to is written, not the link.
fn file_to_save(config: &Config) -> Outcome<Option<PathBuf>> {
    let name = config.files.profile_save.trim();
    if name.is_empty() {
        return Ok(None);
    }
    if !name.to_lowercase().ends_with(ENDING) {
        return Err(refused(config, "must end in .csv, by which wheel.profile knows a file"));
    }
    let place = files::place(Path::new(name));
    if !place.parent().is_some_and(Path::is_dir) || place.exists() && !place.is_file() {
        let why =
            format!("is no file in a folder that exists ({}); make the folder or give another path", place.display());
        return Err(refused(config, &why));
    }
    Ok(Some(place))
}

/// Takes the file to which `config` wants the profile of the wheel written for this wheel alone, after a trial that
/// does not touch it; a file that it has stays its own wherever the process goes meanwhile. Two wheels of a process do not write the same file, and who is going to replace what another
/// one has written hears of it.
pub(super) fn claim_file(held: &mut Option<Claim>, config: &Config, life: &Life) -> Outcome {
    let name = &config.files.profile_save;
    if held.as_ref().is_some_and(|claim| claim.name == *name) {
        return Ok(());
    }
    let Some(place) = file_to_save(config)? else {
        *held = None;
        return Ok(());
    };
    if let Some(claim) = held.as_mut().filter(|claim| claim.holds(&place)) {
        claim.name.clone_from(name);
        return Ok(());
    }
    drop(NewFile::create(&place).map_err(|error| cannot(config, &error))?);
    let file = place.display().to_string();
    let (claim, writer) = Claim::take(name, place, life.name()).map_err(|other| {
        let why = format!(
            "is {file}, to which wheel \"{other}\" of this process saves its profile; give each wheel a path of its \
             own, or free that one before this one is initialized"
        );
        refused(config, &why)
    })?;
    if let Some(writer) = writer {
        let message = format!(
            "wheel.profile_save: at its end this run replaces {file}, to which wheel \"{writer}\" of this process \
             has saved its profile; give another path to keep both"
        );
        life.log().report(Status::Warning, &message);
    }
    *held = Some(claim);
    Ok(())
}

/// Writes the profile of the wheel, if it is wanted, and gives the file back.
pub(super) fn save_profile(
    held: &mut Option<Claim>,
    config: &Config,
    simulation: Option<&Simulation>,
    life: &Life,
) -> Outcome {
    claim_file(held, config, life)?;
    let (Some(claim), Some(simulation)) = (&mut *held, simulation) else { return Ok(()) };
    let file = claim.place().display().to_string();
    if claim.is_changed() {
        let why = format!(
            "has been written by somebody else since this run began ({file}), who would lose it; set another path and \
             terminate again"
        );
        return Err(refused(config, &why));
    }
    write(claim.place(), &simulation.wheel_profile_file()).map_err(|error| cannot(config, &error))?;
    claim.written();
    life.log().report(Status::Ok, &format!("profile of the wheel written to {file}"));
    *held = None;
    Ok(())
}

fn write(place: &Path, text: &str) -> io::Result<()> {
    let mut file = NewFile::create(place)?;
    file.write_all(text.as_bytes())?;
    file.finish()
}

fn cannot(config: &Config, error: &io::Error) -> CallError {
    refused(config, &format!("does not do: {error}; give another path"))
}
