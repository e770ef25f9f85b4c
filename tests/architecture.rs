//! The plan of the house, kept by reading the source: which room may look at which other, that nothing looks back, and how
//! large functions and files may be. Every rule is itself tested on a made-up house that breaks it.

mod source_map;

use source_map::{SourceMap, circles, functions, without_comments, without_strings};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// Each room with the rooms it may import. Rooms that are missing here may not exist.
const ALLOWED: &[(&str, &[&str])] = &[
    ("lib", &[]),
    ("config", &["analytic"]),
    ("analytic", &[]),
    ("material", &["config", "analytic", "piecewise"]),
    ("multistep", &["config"]),
    ("piecewise", &[]),
    ("files", &[]),
    ("linalg", &[]),
    ("fem", &["linalg"]),
    ("mechanics", &["surface", "fem", "linalg", "multistep", "config", "analytic", "material"]),
    ("heat", &["fem", "linalg", "config", "piecewise"]),
    ("surface", &["config", "files", "piecewise"]),
    ("contact", &["linalg", "multistep", "piecewise"]),
    ("damage", &["fem"]),
    (
        "rolling",
        &[
            "mechanics",
            "contact",
            "heat",
            "damage",
            "multistep",
            "config",
            "analytic",
            "piecewise",
            "material",
            "surface",
        ],
    ),
    ("simulation", &["material", "rolling", "mechanics", "heat", "fem", "files", "linalg", "config"]),
    ("wheels", &["simulation"]),
    ("fmi", &["simulation", "config", "files"]),
    ("cli", &["fmi", "simulation", "analytic", "config", "files", "piecewise"]),
    ("main", &["cli"]),
];

/// Rooms that know the interface; all others are its core.
const INTERFACE: [&str; 4] = ["fmi", "cli", "main", "lib"];
/// Longest function and longest file [lines].
const LONGEST_FUNCTION: usize = 80;
const LONGEST_FILE: usize = 400;
/// Files that may be longer, with the reason: tables of many rows.
const LONG_FILES: &[(&str, &str)] = &[];

fn src() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src")
}

/// Path below `src` and text of every file of source.
fn sources() -> Vec<(String, String)> {
    fn collect(folder: &Path, found: &mut Vec<PathBuf>) {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                collect(&path, found);
            } else if path.extension().is_some_and(|e| e == "rs") {
                found.push(path);
            }
        }
    }
    let mut paths = Vec::new();
    collect(&src(), &mut paths);
    let name = |path: &Path| path.strip_prefix(src()).unwrap().to_str().unwrap().replace('\\', "/");
    paths.iter().map(|path| (name(path), fs::read_to_string(path).unwrap())).collect()
}

/// The room of a file: its folder under `src`, or its name.
fn room(file: &str) -> &str {
    file.split('/').next().unwrap().trim_end_matches(".rs")
}

/// What each room imports, with one file that does.
fn looks(map: &SourceMap) -> BTreeMap<(&str, &str), &str> {
    let mut found = BTreeMap::new();
    for (i, module) in map.modules.iter().enumerate() {
        let from = room(&module.file);
        for to in map.rooms_named(i).into_iter().map(room).filter(|to| *to != from) {
            found.insert((from, to), module.file.as_str());
        }
    }
    found
}

/// Rooms that are not in the plan or not in the house, imports that the plan does not allow, and permissions that nobody
/// uses.
fn against_the_plan(map: &SourceMap, plan: &[(&str, &[&str])]) -> Vec<String> {
    let rooms: BTreeSet<&str> = map.modules.iter().map(|module| room(&module.file)).collect();
    let planned: BTreeSet<&str> = plan.iter().map(|(name, _)| *name).collect();
    let permissions: BTreeSet<_> = plan.iter().flat_map(|(from, to)| to.iter().map(move |to| (*from, *to))).collect();
    let looks = looks(map);
    let mut wrong: Vec<String> = rooms.difference(&planned).map(|room| format!("{room} is not in the plan")).collect();
    wrong.extend(planned.difference(&rooms).map(|room| format!("{room} is in the plan only")));
    wrong.extend(
        looks
            .iter()
            .filter(|(look, _)| !permissions.contains(*look))
            .map(|((from, to), file)| format!("{file}: {from} may not look at {to}")),
    );
    let unused = permissions.iter().filter(|permission| !looks.contains_key(*permission));
    wrong.extend(unused.map(|(from, to)| format!("{from} may look at {to}, but does not")));
    wrong
}

