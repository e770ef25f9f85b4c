//! The plan of the house, kept by reading the source: which room may look at which other, that nothing looks back, how
//! large functions and files may be, and how names and comments are written. Every rule is itself tested on a made-up
//! house that breaks it. `tools/house.py` lists every case of what is counted here.

use crate::source_map::choices::{items, shortcuts};
use crate::source_map::{
    MEMBERS, Module, SourceMap, circles, functions, lines_of_tests, types, without_comments, without_strings,
    without_tests,
};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// Each room of `src/` with those of `src/` that it may import; `lib` is the root of the library. Rooms that are missing here may not
/// exist. Between crates cargo keeps the plan: what stands in the `Cargo.toml` of each.
const ALLOWED: &[(&str, &[&str])] = &[
    ("lib", &[]),
    ("config", &[]),
    ("rolling", &["config"]),
    ("simulation", &["config", "rolling"]),
    ("wheels", &["simulation"]),
    ("fmi", &["config", "simulation"]),
];

/// Rooms that know the interface; all others are its core.
const INTERFACE: [&str; 2] = ["fmi", "lib"];
/// Longest function and longest file [lines], unit tests not counted.
const LONGEST_FUNCTION: usize = 60;
const LONGEST_FILE: usize = 400;
/// Files that may be longer, with the reason: tables of many rows.
const LONG_FILES: &[(&str, &str)] = &[];
/// Functions that are longer today. The list may only become shorter.
const LONG_FUNCTIONS: &[(&str, &str)] = &[];
/// Functions of `f64` that the mathematical library of the machine computes, with other last digits on other machines,
/// and sums of products that are rounded once or twice. `√`, whole powers and roundings are the same everywhere.
const OF_THE_MACHINE: [&str; 26] = [
    "sin", "cos", "tan", "sin_cos", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh", "asinh", "acosh", "atanh",
    "exp", "exp2", "exp_m1", "ln", "ln_1p", "log", "log2", "log10", "powf", "cbrt", "hypot", "mul_add",
];
/// Beginnings of doc comments that name no subject.
const NO_SUBJECT: [&str; 3] = ["What", "Whether", "The same"];

fn checkout() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Path and text of every file of source, as [`SourceMap`] names them.
fn sources() -> Vec<(String, String)> {
    let of_member = |(_, folder): (&str, &str)| {
        files_below(&checkout().join(folder))
            .into_iter()
            .map(|(file, text)| (format!("{folder}{file}"), text))
            .collect()
    };
    let members: Vec<Vec<_>> = MEMBERS.into_iter().map(of_member).collect();
    assert!(members.iter().all(|files| files.len() > 10));
    files_below(&checkout().join("src")).into_iter().chain(members.into_iter().flatten()).collect()
}

/// Path of a file below the source of its crate.
fn within_crate(file: &str) -> &str {
    MEMBERS.iter().find_map(|(_, folder)| file.strip_prefix(folder)).unwrap_or(file)
}

/// Path of a file from the root of the checkout.
fn from_checkout(file: &str) -> String {
    if within_crate(file) == file { format!("src/{file}") } else { file.to_owned() }
}

/// Path below a folder and text of every file of source in it.
fn files_below(top: &Path) -> Vec<(String, String)> {
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
    collect(top, &mut paths);
    let name = |path: &Path| path.strip_prefix(top).unwrap().to_str().unwrap().replace('\\', "/");
    paths.iter().map(|path| (name(path), fs::read_to_string(path).unwrap())).collect()
}

/// The room of a file: its folder under the source of its crate, or its name.
fn room(file: &str) -> &str {
    within_crate(file).split('/').next().unwrap().trim_end_matches(".rs")
}

/// Imports of each room, with one file that has them.
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

