//! Files that a user names: read only where they end, and written without losing what is there.
#![cfg(unix)]

use crate::common;
use std::fs::{self, File};
use std::os::unix::fs::{PermissionsExt, symlink};
use std::path::{Path, PathBuf};
use std::process::Command;
use wheelrail::config::Config;
use wheelrail::fmi::instance::{Instance, simulation};
use wheelrail::fmi::log::{CallError, Log};
use wheelrail::fmi::v2::variables::variables;
use wheelrail::fmi::variable::Value;
use wheelrail::simulation::{BasisStore, Model, basis_file_name};

/// An empty directory for one test.
fn workplace(name: &str) -> PathBuf {
    let directory = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&directory);
    fs::create_dir_all(&directory).unwrap();
    directory
}

/// A pipe into which nobody writes: who opens it to read waits for ever.
fn pipe(path: &Path) -> &Path {
    assert!(Command::new("mkfifo").arg(path).status().unwrap().success());
    path
}

fn small() -> Config {
    let mut config = common::preset("railway", 4);
    config.thermal.enabled = false;
    config
}

/// A small wheel with these parameters, initialized, with its first step done.
fn start(settings: &[(&str, &Path)]) -> Result<Instance, CallError> {
    let mut instance = Instance::new(None, Log::new(Box::new(|_, _, _| {}), false))?;
    prepare(&mut instance, settings)?;
    instance.do_step(0.0, 1e-3)?;
    Ok(instance)
}

/// Makes the wheel small, sets these parameters and initializes it.
fn prepare(instance: &mut Instance, settings: &[(&str, &Path)]) -> Result<(), CallError> {
    let set = |instance: &mut Instance, name: &str, value: Value| {
        let row = variables().iter().find(|variable| variable.name == name).unwrap();
        instance.set(&[row.reference], vec![value])
    };
    let counts = [("mesh.elements_per_half_width", 4)];
    counts.iter().try_for_each(|(name, count)| set(instance, name, Value::Integer(*count)))?;
    set(instance, "thermal.enabled", Value::Boolean(false))?;
    for (name, path) in settings {
        set(instance, name, Value::String(path.to_str().unwrap().to_owned()))?;
    }
    instance.enter_initialization()?;
    instance.exit_initialization()
}

#[track_caller]
fn refused(settings: &[(&str, &Path)], words: &[&str]) {
    let message = start(settings).err().expect("refused").message;
    assert!(words.iter().all(|word| message.contains(word)), "{message}");
}

#[test]
fn profiles_that_never_end_are_refused_by_name_and_not_read() {
    let folder = workplace("endless_profiles");
    let (zero, long) = (folder.join("zero.csv"), folder.join("long.csv"));
    symlink("/dev/zero", &zero).unwrap();
    File::create(&long).unwrap().set_len(1 << 40).unwrap();
    refused(&[("rail.profile", pipe(&folder.join("pipe.csv")))], &["rail.profile", "pipe.csv", "only regular files"]);
    refused(&[("wheel.profile", &zero)], &["wheel.profile", "zero.csv", "device", "only regular files"]);
    refused(&[("rail.profile", &long)], &["rail.profile", "long.csv", "more than the 256 MiB"]);
    let link = folder.join("link.csv");
    fs::write(folder.join("plain.csv"), "position,height\n0,0\n1,0\n").unwrap();
    symlink("plain.csv", &link).unwrap();
    assert!(start(&[("rail.profile", &link)]).is_ok(), "a link to a regular file is one");
}

#[test]
fn presets_that_never_end_are_refused_by_name() {
    let folder = workplace("endless_presets");
    pipe(&folder.join("railway.json"));
    let refusal = Instance::new(Some(folder.clone()), Log::new(Box::new(|_, _, _| {}), false)).err().unwrap().message;
    assert!(refusal.contains("\"railway\"") && refusal.contains("only regular files"), "{refusal}");
}

