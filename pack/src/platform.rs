//! Platforms with their names in both versions of FMI, and shared libraries compiled for them.

use super::error::PackageError;
use std::path::{Path, PathBuf};
use std::str::FromStr;
use wheelrail::files;
use wheelrail::fmi::MODEL_IDENTIFIER;
use wheelrail::fmi::interface::Interface;

/// A platform for which the standard has a name.
#[derive(Debug, PartialEq, Eq)]
pub struct Platform {
    /// Name in FMI 2.0, if it has one.
    pub two: Option<&'static str>,
    /// Name in FMI 3.0.
    pub three: &'static str,
    /// Extension of shared libraries.
    extension: &'static str,
}

impl Platform {
    /// Name in an interface; refuses a platform that has none there.
    pub fn name(&self, interface: Interface) -> Result<&'static str, PackageError> {
        match interface {
            Interface::Two(_) => self.two.ok_or_else(|| {
                let remedy = "pack the FMU with --fmi 3, which has one";
                PackageError::Refused(format!("FMI 2.0 has no name for {}: {remedy}", self.three))
            }),
            Interface::Three => Ok(self.three),
        }
    }
}

const fn platform(two: Option<&'static str>, three: &'static str, extension: &'static str) -> Platform {
    Platform { two, three, extension }
}

/// Platforms of FMI. The names of FMI 2.0 stand for x86 processors, on macOS for those of Apple as well.
pub const PLATFORMS: [Platform; 9] = [
    platform(Some("win32"), "x86-windows", "dll"),
    platform(Some("win64"), "x86_64-windows", "dll"),
    platform(None, "aarch64-windows", "dll"),
    platform(Some("linux32"), "x86-linux", "so"),
    platform(Some("linux64"), "x86_64-linux", "so"),
    platform(None, "aarch64-linux", "so"),
    platform(Some("darwin32"), "x86-darwin", "dylib"),
    platform(Some("darwin64"), "x86_64-darwin", "dylib"),
    platform(Some("darwin64"), "aarch64-darwin", "dylib"),
];

/// Names of all platforms in both versions, for messages.
fn platform_names() -> String {
    let mut names: Vec<_> = PLATFORMS.iter().filter_map(|platform| platform.two).collect();
    names.dedup();
    names.extend(PLATFORMS.iter().map(|platform| platform.three));
    names.join(", ")
}

/// The platform of the machine this was compiled for.
pub fn own_platform() -> Result<&'static Platform, PackageError> {
    platform_of(std::env::consts::OS, std::env::consts::ARCH)
}

/// The platform of an operating system and an architecture, both as Rust calls them.
fn platform_of(os: &'static str, architecture: &'static str) -> Result<&'static Platform, PackageError> {
    let system = if os == "macos" { "darwin" } else { os };
    let name = format!("{architecture}-{system}");
    PLATFORMS.iter().find(|known| known.three == name).ok_or_else(|| {
        PackageError::Refused(format!(
            "FMI names no platform for {os} on {architecture}: say with --binary PLATFORM=FILE where your master looks"
        ))
    })
}

/// The content of a file.
pub(super) fn read(path: &Path) -> Result<Vec<u8>, PackageError> {
    files::read(path).map_err(|error| PackageError::of_file(path, error))
}

/// A shared library and the platform it was compiled for; as text `PLATFORM=FILE`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Binary {
    platform: &'static Platform,
    file: PathBuf,
}

impl Binary {
    /// A library for a platform, by its name in either version.
    pub fn new(platform: &str, file: impl Into<PathBuf>) -> Result<Self, PackageError> {
        let known = PLATFORMS.iter().find(|known| known.three == platform || known.two == Some(platform));
        let unknown = || PackageError::Refused(format!("platform {platform:?} is unknown: {}", platform_names()));
        Ok(Self { platform: known.ok_or_else(unknown)?, file: file.into() })
    }