/// Rooms that are not in the plan or not in the house, imports that the plan does not allow, and permissions that
/// nobody uses.
fn against_the_plan(map: &SourceMap, plan: &[(&str, &[&str])]) -> Vec<String> {
    let here = |module: &&Module| within_crate(&module.file) == module.file;
    let rooms: BTreeSet<&str> = map.modules.iter().filter(here).map(|module| room(&module.file)).collect();
    let planned: BTreeSet<&str> = plan.iter().map(|(name, _)| *name).collect();
    let permissions: BTreeSet<_> = plan.iter().flat_map(|(from, to)| to.iter().map(move |to| (*from, *to))).collect();
    let mut looks = looks(map);
    looks.retain(|(from, to), _| rooms.contains(from) && rooms.contains(to));
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

/// Functions and files that are too long but for those excepted, with limit and remedy; unit tests do not count.
fn too_long(file: &str, text: &str, files: &[(&str, &str)], known: &[(&str, &str)]) -> Vec<String> {
    let code = without_strings(&without_comments(text));
    let long = functions(&without_tests(&code)).into_iter().filter(|(_, lines)| *lines > LONGEST_FUNCTION);
    let unknown = long.filter(|(name, _)| !known.contains(&(file, name.as_str())));
    let describe = |(name, lines): (String, usize)| {
        format!(
            "{}: {name} has {lines} lines; limit {LONGEST_FUNCTION}: give each of its steps a function whose name says \
             what it does",
            from_checkout(file)
        )
    };
    let mut wrong: Vec<_> = unknown.map(describe).collect();
    let lines = text.lines().count() - lines_of_tests(&code);
    let excepted = files.iter().any(|(name, _)| *name == file);
    if lines > LONGEST_FILE && !excepted {
        wrong.push(format!(
            "{} has {lines} lines without its tests; limit {LONGEST_FILE}: split it by idea, one reason to change a file",
            from_checkout(file)
        ));
    }
    if lines <= LONGEST_FILE && excepted {
        wrong.push(format!(
            "{} has {lines} lines and needs no exception; limit {LONGEST_FILE}: take it off LONG_FILES",
            from_checkout(file)
        ));
    }
    wrong
}

/// Files that are compiled for tests only.
fn test_files(sources: &[(String, String)]) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    for (file, text) in sources {
        let code = without_strings(&without_comments(text));
        let folder = match file.rsplit_once('/') {
            Some((folder, "mod.rs" | "lib.rs")) => format!("{folder}/"),
            None if file == "lib.rs" => String::new(),
            _ => format!("{}/", file.trim_end_matches(".rs")),
        };
        let declared =
            code.split("#[cfg(test)]").skip(1).filter_map(|item| item.split(';').next()?.split("mod ").nth(1));
        for name in declared.filter(|name| !name.contains('{')) {
            found.extend([format!("{folder}{name}.rs"), format!("{folder}{name}/mod.rs")]);
        }
    }
    found.retain(|file| sources.iter().any(|(known, _)| known == file));
    found
}

/// Type names that are defined more than once, with the files that do.
fn defined_twice(sources: &[(String, String)]) -> Vec<String> {
    let tests = test_files(sources);
    let mut homes = BTreeMap::<String, Vec<&str>>::new();
    for (file, text) in sources.iter().filter(|(file, _)| !tests.contains(file)) {
        for name in types(&without_tests(&without_strings(&without_comments(text)))) {
            homes.entry(name).or_default().push(file);
        }
    }
    let twice = homes.into_iter().filter(|(_, files)| files.len() > 1);
    twice.map(|(name, files)| format!("{name}: {}", files.join(", "))).collect()
}

/// Places of the doc comments that begin without a subject.
fn without_subject(file: &str, text: &str) -> Vec<String> {
    let comment = |line: &str| {
        let line = line.trim_start();
        line.strip_prefix("///").or(line.strip_prefix("//!")).map(|text| text.trim_start().to_owned())
    };
    let lines: Vec<_> = text.lines().map(comment).collect();
    let first = |n: &usize| *n == 0 || lines[n - 1].is_none();
    let bare = |text: &String| {
        let rest = NO_SUBJECT.iter().find_map(|word| text.strip_prefix(word));
        rest.is_some_and(|rest| !rest.starts_with(|c: char| c.is_alphanumeric() || c == '_'))
    };
    let found = (0..lines.len()).filter(first).filter(|n| lines[*n].as_ref().is_some_and(bare));
    found.map(|n| format!("{file}:{}", n + 1)).collect()
}