#[test]
fn a_pipe_among_packed_bases_is_an_error_by_name_and_one_in_the_cache_counts_as_none() {
    let folder = workplace("endless_bases");
    fs::create_dir(folder.join("basis")).unwrap();
    let (config, name) = (small(), basis_file_name(&small()));
    pipe(&folder.join("basis").join(&name));
    let prepare = |store: &BasisStore| Model::prepare(config.clone(), store, &mut |_, _| {});
    let packed = BasisStore::none().with_packed(Some(&folder));
    let refusal = prepare(&packed).err().expect("refused").to_string();
    assert!(refusal.contains(&name) && refusal.contains("only regular files"), "{refusal}");
    let cache = BasisStore::within(&folder);
    assert!(prepare(&cache).is_ok());
    // The computed basis has taken its place.
    assert!(cache.find(&config).unwrap().is_some());
}

#[test]
fn a_profile_that_cannot_be_saved_is_refused_before_the_run() {
    let folder = workplace("not_to_be_saved");
    let (kept, pipe) = (folder.join("kept.csv"), folder.join("pipe.csv"));
    fs::write(&kept, "position,height\n0,0\n1,0\n").unwrap();
    fs::set_permissions(&kept, fs::Permissions::from_mode(0o444)).unwrap();
    refused(&[("wheel.profile_save", &kept)], &["wheel.profile_save", "kept.csv", "read-only", "another path"]);
    refused(&[("wheel.profile_save", self::pipe(&pipe))], &["wheel.profile_save", "pipe.csv", "is no file"]);
    // A folder in which nobody can make files.
    refused(
        &[("wheel.profile_save", Path::new("/proc/x.csv"))],
        &["wheel.profile_save", "/proc/x.csv", "another path"],
    );
    // Later in a run as well, and the parameter keeps its value.
    let good = folder.join("good.csv");
    let mut instance = start(&[("wheel.profile_save", &good)]).unwrap();
    let row = variables().iter().find(|variable| variable.name == "wheel.profile_save").unwrap();
    assert!(instance.set(&[row.reference], vec![Value::String("/proc/x.csv".to_owned())]).is_err());
    instance.terminate().unwrap();
    assert!(good.is_file());
}

#[test]
fn a_file_that_is_there_stays_until_the_run_ends_and_nothing_else_is_left_behind() {
    let folder = workplace("saved");
    let (real, link) = (folder.join("real.csv"), folder.join("link.csv"));
    let old = "position,height\n0,0\n1,0\n";
    fs::write(&real, old).unwrap();
    symlink("real.csv", &link).unwrap();
    drop(start(&[("wheel.profile_save", &link)]).unwrap());
    assert_eq!(fs::read_to_string(&real).unwrap(), old, "a run that is given up");
    let mut instance = start(&[("wheel.profile_save", &link)]).unwrap();
    assert_eq!(fs::read_to_string(&real).unwrap(), old, "a run under way");
    instance.terminate().unwrap();
    assert_eq!(fs::read_to_string(&real).unwrap(), simulation(&mut instance).unwrap().wheel_profile_file());
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 2);
}

#[test]
fn the_path_of_a_saved_profile_is_no_part_of_a_state_and_wheels_that_save_elsewhere_share_a_model() {
    let folder = workplace("elsewhere");
    let [mut one, mut two] =
        ["one.csv", "two.csv"].map(|name| start(&[("wheel.profile_save", &folder.join(name))]).unwrap());
    let [a, b] = [&mut one, &mut two].map(|wheel| simulation(wheel).unwrap());
    assert!(std::sync::Arc::ptr_eq(a.model(), b.model()));
    assert_eq!(a.checkpoint(), b.checkpoint());
    let text = format!("{:?}", a.checkpoint().tuning);
    assert!(!text.contains("one.csv") && text.contains("falling_ratio"), "{text}");
    // As a parameter that was set it comes back with a state, and the file is written there when its owner has gone.
    let state = one.snapshot().unwrap();
    two.restore(&state).unwrap();
    assert_eq!(two.slave().config(), one.slave().config());
    let refusal = two.terminate().unwrap_err().message;
    assert!(refusal.contains("one.csv") && refusal.contains("of this process"), "{refusal}");
    drop(one);
    two.terminate().unwrap();
    assert!(folder.join("one.csv").is_file() && !folder.join("two.csv").exists());
}

