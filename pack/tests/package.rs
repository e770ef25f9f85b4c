//! The archive: binaries of several platforms, refusals, reproducible bytes.

use std::env;
use std::fs::{self, File};
use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::Command;
use wheelrail::fmi::interface::Interface;
use wheelrail::fmi::v2::description::Extent;
use wheelrail_pack::package::{self, Contents};
use wheelrail_pack::platform::{self, Binary};
use zip::ZipArchive;

/// An empty directory for one test.
fn workplace(name: &str) -> PathBuf {
    let directory = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&directory);
    fs::create_dir_all(&directory).unwrap();
    directory
}

/// The program, beside the folder of the tests. (Shells pass no variables with a hyphen on, such as that of cargo.)
fn program() -> PathBuf {
    env::current_exe()
        .unwrap()
        .ancestors()
        .nth(2)
        .unwrap()
        .join("wheelrail-pack")
        .with_extension(env::consts::EXE_EXTENSION)
}

/// Contents with the given libraries, without precomputed bases.
fn contents(binaries: Vec<Binary>) -> Contents {
    let root = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/.."));
    Contents {
        interface: Interface::Two(Extent::Full),
        binaries,
        resources: root.join("resources"),
        reference: root.join("examples/reference"),
        sbom: None,
        bases: Vec::new(),
    }
}

/// A file that stands for the library of a platform, and its text.
fn library(directory: &Path, platform: &str) -> (Binary, String) {
    let head = if platform == "win64" { "MZ" } else { "\x7fELF" };
    let (file, text) = (directory.join(platform), format!("{head} library for {platform}"));
    fs::write(&file, &text).unwrap();
    (Binary::new(platform, file).unwrap(), text)
}

#[test]
fn an_archive_holds_the_binaries_of_all_its_platforms() {
    let directory = workplace("platforms");
    let (linux, windows) = (library(&directory, "linux64"), library(&directory, "win64"));
    let fmu = directory.join("both.fmu");
    package::write(&fmu, &contents(vec![linux.0, windows.0])).unwrap();
    let mut archive = ZipArchive::new(File::open(&fmu).unwrap()).unwrap();
    for (name, expected) in [("binaries/linux64/wheelrail.so", linux.1), ("binaries/win64/wheelrail.dll", windows.1)] {
        let mut text = String::new();
        archive.by_name(name).unwrap().read_to_string(&mut text).unwrap();
        assert_eq!(text, expected, "{name}");
    }
    for name in ["modelDescription.xml", "model.png", "documentation/index.html", "resources/railway.json"] {
        assert!(archive.by_name(name).is_ok(), "{name}");
    }
}

#[test]
fn the_manifest_of_references_names_files_that_are_there_and_every_preset() {
    let directory = workplace("references");
    let fmu = directory.join("references.fmu");
    for interface in [Interface::Two(Extent::Full), Interface::Three] {
        package::write(&fmu, &Contents { interface, ..contents(vec![library(&directory, "linux64").0]) }).unwrap();
        let mut archive = ZipArchive::new(File::open(&fmu).unwrap()).unwrap();
        let names: Vec<_> = archive.file_names().map(|name| name.unwrap().into_owned()).collect();
        let mut manifest = String::new();
        let folder = "extra/org.fmi-standard.fmi-ls-ref";
        archive.by_name(&format!("{folder}/fmi-ls-manifest.xml")).unwrap().read_to_string(&mut manifest).unwrap();
        let sources: Vec<_> = manifest.split("source=\"").skip(1).map(|part| part.split('"').next().unwrap()).collect();
        for source in &sources {
            let place = source.strip_prefix("../../").map_or(format!("{folder}/{source}"), str::to_owned);
            assert!(names.contains(&place), "{place}");
        }
        let presets = names.iter().filter(|name| name.starts_with("resources/") && name.ends_with(".json")).count();
        assert_eq!(sources.iter().filter(|source| source.ends_with(".ssv")).count(), presets);
        assert!(presets >= 12);
    }
}

#[test]
fn a_bill_of_materials_lies_beside_the_licences() {
    let directory = workplace("bill");
    let (bill, fmu) = (directory.join("bill.json"), directory.join("bill.fmu"));
    fs::write(&bill, "{}").unwrap();
    let mut contents = contents(vec![library(&directory, "linux64").0]);
    let names = |contents: &Contents| {
        package::write(&fmu, contents).unwrap();
        let archive = ZipArchive::new(File::open(&fmu).unwrap()).unwrap();
        archive.file_names().map(|name| name.unwrap().into_owned()).collect::<Vec<_>>()
    };
    let bills = |names: Vec<String>| names.into_iter().filter(|name| name.ends_with(".cdx.json")).collect::<Vec<_>>();
    assert_eq!(bills(names(&contents)), Vec::<String>::new());
    contents.sbom = Some(bill);
    assert_eq!(bills(names(&contents)), ["documentation/licenses/wheelrail.cdx.json"]);
    contents.sbom = Some(directory.join("nowhere.json"));
    let error = package::write(&fmu, &contents).unwrap_err().to_string();
    assert!(error.contains("nowhere.json"), "{error}");
}