    /// The platform.
    pub fn platform(&self) -> &'static Platform {
        self.platform
    }

    /// The library; refuses files that are none.
    pub fn read(&self) -> Result<Vec<u8>, PackageError> {
        let bytes = read(&self.file)?;
        let heads: &[&[u8]] = match self.platform.extension {
            "dll" => &[b"MZ"],
            "so" => &[b"\x7fELF"],
            _ => &[b"\xcf\xfa\xed\xfe", b"\xce\xfa\xed\xfe", b"\xca\xfe\xba\xbe"],
        };
        if heads.iter().any(|head| bytes.starts_with(head)) {
            return Ok(bytes);
        }
        Err(PackageError::Refused(format!("{} is no shared library for {}", self.file.display(), self.platform.three)))
    }

    /// Path inside the FMU.
    pub fn entry(&self, interface: Interface) -> Result<String, PackageError> {
        Ok(format!("binaries/{}/{MODEL_IDENTIFIER}.{}", self.platform.name(interface)?, self.platform.extension))
    }
}

impl FromStr for Binary {
    type Err = PackageError;

    fn from_str(text: &str) -> Result<Self, PackageError> {
        match text.split_once('=') {
            Some((platform, file)) if !file.is_empty() => Self::new(platform, file),
            _ => Err(PackageError::Refused(format!("{text:?} is not of the form PLATFORM=FILE"))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use wheelrail::fmi::v2::description::Extent;

    const TWO: Interface = Interface::Two(Extent::Full);

    #[test]
    fn binaries_go_to_the_directory_and_name_of_their_platform_in_either_version() {
        for (text, two, three) in [
            ("win64=a/wheelrail.dll", "win64/wheelrail.dll", "x86_64-windows/wheelrail.dll"),
            ("x86_64-linux=b", "linux64/wheelrail.so", "x86_64-linux/wheelrail.so"),
            ("darwin64=b=c", "darwin64/wheelrail.dylib", "x86_64-darwin/wheelrail.dylib"),
            ("aarch64-darwin=b", "darwin64/wheelrail.dylib", "aarch64-darwin/wheelrail.dylib"),
        ] {
            let binary = text.parse::<Binary>().unwrap();
            assert_eq!(binary.entry(TWO).unwrap(), format!("binaries/{two}"));
            assert_eq!(binary.entry(Interface::Three).unwrap(), format!("binaries/{three}"));
        }
        let arm = "aarch64-linux=b".parse::<Binary>().unwrap();
        assert_eq!(arm.entry(Interface::Three).unwrap(), "binaries/aarch64-linux/wheelrail.so");
        let refusal = arm.entry(TWO).unwrap_err().to_string();
        assert_eq!(refusal, "FMI 2.0 has no name for aarch64-linux: pack the FMU with --fmi 3, which has one");
    }

    #[test]
    fn machines_that_the_standard_does_not_name_are_refused() {
        for (os, architecture, two, three) in [
            ("linux", "x86_64", Some("linux64"), "x86_64-linux"),
            ("windows", "x86_64", Some("win64"), "x86_64-windows"),
            ("macos", "x86_64", Some("darwin64"), "x86_64-darwin"),
            ("macos", "aarch64", Some("darwin64"), "aarch64-darwin"),
            ("linux", "aarch64", None, "aarch64-linux"),
            ("windows", "aarch64", None, "aarch64-windows"),
        ] {
            let platform = platform_of(os, architecture).unwrap();
            assert_eq!((platform.two, platform.three), (two, three));
        }
        for (os, architecture) in [("linux", "riscv64"), ("freebsd", "x86_64")] {
            let refusal = platform_of(os, architecture).unwrap_err().to_string();
            assert!(refusal.contains(&format!("{os} on {architecture}")), "{refusal}");
        }
    }

    #[test]
    fn unknown_platforms_are_refused_with_the_list_of_known_ones() {
        let refusal = |text: &str| text.parse::<Binary>().unwrap_err().to_string();
        let expected = "platform \"amiga\" is unknown: win32, win64, linux32, linux64, darwin32, darwin64, x86-windows, x86_64-windows";
        assert!(refusal("amiga=wheelrail.so").starts_with(expected));
        for text in ["win64", "win64=", "wheelrail.dll"] {
            assert!(refusal(text).contains("PLATFORM=FILE"), "{text}");
        }
    }
}
