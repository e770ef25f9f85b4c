//! Reads the modules of a crate and what they import from each other: enough of the language for the tests of its
//! architecture.
#![allow(dead_code)]

pub mod choices;
mod text;

pub use text::{functions, lines_of_tests, types, without_comments, without_strings, without_tests};

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// One file of source: a module.
#[derive(Default)]
pub struct Module {
    /// Path below `src`, such as `rolling/step.rs`, or from the root of the checkout in one of the [`MEMBERS`].
    pub file: String,
    /// Code without comments, strings and unit tests.
    code: String,
    /// Path from the root of its crate.
    path: Vec<String>,
    /// The crate it belongs to: `lib`, or one of the [`MEMBERS`].
    root: &'static str,
    /// Modules declared in it.
    children: BTreeSet<String>,
    /// Names bound by `use`, and the paths they stand for.
    names: BTreeMap<String, Vec<String>>,
    /// Modules of which everything is imported.
    globs: Vec<Vec<String>>,
}

/// Where a path leads.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Place {
    /// To a module.
    Module(usize),
    /// To something that is defined in a module.
    Item(usize),
    /// Out of the crate.
    Elsewhere,
}

/// Crates of the workspace that hold rooms of the product, from the ground up, and where their source lies.
pub const MEMBERS: [(&str, &str); 5] = [
    ("wheelrail_numerics", "numerics/src/"),
    ("wheelrail_bodies", "bodies/src/"),
    ("wheelrail_heat", "heat/src/"),
    ("wheelrail_contact", "contact/src/"),
    ("wheelrail_surface", "surface/src/"),
];

/// The member of this name.
fn member(name: &str) -> Option<&'static str> {
    MEMBERS.iter().map(|(member, _)| *member).find(|member| *member == name)
}

/// All modules of a crate and its [`MEMBERS`], unit tests left out.
pub struct SourceMap {
    pub modules: Vec<Module>,
    at: BTreeMap<(&'static str, Vec<String>), usize>,
}

/// Longest chain of re-exports that is followed.
const DEPTH: usize = 12;

impl SourceMap {
    /// Reads the modules of a checkout from `lib.rs` of every crate on.
    pub fn read(checkout: &Path) -> Self {
        let within = |folder: &str, file: &str| std::fs::read_to_string(checkout.join(folder).join(file)).ok();
        Self::from_files(|file| match MEMBERS.iter().any(|(_, folder)| file.starts_with(folder)) {
            true => within("", file),
            false => within("src", file),
        })
    }

    /// Reads modules and imports from any source of files.
    pub fn from_files(read: impl Fn(&str) -> Option<String>) -> Self {
        let mut map = Self { modules: Vec::new(), at: BTreeMap::new() };
        for (root, folder) in [("lib", "")].into_iter().chain(MEMBERS) {
            map.add((root, folder), Vec::new(), &read);
        }
        map
    }

    fn add(
        &mut self,
        (root, folder): (&'static str, &'static str),
        path: Vec<String>,
        read: &impl Fn(&str) -> Option<String>,
    ) {
        let base = format!("{folder}{}", path.join("/"));
        let candidates = match path.is_empty() {
            true => vec![format!("{folder}lib.rs")],
            false => vec![format!("{base}.rs"), format!("{base}/mod.rs")],
        };
        let Some((file, text)) = candidates.into_iter().find_map(|file| read(&file).map(|text| (file, text))) else {
            return;
        };
        let code = without_tests(&without_strings(&without_comments(&text)));
        let mut module = Module { file, path, root, children: text::modules(&code), ..Module::default() };
        for import in text::imports(&code) {
            match import.name {
                Some(name) => drop(module.names.insert(name, import.path)),
                None => module.globs.push(import.path),
            }
        }
        module.code = text::without_imports(&code);
        let (children, parent) = (module.children.clone(), module.path.clone());
        self.at.insert((root, parent.clone()), self.modules.len());
        self.modules.push(module);
        for child in children {
            self.add((root, folder), [&parent[..], &[child]].concat(), read);
        }
    }

    /// Where a path written in a module leads.
    fn resolve(&self, from: usize, path: &[String], depth: usize) -> Place {
        let here = &self.modules[from];
        let root = |name: &'static str| self.at.get(&(name, Vec::new())).copied();
        let parent = || self.at.get(&(here.root, here.path[..here.path.len().saturating_sub(1)].to_vec())).copied();
        let Some(first) = path.first() else { return Place::Module(from) };
        let start = match first.as_str() {
            "crate" => root(here.root),
            "wheelrail" => root("lib"),
            name if member(name).is_some() => member(name).and_then(root),
            "self" => Some(from),
            "super" => parent(),
            _ => return self.resolve_name(from, path, depth),
        };
        start.map_or(Place::Elsewhere, |module| self.descend(module, &path[1..], depth))
    }

