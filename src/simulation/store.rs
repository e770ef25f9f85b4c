//! Where computed bases are kept: beside the presets in the FMU, in the cache of the user, or where a caller says.

use crate::config::Config;
use crate::files::{self, NewFile};
use crate::mechanics::{self, Basis, BasisError};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};
use std::{env, fs, io};

/// Names the directory that takes the place of the user's cache; empty: no cache.
pub const CACHE_VARIABLE: &str = "WHEELRAIL_CACHE";
/// Folder of the bases in every place.
const FOLDER: &str = "basis";
/// Number of bases kept in the cache of a user, about 1 MB each; the oldest give way.
const KEPT_BASES: usize = 200;
/// Age from which an unfinished basis is one that nobody finishes: to write one takes milliseconds.
const ABANDONED: Duration = Duration::from_secs(3600);

/// Places of stored bases. Those to be read only come first; one more may be written, too.
#[derive(Clone, Debug, Default)]
pub struct BasisStore {
    packed: Vec<PathBuf>,
    cache: Option<PathBuf>,
    /// Why there is no cache, unless nobody wants one.
    no_cache: Option<String>,
    /// Largest number of bases in the cache.
    capacity: Option<usize>,
    /// Directory of presets and profiles.
    resources: Option<PathBuf>,
    /// Bases in memory, with the names of their files.
    held: Vec<(String, Vec<u8>)>,
}

/// A stored basis that is not one, or a file that is none.
#[derive(Debug, thiserror::Error)]
#[error("stored basis {}: {problem}", path.display())]
pub struct StoreError {
    path: PathBuf,
    problem: String,
}

/// File name of the stored basis of a configuration.
pub fn basis_file_name(config: &Config) -> String {
    format!("{}.bin", mechanics::basis::key(&config.into()))
}

impl BasisStore {
    /// Knows no place: every basis is computed and none is kept.
    pub const fn none() -> Self {
        Self { packed: Vec::new(), cache: None, no_cache: None, capacity: None, resources: None, held: Vec::new() }
    }

    /// Holds a basis in memory, the content of a file of [`basis_file_name`], which it returns: for programs without
    /// files. Such a basis comes before all others.
    ///
    /// # Errors
    /// Bytes that are no basis.
    pub fn hold(&mut self, bytes: Vec<u8>) -> Result<String, BasisError> {
        let name = format!("{}.bin", Basis::from_bytes(&bytes)?.key);
        self.held.retain(|(other, _)| *other != name);
        self.held.push((name.clone(), bytes));
        Ok(name)
    }

    /// Reads and keeps bases in `<directory>/basis`.
    pub fn within(directory: &Path) -> Self {
        Self { cache: Some(directory.join(FOLDER)), ..Self::default() }
    }

    /// Keeps bases in the user's cache: `$WHEELRAIL_CACHE/basis`, else `wheelrail/basis` in `$XDG_CACHE_HOME` or
    /// `~/.cache` (Windows: `%LOCALAPPDATA%`). Directories that do not exist are made when a basis is kept. Nothing is
    /// kept where the variable is empty, which is a wish, and where the user has no home, which [`BasisStore::keep`]
    /// tells.
    pub fn of_user() -> Self {
        let variable = |name| env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
        if let Some(own) = env::var_os(CACHE_VARIABLE) {
            return if own.is_empty() { Self::none() } else { Self::within(Path::new(&own)) };
        }
        let home = || variable("HOME").filter(|home| home.is_dir()).map(|home| home.join(".cache"));
        let usual = if cfg!(windows) { variable("LOCALAPPDATA") } else { variable("XDG_CACHE_HOME").or_else(home) };
        match usual {
            Some(usual) => Self { capacity: Some(KEPT_BASES), ..Self::within(&usual.join("wheelrail")) },
            None => Self {
                no_cache: Some(format!("the user has no home directory; name one that keeps it in {CACHE_VARIABLE}")),
                ..Self::none()
            },
        }
    }

    /// Reads bases in `<directory>/basis`, too, and before all others; files of profiles are looked for in `directory`.
    pub fn with_packed(mut self, directory: Option<&Path>) -> Self {
        self.packed.extend(directory.map(|directory| directory.join(FOLDER)));
        self.resources = directory.map(Path::to_path_buf).or(self.resources);
        self
    }

    /// Directory in which files of profiles are looked for.
    pub fn resources(&self) -> Option<&Path> {
        self.resources.as_deref()
    }