/// True for code that uses a word.
fn has_word(text: &str, word: &str) -> bool {
    let code = without_strings(&without_comments(text));
    code.split(|c: char| !c.is_alphanumeric() && c != '_').any(|found| found == word)
}

/// True for code of the core that speaks of the interface, be it in a name or in a message.
fn names_the_interface(text: &str) -> bool {
    let code = without_comments(text).to_lowercase();
    ["fmi", "fmu"].iter().any(|word| code.contains(word))
}

/// True for code that reaches into a contact grid.
fn reaches_into_a_grid(text: &str) -> bool {
    text.contains("grid.")
}

/// Calls of functions whose last digits depend on the machine, as methods or by path; unit tests do not count.
fn calls_of_the_machine(text: &str) -> Vec<String> {
    let code = without_tests(&without_strings(&without_comments(text)));
    let ends = |rest: &str| !rest.starts_with(|c: char| c.is_alphanumeric() || c == '_');
    let method = |name: &&str| {
        let dotted = format!(".{name}(");
        // `log` without a base is the log of a life cycle.
        code.match_indices(&dotted).any(|(at, _)| *name != "log" || !code[at + dotted.len()..].starts_with(')'))
    };
    let path = |name: &&str| {
        let paths = [format!("f64::{name}"), format!("f32::{name}")];
        paths.iter().any(|path| code.match_indices(path).any(|(at, _)| ends(&code[at + path.len()..])))
    };
    OF_THE_MACHINE.iter().filter(|name| method(name) || path(name)).map(|name| (*name).to_owned()).collect()
}

/// A house of made-up files.
fn house(files: &[(&str, &str)]) -> SourceMap {
    SourceMap::from_files(|file| files.iter().find(|(name, _)| *name == file).map(|(_, text)| (*text).to_owned()))
}

