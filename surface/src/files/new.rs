//! Files that are written: beside their place, and moved there when they are whole.

use std::fs::{self, File, Permissions};
use std::io::{self, BufWriter, Write};
use std::path::{self, Path, PathBuf};
use std::process;
use std::time::{Duration, SystemTime};

/// End of the name of a file under way.
const UNFINISHED: &str = ".unfinished";
/// Age from which a file under way is one that nobody finishes: a run writes its results longer than anything else.
const ABANDONED: Duration = Duration::from_secs(24 * 3600);
/// Links that are followed one after the other.
const LINKS: usize = 40;

/// A file under way. What was there before stays until [`NewFile::finish`]; one that is dropped before leaves nothing
/// behind. Errors name the file.
///
/// Where the path leads to no regular file, such as a pipe or a device, it is written at once.
pub struct NewFile {
    place: PathBuf,
    /// Where the content is, unless it is in its place.
    beside: Option<PathBuf>,
    content: BufWriter<File>,
}

impl NewFile {
    /// Begins a file in a folder that exists; one that is there and read-only is refused.
    pub fn create(path: &Path) -> io::Result<Self> {
        let place = place(path);
        Self::begin(place.clone()).map_err(|error| named(&place, &error))
    }

    fn begin(place: PathBuf) -> io::Result<Self> {
        let before = fs::metadata(&place).ok();
        if before.as_ref().is_some_and(|before| !before.is_file()) {
            let content = BufWriter::new(File::options().write(true).open(&place)?);
            return Ok(Self { place, beside: None, content });
        }
        let permissions = before.map(|before| before.permissions());
        if permissions.as_ref().is_some_and(Permissions::readonly) {
            return Err(io::Error::new(io::ErrorKind::PermissionDenied, "the file is read-only"));
        }
        let name = place.file_name().ok_or(io::ErrorKind::InvalidInput)?.to_string_lossy().into_owned();
        if let Some(folder) = place.parent() {
            clear(folder, ABANDONED, |other| other.ends_with(UNFINISHED) && other.starts_with(&format!("{name}.")));
        }
        // Two writers of a process, or of two, do not share a name.
        for count in 0_u32.. {
            let beside = place.with_file_name(format!("{name}.{}-{count}{UNFINISHED}", process::id()));
            match File::create_new(&beside) {
                Ok(file) => {
                    let new = Self { place, beside: Some(beside), content: BufWriter::new(file) };
                    if let Some(permissions) = permissions {
                        new.content.get_ref().set_permissions(permissions)?;
                    }
                    return Ok(new);
                }
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
                Err(error) => return Err(error),
            }
        }
        Err(io::ErrorKind::AlreadyExists.into())
    }

    /// The place that the file takes when it is finished: absolute, with links resolved.
    pub fn place(&self) -> &Path {
        &self.place
    }

    /// Moves the whole file to its place.
    pub fn finish(mut self) -> io::Result<()> {
        let Some(beside) = self.beside.clone() else { return self.flush() };
        let moved = self.content.flush().and_then(|()| self.content.get_ref().sync_all());
        moved.and_then(|()| fs::rename(&beside, &self.place)).map_err(|error| named(&self.place, &error))?;
        self.beside = None;
        Ok(())
    }
}

impl Write for NewFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.content.write(bytes).map_err(|error| named(&self.place, &error))
    }

    fn flush(&mut self) -> io::Result<()> {
        self.content.flush().map_err(|error| named(&self.place, &error))
    }
}

impl io::Seek for NewFile {
    fn seek(&mut self, to: io::SeekFrom) -> io::Result<u64> {
        self.content.seek(to).map_err(|error| named(&self.place, &error))
    }
}

impl Drop for NewFile {
    fn drop(&mut self) {
        if let Some(beside) = &self.beside {
            let _ = fs::remove_file(beside);
        }
    }
}

/// The error of a file, with its name.
fn named(place: &Path, error: &io::Error) -> io::Error {
    io::Error::new(error.kind(), format!("{} cannot be written: {error}", place.display()))
}

/// Absolute path of a file, there or not, with links resolved: two paths of one file have the same place.
pub fn place(path: &Path) -> PathBuf {
    let mut path = path::absolute(path).unwrap_or_else(|_| path.to_owned());
    for _ in 0..LINKS {
        if let Ok(real) = fs::canonicalize(&path) {
            return real;
        }
        let (Some(folder), Some(name)) = (path.parent(), path.file_name()) else { break };
        let folder = fs::canonicalize(folder).unwrap_or_else(|_| folder.to_owned());
        path = folder.join(name);
        // A link to a file that is not there yet.
        let Ok(target) = fs::read_link(&path) else { break };
        path = folder.join(target);
    }
    path
}