    /// The stored basis of a configuration, with its file; a file of the cache that is damaged, or no regular
    /// file, counts as none.
    pub fn find(&self, config: &Config) -> Result<Option<(Basis, Vec<u8>)>, StoreError> {
        let name = basis_file_name(config);
        let fitting = |bytes: Vec<u8>, path: &Path| {
            let wrong = |error: BasisError| StoreError { path: path.to_owned(), problem: error.to_string() };
            let basis = Basis::from_bytes(&bytes).map_err(wrong)?;
            Ok(Some((basis, bytes)).filter(|(basis, _)| basis.fits(&config.into())))
        };
        let read = |directory: &PathBuf| -> Result<Option<(Basis, Vec<u8>)>, StoreError> {
            let path = directory.join(&name);
            match files::read(&path) {
                Ok(bytes) => fitting(bytes, &path),
                Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
                Err(error) => Err(StoreError { path, problem: error.to_string() }),
            }
        };
        let held = self.held.iter().find(|(held, _)| *held == name);
        if let Some(found) = held.map(|(name, bytes)| fitting(bytes.clone(), Path::new(name))).transpose()?.flatten() {
            return Ok(Some(found));
        }
        for directory in &self.packed {
            if let Some(found) = read(directory)? {
                return Ok(Some(found));
            }
        }
        Ok(self.cache.as_ref().and_then(|directory| read(directory).ok().flatten()))
    }

    /// Keeps the file of a basis in the cache, if there is one; others may be reading and writing there. An error means
    /// no more than that the basis must be computed again next time.
    pub fn keep(&self, config: &Config, bytes: &[u8]) -> Result<(), String> {
        let Some(directory) = &self.cache else {
            let told = |why: &String| Err(format!("the computed basis is not kept for the next start: {why}"));
            return self.no_cache.as_ref().map_or(Ok(()), told);
        };
        let write = || -> io::Result<()> {
            fs::create_dir_all(directory)?;
            files::clear(directory, ABANDONED, is_unfinished);
            let path = directory.join(basis_file_name(config));
            // A basis takes the place of a pipe or link; written to, a pipe would wait for a reader.
            if fs::symlink_metadata(&path).is_ok_and(|there| !there.is_file() && !there.is_dir()) {
                fs::remove_file(&path)?;
            }
            let mut file = NewFile::create(&path)?;
            file.write_all(bytes)?;
            file.finish()?;
            self.capacity.map_or(Ok(()), |capacity| shrink(directory, capacity))
        };
        write().map_err(|error| {
            let folder = directory.display();
            let remedy = format!("name another directory in {CACHE_VARIABLE}");
            format!("the computed basis cannot be kept in {folder} for the next start: {error}; {remedy}")
        })
    }
}

/// True for what a writer leaves that is killed in the write, of any version: the key of a basis without its ending.
fn is_unfinished(name: &str) -> bool {
    name.split_once('.').is_some_and(|(key, end)| uuid::Uuid::try_parse(key).is_ok() && end != "bin")
}

/// Removes the oldest files until `capacity` are left.
fn shrink(directory: &Path, capacity: usize) -> io::Result<()> {
    let entries = fs::read_dir(directory)?.filter_map(Result::ok).map(|entry| entry.path());
    let bases = entries.filter(|path| path.extension().is_some_and(|e| e == "bin"));
    let age = |path: &PathBuf| fs::metadata(path).and_then(|m| m.modified()).unwrap_or(SystemTime::UNIX_EPOCH);
    let mut files: Vec<_> = bases.map(|path| (age(&path), path)).collect();
    files.sort();
    let surplus = files.len().saturating_sub(capacity);
    files.iter().take(surplus).try_for_each(|(_, path)| fs::remove_file(path))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_full_cache_gives_up_its_oldest_bases() {
        let directory = env::temp_dir().join(format!("wheelrail cache {}", std::process::id()));
        fs::create_dir_all(&directory).unwrap();
        for (i, name) in ["a.bin", "b.bin", "other", "c.bin"].into_iter().enumerate() {
            fs::write(directory.join(name), "").unwrap();
            let time = SystemTime::UNIX_EPOCH + std::time::Duration::from_secs(i as u64);
            fs::File::options().write(true).open(directory.join(name)).unwrap().set_modified(time).unwrap();
        }
        shrink(&directory, 2).unwrap();
        let mut left: Vec<_> = fs::read_dir(&directory).unwrap().map(|e| e.unwrap().file_name()).collect();
        left.sort();
        fs::remove_dir_all(&directory).unwrap();
        assert_eq!(left, ["b.bin", "c.bin", "other"]);
    }
}
