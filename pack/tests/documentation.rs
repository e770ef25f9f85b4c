//! Documentation inside the FMU: every page is there, linked, alive, and speaks of variables that exist.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, File};
use std::io::Read;
use std::path::Path;
use wheelrail::fmi::interface::Interface;
use wheelrail::fmi::v2::description::Extent;
use wheelrail::fmi::v2::variables::variables;
use wheelrail::fmi::variable::Causality;
use wheelrail_pack::package::{self, Contents};
use wheelrail_pack::platform::Binary;
use zip::ZipArchive;

/// Text files of the folder `documentation`, and the names of all.
fn documentation() -> (BTreeMap<String, String>, BTreeSet<String>) {
    let root = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."));
    let directory =
        Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("documentation {:?}", std::thread::current().id()));
    fs::create_dir_all(&directory).unwrap();
    let (library, fmu) = (directory.join("library"), directory.join("documentation.fmu"));
    fs::write(&library, "\x7fELF").unwrap();
    let contents = Contents {
        interface: Interface::Two(Extent::WithoutProfiles),
        binaries: vec![Binary::new("linux64", library).unwrap()],
        resources: root.join("resources"),
        reference: root.join("examples/reference"),
        sbom: None,
        bases: Vec::new(),
    };
    package::write(&fmu, &contents).unwrap();
    let mut archive = ZipArchive::new(File::open(&fmu).unwrap()).unwrap();
    let (mut texts, mut names) = (BTreeMap::new(), BTreeSet::new());
    for i in 0..archive.len() {
        let mut file = archive.by_index(i).unwrap();
        let Some(name) = file.name().unwrap().strip_prefix("documentation/").map(str::to_owned) else { continue };
        if name.ends_with(".html") {
            let mut text = String::new();
            file.read_to_string(&mut text).unwrap();
            texts.insert(name.clone(), text);
        }
        names.insert(name);
    }
    fs::remove_dir_all(&directory).unwrap();
    (texts, names)
}

/// Values of the attributes `href` and `src`.
fn targets(html: &str) -> impl Iterator<Item = &str> {
    let after = |name: &'static str| html.split(name).skip(1).filter_map(|rest| rest.split('"').next());
    after(" href=\"").chain(after(" src=\""))
}

/// The file that a link on a page means.
fn file(page: &str, target: &str) -> String {
    let mut parts: Vec<&str> = page.split('/').collect();
    parts.pop();
    for part in target.split('/') {
        match part {
            ".." => assert!(parts.pop().is_some(), "{page}: {target} leads out of the documentation"),
            part => parts.push(part),
        }
    }
    parts.join("/")
}

#[test]
fn every_page_of_the_theory_is_in_the_package_and_linked_from_its_first_page() {
    let (texts, _) = documentation();
    let index: BTreeSet<&str> = targets(&texts["index.html"]).collect();
    let mut pages = 0;
    for entry in fs::read_dir(Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/..")).join("docs/theory")).unwrap() {
        let path = entry.unwrap().path();
        let stem = path.file_stem().unwrap().to_str().unwrap();
        let name = format!("theory/{}.html", if stem == "README" { "index" } else { stem });
        let html = texts.get(&name).unwrap_or_else(|| panic!("{name} is missing"));
        assert!(index.contains(name.as_str()), "{name} is not linked");
        let markdown = fs::read_to_string(&path).unwrap();
        // Equations and tables arrive as such, the heading as title.
        assert_eq!(html.matches("<pre>").count(), markdown.matches("\n```text\n").count(), "{name}");
        assert_eq!(
            html.matches("<table>").count(),
            markdown.matches("\n|---").count() + markdown.matches("\n| ---").count(),
            "{name}"
        );
        let heading = markdown.lines().next().unwrap().trim_start_matches("# ");
        assert!(html.contains(&format!("<title>{heading} – ")), "{name}: {heading}");
        assert!(!html.contains("```") && !html.contains("$$") && !html.contains("{body}"), "{name}");
        pages += 1;
    }
    assert!(pages > 15);
    for name in texts.keys().filter(|name| *name != "index.html") {
        assert!(index.contains(name.as_str()), "{name} is not linked");
    }
}

#[test]
fn no_link_of_the_documentation_is_dead_and_none_leads_to_raw_markdown() {
    let (texts, names) = documentation();
    let mut links = 0;
    for (page, html) in &texts {
        for target in targets(html).filter(|target| !target.contains("://")) {
            links += 1;
            let (path, anchor) = target.split_once('#').unwrap_or((target, ""));
            let name = if path.is_empty() { page.clone() } else { file(page, path) };
            assert!(names.contains(&name), "{page}: {target}");
            assert!(!name.ends_with(".md"), "{page}: {target}");
            let there = anchor.is_empty() || texts[&name].contains(&format!("id=\"{anchor}\""));
            assert!(there, "{page}: {target}");
        }
    }
    println!("{} pages, {links} links", texts.len());
    assert!(links > 150);
}

#[test]
fn nothing_is_loaded_from_a_network() {
    let (texts, _) = documentation();
    for (page, html) in &texts {
        assert!(!html.contains("<script"), "{page}");
        let loaded = html.split(" src=\"").skip(1).chain(html.split("<link ").skip(1));
        for part in loaded.filter_map(|rest| rest.split('>').next()) {
            assert!(!part.contains("://"), "{page}: {part}");
        }
    }
}

#[test]
fn variables_that_the_first_page_names_exist() {
    let (texts, _) = documentation();
    let text = texts["index.html"].split("id=\"variables\"").next().unwrap();
    let known = |name: &str| match name.strip_suffix('*') {
        Some(stem) => variables().iter().any(|variable| variable.name.starts_with(stem)),
        None => variables().iter().any(|variable| variable.name == name),
    };
    let groups: BTreeSet<&str> =
        variables().iter().filter_map(|variable| Some(variable.name.split_once('.')?.0)).collect();
    let mut count = 0;
    for code in text.split("<code>").skip(1).filter_map(|rest| rest.split("</code>").next()) {
        for word in code.split_whitespace().map(|word| word.trim_start_matches('-')) {
            if word.split_once('.').is_some_and(|(group, _)| groups.contains(group)) {
                assert!(known(word), "{word}");
                count += 1;
            }
        }
    }
    assert!(count > 60, "{count}");
}

#[test]
fn the_first_page_has_every_parameter_in_a_row_of_its_own() {
    let (texts, _) = documentation();
    let text = &texts["index.html"];
    let places = ["Basic parameters", "Expert parameters", "Retired parameters"].map(|title| text.find(title).unwrap());
    assert!(places.is_sorted());
    for variable in variables().iter().filter(|variable| variable.causality() == Causality::Parameter) {
        assert_eq!(text.matches(&format!("<code>{}</code></td>", variable.name)).count(), 1, "{}", variable.name);
    }
}
