//! Files that runs of this process write: each has one owner at a time, and it is known who wrote it last.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::SystemTime;

/// Files that are remembered after they have been written; the oldest are forgotten.
const REMEMBERED: usize = 100;

/// A file that somebody writes or has written.
struct Written {
    place: PathBuf,
    /// Name of the wheel that is going to write it.
    owner: Option<String>,
    /// Name of the wheel that wrote it last.
    writer: Option<String>,
}

static FILES: Mutex<Vec<Written>> = Mutex::new(Vec::new());

fn files() -> MutexGuard<'static, Vec<Written>> {
    FILES.lock().unwrap_or_else(PoisonError::into_inner)
}

/// True if two places are one file. Where letters of both cases name the same files they count as equal.
fn same(a: &Path, b: &Path) -> bool {
    let blind = cfg!(any(windows, target_os = "macos"));
    a == b || blind && a.to_string_lossy().to_lowercase() == b.to_string_lossy().to_lowercase()
}

/// The length and the time of the last change of a file, if it is there.
fn stamp(place: &Path) -> Option<(u64, Option<SystemTime>)> {
    fs::metadata(place).ok().map(|about| (about.len(), about.modified().ok()))
}

/// A file that is to be written by one wheel alone, until the claim is dropped.
pub(super) struct Claim {
    /// The path as it was given: where it is relative, the working directory may have changed since.
    pub name: String,
    place: PathBuf,
    owner: String,
    found: Option<(u64, Option<SystemTime>)>,
}

impl Claim {
    /// Takes the file at `place`, given as `name`, for `owner`, with the name of another wheel that wrote it last, if one
    /// did; the error is the name of the one that owns it now.
    pub fn take(name: &str, place: PathBuf, owner: &str) -> Result<(Self, Option<String>), String> {
        let mut files = files();
        let known = files.iter().position(|entry| same(&entry.place, &place));
        let index = known.unwrap_or_else(|| {
            files.push(Written { place: place.clone(), owner: None, writer: None });
            files.len() - 1
        });
        let entry = &mut files[index];
        if let Some(other) = &entry.owner {
            return Err(other.clone());
        }
        entry.owner = Some(owner.to_owned());
        let found = stamp(&place);
        let writer = entry.writer.clone().filter(|writer| writer != owner && found.is_some());
        Ok((Self { name: name.to_owned(), place, owner: owner.to_owned(), found }, writer))
    }

    /// The file.
    pub fn place(&self) -> &Path {
        &self.place
    }

    /// True if the claim is for this place.
    pub fn holds(&self, place: &Path) -> bool {
        same(&self.place, place)
    }

    /// True if somebody else has written the file since it was claimed.
    pub fn is_changed(&self) -> bool {
        let now = stamp(&self.place);
        now.is_some() && now != self.found
    }

    /// Notes that the owner has written the file.
    pub fn written(&mut self) {
        self.found = stamp(&self.place);
        let mut files = files();
        if let Some(entry) = files.iter_mut().find(|entry| same(&entry.place, &self.place)) {
            entry.writer = Some(self.owner.clone());
        }
    }
}

impl Drop for Claim {
    fn drop(&mut self) {
        let mut files = files();
        if let Some(entry) = files.iter_mut().find(|entry| same(&entry.place, &self.place)) {
            entry.owner = None;
        }
        let written = files.iter().filter(|entry| entry.owner.is_none() && entry.writer.is_some()).count();
        let mut surplus = written.saturating_sub(REMEMBERED);
        files.retain(|entry| {
            let forgotten = entry.owner.is_none() && (entry.writer.is_none() || surplus > 0);
            surplus -= usize::from(forgotten && entry.writer.is_some());
            !forgotten
        });
        files.shrink_to_fit();
    }
}