/// A wheel of a name that saves its profile to `path`, with its warnings.
fn saving(name: &str, path: &Path) -> (Result<Instance, CallError>, Vec<String>) {
    let said = std::rc::Rc::new(std::cell::RefCell::new(Vec::new()));
    let heard = said.clone();
    let log = Log::new(Box::new(move |_, _, text: &str| heard.borrow_mut().push(text.to_owned())), false);
    let begin = || -> Result<Instance, CallError> {
        let mut instance = Instance::new(None, log)?;
        instance.take_name(name.to_owned());
        prepare(&mut instance, &[("wheel.profile_save", path)])?;
        Ok(instance)
    };
    let begun = begin();
    let said = said.borrow().iter().filter(|text: &&String| text.contains("profile_save")).cloned().collect();
    (begun, said)
}

#[test]
fn a_file_has_one_owner_in_a_process_by_whatever_path_until_it_ends_is_reset_or_freed() {
    let folder = workplace("owners");
    fs::create_dir(folder.join("sub")).unwrap();
    symlink("worn.csv", folder.join("link.csv")).unwrap();
    symlink(&folder, folder.join("sub/up")).unwrap();
    let path = folder.join("worn.csv");
    let (front, warned) = saving("front", &path);
    assert_eq!(warned, [""; 0]);
    let others = ["worn.csv", "link.csv", "sub/up/worn.csv", "sub/../worn.csv"];
    for other in others {
        let message = saving("rear", &folder.join(other)).0.err().expect("refused").message;
        for word in [other, "worn.csv", "\"front\"", "a path of its own"] {
            assert!(message.contains(word), "{word} is missing in {message}");
        }
    }
    // Freed without an end, reset, and ended.
    drop(front);
    let mut rear = saving("rear", &folder.join("link.csv")).0.unwrap();
    rear.reset().unwrap();
    let mut front = saving("front", &path).0.unwrap();
    assert!(saving("rear", &path).0.is_err());
    front.terminate().unwrap();
    let worn = fs::read_to_string(&path).unwrap();
    // A loop of one wheel is silent, another wheel is told, and the file stays until it ends.
    let (again, warned) = saving("front", &path);
    assert_eq!(warned, [""; 0]);
    drop(again);
    let (rear, warned) = saving("rear", &folder.join("sub/up/worn.csv"));
    println!("{warned:?}");
    assert!(warned.len() == 1 && warned[0].contains("\"front\"") && warned[0].contains("worn.csv"), "{warned:?}");
    assert_eq!(fs::read_to_string(&path).unwrap(), worn);
    rear.unwrap().terminate().unwrap();
}

#[test]
fn what_somebody_else_has_saved_meanwhile_is_not_replaced_and_another_path_saves_the_run() {
    let folder = workplace("meanwhile");
    let (path, other) = (folder.join("worn.csv"), folder.join("other.csv"));
    let mut wheel = start(&[("wheel.profile_save", &path)]).unwrap();
    fs::write(&path, "of another process").unwrap();
    let refusal = wheel.terminate().unwrap_err().message;
    println!("{refusal}");
    assert!(refusal.contains("worn.csv") && refusal.contains("another path"), "{refusal}");
    assert_eq!(fs::read_to_string(&path).unwrap(), "of another process");
    let row = variables().iter().find(|variable| variable.name == "wheel.profile_save").unwrap();
    wheel.set(&[row.reference], vec![Value::String(other.to_str().unwrap().to_owned())]).unwrap();
    wheel.terminate().unwrap();
    assert_eq!(fs::read_to_string(&other).unwrap(), simulation(&mut wheel).unwrap().wheel_profile_file());
}