#[test]
fn imports_run_downward_as_planned_and_every_permission_is_used() {
    let wrong = against_the_plan(&SourceMap::read(checkout()), ALLOWED);
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
fn rooms_of_other_crates_are_seen_behind_the_roots_that_pass_them_on() {
    let map = house(&[
        ("lib.rs", "mod high; pub use wheelrail_contact::middle; pub use wheelrail_numerics::low;"),
        ("high.rs", "use crate::low::Brick; use crate::middle::wall::Wall;"),
        ("contact/src/lib.rs", "pub mod middle; use wheelrail_numerics::low;"),
        ("contact/src/middle/mod.rs", "pub mod wall;"),
        ("contact/src/middle/wall.rs", "use crate::low::Brick;\n#[cfg(test)]\nmod tests { use wheelrail::high::f; }"),
        ("numerics/src/lib.rs", "pub mod low;"),
        ("numerics/src/low.rs", "pub struct Brick;"),
    ]);
    let looks: Vec<_> = looks(&map).into_keys().collect();
    let expected = [("high", "low"), ("high", "middle"), ("lib", "low"), ("lib", "middle"), ("middle", "low")];
    assert_eq!(looks, expected);
    let files = map
        .imports()
        .into_iter()
        .map(|targets| targets.into_iter().map(|file| map.modules[file].file.as_str()).collect());
    let files: Vec<Vec<&str>> = files.collect();
    let high = map.modules.iter().position(|module| module.file == "high.rs").unwrap();
    assert_eq!(files[high], ["numerics/src/low.rs", "contact/src/middle/wall.rs"]);
    assert!(all_circles(&map).is_empty());
}

#[test]
fn no_import_runs_in_a_circle() {
    let circles = all_circles(&SourceMap::read(checkout()));
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
    for crate_of in ["", "bodies", "coach", "contact", "heat", "numerics", "slave", "surface"] {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(crate_of).join("src");
        let is_interface = |file: &str| crate_of == "slave" && file.starts_with("c_abi/");
        for (file, text) in files_below(&folder) {
            assert!(!has_word(&text, "unsafe") || is_interface(&file), "{crate_of} {file}");
            assert!(
                file == "lib.rs" || is_interface(&file) || !text.contains("allow(unsafe_code"),
                "{crate_of} {file}"
            );
        }
        assert!(fs::read_to_string(folder.join("lib.rs")).unwrap().contains("#![deny(unsafe_code"), "{crate_of}");
    }
    assert!(has_word("fn f() { unsafe { g() } }", "unsafe"));
    assert!(!has_word("// unsafe\nconst UNSAFE: &str = \"unsafe\"; fn unsafe_code() {}", "unsafe"));
}

/// `tests/fmi/fmi_library.rs` finds those that dependencies call.
#[test]
fn functions_come_from_the_portable_library() {
    let product = Path::new(env!("CARGO_MANIFEST_DIR"));
    for folder in ["src", "bodies/src", "contact/src", "heat/src", "numerics/src", "slave/src", "surface/src"] {
        let sources = files_below(&product.join(folder));
        let tests = test_files(&sources);
        assert!(sources.len() > tests.len() + 5, "{folder}: {} files", sources.len());
        for (file, text) in sources.iter().filter(|(file, _)| !tests.contains(file)) {
            let found = calls_of_the_machine(text);
            assert!(found.is_empty(), "{folder}/{file} calls {}: take them from the crate libm", found.join(", "));
        }
    }
}

#[test]
fn calls_of_the_machine_are_seen_as_methods_constants_and_paths() {
    for (code, expected) in [
        ("fn f(x: f64) -> f64 { x.sin() }", "sin"),
        ("fn f(x: f64) -> f64 {\n    (2.0 * x)\n        .exp_m1()\n}", "exp_m1"),
        ("const G: f64 = 2.0; fn f() -> f64 { G.ln() }", "ln"),
        ("fn f(x: &[f64]) -> Vec<f64> { x.iter().copied().map(f64::cbrt).collect() }", "cbrt"),
        ("fn f(x: f64) -> f64 { f64::atan2(x, 1.0) }", "atan2"),
        ("fn f(x: f64) -> f64 { x.log(3.0) }", "log"),
        ("fn f(x: f64) -> f64 { x.mul_add(2.0, 1.0) }", "mul_add"),
    ] {
        assert_eq!(calls_of_the_machine(code), [expected], "{code}");
    }
    for code in [
        "fn f(x: f64) -> f64 { libm::sin(x).sqrt().powi(2) } // x.sin()",
        "fn f(life: &Life) { life.log().report(); simd.mul_add_e_f64s(a, b, c); }",
        "fn f(angles: Angles) -> f64 { angles.cosine() + f64::logarithm() }",
        "#[cfg(test)]\nmod tests { fn f(x: f64) -> f64 { x.sin() } }",
    ] {
        assert_eq!(calls_of_the_machine(code), Vec::<String>::new(), "{code}");
    }
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

/// A new item of a choice does not compile until every place has answered for it.
#[test]
fn choices_are_matched_on_every_item() {
    let sources = sources();
    let items: Vec<String> = sources.iter().flat_map(|(_, text)| items(text)).collect();
    assert!(items.len() > 20 && items.iter().any(|item| item == "RailEnds::Free"), "{items:?}");
    let found = |(file, text): &(String, String)| {
        shortcuts(text, &items).into_iter().map(|found| format!("{file} {found}")).collect::<Vec<_>>()
    };
    let tests = test_files(&sources);
    let wrong: Vec<_> = sources.iter().filter(|(file, _)| !tests.contains(file)).flat_map(found).collect();
    let remedy = "match every item by name, or ask a question of src/config/choices.rs";
    assert!(wrong.is_empty(), "{remedy}:\n{}", wrong.join("\n"));
}

#[test]
fn comparisons_with_one_item_and_arms_for_all_others_are_seen() {
    let defined = "choice! {\n    /// About.\n    pub enum Wear named \"Wear\", \"Text\" {\n        Off = \"off\", \"a\";\n        \
                   On = \"on\", \"b = c\";\n    }\n}\n";
    let items = items(defined);
    assert_eq!(items, ["Wear::Off", "Wear::On"]);
    for (code, expected) in [
        ("fn f(w: Wear) -> bool { w == Wear::On }", "compares with Wear::On"),
        ("fn f(w: &Wear) -> bool { *w != config::Wear::Off }", "compares with Wear::Off"),
        ("fn f(w: Wear) -> bool { matches!(w, Wear::On) }", "asks for Wear::On alone"),
        ("fn f(w: Wear) { if let Wear::On = w { g() } }", "asks for Wear::On alone"),
        ("fn f(w: Wear) -> u8 { match w { Wear::On => { 1 } _ => 2 } }", "matches Wear::On and all others as _"),
        (
            "fn f(w: Wear) -> u8 { match w { Wear::On => h(1, 2), other => g(other) } }",
            "matches Wear::On and all others as other",
        ),
    ] {
        assert_eq!(shortcuts(code, &items), [expected], "{code}");
    }
    for code in [
        "fn f(w: Wear) -> u8 { match w { Wear::On => 1, Wear::Off => 2 } }",
        "fn f(w: Wear, n: u8) -> u8 { match n { 0 => match w { Wear::On => 1, Wear::Off => 2 }, _ => 3 } }",
        "const W: Wear = Wear::On; // w == Wear::On\nfn f(w: Worn) -> bool { w == Worn::On }",
        "#[cfg(test)]\nmod tests { fn f(w: Wear) -> bool { w == Wear::On } }",
    ] {
        assert_eq!(shortcuts(code, &items), Vec::<String>::new(), "{code}");
    }
}

#[test]
fn functions_and_files_fit_on_a_screen_and_into_a_head() {
    let sources = sources();
    let tests = test_files(&sources);
    let product = sources.iter().filter(|(file, _)| !tests.contains(file));
    let wrong: Vec<_> = product.flat_map(|(file, text)| too_long(file, text, LONG_FILES, LONG_FUNCTIONS)).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn long_functions_long_files_and_needless_exceptions_are_seen() {
    let body =
        |lines: usize| format!("fn short();\nfn long<'a>(x: [u8; 3]) -> char {{\n{}'}}'\n}}\n", "x();\n".repeat(lines));
    let seen = |text: &str, files: &[(&str, &str)], known: &[(&str, &str)]| too_long("a.rs", text, files, known);
    assert_eq!(seen(&body(57), &[], &[]), Vec::<String>::new());
    let long = seen(&body(58), &[], &[]);
    assert!(long.len() == 1 && long[0].starts_with("src/a.rs: long has 61 lines; limit 60: "), "{long:?}");
    assert_eq!(seen(&body(58), &[], &[("a.rs", "long")]), Vec::<String>::new());
    assert_eq!(seen(&body(58), &[], &[("b.rs", "long"), ("a.rs", "short")]).len(), 1);
    let file = "// a line\n".repeat(401);
    let long = seen(&file, &[], &[]);
    assert!(
        long.len() == 1 && long[0].starts_with("src/a.rs has 401 lines without its tests; limit 400: "),
        "{long:?}"
    );
    assert_eq!(seen(&file, &[("a.rs", "a table")], &[]), Vec::<String>::new());
    let needless = seen("", &[("a.rs", "a table")], &[]);
    assert!(needless.len() == 1 && needless[0].contains("needs no exception"), "{needless:?}");
    // Unit tests may be as long as they need.
    let tests = format!("{}#[cfg(test)]\nmod tests {{\n{}}}\n", "// a line\n".repeat(400), body(100));
    assert_eq!(seen(&tests, &[], &[]), Vec::<String>::new());
}

#[test]
fn type_names_are_not_defined_twice_more_often_than_today() {
    let found = defined_twice(&sources());
    assert!(
        found.is_empty(),
        "{} type names are defined more than once: give the newer type a name of its own, a term of the field\n{}",
        found.len(),
        found.join("\n")
    );
}

#[test]
fn types_of_one_name_are_seen_but_for_those_of_tests_traits_and_implementations() {
    let source = |(file, text): (&str, &str)| (file.to_owned(), text.to_owned());
    let house = [
        ("a/mod.rs", "pub struct One; enum Two { Three }\n#[cfg(test)]\nmod tests;\nmod b;"),
        ("a/b.rs", "type One = u8; // struct Two;\ntrait Four { type Five; }\n#[cfg(test)]\nmod tests { struct Two; }"),
        ("a/tests.rs", "struct One; enum Two {}"),
        (
            "c.rs",
            "struct Five<T>(T);\nimpl<T> Iterator for Five<T> {\n    type Two = T;\n}\nimpl A for u8 {\n    type Two = u8;\n}\nconst X: &str = \"struct Two;\";",
        ),
    ];
    assert_eq!(defined_twice(&house.map(source)), ["One: a/mod.rs, a/b.rs"]);
}

#[test]
fn doc_comments_begin_with_their_subject() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folders = [
        "src", "slave", "bench", "bodies", "coach", "contact", "heat", "numerics", "pack", "surface", "thesis",
        "tests", "benches", "examples",
    ];
    let within = |folder: &str| {
        let files = files_below(&root.join(folder));
        files
            .into_iter()
            .flat_map(|(file, text)| without_subject(&format!("{folder}/{file}"), &text))
            .collect::<Vec<_>>()
    };
    let found: Vec<_> = folders.into_iter().flat_map(within).collect();
    assert!(
        found.is_empty(),
        "doc comments that begin with {}: begin with the subject, a noun of the field\n{}",
        NO_SUBJECT.join(", "),
        found.join("\n")
    );
}

#[test]
fn doc_comments_without_a_subject_are_seen_where_they_begin() {
    let text = "//! What it is.\n\n/// A wheel.\n/// What it rolls on.\nstruct A;\n    /// Whether it rolls.\n// What.\n\
                /// Whatever.\n\n/// The same.\n";
    assert_eq!(without_subject("a.rs", text), ["a.rs:1", "a.rs:6", "a.rs:10"]);
}

#[test]
fn every_file_of_source_is_part_of_the_house() {
    let map = SourceMap::read(checkout());
    let known: BTreeSet<_> = map.modules.iter().map(|module| module.file.as_str()).collect();
    let sources = sources();
    let tests = test_files(&sources);
    let stranger = |file: &&String| !known.contains(file.as_str()) && !tests.contains(*file);
    let strangers: Vec<_> = sources.iter().map(|(file, _)| file).filter(stranger).collect();
    assert!(strangers.is_empty(), "no module declares {strangers:?}: declare or delete them");
}

/// A file beside a `main.rs` that this does not declare would never run.
#[test]
fn every_file_of_tests_is_part_of_a_program() {
    let files = files_below(&Path::new(env!("CARGO_MANIFEST_DIR")).join("tests"));
    let programs: BTreeMap<_, _> =
        files.iter().filter_map(|(file, text)| Some((file.strip_suffix("/main.rs")?, text))).collect();
    assert!(programs.len() > 5, "{programs:?}");
    for (file, _) in &files {
        let Some((folder, name)) = file.strip_suffix(".rs").and_then(|file| file.rsplit_once('/')) else { continue };
        let Some(program) = programs.get(folder).filter(|_| name != "main") else { continue };
        assert!(program.contains(&format!("\nmod {name};\n")), "tests/{folder}/main.rs does not declare {name}");
    }
}
