//! Files that others name: only regular ones of bounded size are read, so that no pipe, device or forgotten terabyte
//! holds up who reads it.

pub mod table;

use std::fs::{self, File};
use std::io::{self, Read};
use std::path::Path;

/// Largest file that is read \[bytes]: 256 MiB, some eight million samples of a profile.
pub const LARGEST: u64 = 256 << 20;

/// Content of a regular file of at most [`LARGEST`] bytes; links are followed.
pub fn read(path: &Path) -> io::Result<Vec<u8>> {
    // Before it is opened: to open a pipe waits for a writer.
    regular(&fs::metadata(path)?)?;
    let file = File::open(path)?;
    regular(&file.metadata()?)?;
    let mut content = Vec::new();
    file.take(LARGEST + 1).read_to_end(&mut content)?;
    bounded(content.len() as u64)?;
    Ok(content)
}

/// Content of such a file as text.
pub fn read_text(path: &Path) -> io::Result<String> {
    String::from_utf8(read(path)?).map_err(|error| io::Error::new(io::ErrorKind::InvalidData, error.utf8_error()))
}

/// Refuses anything that is no file of bounded length.
fn regular(about: &fs::Metadata) -> io::Result<()> {
    if !about.is_file() {
        let what = if about.is_dir() { "a directory" } else { "a pipe, device or the like" };
        let why = format!("it is {what}, only regular files are read; write the content to a file");
        return Err(io::Error::new(io::ErrorKind::InvalidInput, why));
    }
    bounded(about.len())
}

fn bounded(length: u64) -> io::Result<()> {
    if length <= LARGEST {
        return Ok(());
    }
    let why = format!("it has more than the {} MiB that are read; give a shorter file", LARGEST >> 20);
    Err(io::Error::new(io::ErrorKind::InvalidInput, why))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_of_the_largest_size_is_read_and_one_byte_more_is_refused_unread() {
        assert!(bounded(LARGEST).is_ok());
        let path = std::env::temp_dir().join(format!("wheelrail size {}", std::process::id()));
        // Without content on the disk: only its length is large.
        File::create(&path).unwrap().set_len(LARGEST + 1).unwrap();
        let refusal = read(&path).unwrap_err().to_string();
        fs::write(&path, "position").unwrap();
        let text = read_text(&path);
        fs::write(&path, [0xff]).unwrap();
        let no_text = read_text(&path);
        fs::remove_file(&path).unwrap();
        assert!(refusal.contains("more than the 256 MiB"), "{refusal}");
        assert_eq!(text.unwrap(), "position");
        assert!(no_text.unwrap_err().to_string().contains("utf-8"));
    }

    #[test]
    fn directories_are_refused_by_name_and_missing_files_as_such() {
        assert!(read(&std::env::temp_dir()).unwrap_err().to_string().contains("a directory"));
        assert_eq!(read(Path::new("nowhere/at all")).unwrap_err().kind(), io::ErrorKind::NotFound);
    }
}
