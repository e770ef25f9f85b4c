//! Resource locations: the path that `fmuResourceLocation` means.

use std::path::PathBuf;

/// The rest of a text that begins with a word in small or capital letters, which mean the same in schemes and hosts.
fn after<'a>(text: &'a str, word: &str) -> Option<&'a str> {
    text.get(..word.len()).filter(|start| start.eq_ignore_ascii_case(word)).map(|_| &text[word.len()..])
}

/// Path of a `file:` URI (RFC 8089: `file:/a`, `file:///a`, `file://localhost/a`, percent-encoded) or of a plain path.
pub fn path_of(location: &str) -> Result<PathBuf, String> {
    let unusable = |why: &str| format!("resource location \"{location}\" {why}");
    let Some(rest) = after(location, "file:") else {
        return if location.contains("://") { Err(unusable("is not a file URI")) } else { Ok(location.into()) };
    };
    let path = match rest.strip_prefix("//") {
        Some(authority) => after(authority, "localhost").unwrap_or(authority),
        None => rest,
    };
    if !path.starts_with('/') {
        return Err(unusable("is not an absolute path on this machine"));
    }
    let decoded = decode(path.as_bytes()).ok_or_else(|| unusable("has a malformed percent code"))?;
    let path = String::from_utf8(decoded).map_err(|_| unusable("is not UTF-8"))?;
    let drive = path.as_bytes().get(2) == Some(&b':') && path.as_bytes().get(3) == Some(&b'/');
    Ok(if drive { path[1..].into() } else { path.into() })
}

/// Bytes of a text with percent codes such as `%3A`; `None` where one is malformed.
pub fn decode(text: &[u8]) -> Option<Vec<u8>> {
    let mut bytes = text.iter();
    let mut decoded = Vec::with_capacity(text.len());
    while let Some(&byte) = bytes.next() {
        decoded.push(if byte == b'%' {
            let mut digit = || char::from(*bytes.next()?).to_digit(16);
            (digit()? * 16 + digit()?) as u8
        } else {
            byte
        });
    }
    Some(decoded)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn any_text_is_a_path_or_refused_by_name(location in "(file:|file://|file:///|http://)?(localhost)?[%/a-zäC:.\\\\0-9]{0,30}|.{0,40}") {
            match path_of(&location) {
                Ok(path) => prop_assert!(!location.starts_with("file:") || path.has_root() || cfg!(windows) || path.to_string_lossy().contains(":/")),
                Err(why) => prop_assert!(why.contains(&location)),
            }
        }

        #[test]
        fn an_encoded_path_is_found_again(name in "/[^\\x00]{0,40}") {
            let encoded: String = name.bytes().map(|byte| format!("%{byte:02x}")).collect();
            let drive = name.as_bytes().get(2) == Some(&b':') && name.as_bytes().get(3) == Some(&b'/');
            prop_assume!(!drive);
            let encoded = format!("file:///{}", &encoded[3..]);
            prop_assert_eq!(path_of(&encoded).unwrap(), PathBuf::from(name));
        }
    }

    #[test]
    fn all_spellings_of_a_location_name_the_same_path() {
        let same = [
            "/a b/C",
            "file:/a b/C",
            "file:///a%20b/C",
            "file://localhost/a%20b/C",
            "FILE:///a%20b/C",
            "File:/a b/%43",
        ];
        for location in same.into_iter().chain(["fILE://LocalHost/a%20b/C"]) {
            assert_eq!(path_of(location).unwrap(), PathBuf::from("/a b/C"), "{location}");
        }
        assert_eq!(path_of("FILE:///c%3A/a%20b").unwrap(), PathBuf::from("c:/a b"));
        assert_eq!(path_of("file:///C:/a%20b").unwrap(), PathBuf::from("C:/a b"));
    }

    #[test]
    fn other_locations_are_refused_by_name() {
        for location in [
            "http://example.org/a",
            "file:a",
            "file:///a%2",
            "file:///a%zz",
            "file:///%ff",
            "FILE://host/a",
            "FILE:a",
            "filé:///a",
        ] {
            assert!(path_of(location).unwrap_err().contains(location), "{location}");
        }
    }
}