    /// Place of a path from inside a module on: `super` may follow, children, imported names and items.
    fn descend(&self, module: usize, path: &[String], depth: usize) -> Place {
        match path.first().map(String::as_str) {
            None => Place::Module(module),
            Some("super" | "self") => self.resolve(module, path, depth),
            Some(_) => match self.resolve_name(module, path, depth) {
                Place::Elsewhere => Place::Item(module),
                place => place,
            },
        }
    }

    /// Place of a path that begins with a name: a child, an imported name, or something from elsewhere.
    fn resolve_name(&self, module: usize, path: &[String], depth: usize) -> Place {
        let here = &self.modules[module];
        let child = [&here.path[..], &path[..1]].concat();
        if let Some(&child) = self.at.get(&(here.root, child)) {
            return self.descend(child, &path[1..], depth);
        }
        match here.names.get(&path[0]) {
            Some(target) if depth < DEPTH && target[..] != path[..1] => {
                self.resolve(module, &[target, &path[1..]].concat(), depth + 1)
            }
            _ => Place::Elsewhere,
        }
    }

    /// The other files that each file imports from or names, in the order of [`Self::modules`]. An imported module
    /// counts through what is used of it, a re-exported name as the file that defines it.
    pub fn imports(&self) -> Vec<BTreeSet<usize>> {
        (0..self.modules.len()).map(|from| self.imports_of(from)).collect()
    }

    /// The files at the top of the rooms that each file names, whatever stands behind their re-exports.
    pub fn rooms_named(&self, from: usize) -> BTreeSet<&str> {
        let module = &self.modules[from];
        let written = text::paths(&module.code);
        let paths = module.names.values().chain(&module.globs).chain(&written);
        let up = |path: &[String]| path.iter().take_while(|word| *word == "super").count();
        let absolute = |path: &Vec<String>| match path.first().map(String::as_str) {
            Some("crate") => Some((module.root, path[1..].to_vec())),
            Some("wheelrail") => Some(("lib", path[1..].to_vec())),
            Some(name) if member(name).is_some() => Some((member(name)?, path[1..].to_vec())),
            Some("super") => {
                let above = module.path.len().saturating_sub(up(path));
                Some((module.root, [&module.path[..above], &path[up(path)..]].concat()))
            }
            Some(child) if module.path.is_empty() && module.children.contains(child) => {
                Some((module.root, path.clone()))
            }
            _ => None,
        };
        let top = |(root, path): (&'static str, Vec<String>)| {
            let child = self.at.get(&(root, path.get(..1)?.to_vec())).copied();
            child.or_else(|| self.room_of_another_crate(root, &path))
        };
        paths.filter_map(absolute).filter_map(top).map(|room| self.modules[room].file.as_str()).collect()
    }

    /// A file of the room of another crate that the root of this one passes on.
    fn room_of_another_crate(&self, root: &'static str, path: &[String]) -> Option<usize> {
        let library = self.at.get(&(root, Vec::new())).copied()?;
        self.modules[library].names.get(path.first()?)?;
        match self.resolve(library, path, 0) {
            Place::Module(file) | Place::Item(file) => Some(file).filter(|file| !self.modules[*file].path.is_empty()),
            Place::Elsewhere => None,
        }
    }

    fn imports_of(&self, from: usize) -> BTreeSet<usize> {
        let module = &self.modules[from];
        let mut found = BTreeSet::new();
        for path in module.names.values() {
            if let Place::Item(target) = self.resolve(from, path, 0) {
                found.insert(target);
            }
        }
        for path in &module.globs {
            if let Place::Item(target) | Place::Module(target) = self.resolve(from, path, 0) {
                found.insert(target);
            }
        }
        for path in text::paths(&module.code) {
            if let Place::Item(target) = self.resolve(from, &path, 0) {
                found.insert(target);
            }
        }
        found.remove(&from);
        found
    }
}

/// Groups of nodes that reach each other.
pub fn circles(edges: &[BTreeSet<usize>]) -> Vec<Vec<usize>> {
    let reach = |from: usize| {
        let (mut seen, mut open) = (BTreeSet::new(), vec![from]);
        while let Some(node) = open.pop() {
            open.extend(edges[node].iter().filter(|next| seen.insert(**next)));
        }
        seen
    };
    let reached: Vec<_> = (0..edges.len()).map(reach).collect();
    let mut groups = BTreeSet::new();
    for (node, ahead) in reached.iter().enumerate().filter(|(node, ahead)| ahead.contains(node)) {
        groups.insert(ahead.iter().copied().filter(|other| reached[*other].contains(&node)).collect::<Vec<_>>());
    }
    groups.into_iter().collect()
}
