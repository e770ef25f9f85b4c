//! The directions in which rooms of the house may look at each other: imports run downward only.

use std::fs;
use std::path::{Path, PathBuf};

/// Each room with the rooms it may import. Rooms that are missing here may not exist.
const ALLOWED: &[(&str, &[&str])] = &[
    ("lib", &[]),
    ("config", &[]),
    ("analytic", &[]),
    ("material", &["config", "analytic"]),
    ("multistep", &["config"]),
    ("piecewise", &[]),
    ("linalg", &[]),
    ("fem", &["linalg"]),
    ("mechanics", &["fem", "linalg", "multistep", "config", "analytic", "material"]),
    ("heat", &["fem", "linalg", "config", "piecewise"]),
    ("contact", &["linalg", "multistep", "piecewise"]),
    ("rolling", &["mechanics", "contact", "heat", "multistep", "config", "analytic", "piecewise", "material"]),
    ("simulation", &["rolling", "mechanics", "contact", "heat", "fem", "linalg", "config"]),
    ("fmi", &["simulation", "config"]),
    ("cli", &["fmi", "simulation", "analytic", "config", "piecewise"]),
    ("main", &["cli"]),
];

fn sources(directory: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(directory).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(sources(&path));
        } else if path.extension().is_some_and(|e| e == "rs") {
            found.push(path);
        }
    }
    found
}

fn src() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src")
}

/// The room of a file: its folder under `src`, or its name.
fn room(path: &Path) -> String {
    let first = path.strip_prefix(src()).unwrap().components().next().unwrap();
    first.as_os_str().to_str().unwrap().trim_end_matches(".rs").to_owned()
}

/// Code without comments and without the unit tests at the end of the file, which may look anywhere.
fn code(path: &Path) -> String {
    let text = fs::read_to_string(path).unwrap();
    without_tests(&text).lines().map(|line| line.split("//").next().unwrap()).collect::<Vec<_>>().join("\n")
}

fn without_tests(text: &str) -> &str {
    text.split("#[cfg(test)]\nmod tests {").next().unwrap()
}

/// Rooms named after each `prefix`, also in a list such as `crate::{config::Config, simulation}`.
fn named<'a>(code: &'a str, prefix: &'a str) -> impl Iterator<Item = String> + 'a {
    let word = |text: &str| -> String { text.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect() };
    code.split(prefix).skip(1).flat_map(move |rest| {
        let Some(list) = rest.strip_prefix('{') else {
            return vec![word(rest)];
        };
        let mut depth = 1;
        let end = list.find(|c| {
            depth += i32::from(c == '{') - i32::from(c == '}');
            depth == 0
        });
        let mut items = vec![String::new()];
        for c in list[..end.unwrap_or(list.len())].chars() {
            depth += i32::from(c == '{') - i32::from(c == '}');
            if c == ',' && depth == 0 { items.push(String::new()) } else { items.last_mut().unwrap().push(c) }
        }
        items.iter().map(|item| word(item.trim())).filter(|item| !item.is_empty()).collect()
    })
}

#[test]
fn imports_run_downward_only() {
    let mut wrong = Vec::new();
    for path in sources(&src()) {
        let room = room(&path);
        let Some((_, allowed)) = ALLOWED.iter().find(|(name, _)| *name == room) else {
            wrong.push(format!("{}: room {room} is not in the plan", path.display()));
            continue;
        };
        let code = code(&path);
        let prefix = if ["main", "cli"].contains(&room.as_str()) { "wheelrail::" } else { "crate::" };
        for target in named(&code, prefix).filter(|target| *target != room) {
            if !allowed.contains(&target.as_str()) {
                wrong.push(format!("{}: {room} -> {target}", path.display()));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn unsafe_is_only_in_the_c_interface() {
    for path in sources(&src()) {
        let code = code(&path);
        let uses = code.split(|c: char| !c.is_alphanumeric() && c != '_').any(|word| word == "unsafe");
        assert!(!uses || path.components().any(|part| part.as_os_str() == "c_abi"), "{}", path.display());
    }
    assert!(code(&src().join("lib.rs")).contains("#![deny(unsafe_code)]"));
}

#[test]
fn the_core_never_names_the_interface() {
    for path in sources(&src()).iter().filter(|path| !["fmi", "cli", "main", "lib"].contains(&room(path).as_str())) {
        assert!(!code(path).to_lowercase().contains("fmi2"), "{}", path.display());
    }
}

#[test]
fn the_reader_of_imports_sees_lists() {
    let code = "use crate::{config::{Config, Wheel}, simulation};\nuse crate::fem::Mesh;";
    assert_eq!(named(code, "crate::").collect::<Vec<_>>(), ["config", "simulation", "fem"]);
    let file = "#[cfg(test)]\nmod tests;\nuse crate::fem;\n#[cfg(test)]\nmod tests {\nuse crate::cli;\n}";
    assert_eq!(named(without_tests(file), "crate::").collect::<Vec<_>>(), ["fem"]);
}