/// Circles between files, and between rooms.
fn all_circles(map: &SourceMap) -> Vec<String> {
    let imports = map.imports();
    let files = circles(&imports).into_iter().map(|circle| {
        let within = |file: &usize| {
            let targets = imports[*file].iter().filter(|target| circle.contains(target));
            let targets: Vec<_> = targets.map(|target| map.modules[*target].file.as_str()).collect();
            format!("{} -> {}", map.modules[*file].file, targets.join(", "))
        };
        circle.iter().map(within).collect::<Vec<_>>().join("\n  ")
    });
    let looks = looks(map);
    let rooms: Vec<&str> =
        looks.keys().flat_map(|(from, to)| [*from, *to]).collect::<BTreeSet<_>>().into_iter().collect();
    let ahead = |room: &&str| (0..rooms.len()).filter(|to| looks.contains_key(&(*room, rooms[*to]))).collect();
    let edges: Vec<BTreeSet<usize>> = rooms.iter().map(ahead).collect();
    let named = |circle: Vec<usize>| circle.iter().map(|room| rooms[*room]).collect::<Vec<_>>().join(" - ");
    files.chain(circles(&edges).into_iter().map(named)).collect()
}

/// Functions and files that are too long; `excepted` are the files that may be.
fn too_long(file: &str, text: &str, excepted: &[(&str, &str)]) -> Vec<String> {
    let code = without_strings(&without_comments(text));
    let long = functions(&code).into_iter().filter(|(_, lines)| *lines > LONGEST_FUNCTION);
    let mut wrong: Vec<_> = long.map(|(name, lines)| format!("{file}: {name} has {lines} lines")).collect();
    let lines = text.lines().count();
    let excepted = excepted.iter().any(|(name, _)| *name == file);
    if (lines > LONGEST_FILE) != excepted {
        wrong.push(format!("{file} has {lines} lines{}", if excepted { " and needs no exception" } else { "" }));
    }
    wrong
}

/// Whether code uses a word.
fn has_word(text: &str, word: &str) -> bool {
    let code = without_strings(&without_comments(text));
    code.split(|c: char| !c.is_alphanumeric() && c != '_').any(|found| found == word)
}

/// Whether code of the core speaks of the interface, be it in a name or in a message.
fn names_the_interface(text: &str) -> bool {
    let code = without_comments(text).to_lowercase();
    ["fmi", "fmu"].iter().any(|word| code.contains(word))
}

/// Whether code reaches into a contact grid.
fn reaches_into_a_grid(text: &str) -> bool {
    text.contains("grid.")
}

/// A house of made-up files.
fn house(files: &[(&str, &str)]) -> SourceMap {
    SourceMap::from_files(|file| files.iter().find(|(name, _)| *name == file).map(|(_, text)| (*text).to_owned()))
}

