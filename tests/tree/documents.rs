//! Documents name what exists: links lead somewhere, and files that are mentioned are there.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// README and its like, and all pages under `docs`.
fn documents() -> Vec<PathBuf> {
    let mut found = Vec::new();
    for directory in ["", "docs", "docs/theory"] {
        for entry in fs::read_dir(root().join(directory)).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_some_and(|e| e == "md") {
                found.push(path);
            }
        }
    }
    found
}

/// Targets of the links `[text](target)` within this repository, without anchors.
fn links(text: &str) -> impl Iterator<Item = &str> {
    let targets = text.split("](").skip(1).filter_map(|rest| rest.split_once(')')).map(|(target, _)| target);
    targets.filter(|t| !t.contains("://")).filter_map(|t| t.split('#').next()).filter(|t| !t.is_empty())
}

/// Words between backticks that are paths of this repository.
fn paths(text: &str) -> impl Iterator<Item = &str> {
    let words = text.split('`').filter(|word| !word.contains(char::is_whitespace) && !word.contains('*'));
    words.filter(|word| is_path(word))
}

/// True for a word that is a path of this repository.
fn is_path(word: &str) -> bool {
    const ROOMS: [&str; 15] = [
        "src/",
        "tests/",
        "docs/",
        "examples/",
        "fmpy_tests/",
        "benches/",
        "resources/",
        "packaging/",
        "python/",
        "bodies/src/",
        "contact/src/",
        "contact/tests/",
        "heat/src/",
        "numerics/src/",
        "surface/src/",
    ];
    ROOMS.iter().any(|room| word.starts_with(room))
}

#[test]
fn links_lead_to_files_that_exist() {
    let mut broken = Vec::new();
    for document in documents() {
        let text = fs::read_to_string(&document).unwrap();
        for target in links(&text).filter(|target| !document.parent().unwrap().join(target).exists()) {
            broken.push(format!("{}: {target}", document.display()));
        }
    }
    assert!(broken.is_empty(), "{}", broken.join("\n"));
}

#[test]
fn files_named_in_documents_exist() {
    let mut missing = Vec::new();
    for document in documents() {
        let text = fs::read_to_string(&document).unwrap();
        for path in paths(&text).filter(|path| !root().join(path).exists()) {
            missing.push(format!("{}: {path}", document.display()));
        }
    }
    assert!(missing.is_empty(), "{}", missing.join("\n"));
}

#[test]
fn files_and_targets_of_make_that_the_recipes_for_hosted_runners_use_exist() {
    let makefile = fs::read_to_string(root().join("Makefile")).unwrap();
    let (mut used, mut missing) = (0, Vec::new());
    for entry in fs::read_dir(root().join(".github/workflows")).unwrap() {
        let text = fs::read_to_string(entry.unwrap().path()).unwrap();
        let paths = text.split_whitespace().filter(|w| is_path(w) || w.starts_with("requirements/"));
        for path in paths.map(|path| path.trim_end_matches(['.', ',', ')'])) {
            used += 1;
            missing.extend((!root().join(path).exists()).then(|| path.to_owned()));
        }
        for target in text.split("run: make ").skip(1).filter_map(|rest| rest.split_whitespace().next()) {
            used += 1;
            missing.extend((!makefile.contains(&format!("\n{target}:"))).then(|| format!("make {target}")));
        }
    }
    assert!(used > 5 && missing.is_empty(), "{used} {missing:?}");
}

/// Crates that the text of a `Cargo.toml` names under any kind of dependencies.
fn dependencies(manifest: &str) -> Vec<&str> {
    let (mut names, mut within) = (Vec::new(), false);
    for line in manifest.lines() {
        if let Some(table) = line.strip_prefix('[') {
            within = table.trim_end_matches(']').ends_with("dependencies");
        } else if let Some((name, _)) = line.split_once('=').filter(|_| within && !line.starts_with('#')) {
            names.push(name.trim());
        }
    }
    names
}

/// Crates in the first column of the tables of a page.
fn listed(page: &str) -> Vec<&str> {
    let cells = page.lines().filter_map(|line| line.strip_prefix("| `")?.split('|').next());
    cells.flat_map(|cell| cell.split(',').map(|name| name.trim_matches([' ', '`']))).collect()
}

#[test]
fn the_page_of_dependencies_names_every_crate_that_is_asked_for_and_no_other() {
    let read = |path: &str| fs::read_to_string(root().join(path)).unwrap();
    let members = ["bench", "bodies", "coach", "contact", "heat", "numerics", "pack", "slave", "surface", "thesis"]
        .map(|member| format!("{member}/Cargo.toml"));
    let manifests: Vec<_> = members.iter().map(String::as_str).chain(["Cargo.toml"]).map(read).collect();
    let asked: BTreeSet<&str> = manifests.iter().flat_map(|manifest| dependencies(manifest)).collect();
    let page = read("docs/dependencies.md");
    let listed = listed(&page);
    assert!(asked.len() > 20, "{asked:?}");
    assert_eq!(listed.len(), listed.iter().collect::<BTreeSet<_>>().len(), "a crate twice: {listed:?}");
    assert_eq!(asked, listed.into_iter().collect());
}

#[test]
fn the_reader_of_manifests_sees_every_kind_of_dependencies() {
    let text = "[package]\nname = \"a\"\n[dependencies]\n# c = 1\nb = { version = \"1\" }\n[target.'cfg(unix)'.dependencies]\n\
                libc = \"0\"\n[dev-dependencies]\nd-e = \"2\"\n[lints]\nworkspace = true\n";
    assert_eq!(dependencies(text), ["b", "libc", "d-e"]);
    assert_eq!(listed("| crate | for |\n|---|---|\n| `a`, `b-c` | x `d`, `e` |\n"), ["a", "b-c"]);
}

#[test]
fn the_reader_of_documents_sees_links_and_paths() {
    let text = "See [a](b.md#c), [d](https://e.f) and [g](#h); `src/lib.rs`, `cargo test` and `src/*`.";
    assert_eq!(links(text).collect::<Vec<_>>(), ["b.md"]);
    assert_eq!(paths(text).collect::<Vec<_>>(), ["src/lib.rs"]);
}