#[test]
fn equal_contents_give_equal_bytes() {
    let directory = workplace("reproducible");
    let (binary, _) = library(&directory, "linux64");
    let [one, two] = ["one.fmu", "two.fmu"].map(|name| {
        package::write(&directory.join(name), &contents(vec![binary.clone()])).unwrap();
        fs::read(directory.join(name)).unwrap()
    });
    assert!(one == two);
}

#[test]
fn a_platform_has_one_binary() {
    let directory = workplace("twice");
    let binaries = vec![library(&directory, "win64").0, library(&directory, "win64").0];
    let error = package::write(&directory.join("twice.fmu"), &contents(binaries)).unwrap_err();
    assert_eq!(error.to_string(), "two binaries are to become binaries/win64/wheelrail.dll");
}

#[test]
fn a_missing_library_is_named() {
    let directory = workplace("missing");
    let binary = Binary::new("win64", directory.join("nowhere.dll")).unwrap();
    let error = package::write(&directory.join("missing.fmu"), &contents(vec![binary])).unwrap_err();
    assert!(error.to_string().contains("nowhere.dll"), "{error}");
}

#[test]
fn the_command_line_refuses_unknown_platforms_with_the_list_of_known_ones() {
    let pack = |binary: &str| {
        let output = Command::new(program()).args(["pack", "--binary", binary]).output().unwrap();
        assert!(!output.status.success());
        String::from_utf8(output.stderr).unwrap()
    };
    let refusal = pack("amiga=wheelrail.so");
    assert!(refusal.contains("\"amiga\" is unknown: win32, win64, linux32, linux64, darwin32, darwin64"), "{refusal}");
    assert!(pack("wheelrail.dll").contains("PLATFORM=FILE"));
}

#[test]
fn commands_of_the_earlier_program_are_refused_with_what_does_now_what_they_did() {
    for (command, words) in
        [("simulate", "wheelrail simulate"), ("steady", "wheelrail steady"), ("export", "--example fields")]
    {
        let output = Command::new(program()).args([command, "--stop", "1"]).output().unwrap();
        let refusal = String::from_utf8(output.stderr).unwrap();
        assert!(
            output.status.code() == Some(2) && refusal.contains(words) && refusal.lines().count() == 1,
            "{refusal}"
        );
    }
}

#[test]
fn a_binary_named_for_this_machine_takes_the_place_of_the_library() {
    let directory = workplace("named");
    let (own, fmu) = (platform::own_platform().unwrap().three, directory.join("named.fmu"));
    let (_, text) = library(&directory, own);
    let output = Command::new(program())
        .current_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/.."))
        .arg("pack")
        .args(["--library", "nowhere.so", "--binary", &format!("{own}={}", directory.join(own).display())])
        .args(["--resources".as_ref(), directory.as_os_str(), "--out".as_ref(), fmu.as_os_str()])
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let mut archive = ZipArchive::new(File::open(&fmu).unwrap()).unwrap();
    let names: Vec<_> = archive.file_names().map(|name| name.unwrap().into_owned()).collect();
    let binaries: Vec<_> = names.iter().filter(|name| name.starts_with("binaries/")).collect();
    assert_eq!(binaries.len(), 1, "{binaries:?}");
    let mut packed = String::new();
    archive.by_name(binaries[0]).unwrap().read_to_string(&mut packed).unwrap();
    assert_eq!(packed, text);
}

#[test]
fn licences_of_all_linked_crates_are_in_the_archive() {
    let listed =
        fs::read_to_string(Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/..")).join("docs/LICENSE-THIRD-PARTY"))
            .unwrap();
    let tree = Command::new(env!("CARGO"))
        .args([
            "tree",
            "--package",
            "wheelrail",
            "--edges",
            "normal,no-proc-macro",
            "--prefix",
            "none",
            "--offline",
            "--locked",
        ])
        .args(["--format", "{p}", "--target", "x86_64-unknown-linux-gnu"])
        .current_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/.."))
        .output()
        .unwrap();
    assert!(tree.status.success(), "{}", String::from_utf8_lossy(&tree.stderr));
    let tree = String::from_utf8(tree.stdout).unwrap();
    let mut count = 0;
    for line in tree.lines().filter(|line| !line.starts_with("wheelrail")) {
        let mut words = line.split_whitespace();
        let (name, version) = (words.next().unwrap(), words.next().unwrap().trim_start_matches('v'));
        let entry = format!("\n{name} {version}: ");
        assert!(listed.contains(&entry), "{name} {version} is missing: run docs/third_party.py");
        count += 1;
    }
    assert!(count > 20, "{count} crates");
    for (name, user) in [("libfmi", "tests"), ("libloading", "tests"), ("zopfli", "nobody")] {
        assert!(
            !tree.lines().any(|line| line.starts_with(&format!("{name} "))),
            "{name} is for {user}, not for the product"
        );
    }
}

#[test]
fn a_file_that_is_no_library_is_refused() {
    let directory = workplace("no_library");
    let file = directory.join("table.csv");
    fs::write(&file, "time,drive.moment").unwrap();
    let binaries = vec![Binary::new("linux64", &file).unwrap()];
    let error = package::write(&directory.join("none.fmu"), &contents(binaries)).unwrap_err().to_string();
    assert!(error.contains("table.csv") && error.contains("x86_64-linux"), "{error}");
}
