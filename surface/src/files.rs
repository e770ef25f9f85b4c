//! Files that others name. Only regular ones of bounded size are read, so that no pipe, device or forgotten terabyte
//! holds up who reads it. Files are written beside their place and moved there when they are whole, so that a full disk
//! or an end half-way costs the new file only.

mod new;

pub use new::{NewFile, clear, place};

pub mod table;

use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{self, Path, PathBuf};

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

/// Content of such a file as text in UTF-8. What another encoding seems to be, and how to save it otherwise, is said.
pub fn read_text(path: &Path) -> io::Result<String> {
    let content = read(path)?;
    let refused = |why: String| io::Error::new(io::ErrorKind::InvalidData, why);
    match String::from_utf8(content) {
        Ok(text) if !text.contains('\0') => Ok(text),
        Ok(text) => Err(refused(encoding_of(text.as_bytes(), 0))),
        Err(error) => Err(refused(encoding_of(error.as_bytes(), error.utf8_error().valid_up_to()))),
    }
}

/// Guess at what a content is that is no text in UTF-8 from a byte on, and what to do.
fn encoding_of(content: &[u8], valid: usize) -> String {
    const SAVE: &str =
        "save it as UTF-8 (\"CSV UTF-8\" in Excel, Out-File -Encoding utf8 in PowerShell, \"encoding\" in editors)";
    match content {
        [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => {
            format!("it is text in UTF-16, as > in Windows PowerShell and \"Unicode Text\" in Excel write it; {SAVE}")
        }
        [b'P', b'K', 3, 4, ..] => format!("it is an archive, such as a workbook of Excel, and no text; {SAVE}"),
        _ if content.contains(&0) => {
            format!("it has zero bytes, as text in UTF-16 does that Windows programs write, or it is no text; {SAVE}")
        }
        _ => {
            let line = 1 + content[..valid].iter().filter(|byte| **byte == b'\n').count();
            format!(
                "line {line} is not in UTF-8 (byte {:#04x}), perhaps in Latin-1 or Windows-1252; {SAVE}",
                content[valid]
            )
        }
    }
}

/// A file that a user has named and that cannot be read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "file {path} cannot be read ({reason}); looked for {tried}; give a path that is absolute or relative to the working \
     directory"
)]
pub struct Unread {
    /// File that is there, or the name of one that is not.
    pub path: String,
    /// Reason.
    pub reason: String,
    /// Places where it was looked for, as absolute paths.
    pub tried: String,
}

/// Place and text of a file that a user names. A relative path begins in the working directory, where the user is; what
/// is not there is looked for in `folder`, which holds files that were delivered.
pub fn read_named(name: &str, folder: Option<&Path>) -> Result<(PathBuf, String), Unread> {
    let absolute = |path: &Path| path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let mut places = vec![absolute(Path::new(name))];
    places.extend(folder.map(|folder| absolute(&folder.join(name))));
    places.dedup();
    let tried = places.iter().map(|place| place.display().to_string()).collect::<Vec<_>>().join(" and ");
    let missing = io::Error::from(io::ErrorKind::NotFound).to_string();
    let Some(found) = places.into_iter().find(|place| fs::symlink_metadata(place).is_ok()) else {
        return Err(Unread { path: name.to_owned(), reason: missing, tried });
    };
    match read_text(&found) {
        Ok(text) => Ok((found, text)),
        Err(error) => Err(Unread { path: found.display().to_string(), reason: error.to_string(), tried }),
    }
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
        fs::remove_file(&path).unwrap();
        assert!(refusal.contains("more than the 256 MiB"), "{refusal}");
        assert_eq!(text.unwrap(), "position");
    }

    #[test]
    fn text_in_another_encoding_is_refused_with_what_wrote_it_and_how_to_save_it() {
        let path = std::env::temp_dir().join(format!("wheelrail encoding {}", std::process::id()));
        let utf16 = |mark: &[u8], bytes: fn(u16) -> [u8; 2]| {
            [mark.to_vec(), "time,load\n0,1\n".encode_utf16().flat_map(bytes).collect()].concat()
        };
        let cases: [(Vec<u8>, &[&str]); 7] = [
            (utf16(&[0xff, 0xfe], u16::to_le_bytes), &["UTF-16", "PowerShell", "Excel", "save it as UTF-8"]),
            (utf16(&[0xfe, 0xff], u16::to_be_bytes), &["UTF-16", "PowerShell", "Excel", "save it as UTF-8"]),
            (utf16(&[], u16::to_le_bytes), &["zero bytes", "UTF-16", "save it as UTF-8"]),
            (utf16(&[], u16::to_be_bytes), &["zero bytes", "UTF-16", "save it as UTF-8"]),
            (b"PK\x03\x04\x14\0\xff".to_vec(), &["archive", "workbook of Excel"]),
            (b"time,load\n# M\xfcller\n".to_vec(), &["line 2", "0xfc", "Latin-1", "save it as UTF-8"]),
            (vec![0xff], &["line 1", "0xff"]),
        ];
        for (content, words) in cases {
            fs::write(&path, &content).unwrap();
            let said = read_text(&path).unwrap_err().to_string();
            assert!(words.iter().all(|word| said.contains(word)), "{said}");
        }
        fs::remove_file(&path).unwrap();
    }

    #[test]
    fn directories_are_refused_by_name_and_missing_files_as_such() {
        assert!(read(&std::env::temp_dir()).unwrap_err().to_string().contains("a directory"));
        assert_eq!(read(Path::new("nowhere/at all")).unwrap_err().kind(), io::ErrorKind::NotFound);
    }
}