/// Removes files of a folder whose names are `ours` and which nobody has written to for so long. What cannot be removed
/// stays.
pub fn clear(folder: &Path, age: Duration, ours: impl Fn(&str) -> bool) {
    let now = SystemTime::now();
    let is_old = |about: fs::Metadata| {
        about.is_file() && about.modified().is_ok_and(|time| now.duration_since(time).is_ok_and(|past| past > age))
    };
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        if ours(&entry.file_name().to_string_lossy()) && entry.metadata().is_ok_and(is_old) {
            let _ = fs::remove_file(entry.path());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::env;

    fn workplace(name: &str) -> PathBuf {
        let folder = env::temp_dir().join(format!("wheelrail {name} {}", process::id()));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).unwrap();
        folder
    }

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<_> =
            fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn a_file_is_the_old_one_until_the_new_one_is_whole_and_a_dropped_one_leaves_nothing() {
        let folder = workplace("new file");
        let path = folder.join("a.csv");
        fs::write(&path, "old").unwrap();
        let mut dropped = NewFile::create(&path).unwrap();
        dropped.write_all(&[b'x'; 100_000]).unwrap();
        assert_eq!(names(&folder).len(), 2);
        drop(dropped);
        assert_eq!((names(&folder), fs::read_to_string(&path).unwrap()), (vec!["a.csv".to_owned()], "old".to_owned()));
        let (mut one, mut two) = (NewFile::create(&path).unwrap(), NewFile::create(&path).unwrap());
        one.write_all(b"one").unwrap();
        two.write_all(b"two").unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "old");
        two.finish().unwrap();
        one.finish().unwrap();
        assert_eq!((names(&folder), fs::read_to_string(&path).unwrap()), (vec!["a.csv".to_owned()], "one".to_owned()));
        fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn what_a_killed_writer_left_goes_when_it_is_old_and_the_files_of_others_stay() {
        let folder = workplace("leftovers");
        let old = ["a.csv.7-0.unfinished", "b.csv.7-0.unfinished", "a.csv", "a.csv.txt"];
        for name in old {
            let file = File::create(folder.join(name)).unwrap();
            file.set_modified(SystemTime::now() - 2 * ABANDONED).unwrap();
        }
        File::create(folder.join("a.csv.8-0.unfinished")).unwrap();
        NewFile::create(&folder.join("a.csv")).unwrap().finish().unwrap();
        let left = names(&folder);
        fs::remove_dir_all(&folder).unwrap();
        assert_eq!(left, ["a.csv", "a.csv.8-0.unfinished", "a.csv.txt", "b.csv.7-0.unfinished"]);
    }

    #[cfg(unix)]
    #[test]
    fn all_paths_of_a_file_have_one_place_whether_it_is_there_or_not() {
        use std::os::unix::fs::symlink;
        let folder = fs::canonicalize(workplace("places")).unwrap();
        fs::create_dir(folder.join("real")).unwrap();
        symlink("real", folder.join("linked")).unwrap();
        symlink("linked/new.csv", folder.join("to_new.csv")).unwrap();
        symlink("ring.csv", folder.join("ring.csv")).unwrap();
        let expected = folder.join("real/new.csv");
        let paths = ["real/new.csv", "linked/new.csv", "to_new.csv", "real/../linked/./new.csv"];
        for there in [false, true] {
            for path in paths {
                assert_eq!(place(&folder.join(path)), expected, "{path}, there: {there}");
            }
            fs::write(&expected, "").unwrap();
        }
        let ring = NewFile::create(&folder.join("ring.csv"));
        // A link to itself is written like a file of that name.
        assert!(ring.is_ok_and(|ring| ring.place() == folder.join("ring.csv")));
        fs::remove_dir_all(&folder).unwrap();
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_full_disk_is_told_with_the_name_of_the_file() {
        let mut file = NewFile::create(Path::new("/dev/full")).unwrap();
        file.write_all(b"1").unwrap();
        let error = file.finish().unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::StorageFull);
        assert!(error.to_string().starts_with("/dev/full cannot be written: "), "{error}");
    }
}