#[test]
fn imports_run_downward_as_planned_and_every_permission_is_used() {
    let wrong = against_the_plan(&SourceMap::read(&src()), ALLOWED);
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn an_import_against_the_plan_an_unused_permission_and_an_unplanned_room_are_seen() {
    let map = house(&[
        ("lib.rs", "pub mod low; pub mod high; pub mod annex;"),
        ("low.rs", "pub struct Brick;\nfn f() -> u8 { crate::high::roof() }"),
        ("high/mod.rs", "mod part; pub fn roof() -> u8 { 1 }"),
        ("high/part.rs", "#[cfg(test)]\nmod tests { use crate::low::Brick; }\n// use crate::low::Brick;\n"),
        ("annex.rs", "const TEXT: &str = \"use crate::low::Brick;\";"),
    ]);
    let plan: &[(&str, &[&str])] = &[("lib", &[]), ("low", &[]), ("high", &["low"]), ("attic", &[])];
    let wrong = against_the_plan(&map, plan);
    let expected = [
        "annex is not in the plan",
        "attic is in the plan only",
        "low.rs: low may not look at high",
        "high may look at low, but does not",
    ];
    assert_eq!(wrong, expected);
}

#[test]
fn no_import_runs_in_a_circle() {
    let circles = all_circles(&SourceMap::read(&src()));
    assert!(circles.is_empty(), "{}", circles.join("\n"));
}

#[test]
fn circles_are_seen_through_every_kind_of_import() {
    let pairs = [
        ("use crate::room::b::B; pub struct A;", "use super::a::A; pub struct B;"),
        ("use super::b; pub struct A(b::B);", "pub use super::a::{self, A}; pub struct B;"),
        ("use super::*; pub struct A(B);", "pub struct B(crate::room::A);"),
        ("pub struct A(super::b::B);", "use crate::{room::{A as Other}}; pub struct B;"),
    ];
    for (a, b) in pairs {
        let room = "mod a; mod b; pub use a::A; use b::B;";
        let map = house(&[("lib.rs", "mod room;"), ("room/mod.rs", room), ("room/a.rs", a), ("room/b.rs", b)]);
        assert_eq!(all_circles(&map).len(), 1, "{a} {b}: {:?}", all_circles(&map));
    }
    // A parent that only names its children is no part of a circle; one whose own items they use is.
    let parent = |own: &str| {
        let room = format!("mod a; mod b; pub use a::A; {own}");
        let map = house(&[
            ("lib.rs", "mod room;"),
            ("room/mod.rs", &room),
            ("room/a.rs", "pub struct A;"),
            ("room/b.rs", "use super::A; #[cfg(test)] mod tests { use super::super::Own; }"),
        ]);
        all_circles(&map)
    };
    assert!(parent("pub struct Own;").is_empty());
    let map = house(&[
        ("lib.rs", "mod room;"),
        ("room.rs", "mod a; pub use a::A; pub struct Own;"),
        ("room/a.rs", "pub struct A(super::Own);"),
    ]);
    assert_eq!(all_circles(&map), ["room.rs -> room/a.rs\n  room/a.rs -> room.rs"]);
}

#[test]
fn circles_between_rooms_are_seen_though_no_file_is_in_one() {
    let map = house(&[
        ("lib.rs", "mod x; mod y;"),
        ("x/mod.rs", "mod a; mod b;"),
        ("x/a.rs", "pub struct A;"),
        ("x/b.rs", "use crate::y::c::C;"),
        ("y/mod.rs", "mod c; mod d;"),
        ("y/c.rs", "pub struct C;"),
        ("y/d.rs", "use crate::x::a::A;"),
    ]);
    assert_eq!(all_circles(&map), ["x - y"]);
}

#[test]
fn unsafe_is_only_in_the_c_interface() {
    for (file, text) in sources() {
        assert!(!has_word(&text, "unsafe") || file.contains("/c_abi/"), "{file}");
        assert!(file == "lib.rs" || file.contains("/c_abi/") || !text.contains("allow(unsafe_code"), "{file}");
    }
    assert!(fs::read_to_string(src().join("lib.rs")).unwrap().contains("#![deny(unsafe_code)]"));
    assert!(has_word("fn f() { unsafe { g() } }", "unsafe"));
    assert!(!has_word("// unsafe\nconst UNSAFE: &str = \"unsafe\"; fn unsafe_code() {}", "unsafe"));
}

#[test]
fn the_core_never_names_the_interface() {
    for (file, text) in sources().iter().filter(|(file, _)| !INTERFACE.contains(&room(file))) {
        assert!(!names_the_interface(text), "{file}");
    }
    assert!(names_the_interface("const KIND: &str = \"fmi2Real\";"));
    assert!(names_the_interface("struct Fmu;"));
    assert!(!names_the_interface("// where the FMU is packed\nstruct Core;"));
}

#[test]
fn the_rolling_motion_knows_no_grid() {
    for (file, text) in sources().iter().filter(|(file, _)| room(file) == "rolling") {
        assert!(!reaches_into_a_grid(text), "{file}");
    }
    assert!(reaches_into_a_grid("let h = model.grid.spacing;"));
}

#[test]
fn functions_and_files_fit_on_a_screen_and_into_a_head() {
    let wrong: Vec<_> = sources().iter().flat_map(|(file, text)| too_long(file, text, LONG_FILES)).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn long_functions_long_files_and_needless_exceptions_are_seen() {
    let body =
        |lines: usize| format!("fn short();\nfn long<'a>(x: [u8; 3]) -> char {{\n{}'}}'\n}}\n", "x();\n".repeat(lines));
    assert_eq!(too_long("a.rs", &body(77), &[]), Vec::<String>::new());
    assert_eq!(too_long("a.rs", &body(78), &[]), ["a.rs: long has 81 lines"]);
    let file = "// a line\n".repeat(401);
    assert_eq!(too_long("a.rs", &file, &[]), ["a.rs has 401 lines"]);
    assert_eq!(too_long("a.rs", &file, &[("a.rs", "a table")]), Vec::<String>::new());
    assert_eq!(too_long("a.rs", "", &[("a.rs", "a table")]), ["a.rs has 0 lines and needs no exception"]);
}

#[test]
fn every_file_of_source_is_part_of_the_house() {
    let map = SourceMap::read(&src());
    let known: BTreeSet<_> = map.modules.iter().map(|module| module.file.as_str()).collect();
    let tests = ["mechanics/testing.rs", "heat/tensor/tests.rs", "simulation/tests.rs", "surface/tests.rs"];
    let strangers: Vec<_> =
        sources().into_iter().map(|(file, _)| file).filter(|file| !known.contains(file.as_str())).collect();
    assert_eq!(strangers.iter().filter(|file| !tests.contains(&file.as_str())).count(), 0, "{strangers:?}");
}
